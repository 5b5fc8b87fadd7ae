// SPDX-License-Identifier: MIT
#include "app/cli/function_input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "app/cli/numbers.h"
#include "scarp/march/function/presets.h"
#include "scarp/scene/file/example_functions.h"

namespace scarp::cli {
namespace {

constexpr const char* kGroup = "Terrain functions";

}  // namespace

void add_function_option(CLI::App& command, FunctionInput& input, const std::string& extent) {
  std::vector<std::string_view> names;
  for (const ExampleFunction& example : example_functions()) names.push_back(example.name);
  command
      .add_option(
          "--function", input.function,
          fmt::format("in the place of files: {}, or a JSON file (doc/user/functions.md)", fmt::join(names, ", ")))
      ->group(kGroup);
  command.add_option("--extent", input.extent, extent)
      ->check(number_in({.least = 0, .most = kFunctionReach, .above_least = true}))
      ->group(kGroup)
      ->capture_default_str();
}

void add_function_options(CLI::App& command, FunctionInput& input, std::string& march, MarchSettings& settings) {
  add_function_option(command, input, "metres of ground that the picture is about; above 0");
  std::vector<std::string_view> presets;
  for (const MarchPreset& preset : march_presets()) presets.push_back(preset.name);
  command
      .add_option_function<std::string>(
          "--preset",
          [&input, &march, &settings](const std::string& name) {
            const MarchPreset& preset = find_march_preset(name);
            input.preset = name;
            march = preset.march;
            settings = preset.settings;
          },
          fmt::format("a march with the numbers of a known shader: {}; see 'scarp marches --presets'",
                      fmt::join(presets, ", ")))
      ->group(kGroup);
}

}  // namespace scarp::cli
