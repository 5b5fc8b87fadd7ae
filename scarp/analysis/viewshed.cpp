// SPDX-License-Identifier: MIT
#include "scarp/analysis/viewshed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scarp/analysis/viewshed_sweep.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/setting.h"

namespace scarp {
namespace {

constexpr double kPi = std::numbers::pi;

bool is_azimuth(double a) { return a >= 0 && a <= 2 * kPi; }
bool is_pitch(double a) { return a >= -kPi / 2 && a <= kPi / 2; }

}  // namespace

void validate(const ViewshedSettings& s) {
  const auto require = [](bool good, std::string_view what, double value, std::string_view range) {
    require_setting("viewshed", good, what, value, range);
  };
  require(s.observer_height >= 0 && std::isfinite(s.observer_height), "observer height", s.observer_height, ">= 0");
  require(!s.observer_z || std::isfinite(*s.observer_z), "observer height above sea", s.observer_z.value_or(0),
          "finite");
  require(s.target_height >= 0 && std::isfinite(s.target_height), "target height", s.target_height, ">= 0");
  validate(s.curvature);
  require(s.min_distance >= 0 && std::isfinite(s.min_distance), "minimum distance", s.min_distance, ">= 0");
  require(s.max_distance >= s.min_distance, "maximum distance", s.max_distance, ">= the minimum");
  require(is_azimuth(s.first_azimuth), "first azimuth", s.first_azimuth, "0..2pi");
  require(is_azimuth(s.last_azimuth), "last azimuth", s.last_azimuth, "0..2pi");
  require(is_pitch(s.low_pitch), "low pitch", s.low_pitch, "-pi/2..pi/2");
  require(is_pitch(s.high_pitch) && s.high_pitch >= s.low_pitch, "high pitch", s.high_pitch, "low pitch..pi/2");
}

Viewpoint::Viewpoint(const HeightField& field, Node observer, const ViewshedSettings& settings)
    : settings_(settings), observer_(observer), ground_(field, observer.col, observer.row, settings.curvature) {
  validate(settings);
  if (observer.col < 0 || observer.row < 0 || observer.col >= field.cols() || observer.row >= field.rows())
    throw Error(fmt::format("viewshed: observer at column {}, row {} is outside the field of {} x {} samples",
                            observer.col, observer.row, field.cols(), field.rows()));
  const auto height = ground_.height(observer);
  if (!height && !settings.observer_z)
    throw Error(fmt::format("viewshed: observer at column {}, row {} is on nodata (give its height above sea)",
                            observer.col, observer.row));
  eye_ = settings.observer_z ? *settings.observer_z : *height + settings.observer_height;
  if (height && eye_ < *height && !settings.under_surface)
    throw Error(fmt::format("viewshed: observer at {} m is below the ground at {} m", eye_, *height));
  limits_distance_ = settings.min_distance > 0 || std::isfinite(settings.max_distance);
  limits_azimuth_ = settings.first_azimuth > 0 || settings.last_azimuth < 2 * kPi;
  limits_pitch_ = settings.low_pitch > -kPi / 2 || settings.high_pitch < kPi / 2;
}

double Viewpoint::pitch(Node node, double target) const {
  return std::atan2(target - eye_, std::sqrt(ground_.square_distance(node.col, node.row)));
}

bool Viewpoint::in_range(Node node, double target) const {
  if (!has_limits()) return true;
  const double square = ground_.square_distance(node.col, node.row);
  if (limits_distance_ && (square < settings_.min_distance * settings_.min_distance ||
                           square > settings_.max_distance * settings_.max_distance))
    return false;
  // The observer's own node lies in every direction.
  if (node == observer_) return true;
  if (limits_azimuth_) {
    const auto& cell = ground_.field().settings();
    const double azimuth =
        compass_azimuth((node.col - observer_.col) * cell.cell_x, (observer_.row - node.row) * cell.cell_y);
    const double first = settings_.first_azimuth, last = settings_.last_azimuth;
    if (first <= last ? azimuth < first || azimuth > last : azimuth < first && azimuth > last) return false;
  }
  if (limits_pitch_) {
    const double angle = pitch(node, target);
    if (angle < settings_.low_pitch || angle > settings_.high_pitch) return false;
  }
  return true;
}

std::vector<Seen> viewshed(const HeightField& field, Node observer, const ViewshedSettings& settings,
                           const Progress& progress) {
  const Viewpoint view(field, observer, settings);
  std::vector<Seen> codes(static_cast<std::size_t>(field.cols()) * static_cast<std::size_t>(field.rows()));
  sweep_viewshed(view, codes.data(), progress);
  return codes;
}

std::vector<double> least_visible(const HeightField& field, Node observer, const ViewshedSettings& settings,
                                  const Progress& progress) {
  const Viewpoint view(field, observer, settings);
  std::vector<double> least(static_cast<std::size_t>(field.cols()) * static_cast<std::size_t>(field.rows()));
  sweep_least_visible(view, least.data(), progress);
  return least;
}

std::vector<float> sight_angles(const Viewpoint& view, std::span<const Seen> codes, int first_row) {
  constexpr double kDegrees = 180 / kPi;
  const auto cols = static_cast<std::size_t>(view.ground().field().cols());
  std::vector<float> angles(codes.size(), std::numeric_limits<float>::quiet_NaN());
  constexpr std::int64_t kGrain = 16;  // rows
  parallel_for(static_cast<std::int64_t>(codes.size() / cols), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::size_t i = static_cast<std::size_t>(begin) * cols; i < static_cast<std::size_t>(end) * cols; ++i) {
      if (codes[i] != Seen::visible) continue;
      const Node node{static_cast<int>(i % cols), first_row + static_cast<int>(i / cols)};
      if (const auto lowered = view.ground().lowered(node))
        angles[i] = static_cast<float>(kDegrees * view.pitch(node, view.target(*lowered)));
    }
  });
  return angles;
}

float least_height(const SightGround& ground, Node node, double least_visible, HeightDatum datum) {
  const auto height = ground.height(node);
  if (!height || std::isnan(least_visible)) return std::numeric_limits<float>::quiet_NaN();
  const double lowered = ground.lowered(*height, node.col, node.row);
  if (datum == HeightDatum::ground) return static_cast<float>(std::max(0.0, least_visible - lowered));
  return static_cast<float>(least_visible <= lowered ? *height : least_visible + ground.drop(node.col, node.row));
}

}  // namespace scarp
