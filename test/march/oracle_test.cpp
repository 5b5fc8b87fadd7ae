// SPDX-License-Identifier: MIT
// Every march of the table against the exhaustive one, on spiteful fields and rays.
//
// Two correct programs may round differently. What they may differ in is bounded: a ray moved by the rounding of its
// own coordinates (numerics.md: delta) is as good as the ray itself. So an exact march must agree with the judge, or,
// where it does not, pass no hit that the ray and all its neighbours within delta have for certain, and a hit of its
// own must lie on the surface and not on the way out of the ground. How often neighbours had to be asked is counted, so
// that this cannot become a way out.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

#include "march/spiteful.h"
#include "scarp/march/exhaustive.h"
#include "scarp/march/max_mip.h"
#include "scarp/scene/ray_dump.h"

namespace scarp::test {
namespace {

// 10^5 rays per pair where the build is optimised; a tenth under the sanitizers, which are ten times slower.
#ifdef NDEBUG
constexpr int kRaysPerPair = 100'000;
#else
constexpr int kRaysPerPair = 5'000;
#endif
constexpr int kRaysPerField = 250;

// Unit roundoff, and the number of roundings that numerics.md counts on the way from a world coordinate to a sign.
constexpr double kUnit = 0x1p-53;
constexpr double kRoundings = 32;
constexpr int kNeighbours = 256;

std::string text(const Ray& ray) {
  return fmt::format("origin ({:a}, {:a}, {:a}) direction ({:a}, {:a}, {:a}) t [{:a}, {:a}] {} cell ({}, {})",
                     ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z,
                     ray.t_min, ray.t_max, ray.start == RayStart::free ? "free" : "on surface", ray.start_cell.col,
                     ray.start_cell.row);
}

std::string text(const Hit& hit) {
  static constexpr const char* kNames[] = {"miss", "hit", "below", "exhausted"};
  return fmt::format("{} t={:a} cell ({}, {}) u={} v={}", kNames[static_cast<int>(hit.status)], hit.t, hit.cell.col,
                     hit.cell.row, hit.u, hit.v);
}

// Writes a ray on which a march failed, for `scarp replay`; returns the file.
std::string dumped(const HeightField& field, const Ray& ray, const Hit& judge, const Hit& march) {
  static int count = 0;
  const std::string path = fmt::format("{}march-oracle-{}-{}.txt", testing::TempDir(), ::getpid(), ++count);
  write_ray_dumps(path, std::vector{RayDump{field, {}, ray, text(judge), text(march)}});
  return path;
}

class Judge {
 public:
  Judge(const HeightField& field, const Ray& ray) : field_(field), ray_(ray) {
    // A power of two keeps the judge's squares finite and changes no bit of its answer.
    const double longest = std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
    exponent_ = std::ilogb(longest);
    for (int axis = 0; axis < 3; ++axis) ray_.direction[axis] = std::ldexp(ray.direction[axis], -exponent_);
    ray_.t_min = std::ldexp(ray.t_min, exponent_);
    ray_.t_max = std::ldexp(ray.t_max, exponent_);
    nominal_ = march_exhaustive({&field, nullptr}, ray_);
  }

  const Hit& nominal() const { return nominal_; }
  bool asked_neighbours() const { return asked_; }

  bool accepts(const Hit& hit) {
    if (hit.status == HitStatus::hit && !is_in_its_cell(hit)) return false;
    const double t = std::ldexp(hit.t, exponent_);
    const double slack = kRoundings * kUnit * (std::abs(t) + span() / length(ray_.direction));
    if (hit.status == nominal_.status && (hit.status != HitStatus::hit || std::abs(t - nominal_.t) <= slack))
      return true;
    asked_ = true;
    // A hit has to be on the surface, and not on the way out of the ground...
    const double reached = hit ? t : HUGE_VAL;
    if (hit && !(is_on_surface(hit, t) && (begins_at(t) || side_before(t) >= 0))) return false;
    // ... and no answer may pass a hit that the ray and all of its neighbours have for certain.
    Random random(1);
    if (reached <= first_certain_hit(ray_, reached) + slack) return true;
    for (int i = 0; i < kNeighbours; ++i) {
      if (reached <= first_certain_hit(neighbour(random), reached) + slack) return true;
    }
    return false;
  }

 private:
  // Coordinates up to which the ray is computed, in metres.
  double span() const {
    const double far = std::max({std::abs(ray_.origin.x), std::abs(ray_.origin.y), std::abs(ray_.origin.z)});
    return far + field_.width() + field_.depth() + std::abs(field_.min_height()) + std::abs(field_.max_height()) +
           std::abs(field_.settings().offset);
  }

  double delta() const { return kRoundings * kUnit * span(); }

  // The ray moved by up to delta.
  Ray neighbour(Random& random) const {
    Ray ray = ray_;
    // All magnitudes alike: a ray that grazes a corner of the field asks for shifts of unlike size.
    const auto shift = [&] { return std::ldexp(uniform(random, -1, 1) * delta(), -whole(random, 0, 6)); };
    if (ray.start == RayStart::free) {
      for (int axis = 0; axis < 3; ++axis) ray.origin[axis] += shift();
    } else {
      // The start is on the surface by definition; the direction is what rounding moves.
      const double extent = std::max(field_.settings().cell_x, field_.settings().cell_y);
      for (int axis = 0; axis < 3; ++axis) ray.direction[axis] += shift() / extent;
    }
    return ray;
  }

  // Vertical effect of delta in a cell, metres.
  double rounding(const CellHeights& h) const {
    const HeightFieldSettings& to = field_.settings();
    const double relief =
        (std::max({h.h00, h.h10, h.h01, h.h11}) - std::min({h.h00, h.h10, h.h01, h.h11})) * to.scale * to.exaggeration;
    return delta() * (1 + relief / to.cell_x + relief / to.cell_y);
  }

  bool is_on_surface(const Hit& hit, double t) const {
    const CellHeights h = field_.cell_heights(hit.cell).value();
    const double u = hit.u, v = hit.v;
    const double surface =
        field_.height_from_sample((h.h00 * (1 - u) + h.h10 * u) * (1 - v) + (h.h01 * (1 - u) + h.h11 * u) * v);
    return std::abs(ray_.at(t).z - surface) <= rounding(h);
  }

  // Where a ray first comes down through the surface from visibly above it. A rise by no more than rounding is none.
  double first_certain_hit(Ray ray, double enough) const {
    for (;;) {
      const Hit hit = march_exhaustive({&field_, nullptr}, ray);
      if (!hit) return HUGE_VAL;
      if (begins_at(hit.t) || side_before(hit.t) > 0)
        return hit.t < enough && std::isfinite(enough) && skims(hit.t, enough) ? enough : hit.t;
      ray.t_min = hit.t + (hit.t - just_before(hit.t));
    }
  }

  // Whether the ray stays within rounding of the surface from one t to another.
  bool skims(double from, double to) const {
    constexpr int kProbes = 8;
    for (int i = 0; i <= kProbes; ++i) {
      const dvec3 p = ray_.at(from + (to - from) * i / kProbes);
      const auto place = field_.place(p.x, p.y);
      if (!place) continue;
      const auto h = field_.cell_heights(place->cell);
      if (h && std::abs(p.z - field_.height(p.x, p.y).value()) > 2 * rounding(*h)) return false;
    }
    return true;
  }

  // Just before t: a millionth of a cell, far beyond rounding, far below anything that the surface does.
  double just_before(double t) const {
    return t - 0x1p-20 * std::min(field_.settings().cell_x, field_.settings().cell_y) / length(ray_.direction);
  }

  // Whether the ray comes into being at t: at its start, over the border, out of a hole (that may be touched at a
  // corner only). A touch there is a hit, and one that a shift of any size turns into something else.
  bool begins_at(double t) const {
    if (just_before(t) < ray_.t_min) return true;
    const dvec3 before = ray_.at(just_before(t)), p = ray_.at(t);
    const double dx = 0x1p-20 * field_.settings().cell_x, dy = 0x1p-20 * field_.settings().cell_y;
    for (const dvec2 q : {dvec2(before.x, before.y), dvec2(p.x - dx, p.y - dy), dvec2(p.x + dx, p.y - dy),
                          dvec2(p.x - dx, p.y + dy), dvec2(p.x + dx, p.y + dy)}) {
      if (!field_.height(q.x, q.y)) return true;
    }
    return false;
  }

  // On which side the ray was before t, as soon as it can be told from rounding: 1 above, -1 below (then t is a way out
  // of the ground and no hit), 0 it cannot be told.
  int side_before(double t) const {
    for (double cells = 0x1p-20; cells < 1; cells *= 4) {
      const dvec3 p = ray_.at(t - cells * (t - just_before(t)) * 0x1p20);
      const auto place = field_.place(p.x, p.y);
      const auto h = place ? field_.cell_heights(place->cell) : std::nullopt;
      if (!h) return 0;
      const double clearance = p.z - field_.height(p.x, p.y).value();
      if (std::abs(clearance) > 2 * rounding(*h)) return clearance > 0 ? 1 : -1;
    }
    return 0;
  }

  bool is_in_its_cell(const Hit& hit) const {
    return hit.cell.col >= 0 && hit.cell.col < field_.cell_cols() && hit.cell.row >= 0 &&
           hit.cell.row < field_.cell_rows() && hit.u >= 0 && hit.u <= 1 && hit.v >= 0 && hit.v <= 1 &&
           field_.cell_heights(hit.cell).has_value();
  }

  const HeightField& field_;
  Ray ray_;
  int exponent_;
  Hit nominal_;
  bool asked_ = false;
};

using Pair = std::tuple<int, int>;

class Oracle : public testing::TestWithParam<Pair> {};

TEST_P(Oracle, ExactMarchesAgreeWithTheJudge) {
  const FieldKind& fields = spiteful_fields()[static_cast<std::size_t>(std::get<0>(GetParam()))];
  const RayKind& rays = spiteful_rays()[static_cast<std::size_t>(std::get<1>(GetParam()))];
  Random random(static_cast<std::uint64_t>(1000 * std::get<0>(GetParam()) + std::get<1>(GetParam())));
  int asked = 0, hits = 0, bad = 0;
  for (int done = 0; done < kRaysPerPair && bad < 5;) {
    const HeightField field = fields.make(random);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid};
    for (int i = 0; i < kRaysPerField && bad < 5; ++i, ++done) {
      const Ray ray = rays.make(field, random);
      Judge judge(field, ray);
      hits += judge.nominal().status == HitStatus::hit;
      for (const MarchEntry& march : marches()) {
        if (march.cpu == march_exhaustive) continue;
        const Hit hit = march.cpu(target, ray, {}, nullptr);
        if (hit) {
          EXPECT_GE(hit.t, ray.t_min) << march.name << ": " << text(ray);
          EXPECT_LE(hit.t, ray.t_max) << march.name << ": " << text(ray);
        }
        if (march.guarantee == Guarantee::exact && !judge.accepts(hit)) {
          ++bad;
          ADD_FAILURE() << march.name << " on " << fields.name << ", ray " << rays.name << ": " << text(ray)
                        << "\n  judge " << text(judge.nominal()) << "\n  march " << text(hit) << "\n  scarp replay "
                        << dumped(field, ray, judge.nominal(), hit);
        }
      }
      const bool occluded = occluded_max_mip(target, ray);
      if (occluded != (march_max_mip(target, ray).status == HitStatus::hit)) {
        ++bad;
        ADD_FAILURE() << "any-hit contradicts closest-hit: " << text(ray);
      }
      asked += judge.asked_neighbours();
    }
  }
  RecordProperty("hits", hits);
  RecordProperty("asked_neighbours", asked);
  // Rays that were not aimed at anything meet a rounding tie once in a blue moon.
  if (rays.name == "random" || rays.name == "from above") {
    EXPECT_LE(asked, kRaysPerPair / 1000);
  }
}

std::string name_of_pair(const testing::TestParamInfo<Pair>& info) {
  std::string name = fmt::format("{}__{}", spiteful_fields()[static_cast<std::size_t>(std::get<0>(info.param))].name,
                                 spiteful_rays()[static_cast<std::size_t>(std::get<1>(info.param))].name);
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Spiteful, Oracle,
                         testing::Combine(testing::Range(0, static_cast<int>(spiteful_fields().size())),
                                          testing::Range(0, static_cast<int>(spiteful_rays().size()))),
                         name_of_pair);

}  // namespace
}  // namespace scarp::test
