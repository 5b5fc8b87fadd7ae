// SPDX-License-Identifier: MIT
#include "bench/map_task.h"

#include <fmt/format.h>

#include <span>

#include "scarp/output/raster_map.h"
#include "scarp/source/raster/procedural_dem.h"
#include "scarp/source/raster/read_raster.h"

namespace scarp::bench {
namespace {

constexpr const char* kCrs =
    R"(PROJCS["plane",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],)"
    R"(UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],)"
    R"(PARAMETER["central_meridian",0],PARAMETER["scale_factor",1],PARAMETER["false_easting",0],)"
    R"(PARAMETER["false_northing",0],UNIT["metre",1]])";

}  // namespace

Raster make_dem(const std::string& path, const std::string& kind, std::uint64_t seed, int size) {
  const ProceduralDem dem{.cols = size, .rows = size, .seed = seed, .kind = *terrain_kind(kind)};
  const std::vector<float> heights = generate_dem(dem);
  RasterMap map;
  map.cols = map.rows = size;
  map.bands.push_back({"height", "m", std::span<const float>(heights)});
  const double half = dem.cell_m * size / 2;
  map.place = MapPlace{{-half, dem.cell_m, 0, half, 0, -dem.cell_m}, kCrs};
  map.creation_options = {kTiled, kPlain};
  write_raster_map(path, map);
  return read_raster(path, {});
}

void add_scarp_option(cli::Command& command, std::string& path) {
  path = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "scarp").string();
  command.add(
      [&path](const std::string& text) {
        if (!std::filesystem::exists(text)) throw cli::WrongUsage(fmt::format("--scarp '{}': no such file", text));
        path = text;
      },
      {.names = "--scarp",
       .value = "FILE",
       .help = "path of scarp, one of the programs",
       .files = "*",
       .fallback = "beside scarp-bench"});
}

std::vector<std::string> grass_words() { return {"grass", "--tmp-location", kDem, "--exec", "bash", "job.sh"}; }

std::string grass_script(const std::string& command, const std::string& sample_type, int nodata) {
  // -o: the location is made from this file, so their projections agree.
  return fmt::format(
      "set -e\nr.in.gdal -o --quiet input={} output=dem\ng.region raster=dem\n{}\n"
      "r.out.gdal --quiet -f --o input=map output=grass.tif format=GTiff type={} nodata={} createopt={},{}\n",
      kDem, command, sample_type, nodata, kTiled, kPlain);
}

}  // namespace scarp::bench
