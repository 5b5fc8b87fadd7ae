// SPDX-License-Identifier: MIT
// Pixels of the modes of `scarp viewshed`, for one or many observers and some rows.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "app/cli/commands/viewshed_summary.h"
#include "scarp/analysis/map_part.h"
#include "scarp/analysis/observer_count.h"
#include "scarp/analysis/viewshed.h"
#include "scarp/base/progress.h"

namespace scarp::cli {

/// An observer over the part of the raster that was read, with its own plane if the raster is in degrees.
struct Observer {
  Node node;
  ViewshedSettings settings;
  HeightField field;                       ///< hides targets
  std::optional<HeightField> bare_ground;  ///< on which observers and targets stand; nullopt: the field
};

/// The observers of a map, and of its summary.
struct ObserverGroup {
  std::span<const Observer> observers;
  ViewshedSummary* summary = nullptr;  ///< nullptr: none
  std::size_t first = 0;               ///< of the observers, in the summary

  ObserverGroup one(std::size_t k) const { return {observers.subspan(k, 1), summary, first + k}; }
};

/// Numbers of targets within the limits.
struct TargetCount {
  double visible = 0, hidden = 0;

  void add(std::span<const Seen> seen) {
    visible += static_cast<double>(std::count(seen.begin(), seen.end(), Seen::visible));
    hidden += static_cast<double>(std::count(seen.begin(), seen.end(), Seen::hidden));
  }
};

/// The observer's eye and its targets, over the ground on which they stand. Throws Error as Viewpoint.
Viewpoint viewpoint_of(const Observer& observer);

/// Returns the viewshed of the observer `k`, and adds it to the summary.
std::vector<Seen> seen_pixels(const ObserverGroup& group, std::size_t k, const RowBand& rows, const Progress& progress);

/// Returns the number of observers that see each pixel, kCountHole or kCountOutOfRange. Throws Error for too many.
std::vector<std::uint16_t> count_pixels(const ObserverGroup& group, const RowBand& rows, const Progress& progress);

/// Returns the best visibility over all observers.
std::vector<Seen> best_pixels(const ObserverGroup& group, const RowBand& rows, const Progress& progress);

/// The functions below return NaN for pixels without a value, and add viewsheds to the summary.

/// Least height of a visible target over all observers: least_height().
std::vector<float> least_pixels(const ObserverGroup& group, HeightDatum datum, const RowBand& rows,
                                const Progress& progress);

/// Sum over all observers of the metres of a target, which stands on the ground and is as high as the target height,
/// that the observer sees: those above least_height(). 0 where nothing is seen.
std::vector<float> height_pixels(const ObserverGroup& group, const RowBand& rows, const Progress& progress);

/// Largest angle of a visible target in degrees above the horizontal. Counts the targets.
std::vector<float> angle_pixels(const ObserverGroup& group, const RowBand& rows, TargetCount& targets,
                                const Progress& progress);

/// Largest share of the first Fresnel zone that is clear, over all observers: fresnel_clearance(), at most 1. One line
/// of sight per pixel: slower than the others. The viewsheds of a summary are found first.
std::vector<float> fresnel_pixels(const ObserverGroup& group, double wavelength, const RowBand& rows,
                                  const Progress& progress);

}  // namespace scarp::cli
