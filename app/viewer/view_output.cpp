// SPDX-License-Identifier: MIT
#include "app/viewer/view_output.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"
#include "scarp/output/png.h"

namespace scarp::viewer {
namespace {

constexpr const char* kPathFile = "scarp-path.csv";

}  // namespace

bool has_haze(const PictureSettings& picture) {
  return std::isinf(picture.haze_distance) && picture.fog.kind == FogKind::none;
}

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
    text += fmt::format(" --aa {} --samples {}", picture.aa, picture.samples);
    // That of functions is a distance, which --haze sets.
    if (has_haze(picture) || options.is_given("--haze")) text += fmt::format(" --haze {:.17g}", picture.haze);
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
  ReplaceFile replace(kPathFile);
  std::string text;
  if (std::filesystem::exists(kPathFile)) {
    std::ifstream before(kPathFile, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(before), {});
    if (!before) throw Error(fmt::format("'{}' cannot be read", kPathFile));
  }
  if (text.empty()) text = "x,y,z,tx,ty,tz\n";
  text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", pose.eye.x, pose.eye.y, pose.eye.z, target.x,
                      target.y, target.z);
  std::ofstream out(replace.temporary_path(), std::ios::binary);
  out << text;
  out.close();
  if (!out) throw Error(fmt::format("'{}' cannot be written; is the disk full?", kPathFile));
  replace.commit();
  return kPathFile;
}

}  // namespace scarp::viewer
