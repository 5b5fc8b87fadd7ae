// SPDX-License-Identifier: MIT
#include "bench/bullet_peer.h"

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "bench/protocol.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

constexpr int kChunk = 16;  // Bullet's default
constexpr int kUpAxis = 2;

// The nearest of the triangles that Bullet passes, both sides alike, as for Embree and Scarp.
struct Nearest : btTriangleRaycastCallback {
  using btTriangleRaycastCallback::btTriangleRaycastCallback;
  bool hit = false;
  btScalar reportHit(const btVector3&, btScalar fraction, int, int) override {
    hit = true;
    return fraction;
  }
};

}  // namespace

struct BulletPeer::Shape {
  std::vector<float> heights;  // Bullet's rows run northwards
  std::unique_ptr<btHeightfieldTerrainShape> shape;
  btVector3 middle, low, high;  // Bullet centres the shape on its origin
  double build_s = 0;
  bool accelerated = false;

  // Bullet takes segments. Returns the end of the part of a ray over the field.
  float end_of(const BenchRay& ray) const {
    float end = ray.t_max;
    const float o[3] = {ray.ox, ray.oy, ray.oz}, d[3] = {ray.dx, ray.dy, ray.dz};
    for (int axis = 0; axis < 3; ++axis) {
      if (d[axis] != 0) end = std::min(end, ((d[axis] > 0 ? high : low)[axis] - o[axis]) / d[axis]);
    }
    return end;
  }

  float closest(const BenchRay& ray) const {
    // Rounding may end a segment before the surface.
    const float end = end_of(ray) * (1 + 0x1p-16F);
    if (!(end > 0)) return kMiss;
    const btVector3 from = btVector3(ray.ox, ray.oy, ray.oz) - middle;
    Nearest nearest(from, from + btVector3(ray.dx, ray.dy, ray.dz) * end);
    shape->performRaycast(&nearest, nearest.m_from, nearest.m_to);
    return nearest.hit ? nearest.m_hitFraction * end : kMiss;
  }
};

BulletPeer::BulletPeer(const HeightField& field, bool accelerated) : shape_(std::make_unique<Shape>()) {
  shape_->accelerated = accelerated;
  if (field.settings().cell_x != 1 || field.settings().cell_y != 1) throw Error("Bullet: cells of 1 m are expected");
  const Stopwatch watch;
  const int cols = field.cols(), rows = field.rows();
  shape_->heights.resize(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  field.visit([&](const auto& grid) {
    float* to = shape_->heights.data();
    for (int row = rows - 1; row >= 0; --row) {
      for (int col = 0; col < cols; ++col) {
        *to++ = static_cast<float>(field.height_from_sample(static_cast<double>(grid.at(col, row))));
      }
    }
  });
  const auto low = static_cast<float>(field.min_height()), high = static_cast<float>(field.max_height());
  // Bullet's "flipped" diagonal runs from a cell's south-west to its north-east corner; Embree uses the other diagonal.
  shape_->shape = std::make_unique<btHeightfieldTerrainShape>(cols, rows, shape_->heights.data(), low, high, kUpAxis,
                                                              /*flipQuadEdges=*/true);
  if (accelerated) shape_->shape->buildAccelerator(kChunk);
  shape_->low = {0, 0, low}, shape_->high = {static_cast<float>(cols - 1), static_cast<float>(rows - 1), high};
  shape_->middle = (shape_->low + shape_->high) * 0.5F;
  shape_->build_s = watch.wall_s();
}

BulletPeer::~BulletPeer() = default;

Engine BulletPeer::engine() const {
  const Shape& s = *shape_;
  Engine engine;
  engine.name = "bullet", engine.mode = s.accelerated ? "accelerator" : "plain";
  const double chunks = s.accelerated ? static_cast<double>(s.heights.size()) / (kChunk * kChunk) : 0;
  engine.bytes = engine.peak_bytes =
      static_cast<double>(s.heights.size() * sizeof(float)) + chunks * sizeof(btHeightfieldTerrainShape::Range);
  engine.build_s = s.build_s;
  engine.trace = [&s](const RaySet& set, std::int64_t begin, std::int64_t end, float* answers) {
    for (std::int64_t i = begin; i < end; ++i) {
      const float t = s.closest(set.rays[static_cast<std::size_t>(i)]);
      *answers++ = set.any_hit && t < kMiss ? kBlocked : t;
    }
  };
  return engine;
}

}  // namespace scarp::bench
