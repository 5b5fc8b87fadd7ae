// SPDX-License-Identifier: MIT
#include "scarp/output/las.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/output/little_endian.h"
#include "scarp/output/point_format.h"

namespace scarp {
namespace {

constexpr std::uint16_t kHeaderBytes = 375, kExtraBytes = 2 + 4 + 4, kPointBytes = 30 + kExtraBytes;
constexpr std::size_t kRecordHeaderBytes = 54;
constexpr std::uint16_t kWktRecord = 2112, kExtraBytesRecord = 4;
constexpr std::uint16_t kWktBit = 1 << 4;  // of the global encoding; point formats from 6 on require it
constexpr std::uint8_t kPointFormat = 6;
constexpr double kMostSteps = 0x1p31 - 1;

void append_text(std::string& out, std::string_view text, std::size_t width) {
  text = text.substr(0, width);
  out.append(text).append(width - text.size(), '\0');
}

void append_zeros(std::string& out, std::size_t count) { out.append(count, '\0'); }

// Returns a variable length record.
std::string record(std::string_view user, std::uint16_t id, std::string_view about, std::string_view content) {
  constexpr std::size_t kMost = 0xffff;
  if (content.size() > kMost) throw Error(fmt::format("a record of {} bytes is too long for LAS", content.size()));
  std::string out;
  append_zeros(out, 2);
  append_text(out, user, 16);
  append_little_endian(out, id);
  append_little_endian(out, static_cast<std::uint16_t>(content.size()));
  append_text(out, about, 32);
  return out.append(content);
}

std::string extra_bytes_record() {
  constexpr std::uint8_t kUint16 = 3, kUint32 = 5, kFloat = 9;
  const struct {
    std::string_view name;
    std::uint8_t type;
    std::string_view about;
  } fields[] = {{"channel", kUint16, "beam of the scanner, from 0"},
                {"range", kFloat, "metres from the scanner"},
                {"object", kUint32, "object of the scene, from 0"}};
  std::string content;
  for (const auto& field : fields) {
    append_zeros(content, 2);
    append_little_endian(content, field.type);
    append_zeros(content, 1);  // neither bounds nor a scale
    append_text(content, field.name, 32);
    append_zeros(content, 4 + 5 * 24);  // reserved; no_data, min, max, scale, offset
    append_text(content, field.about, 32);
  }
  return record("LASF_Spec", kExtraBytesRecord, "Extra bytes", content);
}

class LasPoints final : public PointFormat {
 public:
  explicit LasPoints(const LasSettings& settings) : settings_(settings) {
    if (!settings.crs_wkt.empty()) {
      // Ends with a zero byte.
      records_ += record("LASF_Projection", kWktRecord, "OGC coordinate system WKT",
                         std::string_view(settings.crs_wkt.c_str(), settings.crs_wkt.size() + 1));
      ++record_count_;
    }
    records_ += extra_bytes_record();
    ++record_count_;
    const std::time_t now = std::time(nullptr);
    std::tm day{};
    ::gmtime_r(&now, &day);
    day_ = static_cast<std::uint16_t>(day.tm_yday + 1), year_ = static_cast<std::uint16_t>(day.tm_year + 1900);
  }

  std::string header(const PointSummary& summary) const override {
    const auto count = static_cast<std::uint64_t>(summary.count);
    std::string out = "LASF";
    append_little_endian(out, std::uint16_t{0});  // file source
    append_little_endian(out, kWktBit);
    append_zeros(out, 16);  // project
    out += {1, 4};
    append_text(out, "OTHER", 32);
    append_text(out, "Scarp", 32);
    append_little_endian(out, day_);
    append_little_endian(out, year_);
    append_little_endian(out, kHeaderBytes);
    append_little_endian(out, static_cast<std::uint32_t>(kHeaderBytes + records_.size()));
    append_little_endian(out, record_count_);
    append_little_endian(out, kPointFormat);
    append_little_endian(out, kPointBytes);
    append_zeros(out, 4 + 5 * 4);  // legacy counts
    for (const dvec3& v : {settings_.scale, settings_.offset})
      for (int i = 0; i < 3; ++i) append_little_endian(out, v[i]);
    const bool any = summary.low.x <= summary.high.x;
    for (int i = 0; i < 3; ++i) {
      for (const double bound : {summary.high[i], summary.low[i]}) {
        append_little_endian(out, any ? settings_.offset[i] + settings_.scale[i] * step_of(bound, i) : 0.0);
      }
    }
    append_zeros(out, 8 + 8 + 4);  // waveforms, extended records
    append_little_endian(out, count);
    append_little_endian(out, count);  // number of first returns
    append_zeros(out, 14 * 8);
    return out + records_;
  }

  void append(std::string& out, const ScanPoint& p) const override {
    require_hit(p);
    for (int i = 0; i < 3; ++i) {
      const double step = step_of(p.position[i], i);
      if (!(std::abs(step) <= kMostSteps)) {
        throw Error(
            fmt::format("{} = {} needs more than 32 bits in steps of {} from {} (limit the range of the scanner)",
                        "xyz"[i], p.position[i], settings_.scale[i], settings_.offset[i]));
      }
      append_little_endian(out, static_cast<std::int32_t>(step));
    }
    constexpr std::uint8_t kOneOfOne = 1 | 1 << 4;
    constexpr double kDegreesPerStep = 0.006;
    append_little_endian(out, std::uint16_t{0});  // intensity
    append_little_endian(out, kOneOfOne);
    append_zeros(out, 3);  // flags, class (never classified), user data
    append_little_endian(out,
                         static_cast<std::int16_t>(std::lround(static_cast<double>(p.scan_angle) / kDegreesPerStep)));
    append_little_endian(out, std::uint16_t{0});  // point source
    append_little_endian(out, p.time);
    append_little_endian(out, static_cast<std::uint16_t>(p.channel));
    append_little_endian(out, p.range);
    append_little_endian(out, p.object);
  }

 private:
  double step_of(double coordinate, int axis) const {
    return std::round((coordinate - settings_.offset[axis]) / settings_.scale[axis]);
  }

  LasSettings settings_;
  std::string records_;
  std::uint32_t record_count_ = 0;
  std::uint16_t day_ = 0, year_ = 0;
};

}  // namespace

LasSettings las_settings(const dvec3& low, const dvec3& high, const dvec3& millimetre) {
  LasSettings settings;
  for (int i = 0; i < 3; ++i) {
    settings.offset[i] = std::round(0.5 * (low[i] + high[i]));
    const double reach = 0.75 * (high[i] - low[i]) + 1;  // half the box, a quarter to spare, and the offset's rounding
    auto digits = static_cast<int>(std::lround(std::log10(millimetre[i])));
    while (reach > kMostSteps * std::pow(10.0, digits)) ++digits;
    // Parsed, not computed: 1e-3 is the double nearest to it.
    settings.scale[i] = std::stod(fmt::format("1e{}", digits));
  }
  return settings;
}

std::unique_ptr<PointFormat> las_points(const LasSettings& settings) { return std::make_unique<LasPoints>(settings); }

}  // namespace scarp
