// SPDX-License-Identifier: MIT
// The table of `scarp viewshed --summary`: what each observer sees.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "app/cli/options/map_input.h"
#include "app/cli/options/place_file.h"
#include "scarp/analysis/viewshed.h"

namespace scarp::cli {

/// Adds up viewsheds of observers, which may come in bands of rows.
class ViewshedSummary {
 public:
  explicit ViewshedSummary(std::size_t observers) : sums_(observers) {}

  /// Adds some rows of the viewshed of an observer, the first of which is `first_row`.
  void add(std::size_t observer, const Viewpoint& view, std::span<const Seen> codes, int first_row);

  double area(std::size_t observer) const { return sums_[observer].area; }          ///< seen, m^2
  double share(std::size_t observer) const;                                         ///< of the targets in range, 0..1
  double farthest(std::size_t observer) const { return sums_[observer].farthest; }  ///< metres
  double eye(std::size_t observer) const { return sums_[observer].eye; }            ///< metres above sea
  /// All numbers that add() changes.
  std::vector<double*> totals() {
    std::vector<double*> all;
    for (Sum& sum : sums_) all.insert(all.end(), {&sum.area, &sum.farthest, &sum.eye, &sum.visible, &sum.hidden});
    return all;
  }

 private:
  struct Sum {
    double area = 0, farthest = 0, eye = 0, visible = 0, hidden = 0;
  };
  std::vector<Sum> sums_;
};

/// An observer of a summary.
struct SummaryRow {
  std::size_t row = 0;  ///< of the table of observers
  dvec2 at{0.0};        ///< in --coords
};

/// Returns the table as CSV: the other columns of `table`, and a line for each of its rows. `observers` are the rows
/// with a viewshed, in the order of `summary`. `status`: nullptr without a column of this name.
std::string summary_csv(const ViewshedSummary& summary, const PlaceTable& table, const RowStatus* status,
                        std::span<const SummaryRow> observers);

}  // namespace scarp::cli
