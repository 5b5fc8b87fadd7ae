// SPDX-License-Identifier: MIT
#include "scarp/render/film/camera_fan.h"

#include <cstddef>
#include <cstdint>

namespace scarp {
void CameraSights::of(const PixelTile& tile, std::vector<FanSight>& to) const {
  to.clear();
  to.reserve(tile.pixels() * static_cast<std::size_t>(aa_ * aa_));
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      for (int j = 0; j < aa_; ++j) {
        const int row = (y - y0_) * aa_ + j;
        for (int column = (x - x0_) * aa_; column < (x - x0_ + 1) * aa_; ++column)
          to.push_back(
              sights_[static_cast<std::size_t>((column / kFanStrip * rows_ + row) * kFanStrip + column % kFanStrip)]);
      }
    }
  }
}

CameraFan::CameraFan(const Scene& scene, const Camera& camera, int rows, int aa)
    : rays_(camera.pixel_rays()), reach_(camera.reach()), aa_(aa) {
  if (camera.orthographic()) return;
  const std::optional<HeightTarget> target = scene.fan_target();
  Fan fan;
  fan.origin = rays_.origin;
  fan.columns = kFanStrip, fan.rows = rows * aa;
  fan.t_max = reach_;
  // Corners of the area in the middle, which crosses neither most lines nor fewest.
  const dvec2 size = camera.size();
  const dvec3 left = rays_.direction + 0.5 * (size.y - rows) * rays_.down;
  if (target && looks_by_fan(*target, fan, left, left + size.x * rays_.right + static_cast<double>(rows) * rays_.down))
    target_ = target;
}

void CameraFan::look(const PixelTile& area, CameraSights& to) const {
  const int rows = (area.y1 - area.y0) * aa_, strips = ((area.x1 - area.x0) * aa_ + kFanStrip - 1) / kFanStrip;
  to.x0_ = area.x0, to.y0_ = area.y0, to.aa_ = aa_, to.rows_ = rows;
  const std::size_t count = static_cast<std::size_t>(strips) * static_cast<std::size_t>(rows) * kFanStrip;
  to.sights_.resize(count);
  KeptVector<float> dx(count), dy(count), dz(count);
  const double step = 1.0 / aa_;
  std::size_t at = 0;
  for (int strip = 0; strip < strips; ++strip) {
    const dvec3 corner = rays_.direction + (area.x0 + (strip * kFanStrip + 0.5) * step) * rays_.right;
    for (int row = 0; row < rows; ++row) {
      const dvec3 left = corner + (area.y0 + (row + 0.5) * step) * rays_.down;
      for (int i = 0; i < kFanStrip; ++i, ++at) {
        const dvec3 d = left + i * step * rays_.right;
        dx[at] = static_cast<float>(d.x), dy[at] = static_cast<float>(d.y), dz[at] = static_cast<float>(d.z);
      }
    }
  }
  Fan fan;
  fan.origin = rays_.origin;
  fan.dx = dx.data(), fan.dy = dy.data(), fan.dz = dz.data();
  fan.columns = strips * kFanStrip, fan.rows = rows;
  fan.t_max = reach_;
  fan.row_stride = kFanStrip, fan.strip_stride = std::ptrdiff_t{kFanStrip} * rows;
  look_max_mip_fan(*target_, fan, to.sights_.data(), 0, fan.columns);
}

}  // namespace scarp
