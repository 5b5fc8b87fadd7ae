// SPDX-License-Identifier: MIT
#include "bench/map_programs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "bench/map_task.h"
#include "bench/map_truth.h"
#include "bench/program_run.h"
#include "scarp/analysis/sight_rays.h"
#include "scarp/base/error.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/source/raster/read_raster.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr double kDegree = std::numbers::pi / 180;
// The parameters of the task, as on the command lines.
struct Question {
  double x, y;  // the observer
  int height, azimuth, altitude;
};

struct MapProgram {
  std::string name, map;
  std::string program;  // name on PATH
  std::string package;  // Debian package
  std::vector<std::string> words;
  std::string script;  // job.sh; empty: none
  std::string result;
  bool (*positive)(double sample);  // visible or lit
};

bool is_one(double sample) { return sample == 1; }
bool is_zero(double sample) { return sample == 0; }
// A shadow is pi/2, in float; lit is nodata.
bool is_not_half_pi(double sample) { return static_cast<float>(sample) != static_cast<float>(std::numbers::pi / 2); }

std::vector<MapProgram> map_programs(const std::string& scarp, const Question& ask) {
  const auto text = [](double value) { return fmt::format("{}", value); };
  const std::string x = text(ask.x), y = text(ask.y), height = text(ask.height), azimuth = text(ask.azimuth),
                    altitude = text(ask.altitude);
  const auto grass = [&](const std::string& name, const std::string& map, const std::string& command, auto positive) {
    return MapProgram{name,        map,     "grass", "grass-core", grass_words(), grass_script(command, "Byte", 255),
                      "grass.tif", positive};
  };
  return {
      {"scarp",
       "viewshed",
       scarp,
       "scarp",
       {scarp, "viewshed", kDem, "--crs", "none", fmt::format("--observer={},{},{}", x, y, height), "--co", kTiled,
        "--co", kPlain, "-o", "seen.tif"},
       "",
       "seen.tif",
       is_one},
      {"gdal_viewshed",
       "viewshed",
       "gdal_viewshed",
       "gdal-bin",
       {"gdal_viewshed", "-q",          "-ox", x,   "-oy", y,      "-oz", height, "-md", "1e7",
        "-cc",           text(6.0 / 7), "-vv", "1", "-co", kTiled, "-co", kPlain, kDem,  "gdal.tif"},
       "",
       "gdal.tif",
       is_one},
      grass("r.viewshed", "viewshed",
            fmt::format("r.viewshed --quiet -b -c -r refraction_coeff={} input=dem output=map coordinates={},{} "
                        "observer_elevation={} target_elevation=0 memory=8000",
                        1.0 / 7, x, y, height),
            is_one),
      {"scarp",
       "shadow",
       scarp,
       "scarp",
       {scarp, "shadow", kDem, fmt::format("--sun={},{}", azimuth, altitude), "--co", kTiled, "--co", kPlain, "-o",
        "shade.tif"},
       "",
       "shade.tif",
       is_zero},
      // Shadows Only, by angles, slim.
      {"saga",
       "shadow",
       "saga_cmd",
       "saga",
       {"saga_cmd", "-f=s", "ta_lighting", "0", "-ELEVATION", kDem, "-SHADE", "saga.sdat", "-METHOD", "3", "-POSITION",
        "0", "-AZIMUTH", azimuth, "-DECLINATION", altitude, "-SHADOW", "0"},
       "",
       "saga.sdat",
       is_not_half_pi},
      grass("r.sunmask", "shadow",
            fmt::format("r.sunmask --quiet elevation=dem output=map altitude={} azimuth={}", altitude, azimuth),
            [](double sample) { return sample != 1; }),
  };
}

std::int64_t wrong_in(const std::string& path, const MapProgram& program, const MapTruth& truth) {
  // A band with a colour table is read as heights only if the band is given explicitly.
  RasterOptions first_band;
  first_band.band = 1;
  const Raster raster = read_raster(path, first_band);
  return std::visit(
      [&](const auto& samples) {
        std::int64_t wrong = 0;
        for (std::size_t i = 0; i < truth.nodes.size(); ++i)
          wrong += program.positive(static_cast<double>(samples.at(truth.nodes[i]))) != (truth.positive[i] != 0);
        return wrong;
      },
      raster.samples);
}

// Number of pixels of `scarp viewshed --mode count` that differ from rays.
std::int64_t wrong_counts(const std::string& path, const std::vector<Viewpoint>& views,
                          const std::vector<scarp::Node>& judged) {
  RasterOptions first_band;
  first_band.band = 1;
  const Raster raster = read_raster(path, first_band);
  return wrong_nodes(views[0].ground().field(), judged, [&](scarp::Node node, std::size_t i) {
    double count = 0;
    for (const Viewpoint& view : views)
      count += sees(view.ground(), view.observer(), view.eye(), node, view.target(*view.ground().lowered(node)));
    return std::visit([&](const auto& samples) { return static_cast<double>(samples.at(i)); }, raster.samples) == count;
  });
}

}  // namespace

MapPrograms::MapPrograms(const MapsOptions& options) : options_(options) {
  std::set<std::string> asked(options.programs.begin(), options.programs.end());
  for (const MapProgram& program : map_programs(options.scarp, {})) {
    if (!asked.contains(program.name)) continue;
    if (is_installed(program.program)) {
      names_.insert(program.name);
    } else if (asked.erase(program.name) > 0) {
      fmt::print(stderr, "note: {} is not measured: {} is not installed\n", program.name, program.package);
    }
  }
}

std::vector<Json> MapPrograms::measure(int size) {
  if (names_.empty()) return {};
  const ScratchFolder folder;
  Raster raster = make_dem((fs::path(folder.path()) / kDem).string(), options_.kind, options_.seed, size);
  const Georeference place = raster.georeference;
  const HeightField field = height_field_from(std::move(raster));
  const scarp::Node observer{size / 2, size / 2};
  const auto& m = place.map_from_node;
  std::vector<MapProgram> programs =
      map_programs(options_.scarp, {m[0] + observer.col * m[1], m[3] + observer.row * m[5], options_.observer_height,
                                    options_.azimuth_deg, options_.altitude_deg});
  std::erase_if(programs, [&](const MapProgram& program) {
    return late_.contains(program.name) || !names_.contains(program.name);
  });
  const auto runs = runs_of(programs, folder.path(), options_.repeats, options_.program_limit_s);

  const Viewpoint view(field, observer, {.observer_height = static_cast<double>(options_.observer_height)});
  const SunDirection sun{options_.azimuth_deg * kDegree - place.grid_north_azimuth, options_.altitude_deg * kDegree};
  const MapTruth seen = viewshed_truth(view, options_.judged), lit = shadow_truth(field, sun, options_.judged);
  std::vector<Json> rows;
  std::map<std::string, double> scarp_s;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const MapProgram& program = programs[i];
    Json row{{"size", size}, {"map", program.map}, {"program", program.name}};
    if (runs[i].empty()) {
      late_.insert(program.name);
      for (const char* name : {"seconds", "cpu_s", "peak_mb", "scarp_ratio", "judged", "wrong"}) row[name] = nullptr;
    } else {
      const MapTruth& truth = program.map == "viewshed" ? seen : lit;
      row["seconds"] = median_of(runs[i], [](const ProgramRun& run) { return run.wall_s; });
      row["cpu_s"] = median_of(runs[i], [](const ProgramRun& run) { return run.cpu_s; });
      row["peak_mb"] = runs[i][0].peak_mb ? Json(*runs[i][0].peak_mb) : Json();
      if (program.program == options_.scarp) scarp_s[program.map] = row["seconds"];
      row["scarp_ratio"] =
          scarp_s.contains(program.map) ? Json(row["seconds"].get<double>() / scarp_s[program.map]) : Json();
      row["judged"] = truth.nodes.size();
      row["wrong"] = wrong_in((fs::path(folder.path()) / program.result).string(), program, truth);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<Json> MapPrograms::measure_cumulative(int size) {
  if (options_.observers == 0 || !names_.contains("scarp")) return {};
  const ScratchFolder folder;
  const auto file = [&](const char* name) { return (fs::path(folder.path()) / name).string(); };
  Raster raster = make_dem(file(kDem), options_.kind, options_.seed, size);
  const auto map = raster.georeference.map_from_node;
  const HeightField field = height_field_from(std::move(raster));
  std::vector<Viewpoint> views;
  std::vector<Question> questions;
  std::ofstream table(file("observers.csv"));
  table << "x,y\n";
  for (const scarp::Node node : random_nodes(field, options_.observers)) {
    views.emplace_back(field, node, ViewshedSettings{.observer_height = static_cast<double>(options_.observer_height)});
    questions.push_back({map[0] + node.col * map[1], map[3] + node.row * map[5], options_.observer_height, 0, 0});
    table << fmt::format("{},{}\n", questions.back().x, questions.back().y);
  }
  table.close();
  std::vector<Json> rows;
  const auto add = [&](const std::string& program, double wall_s, double cpu_s, std::optional<double> peak_mb) {
    rows.push_back({{"size", size},
                    {"map", "cumulative"},
                    {"program", program},
                    {"observers", options_.observers},
                    {"seconds", wall_s},
                    {"cpu_s", cpu_s},
                    {"peak_mb", peak_mb ? Json(*peak_mb) : Json()},
                    {"scarp_ratio", rows.empty() ? 1 : wall_s / rows[0]["seconds"].get<double>()},
                    {"judged", nullptr},
                    {"wrong", nullptr}});
  };
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  const auto own = run_program(
      {options_.scarp, "viewshed", kDem, "--crs", "none", "--observers", "observers.csv", "--observer-height",
       std::to_string(options_.observer_height), "--mode", "count", "--co", kTiled, "--co", kPlain, "-o", "count.tif"},
      folder.path(), kNoLimit);
  add("scarp", own->wall_s, own->cpu_s, own->peak_mb);
  // As many rays as for other maps.
  const auto judged = random_nodes(field, std::max<std::int64_t>(options_.judged / options_.observers, 1));
  rows[0]["judged"] = judged.size();
  rows[0]["wrong"] = wrong_counts(file("count.tif"), views, judged);
  if (!names_.contains("gdal_viewshed")) return rows;
  ProgramRun all;
  for (const Question& ask : questions) {
    const auto programs = map_programs(options_.scarp, ask);
    const auto gdal = std::find_if(programs.begin(), programs.end(),
                                   [](const MapProgram& program) { return program.name == "gdal_viewshed"; });
    const auto run = run_program(gdal->words, folder.path(), kNoLimit);
    all.wall_s += run->wall_s;
    all.cpu_s += run->cpu_s;
    all.peak_mb = run->peak_mb;
  }
  add("gdal_viewshed", all.wall_s, all.cpu_s, all.peak_mb);
  return rows;
}

}  // namespace scarp::bench
