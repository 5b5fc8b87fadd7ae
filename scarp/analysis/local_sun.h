// SPDX-License-Identifier: MIT
// Shadows with a separate sun for every node: the sun's position, north and the steps to the neighbours are those at
// the node's own position on Earth, not those at the centre of the field. One ray per node. Requires a build with ERFA
// (SCARP_ERFA).
//
// A ray keeps the direction that it has at its node; the ground along it is positioned by the field's grid. A node is
// self-shaded if the sun is at or below its horizon.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "scarp/analysis/sun_ground.h"
#include "scarp/analysis/sun_position.h"

namespace scarp {

struct LocalSun {
  UtcTime time{};
  bool refraction = false;
  /// Sets x and y to longitude and latitude in degrees (WGS 84) of the nodes (first_col + i, row), from several threads
  /// at once (NodePlaces, scarp/source/raster/node_places.h). For fields of one column or row, the neighbouring nodes
  /// outside are also requested.
  std::function<void(int row, int first_col, std::span<dvec3> places)> places{};
  /// In place of the sun of the time: the same direction at every node, its azimuth from true north at the node.
  std::optional<SunDirection> fixed = std::nullopt;
};

/// Returns the codes of the band. Throws Error for a wrapped field or an empty band.
std::vector<Shade> local_shadow(const SunGround& ground, const LocalSun& sun, const RowBand& band,
                                const Progress& progress = {});

/// Returns the lit fraction of the sun's disc, as lit_share() does.
std::vector<float> local_lit_share(const SunGround& ground, const LocalSun& sun, const RowBand& band,
                                   const Progress& progress = {});

/// Returns the steps between nodes at `here`, from places one or two columns and rows apart. Places as above. At a
/// pole, north is that of the longitude of `here`.
NodeSteps node_steps(const dvec3& here, const dvec3& west, const dvec3& east, int cols, const dvec3& north,
                     const dvec3& south, int rows);

}  // namespace scarp
