// SPDX-License-Identifier: MIT
#include "app/cli/options/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>

#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/render/camera/camera_path.h"
#include "scarp/source/table/ray_table.h"

namespace scarp::cli {
namespace {

constexpr int kMostFrames = 1000000;
constexpr int kUsualFrames = 120;  // of turntables and animations

// The #s must be in the name, not in its folders.
struct Place {
  std::size_t first, count;
};
Place place_of_number(const std::string& output) {
  const std::size_t folder = output.find_last_of('/');
  const std::size_t first = output.find('#', folder == std::string::npos ? 0 : folder);
  if (first == std::string::npos) return {0, 0};
  const std::size_t end = output.find_first_not_of('#', first);
  return {first, (end == std::string::npos ? output.size() : end) - first};
}

// Places an eye at its height above the surface. A view direction does not change.
void lift(CameraStation& station, const RayTable& table, const PathPlaces& path, const std::string& what) {
  const dvec3 eye = path.above_surface(station.eye, what);
  if (table.aim == RayAim::direction) station.target.z += eye.z - station.eye.z;
  station.eye = eye;
}

// One station per row, in world metres.
std::vector<CameraStation> stations_of(const RayTable& table, const PathPlaces& path) {
  std::vector<CameraStation> stations;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const RayRow& row = table.rows[i];
    const std::string what = table.where(i);
    CameraStation station{path.places.world(row.origin, what), {}};
    if (table.aim == RayAim::direction) {
      station.target = station.eye + path.places.world_direction(row.aim);
    } else {
      station.target = path.places.world(row.aim, what);
      if (!table.has_target_z) station.target = path.places.on_surface(station.target, path.scene, what);
    }
    if (!table.has_z) lift(station, table, path, what);
    stations.push_back(station);
  }
  return stations;
}

}  // namespace

int FrameOptions::chosen() const { return frames > 0 ? frames : kUsualFrames; }

void add_frame_options(Command& command, FrameOptions& o) {
  const auto several = [&o] { return o.several(); };
  command.add(&o.path,
              {.names = "--path",
               .value = "FILE",
               .help = "table of cameras: columns x,y[,z] of the eye and tx,ty[,tz] of the target, or dx,dy,dz "
                       "of the direction, in coordinates of --coords",
               .files = "csv npy",
               .note = "with --coords lonlat also lon,lat and tlon,tlat; eyes without z are --eye-above M over the "
                       "ground; the output is frame-####.png",
               .topic = Topic::flight});
  command.add(&o.turntable, {.names = "--turntable",
                             .help = "one orbit around the scene, clockwise from --view; the output is frame-####.png",
                             .topic = Topic::flight,
                             .common = true,
                             .excludes = {"--path"}});
  command.add(&o.animated, {.names = "--animate",
                            .value = "NAME=VALUE",
                            .help = "frames in which the option NAME changes: its value, with ranges FROM..TO for "
                                    "numbers",
                            .note = "shrink=1..0.2, sun=90..270,30; several options change together; the output is "
                                    "frame-####.png, or a .gif or .mp4 film by ffmpeg",
                            .repeats = true,
                            .topic = Topic::flight,
                            .excludes = {"--path", "--turntable"}});
  command.add(&o.frames, {.names = "--frames",
                          .help = "number of frames",
                          .range = {1, kMostFrames},
                          .fallback = fmt::format("one per row of --path; otherwise {}", kUsualFrames),
                          .topic = Topic::flight,
                          .common = true,
                          .rules = {needs("--path FILE, --turntable or --animate", several)}});
  command.add(&o.per_second, {.names = "--fps",
                              .help = "frames per second of a film",
                              .range = {.least = 0.1, .most = 240},
                              .topic = Topic::flight,
                              .rules = {{"applies to .gif and .mp4 files only", [&o] { return !o.film.empty(); }}}});
  command.add(&o.overwrite, {.names = "--overwrite",
                             .help = "existing frames are rendered again instead of kept",
                             .topic = Topic::flight,
                             .rules = {needs("--path FILE, --turntable or --animate", several)}});
}

void check_frames(const FrameOptions& o, const std::string& output) {
  if (o.several() && o.film.empty() && place_of_number(output).count == 0) {
    throw Error(fmt::format(
        "output '{}': frames need a place for their number (name it frame-####.png, or *.gif or *.mp4 for a film)",
        output));
  }
}

std::vector<Camera> frame_cameras(const FrameOptions& o, const ViewSettings& view, int width, int height,
                                  const std::function<Camera(const ViewSettings&)>& framed, const PathPlaces& path) {
  std::vector<Camera> cameras;
  if (o.turntable) {
    const int frames = o.chosen();
    for (int i = 0; i < frames; ++i) {
      ViewSettings turned = view;
      turned.azimuth_deg += 360.0 * i / frames;
      cameras.push_back(framed(turned));
    }
    return cameras;
  }
  const RayTable table = read_rays(o.path, RayRows::cameras);
  if (table.rows.empty()) throw Error(fmt::format("path '{}': has no rows; one camera each is expected", o.path));
  if (table.lonlat && path.places.frame().coordinates() != Coordinates::lonlat)
    throw Error(fmt::format("path '{}': has columns lon and lat (give --coords lonlat)", o.path));
  if (table.has_z == static_cast<bool>(path.above_surface)) {
    throw Error(fmt::format("path '{}': {}", o.path,
                            table.has_z ? "has heights of the eye, which --eye-above replaces (leave out the column z)"
                                        : "has no column 'z' (give --eye-above M)"));
  }
  std::vector<CameraStation> stations = stations_of(table, path);
  if (o.frames > 0) {
    const CameraPath smooth(std::move(stations));
    stations.clear();
    for (int i = 0; i < o.frames; ++i) {
      CameraStation station = smooth.at(o.frames > 1 ? i / (o.frames - 1.0) : 0.0);
      if (!table.has_z) lift(station, table, path, fmt::format("{}: frame {}", table.path, i));
      stations.push_back(station);
    }
  }
  for (const CameraStation& station : stations)
    cameras.push_back(Camera::look_at(station.eye, station.target, view.fov_deg, width, height));
  return cameras;
}

std::string frame_name(const std::string& output, int i) {
  const Place place = place_of_number(output);
  std::string name = output;
  if (place.count == 0) return name;
  return name.replace(place.first, place.count, fmt::format("{:0{}}", i, place.count));
}

void make_frames(const FrameOptions& o, const std::string& output, int frames,
                 const std::function<void(int, const FrameFile&)>& make) {
  const Progress progress = terminal_progress("frames");
  const bool film = !o.film.empty();
  int kept = 0;
  for (int i = 0; i < frames; ++i) {
    const std::string name = frame_name(output, i);
    if (!film && !o.overwrite && std::filesystem::exists(name)) {
      ++kept;
      continue;
    }
    stop_if_interrupted();
    make(i, {name, film ? fmt::format("{}, frame {}", o.film, i) : name});
    if (film) o.add_to_film();
    if (progress) progress((i + 1.0) / frames);
  }
  if (film) o.end_film();
  if (o.quiet) return;
  if (film) {
    fmt::print("{}: {} frames, {:g} per second\n", o.film, frames, o.per_second);
    return;
  }
  fmt::print("{}: {} frames, {} made now{}\n", output, frames, frames - kept,
             kept > 0 ? fmt::format(", {} kept; --overwrite renders all again", kept) : "");
}

}  // namespace scarp::cli
