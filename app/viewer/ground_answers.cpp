// SPDX-License-Identifier: MIT
#include "app/viewer/ground_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "app/cli/options/map_part.h"
#include "app/viewer/map_command.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp::viewer {
namespace {

// sRGB and opacity: seen ground is marked, hidden ground becomes darker and keeps its relief.
constexpr std::array<std::uint8_t, 4> kVisible{255, 196, 0, 150}, kHidden{20, 22, 60, 130}, kOther{0, 0, 0, 0};
constexpr double kQuickCells = 200;  // reach of the first answer: milliseconds

// Without exaggeration, with other cells.
template <class Grid>
HeightField true_heights(const Grid& grid, HeightFieldSettings settings, const RasterWindow& part, const dvec2& cells) {
  settings.exaggeration = 1;
  settings.cell_x = cells.x, settings.cell_y = cells.y;
  const auto first = std::ptrdiff_t{part.row} * grid.row_stride + part.col;
  return HeightField::view(grid.data + first, part.cols, part.rows, settings, grid.row_stride);
}

std::shared_ptr<const Drape> drape_of(const SeenGround& seen, int cols, int rows) {
  auto drape = std::make_shared<Drape>();
  drape->width = seen.part.cols, drape->height = seen.part.rows;
  drape->rgba.reserve(4 * seen.codes.size());
  for (const Seen code : seen.codes) {
    const auto& colour = code == Seen::visible ? kVisible : code == Seen::hidden ? kHidden : kOther;
    drape->rgba.insert(drape->rgba.end(), colour.begin(), colour.end());
  }
  // The extent goes from the first to the last sample, and pixels lie around samples.
  const dvec2 steps(std::max(cols - 1, 1), std::max(rows - 1, 1));
  drape->first = dvec2(seen.part.col - 0.5, seen.part.row - 0.5) / steps;
  drape->last = dvec2(seen.part.col + seen.part.cols - 0.5, seen.part.row + seen.part.rows - 0.5) / steps;
  return drape;
}

double metres(double reach) { return reach > 0 ? reach : std::numeric_limits<double>::infinity(); }

}  // namespace

GroundAnswers::GroundAnswers(const Opening& opening, std::shared_ptr<const cli::PreparedScene> prepared)
    : words_(raster_words(opening.command())), prepared_(std::move(prepared)) {
  if (opening.kind != cli::InputKind::terrain || !prepared_->given_scene().only_heights())
    throw Error("observers stand on elevation models alone");
  if (shown().settings().wrap != Wrap::none)
    throw Error("observers stand on ground that is not repeated (without --wrap)");
  options_.inputs = opening.options->inputs;
  options_.raster = opening.options->raster;
  input_ = std::make_unique<cli::MapInput>(options_);
  input_->close();
  if (input_->cols() != shown().cols() || input_->rows() != shown().rows())
    throw Error(fmt::format("the window shows {} x {} of {} x {} samples (observers need all of them: --full)",
                            shown().cols(), shown().rows(), input_->cols(), input_->rows()));
}

HeightField GroundAnswers::part_of(const RasterWindow& part, const dvec2& cells) const {
  return shown().visit([&](const auto& grid) { return true_heights(grid, shown().settings(), part, cells); });
}

// The cells of the plane around a node, and the distance to which it holds: as requested or, without a limit, the
// largest of a few round ones. Rasters in degrees have no plane for all of them.
std::pair<dvec2, double> GroundAnswers::plane_around(Node node, double reach) {
  constexpr double kMost = 100e3, kLeast = 100;
  try {
    return {input_->cells_at(node.col, node.row, metres(reach)), reach};
  } catch (const Error&) {
    if (reach > 0) throw;
  }
  for (double less = kMost;; less /= 2) {
    try {
      return {input_->cells_at(node.col, node.row, less), less};
    } catch (const Error&) {
      if (less < kLeast) throw;
    }
  }
}

Node GroundAnswers::node_at(const dvec3& point) const {
  const HeightFieldSettings& cell = shown().settings();
  const auto nearest = [](double at, int side) {
    return std::clamp(static_cast<int>(std::lround(std::clamp(at, 0.0, side - 1.0))), 0, side - 1);
  };
  return {nearest(point.x / cell.cell_x, shown().cols()),
          nearest(shown().rows() - 1 - point.y / cell.cell_y, shown().rows())};
}

dvec3 GroundAnswers::point_at(Node node) const {
  const HeightFieldSettings& cell = shown().settings();
  const double x = node.col * cell.cell_x, y = (shown().rows() - 1 - node.row) * cell.cell_y;
  return {x, y, SightGround(shown()).height(node).value_or(std::numeric_limits<double>::quiet_NaN())};
}

ViewshedTask GroundAnswers::viewshed(const Observer& observer) {
  if (std::isnan(point_at(observer.node).z)) throw Error("there is no ground under the observer (nodata)");
  ViewshedTask task;
  const Node node = observer.node;
  const auto [cells, far] = plane_around(node, observer.reach);
  task.reach = far;
  const double quick = kQuickCells * std::min(cells.x, cells.y);
  if (far == 0 || quick < far) task.quick_reach = quick;
  ViewshedSettings settings;
  settings.observer_height = observer.height, settings.target_height = observer.target_height;
  settings.curvature = input_->curvature();
  const RasterWindow whole = cli::part_around(*input_, node, metres(far)),
                     near = cli::part_around(*input_, node, metres(task.quick_reach));
  task.compute = [=, cells = cells, full = far, kept = prepared_, cols = input_->cols(), rows = input_->rows()](
                     double reach, const Progress& progress) {
    const HeightField& all = *kept->given_scene().only_heights();
    SeenGround seen;
    seen.complete = reach == 0;
    seen.reach = reach > 0 ? reach : full;
    seen.part = reach > 0 ? near : whole;
    ViewshedSettings within = settings;
    within.max_distance = metres(seen.reach);
    const HeightField field =
        all.visit([&](const auto& grid) { return true_heights(grid, all.settings(), seen.part, cells); });
    seen.codes = scarp::viewshed(field, {node.col - seen.part.col, node.row - seen.part.row}, within, progress);
    const auto visible = std::count(seen.codes.begin(), seen.codes.end(), Seen::visible),
               hidden = std::count(seen.codes.begin(), seen.codes.end(), Seen::hidden);
    seen.share = visible + hidden > 0 ? static_cast<double>(visible) / static_cast<double>(visible + hidden) : 0;
    seen.drape = drape_of(seen, cols, rows);
    return seen;
  };
  return task;
}

SightAnswer GroundAnswers::sight(const Observer& observer, const dvec3& point) {
  const HeightFieldSettings& cell = shown().settings();
  const auto on_line = [](double at, int side) { return std::clamp(at, 0.0, side - 1.0); };
  SightEnd from{.col = static_cast<double>(observer.node.col),
                .row = static_cast<double>(observer.node.row),
                .height = observer.height};
  SightEnd to{.col = on_line(point.x / cell.cell_x, input_->cols()),
              .row = on_line(input_->rows() - 1 - point.y / cell.cell_y, input_->rows()),
              .height = observer.target_height};
  const dvec2 cells = input_->cells_along({from.col, from.row}, {to.col, to.row});
  const RasterWindow part = cli::part_of_line(*input_, from, to);
  for (SightEnd* const end : {&from, &to}) end->col -= part.col, end->row -= part.row;
  const HeightField field = part_of(part, cells);
  SightAnswer answer;
  answer.line = line_of_sight(field, from, to, input_->curvature());
  const double exaggeration = cell.exaggeration;
  for (const ProfilePoint& one : profile(SightLine(field, from, to, input_->curvature()))) {
    const double x = (one.col + part.col) * cell.cell_x, y = (input_->rows() - 1 - one.row - part.row) * cell.cell_y;
    answer.ground.push_back({{x, y, one.ground * exaggeration}, one.visible});
  }
  return answer;
}

HorizonTask GroundAnswers::horizon(Node node) {
  if (std::isnan(point_at(node).z)) throw Error("there is no ground under the cursor (nodata)");
  const auto [cells, reach] = plane_around(node, 0);
  HorizonSettings settings;
  settings.max_distance = metres(reach);
  settings.curvature = input_->curvature();
  const double north = input_->north_at(node.col, node.row);
  return [=, cells = cells, reach = reach, kept = prepared_](const Progress& progress) {
    const HeightField& all = *kept->given_scene().only_heights();
    const RasterWindow whole{0, 0, all.cols(), all.rows()};
    const HeightField field =
        all.visit([&](const auto& grid) { return true_heights(grid, all.settings(), whole, cells); });
    constexpr int kAzimuths = 360, kGrain = 8;
    HorizonPlot plot{.node = node, .reach = reach, .views = std::vector<HorizonView>(kAzimuths)};
    parallel_for(
        kAzimuths, kGrain,
        [&](std::int64_t begin, std::int64_t end) {
          for (std::int64_t i = begin; i < end; ++i) {
            const double azimuth = static_cast<double>(i) / cli::kDegreesPerRadian;
            plot.views[static_cast<std::size_t>(i)] =
                horizon_from(field, node.col, node.row, azimuth - north, settings).value_or(HorizonView{});
          }
        },
        progress);
    return plot;
  };
}

double HorizonPlot::highest() const { return views[static_cast<std::size_t>(highest_azimuth_deg())].angle; }

double HorizonPlot::highest_azimuth_deg() const {
  const auto lower = [](const HorizonView& a, const HorizonView& b) { return a.angle < b.angle; };
  return static_cast<double>(std::max_element(views.begin(), views.end(), lower) - views.begin());
}

std::string GroundAnswers::horizon_command(const HorizonPlot& plot, const std::string& output) const {
  const dvec2 at = input_->place_of(plot.node.col, plot.node.row);
  const std::string limit = plot.reach > 0 ? fmt::format(" --max-distance {:.10g}", plot.reach) : "";
  return fmt::format("scarp horizon{} --at={:.12g},{:.12g}{} -o {}", words_, at.x, at.y, limit, output);
}

std::string GroundAnswers::command(const Observer& observer, const std::string& output) const {
  const dvec2 at = input_->place_of(observer.node.col, observer.node.row);
  std::string text = fmt::format("scarp viewshed{} --observer={:.12g},{:.12g} --observer-height {:.10g}", words_, at.x,
                                 at.y, observer.height);
  if (observer.target_height > 0) text += fmt::format(" --target-height {:.10g}", observer.target_height);
  if (observer.reach > 0) text += fmt::format(" --max-distance {:.10g}", observer.reach);
  return text + " -o " + output;
}

}  // namespace scarp::viewer
