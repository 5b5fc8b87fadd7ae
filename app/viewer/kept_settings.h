// SPDX-License-Identifier: MIT
// Settings that the window keeps between runs: scarp/view in the XDG configuration folder.
#pragma once

#include <string>

namespace scarp::viewer {

struct KeptSettings {
  int width = 1280, height = 720;  ///< of the window
  bool panel = true;               ///< whether it is visible
};

/// $XDG_CONFIG_HOME/scarp/view, or ~/.config/scarp/view; empty if neither variable is set.
std::string settings_file();
/// Reads the file; keeps the defaults for everything missing or wrong.
KeptSettings read_settings(const std::string& file);
/// Writes a text, and the folders of the file if they are missing. Returns false if that fails.
bool write_kept(const std::string& file, const std::string& text);
/// Returns false if the file cannot be written.
bool write_settings(const std::string& file, const KeptSettings& settings);

}  // namespace scarp::viewer
