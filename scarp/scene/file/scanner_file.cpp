// SPDX-License-Identifier: MIT
#include "scarp/scene/file/scanner_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/scene/file/json_object.h"
#include "scarp/scene/file/scene_schema.h"
#include "scarp/source/table/pose_table.h"

namespace scarp {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr double kScannerDegree = std::numbers::pi / 180;
constexpr std::int64_t kMostChannels = 4096, kMostColumns = 1 << 20, kMostTurns = 1 << 30;
constexpr const char* kElevations =
    "degrees above the horizon, one per channel: a list, or an object with from, to and count";
constexpr const char* kAzimuths = "an object: count per turn, and from and step in degrees if it is not a whole turn";
constexpr const char* kRate = "turns per second, a number above 0";

// The value of a required key.
const Json& needed(JsonObject& object, std::string_view key, std::string_view expected) {
  const Json* value = object.find(key);
  if (!value) throw Error(fmt::format("{}: is missing; expected {}", object.path_of(key), expected));
  return *value;
}

double number_in(const Json& value, const std::string& path, double least, double most, std::string_view expected) {
  if (!value.is_number()) refuse_json(path, value, expected);
  const auto number = value.get<double>();
  if (!(number >= least && number <= most)) refuse_json(path, value, expected);
  return number;
}

constexpr double kLargest = 1e12;

double any_number(const Json& value, const std::string& path, std::string_view expected) {
  return number_in(value, path, -kLargest, kLargest, expected);
}

std::vector<double> numbers_of(const Json& list, const std::string& path, double least, double most,
                               std::string_view expected) {
  if (!list.is_array()) refuse_json(path, list, fmt::format("a list: {}", expected));
  std::vector<double> numbers;
  for (std::size_t i = 0; i < list.size(); ++i)
    numbers.push_back(number_in(list[i], fmt::format("{}/{}", path, i), least, most, expected));
  return numbers;
}

std::vector<double> elevations_of(const Json& json) {
  const std::string path = "/elevations";
  constexpr const char* kDegrees = "degrees above the horizon, -90 to 90";
  std::vector<double> degrees;
  if (json.is_array()) {
    if (json.empty() || json.size() > static_cast<std::size_t>(kMostChannels))
      refuse_json(path, json, fmt::format("a list of 1 to {} elevations", kMostChannels));
    degrees = numbers_of(json, path, -90, 90, kDegrees);
  } else if (json.is_object()) {
    JsonObject object(json, path);
    const double from = number_in(needed(object, "from", kDegrees), object.path_of("from"), -90, 90, kDegrees);
    const double to = number_in(needed(object, "to", kDegrees), object.path_of("to"), -90, 90, kDegrees);
    needed(object, "count", "the number of channels");
    const std::int64_t count = object.whole("count", 1, 1, kMostChannels);
    object.finish();
    for (std::int64_t i = 0; i < count; ++i)
      degrees.push_back(count == 1 ? from
                                   : from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1));
  } else {
    refuse_json(path, json, kElevations);
  }
  for (double& elevation : degrees) elevation *= kScannerDegree;
  return degrees;
}

void take_azimuths(const Json& json, Lidar& lidar) {
  if (!json.is_object()) refuse_json("/azimuths", json, kAzimuths);
  JsonObject object(json, "/azimuths");
  needed(object, "count", "the number of columns of a turn");
  lidar.columns = static_cast<int>(object.whole("count", 1, 1, kMostColumns));
  constexpr double kWhole = 360;
  double step = kWhole / lidar.columns;
  if (const Json* given = object.find("step")) {
    constexpr const char* kStep = "degrees between columns, clockwise if above 0; count steps are at most a whole turn";
    step = number_in(*given, object.path_of("step"), -kWhole, kWhole, kStep);
    constexpr double kRounded = 1 + 0x1p-52;  // the typed number and the product
    if (step == 0 || std::abs(step) * lidar.columns > kWhole * kRounded)
      refuse_json(object.path_of("step"), *given, kStep);
    // 0.1 is a little more than a tenth.
    step = std::clamp(step, -kWhole / lidar.columns, kWhole / lidar.columns);
  }
  lidar.azimuth_step = step * kScannerDegree;
  if (const Json* from = object.find("from"))
    lidar.first_azimuth =
        number_in(*from, object.path_of("from"), -kWhole, kWhole, "degrees clockwise, -360 to 360") * kScannerDegree;
  object.finish();
}

void take_offsets(JsonObject& scanner, const char* key, std::vector<double>& to, std::size_t channels, double least,
                  double most, double unit, const char* expected) {
  const Json* json = scanner.find(key);
  if (!json) return;
  to = numbers_of(*json, scanner.path_of(key), least, most, expected);
  if (to.size() != channels)
    refuse_json(scanner.path_of(key), *json, fmt::format("a list of {} numbers, one per elevation", channels));
  for (double& number : to) number *= unit;
}

void take_range(JsonObject& scanner, Lidar& lidar) {
  const Json* json = scanner.find("range");
  if (!json) return;
  scanner.pair("range", lidar.min_range, lidar.max_range);
  if (!(lidar.min_range >= 0 && lidar.max_range > lidar.min_range))
    throw Error(fmt::format("/range: is [{}, {}]; expected the smallest and the largest range in metres, 0 or more",
                            lidar.min_range, lidar.max_range));
}

void take_noise(JsonObject& scanner, Lidar& lidar) {
  const Json* json = scanner.find("noise");
  if (!json) return;
  JsonObject noise(*json, "/noise");
  constexpr const char* kDeviation = "the standard deviation of ranges in metres, 0 or more";
  lidar.range_noise = number_in(needed(noise, "range", kDeviation), "/noise/range", 0, kLargest, kDeviation);
  lidar.seed = static_cast<std::uint64_t>(noise.whole("seed", 1, 0, std::numeric_limits<std::int64_t>::max()));
  noise.finish();
}

// Sets angles in radians.
void take_angle(JsonObject& object, const char* key, double& to) {
  if (const Json* json = object.find(key))
    to = number_in(*json, object.path_of(key), -360, 360, "degrees, -360 to 360") * kScannerDegree;
}

void take_mounting(JsonObject& scanner, LidarMounting& mounting) {
  const Json* json = scanner.find("mounting");
  if (!json) return;
  JsonObject object(*json, "/mounting");
  const std::pair<const char*, double*> lengths[] = {
      {"forward", &mounting.forward}, {"right", &mounting.right}, {"up", &mounting.up}};
  for (const auto& [key, to] : lengths) {
    if (const Json* value = object.find(key)) *to = any_number(*value, object.path_of(key), "metres");
  }
  take_angle(object, "yaw", mounting.yaw);
  take_angle(object, "pitch", mounting.pitch);
  take_angle(object, "roll", mounting.roll);
  object.finish();
}

// Reads a pose; returns whether it is relative to the ground.
bool take_pose(const Json& json, const std::string& path, bool moving, LidarPose& pose) {
  JsonObject object(json, path);
  if (moving) {
    pose.time = any_number(needed(object, "time", "seconds"), object.path_of("time"), "seconds");
  }
  constexpr const char* kAt = "[x, y, z], or [x, y] beside above, the metres above ground";
  const Json& at = needed(object, "at", kAt);
  const Json* above = object.find("above");
  if (!at.is_array() || at.size() != (above ? 2 : 3)) refuse_json(object.path_of("at"), at, kAt);
  for (std::size_t i = 0; i < at.size(); ++i)
    pose.position[static_cast<int>(i)] = any_number(at[i], fmt::format("{}/at/{}", path, i), "a coordinate");
  if (above) pose.position.z = any_number(*above, object.path_of("above"), "metres above ground");
  if (moving) needed(object, "heading", "degrees clockwise from north");
  take_angle(object, "heading", pose.heading);
  take_angle(object, "pitch", pose.pitch);
  take_angle(object, "roll", pose.roll);
  object.finish();
  return above != nullptr;
}

void take_table(const std::string& path, ScannerFile& file) {
  const PoseTable table = read_poses(path);
  file.files.push_back(path);
  file.lonlat = table.lonlat;
  file.lidar.above_ground = table.above_ground;
  for (const PoseRow& row : table.rows) {
    file.lidar.path.push_back(
        {row.time, row.at, row.heading * kScannerDegree, row.pitch * kScannerDegree, row.roll * kScannerDegree});
    file.places.push_back(fmt::format("{}: line {}", path, row.line));
  }
}

void take_path(const Json& json, ScannerFile& file, const std::string& folder) {
  constexpr const char* kPath = "a list of two poses or more, or the name of a table of them (.csv)";
  if (json.is_string()) {
    try {
      take_table((fs::path(folder) / json.get<std::string>()).lexically_normal().string(), file);
    } catch (const Error& error) {
      throw Error(fmt::format("/path: {}", error.what()));
    }
    if (file.lidar.path.size() < 2)
      throw Error(fmt::format("/path: {} has one pose; expected two or more", json.dump()));
    return;
  }
  if (!json.is_array() || json.size() < 2) refuse_json("/path", json, kPath);
  std::vector<LidarPose>& path = file.lidar.path;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string where = fmt::format("/path/{}", i);
    LidarPose pose;
    const bool above = take_pose(json[i], where, true, pose);
    if (i > 0 && above != file.lidar.above_ground)
      throw Error(fmt::format("{}: expected above in all poses, or in none", where));
    file.lidar.above_ground = above;
    if (i > 0 && !(pose.time > path.back().time)) {
      throw Error(fmt::format("{}/time: is {}; expected a time later than {}, that of the pose before it", where,
                              pose.time, path.back().time));
    }
    path.push_back(pose);
    file.places.push_back(where);
  }
}

}  // namespace

ScannerFile parse_scanner(std::string_view text, const std::string& folder) {
  const Json json = parse_scene_text(text);
  JsonObject scanner(json, "");
  ScannerFile file;
  Lidar& lidar = file.lidar;
  for (const char* key : {"$schema", "about"}) scanner.find(key);
  lidar.elevations = elevations_of(needed(scanner, "elevations", kElevations));
  take_azimuths(needed(scanner, "azimuths", kAzimuths), lidar);
  lidar.rate = number_in(needed(scanner, "rate", kRate), "/rate", std::numeric_limits<double>::min(), kLargest, kRate);
  take_offsets(scanner, "time_offsets", lidar.time_offsets, lidar.channels(), 0, kLargest, 1,
               "seconds after the time of the column, 0 or more");
  take_offsets(scanner, "azimuth_offsets", lidar.azimuth_offsets, lidar.channels(), -360, 360, kScannerDegree,
               "degrees, -360 to 360");
  take_range(scanner, lidar);
  take_noise(scanner, lidar);
  take_mounting(scanner, lidar.mounting);
  const Json *pose = scanner.find("pose"), *path = scanner.find("path");
  if (pose && path) throw Error("/path: does not go with pose; give one of the two");
  if (!pose && !path)
    throw Error("/pose: is missing; expected where the scanner stands, or /path with the poses of one that moves");
  if (path && json.contains("turns"))
    throw Error("/turns: does not go with path, which lasts from its first to its last pose");
  lidar.turns = static_cast<int>(scanner.whole("turns", 1, 1, kMostTurns));
  if (pose) {
    lidar.above_ground = take_pose(*pose, "/pose", false, lidar.path.emplace_back());
    file.places.emplace_back("/pose");
  } else {
    take_path(*path, file, folder);
  }
  scanner.finish();
  return file;
}

ScannerFile read_scanner(const std::string& path) {
  try {
    ScannerFile file = parse_scanner(json_text_of(path, "a scanner"), fs::path(path).parent_path().string());
    if (file.files.empty()) {
      for (std::string& place : file.places) place = fmt::format("{}: {}", path, place);
    }
    return file;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace scarp
