// SPDX-License-Identifier: MIT
// `scarp replay`: traces the rays of a text file with all marches, side by side.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/rounding.h"
#include "scarp/scene/file/ray_dump.h"

namespace scarp::cli {
namespace {

using Line = std::vector<std::string>;

std::string_view status_name(HitStatus status) {
  constexpr std::string_view kNames[] = {"miss", "hit", "below", "exhausted"};
  return kNames[static_cast<std::size_t>(status)];
}

// One ray and all its results.
class Replay {
 public:
  explicit Replay(const RayDump& dump)
      : dump_(dump), pyramid_(dump.field), target_{&dump.field, &pyramid_, slope_bound(dump.field)} {
    lines_.push_back({"march", "guarantee", "status", "t", "cell", "u", "v", "clearance", "any", "hits", ""});
    oracle_ = march_exhaustive(target_, dump.ray);
    for (const HeightMarchEntry& march : height_marches()) {
      if (takes(march.fields, dump.field)) add(march);
    }
  }

  bool agrees() const { return agrees_; }

  void print(std::size_t number) const {
    const HeightField& field = dump_.field;
    fmt::print("ray {} over {} x {} samples of {}\n", number, field.cols(), field.rows(), name_of(field.sample_type()));
    if (!dump_.expected.empty()) fmt::print("expected: {}\n", dump_.expected);
    if (!dump_.answered.empty()) fmt::print("answered: {}\n", dump_.answered);
    std::vector<std::size_t> widths(lines_.front().size());
    for (const Line& line : lines_) {
      for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
    }
    for (const Line& line : lines_) {
      std::string text;
      for (std::size_t i = 0; i < line.size(); ++i) text += fmt::format("{:<{}}  ", line[i], widths[i]);
      text.erase(text.find_last_not_of(' ') + 1);
      fmt::print("{}\n", text);
    }
  }

 private:
  void add(const HeightMarchEntry& march) {
    const Hit hit = march.cpu(target_, dump_.ray, {}, nullptr);
    std::optional<bool> any;
    if (march.own_any_hit) any = march.occluded(target_, dump_.ray, {});
    std::optional<std::vector<Hit>> all;
    if (march.cpu == march_exhaustive) all_hits_exhaustive(target_, dump_.ray, all.emplace());
    if (march.cpu == march_max_mip) all_hits_max_mip(target_, dump_.ray, all.emplace());

    const char* wrong = "";
    if (march.guarantee == Guarantee::exact) {
      if (!same(oracle_, hit)) wrong = "differs";
      if (any && *any != static_cast<bool>(hit)) wrong = "contradicts itself";
      if (all && (all->empty() == static_cast<bool>(hit) || (hit && all->front().t != hit.t)))
        wrong = "contradicts itself";
    }
    agrees_ = agrees_ && *wrong == 0;
    const auto told = [&](const auto& value) { return hit ? fmt::format("{:.6g}", value) : std::string("-"); };
    lines_.push_back({std::string(march.name), std::string(name_of(march.guarantee)),
                      std::string(status_name(hit.status)), hit ? fmt::format("{:.17g}", hit.t) : "-",
                      hit ? fmt::format("{} {}", hit.cell.col, hit.cell.row) : "-", told(hit.u), told(hit.v),
                      hit.wall ? "wall" : told(hit ? clearance(hit) : 0), any ? (*any ? "hit" : "none") : "-",
                      all ? std::to_string(all->size()) : "-", wrong});
  }

  // Height of the hit above the surface in metres.
  double clearance(const Hit& hit) const {
    const HeightField& field = dump_.field;
    const auto h = field.cell_heights(hit.cell);
    if (!h) return std::nan("");
    return hit.height - field.height_from_sample(height_in_cell(field.settings().surface, *h, hit.u, hit.v));
  }

  // Whether two results are both plausible: their statuses are equal, and between their hits the ray is no farther from
  // the surface than the rounding error.
  bool same(const Hit& a, const Hit& b) const {
    if (a.status != b.status || a.wall != b.wall) return false;
    if (!a || a.t == b.t) return true;
    constexpr int kProbes = 8;
    const HeightField& field = dump_.field;
    for (int i = 0; i <= kProbes; ++i) {
      const double t = a.t + (b.t - a.t) * i / kProbes;
      const dvec3 p = dump_.ray.at(t);
      const auto ground = field.height(p.x, p.y);
      const double metres = field.settings().scale * field.settings().exaggeration;
      // Both the result and this height are rounded.
      if (ground &&
          std::abs(p.z - *ground) > 2 * metres * rounding_of_clearance(field, field.grid_from_world(dump_.ray), t))
        return false;
    }
    return true;
  }

  const RayDump& dump_;
  MaxPyramid pyramid_;
  HeightTarget target_;
  Hit oracle_;
  std::vector<Line> lines_;
  bool agrees_ = true;
};

void replay(const std::string& path) {
  const std::vector<RayDump> dumps = read_ray_dumps(path);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < dumps.size(); ++i) {
    const Replay one(dumps[i]);
    if (i > 0) fmt::print("\n");
    one.print(i + 1);
    differing += !one.agrees();
  }
  if (differing > 0) {
    throw Error(fmt::format("'{}': {} of {} rays: an exact march differs from exhaustive or contradicts itself", path,
                            differing, dumps.size()));
  }
}

}  // namespace

void add_replay(Program& program) {
  Command& command = program.add("replay", "Trace the rays of a dump with all marches; fail if exact marches disagree");
  const auto path = std::make_shared<std::string>();
  command.add(path.get(),
              {.names = "FILE", .help = "ray dump of scarp-bench leaks or the tests", .files = "*", .required = true});
  command.runs([path] { replay(*path); });
}

}  // namespace scarp::cli
