// SPDX-License-Identifier: MIT
#include "app/cli/commands/viewshed_bands.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "scarp/analysis/line_of_sight.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"

namespace scarp::cli {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr std::int64_t kGrain = 16;  // rows

// Settings of a sweep over the surface above bare ground. Eyes below roofs and trees see what these leave free; limits
// of pitch depend on targets, which the sweep does not know.
ViewshedSettings over_surface(const Observer& one, const Viewpoint& view) {
  ViewshedSettings settings = one.settings;
  settings.observer_z = view.eye();
  settings.under_surface = true;
  settings.low_pitch = -std::numbers::pi / 2;
  settings.high_pitch = std::numbers::pi / 2;
  return settings;
}

// Calls visit(i, node) for all pixels of the rows, on all threads.
template <class Visit>
void visit_pixels(const HeightField& field, const RowBand& rows, const Visit& visit) {
  const int cols = field.cols();
  parallel_for(rows.rows(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin) * cols; i < static_cast<std::size_t>(end) * cols; ++i)
      visit(i, Node{static_cast<int>(i % cols), rows.first + static_cast<int>(i / cols)});
  });
}

// The visibility of a pixel's target without what hides it: hole, out_of_range or visible.
Seen reach_of(const Observer& one, const Viewpoint& view, const Node& node) {
  const auto lowered = view.ground().lowered(node);
  if (!lowered || !SightGround(one.field).height(node)) return Seen::hole;
  return view.in_range(node, view.target(*lowered)) ? Seen::visible : Seen::out_of_range;
}

// least_visible_rows() over the surface; NaN for holes and pixels out of range.
std::vector<double> least_of(const Observer& one, const Viewpoint& view, const RowBand& rows,
                             const Progress& progress) {
  if (!one.bare_ground) return least_visible_rows(one.field, one.node, one.settings, rows, progress);
  auto least = least_visible_rows(one.field, one.node, over_surface(one, view), rows, progress);
  visit_pixels(one.field, rows, [&](std::size_t i, const Node& node) {
    if (reach_of(one, view, node) != Seen::visible) least[i] = std::numeric_limits<double>::quiet_NaN();
  });
  return least;
}

// Visibility, from the heights of the least visible targets.
std::vector<Seen> codes_of(const Observer& one, const Viewpoint& view, const RowBand& rows,
                           const std::vector<double>& least) {
  std::vector<Seen> codes(least.size());
  visit_pixels(one.field, rows, [&](std::size_t i, const Node& node) {
    codes[i] = reach_of(one, view, node);
    if (codes[i] == Seen::visible && !(view.target(*view.ground().lowered(node)) >= least[i])) codes[i] = Seen::hidden;
  });
  return codes;
}

// Calls combine(pixel, height above `datum` of the least visible target) for all observers and pixels in range. Adds
// the viewsheds to the summary.
template <class Combine>
std::vector<float> combined_least(const ObserverGroup& group, HeightDatum datum, const RowBand& rows,
                                  const Progress& progress, const Combine& combine) {
  std::vector<float> pixels;
  if (rows.rows() == 0) return pixels;
  const auto count = static_cast<double>(group.observers.size());
  for (std::size_t k = 0; k < group.observers.size(); ++k) {
    const Observer& one = group.observers[k];
    const Viewpoint view = viewpoint_of(one);
    const auto least = least_of(one, view, rows, progress_part(progress, static_cast<double>(k), count));
    if (group.summary) group.summary->add(group.first + k, view, codes_of(one, view, rows, least), rows.first);
    if (pixels.empty()) pixels.assign(least.size(), kNothing);
    visit_pixels(one.field, rows, [&](std::size_t i, const Node& node) {
      const float height = least_height(view.ground(), node, least[i], datum);
      if (!std::isnan(height)) pixels[i] = combine(pixels[i], height, one);
    });
  }
  return pixels;
}

}  // namespace

Viewpoint viewpoint_of(const Observer& observer) {
  return {observer.bare_ground ? *observer.bare_ground : observer.field, observer.node, observer.settings};
}

std::vector<Seen> seen_pixels(const ObserverGroup& group, std::size_t k, const RowBand& rows,
                              const Progress& progress) {
  const Observer& one = group.observers[k];
  const Viewpoint view = viewpoint_of(one);
  std::vector<Seen> codes;
  if (one.bare_ground) {
    codes = codes_of(one, view, rows, least_visible_rows(one.field, one.node, over_surface(one, view), rows, progress));
  } else {
    codes = viewshed_rows(one.field, one.node, one.settings, rows, progress);
  }
  if (group.summary) group.summary->add(group.first + k, view, codes, rows.first);
  return codes;
}

std::vector<std::uint16_t> count_pixels(const ObserverGroup& group, const RowBand& rows, const Progress& progress) {
  if (!group.summary && !group.observers.front().bare_ground) {
    std::vector<Viewpoint> views;
    for (const Observer& one : group.observers) views.push_back(viewpoint_of(one));
    return observer_count_rows(views, rows, progress);
  }
  if (group.observers.size() > kMostObservers)
    throw Error(fmt::format("viewshed: {} observers (1 to {} are possible)", group.observers.size(), kMostObservers));
  std::vector<std::uint16_t> counts;
  const auto all = static_cast<double>(group.observers.size());
  for (std::size_t k = 0; k < group.observers.size(); ++k) {
    const auto codes = seen_pixels(group, k, rows, progress_part(progress, static_cast<double>(k), all));
    if (counts.empty()) counts.assign(codes.size(), kCountOutOfRange);
    for (std::size_t i = 0; i < codes.size(); ++i) {
      if (codes[i] == Seen::hole) counts[i] = kCountHole;
      if (codes[i] != Seen::visible && codes[i] != Seen::hidden) continue;
      if (counts[i] == kCountOutOfRange) counts[i] = 0;
      counts[i] = static_cast<std::uint16_t>(counts[i] + (codes[i] == Seen::visible));
    }
  }
  return counts;
}

std::vector<Seen> best_pixels(const ObserverGroup& group, const RowBand& rows, const Progress& progress) {
  if (group.observers.size() == 1) return seen_pixels(group, 0, rows, progress);
  const auto counts = count_pixels(group, rows, progress);
  std::vector<Seen> best;
  best.reserve(counts.size());
  for (const std::uint16_t count : counts)
    best.push_back(count == kCountHole         ? Seen::hole
                   : count == kCountOutOfRange ? Seen::out_of_range
                   : count > 0                 ? Seen::visible
                                               : Seen::hidden);
  return best;
}

std::vector<float> least_pixels(const ObserverGroup& group, HeightDatum datum, const RowBand& rows,
                                const Progress& progress) {
  return combined_least(group, datum, rows, progress,
                        [](float pixel, float height, const Observer&) { return std::fmin(pixel, height); });
}

std::vector<float> height_pixels(const ObserverGroup& group, const RowBand& rows, const Progress& progress) {
  return combined_least(group, HeightDatum::ground, rows, progress, [](float pixel, float height, const Observer& one) {
    const double seen = std::max(0.0, one.settings.target_height - static_cast<double>(height));
    return static_cast<float>(seen) + (std::isnan(pixel) ? 0 : pixel);
  });
}

std::vector<float> angle_pixels(const ObserverGroup& group, const RowBand& rows, TargetCount& targets,
                                const Progress& progress) {
  std::vector<float> pixels;
  std::vector<Seen> best;
  if (rows.rows() == 0) return pixels;
  const auto count = static_cast<double>(group.observers.size());
  for (std::size_t k = 0; k < group.observers.size(); ++k) {
    const Observer& one = group.observers[k];
    const auto codes = seen_pixels(group, k, rows, progress_part(progress, static_cast<double>(k), count));
    const auto angles = sight_angles(viewpoint_of(one), codes, rows.first);
    if (pixels.empty()) pixels.assign(angles.size(), kNothing), best.assign(codes.size(), Seen::out_of_range);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      pixels[i] = std::fmax(pixels[i], angles[i]);  // replaces NaN
      if (codes[i] == Seen::visible || best[i] == Seen::out_of_range) best[i] = codes[i];
    }
  }
  targets.add(best);
  return pixels;
}

std::vector<float> fresnel_pixels(const ObserverGroup& group, double wavelength, const RowBand& rows,
                                  const Progress& progress) {
  std::vector<float> pixels(
      static_cast<std::size_t>(rows.rows()) * static_cast<std::size_t>(group.observers.front().field.cols()), kNothing);
  const auto steps = static_cast<double>((group.summary ? 2 : 1) * group.observers.size());
  double step = 0;
  for (std::size_t k = 0; group.summary && rows.rows() > 0 && k < group.observers.size(); ++k)
    seen_pixels(group, k, rows, progress_part(progress, step++, steps));
  for (std::size_t k = 0; k < group.observers.size(); ++k) {
    const Observer& one = group.observers[k];
    const Viewpoint view = viewpoint_of(one);
    const SightEnd eye{static_cast<double>(one.node.col), static_cast<double>(one.node.row), view.eye(),
                       HeightDatum::sea, true};
    const int cols = one.field.cols();
    parallel_for(
        rows.rows(), 1,
        [&](std::int64_t begin, std::int64_t end) {
          for (int row = static_cast<int>(begin); row < end; ++row) {
            for (int col = 0; col < cols; ++col) {
              const Node node{col, rows.first + row};
              if (reach_of(one, view, node) != Seen::visible) continue;
              const SightEnd target{static_cast<double>(col), static_cast<double>(node.row),
                                    *view.ground().height(node) + one.settings.target_height, HeightDatum::sea, true};
              const SightLine line(one.field, eye, target, one.settings.curvature);
              const float share = static_cast<float>(std::min(1.0, fresnel_clearance(line, wavelength).share));
              float& pixel = pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) +
                                    static_cast<std::size_t>(col)];
              pixel = std::fmax(pixel, share);  // replaces NaN
            }
          }
        },
        progress_part(progress, step++, steps));
  }
  return pixels;
}

}  // namespace scarp::cli
