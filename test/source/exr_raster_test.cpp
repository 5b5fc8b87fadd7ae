// SPDX-License-Identifier: MIT
#include "scarp/source/raster/exr_raster.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>

#include <cmath>
#include <limits>

#include "source/files.h"

namespace scarp {
namespace {

using namespace test;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class ExrRaster : public Files {
 protected:
  // An EXR whose channels all hold `values`, whose data window starts at (-5, 7).
  std::string write_exr(const std::string& name, const std::vector<std::string>& channels, Imf::PixelType type,
                        int cols, int rows, const std::vector<float>& values,
                        Imf::Compression packing = Imf::ZIP_COMPRESSION) {
    Imf::Header header = header_of(channels, type, cols, rows);
    header.compression() = packing;
    Imf::OutputFile file(path(name).c_str(), header);
    const Storage storage(type, values);
    file.setFrameBuffer(storage.frame(channels, type, cols));
    file.writePixels(rows);
    return path(name);
  }
  static Imf::Header header_of(const std::vector<std::string>& channels, Imf::PixelType type, int cols, int rows) {
    Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), Imath::Box2i({-5, 7}, {-5 + cols - 1, 7 + rows - 1}));
    for (const std::string& channel : channels) header.channels().insert(channel, Imf::Channel(type));
    return header;
  }
  // The values as samples of a type.
  struct Storage {
    Storage(Imf::PixelType type, const std::vector<float>& values) : floats(values) {
      for (const float value : values) {
        if (type == Imf::HALF) halves.emplace_back(value);
        if (type == Imf::UINT) uints.push_back(static_cast<unsigned>(value));
      }
    }
    Imf::FrameBuffer frame(const std::vector<std::string>& channels, Imf::PixelType type, int cols) const {
      const std::size_t bytes = type == Imf::HALF ? 2 : 4;
      const void* first = type == Imf::HALF   ? static_cast<const void*>(halves.data())
                          : type == Imf::UINT ? static_cast<const void*>(uints.data())
                                              : static_cast<const void*>(floats.data());
      Imf::FrameBuffer frame;
      for (const std::string& channel : channels) {
        frame.insert(channel, Imf::Slice::Make(type, first, Imath::V2i(-5, 7), cols,
                                               static_cast<std::int64_t>(floats.size()) / cols, bytes,
                                               bytes * static_cast<std::size_t>(cols)));
      }
      return frame;
    }
    std::vector<float> floats;
    std::vector<half> halves;
    std::vector<unsigned> uints;
  };
};

const std::vector<float> kValues{0, 1, 2, 3, 4, 1000};
const std::vector<double> kDoubles(kValues.begin(), kValues.end());

TEST_F(ExrRaster, ReadsAllSampleTypes) {
  const struct {
    Imf::PixelType type;
    const char* name;
  } cases[] = {{Imf::HALF, "half"}, {Imf::FLOAT, "float"}, {Imf::UINT, "uint"}};
  for (const auto& c : cases) {
    const Raster raster = read_raster(write_exr("a.exr", {"Y"}, c.type, 3, 2, kValues), {});
    EXPECT_EQ(3, raster.cols);
    EXPECT_EQ(2, raster.rows);
    EXPECT_EQ(c.name, raster.file_type);
    EXPECT_EQ(kDoubles, doubles(raster)) << c.name;
    EXPECT_TRUE(holds<float>(raster));
    EXPECT_FALSE(raster.georeference.present);
  }
}

TEST_F(ExrRaster, ScanLineBlocksKeepTheirPosition) {
  const int cols = 37, rows = 101;
  std::vector<float> values(cols * rows);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  const std::vector<double> expected(values.begin(), values.end());
  for (const Imf::Compression packing :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    const std::string file = write_exr("a.EXR", {"height"}, Imf::FLOAT, cols, rows, values, packing);
    EXPECT_EQ(expected, doubles(read_raster(file, {}))) << packing;
    RasterOptions options;
    options.window = {30, 95, 2, 2};
    EXPECT_EQ((std::vector<double>{95 * 37 + 30, 95 * 37 + 31, 96 * 37 + 30, 96 * 37 + 31}),
              doubles(read_raster(file, options)));
  }
}

TEST_F(ExrRaster, TilesMatchScanLines) {
  const int cols = 37, rows = 101;
  std::vector<float> values(cols * rows);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  {
    Imf::Header header = header_of({"Y"}, Imf::FLOAT, cols, rows);
    header.setTileDescription(Imf::TileDescription(16, 16, Imf::MIPMAP_LEVELS));
    Imf::TiledOutputFile file(path("t.exr").c_str(), header);
    const Storage storage(Imf::FLOAT, values);
    file.setFrameBuffer(storage.frame({"Y"}, Imf::FLOAT, cols));
    for (int level = 0; level < file.numLevels(); ++level)
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  }
  EXPECT_EQ(std::vector<double>(values.begin(), values.end()), doubles(read_raster(path("t.exr"), {})));
}

TEST_F(ExrRaster, ChoosesTheOnlyChannelThenYThenR) {
  EXPECT_EQ(kDoubles, doubles(read_raster(write_exr("a.exr", {"depth.Z"}, Imf::FLOAT, 3, 2, kValues), {})));
  const Raster rgb = read_raster(write_exr("b.exr", {"R", "G", "B"}, Imf::FLOAT, 3, 2, kValues), {});
  EXPECT_TRUE(has_note(rgb, "channel R of B, G, R"));
  EXPECT_TRUE(has_note(read_raster(write_exr("c.exr", {"R", "Y", "A"}, Imf::FLOAT, 3, 2, kValues), {}),
                       "channel Y of A, R, Y"));
  const std::string file = write_exr("d.exr", {"a", "b"}, Imf::FLOAT, 3, 2, kValues);
  expect_says(read_error(file), "--channel: a, b");
  RasterOptions options;
  options.channel = "b";
  EXPECT_EQ(kDoubles, doubles(read_raster(file, options)));
  options.channel = "Y";
  expect_says(read_error(file, options), "no channel 'Y' (available: a, b)");
}

TEST_F(ExrRaster, MapsAHeightRange) {
  RasterOptions options;
  options.height_range = {-100, 400};
  const Raster floats = read_raster(write_exr("a.exr", {"Y"}, Imf::FLOAT, 2, 1, {0, 0.5}), options);
  EXPECT_DOUBLE_EQ(500, floats.scale);
  EXPECT_DOUBLE_EQ(-100, floats.offset);
  const Raster uints = read_raster(write_exr("b.exr", {"Y"}, Imf::UINT, 2, 1, {0, 7}), options);
  EXPECT_DOUBLE_EQ(500 / 4294967295.0, uints.scale);
}

TEST_F(ExrRaster, NanIsAHoleAndInfinityIsRejected) {
  const Raster raster = read_raster(write_exr("a.exr", {"Y"}, Imf::HALF, 2, 1, {kNan, 5}), {});
  EXPECT_TRUE(std::isnan(doubles(raster)[0]));
  EXPECT_EQ(5, doubles(raster)[1]);
  expect_says(read_error(write_exr("b.exr", {"Y"}, Imf::FLOAT, 2, 1, {1, INFINITY})), "column 1, row 0");
  expect_says(read_error(write_exr("c.exr", {"Y"}, Imf::FLOAT, 2, 1, {kNan, kNan})), "nodata");
}

TEST_F(ExrRaster, ReadsTheFirstPart) {
  {
    std::vector<Imf::Header> headers(2, header_of({"Y"}, Imf::FLOAT, 3, 2));
    for (int i = 0; i < 2; ++i) {
      headers[static_cast<std::size_t>(i)].setName(std::to_string(i));
      headers[static_cast<std::size_t>(i)].setType(Imf::SCANLINEIMAGE);
    }
    Imf::MultiPartOutputFile file(path("m.exr").c_str(), headers.data(), 2);
    for (int i = 0; i < 2; ++i) {
      std::vector<float> values = kValues;
      values[0] += static_cast<float>(i);
      const Storage storage(Imf::FLOAT, values);
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(storage.frame({"Y"}, Imf::FLOAT, 3));
      part.writePixels(2);
    }
  }
  const Raster raster = read_raster(path("m.exr"), {});
  EXPECT_EQ(kDoubles, doubles(raster));
  EXPECT_TRUE(has_note(raster, "first of 2 parts"));
}

TEST_F(ExrRaster, RejectsASubsampledChannel) {
  {
    Imf::Header header = header_of({}, Imf::FLOAT, 4, 4);
    header.dataWindow() = Imath::Box2i({0, 0}, {3, 3});
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT, 2, 2));
    std::vector<float> values(4, 1);
    Imf::OutputFile file(path("s.exr").c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 8, 2, 2));
    file.setFrameBuffer(frame);
    file.writePixels(4);
  }
  expect_says(read_error(path("s.exr")), "without a sample for every pixel");
}

TEST_F(ExrRaster, RejectsOtherFiles) {
  expect_says(read_error(path("none.exr")), "does not exist");
  expect_says(read_error(write("e.exr", "")), "0 bytes");
  expect_says(read_error(write("t.exr", "hello, this is text")), "not an EXR image");
  std::filesystem::create_directory(path("d.exr"));
  expect_says(read_error(path("d.exr")), "folder without");
  RasterOptions options;
  options.encoding = HeightEncoding::terrarium;
  expect_says(read_error(write_exr("a.exr", {"Y"}, Imf::FLOAT, 3, 2, kValues), options), "--encoding");
  RasterOptions channel;
  channel.channel = "Y";
  expect_says(read_error(write_tiff("a.tif", GDT_Int16, 1, 1, {1}), channel), ".exr");
}

TEST_F(ExrRaster, DamagedImagesAreRejectedOrReadCompletely) {
  std::vector<float> values(200 * 150);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * 7919 % 1000);
  for (const Imf::Compression packing : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    const std::string whole = bytes_of(write_exr("a.exr", {"Y"}, Imf::FLOAT, 200, 150, values, packing));
    for (const double share : {0.0005, 0.003, 0.1, 0.5, 0.97}) {
      write("cut.exr", whole.substr(0, 1 + static_cast<std::size_t>(static_cast<double>(whole.size()) * share)));
      read_error(path("cut.exr"));
    }
    // With a changed byte of the header or of the table behind it: an Error or samples, nothing else.
    const std::string small =
        bytes_of(write_exr("b.exr", {"Y"}, Imf::FLOAT, 20, 15, {values.begin(), values.begin() + 300}, packing));
    for (std::size_t at = 4; at < 600; at += 3) {
      std::string bytes = small;
      bytes[at] = static_cast<char>(bytes[at] ^ 0x55);
      try {
        read_raster(write("bad.exr", bytes), {});
      } catch (const Error&) {
      }
    }
  }
}

TEST_F(ExrRaster, ReadsFromArchives) {
  const std::string bytes = bytes_of(write_exr("a.exr", {"Y"}, Imf::FLOAT, 3, 2, kValues));
  const std::string member = "/vsizip/" + path("a.zip") + "/a.exr";
  VSILFILE* file = VSIFOpenL(member.c_str(), "wb");
  EXPECT_EQ(bytes.size(), VSIFWriteL(bytes.data(), 1, bytes.size(), file));
  VSIFCloseL(file);
  EXPECT_EQ(kDoubles, doubles(read_raster(member, {})));
}

}  // namespace
}  // namespace scarp
