// SPDX-License-Identifier: MIT
#include "scarp/march/height/ground_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/error.h"
#include "scarp/march/height/ground_search.h"

namespace scarp {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

void require_ground(const HeightTarget& target) {
  require(target, HeightPart::pyramid);
  if (target.field->wraps()) throw Error("sweep: the field wraps round (use a field without wrap)");
}

// A query of GroundSearch: times.
class SweepSearch {
 public:
  SweepSearch(const Capsule& capsule, const dvec3& motion) : capsule_(capsule), motion_(motion) {}

  double best() const { return best_; }
  double bound(const WorldBox& box) const {
    return sweep_bound(capsule_, motion_, box.low, box.high, std::min(best_, 1.0));
  }
  bool compare(const GroundPart& part, bool flat) {
    if (!flat) return false;
    for (const Triangle& triangle : part.triangles) {
      const auto t = sweep_time(capsule_, motion_, triangle, std::min(best_, 1.0));
      if (!t || !(*t < best_)) continue;
      best_ = *t;
      triangle_ = triangle;
      cell_ = part.cell;
    }
    return true;
  }

  std::optional<GroundContact> answer() const {
    if (best_ == kNever) return {};
    return GroundContact{contact_at(capsule_, motion_, triangle_, best_), cell_};
  }

 private:
  const Capsule& capsule_;
  dvec3 motion_;
  double best_ = kNever;
  Triangle triangle_{};
  Cell cell_{};
};

// Whether a triangle meets a box around the origin with axes x, y, z: no axis separates them. Source: T.
// Akenine-Möller, "Fast 3D triangle-box overlap testing", JGT 6(1), 2001.
bool meets_box(const Triangle& t, const dvec3& half) {
  const auto separates = [&](const dvec3& axis) {
    const double a = dot(axis, t[0]), b = dot(axis, t[1]), c = dot(axis, t[2]);
    const double reach = dot(half, abs(axis));
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  const dvec3 sides[3] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  for (int i = 0; i < 3; ++i) {
    dvec3 axis(0.0);
    axis[i] = 1;
    if (separates(axis)) return false;
    for (const dvec3& side : sides) {
      if (separates(cross(axis, side))) return false;
    }
  }
  return !separates(cross(sides[0], sides[1]));
}

// A query of GroundSearch that ends at the first triangle.
class BoxSearch {
 public:
  explicit BoxSearch(const TurnedBox& box)
      : box_(box),
        reach_(abs(box.turn[0]) * box.half.x + abs(box.turn[1]) * box.half.y + abs(box.turn[2]) * box.half.z) {}

  double best() const { return found_ ? 0 : kNever; }
  double bound(const WorldBox& ground) const {
    const double wide = 16 * 0x1p-53 * (length(box_.centre) + length(reach_));
    for (int axis = 0; axis < 3; ++axis) {
      const double low = box_.centre[axis] - reach_[axis] - wide, high = box_.centre[axis] + reach_[axis] + wide;
      if (ground.low[axis] > high || ground.high[axis] < low) return kNever;
    }
    return 0;
  }
  bool compare(const GroundPart& part, bool flat) {
    if (!flat) return false;
    for (const Triangle& triangle : part.triangles) {
      Triangle own;
      for (std::size_t i = 0; i < 3; ++i) own[i] = (triangle[i] - box_.centre) * box_.turn;
      found_ = found_ || meets_box(own, box_.half);
    }
    return true;
  }
  bool found() const { return found_; }

 private:
  const TurnedBox& box_;
  dvec3 reach_;
  bool found_ = false;
};

}  // namespace

std::optional<GroundContact> sweep(const HeightTarget& target, const Capsule& capsule, const dvec3& motion) {
  require_ground(target);
  validate(capsule, motion);
  SweepSearch search(capsule, motion);
  GroundSearch(target, search).run();
  return search.answer();
}

bool overlaps(const HeightTarget& target, const TurnedBox& box) {
  require_ground(target);
  const double sum =
      length(box.centre) + length(box.half) + length(box.turn[0]) + length(box.turn[1]) + length(box.turn[2]);
  if (!std::isfinite(sum) || !(box.half.x >= 0 && box.half.y >= 0 && box.half.z >= 0))
    throw Error("overlap: the box must be finite, and none of its sides negative");
  BoxSearch search(box);
  GroundSearch(target, search).run();
  return search.found();
}

}  // namespace scarp
