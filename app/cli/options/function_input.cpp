// SPDX-License-Identifier: MIT
#include "app/cli/options/function_input.h"

#include <utility>
#include <vector>

#include "app/options/numbers.h"
#include "scarp/field/height_function.h"
#include "scarp/march/function/presets.h"
#include "scarp/scene/file/example_functions.h"

namespace scarp::cli {

void add_function_option(Command& command, FunctionInput& input, const std::string& extent) {
  std::vector<std::string> names;
  for (const ExampleFunction& example : example_functions()) names.emplace_back(example.name);
  command.add(&input.function, {.names = "--function",
                                .value = "NAME",
                                .help = "terrain function instead of files",
                                .choices = std::move(names),
                                .files = "json",
                                .note = "or a JSON file (doc/user/functions.md)",
                                .topic = Topic::functions,
                                .common = true,
                                .inputs = {kFunction}});
  if (extent.empty()) return;
  command.add(&input.extent, {.names = "--extent",
                              .help = extent,
                              .unit = "metres",
                              .range = {.least = 0, .most = kFunctionReach, .above_least = true},
                              .topic = Topic::functions,
                              .inputs = {kFunction, "files have an extent"}});
}

void add_function_options(Command& command, FunctionInput& input, const std::string& extent, std::string& march,
                          MarchSettings& settings) {
  add_function_option(command, input, extent);
  std::vector<std::string> presets;
  for (const MarchPreset& preset : march_presets()) presets.emplace_back(preset.name);
  command.add(
      [&input, &march, &settings](const std::string& name) {
        const MarchPreset& preset = find_march_preset(name);
        input.preset = name;
        march = preset.march;
        settings = preset.settings;
      },
      {.names = "--preset",
       .value = "NAME",
       .help = "march and settings of a known shader",
       .choices = std::move(presets),
       .unlisted = true,
       .note = "see 'scarp marches --presets'",
       .topic = Topic::functions,
       .first = true,
       .inputs = {kFunction, "add --function: presets are settings of shaders over functions"}});
}

}  // namespace scarp::cli
