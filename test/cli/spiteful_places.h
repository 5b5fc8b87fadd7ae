// SPDX-License-Identifier: MIT
// Adversarial rasters: odd geotransforms and coordinate reference systems, and odd bands and pictures.
#pragma once

#include <filesystem>

#include "cli/spiteful_raster.h"

namespace scarp::test {

inline SpitefulRasters places(const SpitefulFiles& f) {
  using enum Expected;
  const std::string utm = "EPSG:32632";
  SpitefulRasters all;
  std::vector<double> southern, eastern;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) {
      southern.push_back(hill(col, kRows - 1 - row));
      eastern.push_back(hill(kCols - 1 - col, row));
    }
  }
  all.push_back({.kind = "rows from south to north",
                 .inputs = {f.tiff_at("south.tif", utm, {500000, 10, 0, 5000000, 0, 10}, southern)},
                 .heights = kHills,
                 .width_m = kHillsWidth_m,
                 .peaks_in_north_east = true});
  all.push_back({.kind = "columns from east to west",
                 .inputs = {f.tiff_at("east.tif", utm, {500240, -10, 0, 5000160, 0, -10}, eastern)},
                 .heights = kHills,
                 .width_m = kHillsWidth_m,
                 .peaks_in_north_east = true});
  all.push_back({.kind = "rotated by 30 degrees",
                 .inputs = {f.tiff_at("rotated.tif", utm, {500000, 8.66, 5, 5000160, 5, -8.66})},
                 .expected = refused,
                 .words = "gdalwarp"});
  all.push_back({.kind = "ground control points alone",
                 .inputs = {f.tiff("gcps.tif", GDT_Int16, hills(),
                                   [](GDALDataset& d) {
                                     GDAL_GCP points[3];
                                     GDALInitGCPs(3, points);
                                     points[1].dfGCPPixel = points[1].dfGCPX = 20;
                                     points[2].dfGCPLine = points[2].dfGCPY = 10;
                                     const OGRSpatialReference crs(SRS_WKT_WGS84_LAT_LONG);
                                     d.SetGCPs(3, points, &crs);
                                     GDALDeinitGCPs(3, points);
                                   })},
                 .expected = refused,
                 .words = "gdalwarp"});
  all.push_back({.kind = "cells of size 1e-12",
                 .inputs = {f.tiff_at("small.tif", utm, {500000, 1e-12, 0, 5000160, 0, -1e-12})},
                 .expected = right_or_refused});
  all.push_back({.kind = "cells of 1e-12 m by --bounds",
                 .inputs = {f.tiff("bounds.tif", GDT_Int16, hills())},
                 .expected = right_or_refused,
                 .options = {"--bounds=0,0,2.4e-11,1.6e-11"}});
  all.push_back({.kind = "cells of size 1e12",
                 .inputs = {f.tiff_at("large.tif", utm, {0, 1e12, 0, 0, 0, -1e12})},
                 .expected = right_or_refused});
  all.push_back(
      {.kind = "cells of 1e12 m without a CRS",
       .inputs = {f.bytes("large.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1e12\n1 2 3 4\n")},
       .expected = right_or_refused,
       .size = "2x2"});
  all.push_back(
      {.kind = "cells of 1e200 m without a CRS",
       .inputs = {f.bytes("huge.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1e200\n1 2 3 4\n")},
       .expected = right_or_refused,
       .size = "2x2"});
  all.push_back({.kind = "a corner at 1e15",
                 .inputs = {f.asc("far.asc", "xllcorner 1e15\nyllcorner 1e15\ncellsize 10")},
                 .heights = kHills,
                 .width_m = 230});
  all.push_back({.kind = "a corner at 1e17, where coordinates are 16 apart",
                 .inputs = {f.asc("farther.asc", "xllcorner 1e17\nyllcorner 1e17\ncellsize 10")},
                 .expected = right_or_refused,
                 .heights = kHills,
                 .width_m = 230});
  const std::string wgs84 = "EPSG:4326";
  all.push_back({.kind = "tiles on both sides of 180 degrees",
                 .inputs = {f.tiff_at("west.tif", wgs84, {179.76, 0.01, 0, -16, 0, -0.01}),
                            f.tiff_at("east180.tif", wgs84, {-180, 0.01, 0, -16, 0, -0.01})},
                 .heights = kHills,
                 .width_m = 47 * 0.01 * 106900,
                 .size = "48x16"});
  all.push_back({.kind = "a raster across 180 degrees",
                 .inputs = {f.tiff_at("across.tif", wgs84, {179.88, 0.01, 0, -16, 0, -0.01})},
                 .heights = kHills,
                 .width_m = 23 * 0.01 * 106900});
  all.push_back({.kind = "the globe from 0 to 360 with both poles",
                 .inputs = {f.tiff_at("globe.tif", wgs84, {0, 15, 0, 90, 0, -11.25})},
                 .expected = drawn_or_warned,
                 .heights = kHills});
  all.push_back({.kind = "the globe with samples on the poles",
                 .inputs = {f.tiff_at("nodes.tif", wgs84, {-187.5, 15, 0, 96, 0, -12})},
                 .expected = drawn_or_warned,
                 .heights = kHills});
  all.push_back({.kind = "latitudes beyond the pole",
                 .inputs = {f.tiff_at("latitude.tif", wgs84, {0, 0.01, 0, 100, 0, -0.01})},
                 .expected = refused,
                 .words = "latitude"});
  all.push_back({.kind = "metres under a CRS in degrees",
                 .inputs = {f.tiff_at("metres.tif", wgs84, {500000, 10, 0, 5000160, 0, -10})},
                 .expected = refused,
                 .words = "longitude|latitude"});
  all.push_back({.kind = "Web Mercator at 85 degrees: 1 / cos(85) = 11.4 times too long",
                 .inputs = {f.tiff_at("mercator.tif", "EPSG:3857", {0, 100, 0, 19971868, 0, -100})},
                 .heights = kHills,
                 .width_m = 2300 * 0.08735});
  all.push_back({.kind = "the pole in the middle",
                 .inputs = {f.tiff_at("pole.tif", "EPSG:3413", {-120, 10, 0, 80, 0, -10})},
                 .heights = kHills,
                 .width_m = 230 / 0.97});
  all.push_back(
      {.kind = "a local CRS",
       .inputs = {f.tiff_at("local.tif", "LOCAL_CS[\"mine\",UNIT[\"metre\",1]]", {500000, 10, 0, 5000160, 0, -10})},
       .heights = kHills,
       .width_m = 230});
  all.push_back({.kind = "a geocentric CRS",
                 .inputs = {f.tiff_at("geocentric.tif", "EPSG:4978", {500000, 10, 0, 5000160, 0, -10})},
                 .expected = right_or_refused,
                 .words = "coordinate reference|--crs"});
  all.push_back({.kind = "a CRS of heights alone",
                 .inputs = {f.tiff_at("vertical.tif", "EPSG:5703", {500000, 10, 0, 5000160, 0, -10})},
                 .expected = right_or_refused,
                 .words = "coordinate|--crs",
                 .heights = kHills,
                 .width_m = 230});
  all.push_back({.kind = "a compound CRS with heights in feet",
                 .inputs = {f.tiff_at("compound.tif", "EPSG:32632+6360", {500000, 10, 0, 5000160, 0, -10})},
                 .words = "foot|feet",
                 .heights = {60 * 1200 / 3937.0, 120 * 1200 / 3937.0},
                 .width_m = 230});
  all.push_back({.kind = "a map in feet that is silent about heights",
                 .inputs = {f.tiff_at("feetmap.tif", "EPSG:2263", {980000, 10, 0, 200160, 0, -10})},
                 .words = "--unit",
                 .heights = kHills,
                 .width_m = 230 * 1200 / 3937.0});
  all.push_back({.kind = "an unknown datum on a sphere",
                 .inputs = {f.tiff_at("sphere.tif", "+proj=laea +lat_0=50 +lon_0=10 +R=6370997 +units=m",
                                      {0, 10, 0, 160, 0, -10})},
                 .heights = kHills,
                 .width_m = 230});
  // 23 * 0.01 degrees of a sphere of 1737.4 km.
  all.push_back({.kind = "degrees on the Moon",
                 .inputs = {f.tiff_at("moon.tif", "+proj=longlat +R=1737400 +no_defs", {0, 0.01, 0, 0.08, 0, -0.01})},
                 .heights = kHills,
                 .width_m = 6974});
  return all;
}

inline SpitefulRasters pictures_and_bands(const SpitefulFiles& f) {
  using enum Expected;
  SpitefulRasters all;
  const auto add = [&](SpitefulRaster raster) {
    if (!raster.inputs.front().empty()) all.push_back(std::move(raster));  // otherwise GDAL has no driver for it
  };
  std::vector<double> grey;
  for (const double h : hills()) grey.push_back((h - 60) / 60 * 65000);
  const auto plain = [&](const char* name, GDALDataType type, const std::vector<double>& samples, int bands = 1,
                         const SpitefulFiles::Edit& edit = {}, std::vector<const char*> options = {}) {
    return f.tiff(
        name, type, samples,
        [&](GDALDataset& d) {
          if (edit) edit(d);
        },
        options, bands);
  };
  // Without a world file a PNG has no georeference: relief of 65 km on 23 m.
  const std::string wide = plain("wide.tif", GDT_UInt16, grey), narrow = plain("narrow.tif", GDT_Byte, hills());
  const auto bare = [&](const std::string& source, const char* driver, const std::string& name) {
    const std::string copy = f.copy(source, driver, name);
    std::filesystem::remove(copy + ".aux.xml");
    return copy;
  };
  add({.kind = "16-bit PNG without scale", .inputs = {bare(wide, "PNG", "wide.png")}, .words = "--height-range"});
  add({.kind = "8-bit PNG", .inputs = {bare(narrow, "PNG", "narrow.png")}, .heights = {}});
  add({.kind = "JPEG of heights", .inputs = {bare(narrow, "JPEG", "grey.jpg")}, .expected = right_or_refused});
  const std::string rgb = plain("rgb.tif", GDT_Byte, hills(), 3), rgba = plain("rgba.tif", GDT_Byte, hills(), 4);
  add({.kind = "JPEG of colours",
       .inputs = {bare(rgb, "JPEG", "rgb.jpg")},
       .expected = refused,
       .words = "colour|band"});
  add({.kind = "RGBA PNG", .inputs = {bare(rgba, "PNG", "rgba.png")}, .expected = refused, .words = "colour|band"});
  const auto palette = [](GDALDataset& d) {
    GDALColorTable table;
    for (int i = 0; i < 256; ++i) {
      const GDALColorEntry entry{static_cast<short>(i), 0, 9, 255};
      table.SetColorEntry(i, &entry);
    }
    d.GetRasterBand(1)->SetColorTable(&table);
  };
  const std::string indices = plain("palette.tif", GDT_Byte, hills(), 1, palette);
  add({.kind = "palette PNG",
       .inputs = {bare(indices, "PNG", "palette.png")},
       .expected = refused,
       .words = "palette"});
  std::vector<double> bits;
  for (const double h : hills()) bits.push_back(h > 80 ? 1 : 0);
  add({.kind = "a mask of 1 bit",
       .inputs = {plain("bits.tif", GDT_Byte, bits, 1, {}, {"NBITS=1"})},
       .expected = right_or_refused,
       .heights = {0, 1}});
  add({.kind = "100 bands",
       .inputs = {plain("hundred.tif", GDT_Byte, hills(), 100)},
       .expected = refused,
       .words = "--band"});
  add({.kind = "alpha of 0 in the west",
       .inputs = {f.tiff(
           "alpha.tif", GDT_Byte, {},
           [](GDALDataset& d) {
             std::vector<double> alpha;
             for (int i = 0; i < kCols * kRows; ++i) alpha.push_back(i % kCols < 5 ? 0 : 255);
             SpitefulFiles::write(d, 1, hills());
             SpitefulFiles::write(d, 2, alpha);
           },
           {"ALPHA=YES"}, 2)},
       .words = "alpha"});
  const auto masked = [](double hidden_cols) {
    return [hidden_cols](GDALDataset& d) {
      CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
      d.CreateMaskBand(GMF_PER_DATASET);
      std::vector<std::uint8_t> mask;
      for (int i = 0; i < kCols * kRows; ++i) mask.push_back(i % kCols < hidden_cols ? 0 : 255);
      if (d.GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, kCols, kRows, mask.data(), kCols, kRows, GDT_Byte,
                                                      0, 0, nullptr) != CE_None)
        throw std::runtime_error("cannot write a mask");
      CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
    };
  };
  add({.kind = "a mask over the west", .inputs = {f.tiff("mask.tif", GDT_Int16, hills(), masked(5))}, .words = "mask"});
  add({.kind = "a mask over everything",
       .inputs = {f.tiff("masked.tif", GDT_Int16, hills(), masked(kCols))},
       .expected = refused,
       .words = "mask|nodata"});
  const std::string liar = f.tiff("overviews.tif", GDT_Int16, hills());
  {
    const GDALDatasetUniquePtr d(GDALDataset::Open(liar.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    int level = 2;
    d->BuildOverviews("NEAREST", 1, &level, 0, nullptr, nullptr, nullptr);
    d->GetRasterBand(1)->GetOverview(0)->Fill(9000);
  }
  add({.kind = "overviews of other heights", .inputs = {liar}, .heights = kHills, .width_m = kHillsWidth_m});
  add({.kind = "netCDF", .inputs = {f.copy(narrow, "netCDF", "a.nc")}, .heights = kHills});
  return all;
}

}  // namespace scarp::test
