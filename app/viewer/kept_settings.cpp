// SPDX-License-Identifier: MIT
#include "app/viewer/kept_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace scarp::viewer {
namespace {

constexpr int kLeastSide = 64, kMostSide = 16384;  // minimum size of a usable window

}  // namespace

double text_size_after(double size, int steps) {
  int nearest = 0;
  const auto count = static_cast<int>(kTextSizes.size());
  const auto at = [](int i) { return kTextSizes[static_cast<std::size_t>(i)]; };
  for (int i = 1; i < count; ++i) {
    if (std::abs(at(i) - size) < std::abs(at(nearest) - size)) nearest = i;
  }
  return at(std::clamp(nearest + steps, 0, count - 1));
}

std::string settings_file() {
  const char* const folder = std::getenv("XDG_CONFIG_HOME");
  // Relative paths count as not set, by the XDG specification.
  if (folder && folder[0] == '/') return std::string(folder) + "/scarp/view";
  const char* const home = std::getenv("HOME");
  return home && home[0] == '/' ? std::string(home) + "/.config/scarp/view" : std::string();
}

KeptSettings read_settings(const std::string& file) {
  KeptSettings settings;
  std::ifstream in(file);
  for (std::string word; in >> word;) {
    if (word == "size") {
      int width = 0, height = 0;
      if (in >> width >> height && width >= kLeastSide && height >= kLeastSide && width <= kMostSide &&
          height <= kMostSide)
        settings.width = width, settings.height = height;
    } else if (word == "panel") {
      bool panel = true;
      if (in >> panel) settings.panel = panel;
    } else if (word == "text") {
      double text = 1;
      if (in >> text) settings.text = text_size_after(text, 0);
    }
  }
  return settings;
}

bool write_kept(const std::string& file, const std::string& text) {
  if (file.empty()) return false;
  std::error_code none;
  std::filesystem::create_directories(std::filesystem::path(file).parent_path(), none);
  std::ofstream out(file);
  out << text;
  out.close();
  return static_cast<bool>(out);
}

bool write_settings(const std::string& file, const KeptSettings& settings) {
  return write_kept(file, fmt::format("size {} {}\npanel {:d}\ntext {}\n", settings.width, settings.height,
                                      settings.panel, settings.text));
}

}  // namespace scarp::viewer
