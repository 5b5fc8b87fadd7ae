// SPDX-License-Identifier: MIT
#include "app/cli/march_options.h"

namespace scarp::cli {

void add_march_options(CLI::App& command, MarchSettings& march) {
  const std::string group = "Settings of marches";
  const auto add = [&](const char* name, auto& value, const char* help) {
    command.add_option(name, value, help)->group(group)->capture_default_str();
  };
  add("--naive-step-factor", march.naive.step_factor, "share of the vertical distance that naive steps; above 0");
  add("--naive-min-step", march.naive.min_step, "its least step, a share of the ray's way out; above 0, at most 1");
  add("--naive-tolerance", march.naive.tolerance,
      "height above ground that it takes for a hit, per distance; 0 or more");
  add("--naive-max-steps", march.naive.max_steps, "its limit of steps; 1 or more");
  add("--fixed-step", march.fixed_step.step, "the step of fixed-step, in cells; above 0");
  add("--fixed-step-interpolate", march.fixed_step.interpolate,
      "whether it puts the hit between the last two samples, or on the last; true or false");
  add("--fixed-step-max-steps", march.fixed_step.max_steps, "its limit of steps; 1 or more");
  add("--relaxed-step-factor", march.relaxed.step_factor, "share of the vertical distance that relaxed steps; above 0");
  add("--relaxed-tolerance", march.relaxed.tolerance,
      "height off the ground that it takes for a hit, per distance; above 0");
  add("--relaxed-max-steps", march.relaxed.max_steps, "its limit of steps; 1 or more");
  add("--shrink", march.lipschitz.shrink,
      "share of the vertical distance that lipschitz steps; above 0, at most 1; 0: what the steepest slope allows");
  add("--lipschitz-tolerance", march.lipschitz.tolerance,
      "distance to the ground that it takes for a hit, per distance travelled; 0 or more");
  add("--lipschitz-max-steps", march.lipschitz.max_steps, "its limit of steps; 1 or more");
  add("--local-tolerance", march.lipschitz_local.tolerance,
      "length of the last interval of lipschitz-local, per distance travelled; 0 or more");
  add("--local-max-steps", march.lipschitz_local.max_steps, "its limit of steps; 1 or more");
  add("--bisect-halvings", march.bisect.halvings, "halvings of max-mip-bisect; 1 to 60");
  const std::string functions = "Settings of marches over terrain functions";
  const auto add_function = [&](const char* name, auto& value, const char* help) {
    command.add_option(name, value, help)->group(functions)->capture_default_str();
  };
  command.add_option("--function-reach", march.function.reach, "metres that a ray is followed; above 0 (any)")
      ->group(functions);
  add_function("--function-step", march.function.step, "the step of fixed-step, metres; above 0");
  add_function("--function-step-share", march.function.step_share,
               "its least step as a share of the distance travelled; 0 or more");
  add_function("--function-tolerance", march.function.tolerance,
               "metres off the ground that naive and relaxed take for a hit at any distance; 0 or more");
  command
      .add_option_function<std::string>(
          "--refine", [&march](const std::string& name) { march.function.refinement = find_refinement(name); },
          "how naive, fixed-step and relaxed narrow down their last interval: none, secant, bisect (none)")
      ->group(functions);
  add_function("--refine-halvings", march.function.halvings, "halvings of bisect; 1 to 60");
}

}  // namespace scarp::cli
