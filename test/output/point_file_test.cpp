// SPDX-License-Identifier: MIT
// Point files, read back byte by byte, with the offsets of the published formats instead of the writers' structures.
#include "scarp/output/point_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "full_disk.h"
#include "scarp/base/error.h"
#include "scratch.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

// Little-endian numbers at offsets; these machines are little-endian.
class Bytes {
 public:
  explicit Bytes(std::string bytes) : bytes_(std::move(bytes)) {}
  template <class Number>
  Number at(std::size_t offset) const {
    Number number{};
    if (offset + sizeof(Number) > bytes_.size()) {
      ADD_FAILURE() << "beyond the end: " << offset;
      return number;
    }
    std::memcpy(&number, bytes_.data() + offset, sizeof(Number));
    return number;
  }
  std::string text(std::size_t offset, std::size_t width) const {
    const std::string field = bytes_.substr(offset, width);
    return field.substr(0, field.find('\0'));
  }
  std::size_t size() const { return bytes_.size(); }
  const std::string& all() const { return bytes_; }

 private:
  std::string bytes_;
};

class PointFiles : public testing::Test, protected test::Scratch {
 protected:
  Bytes written(const std::string& name, const std::vector<ScanPoint>& points, const LasSettings& las = {}) const {
    PointFile file(path(name), las);
    file.add(points);
    EXPECT_FALSE(fs::exists(path(name))) << "whole or not there";
    file.commit();
    EXPECT_EQ(file.count(), static_cast<std::int64_t>(points.size()));
    std::ifstream in(path(name), std::ios::binary);
    return Bytes({std::istreambuf_iterator<char>(in), {}});
  }
};

std::vector<ScanPoint> some_points(std::size_t count) {
  std::vector<ScanPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<double>(i);
    ScanPoint& point = points[i];
    point.position = {429450 + 0.37 * n, 5150700 - 0.21 * n, 120.25 + 0.001 * n};
    point.time = 1000 + 0.001 * n;
    point.column = static_cast<std::int64_t>(i / 64);
    point.channel = static_cast<std::int32_t>(i % 64);
    point.object = static_cast<std::uint32_t>(i % 3);
    point.azimuth = static_cast<float>(i % 360);
    point.elevation = -2.5f;
    point.range = 10.5f + static_cast<float>(i);
    point.scan_angle = static_cast<float>(i % 361) - 180;
  }
  return points;
}

TEST_F(PointFiles, WritesCsv) {
  std::vector<ScanPoint> points = some_points(2);
  points[1].hit = false;
  EXPECT_EQ(written("p.csv", points).all(),
            "time,column,channel,azimuth,elevation,range,x,y,z,object\n"
            "1000,0,0,0,-2.5,10.5,429450,5150700,120.25,0\n"
            "1000.001,0,1,1,-2.5,,,,,\n");
}

TEST_F(PointFiles, WritesAStructuredArray) {
  std::vector<ScanPoint> points = some_points(1000);
  points[999].hit = false;
  const Bytes file = written("p.npy", points);
  ASSERT_EQ(file.all().substr(0, 8), std::string("\x93NUMPY\x01\0", 8));
  const std::size_t begin = 10u + file.at<std::uint16_t>(8);
  EXPECT_EQ(begin % 64, 0u);
  const std::string header = file.all().substr(10, begin - 10);
  EXPECT_EQ(header.find("{'descr': [('time', '<f8'), ('column', '<i8'), ('channel', '<i4'), ('azimuth', '<f4'), "
                        "('elevation', '<f4'), ('range', '<f4'), ('x', '<f8'), ('y', '<f8'), ('z', '<f8'), "
                        "('object', '<u4')], 'fortran_order': False, 'shape': (1000,), }"),
            0u)
      << header;
  constexpr std::size_t kRow = 8 + 8 + 4 + 4 + 4 + 4 + 24 + 4;
  ASSERT_EQ(file.size(), begin + 1000 * kRow);
  for (std::size_t i = 0; i < 1000; ++i) {
    const std::size_t row = begin + i * kRow;
    EXPECT_EQ(file.at<double>(row), points[i].time);
    EXPECT_EQ(file.at<std::int64_t>(row + 8), points[i].column);
    EXPECT_EQ(file.at<std::int32_t>(row + 16), points[i].channel);
    EXPECT_EQ(file.at<float>(row + 20), points[i].azimuth);
    EXPECT_EQ(file.at<float>(row + 24), points[i].elevation);
    if (i == 999) {
      EXPECT_TRUE(std::isnan(file.at<float>(row + 28)));
      EXPECT_TRUE(std::isnan(file.at<double>(row + 32)));
      continue;
    }
    EXPECT_EQ(file.at<float>(row + 28), points[i].range);
    EXPECT_EQ(file.at<double>(row + 32), points[i].position.x);
    EXPECT_EQ(file.at<double>(row + 40), points[i].position.y);
    EXPECT_EQ(file.at<double>(row + 48), points[i].position.z);
    EXPECT_EQ(file.at<std::uint32_t>(row + 56), points[i].object);
  }
}

TEST_F(PointFiles, WritesPly) {
  const std::vector<ScanPoint> points = some_points(300);
  const Bytes file = written("p.ply", points);
  const std::string end = "end_header\n";
  const std::size_t begin = file.all().find(end) + end.size();
  std::istringstream header(file.all().substr(0, begin));
  std::string line;
  std::vector<std::string> lines;
  while (std::getline(header, line)) {
    if (!line.starts_with("comment")) lines.push_back(line);
  }
  EXPECT_EQ(lines, (std::vector<std::string>{"ply", "format binary_little_endian 1.0", "element vertex 300",
                                             "property double x", "property double y", "property double z",
                                             "property double time", "property float range", "property float azimuth",
                                             "property float elevation", "property int channel", "property uint object",
                                             "property double column", "end_header"}));
  constexpr std::size_t kRow = 4 * 8 + 3 * 4 + 4 + 4 + 8;
  ASSERT_EQ(file.size(), begin + 300 * kRow);
  for (std::size_t i = 0; i < 300; ++i) {
    const std::size_t row = begin + i * kRow;
    EXPECT_EQ(file.at<double>(row), points[i].position.x);
    EXPECT_EQ(file.at<double>(row + 8), points[i].position.y);
    EXPECT_EQ(file.at<double>(row + 16), points[i].position.z);
    EXPECT_EQ(file.at<double>(row + 24), points[i].time);
    EXPECT_EQ(file.at<float>(row + 32), points[i].range);
    EXPECT_EQ(file.at<float>(row + 36), points[i].azimuth);
    EXPECT_EQ(file.at<float>(row + 40), points[i].elevation);
    EXPECT_EQ(file.at<std::int32_t>(row + 44), points[i].channel);
    EXPECT_EQ(file.at<std::uint32_t>(row + 48), points[i].object);
    EXPECT_EQ(file.at<double>(row + 52), static_cast<double>(points[i].column));
  }
}

// Offsets of the public header block, of variable length records and of point data record format 6: LAS 1.4 R15, tables
// 3, 5 and 17; extra bytes: table 24.
TEST_F(PointFiles, WritesLasAsPublished) {
  const std::vector<ScanPoint> points = some_points(9000);
  LasSettings las = las_settings({429400, 5148000, 100}, {433000, 5151000, 200});
  las.crs_wkt = "PROJCS[\"a test\"]";
  const Bytes file = written("p.las", points, las);
  EXPECT_EQ(file.all().substr(0, 4), "LASF");
  EXPECT_EQ(file.at<std::uint16_t>(4), 0) << "file source";
  EXPECT_EQ(file.at<std::uint16_t>(6), 0x10) << "global encoding: WKT, and GPS week time";
  EXPECT_EQ(file.all().substr(8, 16), std::string(16, '\0'));
  EXPECT_EQ(file.at<std::uint8_t>(24), 1);
  EXPECT_EQ(file.at<std::uint8_t>(25), 4);
  EXPECT_EQ(file.text(26, 32), "OTHER");
  EXPECT_EQ(file.text(58, 32), "Scarp");
  EXPECT_GE(file.at<std::uint16_t>(90), 1);
  EXPECT_LE(file.at<std::uint16_t>(90), 366);
  EXPECT_GE(file.at<std::uint16_t>(92), 2024);
  EXPECT_EQ(file.at<std::uint16_t>(94), 375) << "size of the header";
  const std::size_t begin = file.at<std::uint32_t>(96);
  EXPECT_EQ(file.at<std::uint32_t>(100), 2u) << "variable length records";
  EXPECT_EQ(file.at<std::uint8_t>(104), 6) << "point format";
  const std::size_t row_bytes = file.at<std::uint16_t>(105);
  EXPECT_EQ(row_bytes, 30u + 10u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(file.at<std::uint32_t>(107 + 4 * i), 0u) << "legacy counts";
  double scale[3], offset[3], high[3], low[3];
  for (std::size_t i = 0; i < 3; ++i) {
    scale[i] = file.at<double>(131 + 8 * i), offset[i] = file.at<double>(155 + 8 * i);
    high[i] = file.at<double>(179 + 16 * i), low[i] = file.at<double>(187 + 16 * i);
    EXPECT_EQ(scale[i], 0.001);
    EXPECT_EQ(offset[i], std::round(offset[i]));
  }
  EXPECT_EQ(file.at<std::uint64_t>(227), 0u) << "waveforms";
  EXPECT_EQ(file.at<std::uint64_t>(235), 0u) << "extended records";
  EXPECT_EQ(file.at<std::uint32_t>(243), 0u);
  EXPECT_EQ(file.at<std::uint64_t>(247), 9000u) << "points";
  EXPECT_EQ(file.at<std::uint64_t>(255), 9000u) << "of return 1";
  for (std::size_t i = 1; i < 15; ++i) EXPECT_EQ(file.at<std::uint64_t>(255 + 8 * i), 0u);

  std::size_t record = 375;
  EXPECT_EQ(file.at<std::uint16_t>(record), 0);
  EXPECT_EQ(file.text(record + 2, 16), "LASF_Projection");
  EXPECT_EQ(file.at<std::uint16_t>(record + 18), 2112);
  const std::size_t wkt = file.at<std::uint16_t>(record + 20);
  EXPECT_EQ(file.all().substr(record + 54, wkt), las.crs_wkt + '\0');
  record += 54 + wkt;
  EXPECT_EQ(file.text(record + 2, 16), "LASF_Spec");
  EXPECT_EQ(file.at<std::uint16_t>(record + 18), 4);
  EXPECT_EQ(file.at<std::uint16_t>(record + 20), 3 * 192);
  const std::pair<std::string, int> extra[] = {{"channel", 3}, {"range", 9}, {"object", 5}};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t field = record + 54 + 192 * i;
    EXPECT_EQ(file.at<std::uint8_t>(field + 2), extra[i].second);
    EXPECT_EQ(file.at<std::uint8_t>(field + 3), 0);
    EXPECT_EQ(file.text(field + 4, 32), extra[i].first);
    EXPECT_FALSE(file.text(field + 160, 32).empty());
  }
  EXPECT_EQ(begin, record + 54 + 3 * 192);

  ASSERT_EQ(file.size(), begin + 9000 * row_bytes);
  double least[3] = {1e9, 1e9, 1e9}, most[3] = {-1e9, -1e9, -1e9};
  for (std::size_t i = 0; i < 9000; ++i) {
    const std::size_t row = begin + i * row_bytes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = file.at<std::int32_t>(row + 4 * axis) * scale[axis] + offset[axis];
      EXPECT_NEAR(place, points[i].position[static_cast<int>(axis)], 0.000501);
      least[axis] = std::min(least[axis], place), most[axis] = std::max(most[axis], place);
    }
    EXPECT_EQ(file.at<std::uint16_t>(row + 12), 0) << "intensity";
    EXPECT_EQ(file.at<std::uint8_t>(row + 14), 0x11) << "return 1 of 1";
    EXPECT_EQ(file.at<std::uint8_t>(row + 15), 0) << "flags";
    EXPECT_EQ(file.at<std::uint8_t>(row + 16), 0) << "class";
    EXPECT_EQ(file.at<std::uint8_t>(row + 17), 0) << "user data";
    EXPECT_NEAR(file.at<std::int16_t>(row + 18) * 0.006, static_cast<double>(points[i].scan_angle), 0.00301);
    EXPECT_EQ(file.at<std::uint16_t>(row + 20), 0) << "source";
    EXPECT_EQ(file.at<double>(row + 22), points[i].time);
    EXPECT_EQ(file.at<std::uint16_t>(row + 30), points[i].channel);
    EXPECT_EQ(file.at<float>(row + 32), points[i].range);
    EXPECT_EQ(file.at<std::uint32_t>(row + 36), points[i].object);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(low[axis], least[axis], 1e-9) << axis;
    EXPECT_NEAR(high[axis], most[axis], 1e-9) << axis;
  }
}

TEST_F(PointFiles, EmptyFilesAreValid) {
  EXPECT_EQ(written("e.csv", {}).all(), "time,column,channel,azimuth,elevation,range,x,y,z,object\n");
  EXPECT_NE(written("e.npy", {}).all().find("'shape': (0,)"), std::string::npos);
  EXPECT_NE(written("e.ply", {}).all().find("\nelement vertex 0\n"), std::string::npos);
  const Bytes las = written("e.las", {});
  EXPECT_EQ(las.size(), las.at<std::uint32_t>(96));
  EXPECT_EQ(las.at<std::uint64_t>(247), 0u);
  EXPECT_EQ(las.at<std::uint32_t>(100), 1u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(las.at<double>(179 + 8 * i), 0);
}

TEST_F(PointFiles, LasStepsCoverTheBox) {
  const double most = 0x1p31 - 1;
  const struct {
    dvec3 low, high, millimetre, scale;
  } cases[] = {
      {{0, 0, 0}, {100, 2000, 50}, dvec3(1e-3), dvec3(1e-3)},
      {{500000, 4000000, -400}, {600000, 4100000, 9000}, dvec3(1e-3), dvec3(1e-3)},
      {{-20037508, -20037508, 0}, {20037508, 20037508, 9000}, dvec3(1.3e-3, 1.3e-3, 1e-3), {0.1, 0.1, 1e-3}},
      {{10, 0, 1}, {11, 1, 1000}, {9e-9, 9e-9, 1e-3}, {1e-8, 1e-8, 1e-3}},
      {{-180, -90, -400}, {180, 90, 9000}, {9e-9, 9e-9, 1e-3}, {1e-6, 1e-7, 1e-3}},
  };
  for (const auto& c : cases) {
    const LasSettings las = las_settings(c.low, c.high, c.millimetre);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(las.scale[i], c.scale[i]) << c.low.x << " " << i;
      EXPECT_LE(std::abs(c.low[i] - las.offset[i]) / las.scale[i], most);
      EXPECT_LE(std::abs(c.high[i] - las.offset[i]) / las.scale[i], most);
    }
  }
}

TEST_F(PointFiles, ErrorsNameTheFileAndLeaveNoFile) {
  std::vector<ScanPoint> points = some_points(10);
  EXPECT_EQ(test::refusal([&] { PointFile file(path("p.laz")); }),
            path("p.laz") +
                ": points of a scanner are CSV, NumPy, PLY or LAS files (end the name in .csv, .npy, .ply or .las)");
  EXPECT_THROW(PointFile(path("none/p.las")), Error);
  const std::string far = test::refusal([&] { written("p.las", points); });  // steps of a millimetre from 0
  EXPECT_EQ(far.find(path("p.las") + ": y = 5150700 needs more than 32 bits"), 0u) << far;
  points[3].hit = false;
  for (const char* name : {"p.las", "p.ply"}) {
    const std::string miss = test::refusal([&] { written(name, points, las_settings({4e5, 5e6, 0}, {5e5, 6e6, 1})); });
    EXPECT_EQ(miss, path(name) + ": misses have no position (write them to .csv or .npy)");
  }
  EXPECT_TRUE(empty());
}

TEST_F(PointFiles, FullDiskLeavesNoFile) {
  const std::vector<ScanPoint> points = some_points(100000);
  for (const char* name : {"p.csv", "p.npy", "p.ply", "p.las"}) {
    const test::FullDisk full(1 << 20);
    const std::string what = test::refusal([&] {
      PointFile file(path(name), las_settings({4e5, 5e6, 0}, {5e5, 6e6, 1}));
      for (int i = 0; i < 3; ++i) file.add(points);
      file.commit();
    });
    EXPECT_EQ(what, path(name) + ": cannot be written (is the disk full?)");
    EXPECT_TRUE(empty()) << name;
  }
}

}  // namespace
}  // namespace scarp
