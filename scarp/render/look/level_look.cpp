// SPDX-License-Identifier: MIT
#include "scarp/render/look/level_look.h"

#include <fmt/format.h>

#include <algorithm>

#include "scarp/base/error.h"

namespace scarp {
namespace {

const HeightField& field_of(const Scene& scene) {
  const HeightField* field = scene.only_heights();
  if (!field) throw Error("picture: the look level needs a single height field");
  return *field;
}

}  // namespace

LevelMaxima::LevelMaxima(const Scene& scene, int level) : field_(field_of(scene)), level_(level), pyramid_(field_) {
  if (level > pyramid_.top_level()) {
    throw Error(fmt::format("picture: there is no level {} (the pyramid over {} x {} cells has levels 0 to {})", level,
                            field_.cell_cols(), field_.cell_rows(), pyramid_.top_level()));
  }
}

double LevelMaxima::over(const Cell& cell) const {
  if (level_ > 0) return field_.height_from_sample(pyramid_.maximum(level_, cell.col >> level_, cell.row >> level_));
  const CellHeights h = field_.cell_heights(cell).value();
  return field_.height_from_sample(std::max({h.h00, h.h10, h.h01, h.h11}));
}

}  // namespace scarp
