// SPDX-License-Identifier: MIT
#include "app/cli/commands/function_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <variant>

#include "app/cli/options/function_input.h"
#include "scarp/field/height_function.h"
#include "scarp/scene/file/example_functions.h"

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

// The number of octaves of the fractal with the most octaves.
void find_octaves(const Function& function, Octaves& most) {
  std::visit(
      [&](const auto& f) {
        using Of = std::decay_t<decltype(f)>;
        if constexpr (std::is_same_v<Of, Fractal>) {
          most = {std::max(most.march, f.octaves.march), std::max(most.shadow, f.octaves.shadow),
                  std::max(most.normal, f.octaves.normal)};
        } else if constexpr (std::is_same_v<Of, Warp>) {
          find_octaves(f.base, most), find_octaves(f.shift_x, most), find_octaves(f.shift_y, most);
        } else if constexpr (std::is_same_v<Of, Terraces>) {
          find_octaves(f.base, most);
        } else if constexpr (requires { f.a, f.b; }) {
          find_octaves(f.a, most), find_octaves(f.b, most);
        }
      },
      function->shape);
}

struct Seen {
  double low = std::numeric_limits<double>::infinity(), high = -low, slope = 0;
};

// Heights on a lattice of side x side positions.
Seen seen_in(const HeightFunction& function, const FunctionRectangle& r, int side) {
  Seen seen;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      const double x = r.x_low + (r.x_high - r.x_low) * col / (side - 1);
      const double y = r.y_low + (r.y_high - r.y_low) * row / (side - 1);
      const double h = function.value(x, y);
      seen.low = std::min(seen.low, h), seen.high = std::max(seen.high, h);
      seen.slope = std::max(seen.slope, length(function.gradient(x, y, FunctionUse::march)));
    }
  }
  return seen;
}

double ratio(double certified, double seen) { return seen > 0 ? certified / seen : 1; }

// Ratio of the certified to the observed range, averaged over squares of the given size.
Json tightness_of(const HeightFunction& function, double extent, double size) {
  constexpr int kSquares = 5, kSide = 17;  // along each axis; samples along a side
  double range = 0, slope = 0;
  int count = 0;
  for (int row = 0; row < kSquares; ++row) {
    for (int col = 0; col < kSquares; ++col) {
      const double x = (extent - size) * (col / (kSquares - 1.0) - 0.5);
      const double y = (extent - size) * (row / (kSquares - 1.0) - 0.5);
      const FunctionRectangle square{x - 0.5 * size, x + 0.5 * size, y - 0.5 * size, y + 0.5 * size};
      const FunctionBound bound = function.bound(square);
      const Seen seen = seen_in(function, square, kSide);
      range += ratio(bound.high - bound.low, seen.high - seen.low), slope += ratio(bound.slope, seen.slope);
      ++count;
    }
  }
  return {{"size_m", size}, {"range", range / count}, {"slope", slope / count}};
}

Json bound_json(const FunctionBound& bound) {
  return {{"low_m", bound.low}, {"high_m", bound.high}, {"slope", bound.slope}, {"rounding_m", bound.rounding}};
}

}  // namespace

Json describe_function(const std::string& name_or_path, double extent) {
  const HeightFunction function(read_function(name_or_path));
  Octaves octaves{0, 0, 0};
  find_octaves(function.function(), octaves);
  Json info;
  info["function"] = name_or_path;
  info["kind"] = name_of(InputKind::function);
  info["octaves"] = {{"march", octaves.march}, {"shadow", octaves.shadow}, {"normal", octaves.normal}};
  info["instructions"] = {{"march", function.program(FunctionUse::march).code.size()},
                          {"shadow", function.program(FunctionUse::shadow).code.size()},
                          {"normal", function.program(FunctionUse::normal).code.size()}};
  info["everywhere"] = bound_json(function.bound_everywhere());
  const FunctionRectangle square{-0.5 * extent, 0.5 * extent, -0.5 * extent, 0.5 * extent};
  info["extent_m"] = extent;
  info["within"] = bound_json(function.bound(square));
  const Seen seen = seen_in(function, square, 257);
  info["seen"] = {{"low_m", seen.low}, {"high_m", seen.high}, {"slope", seen.slope}};
  info["tightness"] = Json::array();
  for (const double share : {1.0, 1.0 / 16, 1.0 / 256, 1.0 / 4096})
    info["tightness"].push_back(tightness_of(function, extent, share * extent));
  return info;
}

std::string function_text_of(const Json& info) {
  std::string out;
  const auto line = [&](std::string_view name, const std::string& value) {
    out += fmt::format("{:<12} {}\n", name, value);
  };
  const auto degrees = [](double slope) { return std::atan(slope) * 180 / std::numbers::pi; };
  const auto bound = [&](const Json& b) {
    const double slope = b["slope"].get<double>();
    return fmt::format("{:.6g} to {:.6g} m, slope at most {:.4g} ({:.1f} degrees)", b["low_m"].get<double>(),
                       b["high_m"].get<double>(), slope, degrees(slope));
  };
  const auto three = [&](const char* key) {
    const Json& of = info[key];
    return fmt::format("{} march, {} shadow, {} normal", of["march"].get<int>(), of["shadow"].get<int>(),
                       of["normal"].get<int>());
  };
  line("function", info["function"].get<std::string>());
  line("octaves", three("octaves"));
  line("program", three("instructions") + " instructions");
  line("everywhere", bound(info["everywhere"]) + ", certified");
  line("rounding", fmt::format("{:.2g} m at most", info["everywhere"]["rounding_m"].get<double>()));
  const double extent = info["extent_m"].get<double>();
  line("extent", fmt::format("{:.6g} x {:.6g} m about (0, 0)", extent, extent));
  line("  certified", bound(info["within"]));
  line("  seen", bound(info["seen"]) + ", of 257 x 257 places");
  line("tightness", "certified over seen, mean of 25 squares: range of heights, slope");
  for (const Json& at : info["tightness"]) {
    line("", fmt::format("{:>8.5g} m  {:6.2f}  {:6.2f}", at["size_m"].get<double>(), at["range"].get<double>(),
                         at["slope"].get<double>()));
  }
  return out;
}

}  // namespace scarp::cli
