// SPDX-License-Identifier: MIT
#include "scarp/scene/file/from_raster.h"

#include <gtest/gtest.h>

#include <limits>

#include "scarp/base/error.h"

namespace scarp {
namespace {

template <class T>
Raster raster_of(std::vector<T> samples, int cols, int rows) {
  Raster raster;
  raster.samples = std::move(samples);
  raster.cols = cols;
  raster.rows = rows;
  raster.path = "hills.tif";
  return raster;
}

TEST(FromRaster, SamplesKeepTheirType) {
  EXPECT_EQ(height_field_from(raster_of<std::int16_t>({-1, 2, 3, 4}, 2, 2)).sample_type(), SampleType::int16);
  EXPECT_EQ(height_field_from(raster_of<std::uint16_t>({1, 2, 3, 40000}, 2, 2)).sample_type(), SampleType::uint16);
  EXPECT_EQ(height_field_from(raster_of<float>({1, 2, 3, 4}, 2, 2)).sample_type(), SampleType::float32);
}

TEST(FromRaster, CellSizesAreGroundDistances) {
  Raster raster = raster_of<float>({1, 1, 1, 1, 1, 1}, 3, 2);
  raster.georeference.cell_x_m = 23.5;
  raster.georeference.cell_y_m = 30.75;
  const HeightField field = height_field_from(std::move(raster));
  EXPECT_DOUBLE_EQ(field.width(), 47.0);
  EXPECT_DOUBLE_EQ(field.depth(), 30.75);
}

TEST(FromRaster, ExaggeratesMetres) {
  Raster raster = raster_of<std::int16_t>({10, 20, 30, 40}, 2, 2);
  raster.scale = 0.5;
  raster.offset = 100;
  const HeightField field = height_field_from(std::move(raster), {.exaggeration = 3.0});
  EXPECT_DOUBLE_EQ(field.min_height(), 315);
  EXPECT_DOUBLE_EQ(field.max_height(), 360);
}

TEST(FromRaster, OptionsReachTheField) {
  const HeightField field = height_field_from(raster_of<float>({1, 2, 3, 4}, 2, 2),
                                              {.surface = Surface::triangles, .wrap = Wrap::periodic, .solid = true});
  EXPECT_EQ(field.settings().surface, Surface::triangles);
  EXPECT_EQ(field.settings().wrap, Wrap::periodic);
  EXPECT_TRUE(field.settings().solid);
}

TEST(FromRaster, NodataMarksHoles) {
  Raster raster = raster_of<std::int16_t>({-32768, 20, 30, 40}, 2, 2);
  raster.nodata = -32768;
  EXPECT_EQ(height_field_from(std::move(raster)).nodata_count(), 1);
}

TEST(FromRaster, ErrorNamesFileAndSample) {
  try {
    height_field_from(raster_of<float>({1, 2, 3, std::numeric_limits<float>::infinity()}, 2, 2));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("hills.tif"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("column 1, row 1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace scarp
