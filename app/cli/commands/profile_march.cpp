// SPDX-License-Identifier: MIT
#include "app/cli/commands/profile_march.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "app/cli/options/march_options.h"
#include "app/cli/options/plot_options.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/base/march_trace.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/sampling/shrink_factor.h"
#ifdef SCARP_CAIRO
#include "scarp/output/march_figure.h"
#endif

namespace scarp::cli {
namespace {

constexpr std::string_view kNoMarch = "none";  // for messages: no march has this name
constexpr const char* kRayForm = "X,Y,Z,DX,DY,DZ, for example 692000,5143000,2500,1,0.5,-0.2";

// The part of the ray over the field, down to its lowest ground.
std::optional<std::pair<double, double>> part_over(const HeightField& field, const Ray& ray) {
  double begin = ray.t_min, end = ray.t_max;
  const auto clip = [&](double origin, double direction, double low, double high) {
    if (direction == 0) return origin >= low && origin <= high;
    const double a = (low - origin) / direction, b = (high - origin) / direction;
    begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
    return begin < end;
  };
  if (!clip(ray.origin.x, ray.direction.x, 0, field.width()) || !clip(ray.origin.y, ray.direction.y, 0, field.depth()))
    return {};
  // A little beyond, so that the figure shows the ground around the end.
  constexpr double kBeyondHit = 0.02;
  if (ray.direction.z < 0 && std::isinf(ray.t_max)) {
    const double lowest = (field.min_height() - ray.origin.z) / ray.direction.z;
    end = std::min(end, lowest + kBeyondHit * std::abs(lowest - begin));
  }
  if (!(begin < end)) return {};
  return std::pair(begin, end);
}

#ifdef SCARP_CAIRO

constexpr int kPointsPerPixel = 1;
// The drawn ground differs by less than this fraction of its range of heights.
constexpr double kSmoothing = 1.0 / 1500;

MarchMarks marks_of(const HeightMarchEntry& march) {
  switch (march.sampling) {
    case Sampling::naive:
    case Sampling::relaxed:
      return MarchMarks::bars;
    case Sampling::fixed_step:
      return MarchMarks::shells;
    case Sampling::lipschitz:
      return MarchMarks::balls;
    case Sampling::none:
      break;
  }
  return MarchMarks::blocks;
}

BallProof proof_of(const LipschitzSettings& settings, double slope) {
  if (settings.shrink == 0) return BallProof::steepest_slope;
  return lipschitz_guarantee(settings, slope) == Guarantee::approximate ? BallProof::none : BallProof::steeper_slope;
}

// Leaves out points that lie on a straight line between others, up to `tolerance`.
std::vector<MarchFigurePoint> simplified(const std::vector<MarchFigurePoint>& points, double tolerance) {
  constexpr std::size_t kMostSkipped = 400;
  std::vector<MarchFigurePoint> kept;
  const auto straight = [&](std::size_t from, std::size_t to) {
    const MarchFigurePoint &a = points[from], &b = points[to];
    for (std::size_t i = from + 1; i < to; ++i) {
      const double share = (points[i].distance - a.distance) / (b.distance - a.distance);
      if (!(std::abs(a.height + share * (b.height - a.height) - points[i].height) <= tolerance)) return false;
    }
    return true;
  };
  for (std::size_t i = 0; i < points.size();) {
    kept.push_back(points[i]);
    std::size_t next = i + 1;
    while (next + 1 < points.size() && next - i < kMostSkipped && straight(i, next + 1)) ++next;
    i = next;
  }
  return kept;
}

std::vector<MarchFigurePoint> ground_below(const HeightField& field, const Ray& ray, double begin, double end,
                                           double metres_per_t, int points) {
  std::vector<MarchFigurePoint> ground;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (int i = 0; i <= points; ++i) {
    const double t = begin + (end - begin) * i / points;
    const dvec3 p = ray.at(t);
    const auto height = field.height(std::clamp(p.x, 0.0, field.width()), std::clamp(p.y, 0.0, field.depth()));
    ground.push_back({t * metres_per_t, height.value_or(std::numeric_limits<double>::quiet_NaN())});
    if (height) low = std::min(low, *height), high = std::max(high, *height);
  }
  return simplified(ground, kSmoothing * std::max(high - low, 0.0));
}

// " (12.3 m late)", against an exact march.
std::string error_of(const Hit& hit, const Hit& exact, double metre) {
  if (hit && exact) {
    const double metres = (hit.t - exact.t) * metre;
    if (metres == 0) return {};
    return fmt::format(" ({:.3g} m {})", std::abs(metres), metres < 0 ? "early" : "late");
  }
  if (exact) return fmt::format(" (the ground is hit after {:.6g} m)", exact.t * metre);
  return hit ? " (nothing is hit)" : "";
}

// The time at which the figure ends: behind all hits, unless a march has none.
double end_of(const MarchFigure& figure, const Ray& ray, double last) {
  constexpr double kBehind = 0.2;  // of the way to the last hit
  double end = ray.t_min;
  for (const MarchPanel& panel : figure.panels) {
    if (!panel.hit) return last;
    end = std::max(end, panel.hit.t);
    for (const TraceStep& step : panel.trace.steps)
      if (std::isfinite(step.t_out)) end = std::max(end, std::min(step.t_out, (1 + kBehind) * panel.hit.t));
  }
  return end + kBehind * (end - ray.t_min);
}

std::string caption_of(const HeightMarchEntry& march, const MarchPanel& panel, const MarchStats& stats,
                       const Hit& exact, double metre) {
  std::string text(march.name);
  if (march.sampling != Sampling::none) {
    text += fmt::format(": {} samples", stats.steps);
  } else {
    text += fmt::format(": {} blocks and cells, {} tested", stats.steps, stats.cell_tests);
  }
  switch (panel.hit.status) {
    case HitStatus::hit:
      text += fmt::format(", hit after {:.6g} m", panel.hit.t * metre);
      break;
    case HitStatus::miss:
    case HitStatus::invalid:  // only in batches that ask for it
      text += ", no hit";
      break;
    case HitStatus::below:
      text += ", starts below the ground";
      break;
    case HitStatus::exhausted:
      text += fmt::format(", given up after {:.6g} m", panel.hit.t * metre);
      break;
  }
  return text + error_of(panel.hit, exact, metre);
}

#endif

}  // namespace

void add_profile_march_options(Command& command, ProfileMarchOptions& options, const std::string& output) {
  std::vector<std::string> names;
  for (const HeightMarchEntry& march : height_marches()) {
    if (march.traced) names.emplace_back(march.name);
  }
  command.add(List<std::string>{&options.names}, {.names = "--march",
                                                  .value = "NAME[,NAME]",
                                                  .help = "marches whose steps are drawn, each in a panel",
                                                  .choices = names,
                                                  .closed = true,
                                                  .note = "without --cc: rays are straight",
                                                  .fallback = "none: a profile with its line of sight",
                                                  .common = true,
                                                  .rules = {needs_figure(output)},
                                                  .excludes = {"--cc"}});
  command.add(&options.ray,
              {.names = "--ray",
               .value = "X,Y,Z,DX,DY,DZ",
               .help = "ray instead of the line from --from to --to: position, height above sea, direction",
               .fallback = "none",
               .common = true,
               .rules = {needs("--march NAME", [&options] { return !options.names.empty(); })},
               .excludes = {"--from", "--to", "--observer-height", "--target-height", "--heights"}});
  add_march_options(command, options.settings);
}

void check_marches(const Command& command, const ProfileMarchOptions& options) {
  // Settings of marches need one of those that are drawn.
  std::vector<Use> uses;
  for (const std::string& name : options.names) uses.push_back({InputKind::terrain, {}, name});
  if (uses.empty()) uses.push_back({InputKind::terrain, {}, kNoMarch});
  command.require_effect_of_any(uses);
}

ProfileRay typed_ray(MapInput& input, const std::string& text) {
  const auto n = ground_numbers_from(text, 6, 6, "--ray", kRayForm);
  const dvec2 at = input.position_of({n[0], n[1], {}}, false, "--ray");
  const dvec3 direction = input.direction_of({n[3], n[4], n[5]});
  if (direction.x == 0 && direction.y == 0)
    throw Error(fmt::format("--ray '{}': a profile needs a direction that is not vertical", text));
  ProfileRay ray{input.field(), {}};
  const auto place = [&] {
    const HeightFieldSettings& cells = ray.field.settings();
    ray.ray.origin = {at.x * cells.cell_x, (ray.field.rows() - 1 - at.y) * cells.cell_y, n[2]};
    ray.ray.direction = normalize(direction);
  };
  place();
  if (const auto part = part_over(ray.field, ray.ray)) {
    ray.field = input.field_at(at.x, at.y, part->second);
    place();
  }
  return ray;
}

ProfileRay ray_along(const SightLine& line) {
  // Beyond the target, so that a target on the ground is hit in spite of rounding.
  constexpr double kBeyondHit = 1.0 / 256;
  const HeightField& field = line.ground().field();
  const auto at = [&](const SightEnd& end, double z) {
    const HeightFieldSettings& cells = field.settings();
    return dvec3(end.col * cells.cell_x, (field.rows() - 1 - end.row) * cells.cell_y, z);
  };
  if (!(line.distance() > 0)) throw Error("--to: a profile needs a target beside the observer");
  ProfileRay ray{field, {}};
  ray.ray.origin = at(line.from(), line.eye());
  const dvec3 way = at(line.to(), line.target()) - ray.ray.origin;
  ray.ray.direction = normalize(way);
  ray.ray.t_max = (1 + kBeyondHit) * length(way);
  return ray;
}

std::vector<std::string> draw_marches([[maybe_unused]] const ProfileMarchOptions& options,
                                      [[maybe_unused]] const ProfileRay& over,
                                      [[maybe_unused]] const std::string& title, [[maybe_unused]] int width,
                                      [[maybe_unused]] int height, const std::string& output) {
#ifdef SCARP_CAIRO
  validate(options.settings);
  const auto& [field, ray] = over;
  const auto part = part_over(field, ray);
  if (!part) throw Error("the ray does not pass over the elevation model (check its position and direction)");
  MarchFigure figure;
  figure.title = title;
  figure.width = width, figure.height = height;
  figure.z = ray.origin.z;
  figure.distance_per_t = std::hypot(ray.direction.x, ray.direction.y);
  figure.rise_per_t = ray.direction.z;
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid, slope_bound(field)};
  const Hit exact = find_height_march("max-mip").cpu(target, ray, {}, nullptr);
  const double metre = length(ray.direction);
  std::vector<std::string> lines;
  for (const std::string& name : options.names) {
    const HeightMarchEntry& march = find_height_march(name);
    MarchPanel panel;
    panel.marks = marks_of(march);
    panel.proof = proof_of(options.settings.lipschitz, target.slope);
    MarchStats stats;
    panel.hit = march.traced(target, ray, options.settings, &stats, panel.trace);
    panel.caption = caption_of(march, panel, stats, exact, metre);
    lines.push_back(panel.caption);
    if (panel.marks == MarchMarks::balls && panel.proof == BallProof::none)
      lines.push_back(lipschitz_caveat(options.settings.lipschitz, target.slope));
    figure.panels.push_back(std::move(panel));
  }
  const double end = std::min(part->second, end_of(figure, ray, part->second));
  figure.begin = part->first * figure.distance_per_t;
  figure.length = end * figure.distance_per_t;
  figure.ground = ground_below(field, ray, part->first, end, figure.distance_per_t, kPointsPerPixel * width);
  ReplaceFile file(output);
  write_march_figure(file, output, figure);
  return lines;
#else
  throw Error(fmt::format("output '{}': this build draws no figures (SCARP_CAIRO=OFF)", output));
#endif
}

}  // namespace scarp::cli
