// SPDX-License-Identifier: MIT
// Points as PLY. Source: G. Turk, "The PLY Polygon File Format", 1994; type sizes as in later versions.
#include <fmt/format.h>

#include <limits>

#include "scarp/output/little_endian.h"
#include "scarp/output/point_format.h"

namespace scarp {
namespace {

class PlyPoints final : public PointFormat {
 public:
  std::string header(const PointSummary& summary) const override {
    const std::string count = fmt::format("{}", summary.count);
    constexpr std::size_t kWidestCount = std::numeric_limits<std::int64_t>::digits10 + 1;
    // The comment pads the header to the length that it has with the widest count.
    return fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment Scarp: points of a scanner{}\nelement vertex {}\n"
        "property double x\nproperty double y\nproperty double z\nproperty double time\nproperty float range\n"
        "property float azimuth\nproperty float elevation\nproperty int channel\nproperty uint object\n"
        "property double column\nend_header\n",
        std::string(kWidestCount - count.size(), ' '), count);
  }
  void append(std::string& out, const ScanPoint& p) const override {
    require_hit(p);
    for (int i = 0; i < 3; ++i) append_little_endian(out, p.position[i]);
    append_little_endian(out, p.time);
    for (const float number : {p.range, p.azimuth, p.elevation}) append_little_endian(out, number);
    append_little_endian(out, p.channel);
    append_little_endian(out, p.object);
    append_little_endian(out, static_cast<double>(p.column));
  }
};

}  // namespace

std::unique_ptr<PointFormat> ply_points() { return std::make_unique<PlyPoints>(); }

}  // namespace scarp
