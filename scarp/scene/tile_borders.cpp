// SPDX-License-Identifier: MIT
// Borders shared by tiles: both tiles have the same samples there, and a finer tile is stitched to a coarser one.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "scarp/base/error.h"
#include "scarp/scene/tile_map.h"

namespace scarp {
namespace {

// A sample as a double, NaN for a hole.
double sample_at(const HeightField& field, int col, int row) {
  return field.visit([&](const auto& grid) {
    const auto sample = grid.at(col, row);
    return grid.is_nodata(sample) ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(sample);
  });
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

struct Side {
  int dcol, drow;  // to the adjacent tile
};
constexpr std::array<Side, 4> kSides{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
constexpr std::array<Side, 4> kDiagonals{{{-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};

// Sample `index` of a tile's border on this side.
double on_border(const Tile& tile, Side side, int index) {
  const HeightField& field = tile.given;
  if (side.dcol != 0) return sample_at(field, side.dcol < 0 ? 0 : field.cols() - 1, index);
  return sample_at(field, index, side.drow < 0 ? 0 : field.rows() - 1);
}

int border_samples(const Tile& tile, Side side) { return side.dcol != 0 ? tile.given.rows() : tile.given.cols(); }

std::string shown(double sample) { return std::isnan(sample) ? "a hole" : fmt::format("{}", sample); }

[[noreturn]] void refuse(int col, int row, Side side, double here, double beside) {
  throw Error(
      fmt::format("tiles: ({}, {}) and ({}, {}) differ at a sample of their border: {} and {} (tiles that meet "
                  "share the samples of their border)",
                  col, row, col + side.dcol, row + side.drow, shown(here), shown(beside)));
}

// A copy of a tile's samples as float32, and the rounding of the samples on straight lines.
struct Stitched {
  int cols, rows;
  std::vector<float> samples;
  double step = 0;

  float& at(int col, int row) {
    return samples[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)];
  }
};

void stitch(Stitched& to, Side side, const Tile& coarser, int level) {
  const Side back{-side.dcol, -side.drow};
  const int apart = 1 << (coarser.level - level);
  for (int i = 0; i + 1 < border_samples(coarser, back); ++i) {
    const double first = on_border(coarser, back, i), second = on_border(coarser, back, i + 1);
    // At the rim of a hole the coarser tile has no ground to match.
    if (std::isnan(first) || std::isnan(second)) continue;
    for (int j = 1; j < apart; ++j) {
      const int at = i * apart + j;
      const int col = side.dcol == 0 ? at : side.dcol < 0 ? 0 : to.cols - 1;
      const int row = side.drow == 0 ? at : side.drow < 0 ? 0 : to.rows - 1;
      float& sample = to.at(col, row);
      if (std::isnan(sample)) continue;  // a hole in the finer tile remains a hole
      const double line = first + (second - first) * j / apart;
      sample = static_cast<float>(line);
      to.step = std::max(to.step, std::abs(sample - line));
    }
  }
}

}  // namespace

void require_same_border(const TileMap& map, int col, int row) {
  const Tile* tile = map.find(col, row);
  if (!tile) return;
  for (const Side side : kSides) {
    const Tile* beside = map.find(col + side.dcol, row + side.drow);
    if (!beside) continue;
    const Side back{-side.dcol, -side.drow};
    const int level = std::max(tile->level, beside->level);
    const int apart = 1 << (level - tile->level), apart_beside = 1 << (level - beside->level);
    const int count = (border_samples(*tile, side) - 1) / apart + 1;
    for (int i = 0; i < count; ++i) {
      const double here = on_border(*tile, side, i * apart), there = on_border(*beside, back, i * apart_beside);
      if (!same(here, there)) refuse(col, row, side, here, there);
    }
  }
  for (const Side side : kDiagonals) {
    const Tile* beside = map.find(col + side.dcol, row + side.drow);
    if (!beside) continue;
    const auto corner = [](const HeightField& field, int dcol, int drow) {
      return sample_at(field, dcol < 0 ? 0 : field.cols() - 1, drow < 0 ? 0 : field.rows() - 1);
    };
    const double here = corner(tile->given, side.dcol, side.drow);
    const double there = corner(beside->given, -side.dcol, -side.drow);
    if (!same(here, there)) refuse(col, row, side, here, there);
  }
}

void build_ground(const TileMap& map, int col, int row, Tile& tile) {
  const auto coarser = [&](Side side) -> const Tile* {
    const Tile* beside = map.find(col + side.dcol, row + side.drow);
    return beside && beside->level > tile.level ? beside : nullptr;
  };
  tile.stitched = std::any_of(kSides.begin(), kSides.end(), coarser);
  tile.own_step = 0;
  if (!tile.stitched) {
    tile.ground = std::make_shared<const TileGround>(tile.given);
    return;
  }
  Stitched to{tile.given.cols(), tile.given.rows(), {}};
  to.samples.reserve(static_cast<std::size_t>(to.cols) * static_cast<std::size_t>(to.rows));
  for (int r = 0; r < to.rows; ++r)
    for (int c = 0; c < to.cols; ++c) to.samples.push_back(static_cast<float>(sample_at(tile.given, c, r)));
  for (const Side side : kSides) {
    if (const Tile* beside = coarser(side)) stitch(to, side, *beside, tile.level);
  }
  tile.own_step = to.step;
  HeightFieldSettings settings = tile.given.settings();
  settings.nodata.reset();  // holes are NaN
  tile.ground = std::make_shared<const TileGround>(HeightField::own(std::move(to.samples), to.cols, to.rows, settings));
}

}  // namespace scarp
