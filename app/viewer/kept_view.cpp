// SPDX-License-Identifier: MIT
#include "app/viewer/kept_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/viewer/kept_settings.h"

namespace scarp::viewer {
namespace {

constexpr std::array<const char*, 4> kModes = {"orbit", "fly", "walk", "top"};

std::string text_of(const Pose& pose) {
  return fmt::format("{} {} {} {} {} {} {} {} {}", kModes[static_cast<std::size_t>(pose.mode)], pose.eye.x, pose.eye.y,
                     pose.eye.z, pose.azimuth, pose.altitude, pose.distance, pose.fov_deg, pose.map_width);
}

bool read_finite(std::istream& in, std::initializer_list<double*> numbers) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [&](double* number) { return static_cast<bool>(in >> *number) && std::isfinite(*number); });
}

std::optional<Pose> read_pose(std::istream& in) {
  Pose pose;
  std::string mode;
  in >> mode;
  const auto found = std::find(kModes.begin(), kModes.end(), mode);
  if (found == kModes.end() || !read_finite(in, {&pose.eye.x, &pose.eye.y, &pose.eye.z, &pose.azimuth, &pose.altitude,
                                                 &pose.distance, &pose.fov_deg, &pose.map_width}))
    return {};
  const bool good = pose.distance > 0 && pose.fov_deg >= Navigator::kLeastFov && pose.fov_deg <= Navigator::kMostFov &&
                    std::abs(pose.altitude) < 1.6 && pose.map_width >= 0;
  pose.mode = static_cast<MoveMode>(found - kModes.begin());
  return good ? std::optional(pose) : std::nullopt;
}

}  // namespace

std::string view_file(const std::string& settings_file, const std::vector<std::string>& inputs) {
  if (settings_file.empty() || inputs.empty()) return {};
  // FNV-1a, which is the same everywhere.
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::string& input : inputs) {
    std::error_code none;
    if (!std::filesystem::exists(input, none)) return {};
    for (const char c : std::filesystem::absolute(input, none).lexically_normal().string() + '\n')
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  const std::filesystem::path folder = std::filesystem::path(settings_file).parent_path();
  return folder / "views" / fmt::format("{}-{:016x}", std::filesystem::path(inputs.front()).stem().string(), hash);
}

KeptView read_view(const std::string& file) {
  KeptView view;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string what;
    words >> what;
    if (what == "view") {
      view.pose = read_pose(words);
    } else if (what == "bookmark") {
      std::size_t number = 0;
      if (words >> number && number >= 1 && number <= view.bookmarks.size())
        view.bookmarks[number - 1] = read_pose(words);
    } else if (what == "line") {
      dvec3 from, to;
      if (read_finite(words, {&from.x, &from.y, &from.z, &to.x, &to.y, &to.z})) view.line = {from, to};
    }
  }
  return view;
}

bool write_view(const std::string& file, const KeptView& view) {
  std::string text;
  if (view.pose) text += fmt::format("view {}\n", text_of(*view.pose));
  for (std::size_t i = 0; i < view.bookmarks.size(); ++i) {
    if (view.bookmarks[i]) text += fmt::format("bookmark {} {}\n", i + 1, text_of(*view.bookmarks[i]));
  }
  if (view.line) {
    const auto& [from, to] = *view.line;
    text += fmt::format("line {} {} {} {} {} {}\n", from.x, from.y, from.z, to.x, to.y, to.z);
  }
  return write_kept(file, text);
}

}  // namespace scarp::viewer
