// SPDX-License-Identifier: MIT
#include "app/cli/input_kind.h"

#include <fmt/format.h>

#include "app/cli/scene_input.h"
#include "scarp/base/error.h"

namespace scarp::cli {

InputKind kind_of_input(const Command& command, const std::vector<std::string>& inputs, const VoxOptions& vox,
                        const FunctionInput& function) {
  if (!function.function.empty()) {
    if (inputs.empty()) return InputKind::function;
    throw Error(fmt::format("'{}': --function replaces files (give one of the two)", inputs.front()));
  }
  if (inputs.empty())
    throw WrongUsage(fmt::format("IN (or --function NAME) is required (see 'scarp {} --help')", command.name()));
  if (is_scene_input(inputs)) return InputKind::scene;
  return is_vox_input(inputs, vox) ? InputKind::voxels : InputKind::terrain;
}

}  // namespace scarp::cli
