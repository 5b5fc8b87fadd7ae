// SPDX-License-Identifier: MIT
#include "app/cli/raster_options.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "app/cli/numbers.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

RasterWindow window_from(const std::string& text) {
  constexpr std::string_view kForm = "COL,ROW,COLS,ROWS in samples, counted from 0, for example 0,0,1024,1024";
  const auto numbers = numbers_from(text, ',', 4, 4, "--window", kForm);
  int whole[4];
  for (std::size_t i = 0; i < 4; ++i) {
    if (numbers[i] != std::floor(numbers[i]) || std::abs(numbers[i]) > 1e9)
      throw Error(fmt::format("--window '{}': expected {}", text, kForm));
    whole[i] = static_cast<int>(numbers[i]);
  }
  return {whole[0], whole[1], whole[2], whole[3]};
}

MapBounds bounds_from(const std::string& text) {
  const auto n = ground_numbers_from(text, 4, 4, "--bounds",
                                     "W,S,E,N in units of the CRS, for example -84.415,36.568,-84.127,36.734");
  return {n[0], n[1], n[2], n[3]};
}

HeightRange height_range_from(const std::string& text) {
  const auto n = ground_numbers_from(text, 2, 2, "--height-range", "LOW,HIGH in the vertical unit, for example 0,2400");
  return {n[0], n[1]};
}

HeightEncoding encoding_from(const std::string& text) {
  const auto encoding = height_encoding(text);
  if (!encoding) throw Error(fmt::format("--encoding '{}': expected none, terrain-rgb or terrarium", text));
  return *encoding;
}

}  // namespace

CLI::Option* add_raster_inputs(CLI::App& command, std::vector<std::string>& inputs) {
  return command
      .add_option("IN", inputs,
                  "raster of heights: anything GDAL reads, .npy, .npz, .exr; several files, or a folder of them, are "
                  "tiles of one field. render and info take a MagicaVoxel file (.vox) or a scene (.json), too")
      ->required();
}

void add_raster_options(CLI::App& command, RasterOptions& options, const std::string& crs_option) {
  const std::string group = "What the file does not say";
  command.add_option("--band", options.band, "band to read, from 1 (the only one)")
      ->check(CLI::Range(1, 65536))
      ->group(group);
  command.add_option("--key", options.key, "array of a .npz file (the only one of heights)")->group(group);
  command
      .add_option_function<std::string>(
          "--window", [&options](const std::string& text) { options.window = window_from(text); },
          "COL,ROW,COLS,ROWS: read this part only")
      ->group(group);
  command.add_option("--nodata", options.nodata, "sample value that marks a hole; nan: none but NaN does")
      ->group(group);
  command.add_option("--unit", options.unit, "vertical unit: m, ft, us-ft, km, dm, cm, mm, yd, fathom")->group(group);
  command
      .add_option_function<std::string>(
          "--scale",
          [&command, &options](const std::string& text) {
            const auto n = ground_numbers_from(text, 1, 2, "--scale", "S[,OFFSET], for example 0.1 or 0.1,-10000");
            if (n.size() == 2 && command.count("--offset") > 0)
              throw Error(fmt::format("--scale '{}' has an offset already; leave out --offset", text));
            options.scale = n[0];
            if (n.size() == 2) options.offset = n[1];
          },
          "S[,OFFSET]: height = sample * S + OFFSET, in the vertical unit; not 0")
      ->group(group);
  command.add_option("--offset", options.offset, "see --scale")
      ->check(number_in({-kMostOfGround, kMostOfGround}))
      ->group(group);
  command
      .add_option_function<std::string>(
          "--height-range", [&options](const std::string& text) { options.height_range = height_range_from(text); },
          "LOW,HIGH: heights of the least and the greatest value of unsigned samples (0 and 65535 of UInt16), or of 0 "
          "and 1 in float samples")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--encoding", [&options](const std::string& text) { options.encoding = encoding_from(text); },
          "terrain-rgb or terrarium: the colours of the image are heights")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--raw", [&options](const std::string& text) { options.raw = parse_raw_format(text); },
          "COLSxROWS:TYPE[+OFFSET]: the file is bare samples, for example 4097x4097:u16le")
      ->group(group);
  command.add_option("--channel", options.channel, "channel of an .exr file (the only one, else Y, else R)")
      ->group(group);
  command.add_option(crs_option, options.crs, "coordinate reference system, for example EPSG:4326")->group(group);
  command
      .add_option_function<std::string>(
          "--bounds", [&options](const std::string& text) { options.bounds = bounds_from(text); },
          "W,S,E,N: outer edges of the file, in units of its CRS")
      ->group(group);
}

}  // namespace scarp::cli
