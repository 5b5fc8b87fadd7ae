// SPDX-License-Identifier: MIT
#include "scarp/scene/file/to_vox.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr int kModelSide = 256, kRgbBits = 24;
constexpr std::size_t kMostPaletteColours = 255;
constexpr int kReds = 6, kGreens = 7, kBlues = 6;

// The step of a byte nearest to a value.
int step(std::uint32_t byte, int steps) { return (static_cast<int>(byte) * (steps - 1) + 127) / 255; }
std::uint8_t of_step(int i, int steps) { return static_cast<std::uint8_t>((i * 255 + (steps - 1) / 2) / (steps - 1)); }

class Palette {
 public:
  explicit Palette(const VoxelGrid& grid) {
    for_each_voxel(grid.bounds(), [&](const ivec3& v) {
      if (!grid.solid(v) || known_.size() > kMostPaletteColours) return;
      const auto next = static_cast<int>(known_.size());
      known_.try_emplace(grid.entry(v), next);
    });
    exact_ = known_.size() <= kMostPaletteColours;
  }
  bool exact() const { return exact_; }

  std::uint8_t index(std::uint32_t rgb) const {
    if (exact_) return static_cast<std::uint8_t>(1 + known_.at(rgb));
    const int r = step(rgb & 255, kReds), g = step(rgb >> 8 & 255, kGreens), b = step(rgb >> 16 & 255, kBlues);
    return static_cast<std::uint8_t>(1 + b + kBlues * (g + kGreens * r));
  }
  VoxPalette colours() const {
    VoxPalette colours{};
    if (exact_) {
      for (const auto& [rgb, i] : known_) {
        colours[static_cast<std::size_t>(i)] = {static_cast<std::uint8_t>(rgb), static_cast<std::uint8_t>(rgb >> 8),
                                                static_cast<std::uint8_t>(rgb >> 16), 255};
      }
      return colours;
    }
    for (std::size_t i = 0; i < kReds * kGreens * kBlues; ++i) {
      const auto n = static_cast<int>(i);
      colours[i] = {of_step(n / (kBlues * kGreens), kReds), of_step(n / kBlues % kGreens, kGreens),
                    of_step(n % kBlues, kBlues), 255};
    }
    return colours;
  }

 private:
  std::map<std::uint32_t, int> known_;
  bool exact_ = true;
};

VoxModel model_of(const VoxelGrid& grid, const VoxelBox& box, const Palette& palette) {
  VoxModel model{box.high - box.low, {}};
  for_each_voxel(box, [&](const ivec3& v) {
    if (!grid.solid(v)) return;
    const ivec3 at = v - box.low;
    model.voxels.push_back({static_cast<std::uint8_t>(at.x), static_cast<std::uint8_t>(at.y),
                            static_cast<std::uint8_t>(at.z), palette.index(grid.entry(v))});
  });
  return model;
}

}  // namespace

VoxFile vox_file_of(const VoxelGrid& grid, const ivec3& low, bool& exact_colours) {
  if (grid.entry_bits() != kRgbBits) throw Error("vox: the grid's entries must be RGB, 24 bits");
  if (grid.solid_count() == 0) throw Error("vox: there is no solid voxel to write");
  const Palette palette(grid);
  exact_colours = palette.exact();
  VoxFile file;
  file.version = 200;
  file.palette = palette.colours();
  // A transform over a group, and for each model a transform and a shape.
  file.nodes = {{0, {}, VoxTransform{1}}, {1, {}, VoxGroup{}}};
  std::vector<int> children;
  const ivec3 models = (grid.size() + (kModelSide - 1)) / kModelSide;
  for_each_voxel({ivec3(0), models}, [&](const ivec3& i) {
    const VoxelBox box = intersection({i * kModelSide, (i + 1) * kModelSide}, grid.bounds());
    if (box.empty()) return;
    VoxModel model = model_of(grid, box, palette);
    if (model.voxels.empty()) return;
    const ivec3 move = low + box.low + model.size / 2;
    const int node = static_cast<int>(file.nodes.size()), index = static_cast<int>(file.models.size());
    VoxTransform transform{node + 1};
    transform.frames = {{{"_t", fmt::format("{} {} {}", move.x, move.y, move.z)}}};
    VoxShape shape;
    shape.models = {{index, {}}};
    file.nodes.push_back({node, {}, transform});
    file.nodes.push_back({node + 1, {}, shape});
    file.models.push_back(std::move(model));
    children.push_back(node);
  });
  file.nodes[1].content = VoxGroup{children};
  return file;
}

}  // namespace scarp
