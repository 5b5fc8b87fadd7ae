// SPDX-License-Identifier: MIT
// Private to the station: a batch over many height fields of a scene. Rays wait at the objects on their way, so that
// each field traces many at once (tile_queues.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include "scarp/scene/object_boxes.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/tile_queues.h"

namespace scarp {

/// Number of rays of a batch that a thread takes at a time, and of fields up to which they are examined.
inline constexpr std::int64_t kRaysPerQueuedPiece = 4096;
inline constexpr std::size_t kMostQueuedFields = 1024;
/// With fewer rays, or at an object with fewer, rays are traced one by one.
inline constexpr std::size_t kFewForQueues = 64, kFewAtObject = 16;

/// Whether queues pay: all fields of the scene are height fields whose batches are faster than single rays.
inline bool has_only_heights(const Scene& scene) {
  const auto& fields = scene.fields();
  return fields.size() <= kMostQueuedFields &&
         std::all_of(fields.begin(), fields.end(),
                     [](const SceneFieldPtr& field) { return field->likes_batches() && height_field_of(*field); });
}

/// By which part of its distance a box is widened: more than rounding and the seams of fields.
inline constexpr double kWider = 0x1p-20;
/// The time at which a ray enters a widened box, whose low z may be infinite; infinity if it misses the box.
inline double enters_box(const WorldBox& box, const Ray& ray) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  double begin = ray.t_min, end = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    const double side = std::max(axis == 2 ? 0 : std::abs(box.low[axis]), std::abs(box.high[axis]));
    const double wide = kWider * (std::abs(o) + side);
    const double low = box.low[axis] - wide - o, high = box.high[axis] + wide - o;
    if (d == 0) {
      if (low > 0 || high < 0) return kNever;
      continue;
    }
    const double a = low / d, b = high / d;
    begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
  }
  return begin <= end ? begin : kNever;
}

/// The objects on the way of each ray of a batch.
class ObjectQueues {
 public:
  struct Waiting {
    std::uint32_t ray;
    std::uint32_t next, end;  // in ways_
    double enters;            ///< time at which the ray enters the object's box
  };

  explicit ObjectQueues(const Scene& scene) : boxes_(scene.objects().size()), queues_(std::ssize(scene.objects())) {
    for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
      const auto box = scene.field_of(i).box();
      if (box) boxes_[i] = world_box(scene.objects()[i].placement, *box);
      bounded_.push_back(!boxes_[i].empty() && scene.objects()[i].placement.upright());
      // Rays that start below the ground are `below`.
      if (bounded_[i]) boxes_[i].low.z = -std::numeric_limits<double>::infinity();
    }
  }

  /// Whether no ray that misses the object's box, or all space below it, has an answer other than `miss`.
  bool bounded(std::uint32_t object) const { return bounded_[object]; }
  /// Adds a ray. traverse(visit) calls visit(object) for the bounded objects that may be on its way, in any order.
  template <class Traverse>
  void add(std::uint32_t i, const Ray& ray, const Traverse& traverse) {
    const std::size_t first = ways_.size();
    traverse([&](std::uint32_t object) {
      const double enters = enters_box(boxes_[object], ray);
      if (enters < std::numeric_limits<double>::infinity()) ways_.push_back({enters, object});
    });
    std::sort(ways_.begin() + static_cast<std::ptrdiff_t>(first), ways_.end(),
              [](const Way& a, const Way& b) { return a.enters < b.enters; });
    go_on({i, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(ways_.size()), 0});
  }
  /// Calls trace(object, waiting) until all queues are empty. `trace` calls go_on() for the rays that go on.
  template <class Trace>
  void run(const Trace& trace) {
    queues_.run(trace);
  }
  void go_on(Waiting one) {
    if (one.next == one.end) return;
    const Way& way = ways_[one.next++];
    one.enters = way.enters;
    queues_.push(way.object, one);
  }

 private:
  struct Way {
    double enters;
    std::uint32_t object;
  };
  std::vector<WorldBox> boxes_;
  std::vector<bool> bounded_;
  std::vector<Way> ways_;
  TileQueues<Waiting> queues_;
};

}  // namespace scarp
