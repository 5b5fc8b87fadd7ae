// SPDX-License-Identifier: MIT
#include "scarp/field/function_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <tuple>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr int kMostInstructions = 4096;

// An instruction over any number of values, each written once.
struct Step {
  FunctionOp op = FunctionOp::constant;
  int a = 0, b = 0;
  double k0 = 0, k1 = 0, k2 = 0, k3 = 0;
  NoiseKind kind = NoiseKind::value;
  std::uint32_t seed = 0;
  int out = 0;  // noise_slope writes out, out + 1 and out + 2, turn writes out and out + 1
};

int outputs(FunctionOp op) { return op == FunctionOp::noise_slope ? 3 : op == FunctionOp::turn ? 2 : 1; }

class Compiler {
 public:
  explicit Compiler(FunctionUse use) : use_(use) {}

  int value_of(const Function& function, int x, int y) {
    const auto key = std::tuple(function.get(), x, y);
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    const int value = std::visit([&](const auto& shape) { return emit(shape, x, y); }, function->shape);
    known_.emplace(key, value);
    return value;
  }

  // Assigns each value a register from the step that writes it to the last step that reads it.
  FunctionProgram with_registers(int result) const {
    std::vector<std::size_t> last(static_cast<std::size_t>(values_), 0);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      last[static_cast<std::size_t>(steps_[i].a)] = last[static_cast<std::size_t>(steps_[i].b)] = i;
    }
    last[static_cast<std::size_t>(result)] = steps_.size();
    std::vector<std::uint8_t> place(static_cast<std::size_t>(values_), 0);
    std::array<int, kFunctionRegisters> holds;
    holds.fill(-1);
    holds[0] = 0, holds[1] = 1;
    place[1] = 1;
    FunctionProgram program;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const Step& step = steps_[i];
      FunctionInstruction instruction{step.op,
                                      step.kind,
                                      0,
                                      0,
                                      0,
                                      place[static_cast<std::size_t>(step.a)],
                                      place[static_cast<std::size_t>(step.b)],
                                      step.seed,
                                      step.k0,
                                      step.k1,
                                      step.k2,
                                      step.k3};
      std::uint8_t* const written[3] = {&instruction.out, &instruction.out_x, &instruction.out_y};
      for (int n = 0; n < outputs(step.op); ++n) {
        int free = 2;
        while (free < kFunctionRegisters && holds[static_cast<std::size_t>(free)] >= 0 &&
               last[static_cast<std::size_t>(holds[static_cast<std::size_t>(free)])] >= i) {
          ++free;
        }
        if (free == kFunctionRegisters) {
          throw Error(fmt::format("terrain function: needs more than {} numbers at a time (use fewer branches)",
                                  kFunctionRegisters));
        }
        holds[static_cast<std::size_t>(free)] = step.out + n;
        // Unread values stay live during their own step; otherwise another output of that step could take their
        // register.
        auto& until = last[static_cast<std::size_t>(step.out + n)];
        until = std::max(until, i);
        place[static_cast<std::size_t>(step.out + n)] = static_cast<std::uint8_t>(free);
        *written[n] = static_cast<std::uint8_t>(free);
      }
      program.code.push_back(instruction);
    }
    program.result = place[static_cast<std::size_t>(result)];
    return program;
  }

 private:
  int add(Step step) {
    if (steps_.size() == static_cast<std::size_t>(kMostInstructions)) {
      throw Error(
          fmt::format("terrain function: more than {} instructions (use fewer octaves or warps)", kMostInstructions));
    }
    step.out = values_;
    values_ += outputs(step.op);
    steps_.push_back(step);
    return step.out;
  }
  int constant(double k) { return add({.op = FunctionOp::constant, .k0 = k}); }
  int combine(double k0, int a, double k1, int b, double k2) {
    return add({.op = FunctionOp::combine, .a = a, .b = b, .k0 = k0, .k1 = k1, .k2 = k2});
  }
  int scale(double k0, int a, double k2 = 0) { return combine(k0, a, 0, a, k2); }
  int binary(FunctionOp op, int a, int b, double k0 = 0) { return add({.op = op, .a = a, .b = b, .k0 = k0}); }
  int unary(FunctionOp op, int a, double k0 = 0, double k1 = 0) {
    return add({.op = op, .a = a, .b = a, .k0 = k0, .k1 = k1});
  }

  int emit(const Plane& p, int x, int y) {
    if (p.slope_x == 0 && p.slope_y == 0) return constant(p.height);
    return combine(p.slope_x, x, p.slope_y, y, p.height);
  }
  int emit(const Sines& s, int x, int y) {
    int sum = -1;
    for (const Sine& wave : s.waves) {
      const double k = 2 * std::numbers::pi / wave.wavelength;
      const int angle = combine(k * std::cos(wave.towards), x, k * std::sin(wave.towards), y, wave.phase);
      const int sine = unary(FunctionOp::sine, angle);
      sum = sum < 0 ? scale(wave.amplitude, sine) : combine(1, sum, wave.amplitude, sine, 0);
    }
    return sum;
  }
  int octaves_of(const Octaves& octaves) const {
    return use_ == FunctionUse::march ? octaves.march : use_ == FunctionUse::shadow ? octaves.shadow : octaves.normal;
  }
  int emit(const Fractal& f, int x, int y) {
    // Offset from the lattice: otherwise every octave of gradient noise would be zero at (0, 0).
    constexpr double kOffX = 0.3125, kOffY = 0.6875;
    const double c = f.lacunarity * f.turn.x, s = f.lacunarity * f.turn.y;
    int u = scale(1 / f.wavelength, x, kOffX), v = scale(1 / f.wavelength, y, kOffY);
    int sum = -1, slope_x = -1, slope_y = -1, weight = -1;
    double height = f.height;
    const int octaves = octaves_of(f.octaves);
    for (int octave = 0; octave < octaves; ++octave, height *= f.gain) {
      if (octave > 0) {
        u = add({.op = FunctionOp::turn, .a = u, .b = v, .k0 = c, .k1 = s});
        v = u + 1;
      }
      const bool damped = f.damping > 0;
      int n = add({.op = damped ? FunctionOp::noise_slope : FunctionOp::noise,
                   .a = u,
                   .b = v,
                   .kind = f.noise,
                   .seed = octave_seed(f.seed, static_cast<std::uint32_t>(octave))});
      int shown = n;
      if (f.form == FractalForm::ridged) {
        const int fold = unary(FunctionOp::clamp, scale(-1, unary(FunctionOp::absolute, n), 1), 0, 1);
        shown = unary(FunctionOp::square, fold);
        if (weight >= 0) shown = binary(FunctionOp::multiply, shown, weight);
        if (octave + 1 < octaves) weight = unary(FunctionOp::clamp, scale(f.focus, shown), 0, 1);
      }
      if (damped) {
        slope_x = slope_x < 0 ? n + 1 : combine(1, slope_x, 1, n + 1, 0);
        slope_y = slope_y < 0 ? n + 2 : combine(1, slope_y, 1, n + 2, 0);
        const int damp =
            combine(f.damping, unary(FunctionOp::square, slope_x), f.damping, unary(FunctionOp::square, slope_y), 1);
        shown = binary(FunctionOp::multiply, shown, unary(FunctionOp::reciprocal, damp));
      }
      sum = sum < 0 ? scale(height, shown) : combine(1, sum, height, shown, 0);
    }
    return sum;
  }
  int emit(const Warp& w, int x, int y) {
    const int shift_x = value_of(w.shift_x, x, y), shift_y = value_of(w.shift_y, x, y);
    return value_of(w.base, combine(1, x, 1, shift_x, 0), combine(1, y, 1, shift_y, 0));
  }
  int emit(const Terraces& t, int x, int y) {
    return unary(FunctionOp::terrace, value_of(t.base, x, y), t.step, t.rise);
  }
  int emit(const RadialMask& m, int x, int y) {
    return add(
        {.op = FunctionOp::radial, .a = x, .b = y, .k0 = m.centre.x, .k1 = m.centre.y, .k2 = m.inner, .k3 = m.outer});
  }
  int emit(const Sum& s, int x, int y) {
    const int a = value_of(s.a, x, y);
    return combine(s.factor_a, a, s.factor_b, value_of(s.b, x, y), s.offset);
  }
  int emit(const Product& p, int x, int y) {
    const int a = value_of(p.a, x, y);
    return binary(FunctionOp::multiply, a, value_of(p.b, x, y));
  }
  int emit(const Minimum& m, int x, int y) {
    const int a = value_of(m.a, x, y);
    return binary(FunctionOp::minimum, a, value_of(m.b, x, y));
  }
  int emit(const Maximum& m, int x, int y) {
    const int a = value_of(m.a, x, y);
    return binary(FunctionOp::maximum, a, value_of(m.b, x, y));
  }
  int emit(const SmoothMinimum& m, int x, int y) {
    const int a = value_of(m.a, x, y);
    return binary(FunctionOp::smooth_minimum, a, value_of(m.b, x, y), m.radius);
  }

  FunctionUse use_;
  std::vector<Step> steps_;
  int values_ = 2;  // x and y
  std::map<std::tuple<const FunctionNode*, int, int>, int> known_;
};

}  // namespace

FunctionProgram compile(const Function& function, FunctionUse use) {
  if (!function) throw Error("terrain function is missing (make one with make_function())");
  Compiler compiler(use);
  const int result = compiler.value_of(function, 0, 1);
  return compiler.with_registers(result);
}

}  // namespace scarp
