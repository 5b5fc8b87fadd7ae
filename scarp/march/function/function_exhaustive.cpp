// SPDX-License-Identifier: MIT
#include "scarp/march/function/function_exhaustive.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scarp/march/function/function_interval.h"

namespace scarp {
namespace {

using namespace judge;

double fade(double t) { return t * t * t * (10 + t * (-15 + 6 * t)); }
// The fade is monotone: its range is that of its ends, computed with fewer than 8 roundings of numbers below 32.
Interval fade(const Interval& t) {
  constexpr double kSlack = 0x1p-45;
  return {std::max(0.0, fade(std::clamp(t.lower(), 0.0, 1.0)) - kSlack),
          std::min(1.0, fade(std::clamp(t.upper(), 0.0, 1.0)) + kSlack)};
}
// a at t = 0, b at t = 1: monotone in each of a and b while t is in [0, 1].
Interval blend(const Interval& a, const Interval& b, const Interval& t) {
  const Interval from(t.lower()), to(t.upper()), one(1.0);
  return hull((one - from) * a + from * b, (one - to) * a + to * b);
}
Interval direction_dot(std::uint32_t hash, const Interval& dx, const Interval& dy) {
  const double* g = lattice_direction(hash);
  return g[0] * dx + g[1] * dy;
}

Interval square_noise(NoiseKind kind, std::uint32_t seed, const Interval& x, const Interval& y) {
  const double i0 = std::floor(x.lower()), i1 = std::floor(x.upper());
  const double j0 = std::floor(y.lower()), j1 = std::floor(y.upper());
  const Interval anything(-bound_of(kind).height, bound_of(kind).height);
  if (i1 - i0 > 1 || j1 - j0 > 1) return anything;
  Interval range = Interval::empty();
  for (double j = j0; j <= j1; ++j) {
    for (double i = i0; i <= i1; ++i) {
      const Interval dx = intersect(x - i, Interval(0, 1)), dy = intersect(y - j, Interval(0, 1));
      const Interval u = fade(dx), v = fade(dy);
      Interval corner[4];
      for (int c = 0; c < 4; ++c) {
        const std::uint32_t hash =
            lattice_hash(seed, static_cast<std::int64_t>(i) + c % 2, static_cast<std::int64_t>(j) + c / 2);
        corner[c] = kind == NoiseKind::value
                        ? Interval(lattice_value(hash))
                        : kPerlinScale * direction_dot(hash, dx - double(c % 2), dy - double(c / 2));
      }
      range = hull(range, blend(blend(corner[0], corner[1], u), blend(corner[2], corner[3], u), v));
    }
  }
  return intersect(range, anything);
}

// Every corner whose disc the box may touch adds its part; the two triangles of a square share corners.
Interval simplex_noise(std::uint32_t seed, const Interval& x, const Interval& y) {
  const Interval root = sqrt(Interval(3.0)), skew = (root - 1.0) / 2.0, unskew = (3.0 - root) / 6.0;
  const Interval s = (x + y) * skew;
  const double i0 = std::floor((x + s).lower()), i1 = std::floor((x + s).upper()) + 1;
  const double j0 = std::floor((y + s).lower()), j1 = std::floor((y + s).upper()) + 1;
  const double most = bound_of(NoiseKind::simplex).height;
  if (i1 - i0 > 3 || j1 - j0 > 3) return {-most, most};
  Interval sum(0.0);
  for (double j = j0; j <= j1; ++j) {
    for (double i = i0; i <= i1; ++i) {
      const Interval t = (i + j) * unskew;
      const Interval dx = x - (i - t), dy = y - (j - t);
      const Interval m = max(Interval(0.0), 0.5 - square(dx) - square(dy));
      if (m.upper() == 0) continue;
      const std::uint32_t hash = lattice_hash(seed, static_cast<std::int64_t>(i), static_cast<std::int64_t>(j));
      sum += square(square(m)) * kSimplexScale * direction_dot(hash, dx, dy);
    }
  }
  return intersect(sum, Interval(-most, most));
}

Interval noise_over(NoiseKind kind, std::uint32_t seed, const Interval& x, const Interval& y) {
  return kind == NoiseKind::simplex ? simplex_noise(seed, x, y) : square_noise(kind, seed, x, y);
}

// Only damping needs the gradient: the gradient at the middle, widened by the curvature bound.
struct NoiseSlope {
  Interval x, y;
};
NoiseSlope noise_slope_over(NoiseKind kind, std::uint32_t seed, const Interval& x, const Interval& y) {
  const NoiseBound bound = bound_of(kind);
  const double mx = median(x), my = median(y);
  const NoiseJet jet = noise_jet(kind, seed, mx, my);
  const double away = bound.curvature * (width(x) + width(y)) + noise_rounding(kind, mx, my);
  const Interval all(-bound.slope, bound.slope);
  return {intersect(Interval(jet.x - away, jet.x + away), all), intersect(Interval(jet.y - away, jet.y + away), all)};
}

Interval sine_of(const Interval& a) {
  const double half = std::numbers::pi / 2;
  if (width(a) >= 4 * half) return {-1, 1};
  const double low = std::sin(a.lower()), high = std::sin(a.upper());
  constexpr double kSlack = 0x1p-50;
  Interval range(std::min(low, high) - kSlack, std::max(low, high) + kSlack);
  // An extreme at (4 n + 1) or (4 n + 3) quarter turns, searched slightly beyond both ends.
  const double margin = 0x1p-40 * (1 + std::abs(a.lower()) + std::abs(a.upper()));
  const auto within = [&](double quarter) {
    const double turns = (a.lower() - margin) / (4 * half) - quarter / 4;
    return (std::ceil(turns) + quarter / 4) * 4 * half <= a.upper() + margin;
  };
  if (within(1)) range = hull(range, Interval(1.0));
  if (within(3)) range = hull(range, Interval(-1.0));
  return intersect(range, Interval(-1, 1));
}

class Evaluation {
 public:
  Evaluation(FunctionUse use, const Interval& t) : use_(use), t_(t) {}

  Interval of(const Function& function, const Position& x, const Position& y) const {
    return std::visit([&](const auto& shape) { return value(shape, x, y); }, function->shape);
  }

 private:
  Interval value(const Plane& p, const Position& x, const Position& y) const {
    return (Interval(p.slope_x) * x + Interval(p.slope_y) * y).over(t_) + p.height;
  }
  Interval value(const Sines& s, const Position& x, const Position& y) const {
    Interval sum(0.0);
    for (const Sine& wave : s.waves) {
      const double k = 2 * std::numbers::pi / wave.wavelength;
      const Position angle = Interval(k * std::cos(wave.towards)) * x + Interval(k * std::sin(wave.towards)) * y;
      sum += wave.amplitude * sine_of(angle.over(t_) + wave.phase);
    }
    return sum;
  }
  Interval value(const Fractal& f, const Position& x, const Position& y) const {
    const int octaves = use_ == FunctionUse::march    ? f.octaves.march
                        : use_ == FunctionUse::shadow ? f.octaves.shadow
                                                      : f.octaves.normal;
    const Interval c(f.lacunarity * f.turn.x), s(f.lacunarity * f.turn.y), one(1.0), zero(0.0);
    Position u = Interval(1 / f.wavelength) * x, v = Interval(1 / f.wavelength) * y;
    u.base += 0.3125, v.base += 0.6875;
    Interval sum(0.0), slope_x(0.0), slope_y(0.0), weight(1.0);
    double height = f.height;
    for (int octave = 0; octave < octaves; ++octave, height *= f.gain) {
      const std::uint32_t seed = octave_seed(f.seed, static_cast<std::uint32_t>(octave));
      const Interval at_x = u.over(t_), at_y = v.over(t_);
      Interval shown = noise_over(f.noise, seed, at_x, at_y);
      if (f.form == FractalForm::ridged) {
        shown = square(max(zero, one - abs(shown))) * weight;
        weight = min(one, f.focus * shown);
      }
      if (f.damping > 0) {
        const NoiseSlope slope = noise_slope_over(f.noise, seed, at_x, at_y);
        slope_x += slope.x, slope_y += slope.y;
        shown /= one + f.damping * (square(slope_x) + square(slope_y));
      }
      sum += height * shown;
      const Position turned = c * u + (-s) * v;
      v = s * u + c * v;
      u = turned;
    }
    return sum;
  }
  Interval value(const Warp& w, const Position& x, const Position& y) const {
    Position warped_x = x, warped_y = y;
    warped_x.more += of(w.shift_x, x, y);
    warped_y.more += of(w.shift_y, x, y);
    return of(w.base, warped_x, warped_y);
  }
  Interval value(const Terraces& t, const Position& x, const Position& y) const {
    const Interval base = of(t.base, x, y);
    return hull(terrace(t, Interval(base.lower())), terrace(t, Interval(base.upper())));
  }
  static Interval terrace(const Terraces& t, const Interval& h) {
    const Interval steps = h / t.step;
    const double from = std::floor(steps.lower());
    if (std::floor(steps.upper()) != from) return Interval(from + 1) * t.step + Interval(-0x1p-40, 0x1p-40) * t.step;
    return t.step * (from + fade((steps - from - (1.0 - Interval(t.rise))) / t.rise));
  }
  Interval value(const RadialMask& m, const Position& x, const Position& y) const {
    const Interval away = sqrt(square(x.over(t_) - m.centre.x) + square(y.over(t_) - m.centre.y));
    return fade((Interval(m.outer) - away) / (Interval(m.outer) - m.inner));
  }
  Interval value(const Sum& s, const Position& x, const Position& y) const {
    return s.factor_a * of(s.a, x, y) + s.factor_b * of(s.b, x, y) + s.offset;
  }
  Interval value(const Product& p, const Position& x, const Position& y) const { return of(p.a, x, y) * of(p.b, x, y); }
  Interval value(const Minimum& m, const Position& x, const Position& y) const {
    return min(of(m.a, x, y), of(m.b, x, y));
  }
  Interval value(const Maximum& m, const Position& x, const Position& y) const {
    return max(of(m.a, x, y), of(m.b, x, y));
  }
  Interval value(const SmoothMinimum& m, const Position& x, const Position& y) const {
    // Monotone in both operands.
    const Interval a = of(m.a, x, y), b = of(m.b, x, y);
    return hull(smooth(a.lower(), b.lower(), m.radius), smooth(a.upper(), b.upper(), m.radius));
  }
  static Interval smooth(double a, double b, double radius) {
    const Interval share = max(Interval(0.0), min(Interval(1.0), 0.5 + 0.5 * (Interval(b) - a) / radius));
    return b + share * (Interval(a) - b) - radius * share * (1.0 - share);
  }

  FunctionUse use_;
  Interval t_;
};

}  // namespace

Interval judge::height_over(const Function& function, FunctionUse use, const Position& x, const Position& y,
                            const Interval& t) {
  return Evaluation(use, t).of(function, x, y);
}

FunctionJudgement judge_function(const Function& function, const Ray& ray, FunctionUse use, int most_evaluations) {
  double t_enter = ray.t_min, t_exit = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) continue;
    const double a = (-kMostMetres - o) / d, b = (kMostMetres - o) / d;
    t_enter = std::max(t_enter, std::min(a, b));
    t_exit = std::min(t_exit, std::max(a, b));
  }
  const auto position = [&](int axis) {
    return Position{Interval(ray.origin[axis]), Interval(ray.direction[axis]), Interval(0.0)};
  };
  const Position x = position(0), y = position(1), z = position(2);
  const auto above = [&](const Interval& t) { return z.over(t) - Evaluation(use, t).of(function, x, y); };

  return first_crossing(t_enter, t_exit, ray.t_max, most_evaluations, above);
}

}  // namespace scarp
