// SPDX-License-Identifier: MIT
// Parts of maps: bands of rows, for tasks that share one map. Every function returns its rows bit-identical to those of
// the whole map, computed only from the part of the field that affects them.
//
//   viewshed   rows between the observer and the band     shadow   rows from the band towards the sun, as far as
//                                                                  the highest ground reaches
//
//   const auto codes = scarp::shadow_rows(field, sun, scarp::row_band(field.rows(), 3, 16));
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scarp/analysis/shadow.h"
#include "scarp/analysis/viewshed.h"
#include "scarp/base/progress.h"

namespace scarp {

/// Rows [first, last) of a field.
struct RowBand {
  int first = 0;
  int last = 0;
  int rows() const { return last - first; }
  friend bool operator==(const RowBand&, const RowBand&) = default;
};

/// Returns part `part`, from 1, of `parts` bands that cover all rows from north to south and differ by at most one row.
/// Throws Error unless 1 <= part <= parts <= rows.
RowBand row_band(int rows, int part, int parts);

/// Returns the rows, of `rows` in all, that the shadows of a band depend on, if no ground is more than `relief` metres
/// above the ground of the band. `steps` as for sun_ray(), which it throws as.
RowBand rows_towards(const NodeSteps& steps, int rows, const SunDirection& sun, const RowBand& band, double relief);
/// The same for columns, of `cols` in all.
RowBand cols_towards(const NodeSteps& steps, int cols, const SunDirection& sun, const RowBand& band, double relief);

/// Throws Error for an empty band, and one that is not inside the field.
void require_band(const HeightField& field, const RowBand& band);

/// Rows of viewshed(). Throws as it does, and as require_band(); the functions below do the same.
std::vector<Seen> viewshed_rows(const HeightField& field, Node observer, const ViewshedSettings& settings,
                                const RowBand& band, const Progress& progress = {});

/// Rows of least_visible().
std::vector<double> least_visible_rows(const HeightField& field, Node observer, const ViewshedSettings& settings,
                                       const RowBand& band, const Progress& progress = {});

/// Rows of observer_count().
std::vector<std::uint16_t> observer_count_rows(std::span<const Viewpoint> views, const RowBand& band,
                                               const Progress& progress = {});

/// Rows of shadow().
std::vector<Shade> shadow_rows(const HeightField& field, const SunDirection& sun, const RowBand& band,
                               const Progress& progress = {});

}  // namespace scarp
