// SPDX-License-Identifier: MIT
// Settings that the window keeps between runs: scarp/view in the XDG configuration folder.
#pragma once

#include <array>
#include <string>

namespace scarp::viewer {

struct KeptSettings {
  int width = 0, height = 0;  ///< of the window; 0: not kept yet
  bool panel = true;          ///< whether it is visible
  double text = 1;            ///< size of text, one of kTextSizes
};

/// Sizes of text, as multiples of the usual one, ascending.
inline constexpr std::array kTextSizes = {1.0, 1.25, 1.5, 2.0};
/// The size that is `steps` larger, within kTextSizes.
double text_size_after(double size, int steps);

/// $XDG_CONFIG_HOME/scarp/view, or ~/.config/scarp/view; empty if neither variable is set.
std::string settings_file();
/// Reads the file; keeps the defaults for everything missing or wrong.
KeptSettings read_settings(const std::string& file);
/// Writes a text, and the folders of the file if they are missing. Returns false if that fails.
bool write_kept(const std::string& file, const std::string& text);
/// Returns false if the file cannot be written.
bool write_settings(const std::string& file, const KeptSettings& settings);

}  // namespace scarp::viewer
