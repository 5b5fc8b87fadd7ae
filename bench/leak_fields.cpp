// SPDX-License-Identifier: MIT
#include "bench/leak_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bench/random.h"

namespace scarp::bench {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

template <class T, class Height>
HeightField make(int cols, int rows, const HeightFieldSettings& settings, const Height& height) {
  std::vector<T> samples;
  samples.reserve(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) samples.push_back(static_cast<T>(height(col, row)));
  }
  return HeightField::own(std::move(samples), cols, rows, settings);
}

// Nodes next to a hole: all with a height and an adjacent hole cell.
std::vector<Node> rim_of(const HeightField& field) {
  std::vector<Node> rim;
  if (field.nodata_count() == 0) return rim;
  for (int row = 0; row < field.rows(); ++row) {
    for (int col = 0; col < field.cols(); ++col) {
      bool hole = false, ground = false;
      for (int dr = -1; dr <= 0; ++dr) {
        for (int dc = -1; dc <= 0; ++dc) {
          const Cell cell{col + dc, row + dr};
          if (cell.col < 0 || cell.row < 0 || cell.col >= field.cell_cols() || cell.row >= field.cell_rows()) continue;
          (field.cell_heights(cell) ? ground : hole) = true;
        }
      }
      if (hole && ground) rim.push_back({col, row});
    }
  }
  return rim;
}

}  // namespace

HoleCounts::HoleCounts(const HeightField& field) : stride_(field.cell_cols() + 1) {
  if (field.nodata_count() == 0) return;
  sums_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(field.cell_rows() + 1), 0);
  for (int row = 0; row < field.cell_rows(); ++row) {
    std::int32_t line = 0;
    for (int col = 0; col < field.cell_cols(); ++col) {
      line += field.cell_heights({col, row}) ? 0 : 1;
      const std::ptrdiff_t north = static_cast<std::ptrdiff_t>(row) * stride_ + col + 1;
      sums_[static_cast<std::size_t>(north + stride_)] = sums_[static_cast<std::size_t>(north)] + line;
    }
  }
}

bool HoleCounts::any(const CellBox& box) const {
  if (sums_.empty()) return false;
  const auto sum = [&](int col, int row) {
    return sums_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(row) * stride_ + col)];
  };
  return sum(box.col_end, box.row_end) - sum(box.col_begin, box.row_end) - sum(box.col_end, box.row_begin) +
             sum(box.col_begin, box.row_begin) >
         0;
}

std::vector<LeakField> make_leak_fields(std::uint64_t seed, int large, bool embree) {
  std::vector<LeakField> fields;
  const auto add = [&](std::string name, HeightField field, std::optional<ProceduralDem> generator = std::nullopt) {
    LeakField& added = fields.emplace_back(LeakField{std::move(name), std::move(field), std::move(generator)});
    added.rim = rim_of(added.field);
    const bool same_triangles =
        !added.field.wraps() && added.field.nodata_count() == 0 && !added.field.settings().solid;
    if (embree && same_triangles) {
      added.embree = std::make_unique<EmbreePeer>(added.field, EmbreeSurface::triangles, EmbreeQuality::high);
    }
  };
  // Each field has its own random sequence.
  const auto random = [&] { return Random(seed, ~static_cast<std::uint64_t>(fields.size())); };
  const auto rough = [&](int cols, int rows, const HeightFieldSettings& settings = {}) {
    Random r = random();
    return make<float>(cols, rows, settings, [&](int, int) { return r.uniform(0, 6); });
  };
  const auto shared = [](int i, int cells) { return i % cells; };

  add("rough, 2^n + 1", rough(65, 65));
  add("rough, 2^n", rough(64, 128));
  add("rough, prime", rough(61, 101));
  add("rough, strip", rough(509, 7));
  {
    const ProceduralDem dem{.cols = 257, .rows = 257, .seed = seed, .cell_m = 1};
    const std::vector<float> heights = generate_dem(dem);
    add("int16 terrain", make<std::int16_t>(257, 257, {.scale = 0.25}, [&](int c, int r) {
          return std::round(4 * heights[static_cast<std::size_t>(257 * r + c)]);
        }));
  }
  {
    Random r = random();
    std::vector<double> steps;
    for (int i = 0; i < 65; ++i) steps.push_back(r.below(2) * 1000.0);
    add("cliffs",
        make<float>(65, 63, {}, [&](int c, int q) { return steps[static_cast<std::size_t>((c + q / 16) % 65)]; }));
  }
  {
    Random r = random();
    add("spikes", make<float>(97, 89, {}, [&](int, int) { return r.below(25) == 0 ? 500.0 : 0.0; }));
  }
  {
    Random r = random();
    add("holes", make<float>(101, 89, {}, [&](int c, int q) {
          const double z = r.uniform(0, 5);
          const bool lake = std::abs(c - 50) < 12 && std::abs(q - 40) < 9;
          return lake || r.below(40) == 0 ? kNaN : z;
        }));
  }
  {
    Random r = random();
    const HeightFieldSettings settings{
        .cell_x = 30, .cell_y = 30, .scale = 0.1, .offset = 100, .exaggeration = 2.5, .nodata = -32768};
    add("int16, nodata, scaled", make<std::int16_t>(129, 127, settings, [&](int, int) {
          const int z = r.below(801) - 400;
          return r.below(30) == 0 ? -32768 : z;
        }));
  }
  add("oblong cells", rough(67, 131, {.cell_x = 6.75, .cell_y = 0.625, .exaggeration = 2.5}));
  add("decimal cells", rough(61, 47, {.cell_x = 30.7, .cell_y = 92.65}));
  const auto with_holes = [&](const char* name, HeightFieldSettings settings) {
    Random r = random();
    settings.cell_x = 7.7, settings.cell_y = 0.71;
    add(name, make<float>(93, 57, settings, [&](int, int) {
          const double z = r.uniform(0, 5);
          return r.below(30) == 0 ? kNaN : z;
        }));
  };
  with_holes("decimal cells, holes", {});
  with_holes("decimal cells, triangles, holes", {.surface = Surface::triangles});
  with_holes("decimal cells, solid, holes", {.solid = true});
  with_holes("decimal cells, periodic, holes", {.wrap = Wrap::periodic});
  add("high above the datum", rough(67, 61, {.cell_x = 0.5, .cell_y = 0.5, .offset = 1e6}));
  add("periodic", rough(64, 48, {.wrap = Wrap::periodic}));
  {
    Random r = random();
    std::vector<int> tile;
    for (int i = 0; i < 64 * 48; ++i) tile.push_back(r.below(40) - 20);
    add("int16, shared border", make<std::int16_t>(65, 49, {.wrap = Wrap::shared_border}, [&](int c, int q) {
          return tile[static_cast<std::size_t>(64 * shared(q, 48) + shared(c, 64))];
        }));
  }
  add("triangles", rough(65, 65, {.surface = Surface::triangles}));
  add("triangles, periodic", rough(61, 47, {.surface = Surface::triangles, .wrap = Wrap::periodic}));
  {
    Random r = random();
    add("triangles, holes", make<float>(83, 71, {.surface = Surface::triangles}, [&](int, int) {
          const double z = r.uniform(0, 5);
          return r.below(40) == 0 ? kNaN : z;
        }));
  }
  {
    Random r = random();
    add("solid, holes", make<float>(83, 71, {.solid = true}, [&](int, int) {
          const double z = r.uniform(0, 5);
          return r.below(40) == 0 ? kNaN : z;
        }));
  }
  add("plane", make<float>(64, 48, {.cell_x = 7.3, .cell_y = 5.1, .scale = 0.3},
                           [](int c, int r) { return 0.5 * c + 0.25 * r; }));
  add("saddles", make<float>(40, 40, {}, [](int c, int r) { return (c + r) % 2 ? 4.0 : 0.0; }));
  {
    const ProceduralDem dem{.cols = large, .rows = large, .seed = seed, .kind = TerrainKind::ridged, .cell_m = 1};
    add("large ridged", HeightField::own(generate_dem(dem), large, large), dem);
  }
  return fields;
}

}  // namespace scarp::bench
