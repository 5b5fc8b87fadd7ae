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
  SweepSearch(const Capsule& capsule, const dvec3& motion, double slack)
      : capsule_(capsule), motion_(motion), slack_(slack) {}

  double best() const { return best_; }
  double bound(const WorldBox& box) const {
    return sweep_bound(capsule_, motion_, box.low, box.high, std::min(best_, 1.0));
  }
  double bound(const GroundPart& part) const {
    const Capsule wider{capsule_.a, capsule_.b, capsule_.radius + part.off};
    double first = kNever;
    for (const Triangle& triangle : part.triangles)
      first = std::min(first, sweep_time(wider, motion_, triangle, std::min(best_, 1.0)).value_or(kNever));
    return first;
  }
  bool compare(const GroundPart& part, bool flat) {
    if (!flat) return touches_patch(part);
    for (const Triangle& triangle : part.triangles) {
      const auto t = sweep_time(capsule_, motion_, triangle, std::min(best_, 1.0));
      if (!t || !(*t < best_)) continue;
      best_ = *t;
      triangle_ = triangle;
      curved_.reset();
      cell_ = part.cell;
    }
    return true;
  }

  std::optional<GroundContact> answer() const {
    if (best_ == kNever) return {};
    return GroundContact{curved_ ? *curved_ : contact_at(capsule_, motion_, triangle_, best_), cell_};
  }

 private:
  // Returns whether the first contact with the part is known.
  bool touches_patch(const GroundPart& part) {
    const auto contact = patch_contact(part.patch(), capsule_, motion_, std::min(best_, 1.0), slack_);
    if (!contact) return false;
    if (contact->t < best_) {
      best_ = contact->t;
      curved_ = *contact;
      cell_ = part.cell;
    }
    return contact->proven;
  }

  const Capsule& capsule_;
  dvec3 motion_;
  double slack_;
  double best_ = kNever;
  std::optional<Contact> curved_;  // with a curved part; else triangle_ is touched
  Triangle triangle_{};
  Cell cell_{};
};

// A query of GroundSearch: distances from the centre line of a capsule that overlaps the ground at its start.
class DepthSearch {
 public:
  DepthSearch(const Capsule& capsule, double slack)
      : capsule_(capsule), slack_(slack), best_(std::nextafter(capsule.radius, kNever)) {}

  double best() const { return best_; }
  double bound(const WorldBox& box) const {
    const dvec3 low = min(capsule_.a, capsule_.b), high = max(capsule_.a, capsule_.b);
    return length(max(max(box.low - high, low - box.high), dvec3(0.0)));
  }
  double bound(const GroundPart& part) const {
    double nearest = kNever;
    for (const Triangle& triangle : part.triangles) nearest = std::min(nearest, std::sqrt(closest(triangle).square()));
    return std::max(0.0, nearest - part.off);
  }
  bool compare(const GroundPart& part, bool flat) {
    if (!flat && capsule_.a == capsule_.b) {
      const PatchPoint found = closest_of_patch(part.patch(), capsule_.a, slack_);
      take({capsule_.a, found.point}, normal_of(part.triangles[0]), part.cell);
      if (found.proven) return true;
    }
    for (const Triangle& triangle : part.triangles) {
      if (flat) take(closest(triangle), normal_of(triangle), part.cell);
    }
    return flat;
  }

  /// `found`: the contact of the sweep, kept if no distance was below the radius.
  GroundContact answer(const GroundContact& found, const dvec3& motion) const {
    if (normal_ == dvec3(0.0)) return found;
    return {overlap_at(capsule_, motion, pair_, normal_), cell_};
  }

 private:
  static dvec3 normal_of(const Triangle& t) { return cross(t[1] - t[0], t[2] - t[0]); }
  ClosestPair closest(const Triangle& triangle) const {
    return closest_of_segment_and_triangle(capsule_.a, capsule_.b - capsule_.a, triangle);
  }
  void take(const ClosestPair& pair, const dvec3& normal, Cell cell) {
    const double distance = std::sqrt(pair.square());
    if (!(distance < best_)) return;
    best_ = distance;
    pair_ = pair, normal_ = normal, cell_ = cell;
  }

  const Capsule& capsule_;
  double slack_;
  double best_;
  ClosestPair pair_;
  dvec3 normal_{0.0};
  Cell cell_{};
};

// A query of GroundSearch that ends at the first triangle.
class BoxSearch {
 public:
  explicit BoxSearch(const TurnedBox& box) : box_(box) {}

  double best() const { return found_ ? 0 : kNever; }
  double bound(const WorldBox& ground) const {
    const double wide = 16 * 0x1p-53 * (length(box_.centre) + length(box_.half));
    return scarp::overlaps(box_, ground.low - wide, ground.high + wide) ? 0 : kNever;
  }
  double bound(const GroundPart& part) const {
    TurnedBox wider = box_;
    wider.half += part.off;
    const auto& [north_west, south_east] = part.triangles;
    return scarp::overlaps(wider, north_west) || scarp::overlaps(wider, south_east) ? 0 : kNever;
  }
  bool compare(const GroundPart& part, bool flat) {
    if (!flat) {
      found_ = contains_point_of(part);
      return found_;
    }
    for (const Triangle& triangle : part.triangles) found_ = found_ || scarp::overlaps(box_, triangle);
    return true;
  }
  bool found() const { return found_; }

 private:
  // Tests points of the surface near the middle of the box.
  bool contains_point_of(const GroundPart& part) const {
    const Patch patch = part.patch();
    for (const Triangle& triangle : part.triangles) {
      const dvec3 q = closest_of_triangle(box_.centre, triangle) - patch.corner;
      const dvec3 p = (patch.at(q.x / patch.along_u.x, q.y / patch.along_v.y) - box_.centre) * box_.turn;
      if (std::abs(p.x) <= box_.half.x && std::abs(p.y) <= box_.half.y && std::abs(p.z) <= box_.half.z) return true;
    }
    return false;
  }

  const TurnedBox& box_;
  bool found_ = false;
};

}  // namespace

std::optional<GroundContact> sweep(const HeightTarget& target, const Capsule& capsule, const dvec3& motion) {
  require_ground(target);
  validate(capsule, motion);
  SweepSearch search(capsule, motion, GroundSearch<SweepSearch>::slack(*target.field));
  GroundSearch(target, search).run();
  const auto found = search.answer();
  if (!found || found->t > 0) return found;
  DepthSearch depth(capsule, GroundSearch<DepthSearch>::slack(*target.field));
  GroundSearch(target, depth).run();
  return depth.answer(*found, motion);
}

bool overlaps(const HeightTarget& target, const TurnedBox& box) {
  require_ground(target);
  validate(box);
  BoxSearch search(box);
  GroundSearch(target, search).run();
  return search.found();
}

}  // namespace scarp
