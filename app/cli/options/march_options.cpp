// SPDX-License-Identifier: MIT
#include "app/cli/options/march_options.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "app/cli/options/open_input.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/voxel/voxel_table.h"

namespace scarp::cli {
namespace {

constexpr Inputs kMarched{kTerrain | kFunction, "what traces voxels and meshes has no settings"};
constexpr Inputs kFunctionsOnly{kFunction, "rasters have cells to measure steps in, and end"};

// Names for completion. The table of each kind of field rejects all others.
std::vector<std::string> march_names() {
  std::vector<std::string> names;
  const auto add = [&](const auto& table) {
    for (const MarchEntry& march : table) {
      if (!is_given(names, march.name)) names.emplace_back(march.name);
    }
  };
  add(height_marches());
  add(function_marches());
  add(voxel_marches());
  return names;
}

}  // namespace

void add_march_option(Command& command, std::string& march) {
  command.add(&march, {.names = "--march",
                       .value = "NAME",
                       .help = "marching technique",
                       .choices = march_names(),
                       .unlisted = true,
                       .note = "see 'scarp marches'",
                       .fallback = fmt::format("{}; voxels: voxel-octants, large models voxel-bricks; functions: {}",
                                               kTerrainMarch, kFunctionMarch),
                       .topic = Topic::march,
                       .common = true,
                       .inputs = {kTerrain | kVoxels | kFunction, "meshes are traced by Embree"}});
}

void add_compare_option(Command& command, std::vector<std::string>& marches, const std::function<bool()>& several) {
  command.add(
      List<std::string>{&marches},
      {.names = "--compare",
       .value = "NAME,NAME,...",
       .help = "one picture with a vertical strip for each of these marches, labelled with its steps and errors",
       .choices = march_names(),
       .closed = true,
       .unlisted = true,
       .topic = Topic::march,
       .inputs = {kTerrain | kVoxels | kFunction, "meshes are traced by Embree"},
       .looks = {"shaded hillshade height steps cost error level slope aspect multidirectional", "it has its own rays"},
       .rules = {{"describes one picture, without --path or --turntable", [several] { return !several(); }}},
       .excludes = {"--march"}});
}

namespace {

constexpr NumberRange kSteps{.least = 1}, kHalvings{1, 60};

void add_fixed_step_options(Command& command, FixedStepSettings& fixed_step, std::optional<bool>* typed) {
  // Over a single raster, the look comanche steps by its own rules (step_march_of() in frame_view.h).
  std::vector<Rule> plain;
  if (command.find("--steps")) {
    plain.push_back({"has no effect with --look comanche or --lowres, whose rays take --steps N",
                     [&command] {
                       return command.given("--mesh") ||
                              (command.value("--look") != "comanche" && !command.given("--lowres"));
                     },
                     kTerrain});
  }
  command.add(&fixed_step.step, {.names = "--fixed-step",
                                 .help = "step length in cells",
                                 .range = kAboveZero,
                                 .topic = Topic::march,
                                 .inputs = {kTerrain, "functions have --function-step M"},
                                 .marches = "fixed-step",
                                 .rules = plain});
  const auto set_interpolate = [&fixed_step, typed](const std::string& text) {
    fixed_step.interpolate = text == "true";
    if (typed) *typed = fixed_step.interpolate;
  };
  command.add(set_interpolate, {.names = "--fixed-step-interpolate",
                                .value = "BOOL",
                                .help = "hit between the last two samples instead of at the last one",
                                .choices = {"true", "false"},
                                .closed = true,
                                .fallback = typed ? "true; with --shells false" : "true",
                                .now = [&fixed_step] { return std::string(fixed_step.interpolate ? "true" : "false"); },
                                .topic = Topic::march,
                                .inputs = kMarched,
                                .marches = "fixed-step"});
  command.add(&fixed_step.max_steps, {.names = "--fixed-step-max-steps",
                                      .help = "maximum number of steps",
                                      .range = kSteps,
                                      .topic = Topic::march,
                                      .inputs = kMarched,
                                      .marches = "fixed-step",
                                      .rules = plain});
}

void add_refinement_options(Command& command, SamplingSettings& sampling) {
  command.add([&sampling](const std::string& name) { sampling.refinement = find_refinement(name); },
              {.names = "--refine",
               .value = "KIND",
               .help = "refinement of a hit within the last step",
               .choices = {std::string(name_of(Refinement::none)), std::string(name_of(Refinement::secant)),
                           std::string(name_of(Refinement::bisect))},
               .closed = true,
               .fallback = std::string(name_of(sampling.refinement)),
               .topic = Topic::march,
               .inputs = kMarched,
               .looks = {"shaded hillshade height steps cost error level slope aspect multidirectional",
                         "it has --fixed-step-interpolate instead"},
               .marches = "naive fixed-step relaxed"});
  command.add(&sampling.halvings,
              {.names = "--refine-halvings",
               .help = "halvings of the last step",
               .range = kHalvings,
               .topic = Topic::march,
               .inputs = kMarched,
               .marches = "naive fixed-step relaxed",
               .rules = {needs("--refine bisect", [&sampling] { return sampling.refinement == Refinement::bisect; })}});
}

}  // namespace

void add_march_options(Command& command, MarchSettings& march, std::optional<bool>* interpolate) {
  const auto add = [&](const char* name, Binding to, const char* help, const NumberRange& range,
                       std::string_view marches, const char* note = "", const Inputs& inputs = kMarched) {
    command.add(to, {.names = name,
                     .help = help,
                     .range = range,
                     .note = note,
                     .topic = Topic::march,
                     .inputs = inputs,
                     .marches = marches});
  };
  constexpr NumberRange kShare{.least = 0, .most = 1, .above_least = true};
  NaiveSettings& naive = march.naive;
  add("--naive-step-factor", &naive.step_factor, "step as a fraction of the vertical distance", kAboveZero, "naive");
  add("--naive-min-step", &naive.min_step, "minimum step as a fraction of the exit distance", kShare, "naive");
  add("--naive-tolerance", &naive.tolerance, "height above ground that counts as a hit, per unit of distance",
      kZeroOrMore, "naive");
  add("--naive-max-steps", &naive.max_steps, "maximum number of steps", kSteps, "naive");
  add_fixed_step_options(command, march.fixed_step, interpolate);
  RelaxedSettings& relaxed = march.relaxed;
  add("--relaxed-step-factor", &relaxed.step_factor, "step as a fraction of the vertical distance", kAboveZero,
      "relaxed");
  add("--relaxed-tolerance", &relaxed.tolerance, "height off the ground that counts as a hit, per unit of distance",
      kAboveZero, "relaxed");
  add("--relaxed-max-steps", &relaxed.max_steps, "maximum number of steps", kSteps, "relaxed");
  LipschitzSettings& lipschitz = march.lipschitz;
  add("--shrink", &lipschitz.shrink, "step as a fraction of the vertical distance", {0, 1}, "lipschitz",
      "0: the largest factor that the steepest slope proves; larger factors are approximate");
  add("--lipschitz-tolerance", &lipschitz.tolerance,
      "distance to the ground that counts as a hit, per unit of distance travelled", kZeroOrMore, "lipschitz");
  add("--lipschitz-max-steps", &lipschitz.max_steps, "maximum number of steps", kSteps, "lipschitz");
  add("--local-tolerance", &march.lipschitz_local.tolerance, "length of the last interval per unit of distance",
      kZeroOrMore, "lipschitz-local");
  add("--local-max-steps", &march.lipschitz_local.max_steps, "maximum number of steps", kSteps, "lipschitz-local");
  add("--bisect-halvings", &march.bisect.halvings, "halvings of the last interval", kHalvings, "max-mip-bisect");
  add_refinement_options(command, march.sampling);
  FunctionMarchSettings& function = march.function;
  command.add(&function.reach, {.names = "--function-reach",
                                .help = "maximum length of a ray",
                                .unit = "metres",
                                .range = kAboveZero,
                                .fallback = "unlimited",
                                .topic = Topic::march,
                                .inputs = kFunctionsOnly});
  add("--function-step", &function.step, "step length in metres", kAboveZero, "fixed-step", "", kFunctionsOnly);
  add("--function-step-share", &function.step_share, "minimum step as a fraction of the distance travelled",
      kZeroOrMore, "fixed-step", "", kFunctionsOnly);
  add("--function-tolerance", &march.sampling.tolerance, "metres off the ground that count as a hit at any distance",
      kZeroOrMore, "naive relaxed", "", kFunctionsOnly);
}

}  // namespace scarp::cli
