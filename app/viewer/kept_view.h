// SPDX-License-Identifier: MIT
// What the window keeps of each input between runs: the last view, bookmarks and the measured line. A small text file
// per input, in scarp/views in the XDG configuration folder.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/viewer/navigation.h"

namespace scarp::viewer {

/// Heights are those of the input, without exaggeration.
struct KeptView {
  std::optional<Pose> pose{};
  std::array<std::optional<Pose>, 9> bookmarks{};
  std::optional<std::pair<dvec3, dvec3>> line{};
};

/// The file of these inputs, named after the first one and the paths of all; empty if there is no settings folder, or
/// an input is something else than a file.
std::string view_file(const std::string& settings_file, const std::vector<std::string>& inputs);
/// Reads the file; lines that are wrong have no effect.
KeptView read_view(const std::string& file);
/// Returns false if the file cannot be written.
bool write_view(const std::string& file, const KeptView& view);

}  // namespace scarp::viewer
