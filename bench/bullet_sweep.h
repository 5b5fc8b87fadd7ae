// SPDX-License-Identifier: MIT
// Bullet 3.24 on the same samples: spheres and capsules swept over a btHeightfieldTerrainShape by
// btCollisionWorld::objectQuerySingle(), as btCollisionWorld::convexSweepTest() does for each object.
#pragma once

#include <memory>
#include <optional>

#include "scarp/field/height_field.h"
#include "scarp/march/sweep.h"

namespace scarp::bench {

/// A shape over a field of cells of 1 m with the surface `triangles`.
class BulletSweeper {
 public:
  explicit BulletSweeper(const HeightField& field);
  ~BulletSweeper();
  BulletSweeper(const BulletSweeper&) = delete;
  BulletSweeper& operator=(const BulletSweeper&) = delete;

  /// The first contact as a fraction of the motion. The capsule is a sphere or upright.
  std::optional<double> sweep(const Capsule& capsule, const dvec3& motion) const;

 private:
  struct Shape;
  std::unique_ptr<Shape> shape_;
};

}  // namespace scarp::bench
