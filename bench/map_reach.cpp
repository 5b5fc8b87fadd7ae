// SPDX-License-Identifier: MIT
#include "bench/map_reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "bench/map_task.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kTile = 4000, kCell = 10;
constexpr const char* kMosaic = "mosaic.vrt";     // 40,000 x 40,000 samples
constexpr const char* kContinent = "200000.vrt";  // 200,000 x 200,000

// A mosaic of int16 that repeats the elevation model.
void write_mosaic(const fs::path& path, int tiles) {
  const int side = tiles * kTile;
  std::ofstream out(path);
  out << fmt::format(
      "<VRTDataset rasterXSize=\"{0}\" rasterYSize=\"{0}\"><GeoTransform>0,{1},0,{2},0,-{1}</GeoTransform>"
      "<VRTRasterBand dataType=\"Int16\" band=\"1\">\n",
      side, kCell, side * kCell);
  for (int row = 0; row < side; row += kTile)
    for (int col = 0; col < side; col += kTile)
      out << fmt::format(
          "<SimpleSource><SourceFilename relativeToVRT=\"1\">{0}</SourceFilename><SourceBand>1</SourceBand>"
          "<SourceProperties RasterXSize=\"{1}\" RasterYSize=\"{1}\" DataType=\"Float32\" BlockXSize=\"256\" "
          "BlockYSize=\"256\"/><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"{1}\" ySize=\"{1}\"/>"
          "<DstRect xOff=\"{2}\" yOff=\"{3}\" xSize=\"{1}\" ySize=\"{1}\"/></SimpleSource>\n",
          kDem, kTile, col, row);
  out << "</VRTRasterBand></VRTDataset>\n";
}

struct Reach {
  std::string name;
  std::vector<std::string> words;
  std::string script, result;
};

std::vector<Reach> reaches(const std::string& scarp, bool has_peer) {
  const std::string x = "200005", y = "199995", here = x + "," + y;
  const auto own = [&](std::vector<std::string> words, const std::string& result = "stdout") {
    std::string name = "scarp " + words[0];
    if (words.size() > 1) name += words[1] == kContinent ? ", 200,000^2" : words[1] == "--help" ? " --help" : "";
    words.insert(words.begin(), scarp);
    return Reach{name, words, "", result};
  };
  std::vector<Reach> all;
  if (has_peer) {
    all.push_back({"gdal_viewshed",
                   {"gdal_viewshed", "-q", "-ox", x, "-oy", y, "-oz", "10", "-md", "3000", kMosaic, "gdal.tif"},
                   "",
                   "gdal.tif"});
    all.push_back({"gdalinfo --version", {"gdalinfo", "--version"}, "", "stdout"});
  }
  all.push_back(own({"viewshed", kMosaic, "--crs", "none", "--observer", here + ",10", "--max-distance", "3000",
                     "--crop", "-o", "seen.tif"},
                    "seen.tif"));
  all.push_back(own({"los", kMosaic, "--crs", "none", "--from", here + ",10", "--to", "200505,200495,2"}));
  all.push_back(own({"profile", kMosaic, "--crs", "none", "--from", here, "--to", "200505,200495", "-o", "line.csv"},
                    "line.csv"));
  all.push_back(own({"cast", kMosaic, "--crs", "none", "--rays", "rays.csv", "-o", "hits.csv"}, "hits.csv"));
  all.push_back(
      own({"shadow", kMosaic, "--crs", "none", "--sun", "135,30", "--window", "20000,20000,300,300", "-o", "shade.tif"},
          "shade.tif"));
  all.push_back(own({"info", kMosaic}));
  all.push_back(own({"info", kContinent}));
  all.push_back(own({"--version"}));
  all.push_back(own({"viewshed", "--help"}));
  return all;
}

}  // namespace

std::vector<Json> measure_reach(const MapsOptions& options) {
  const auto is_asked = [&](const char* name) {
    return std::find(options.programs.begin(), options.programs.end(), name) != options.programs.end();
  };
  if (!options.reach || !is_asked("scarp")) return {};
  const ScratchFolder folder;
  const fs::path in = folder.path();
  make_dem((in / kDem).string(), options.kind, options.seed, kTile);
  constexpr int kTiles = 10, kContinentTiles = 50;
  write_mosaic(in / kMosaic, kTiles);
  write_mosaic(in / kContinent, kContinentTiles);
  std::ofstream(in / "rays.csv") << "x,y,z,tx,ty,tz\n200005,199995,9000,200505,200495,-9000\n";
  const bool has_peer = is_asked("gdal_viewshed") && is_installed("gdal_viewshed") && is_installed("gdalinfo");
  const std::vector<Reach> programs = reaches(options.scarp, has_peer);
  const auto runs = runs_of(programs, folder.path(), options.repeats, options.program_limit_s);
  std::vector<Json> rows;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    if (runs[i].empty()) throw Error(fmt::format("{}: took over {} s", programs[i].name, options.program_limit_s));
    const double seconds = median_of(runs[i], [](const ProgramRun& run) { return run.wall_s; });
    const double cpu_s = median_of(runs[i], [](const ProgramRun& run) { return run.cpu_s; });
    Json row{{"map", "reach"}, {"program", programs[i].name}, {"seconds", seconds}, {"cpu_s", cpu_s}};
    row["peak_mb"] = runs[i][0].peak_mb ? Json(*runs[i][0].peak_mb) : Json();
    row["gdal_ratio"] = has_peer ? Json(seconds / (i == 0 ? seconds : rows[0]["seconds"].get<double>())) : Json();
    row["gdal_cpu_ratio"] = has_peer ? Json(cpu_s / (i == 0 ? cpu_s : rows[0]["cpu_s"].get<double>())) : Json();
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace scarp::bench
