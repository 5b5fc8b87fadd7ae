// SPDX-License-Identifier: MIT
#include "app/cli/picture/graticule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/source/raster/coordinates.h"

namespace scarp::cli {
namespace {

constexpr double kMinute = 1.0 / 60, kSecond = 1.0 / 3600;
// Round numbers of degrees, minutes and seconds; below a second, decimal degrees.
constexpr double kSpacings[] = {1e-6,
                                2e-6,
                                5e-6,
                                1e-5,
                                2e-5,
                                5e-5,
                                1e-4,
                                kSecond,
                                2 * kSecond,
                                5 * kSecond,
                                10 * kSecond,
                                15 * kSecond,
                                30 * kSecond,
                                kMinute,
                                2 * kMinute,
                                5 * kMinute,
                                10 * kMinute,
                                15 * kMinute,
                                30 * kMinute,
                                1,
                                2,
                                5,
                                10,
                                15,
                                30};
constexpr double kWantedLines = 5, kMostWanted = 12;  // along the longer side
constexpr int kMostLines = 200;
constexpr int kLattice = 17;      // points per side, to find the range of longitudes and latitudes
constexpr int kPieces = 64;       // per line
constexpr double kBeyond = 0.05;  // fraction of the range by which lines extend beyond it, to reach the border

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void include(double v) { low = std::min(low, v), high = std::max(high, v); }
  double size() const { return high - low; }
  int multiples(double step) const {
    return std::max(0, static_cast<int>(std::floor(high / step) - std::ceil(low / step)) + 1);
  }
};

// "84°20'W"; all lines of a spacing show the same units.
std::string degrees_text(double degrees, double spacing, const char* positive, const char* negative) {
  const double size = std::abs(degrees);
  const auto whole = [&](double unit) { return std::abs(spacing / unit - std::round(spacing / unit)) < 1e-9; };
  std::string text;
  if (whole(1)) {
    text = fmt::format("{:.0f}°", size);
  } else if (whole(kMinute)) {
    const auto minutes = std::llround(size / kMinute);
    text = fmt::format("{}°{:02}'", minutes / 60, minutes % 60);
  } else if (whole(kSecond)) {
    const auto seconds = std::llround(size / kSecond);
    text = fmt::format("{}°{:02}'{:02}\"", seconds / 3600, seconds / 60 % 60, seconds % 60);
  } else {
    text = fmt::format("{:.9g}°", std::round(size * 1e9) / 1e9);
  }
  const bool none = size < spacing / 2 || (size == 180 && *positive == 'E');
  return text + (none ? "" : degrees > 0 ? positive : negative);
}

class Graticule {
 public:
  Graticule(const CoordinateFrame& frame, const Camera& camera, double per_pixel)
      : frame_(frame), camera_(camera), per_pixel_(per_pixel) {
    const dvec2 size = camera.size();
    std::optional<double> middle;
    for (int i = 0; i < kLattice * kLattice; ++i) {
      // Starts in the middle. Stays half a pixel inside the border, because the longitude on the border may be that of
      // the other side.
      const int k = (i + kLattice * kLattice / 2) % (kLattice * kLattice);
      const auto at = [&](int n, double pixels) { return 0.5 + n / (kLattice - 1.0) * (pixels - 1); };
      dvec3 p = camera.ray(at(k % kLattice, size.x), at(k / kLattice, size.y)).origin;
      if (frame.from_local({&p, 1})) continue;
      if (!middle) middle = p.x;
      longitudes_.include(*middle + std::remainder(p.x - *middle, 360));
      latitudes_.include(p.y);
    }
    if (!middle) throw Error("--graticule: the map is outside the domain of its CRS");
  }

  double round_spacing() const {
    const double most = std::max(longitudes_.size(), latitudes_.size());
    std::size_t i = 0;
    while (i + 1 < std::size(kSpacings) && most / kSpacings[i] > kWantedLines) ++i;
    // Uses a closer spacing if no line would cross the shorter side.
    const auto leaves_one_out = [&](double spacing) {
      return longitudes_.multiples(spacing) == 0 || latitudes_.multiples(spacing) == 0;
    };
    while (i > 0 && leaves_one_out(kSpacings[i]) && most / kSpacings[i - 1] <= kMostWanted) --i;
    return kSpacings[i];
  }

  std::vector<FigureLine> lines(double spacing) const {
    const int count = longitudes_.multiples(spacing) + latitudes_.multiples(spacing);
    if (count == 0 || count > kMostLines) {
      throw Error(fmt::format(
          "--graticule {:.6g}: {} lines cross the map, which spans {:.6g} x {:.6g} degrees (use {} spacing, or auto)",
          spacing, count == 0 ? "no" : fmt::format("{}", count), longitudes_.size(), latitudes_.size(),
          count == 0 ? "a smaller" : "a larger"));
    }
    std::vector<FigureLine> all;
    for (const bool meridian : {true, false}) {
      const Range &across = meridian ? longitudes_ : latitudes_, &along = meridian ? latitudes_ : longitudes_;
      for (int i = 0; i < across.multiples(spacing); ++i) {
        const double value = (std::ceil(across.low / spacing) + i) * spacing;
        FigureLine line{{}, "", meridian};
        const double beyond = kBeyond * along.size();
        for (int k = 0; k <= kPieces; ++k) {
          const double other = along.low - beyond + (along.size() + 2 * beyond) * k / kPieces;
          add_point(line, meridian ? dvec3(value, other, 0) : dvec3(other, value, 0));
        }
        line.text = meridian ? degrees_text(std::remainder(value, 360), spacing, "E", "W")
                             : degrees_text(value, spacing, "N", "S");
        all.push_back(std::move(line));
      }
    }
    return all;
  }

 private:
  void add_point(FigureLine& line, dvec3 p) const {
    p.y = std::clamp(p.y, -90.0, 90.0);
    if (std::abs(p.x) > 360 || frame_.to_local({&p, 1})) return;
    const std::optional<dvec2> pixel = camera_.pixel(p);
    if (pixel) line.points.push_back({per_pixel_ * pixel->x, per_pixel_ * pixel->y});
  }

  const CoordinateFrame& frame_;
  const Camera& camera_;
  double per_pixel_;
  Range longitudes_, latitudes_;
};

}  // namespace

std::vector<FigureLine> graticule_of(const Georeference& georeference, int cols, int rows, const Camera& camera,
                                     double per_pixel, std::optional<double> spacing_deg) {
  const auto frame = [&] {
    try {
      return CoordinateFrame(georeference, cols, rows, Coordinates::lonlat);
    } catch (const Error& error) {
      throw Error(fmt::format("--graticule: {}", error.what()));
    }
  }();
  const Graticule graticule(frame, camera, per_pixel);
  return graticule.lines(spacing_deg.value_or(graticule.round_spacing()));
}

}  // namespace scarp::cli
