// SPDX-License-Identifier: MIT
// Adversarial rasters: text grids, and odd values and types of samples.
#pragma once

#include "cli/spiteful_raster.h"

namespace scarp::test {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInf = std::numeric_limits<double>::infinity();
inline constexpr const char* kMetres = "xllcorner 500000\nyllcorner 5000000\ncellsize 10";

inline SpitefulRasters text_grids(const SpitefulFiles& f) {
  using enum Expected;
  SpitefulRasters all;
  // 23 columns of 0.01 degrees at latitude 47.08: 23 * 758.4 m.
  all.push_back({.kind = "degrees without a CRS",
                 .inputs = {f.asc("degrees.asc", "xllcorner 8\nyllcorner 47\ncellsize 0.01")},
                 .words = "EPSG:4326",
                 .heights = kHills,
                 .width_m = 17480});
  all.push_back({.kind = "decimal commas",
                 .inputs = {f.bytes("commas.asc",
                                    "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                                    "1,25 2,5\n3,75 4,5\n")},
                 .expected = right_or_refused,
                 .heights = {1.25, 4.5},
                 .size = "2x2"});
  all.push_back(
      {.kind = "lines of Windows",
       .inputs = {f.asc("crlf.asc", "xllcorner 500000\r\nyllcorner 5000000\r\ncellsize 10", hills(), "{} ", "\r\n")},
       .heights = kHills,
       .width_m = 230,
       .peaks_in_north_east = true});
  all.push_back({.kind = "negative cellsize",
                 .inputs = {f.asc("negative.asc", "xllcorner 500000\nyllcorner 5000000\ncellsize -10")},
                 .expected = right_or_refused,
                 .heights = kHills,
                 .width_m = 230});
  all.push_back({.kind = "cells of 10 x 20 (dx, dy)",
                 .inputs = {f.asc("dxdy.asc", "xllcorner 500000\nyllcorner 5000000\ndx 10\ndy 20")},
                 .heights = kHills,
                 .width_m = 230});
  all.push_back({.kind = "-9999 without a NODATA_value",
                 .inputs = {f.asc("undeclared.asc", kMetres, hills_with(-9999, 3))},
                 .expected = drawn_or_warned,
                 .words = "--nodata"});
  for (const double mark : {3.4e38, -3.4028234663852886e38, 1e38}) {
    all.push_back({.kind = fmt::format("a sample of {:.3g} that is not declared", mark),
                   .inputs = {f.asc(fmt::format("mark{:.3g}.asc", mark), kMetres, hills_with(mark))},
                   .words = "nodata|hole"});
  }
  const std::string nan_place = std::string(kMetres) + "\nNODATA_value nan";
  all.push_back({.kind = "NODATA_value nan, heights with decimals",
                 .inputs = {f.asc("nan.asc", nan_place, hills_with(kNaN, 3), "{:.2f} ")},
                 .heights = kHills,
                 .width_m = 230});
  all.push_back({.kind = "NODATA_value nan, heights in whole metres",
                 .inputs = {f.asc("nans.asc", nan_place, hills_with(kNaN, 3))},
                 .heights = kHills,
                 .width_m = 230});
  const std::string rows = f.asc("whole.asc", kMetres);
  all.push_back({.kind = "fewer samples than the header says",
                 .inputs = {f.bytes("few.asc", text_of(rows).substr(0, 700))},
                 .expected = refused,
                 .words = "truncated|samples"});
  all.push_back({.kind = "a denormal cellsize",
                 .inputs = {f.asc("denormal.asc", "xllcorner 0\nyllcorner 0\ncellsize 1e-310")},
                 .expected = right_or_refused,
                 .words = "cell|degrees"});
  all.push_back({.kind = "degrees that go just beyond a pole, without a CRS",
                 .inputs = {f.asc("beyond.asc", "xllcorner 8\nyllcorner 89.9\ncellsize 0.01")},
                 .expected = right_or_refused});
  std::string words = text_of(rows);
  words.replace(words.find(" 80 "), 4, " N/A ");
  all.push_back({.kind = "N/A instead of a sample",
                 .inputs = {f.bytes("words.asc", words)},
                 .expected = refused,
                 .words = "'N/A' is not a number"});
  words.replace(words.find(" N/A "), 5, "  -  ");
  all.push_back({.kind = "a dash instead of a sample",
                 .inputs = {f.bytes("dashes.asc", words)},
                 .expected = refused,
                 .words = "'-' is not a number"});
  all.push_back({.kind = "NaN in tiles of whole metres",
                 .inputs = {f.bytes("west.asc", text_of(f.path("nans.asc"))),
                            f.asc("east.asc", "xllcorner 500240\nyllcorner 5000000\ncellsize 10\nNODATA_value nan",
                                  hills_with(kNaN, 3))},
                 .heights = kHills,
                 .width_m = 470,
                 .size = "48x16"});
  all.push_back({.kind = "cellsize 0",
                 .inputs = {f.asc("zero.asc", "xllcorner 0\nyllcorner 0\ncellsize 0")},
                 .expected = refused,
                 .words = "cell"});
  all.push_back({.kind = "a header of 2e9 samples squared",
                 .inputs = {f.bytes("vast.asc",
                                    "ncols 2000000000\nnrows 2000000000\nxllcorner 0\nyllcorner 0\n"
                                    "cellsize 10\n1 2 3\n")},
                 .expected = refused,
                 .may_hang = true});
  std::string points, oblique;
  for (int row = kRows - 1; row >= 0; --row) {
    for (int col = 0; col < kCols; ++col) {
      points += fmt::format("{} {} {}\n", 500000 + 10 * col, 5000000 - 10 * row, hill(col, row));
      oblique += fmt::format("{} {} {}\n", 500000 + 10.7 * col + 3.1 * row, 5000000 - 10.3 * row + col, hill(col, row));
    }
  }
  all.push_back({.kind = "points of a grid from the south",
                 .inputs = {f.bytes("points.xyz", points)},
                 .heights = kHills,
                 .width_m = 230,
                 .peaks_in_north_east = true});
  all.push_back({.kind = "points of no grid", .inputs = {f.bytes("oblique.xyz", oblique)}, .expected = refused});
  all.push_back({.kind = "a .prj that is no CRS",
                 .inputs = {f.asc("prj.asc", kMetres)},
                 .words = "coordinate reference",
                 .heights = kHills});
  f.bytes("prj.prj", "PROJCS[\"broken\",GEOGCS[\"x");
  return all;
}

inline SpitefulRasters sample_values(const SpitefulFiles& f) {
  using enum Expected;
  SpitefulRasters all;
  struct {
    const char* name;
    GDALDataType type;
    std::vector<const char*> options;
  } const types[] = {{"Byte", GDT_Byte, {}},
                     {"Int8", GDT_Byte, {"PIXELTYPE=SIGNEDBYTE"}},
                     {"UInt32", GDT_UInt32, {}},
                     {"Int64", GDT_Int64, {}},
                     {"Float64", GDT_Float64, {}},
                     {"Byte of 7 bits", GDT_Byte, {"NBITS=7"}},
                     {"half", GDT_Float32, {"NBITS=16"}}};
  for (const auto& type : types) {
    all.push_back({.kind = fmt::format("samples of type {}", type.name),
                   .inputs = {f.tiff(fmt::format("{}.tif", type.name), type.type, hills(), {}, type.options)},
                   .heights = kHills,
                   .width_m = kHillsWidth_m});
  }
  for (const GDALDataType type : {GDT_CInt16, GDT_CFloat32}) {
    const std::string name = GDALGetDataTypeName(type);
    all.push_back({.kind = "complex samples, " + name,
                   .inputs = {f.tiff(name + ".tif", type, hills())},
                   .expected = refused,
                   .words = "complex"});
  }
  all.push_back({.kind = "float64 beyond float32",
                 .inputs = {f.tiff("beyond.tif", GDT_Float64, hills_with(1e300))},
                 .expected = right_or_refused,
                 .words = "1e+300|nodata"});
  for (const double infinite : {kInf, -kInf}) {
    all.push_back({.kind = fmt::format("a sample of {}", infinite),
                   .inputs = {f.tiff(fmt::format("{}.tif", infinite), GDT_Float32, hills_with(infinite))},
                   .expected = right_or_refused,
                   .words = "infin|nodata|hole"});
  }
  for (const double spike : {1e6, -1e6, 32767.0}) {
    all.push_back({.kind = fmt::format("a single sample of {}", spike),
                   .inputs = {f.tiff(fmt::format("spike{}.tif", spike), GDT_Float32, hills_with(spike))},
                   .expected = drawn_or_warned,
                   .words = "nodata|hole"});
  }
  all.push_back({.kind = "65535 that is not declared",
                 .inputs = {f.tiff("u16.tif", GDT_UInt16, hills_with(65535, 2))},
                 .expected = drawn_or_warned,
                 .words = "65535"});
  const auto nodata = [](double value) {
    return [value](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(value); };
  };
  all.push_back({.kind = "nothing but nodata",
                 .inputs = {f.tiff("none.tif", GDT_Int16, std::vector<double>(kCols * kRows, -7), nodata(-7))},
                 .expected = refused,
                 .words = "nodata"});
  all.push_back({.kind = "nothing but NaN",
                 .inputs = {f.tiff("nans.tif", GDT_Float32, std::vector<double>(kCols * kRows, kNaN))},
                 .expected = refused,
                 .words = "nodata|NaN"});
  std::vector<double> one(kCols * kRows, -7), cell = one, board = one;
  one[100] = cell[100] = cell[101] = cell[100 + kCols] = cell[101 + kCols] = 50;
  for (std::size_t i = 0; i < board.size(); ++i) {
    if ((i / kCols + i % kCols) % 2 == 0) board[i] = 50;
  }
  all.push_back({.kind = "a single valid sample, so no cell",
                 .inputs = {f.tiff("one.tif", GDT_Int16, one, nodata(-7))},
                 .expected = described,
                 .words = "cell|hole|nodata"});
  all.push_back({.kind = "a single valid cell of 345",
                 .inputs = {f.tiff("cell.tif", GDT_Int16, cell, nodata(-7))},
                 .expected = drawn_or_warned});
  all.push_back({.kind = "a checkerboard of holes, so no cell",
                 .inputs = {f.tiff("board.tif", GDT_Int16, board, nodata(-7))},
                 .expected = described,
                 .words = "cell|hole|nodata"});
  for (const auto& [cols, rows] : {std::pair{1, 1}, {1, 40}, {40, 1}}) {
    all.push_back({.kind = fmt::format("{} x {} samples", cols, rows),
                   .inputs = {f.tiff(fmt::format("{}x{}.tif", cols, rows), GDT_Int16, std::vector<double>(40, 5), {},
                                     {}, 1, cols, rows)},
                   .expected = described,
                   .words = "2 x 2|cell",
                   .size = fmt::format("{}x{}", cols, rows)});
  }
  all.push_back({.kind = "2 x 2 samples",
                 .inputs = {f.tiff("2x2.tif", GDT_Int16, {1, 2, 3, 4}, {}, {}, 1, 2, 2)},
                 .heights = {1, 4},
                 .width_m = 10,
                 .size = "2x2"});
  all.push_back({.kind = "perfectly flat",
                 .inputs = {f.tiff("flat.tif", GDT_Float32, std::vector<double>(kCols * kRows, 5))},
                 .heights = {5, 5}});
  all.push_back({.kind = "flat to the eye: 60 m over 230 km",
                 .inputs = {f.tiff_at("plain.tif", "", {0, 10000, 0, 5000000, 0, -10000})},
                 .words = "--exaggeration",
                 .heights = kHills});
  all.push_back({.kind = "nodata that the type cannot hold",
                 .inputs = {f.tiff("outside.tif", GDT_Byte, hills(), nodata(-9999))},
                 .words = "nodata",
                 .heights = kHills});
  all.push_back({.kind = "statistics that lie",
                 .inputs = {f.tiff("statistics.tif", GDT_Int16, hills(),
                                   [](GDALDataset& d) { d.GetRasterBand(1)->SetStatistics(-5e4, 5e6, 9, 9); })},
                 .heights = kHills});
  struct {
    const char* kind;
    double scale, offset;
    Expected expected;
    Heights heights;
  } const scales[] = {{"scale 0", 0, 0, refused, {}},       {"scale -1", -1, 0, drawn, {-120, -60}},
                      {"scale nan", kNaN, 0, refused, {}},  {"scale 1e300", 1e300, 0, right_or_refused, {}},
                      {"offset inf", 1, kInf, refused, {}}, {"scale 0.1, offset 1000", 0.1, 1000, drawn, {1006, 1012}}};
  for (const auto& c : scales) {
    const auto edit = [&c](GDALDataset& d) {
      d.GetRasterBand(1)->SetScale(c.scale);
      d.GetRasterBand(1)->SetOffset(c.offset);
    };
    all.push_back({.kind = c.kind,
                   .inputs = {f.tiff(std::string(c.kind) + ".tif", GDT_Int16, hills(), edit)},
                   .expected = c.expected,
                   .words = c.expected == drawn ? "" : "scale|height",
                   .heights = c.heights});
  }
  const auto unit = [](const char* name) { return [name](GDALDataset& d) { d.GetRasterBand(1)->SetUnitType(name); }; };
  all.push_back({.kind = "heights in feet",
                 .inputs = {f.tiff("feet.tif", GDT_Int16, hills(), unit("ft"))},
                 .words = "ft",
                 .heights = {60 * 0.3048, 120 * 0.3048}});
  all.push_back({.kind = "heights in furlongs",
                 .inputs = {f.tiff("furlongs.tif", GDT_Int16, hills(), unit("furlong"))},
                 .expected = right_or_refused,
                 .words = "furlong"});
  return all;
}

}  // namespace scarp::test
