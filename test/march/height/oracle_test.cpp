// SPDX-License-Identifier: MIT
// Every march of the table against the exhaustive one, on spiteful fields and rays.
//
// Two correct programs may round differently, but the difference is bounded: a ray moved by the rounding of its own
// coordinates (numerics.md: delta) is as good as the ray itself. An exact march must therefore agree with the oracle.
// If it does not, it must pass no hit that the ray and all its neighbours within delta certainly have, and its own hit
// must be on the surface and not on the way out of the ground. The use of neighbours is counted, so that it cannot
// become a loophole.
//
// Lists of all hits are judged alike: equal lists are right; where they differ, each hit must be at a possible
// position, and between one hit and the next the march may pass no hit that all neighbours have. The lists may thus
// differ in touches, and in whether a touch counts as passing through twice.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

#include "cases.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/queries.h"
#include "scarp/march/height/rounding.h"
#include "scarp/scene/file/ray_dump.h"

namespace scarp::test {
namespace {

// Eight fields per pair under the sanitizers, which check memory accesses; these repeat with each ray.
const int kRaysPerPair = cases(100'000, 10'000, 700);
constexpr int kRaysPerField = 250;
// For marches without a guarantee, hits must only be in the ray's range.
constexpr int kRaysPerApproximation = 20;

// Unit roundoff, and the number of roundings that numerics.md counts on the way from a world coordinate to a sign.
constexpr double kUnit = 0x1p-53;
constexpr double kRoundings = 32;
constexpr int kNeighbours = 256;

using test::text;

std::string text(const std::vector<Hit>& hits) {
  std::string all;
  for (const Hit& hit : hits) all += "\n    " + text(hit);
  return all;
}

bool same(const Hit& a, const Hit& b) {
  return a.status == b.status && a.t == b.t && a.cell == b.cell && a.u == b.u && a.v == b.v && a.height == b.height &&
         a.wall == b.wall;
}

// Writes a ray on which a march failed, for `scarp replay`; returns the file.
std::string dumped(const HeightField& field, const Ray& ray, const std::string& judge, const std::string& march) {
  static int count = 0;
  const std::string path = fmt::format("{}march-oracle-{}-{}.txt", testing::TempDir(), ::getpid(), ++count);
  write_ray_dumps(path, std::vector{RayDump{field, {}, ray, judge, march}});
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
    // The closest hit is the first of all hits: each is queried once.
    const HitStatus status = all_hits_exhaustive({&field, nullptr}, ray_, expected_);
    if (!expected_.empty()) nominal_ = expected_.front();
    nominal_.status = status;
  }

  const Hit& nominal() const { return nominal_; }
  bool asked_neighbours() const { return asked_; }

  bool accepts(const Hit& hit) {
    const double t = std::ldexp(hit.t, exponent_);
    if (hit && !is_somewhere(hit, t)) return false;
    if (agree(hit, nominal_)) return true;
    asked_ = true;
    if (!hit) return ends_without(hit.status);
    return may_be_hit(hit, t) && passes_nothing(ray_, t);
  }

  std::vector<Hit> all() const {
    std::vector<Hit> hits = expected_;
    for (Hit& hit : hits) hit.t = std::ldexp(hit.t, -exponent_);
    return hits;
  }

  bool accepts_all(const std::vector<Hit>& hits, HitStatus status) {
    if ((status == HitStatus::hit) == hits.empty()) return false;
    bool agreed = hits.size() == expected_.size() && (!hits.empty() || status == nominal_.status);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (!is_somewhere(hits[i], std::ldexp(hits[i].t, exponent_))) return false;
      if (i > 0 && hits[i].t < hits[i - 1].t) return false;
      agreed = agreed && agree(hits[i], expected_[i]);
    }
    if (agreed) return true;
    asked_ = true;
    Ray rest = ray_;
    for (const Hit& hit : hits) {
      const double t = std::ldexp(hit.t, exponent_);
      if (!(may_be_hit(hit, t) && passes_nothing(rest, t))) return false;
      rest.t_min = t + (t - just_before(t));
      rest.start = RayStart::free;
    }
    return rest.t_min > rest.t_max || passes_nothing(rest, HUGE_VAL);
  }

 private:
  double slack(double t) const { return kRoundings * kUnit * (std::abs(t) + span() / length(ray_.direction)); }

  // `expected` is the judge's hit, scaled.
  bool agree(const Hit& hit, const Hit& expected) const {
    if (hit.status != expected.status || hit.wall != expected.wall) return false;
    const double t = std::ldexp(hit.t, exponent_);
    return hit.status != HitStatus::hit || std::abs(t - expected.t) <= slack(t);
  }

  // The hit is in a cell, and there on the surface or on a wall.
  bool is_somewhere(const Hit& hit, double t) const {
    return is_in_its_cell(hit) && (hit.wall ? is_on_wall(hit, t) : is_on_surface(hit, t));
  }

  // Not visibly on the way out of the ground, or where a neighbour has such a hit, too; walls there only.
  bool may_be_hit(const Hit& hit, double t) const {
    if (!hit.wall && (begins_at(t) || side_before(t, ray_.t_min) >= 0)) return true;
    Random random(2);
    Ray ray = ray_;
    for (int i = 0; i < kNeighbours; ++i, ray = neighbour(ray_, random)) {
      std::vector<Hit> hits;
      all_hits_exhaustive({&field_, nullptr}, ray, hits);
      for (const Hit& other : hits) {
        if (other.wall == hit.wall && std::abs(other.t - t) <= t - just_before(t)) return true;
      }
    }
    return false;
  }

  // Whether a march whose first reported hit is at `reached` passes no hit that the ray and its neighbours certainly
  // have.
  bool passes_nothing(Ray ray, double reached) const {
    const double latest = reached - slack(std::isfinite(reached) ? reached : 0);
    for (;;) {
      const double certain = first_certain_hit(ray, reached);
      if (latest <= certain) return true;
      const auto some_neighbour = [&](const Ray& part, double without) {
        Random random(1);
        for (int i = 0; i < kNeighbours; ++i) {
          if (without <= first_certain_hit(neighbour(part, random), without)) return true;
        }
        return false;
      };
      if (some_neighbour(ray, latest)) return true;
      // Between two corners of rims, on either side, no moved ray can pass; past each of them alone, one can.
      const double step = 4 * (certain - just_before(certain));
      if (!is_at_rim(ray_.at(certain))) return false;
      // Where two cells touch at a corner between two holes, the corner belongs to the ground: a ray that passes
      // exactly there does not leave it (conventions.md), though every moved ray does.
      if (is_pinch(ray_.at(certain))) {
        ray.t_min = certain + step;
        ray.start = RayStart::free;
        if (!(ray.t_min < ray.t_max)) return true;
        continue;
      }
      Ray part = ray;
      if (certain - step > ray.t_min) part.t_min = certain - step, part.start = RayStart::free;
      part.t_max = std::min(ray.t_max, certain + step);
      if (!some_neighbour(part, HUGE_VAL)) return false;
      if (!(certain + step < ray.t_max)) return true;
      ray.t_min = certain + step;
      ray.start = RayStart::free;
    }
  }

  // The same for a march that reports no hit. The status is `below` only if the ray visibly enters below the ground.
  bool ends_without(HitStatus status) const {
    if (!passes_nothing(ray_, HUGE_VAL)) return false;
    const int side = ray_.start == RayStart::on_surface ? 1 : side_at_entry();
    return side == 0 || (side < 0) == (status == HitStatus::below);
  }

  // A bound on the coordinates in the ray's computation, in metres.
  double span() const {
    double far = std::max({std::abs(ray_.origin.x), std::abs(ray_.origin.y), std::abs(ray_.origin.z)});
    // A ray over copies of the field does not end at a border.
    if (field_.wraps()) far += std::max(std::abs(ray_.t_min), std::abs(ray_.t_max)) * length(ray_.direction);
    return far + field_.width() + field_.depth() + std::abs(field_.min_height()) + std::abs(field_.max_height()) +
           std::abs(field_.settings().offset);
  }

  double delta() const { return kRoundings * kUnit * span(); }

  // The ray moved by up to delta.
  Ray neighbour(Ray ray, Random& random) const {
    // Magnitudes differ: a ray that grazes a corner of the field needs shifts of unequal size.
    const auto shift = [&] { return std::ldexp(uniform(random, -1, 1) * delta(), -whole(random, 0, 6)); };
    if (ray.start == RayStart::free) {
      for (int axis = 0; axis < 3; ++axis) ray.origin[axis] += shift();
    } else {
      // The start is on the surface by definition; rounding moves its position on it, and the direction.
      for (int axis = 0; axis < 2; ++axis) ray.origin[axis] += shift();
      const double extent = std::max(field_.settings().cell_x, field_.settings().cell_y);
      for (int axis = 0; axis < 3; ++axis) ray.direction[axis] += shift() / extent;
    }
    return ray;
  }

  // Vertical effect of delta in a cell, metres.
  double rounding(const CellHeights& h) const {
    return rounding(std::max({h.h00, h.h10, h.h01, h.h11}) - std::min({h.h00, h.h10, h.h01, h.h11}));
  }
  double rounding(double samples) const {
    const HeightFieldSettings& to = field_.settings();
    const double relief = samples * to.scale * to.exaggeration;
    return delta() * (1 + relief / to.cell_x + relief / to.cell_y);
  }

  // Height of the ray above the surface of the hit's cell.
  double clearance(const CellHeights& h, const Hit& hit, double t) const {
    return ray_.at(t).z - field_.height_from_sample(height_in_cell(field_.settings().surface, h, hit.u, hit.v));
  }
  bool is_on_surface(const Hit& hit, double t) const {
    const CellHeights h = field_.cell_heights(hit.cell).value();
    const double off = std::abs(clearance(h, hit, t));
    return off <= rounding(h) || (is_at_rim(ray_.at(t)) && off <= 2 * at_rim(h, t));
  }
  // Distance in metres that a march may treat as a touch where the ray crosses a rim (numerics.md), for the line that
  // it crosses.
  double at_rim(const CellHeights& h, double t) const {
    const double relief = std::max({h.h00, h.h10, h.h01, h.h11}) - std::min({h.h00, h.h10, h.h01, h.h11});
    const GridRay local = field_.grid_from_world(ray_);
    double most = 0;
    for (const int axis : {0, 1}) {
      if (local.direction[axis] == 0) continue;
      const double place = local.origin[axis] + local.direction[axis] * t;
      if (std::abs(place - std::round(place)) <= 0x1p-20)
        most = std::max(most, rounding_at_hole(field_, local, t, relief, axis, 0));
    }
    return most * field_.settings().scale * field_.settings().exaggeration;
  }
  // At the border or a hole's rim, below the edge of the surface.
  bool is_on_wall(const Hit& hit, double t) const {
    const CellHeights h = field_.cell_heights(hit.cell).value();
    return field_.settings().solid && begins_at(t) && clearance(h, hit, t) <= rounding(h);
  }

  // Where a ray first descends through the surface from visibly above it. A rise within rounding does not count. Where
  // the ray stays on the surface, the search restarts after increasing steps, up to a sixteenth of a cell.
  double first_certain_hit(Ray ray, double enough) const {
    for (double step = 1;; step = std::min(2 * step, 0x1p16)) {
      const Hit hit = march_exhaustive({&field_, nullptr}, ray);
      if (!hit) return HUGE_VAL;
      if (begins_at(hit.t) || side_before(hit.t, ray.t_min) > 0)
        return hit.t < enough && std::isfinite(enough) && skims(hit.t, enough) ? enough : hit.t;
      ray.t_min = hit.t + step * (hit.t - just_before(hit.t));
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

  // Just before t: a millionth of a cell, far more than rounding, far less than any feature of the surface.
  double just_before(double t) const {
    return t - 0x1p-20 * std::min(field_.settings().cell_x, field_.settings().cell_y) / length(ray_.direction);
  }

  // Whether the ray appears at t: at its start, over the border, out of a hole (which may be touched only at a corner).
  // A touch there is a hit, which a shift of any size may change.
  bool begins_at(double t) const {
    if (just_before(t) < ray_.t_min) return true;
    const dvec3 before = ray_.at(just_before(t));
    return !field_.height(before.x, before.y) || is_at_rim(ray_.at(t));
  }

  // Whether two cells touch here at a corner, between two holes.
  bool is_pinch(const dvec3& p) const {
    const double dx = 0x1p-20 * field_.settings().cell_x, dy = 0x1p-20 * field_.settings().cell_y;
    const bool sw(field_.height(p.x - dx, p.y - dy)), se(field_.height(p.x + dx, p.y - dy));
    const bool nw(field_.height(p.x - dx, p.y + dy)), ne(field_.height(p.x + dx, p.y + dy));
    return sw == ne && se == nw && sw != se;
  }

  // Whether the field ends, or a hole begins, within a millionth of a cell.
  bool is_at_rim(const dvec3& p) const {
    const double dx = 0x1p-20 * field_.settings().cell_x, dy = 0x1p-20 * field_.settings().cell_y;
    return !(field_.height(p.x - dx, p.y - dy) && field_.height(p.x + dx, p.y - dy) &&
             field_.height(p.x - dx, p.y + dy) && field_.height(p.x + dx, p.y + dy));
  }

  // Side of the ray before t, once it exceeds rounding: 1 above, -1 below (then the ray leaves the ground at t, which
  // is not a hit), 0 undecided, or not decided after `from`.
  int side_before(double t, double from) const {
    for (double cells = 0x1p-20; cells < 1; cells *= 4) {
      const double before = t - cells * (t - just_before(t)) * 0x1p20;
      const dvec3 p = ray_.at(before);
      if (before < from || !field_.height(p.x, p.y)) return 0;
      if (const int found = side(before, 0)) return found;
    }
    return 0;
  }

  // Side on which the ray enters or starts over the field; 0 if undecided, or over a hole.
  int side_at_entry() const {
    double t = ray_.t_min;
    if (!field_.wraps()) {
      const dvec2 size{field_.width(), field_.depth()};
      for (int axis = 0; axis < 2; ++axis) {
        const double o = ray_.origin[axis], d = ray_.direction[axis];
        if (d != 0) t = std::max(t, std::min(-o / d, (size[axis] - o) / d));
      }
    }
    // A few steps further in, so that the ray is certainly over the field.
    t += 4 * (t - just_before(t));
    const dvec3 p = ray_.at(t);
    return t <= ray_.t_max && !is_at_rim(p) && !is_at_rim(ray_.at(std::max(ray_.t_min, t - 8 * (t - just_before(t)))))
               ? side(t, 0x1p-17)
               : 0;
  }

  // Side of the surface on which the ray is at t; 0 if that is within rounding, or if the rise of the surface within a
  // few cells could change it. Marches may distinguish a rise from rounding by the relief of the whole field.
  int side(double t, double cells) const {
    const dvec3 p = ray_.at(t);
    const auto place = field_.place(p.x, p.y);
    const auto h = place ? field_.cell_heights(place->cell) : std::nullopt;
    if (!h) return 0;
    const double relief = std::max({h->h00, h->h10, h->h01, h->h11}) - std::min({h->h00, h->h10, h->h01, h->h11});
    const double change = cells * (2 * relief * field_.settings().scale * field_.settings().exaggeration +
                                   std::abs(ray_.direction.z) * (t - just_before(t)) * 0x1p20);
    const double clearance = p.z - field_.height(p.x, p.y).value();
    if (std::abs(clearance) <= 2 * rounding(field_.max_sample() - field_.min_sample()) + change) return 0;
    return clearance > 0 ? 1 : -1;
  }

  bool is_in_its_cell(const Hit& hit) const {
    return hit.cell.col >= 0 && hit.cell.col < field_.cell_cols() && hit.cell.row >= 0 &&
           hit.cell.row < field_.cell_rows() && hit.u >= 0 && hit.u <= 1 && hit.v >= 0 && hit.v <= 1 &&
           field_.cell_heights(hit.cell).has_value();
  }

  const HeightField& field_;
  Ray ray_;
  int exponent_;
  std::vector<Hit> expected_;
  Hit nominal_;
  bool asked_ = false;
};

class Oracle : public testing::TestWithParam<Pair> {};

TEST_P(Oracle, ExactMarchesMatchTheOracle) {
  const FieldKind& fields = spiteful_fields()[GetParam().field];
  const RayKind& kind = spiteful_rays()[GetParam().ray];
  Random random(1000 * GetParam().field + GetParam().ray);
  int asked = 0, hit_count = 0, bad = 0;
  std::vector<Ray> rays(kRaysPerField);
  std::vector<Hit> closest(rays.size()), all;
  std::vector<std::uint8_t> blocked(rays.size());
  for (int done = 0; done < kRaysPerPair && bad < 5; done += kRaysPerField) {
    const HeightField field = fields.make(random);
    const MaxPyramid pyramid(field);
    const HeightTarget target{&field, &pyramid, slope_bound(field)};
    for (Ray& ray : rays) ray = kind.make(field, random);
    closest_hits(target, rays, closest);
    occluded(target, rays, blocked);
    for (std::size_t i = 0; i < rays.size() && bad < 5; ++i) {
      const Ray& ray = rays[i];
      Judge judge(field, ray);
      hit_count += judge.nominal().status == HitStatus::hit;
      const auto fail = [&](std::string_view what, std::string_view answer) {
        ++bad;
        ADD_FAILURE() << what << " on " << fields.name << ", ray " << kind.name << ": " << text(ray) << "\n  judge "
                      << text(judge.nominal()) << "\n  march " << answer << "\n  scarp replay "
                      << dumped(field, ray, text(judge.nominal()), std::string(answer));
      };
      for (const HeightMarchEntry& march : height_marches()) {
        const bool exact = march.guarantee == Guarantee::exact;
        if (!takes(march.fields, field)) continue;
        if (march.cpu == march_exhaustive || (!exact && i % kRaysPerApproximation != 0)) continue;
        const Hit hit = march.cpu(target, ray, {}, nullptr);
        if (hit && !(hit.t >= ray.t_min && hit.t <= ray.t_max)) fail("out of range", text(hit));
        if (exact && !judge.accepts(hit)) fail(march.name, text(hit));
        if (march.cpu == march_max_mip && !same(hit, closest[i])) fail("batch contradicts closest-hit", text(hit));
      }
      const HitStatus status = all_hits_max_mip(target, ray, all);
      if (!judge.accepts_all(all, status)) fail("all hits", text(all) + "\n  judge" + text(judge.all()));
      if (status != closest[i].status || (closest[i] && !same(all.front(), closest[i]))) {
        fail("all hits contradict closest-hit", text(closest[i]) + text(all));
      }
      const bool occluded = occluded_max_mip(target, ray);
      if (occluded != (closest[i].status == HitStatus::hit) || blocked[i] != occluded) {
        fail("any-hit contradicts closest-hit", fmt::format("{}, {}", occluded, blocked[i]));
      }
      asked += judge.asked_neighbours();
    }
  }
  RecordProperty("hits", hit_count);
  RecordProperty("asked_neighbours", asked);
  // Rays that are not aimed at anything rarely meet a rounding tie.
  if (kind.name == "random" || kind.name == "from above") {
    EXPECT_LE(asked, kRaysPerPair / 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(Spiteful, Oracle, testing::ValuesIn(pairs()), name_of_pair);

}  // namespace
}  // namespace scarp::test
