// SPDX-License-Identifier: MIT
#include "bench/sky_programs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <span>
#include <variant>

#include "bench/map_task.h"
#include "bench/map_truth.h"
#include "scarp/analysis/horizon.h"
#include "scarp/base/parallel.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/source/raster/read_raster.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kAzimuth = 100;    // of the horizon; 350 counter-clockwise from east
constexpr int kDirections = 16;  // of the sky
constexpr int kStep = 30;        // minutes between suns

struct SkyProgram {
  std::string map, name;
  std::string program, package;
  std::vector<std::string> words;
  std::string script, result;
  double unit;  // of the samples, in radians or as they are
};

std::vector<SkyProgram> sky_programs(const std::string& scarp) {
  const auto own = [&](const std::string& map, const std::string& name, std::vector<std::string> words, double unit) {
    words.insert(words.begin(), scarp);
    for (const char* word : {"--cc", "0", "--co", kTiled, "--co", kPlain, "-o", "scarp.tif"}) words.emplace_back(word);
    return SkyProgram{map, name, scarp, "scarp", words, "", "scarp.tif", unit};
  };
  const auto grass = [&](const std::string& map, const std::string& name, const std::string& command, double unit) {
    return SkyProgram{map,         name, "grass", "grass-core", grass_words(), grass_script(command, "Float32", -9999),
                      "grass.tif", unit};
  };
  const auto saga = [&](const std::string& map, std::vector<std::string> words) {
    std::vector<std::string> all{"saga_cmd", "-f=s", "ta_lighting"};
    all.insert(all.end(), words.begin(), words.end());
    return SkyProgram{map, "saga", "saga_cmd", "saga", all, "", "saga.sdat", 1};
  };
  const std::string directions = fmt::format("{}", kDirections), far = "1e6";
  std::vector<SkyProgram> programs;
  for (const char* engine : {"exact", "sweep"}) {
    const std::string name = fmt::format("scarp, {}", engine);
    programs.push_back(own("horizon", name,
                           {"horizon", kDem, "--azimuths", "1", "--first-azimuth", fmt::format("{}", kAzimuth),
                            "--clamp", "--engine", engine},
                           kDegree));
    programs.push_back(
        own("sky view factor", name,
            {"skyview", kDem, "--measure", "sky-view-factor", "--azimuths", directions, "--engine", engine}, 1));
    programs.push_back(own(
        "positive openness", name,
        {"skyview", kDem, "--measure", "positive-openness", "--azimuths", directions, "--engine", engine}, kDegree));
    programs.push_back(
        own("hours of sun", name,
            {"sunhours", kDem, "--date", "2026-06-21", "--step", fmt::format("{}", kStep), "--engine", engine}, 1));
  }
  programs.push_back(grass("horizon", "r.horizon",
                           fmt::format("r.horizon -d --quiet elevation=dem direction={0} output=hor\n"
                                       "g.rename --quiet raster=hor_{0},map",
                                       (450 - kAzimuth) % 360),
                           kDegree));
  // All sides of the search that SAGA offers: cell by cell, as far as the raster reaches.
  programs.push_back(saga("sky view factor", {"3", "-DEM", kDem, "-VISIBLE", "visible.sdat", "-SVF", "saga.sdat",
                                              "-RADIUS", far, "-NDIRS", directions, "-METHOD", "0"}));
  programs.push_back(saga("positive openness", {"5", "-DEM", kDem, "-POS", "saga.sdat", "-NEG", "neg.sdat", "-RADIUS",
                                                far, "-NDIRS", directions, "-METHOD", "1"}));
  programs.push_back(grass("hours of sun", "r.sun",
                           fmt::format("r.sun --quiet elevation=dem day=172 step={} insol_time=map", kStep / 60.0), 1));
  std::stable_sort(programs.begin(), programs.end(),
                   [](const SkyProgram& a, const SkyProgram& b) { return a.map < b.map; });
  return programs;
}

// The value of a map at a node, by every crossing in double.
class SkyTruth {
 public:
  explicit SkyTruth(const HeightField& field) : field_(field) { settings_.curvature.coefficient = 0; }

  double of(const std::string& map, const scarp::Node& node) const {
    if (map == "horizon") return std::max(angle(node, kAzimuth * kDegree), 0.0);
    if (map == "hours of sun") return hours(node);
    const dvec3 normal = map == "sky view factor" ? normal_of(node) : dvec3(0.0);
    double sum = 0;
    for (int i = 0; i < kDirections; ++i) {
      const double azimuth = 2 * std::numbers::pi * i / kDirections, horizon = angle(node, azimuth);
      if (map == "positive openness") {
        sum += std::numbers::pi / 2 - horizon;
      } else {
        const double zenith = std::numbers::pi / 2 - std::max(horizon, 0.0);
        const double facing = normal.x * std::sin(azimuth) + normal.y * std::cos(azimuth);
        sum += normal.z * std::pow(std::sin(zenith), 2) + facing * (zenith - std::sin(zenith) * std::cos(zenith));
      }
    }
    return sum / kDirections;
  }

 private:
  // Level at the border.
  double angle(const scarp::Node& node, double azimuth) const {
    const auto view = horizon_from(field_, node.col, node.row, azimuth, settings_);
    return view && view->distance ? view->angle : 0;
  }
  double height(int col, int row) const {
    return field_.visit([&](const auto& grid) { return static_cast<double>(grid.at(col, row)); });
  }
  dvec3 normal_of(const scarp::Node& node) const {
    const double east = (height(node.col + 1, node.row) - height(node.col - 1, node.row)) / 2;
    const double north = (height(node.col, node.row - 1) - height(node.col, node.row + 1)) / 2;
    return normalize(dvec3(-east / field_.settings().cell_x, -north / field_.settings().cell_y, 1));
  }
  // The sun of 21 June at the equator, in steps of two minutes.
  double hours(const scarp::Node& node) const {
    constexpr double kDeclination = 23.437 * kDegree, kHours = 2.0 / 60;
    double sum = 0;
    for (double hour = -6 + kHours / 2; hour < 6; hour += kHours) {
      const double up = std::cos(kDeclination) * std::cos(hour * 15 * kDegree);
      const double east = -std::cos(kDeclination) * std::sin(hour * 15 * kDegree);
      if (std::asin(up) >= angle(node, std::atan2(east, std::sin(kDeclination)))) sum += kHours;
    }
    return sum;
  }

  const HeightField& field_;
  HorizonSettings settings_;
};

struct Errors {
  double mean = 0, p99 = 0;
};
Errors errors_of(const std::string& path, double unit, const HeightField& field, const std::vector<scarp::Node>& nodes,
                 const std::vector<double>& truth) {
  RasterOptions first_band;
  first_band.band = 1;
  const Raster raster = read_raster(path, first_band);
  std::vector<double> errors;
  Errors found;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto at = static_cast<std::size_t>(nodes[i].row) * static_cast<std::size_t>(field.cols()) +
                    static_cast<std::size_t>(nodes[i].col);
    const double sample =
        std::visit([&](const auto& samples) { return static_cast<double>(samples.at(at)); }, raster.samples);
    errors.push_back(std::abs(sample * unit - truth[i]));
    found.mean += errors.back() / static_cast<double>(nodes.size());
  }
  const auto p99 = errors.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(errors.size() - 1));
  std::nth_element(errors.begin(), p99, errors.end());
  found.p99 = *p99;
  return found;
}

}  // namespace

std::vector<Json> measure_sky_programs(const SkyProgramOptions& options) {
  std::vector<SkyProgram> programs = sky_programs(options.scarp);
  std::erase_if(programs, [&](const SkyProgram& program) {
    const std::string name = program.name.substr(0, program.name.find(','));
    if (std::find(options.programs.begin(), options.programs.end(), name) == options.programs.end()) return true;
    if (is_installed(program.program)) return false;
    fmt::print(stderr, "note: {} is not measured: {} is not installed\n", program.name, program.package);
    return true;
  });
  const ScratchFolder folder;
  const auto file = [&](const std::string& name) { return (fs::path(folder.path()) / name).string(); };
  const HeightField field = height_field_from(make_dem(file(kDem), options.kind, options.seed, options.size));
  // Beside the border, where slopes have neighbours.
  std::vector<scarp::Node> nodes = random_nodes(field, options.judged);
  std::erase_if(nodes, [&](const scarp::Node& node) {
    return node.col == 0 || node.row == 0 || node.col + 1 == field.cols() || node.row + 1 == field.rows();
  });
  const SkyTruth judge(field);
  std::vector<Json> rows;
  std::string map;
  std::vector<double> truth(nodes.size());
  double exact_s = 0;
  for (const SkyProgram& program : programs) {
    if (program.map != map) {
      map = program.map, exact_s = 0;
      parallel_for(static_cast<std::int64_t>(nodes.size()), 16, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
          truth[i] = judge.of(map, nodes[i]);
      });
    }
    // One after another: they write the same files.
    const auto runs = runs_of(std::vector{program}, folder.path(), options.repeats, options.program_limit_s)[0];
    Json row{{"size", options.size}, {"map", map}, {"program", program.name}};
    for (const char* name : {"seconds", "cpu_s", "peak_mb", "scarp_ratio", "judged", "error_mean", "error_p99"})
      row[name] = nullptr;
    if (!runs.empty()) {
      row["seconds"] = median_of(runs, [](const ProgramRun& run) { return run.wall_s; });
      row["cpu_s"] = median_of(runs, [](const ProgramRun& run) { return run.cpu_s; });
      if (runs[0].peak_mb) row["peak_mb"] = *runs[0].peak_mb;
      if (program.name == "scarp, exact") exact_s = row["seconds"];
      if (exact_s > 0) row["scarp_ratio"] = row["seconds"].get<double>() / exact_s;
      const Errors errors = errors_of(file(program.result), program.unit, field, nodes, truth);
      row["judged"] = nodes.size(), row["error_mean"] = errors.mean, row["error_p99"] = errors.p99;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace scarp::bench
