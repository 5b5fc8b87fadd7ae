// SPDX-License-Identifier: MIT
#include "app/cli/commands/scan.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/output/las_crs.h"
#include "scarp/output/point_file.h"
#include "scarp/scene/lidar.h"

namespace scarp::cli {
namespace {

// Rays are traced and written in pieces, so a scan of any length needs memory for only one piece.
constexpr std::int64_t kScanRaysPerPiece = 1 << 18;
// Columns of fans are walked together in strips of 16 (scene/cast_from.h).
constexpr std::int64_t kColumnsPerStrip = 16;
constexpr float kScanDegrees = static_cast<float>(180 / std::numbers::pi);

// Converts the coordinates of the file to metres.
void place_scanner(ScannerFile& file, const ScanOptions& options, const ScannedScene& scanned) {
  const Places& places = scanned.places;
  if (file.lonlat && places.frame().coordinates() != Coordinates::lonlat)
    throw Error(fmt::format("{}: its path has columns lon and lat (give --coords lonlat)", options.scanner));
  for (std::size_t i = 0; i < file.lidar.path.size(); ++i) {
    dvec3& at = file.lidar.path[i].position;
    at = places.world(at, file.places[i]);
    if (!file.lidar.above_ground || scanned.scene.height(at.x, at.y)) continue;
    places.on_surface(at, scanned.scene, file.places[i]);
    throw Error(fmt::format("{}: has no terrain below it (give z, not above)", file.places[i]));
  }
  const dvec3 north = places.frame().direction_to_local({0, 1, 0});
  file.lidar.north = std::atan2(north.x, north.y);
}

// The box that contains the points, in metres; nullopt if it is unbounded.
std::optional<WorldBox> scan_box(const Scene& scene, const Lidar& lidar) {
  if (!scene.endless() && !scene.box().empty()) return scene.box();
  if (std::isinf(lidar.max_range)) return {};
  const LidarMounting& m = lidar.mounting;
  const double size = lidar.max_range + length(dvec3(m.forward, m.right, m.up));
  WorldBox box{lidar.path.front().position, lidar.path.front().position};
  for (const LidarPose& pose : lidar.path) box = {min(box.low, pose.position), max(box.high, pose.position)};
  return WorldBox{box.low - size, box.high + size};
}

LasSettings las_settings_of(const ScannedScene& scanned, const Lidar& lidar, std::vector<std::string>& notes) {
  const CoordinateFrame& frame = scanned.places.frame();
  constexpr double kStep = 0.001, kStepDegrees = 1e-8;  // a millimetre: 1e-8 degrees are 1.1 mm along a meridian
  constexpr double kUnbounded = 1e5;                    // metres around the scanner, if no bounds are known
  const dvec3 start = lidar.path.front().position;
  const WorldBox box = scan_box(scanned.scene, lidar).value_or(WorldBox{start - kUnbounded, start + kUnbounded});
  const dvec3 middle = 0.5 * (box.low + box.high);
  // The corners, and a point one metre away.
  std::array points{box.low, box.high,    dvec3(box.low.x, box.high.y, 0.0), dvec3(box.high.x, box.low.y, 0.0),
                    middle,  middle + 1.0};
  LasSettings las;
  if (frame.from_local(points)) {
    las = las_settings({-180, -90, box.low.z}, {180, 90, box.high.z}, dvec3(kStepDegrees, kStepDegrees, kStep));
  } else {
    dvec3 low = points[0], high = points[0];
    for (int i = 1; i < 4; ++i) low = min(low, points[i]), high = max(high, points[i]);
    low.z = box.low.z, high.z = box.high.z;
    las = las_settings(low, high, kStep * abs(points[5] - points[4]));
  }
  if (frame.coordinates() == Coordinates::lonlat) {
    las.crs_wkt = las_wkt("OGC:CRS84");
  } else if (frame.coordinates() == Coordinates::map && !scanned.georeference.crs_wkt.empty()) {
    las.crs_wkt = las_wkt(scanned.georeference.crs_wkt);
    if (las.crs_wkt.empty())
      notes.push_back(fmt::format("the CRS '{}' has no WKT 1, which LAS requires; the file names none",
                                  scanned.georeference.crs_name));
  }
  return las;
}

struct ScanCounts {
  std::int64_t rays = 0, hits = 0, below = 0, exhausted = 0;
};

// Converts the returns of a piece. Throws Error for a position without longitude and latitude.
void take_returns(std::span<const LidarReturn> returns, const CoordinateFrame& frame, bool misses,
                  std::vector<ScanPoint>& points, ScanCounts& counts) {
  points.clear();
  std::vector<dvec3> positions;
  for (const LidarReturn& answer : returns) {
    ++counts.rays;
    if (answer.status == HitStatus::below) ++counts.below;
    if (answer.status == HitStatus::exhausted) ++counts.exhausted;
    if (answer) {
      ++counts.hits;
      positions.push_back(answer.position);
    } else if (!misses) {
      continue;
    }
    ScanPoint& point = points.emplace_back();
    point.time = answer.time, point.column = answer.column, point.channel = answer.channel;
    point.object = answer.object;
    point.azimuth = answer.azimuth * kScanDegrees, point.elevation = answer.elevation * kScanDegrees;
    point.scan_angle = answer.scan_angle * kScanDegrees;
    point.range = answer.range;
    point.hit = static_cast<bool>(answer);
  }
  if (frame.from_local(positions))
    throw Error("a point of the scan is at a place that has no longitude and latitude; use --coords map");
  auto next = positions.begin();
  for (ScanPoint& point : points) {
    if (point.hit) point.position = *next++;
  }
}

std::string scan_finding(const ScanCounts& counts, const ScannedScene& scanned, const LidarScan& scan) {
  if (counts.rays == 0) return "the path is shorter than a column of the scanner: 0 rays, and no points in the output";
  if (counts.hits > 0) return {};
  const dvec3 start = scan.lidar().path.front().position;
  const WorldBox box = ground_box(scanned.scene);
  const bool over = scanned.scene.endless() ||
                    (start.x >= box.low.x && start.x <= box.high.x && start.y >= box.low.y && start.y <= box.high.y);
  const std::string bounds = scanned.places.bounds_text(scanned.scene);
  std::array shown{start};
  if (!over && !bounds.empty() && !scanned.places.frame().from_local(shown)) {
    return fmt::format(
        "nothing was hit: the scanner starts at x {:.8g}, y {:.8g}; the scene is in {} coordinates {} "
        "(--coords)",
        shown[0].x, shown[0].y, name_of(scanned.places.frame().coordinates()), bounds);
  }
  if (counts.below > 0) {
    return fmt::format(
        "nothing was hit: {} of {} rays start below ground, or enter it through its border, and never emerge; check "
        "the height of the scanner",
        counts.below, counts.rays);
  }
  if (counts.exhausted > 0) {
    return fmt::format(
        "nothing was hit: {} of {} rays are too long for ground that repeats, and were given up; set a shorter range",
        counts.exhausted, counts.rays);
  }
  return fmt::format("nothing was hit: all {} rays end above the ground, or beyond the range", counts.rays);
}

}  // namespace

void add_scan_options(Command& command, ScanOptions& o) {
  command.add(&o.scanner, {.names = "--scanner",
                           .value = "FILE",
                           .help = "scanner that stands or moves: .json, instead of a table of rays",
                           .files = "json",
                           .fallback = "none",
                           .common = true,
                           .excludes = {"--rays"}});
  command.add(&o.misses, {.names = "--misses",
                          .help = "also rays without a hit, in .csv and .npy",
                          .rules = {needs("--scanner FILE", [&o] { return !o.scanner.empty(); })}});
}

void check_scan_output(const ScanOptions& options, const std::string& output) {
  const PointKind kind = point_kind_of(output);
  if (options.misses && (kind == PointKind::ply || kind == PointKind::las))
    throw Error(fmt::format("--misses: '{}' holds points only (write .csv or .npy)", output));
}

void run_scan(const ScanOptions& options, ScannerFile file, const ScannedScene& scanned, const std::string& output,
              const std::vector<std::string>& notes, const std::string& device) {
  place_scanner(file, options, scanned);
  std::vector<std::string> all_notes = notes;
  std::optional<LidarScan> made;
  try {
    made.emplace(scanned.scene, std::move(file.lidar));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", options.scanner, error.what()));
  }
  const LidarScan& scan = *made;
  const bool las = point_kind_of(output) == PointKind::las;
  PointFile out(output, las ? las_settings_of(scanned, scan.lidar(), all_notes) : LasSettings{});
  const Progress progress = terminal_progress("cast");
  const auto channels = static_cast<std::int64_t>(scan.lidar().channels());
  const std::int64_t piece =
      std::max(std::int64_t{1}, kScanRaysPerPiece / channels / kColumnsPerStrip) * kColumnsPerStrip;
  ScanCounts counts;
  double seconds = 0;
  std::vector<LidarReturn> returns;
  std::vector<ScanPoint> points;
  for (std::int64_t first = 0; first < scan.columns(); first += piece) {
    const std::int64_t count = std::min(piece, scan.columns() - first);
    const auto begin = std::chrono::steady_clock::now();
    try {
      scan.cast(first, count, returns);
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", options.scanner, error.what()));
    }
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    take_returns(returns, scanned.places.frame(), options.misses, points, counts);
    out.add(points);
    if (!progress(static_cast<double>(first + count) / static_cast<double>(scan.columns()))) throw Interrupted();
  }
  out.commit();
  if (const std::string note = scan_finding(counts, scanned, scan); !note.empty()) all_notes.push_back(note);
  print_notes(all_notes);
  if (::isatty(STDERR_FILENO) != 0) {
    constexpr double kTick_s = 1e-9;  // resolution of the clock
    fmt::print(stderr, "{} rays, {} points; {:.3g} s, {:.3g} Mrays/s{}\n", counts.rays, counts.hits, seconds,
               static_cast<double>(counts.rays) / std::max(seconds, kTick_s) * 1e-6,
               device.empty() ? "" : ", on " + device);
  }
}

}  // namespace scarp::cli
