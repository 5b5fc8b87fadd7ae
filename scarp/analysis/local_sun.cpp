// SPDX-License-Identifier: MIT
#include "scarp/analysis/local_sun.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "scarp/analysis/sun_disc.h"
#include "scarp/base/ellipsoid.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

// The nodes [first, first + count) of an axis of `nodes`, and their neighbours: on an axis of one node, both neighbours
// are outside the field.
struct Reach {
  int first, count;
  Reach(int from, int to, int nodes)
      : first(nodes > 1 ? std::max(from - 1, 0) : -1), count((nodes > 1 ? std::min(to + 1, nodes) : 2) - first) {}
  int clamp(int i) const { return std::clamp(i, first, first + count - 1); }
};

// Places of some rows.
class Places {
 public:
  Places(const HeightField& field, const LocalSun& sun, int first_row, int last_row)
      : cols_(0, field.cols(), field.cols()),
        rows_(first_row, last_row, field.rows()),
        places_(static_cast<std::size_t>(cols_.count) * static_cast<std::size_t>(rows_.count)) {
    for (int row = rows_.first; row < rows_.first + rows_.count; ++row)
      sun.places(row, cols_.first, std::span(places_).subspan(index(cols_.first, row), cols_.count));
  }
  const dvec3& at(int col, int row) const { return places_[index(col, row)]; }
  NodeSteps steps(Node node) const {
    const int west = cols_.clamp(node.col - 1), east = cols_.clamp(node.col + 1);
    const int north = rows_.clamp(node.row - 1), south = rows_.clamp(node.row + 1);
    return node_steps(at(node.col, node.row), at(west, node.row), at(east, node.row), east - west, at(node.col, north),
                      at(node.col, south), south - north);
  }

 private:
  std::size_t index(int col, int row) const {
    return static_cast<std::size_t>(row - rows_.first) * static_cast<std::size_t>(cols_.count) +
           static_cast<std::size_t>(col - cols_.first);
  }
  Reach cols_, rows_;
  std::vector<dvec3> places_;
};

// Sets every value of a map to value(node, steps, sun at the node), or to `hole`.
template <class T, class Value>
std::vector<T> map_of(const SunGround& ground, const LocalSun& sun, const RowBand& band, T hole,
                      const Progress& progress, const Value& value) {
  const HeightField& field = ground.field();
  require_band(field, band);
  const std::optional<SunAtTime> sky = sun.fixed ? std::nullopt : std::optional<SunAtTime>(std::in_place, sun.time);
  const auto cols = static_cast<std::size_t>(field.cols());
  std::vector<T> map(cols * static_cast<std::size_t>(band.rows()), hole);
  constexpr std::int64_t kGrain = 16;  // rows
  parallel_for(
      band.rows(), kGrain,
      [&](std::int64_t begin, std::int64_t end) {
        const int first = band.first + static_cast<int>(begin), last = band.first + static_cast<int>(end);
        const Places places(field, sun, first, last);
        for (int row = first; row < last; ++row)
          for (int col = 0; col < field.cols(); ++col) {
            const Node node{col, row};
            const auto height = ground.heights().height(node);
            if (!height) continue;
            const dvec3& at = places.at(col, row);
            const SunPosition here = sky ? sky->at({at.x * kRadians, at.y * kRadians, *height}, sun.refraction)
                                         : SunPosition{sun.fixed->azimuth, sun.fixed->altitude};
            map[static_cast<std::size_t>(row - band.first) * cols + static_cast<std::size_t>(col)] =
                value(node, places.steps(node), here);
          }
      },
      progress);
  return map;
}

}  // namespace

NodeSteps node_steps(const dvec3& here, const dvec3& west, const dvec3& east, int cols, const dvec3& north,
                     const dvec3& south, int rows) {
  constexpr Ellipsoid kEarth;
  const double lon = here.x * kRadians, lat = here.y * kRadians;
  const dvec3 to_east = east_of(lon), to_north = north_of(lon, lat);
  const auto step = [&](const dvec3& from, const dvec3& to, int steps) {
    const dvec3 way =
        (kEarth.point(to.x * kRadians, to.y * kRadians) - kEarth.point(from.x * kRadians, from.y * kRadians)) /
        static_cast<double>(steps);
    return dvec2(dot(way, to_east), dot(way, to_north));
  };
  return {step(west, east, cols), step(north, south, rows)};
}

std::vector<Shade> local_shadow(const SunGround& ground, const LocalSun& sun, const RowBand& band,
                                const Progress& progress) {
  return map_of(ground, sun, band, Shade::hole, progress,
                [&](Node node, const NodeSteps& steps, const SunPosition& at) {
                  if (at.altitude <= 0) return Shade::self_shaded;
                  return ground.shade(sun_ray(steps, {at.azimuth, at.altitude}), node);
                });
}

std::vector<float> local_lit_share(const SunGround& ground, const LocalSun& sun, const RowBand& band,
                                   const Progress& progress) {
  return map_of(ground, sun, band, kNoShare, progress, [&](Node node, const NodeSteps& steps, const SunPosition& at) {
    const auto strips = sun_strips();
    const auto is_dark = [&](const SunStrip& strip) {
      const double altitude = at.altitude + strip.rise;
      return altitude <= 0 || ground.shade(sun_ray(steps, {at.azimuth, altitude}), node) != Shade::lit;
    };
    const auto is_up = [&](const SunStrip& strip) { return at.altitude + strip.rise <= std::numbers::pi / 2; };
    // A strip above a lit strip is lit: its ray is higher at every crossing.
    const auto end = std::partition_point(strips.begin(), strips.end(), is_up);
    float lit = 0;
    for (auto strip = std::partition_point(strips.begin(), end, is_dark); strip != end; ++strip) lit += strip->share;
    return lit;
  });
}

}  // namespace scarp
