// SPDX-License-Identifier: MIT
// Points as CSV and .npy.
#include <fmt/format.h>

#include <array>
#include <iterator>
#include <limits>

#include "scarp/output/little_endian.h"
#include "scarp/output/npy_array.h"
#include "scarp/output/point_format.h"

namespace scarp {
namespace {

class CsvPoints final : public PointFormat {
 public:
  // Its length never changes.
  std::string header(const PointSummary&) const override {
    return "time,column,channel,azimuth,elevation,range,x,y,z,object\n";
  }
  void append(std::string& out, const ScanPoint& p) const override {
    const auto to = std::back_inserter(out);
    fmt::format_to(to, "{},{},{},{},{},", p.time, p.column, p.channel, p.azimuth, p.elevation);
    if (p.hit) {
      fmt::format_to(to, "{},{},{},{},{}\n", p.range, p.position.x, p.position.y, p.position.z, p.object);
    } else {
      out += ",,,,\n";
    }
  }
};

constexpr std::array kPointColumns = {
    NpyColumn{"time", "<f8"},      NpyColumn{"column", "<i8"}, NpyColumn{"channel", "<i4"}, NpyColumn{"azimuth", "<f4"},
    NpyColumn{"elevation", "<f4"}, NpyColumn{"range", "<f4"},  NpyColumn{"x", "<f8"},       NpyColumn{"y", "<f8"},
    NpyColumn{"z", "<f8"},         NpyColumn{"object", "<u4"}};

class NpyPoints final : public PointFormat {
 public:
  std::string header(const PointSummary& summary) const override {
    return npy_array_header(kPointColumns, summary.count);
  }
  void append(std::string& out, const ScanPoint& p) const override {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const dvec3 position = p.hit ? p.position : dvec3(std::numeric_limits<double>::quiet_NaN());
    append_little_endian(out, p.time);
    append_little_endian(out, p.column);
    append_little_endian(out, p.channel);
    for (const float number : {p.azimuth, p.elevation, p.hit ? p.range : kNone}) append_little_endian(out, number);
    for (int i = 0; i < 3; ++i) append_little_endian(out, position[i]);
    append_little_endian(out, p.object);
  }
};

}  // namespace

std::unique_ptr<PointFormat> csv_points() { return std::make_unique<CsvPoints>(); }
std::unique_ptr<PointFormat> npy_points() { return std::make_unique<NpyPoints>(); }

}  // namespace scarp
