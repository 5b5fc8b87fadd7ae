// SPDX-License-Identifier: MIT
#include "scarp/scene/file/from_raster.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "scarp/base/error.h"
#include "scarp/source/raster/mirrored.h"

namespace scarp {

HeightField height_field_from(Raster raster, const FieldOptions& options) {
  if (options.mirror) raster = mirrored(std::move(raster));
  HeightFieldSettings settings;
  settings.cell_x = raster.georeference.cell_x_m;
  settings.cell_y = raster.georeference.cell_y_m;
  settings.scale = raster.scale;
  settings.offset = raster.offset;
  settings.exaggeration = options.exaggeration;
  settings.nodata = raster.nodata;
  settings.surface = options.surface;
  settings.wrap = options.mirror ? Wrap::periodic : options.wrap;
  settings.solid = options.solid;
  try {
    return std::visit(
        [&](auto&& samples) { return HeightField::own(std::move(samples), raster.cols, raster.rows, settings); },
        std::move(raster.samples));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", raster.path, error.what()));
  }
}

}  // namespace scarp
