// SPDX-License-Identifier: MIT
// How much sky each node of a field sees, from its horizons in a number of azimuths.
//
//   sky fraction        solid angle of the visible sky / 2 pi          mean of 1 - sin h
//   sky view factor     share of the radiation of a uniform sky that reaches the ground, whose slope b and aspect a
//                       are those of the central differences at the node:
//                         mean of cos b sin^2 H + sin b cos(azimuth - a) (H - sin H cos H),   H = pi/2 - h
//   positive openness   mean of H, horizons below the horizontal included; radians
//   negative openness   the same over the ground upside down, which curves the other way, too
//
// h is the horizon, at least 0 in the first two. Where a line of sight meets no ground (a node at the border that looks
// out), the horizon is level. Three different quantities are called "sky view factor"; their names here are those of
// the papers:
// - sky fraction: K. Zaksek, K. Ostir, Z. Kokalj, "Sky-View Factor as a Relief Visualization Technique", Remote Sensing
//   3(2), 2011. It writes 1 - mean of sin h as well.
// - sky view factor: J. Dozier, J. Frew, "Rapid calculation of terrain parameters for radiation modeling from digital
//   elevation data", IEEE Transactions on Geoscience and Remote Sensing 28(5), 1990, equation 7b.
// - openness: R. Yokoyama, M. Shirasawa, R. J. Pike, "Visualizing topography by openness", Photogrammetric Engineering
//   and Remote Sensing 68(3), 2002.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scarp/analysis/horizon.h"

namespace scarp {

enum class SkyMeasure : std::uint8_t { sky_fraction, sky_view_factor, positive_openness, negative_openness };

class SkyView {
 public:
  /// `azimuths`: number of directions, equally spaced from grid north on, 1 to 3600. Throws as Horizons does. Negative
  /// openness needs a second copy of the heights, upside down.
  SkyView(const HeightField& field, const HorizonSettings& settings, int azimuths, std::vector<SkyMeasure> measures,
          const Progress& progress = {});
  ~SkyView();
  SkyView(SkyView&&) noexcept;

  /// Rows [first, last) of each measure, from north to south; NaN on holes. Runs on all threads. Throws as
  /// Horizons::rows() does.
  std::vector<std::vector<float>> rows(int first, int last, const Progress& progress = {}) const;

  /// The same of a block of nodes, at least one: nodes.count() values of each measure, in rows of the block. Throws as
  /// Horizons::block() does.
  std::vector<std::vector<float>> block(const NodeRect& nodes, const Progress& progress = {}) const;
  /// The same heights with cells of other lengths, as Horizons::with_cells().
  SkyView with_cells(double cell_x, double cell_y) const;

 private:
  struct State;
  explicit SkyView(std::unique_ptr<const State> state);
  std::unique_ptr<const State> state_;
};

}  // namespace scarp
