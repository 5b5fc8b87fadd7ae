// SPDX-License-Identifier: MIT
#include "app/cli/picture/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

void print_counts(std::string_view what, const StepRange& counts) {
  const auto [low, high] = counts.scale;
  const bool whole = low == counts.least && high == counts.most;
  fmt::print("{} per ray: {}{} to {}{}, mean {:.1f}{} ({})\n", what, counts.least,
             whole ? " (first colour of the ramp)" : "", counts.most, whole ? " (last)" : "", counts.mean,
             whole ? "" : fmt::format("; colours of the ramp from {} to {}", low, high), counts.of);
}

// "; 0.27 m on average, 99 % at most 1.3 m"
std::string metres_of(const ErrorCounts& errors, Verdict verdict) {
  if (!has_metres(verdict) || errors[verdict] == 0) return {};
  const ErrorMetres& metres = errors.of(verdict);
  const bool place = verdict == Verdict::lost || verdict == Verdict::false_hit;
  return fmt::format("  {}{:.3g} m on average, 99 % up to {:.3g} m", place ? "at a distance of " : "", metres.mean,
                     metres.p99);
}

Json counts_json(const StepRange& counts) {
  return {{"of", counts.of}, {"least", counts.least}, {"most", counts.most}, {"mean", counts.mean}};
}

Json errors_json(const ErrorCounts& errors) {
  Json json{{"judge", errors.judges}};
  if (errors.tolerance_m > 0) {
    json["tolerance_m"] = errors.tolerance_m;
  } else {
    json["tolerance_of_distance"] = errors.share;
  }
  for (int i = 0; i < kVerdicts; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    std::string name(name_of(verdict));
    std::replace(name.begin(), name.end(), ' ', '_');
    Json& one = json[name] = {{"pixels", errors[verdict]}};
    if (!has_metres(verdict)) continue;
    const ErrorMetres& metres = errors.of(verdict);
    const auto number = [&](double value) { return errors[verdict] > 0 ? Json(value) : Json(); };
    one["mean_m"] = number(metres.mean), one["p99_m"] = number(metres.p99), one["most_m"] = number(metres.most);
  }
  if (errors.proven > 0) json["proven"] = errors.proven, json["contradictions"] = errors.contradictions;
  if (!errors.caveats.empty()) json["caveats"] = errors.caveats;
  return json;
}

}  // namespace

void print_findings(const Picture& picture) {
  if (picture.steps) print_counts("steps", *picture.steps);
  if (picture.cost) print_counts("reads", *picture.cost);
  if (picture.heights) {
    fmt::print("heights: {:.6g} m (grey 1) to {:.6g} m (grey 255)\n", picture.heights->low, picture.heights->high);
  }
  if (!picture.errors) return;
  const ErrorCounts& errors = *picture.errors;
  for (const std::string& caveat : errors.caveats) fmt::print("{}\n", caveat);
  fmt::print("judged by {}; tolerance {} along the ray; pixels:\n", errors.judges,
             errors.share == 0 ? fmt::format("{:.3g} m", errors.tolerance_m)
                               : fmt::format("{:.3g} % of the distance", 100 * errors.share));
  for (int i = 0; i < kVerdicts; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    fmt::print("  {:10}  {:9}  {}{}\n", name_of(verdict), colour_name_of(verdict), errors[verdict],
               metres_of(errors, verdict));
  }
  if (errors.proven > 0) {
    fmt::print("of these {} proven by interval bisection, which contradicts the judge {} times\n", errors.proven,
               errors.contradictions);
  }
}

Json describe_findings(const Picture& picture) {
  Json json = Json::object();
  if (picture.steps) json["steps"] = counts_json(*picture.steps);
  if (picture.cost) json["cost"] = counts_json(*picture.cost);
  if (picture.heights) json["heights_m"] = {picture.heights->low, picture.heights->high};
  if (picture.errors) json["errors"] = errors_json(*picture.errors);
  return json;
}

}  // namespace scarp::cli
