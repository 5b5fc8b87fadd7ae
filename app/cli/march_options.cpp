// SPDX-License-Identifier: MIT
#include "app/cli/march_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/cli/input_kind.h"
#include "app/cli/numbers.h"
#include "scarp/base/error.h"

namespace scarp::cli {

void add_march_options(CLI::App& command, MarchSettings& march) {
  const std::string group = "Settings of marches";
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group(group)->capture_default_str();
  };
  add("--naive-step-factor", march.naive.step_factor, "share of the vertical distance that naive steps; above 0")
      ->check(number_in(kAboveZero));
  add("--naive-min-step", march.naive.min_step, "its least step, a share of the ray's way out; above 0, at most 1")
      ->check(number_in({.least = 0, .most = 1, .above_least = true}));
  add("--naive-tolerance", march.naive.tolerance,
      "height above ground that it takes for a hit, per distance; 0 or more")
      ->check(number_in(kZeroOrMore));
  add("--naive-max-steps", march.naive.max_steps, "its limit of steps; 1 or more");
  add("--fixed-step", march.fixed_step.step, "the step of fixed-step, in cells; above 0")->check(number_in(kAboveZero));
  add("--fixed-step-interpolate", march.fixed_step.interpolate,
      "whether it puts the hit between the last two samples, or on the last; true or false");
  add("--fixed-step-max-steps", march.fixed_step.max_steps, "its limit of steps; 1 or more");
  add("--relaxed-step-factor", march.relaxed.step_factor, "share of the vertical distance that relaxed steps; above 0")
      ->check(number_in(kAboveZero));
  add("--relaxed-tolerance", march.relaxed.tolerance,
      "height off the ground that it takes for a hit, per distance; above 0")
      ->check(number_in(kZeroOrMore));
  add("--relaxed-max-steps", march.relaxed.max_steps, "its limit of steps; 1 or more");
  add("--shrink", march.lipschitz.shrink,
      "share of the vertical distance that lipschitz steps; above 0, at most 1; 0: what the steepest slope allows")
      ->check(number_in({0, 1}));
  add("--lipschitz-tolerance", march.lipschitz.tolerance,
      "distance to the ground that it takes for a hit, per distance travelled; 0 or more")
      ->check(number_in(kZeroOrMore));
  add("--lipschitz-max-steps", march.lipschitz.max_steps, "its limit of steps; 1 or more");
  add("--local-tolerance", march.lipschitz_local.tolerance,
      "length of the last interval of lipschitz-local, per distance travelled; 0 or more")
      ->check(number_in(kZeroOrMore));
  add("--local-max-steps", march.lipschitz_local.max_steps, "its limit of steps; 1 or more");
  add("--bisect-halvings", march.bisect.halvings, "halvings of max-mip-bisect; 1 to 60");
  command
      .add_option_function<std::string>(
          "--refine", [&march](const std::string& name) { march.sampling.refinement = find_refinement(name); },
          "how naive, fixed-step and relaxed refine a hit within the last step: none, secant, bisect (none)")
      ->group(group);
  add("--refine-halvings", march.sampling.halvings, "halvings of --refine bisect; 1 to 60");
  const std::string functions = "Settings of marches over terrain functions";
  const auto add_function = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group(functions)->capture_default_str();
  };
  command.add_option("--function-reach", march.function.reach, "metres that a ray is followed; above 0 (any)")
      ->group(functions)
      ->check(number_in(kAboveZero));
  add_function("--function-step", march.function.step, "the step of fixed-step, metres; above 0")
      ->check(number_in(kAboveZero));
  add_function("--function-step-share", march.function.step_share,
               "its least step as a share of the distance travelled; 0 or more")
      ->check(number_in(kZeroOrMore));
  add_function("--function-tolerance", march.sampling.tolerance,
               "metres off the ground that naive and relaxed take for a hit at any distance; 0 or more")
      ->check(number_in(kZeroOrMore));
}

void require_settings_of(std::string_view march, const std::vector<std::string>& given, const MarchSettings& settings) {
  // By how their names begin; --function-reach is of all.
  static constexpr struct {
    std::string_view beginning, march;
  } kOf[] = {
      {"--naive-", "naive"},
      {"--fixed-step", "fixed-step"},
      {"--relaxed-", "relaxed"},
      {"--shrink", "lipschitz"},
      {"--lipschitz-", "lipschitz"},
      {"--local-", "lipschitz-local"},
      {"--bisect-", "max-mip-bisect"},
      {"--function-step", "fixed-step"},
      {"--function-tolerance", "naive"},
      {"--function-tolerance", "relaxed"},
      {"--refine", "naive"},
      {"--refine", "fixed-step"},
      {"--refine", "relaxed"},
  };
  for (const std::string& option : given) {
    std::vector<std::string_view> theirs;
    for (const auto& of : kOf) {
      if (option.starts_with(of.beginning)) theirs.push_back(of.march);
    }
    if (theirs.empty() || std::find(theirs.begin(), theirs.end(), march) != theirs.end()) continue;
    throw Error(fmt::format("{}: goes with --march {}, and the march is {}; leave it out", option,
                            fmt::join(theirs, ", "), march));
  }
  require_company({{{"--refine-halvings"}, settings.sampling.refinement == Refinement::bisect, "--refine bisect"}},
                  given);
}

}  // namespace scarp::cli
