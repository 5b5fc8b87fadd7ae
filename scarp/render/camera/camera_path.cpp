// SPDX-License-Identifier: MIT
#include "scarp/render/camera/camera_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// Between two stations with the same eye, only the target moves; it takes this long.
constexpr double kLeastKnot = 1e-3;

struct Knots {
  double t[4];
};

// The pyramid of linear interpolations by Barry and Goldman (1988) between p[1] and p[2].
dvec3 spline(const dvec3 (&p)[4], const Knots& k, double t) {
  dvec3 a[3], b[2];
  for (int i = 0; i < 3; ++i) {
    const double s = (t - k.t[i]) / (k.t[i + 1] - k.t[i]);
    a[i] = p[i] * (1 - s) + p[i + 1] * s;
  }
  for (int i = 0; i < 2; ++i) {
    const double s = (t - k.t[i]) / (k.t[i + 2] - k.t[i]);
    b[i] = a[i] * (1 - s) + a[i + 1] * s;
  }
  const double s = (t - k.t[1]) / (k.t[2] - k.t[1]);
  return b[0] * (1 - s) + b[1] * s;
}

}  // namespace

CameraPath::CameraPath(std::vector<CameraStation> stations) : stations_(std::move(stations)) {
  if (stations_.empty()) throw Error("camera path: has no stations; at least one is needed");
  knots_.push_back(0);
  for (std::size_t i = 1; i < stations_.size(); ++i) {
    knots_.push_back(knots_.back() + std::max(kLeastKnot, std::sqrt(length(stations_[i].eye - stations_[i - 1].eye))));
  }
}

CameraStation CameraPath::at(double share) const {
  if (stations_.size() == 1) return stations_.front();
  const double t = std::clamp(share, 0.0, 1.0) * knots_.back();
  const auto above = std::upper_bound(knots_.begin(), knots_.end() - 1, t);
  const std::size_t i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, above - knots_.begin())) - 1;
  // Beyond its ends the path is extrapolated.
  dvec3 eyes[4], targets[4];
  Knots knots{};
  for (int j = 0; j < 4; ++j) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) + j - 1,
                         last = static_cast<std::ptrdiff_t>(knots_.size()) - 1;
    if (at < 0) {
      eyes[j] = 2.0 * stations_[0].eye - stations_[1].eye;
      targets[j] = 2.0 * stations_[0].target - stations_[1].target;
      knots.t[j] = -knots_[1];
    } else if (at > last) {
      const auto l = static_cast<std::size_t>(last);
      eyes[j] = 2.0 * stations_[l].eye - stations_[l - 1].eye;
      targets[j] = 2.0 * stations_[l].target - stations_[l - 1].target;
      knots.t[j] = 2 * knots_[l] - knots_[l - 1];
    } else {
      const auto a = static_cast<std::size_t>(at);
      eyes[j] = stations_[a].eye;
      targets[j] = stations_[a].target;
      knots.t[j] = knots_[a];
    }
  }
  return {spline(eyes, knots, t), spline(targets, knots, t)};
}

}  // namespace scarp
