// SPDX-License-Identifier: MIT
#include "app/cli/options/raster_options.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/source/raster/coordinates.h"

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

// The choices of --coords are not CRSs; PROJ would search for a CRS with that name.
std::string crs_from(const std::string& text) {
  for (const Coordinates kind : {Coordinates::local, Coordinates::map, Coordinates::lonlat}) {
    if (text == name_of(kind)) {
      throw WrongUsage(fmt::format(
          "--crs '{}': expected a CRS, for example EPSG:4326 (--coords names the kind of coordinates)", text));
    }
  }
  return text;
}

double nodata_from(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') throw WrongUsage(fmt::format("--nodata '{}': expected a number", text));
  return value;
}

}  // namespace

void add_raster_inputs(Command& command, std::vector<std::string>& inputs, const std::string& kinds, bool required) {
  command.add(&inputs, {.names = "IN",
                        .help = kinds,
                        .files = "*",
                        .note = "several rasters, or a folder of them, are tiles of one field",
                        .common = true,
                        .required = required});
}

void add_raster_options(Command& command, RasterOptions& options) {
  // "S,OFFSET" already sets the offset.
  const auto one_offset = [&command] { return command.value("--scale").find(',') == std::string::npos; };
  constexpr Inputs kRasters{kTerrain, "it interprets raster files"};
  const auto add = [&](Binding to, Option option) {
    option.topic = Topic::input;
    option.inputs = kRasters;
    command.add(std::move(to), std::move(option));
  };
  add(&options.band, {.names = "--band", .help = "band to read", .range = {1, 65536}, .fallback = "the only one"});
  add(&options.key,
      {.names = "--key", .value = "NAME", .help = "array of a .npz file", .fallback = "the only array of heights"});
  add([&options](const std::string& text) { options.window = window_from(text); },
      {.names = "--window",
       .value = "COL,ROW,COLS,ROWS",
       .help = "part of the raster to read, in samples counted from 0",
       .fallback = "all"});
  add([&options](const std::string& text) { options.nodata = nodata_from(text); },
      {.names = "--nodata",
       .value = "V",
       .help = "sample value treated as a hole",
       .note = "nan: only NaN",
       .fallback = "the file's",
       .common = true});
  add(&options.unit, {.names = "--unit",
                      .value = "UNIT",
                      .help = "vertical unit",
                      .choices = {"m", "ft", "us-ft", "km", "dm", "cm", "mm", "yd", "fathom"},
                      .fallback = "the file's, else m"});
  add(
      [&options](const std::string& text) {
        const auto n = ground_numbers_from(text, 1, 2, "--scale", "S[,OFFSET], for example 0.1 or 0.1,-10000");
        options.scale = n[0];
        if (n.size() == 2) options.offset = n[1];
      },
      {.names = "--scale",
       .value = "S[,OFFSET]",
       .help = "height = sample * S + OFFSET in the vertical unit",
       .note = "S is not 0",
       .fallback = "the file's"});
  add(&options.offset, {.names = "--offset",
                        .help = "offset added to scaled samples, in the vertical unit",
                        .range = {-kMostOfGround, kMostOfGround},
                        .fallback = "the file's",
                        .rules = {{"repeats the offset of --scale S,OFFSET (leave one of the two out)", one_offset}}});
  add([&options](const std::string& text) { options.height_range = height_range_from(text); },
      {.names = "--height-range",
       .value = "LOW,HIGH",
       .help = "heights of the smallest and largest value of unsigned samples, or of 0 and 1 in float samples"});
  add([&options](const std::string& text) { options.encoding = *height_encoding(text); },
      {.names = "--encoding",
       .value = "KIND",
       .help = "heights encoded in image colours",
       .choices = {std::string(name_of(HeightEncoding::none)), std::string(name_of(HeightEncoding::terrain_rgb)),
                   std::string(name_of(HeightEncoding::terrarium))},
       .closed = true,
       .fallback = std::string(name_of(HeightEncoding::none))});
  add([&options](const std::string& text) { options.raw = parse_raw_format(text); },
      {.names = "--raw",
       .value = "COLSxROWS:TYPE[+OFFSET]",
       .help = "layout of a headerless file of samples, for example 4097x4097:u16le"});
  add(&options.channel, {.names = "--channel",
                         .value = "NAME",
                         .help = "channel of an .exr file",
                         .fallback = "the only one, else Y, else R"});
  add([&options](const std::string& text) { options.crs = crs_from(text); },
      {.names = "--crs",
       .value = "CRS",
       .help = "coordinate reference system, for example EPSG:4326",
       .note = "none: metres",
       .fallback = "the file's",
       .common = true});
  add([&options](const std::string& text) { options.bounds = bounds_from(text); },
      {.names = "--bounds",
       .value = "W,S,E,N",
       .help = "outer edges of the file in units of its CRS",
       .fallback = "the file's"});
}

}  // namespace scarp::cli
