// SPDX-License-Identifier: MIT
#include "scarp/render/surface/ramp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "scarp/base/error.h"
#include "scarp/render/light/colour.glsl.h"
#include "scarp/render/surface/ramp_tables.h"

namespace scarp {
namespace {

constexpr std::array<std::string_view, 6> kNames = {"viridis", "magma", "inferno", "plasma", "grey", "hypsometric"};

// A colour of a hand-made ramp at a fraction of its range.
struct Stop {
  double at;
  std::uint32_t rgb;
};

// Deep water to the shore.
constexpr std::array kSea = {Stop{0.00, 0x1c3f6e}, Stop{0.50, 0x4a86b8}, Stop{0.85, 0x8fbfdc}, Stop{1.00, 0xb9dcea}};
// Lowland to summits: light on low ground so that hill shading is visible everywhere, nearly white at the top.
constexpr std::array kLand = {Stop{0.00, 0x789b74}, Stop{0.18, 0xa1b588}, Stop{0.36, 0xd0c99c}, Stop{0.55, 0xc6a67b},
                              Stop{0.72, 0xab866a}, Stop{0.86, 0xb5a397}, Stop{1.00, 0xf3f1ee}};
constexpr std::array kGrey = {Stop{0.0, 0x000000}, Stop{1.0, 0xffffff}};

// Number of entries of a ramp made from stops: the steps are far below 8-bit resolution.
constexpr int kEntries = 1024;

vec3 srgb_from_rgb(std::uint32_t rgb) { return vec3((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255) / 255.0f; }

std::vector<vec3> from_table(const RampTable& table) {
  std::vector<vec3> colours;
  for (const std::uint32_t rgb : table) colours.push_back(linear_from_srgb(srgb_from_rgb(rgb)));
  return colours;
}

// Interpolated in sRGB, where equal steps look equal.
std::vector<vec3> from_stops(std::span<const Stop> stops) {
  std::vector<vec3> colours;
  std::size_t next = 1;
  for (int i = 0; i < kEntries; ++i) {
    const double at = i / (kEntries - 1.0);
    while (next + 1 < stops.size() && at > stops[next].at) ++next;
    const Stop &from = stops[next - 1], &to = stops[next];
    const auto share = static_cast<float>((at - from.at) / (to.at - from.at));
    colours.push_back(linear_from_srgb(srgb_from_rgb(from.rgb) * (1 - share) + srgb_from_rgb(to.rgb) * share));
  }
  return colours;
}

// scarp_srgb_byte() without a call of pow(): for each piece of the channel's range, the byte at its start, and where
// the next byte starts. No piece contains the starts of two bytes.
class SrgbBytes {
 public:
  SrgbBytes() {
    for (std::size_t byte = 1; byte < begin_.size() - 1; ++byte) begin_[byte] = first_with(static_cast<float>(byte));
    begin_.back() = std::numeric_limits<float>::infinity();
    for (std::uint32_t i = 0; i < kPieces; ++i) byte_[i] = by_power(std::bit_cast<float>(kFirst + (i << kShift)));
  }
  unsigned char operator()(float linear) const {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    const std::uint32_t bits = std::max(std::bit_cast<std::uint32_t>(linear), kFirst);
    const unsigned byte = byte_[(bits - kFirst) >> kShift];
    return static_cast<unsigned char>(byte + (linear >= begin_[byte + 1]));
  }

 private:
  // Pieces of floats from 2^-13, which is black, to 1: 256 of each power of two.
  static constexpr std::uint32_t kFirst = std::bit_cast<std::uint32_t>(0x1p-13f), kShift = 15;
  static constexpr std::uint32_t kPieces = (std::bit_cast<std::uint32_t>(1.0f) - kFirst) >> kShift;

  static unsigned char by_power(float linear) { return static_cast<unsigned char>(glsl::scarp_srgb_byte(linear)); }
  // The smallest float with this byte.
  static float first_with(float byte) {
    std::uint32_t below = 0, from = std::bit_cast<std::uint32_t>(1.0f);
    while (from - below > 1) {
      const std::uint32_t middle = below + (from - below) / 2;
      (glsl::scarp_srgb_byte(std::bit_cast<float>(middle)) < byte ? below : from) = middle;
    }
    return std::bit_cast<float>(from);
  }

  std::array<float, 257> begin_{};
  std::array<unsigned char, kPieces> byte_{};
};

}  // namespace

std::span<const std::string_view> ramp_names() { return kNames; }

Ramp::Ramp(std::string_view name, double low, double high) {
  if (name == "viridis") pieces_.push_back({low, high, from_table(kViridis)});
  if (name == "magma") pieces_.push_back({low, high, from_table(kMagma)});
  if (name == "inferno") pieces_.push_back({low, high, from_table(kInferno)});
  if (name == "plasma") pieces_.push_back({low, high, from_table(kPlasma)});
  if (name == "grey") pieces_.push_back({low, high, from_stops(kGrey)});
  if (name == "hypsometric") {
    // A sea without depth, entirely at 0, has the colour of the shore: any lower end has this effect.
    if (low <= 0) pieces_.push_back({low < 0 ? low : -1.0, 0.0, from_stops(kSea)});
    if (high > 0) pieces_.push_back({std::max(low, 0.0), high, from_stops(kLand)});
  }
  if (pieces_.empty()) {
    std::string names;
    for (const std::string_view known : kNames) names += fmt::format("{}{}", names.empty() ? "" : ", ", known);
    throw Error(fmt::format("ramp '{}': unknown (available: {})", name, names));
  }
}

Ramp::Ramp(const RampStops& stops, double low, double high, double scale) {
  // Steps within a slice that are indistinguishable to the eye.
  constexpr int kSteps = 32;
  for (const RampSlice& slice : stops.slices) {
    const auto placed = [&](double value) {
      if (!stops.stretched) return value * scale;
      if (!stops.hinged) return low + value * (high - low);
      return value * (value < 0 ? std::max(0.0, -low) : std::max(0.0, high));
    };
    Piece piece{placed(slice.low), placed(slice.high), {}};
    for (int i = 0; i <= kSteps; ++i) {
      const auto share = static_cast<float>(i) / kSteps;
      piece.colours.push_back(linear_from_srgb(slice.srgb_low * (1 - share) + slice.srgb_high * share));
    }
    pieces_.push_back(std::move(piece));
  }
}

vec3 Ramp::operator()(double value) const {
  const auto above = [](const Piece& piece, double v) { return piece.high < v; };
  const auto found = std::lower_bound(pieces_.begin(), pieces_.end() - 1, value, above);
  const Piece& piece = *found;
  const auto at = glsl::scarp_table_place(value, piece.low, piece.high, static_cast<int>(piece.colours.size()));
  const auto entry = static_cast<std::size_t>(at.entry);
  return piece.colours[entry] * (1 - at.place) + piece.colours[entry + 1] * at.place;
}

vec3 linear_from_srgb(vec3 srgb) { return glsl::scarp_linear_from_srgb(srgb); }

unsigned char srgb_byte(float linear) {
  static const SrgbBytes bytes;
  return bytes(linear);
}

}  // namespace scarp
