// SPDX-License-Identifier: MIT
#include "scarp/analysis/sun_hours.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "scarp/analysis/clear_sky.h"
#include "scarp/analysis/horizon_state.h"
#include "scarp/analysis/tangent_planes.h"
#include "scarp/base/array_files.h"
#include "scarp/base/error.h"
#include "scarp/base/setting.h"

namespace scarp {

namespace {

// The beam at a node's height, interpolated between heights of equal distances. Its logarithm bends by less than
// (distance / 8434.5 m)^2 between them.
class BeamByHeight {
 public:
  static constexpr int kSteps = 32;

  BeamByHeight(const HeightField& field, const SunMoment& moment, const ClearSkyGround& ground)
      : lowest_(field.all_nodata() ? 0 : field.min_height()),
        step_(field.all_nodata() ? 1 : std::max((field.max_height() - field.min_height()) / kSteps, 0x1p-10)) {
    for (int i = 0; i <= kSteps + 1; ++i) {
      const double height = lowest_ + step_ * i;
      const ClearSky sky =
          clear_sky(moment.sun.altitude, height, moment.day_of_year, ground.linke, ground.transmittance);
      beam_.push_back(static_cast<float>(sky.beam));
    }
  }

  float at(float place) const {
    const auto i = static_cast<std::size_t>(place);
    return beam_[i] + (place - static_cast<float>(i)) * (beam_[i + 1] - beam_[i]);
  }
  // Where at() finds a height; it depends on the field alone.
  float place(double height) const {
    return static_cast<float>(std::clamp((height - lowest_) / step_, 0.0, static_cast<double>(kSteps)));
  }

 private:
  double lowest_, step_;
  std::vector<float> beam_;
};

// The energy of a block of nodes.
class EnergySums {
 public:
  EnergySums(const Horizons::State& state, const NodeRect& nodes, std::span<const SunMoment> moments,
             const ClearSkyGround& ground)
      : planes_(state.field, nodes, state.cells), ground_(ground) {
    const HeightField& field = state.field;
    for (const SunMoment& moment : moments) {
      beams_.emplace_back(field, moment, ground);
      const SunDirection& sun = moment.sun;
      towards_.push_back({static_cast<float>(std::sin(sun.azimuth) * std::cos(sun.altitude)),
                          static_cast<float>(std::cos(sun.azimuth) * std::cos(sun.altitude)),
                          static_cast<float>(std::sin(sun.altitude))});
      const double diffuse = clear_sky(sun.altitude, 0, moment.day_of_year, ground.linke, ground.transmittance).diffuse;
      diffuse_ += moment.hours * diffuse / 1000;
    }
    std::vector<float> heights(static_cast<std::size_t>(nodes.col_end - nodes.col_begin));
    places_.reserve(nodes.count());
    for (int row = nodes.row_begin; row < nodes.row_end; ++row) {
      state.relief->copy_heights(nodes.col_begin, row, static_cast<int>(heights.size()), heights.data());
      for (const float height : heights) {
        const bool hole = std::isnan(height) || moments.empty();
        places_.push_back(hole ? 0 : beams_.front().place(static_cast<double>(height)));
      }
    }
    sums_.resize(places_.size());
  }

  // Adds the beam of a moment on the lit nodes among some neighbours.
  void add(std::size_t moment, std::size_t node, std::size_t count, double hours, const float* slopes, float sun) {
    const Direction& to = towards_[moment];
    ArrayPiece<const float> east(&planes_.east[node], count), north(&planes_.north[node], count),
        level(&planes_.level[node], count), places(&places_[node], count);
    ArrayPiece sums(&sums_[node], count);
    for (std::size_t i = 0; i < count; ++i) {
      if (!(slopes[i] <= sun)) continue;
      const float cosine = east[i] * to.east + north[i] * to.north + level[i] * to.up;
      if (cosine > 0) sums[i] += hours / 1000 * static_cast<double>(cosine * beams_[moment].at(places[i]));
    }
  }

  SunEnergy total(std::span<const SunMoment> moments, const std::vector<float>& hours) const {
    // The beam on level ground by height.
    std::vector<double> level(BeamByHeight::kSteps + 2);
    for (std::size_t m = 0; m < moments.size(); ++m) {
      for (std::size_t i = 0; i + 1 < level.size(); ++i)
        level[i] += moments[m].hours / 1000 * static_cast<double>(towards_[m].up * beams_[m].at(static_cast<float>(i)));
    }
    SunEnergy energy;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const double hole = std::isnan(hours[i]) ? std::numeric_limits<double>::quiet_NaN() : 0;
      const double seen = static_cast<double>(ground_.sky_view_factor[i]), place = static_cast<double>(places_[i]);
      const auto at = static_cast<std::size_t>(place);
      const double beam = level[at] + (place - static_cast<double>(at)) * (level[at + 1] - level[at]);
      energy.beam.push_back(static_cast<float>(sums_[i] + hole));
      energy.diffuse.push_back(static_cast<float>(diffuse_ * seen + hole));
      energy.reflected.push_back(static_cast<float>(ground_.albedo * (beam + diffuse_) * (1 - seen) + hole));
    }
    return energy;
  }

 private:
  struct Direction {
    float east, north, up;
  };
  const TangentPlanes planes_;
  const ClearSkyGround& ground_;
  std::vector<BeamByHeight> beams_;
  std::vector<Direction> towards_;
  double diffuse_ = 0;         // kWh on the horizontal
  std::vector<float> places_;  // of nodes, for BeamByHeight
  std::vector<double> sums_;
};

void validate(const ClearSkyGround& ground, std::size_t nodes) {
  require_setting("sun energy", ground.linke >= 1 && ground.linke <= 8, "Linke turbidity", ground.linke, "1 to 8");
  const double through = ground.transmittance.value_or(1);
  require_setting("sun energy", through > 0 && through <= 1, "transmittance", through, "above 0, at most 1");
  require_setting("sun energy", ground.albedo >= 0 && ground.albedo <= 1, "albedo", ground.albedo, "0 to 1");
  if (ground.sky_view_factor.size() != nodes) throw Error("sun energy: expected a sky view factor for each node");
}

}  // namespace

SunHours sun_hours(const Horizons& horizons, std::span<const SunMoment> moments, int first, int last,
                   const ClearSkyGround* ground, const Progress& progress) {
  return sun_hours(horizons, moments, {0, first, state_of(horizons).field.cols(), last}, ground, progress);
}

SunHours sun_hours(const Horizons& horizons, std::span<const SunMoment> moments, const NodeRect& nodes,
                   const ClearSkyGround* ground, const Progress& progress) {
  for (const SunMoment& moment : moments) {
    require_setting("sun hours", std::isfinite(moment.sun.azimuth), "sun azimuth", moment.sun.azimuth, "finite");
    require_setting("sun hours", moment.sun.altitude > 0 && moment.sun.altitude <= std::numbers::pi / 2, "sun altitude",
                    moment.sun.altitude, "above 0, at most pi/2");
    require_setting("sun hours", std::isfinite(moment.hours), "length of a moment", moment.hours, "finite");
  }
  const auto& state = state_of(horizons);
  require_nodes(state.field, nodes);
  const std::ptrdiff_t cols = nodes.col_end - nodes.col_begin;
  // Together: where they lie in files, a piece of them is one piece of a file.
  struct Lit {
    double hours;  // NaN on holes
    std::int32_t first, last;
  };
  std::vector<Lit> lit;
  lit.reserve(nodes.count());
  std::vector<float> heights(static_cast<std::size_t>(cols));
  for (int row = nodes.row_begin; row < nodes.row_end; ++row) {
    state.relief->copy_heights(nodes.col_begin, row, static_cast<int>(cols), heights.data());
    for (const float height : heights)
      lit.push_back({std::isnan(height) ? std::numeric_limits<double>::quiet_NaN() : 0, -1, -1});
  }
  std::optional<EnergySums> energy;
  if (ground) {
    validate(*ground, lit.size());
    energy.emplace(state, nodes, moments, *ground);
  }
  SunHours found;
  std::vector<double> azimuths;
  for (const SunMoment& moment : moments) azimuths.push_back(moment.sun.azimuth);
  const auto add = [&](const HorizonBlock& block) {
    const SunMoment& moment = moments[block.azimuth];
    const auto sun = static_cast<float>(std::tan(moment.sun.altitude));
    const auto width = static_cast<std::size_t>(block.nodes.col_end - block.nodes.col_begin);
    const float* slopes = block.slopes;
    for (int row = block.nodes.row_begin; row < block.nodes.row_end; ++row, slopes += width) {
      const auto at =
          static_cast<std::size_t>((row - nodes.row_begin) * cols + block.nodes.col_begin - nodes.col_begin);
      ArrayPiece piece(&lit[at], width);
      for (std::size_t i = 0; i < width; ++i) {
        if (!(slopes[i] <= sun)) continue;  // holes, too
        Lit& node = piece[i];
        node.hours += moment.hours, node.last = static_cast<std::int32_t>(block.azimuth);
        if (node.first < 0) node.first = node.last;
      }
      if (energy) energy->add(block.azimuth, at, width, moment.hours, slopes, sun);
    }
  };
  for_each_horizon(state, *state.relief, azimuths, nodes, add, progress);
  found.hours.reserve(lit.size()), found.first.reserve(lit.size()), found.last.reserve(lit.size());
  for (const Lit& node : lit) {
    found.hours.push_back(static_cast<float>(node.hours));
    found.first.push_back(node.first), found.last.push_back(node.last);
  }
  if (energy) found.energy = energy->total(moments, found.hours);
  return found;
}

}  // namespace scarp
