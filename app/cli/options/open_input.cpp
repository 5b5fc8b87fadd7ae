// SPDX-License-Identifier: MIT
#include "app/cli/options/open_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "app/cli/options/device_option.h"
#include "app/cli/options/scene_input.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/shape/shape_table.h"
#include "scarp/march/voxel/voxel_table.h"
#include "scarp/scene/file/example_functions.h"
#include "scarp/source/raster/opened_raster.h"

namespace scarp::cli {
namespace {

// Applies --exaggeration auto, from the field without exaggeration.
void choose_exaggeration(const Raster& raster, FieldOptions& settings, std::vector<std::string>& notes) {
  const HeightFieldSettings plain{.cell_x = raster.georeference.cell_x_m,
                                  .cell_y = raster.georeference.cell_y_m,
                                  .scale = raster.scale,
                                  .offset = raster.offset,
                                  .nodata = raster.nodata};
  const auto view = [&](const auto& samples) {
    return HeightField::view(samples.data(), raster.cols, raster.rows, plain);
  };
  try {
    const HeightField field = std::visit(view, raster.samples);
    if (field.all_nodata()) return;  // rejected later
    const double relief = field.max_height() - field.min_height(), side = std::max(field.width(), field.depth());
    settings.exaggeration = chosen_exaggeration(relief, side);
    notes.push_back(fmt::format(
        "--exaggeration auto is {:g}: the relief of {} m over {} m becomes {:.2g} of the longer side",
        settings.exaggeration, metres_text(relief), metres_text(side), settings.exaggeration * relief / side));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", raster.path, error.what()));
  }
}

// Throws Error for a march of another kind of input. The lookup rejects unknown names.
template <class Table>
void require_march_of(const Table& table, std::string_view inputs, const std::string& march) {
  const auto in = [&](const auto& entries) {
    return std::any_of(entries.begin(), entries.end(), [&](const MarchEntry& one) { return one.name == march; });
  };
  if (in(table)) return;
  if (!in(height_marches()) && !in(function_marches()) && !in(voxel_marches()) && !in(shape_marches())) return;
  std::string names;
  for (const MarchEntry& one : table) names += fmt::format("{}{}", names.empty() ? "" : ", ", one.name);
  throw Error(fmt::format("march '{}': is not for {} (available: {})", march, inputs, names));
}

Raster read_samples(const InputOptions& options) {
  const Progress progress = terminal_progress("read");
  OpenedRaster file(options.inputs, options.raster, progress);
  return options.part ? file.read(*options.part, progress) : file.read(progress);
}

OpenedInput terrain(const InputOptions& options) {
  require_march_of(height_marches(), "terrain", options.march);
  const HeightMarchEntry& march = find_height_march(options.march.empty() ? kTerrainMarch : options.march);
  require_device_march(options.device, march);
  Raster raster = read_samples(options);
  stop_if_interrupted();
  OpenedInput opened;
  opened.notes = raster.notes, opened.files = raster.files, opened.path = raster.path;
  opened.georeference = raster.georeference, opened.cols = raster.cols, opened.rows = raster.rows;
  FieldOptions settings = options.field;
  if (options.exaggeration.chosen) choose_exaggeration(raster, settings, opened.notes);
  HeightField field = height_field_from(std::move(raster), settings);
  stop_if_interrupted();
  const bool on_cpu = options.device.empty() || options.moves;
  opened.scene = Scene(
      scene_heights(std::move(field), march, options.march_settings, on_cpu ? AnsweredBy::cpu : AnsweredBy::back_end));
  return opened;
}

OpenedInput voxels(const InputOptions& options, const std::string& ramp) {
  VoxelFileOptions voxels;
  voxels.march = options.march;
  require_march_of(voxel_marches(), "voxels", options.march);
  // An unknown name is reported before the file is read.
  if (!options.march.empty()) find_voxel_march(options.march);
  voxels.surface_colours = options.vox.surface_colours;
  voxels.rounding = options.vox_look.rounding;
  const VoxelShading shading = shading_of(options.vox_look);
  VoxInput read = read_voxels(options.inputs.front(), options.vox, voxels, ramp);
  OpenedInput opened{Scene(scene_voxels(std::move(read.voxels), shading))};
  opened.numbers = read.numbers, opened.notes = std::move(read.notes);
  return opened;
}

OpenedInput scene_file(const InputOptions& options) {
  SceneFile document = read_scene(options.inputs.front(), terminal_progress("read"));
  OpenedInput opened{document.scene, document.notes, document.files};
  opened.document = std::move(document);
  return opened;
}

OpenedInput function(const InputOptions& options) {
  require_march_of(function_marches(), "functions", options.march);
  const FunctionMarchEntry& march = find_function_march(options.march.empty() ? kFunctionMarch : options.march);
  HeightFunction function(read_function(options.function.function));
  OpenedInput opened{Scene(scene_function(function, march, options.march_settings))};
  opened.function = std::move(function);
  return opened;
}

}  // namespace

InputKind kind_of_input(const Command& command, const InputOptions& options) {
  const std::vector<std::string>& inputs = options.inputs;
  if (!options.function.function.empty()) {
    if (inputs.empty()) return InputKind::function;
    throw Error(fmt::format("'{}': --function replaces files (give one of the two)", inputs.front()));
  }
  if (inputs.empty()) {
    throw WrongUsage(fmt::format("IN{} is required (see 'scarp {} --help')",
                                 command.find("--function") ? " (or --function NAME)" : "", command.name()));
  }
  if (is_scene_input(inputs)) return InputKind::scene;
  if (is_mesh_input(inputs)) return InputKind::mesh;
  return is_vox_input(inputs, options.vox) ? InputKind::voxels : InputKind::terrain;
}

std::string_view march_of(const InputOptions& options, InputKind kind) {
  if (kind != InputKind::terrain && kind != InputKind::function) return {};
  if (!options.march.empty()) return options.march;
  return kind == InputKind::terrain ? kTerrainMarch : kFunctionMarch;
}

OpenedInput open_input(InputKind kind, const InputOptions& options, const std::string& ramp) {
  switch (kind) {
    case InputKind::terrain:
      return terrain(options);
    case InputKind::voxels:
      return voxels(options, ramp);
    case InputKind::scene:
      return scene_file(options);
    case InputKind::function:
      return function(options);
    case InputKind::mesh:
      break;
  }
  MeshInput mesh(options.inputs.front(), options.mesh);
  return {mesh.alone(), mesh.notes()};
}

}  // namespace scarp::cli
