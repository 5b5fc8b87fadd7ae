// SPDX-License-Identifier: MIT
#include "app/viewer/view_output.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "scarp/base/error.h"
#include "scarp/output/png.h"

namespace scarp::viewer {
namespace {

constexpr const char* kPathFile = "scarp-path.csv";

}  // namespace

std::string render_command(const Opening& opening, const Pose& pose, int width, int height, const std::string& output) {
  std::vector<std::string_view> left_out = cli::kWindowOptions;
  // Places of the command are local.
  if (opening.options->mesh.at.empty()) left_out.emplace_back("--coords");
  std::string text =
      fmt::format("scarp render{} -o {} --size {}x{}", opening.command().typed_words(left_out), output, width, height);
  if (pose.mode == MoveMode::top) {
    const auto [low, high] = map_corners(pose, width, height);
    return text + fmt::format(" --top --area={:.17g},{:.17g},{:.17g},{:.17g}", low.x, low.y, high.x, high.y);
  }
  const dvec3 target = pose.eye + forward_of(pose);
  return text + fmt::format(" --eye={:.17g},{:.17g},{:.17g} --target={:.17g},{:.17g},{:.17g} --fov {:.17g}", pose.eye.x,
                            pose.eye.y, pose.eye.z, target.x, target.y, target.z, pose.fov_deg);
}

std::string save_numbered(const Image& image) {
  std::string name;
  for (int i = 1; name.empty() || std::filesystem::exists(name); ++i) name = fmt::format("scarp-view-{}.png", i);
  write_png(name, {image.rgb.data(), image.width, image.height});
  return name;
}

std::string add_to_path(const Pose& pose) {
  const dvec3 target = pose.eye + forward_of(pose);
  const bool begins = !std::filesystem::exists(kPathFile);
  std::FILE* file = std::fopen(kPathFile, "a");
  if (!file) throw Error(fmt::format("'{}' cannot be written", kPathFile));
  if (begins) std::fputs("x,y,z,tx,ty,tz\n", file);
  fmt::print(file, "{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", pose.eye.x, pose.eye.y, pose.eye.z, target.x,
             target.y, target.z);
  if (std::fclose(file) != 0) throw Error(fmt::format("'{}' cannot be written; is the disk full?", kPathFile));
  return kPathFile;
}

}  // namespace scarp::viewer
