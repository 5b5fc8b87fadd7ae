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

std::string render_command(const cli::ViewOptions& options, const Pose& pose, const PictureSettings& picture,
                           const std::string& output) {
  const dvec3 target = pose.eye + forward_of(pose);
  std::string text =
      fmt::format("scarp render{} -o {} --size {}x{}", options.words, output, picture.width, picture.height);
  if (pose.mode == MoveMode::top) {
    text += " --top";
  } else {
    text += fmt::format(" --eye={:.17g},{:.17g},{:.17g} --target={:.17g},{:.17g},{:.17g} --fov {:.17g}", pose.eye.x,
                        pose.eye.y, pose.eye.z, target.x, target.y, target.z, pose.fov_deg);
  }
  text += fmt::format(" --look {}", name_of(picture.look));
  if (picture.look == Look::shaded || picture.look == Look::hillshade)
    text += fmt::format(" --sun {:.17g},{:.17g}", picture.sun.azimuth_deg, picture.sun.altitude_deg);
  if (picture.look == Look::shaded) {
    text += fmt::format(" --aa {} --samples {} --haze {:.17g}", picture.aa, picture.samples, picture.haze);
    if (!picture.shadows) text += " --no-shadows";
    if (picture.water) text += fmt::format(" --water {:.17g}", picture.water->level);
  }
  if (!options.march.empty()) text += " --march " + options.march;
  return text;
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
