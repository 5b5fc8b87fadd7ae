// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel/coarse_voxels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scarp/scene/voxel/ordered_pattern.h"

namespace scarp {
namespace {

// Number of the four columns along an axis that contain a voxel; children are bits x + 2 y + 4 z.
int columns(unsigned children, int axis) {
  constexpr std::array<unsigned, 3> kFirst = {0b01010101, 0b00110011, 0b00001111};
  const auto a = static_cast<std::size_t>(axis);
  unsigned seen = (children | children >> (1U << a)) & kFirst[a];
  int count = 0;
  for (; seen != 0; seen &= seen - 1) ++count;
  return count;
}

int covered(unsigned children) { return std::max({columns(children, 0), columns(children, 1), columns(children, 2)}); }

bool open(const VoxelGrid& grid, const ivec3& voxel) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      ivec3 beyond = voxel;
      beyond[axis] += step;
      if (!grid.box().contains(beyond) || !grid.solid(beyond)) return true;
    }
  }
  return false;
}

// Converts 8 bits by the sRGB standard's curve.
double linear(std::uint8_t value) {
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
std::uint32_t eight_bits(double linear) {
  const double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<std::uint32_t>(std::lround(std::clamp(v, 0.0, 1.0) * 255));
}

class Mean {
 public:
  Mean() {
    for (std::size_t i = 0; i < 256; ++i) linear_[i] = linear(static_cast<std::uint8_t>(i));
  }
  void clear() { sum_ = dvec3(0.0), count_ = 0; }
  void add(const VoxelColour& colour, double emission) {
    sum_ += (1 + emission) * dvec3(linear_[colour[0]], linear_[colour[1]], linear_[colour[2]]);
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  std::uint32_t rgb() const {
    const dvec3 mean = sum_ / static_cast<double>(count_);
    return eight_bits(mean.x) | eight_bits(mean.y) << 8 | eight_bits(mean.z) << 16;
  }

 private:
  std::array<double, 256> linear_{};
  dvec3 sum_{0.0};
  int count_ = 0;
};

VoxelGrid halved(const VoxelModel& model) {
  const VoxelGrid& fine = model.grid();
  VoxelGrid coarse((fine.size() + 1) / 2, 24);
  Mean mean;
  coarse.edit(coarse.box(), [&](const ivec3& block, const VoxelGrid::Voxel&) {
    std::array<ivec3, 8> children;
    unsigned solid = 0;
    for (int i = 0; i < 8; ++i) {
      ivec3& child = children[static_cast<std::size_t>(i)];
      child = 2 * block + ivec3(i & 1, i >> 1 & 1, i >> 2);
      if (fine.box().contains(child) && fine.solid(child)) solid |= 1U << i;
    }
    if (covered(solid) <= ordered_rank(block)) return VoxelGrid::Voxel();
    mean.clear();
    for (const bool all : {false, true}) {
      if (!mean.empty()) break;
      for (std::size_t i = 0; i < 8; ++i) {
        if ((solid >> i & 1) == 0 || !(all || open(fine, children[i]))) continue;
        const std::uint32_t entry = fine.entry(children[i]);
        mean.add(model.colour(entry), model.material(entry).emission);
      }
    }
    return VoxelGrid::Voxel(mean.rgb());
  });
  return coarse;
}

}  // namespace

std::shared_ptr<const VoxelModel> coarse_voxels(std::shared_ptr<const VoxelModel> model, int level) {
  for (; level > 0; --level) model = std::make_shared<const VoxelModel>(halved(*model), model->march());
  return model;
}

}  // namespace scarp
