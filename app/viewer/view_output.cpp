// SPDX-License-Identifier: MIT
#include "app/viewer/view_output.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/cli/options/mesh_options.h"
#include "app/viewer/film_size.h"
#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"
#include "scarp/output/png.h"

namespace scarp::viewer {
namespace {

// The first free name of BEGIN1END, BEGIN2END, ...
std::string first_free(std::string_view begin, std::string_view end) {
  std::string name;
  for (int i = 1; name.empty() || std::filesystem::exists(name); ++i) name = fmt::format("{}{}{}", begin, i, end);
  return name;
}

}  // namespace

std::string render_command(const Opening& opening, const cli::Places& places, const Pose& pose, int width, int height,
                           const std::string& output) {
  std::vector<std::string_view> left_out = cli::kWindowOptions;
  left_out.emplace_back("--coords");
  std::string mesh;
  if (places.frame().coordinates() != Coordinates::local && !opening.options->mesh.at.empty()) {
    left_out.emplace_back("--mesh-at");
    mesh = " --mesh-at=" + cli::local_mesh_at(opening.options->mesh, places);
  }
  const PictureRequest& picture = opening.options->picture;
  const bool large_pixels = entry_of(look_of(picture)).large_pixels;
  if (large_pixels) left_out.emplace_back("--lowres");
  const ImageSize size = film_size(picture, width, height);
  std::string text = fmt::format("scarp render{}{} -o {} {} {}x{}", opening.command().typed_words(left_out), mesh,
                                 output, large_pixels ? "--lowres" : "--size", size.width, size.height);
  if (pose.mode == MoveMode::top) {
    const auto [low, high] = map_corners(pose, size.width, size.height);
    return text + fmt::format(" --top --area={:.17g},{:.17g},{:.17g},{:.17g}", low.x, low.y, high.x, high.y);
  }
  const dvec3 target = pose.eye + forward_of(pose);
  return text + fmt::format(" --eye={:.17g},{:.17g},{:.17g} --target={:.17g},{:.17g},{:.17g} --fov {:.17g}", pose.eye.x,
                            pose.eye.y, pose.eye.z, target.x, target.y, target.z, pose.fov_deg);
}

std::string save_numbered(const Image& image) {
  const std::string name = first_free("scarp-view-", ".png");
  write_png(name, {image.rgb.data(), image.width, image.height});
  return name;
}

std::string save_line(const dvec2& from_lonlat, const dvec2& to_lonlat) {
  std::string name = first_free("scarp-line-", ".geojson");
  ReplaceFile replace(name);
  std::ofstream out(replace.temporary_path());
  // RFC 7946: longitude before latitude, WGS 84.
  out << fmt::format(
      R"({{"type": "FeatureCollection", "features": [{{"type": "Feature", "properties": {{"name": "measured line"}}, )"
      R"("geometry": {{"type": "LineString", "coordinates": [[{:.9f}, {:.9f}], [{:.9f}, {:.9f}]]}}}}]}})"
      "\n",
      from_lonlat.x, from_lonlat.y, to_lonlat.x, to_lonlat.y);
  out.close();
  if (!out) throw Error(fmt::format("'{}': cannot be written; is the disk full?", name));
  replace.commit();
  return name;
}

std::string next_path() { return first_free("scarp-path-", ".csv"); }

void add_to_path(const std::string& file, const Pose& pose) {
  const dvec3 target = pose.eye + forward_of(pose);
  ReplaceFile replace(file);
  std::string text;
  if (std::filesystem::exists(file)) {
    std::ifstream before(file, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(before), {});
    if (!before) throw Error(fmt::format("'{}' cannot be read", file));
  }
  if (text.empty()) text = "x,y,z,tx,ty,tz\n";
  text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", pose.eye.x, pose.eye.y, pose.eye.z, target.x,
                      target.y, target.z);
  std::ofstream out(replace.temporary_path(), std::ios::binary);
  out << text;
  out.close();
  if (!out) throw Error(fmt::format("'{}' cannot be written; is the disk full?", file));
  replace.commit();
}

}  // namespace scarp::viewer
