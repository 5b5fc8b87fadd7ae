// SPDX-License-Identifier: MIT
#include "bench/bullet_sweep.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <vector>

namespace scarp::bench {
namespace {

btVector3 bullet(const dvec3& p) {
  return {static_cast<btScalar>(p.x), static_cast<btScalar>(p.y), static_cast<btScalar>(p.z)};
}

}  // namespace

struct BulletSweeper::Shape {
  std::vector<float> heights;  // Bullet's rows run northwards
  std::unique_ptr<btHeightfieldTerrainShape> ground;
  std::unique_ptr<btCollisionObject> object;
};

BulletSweeper::BulletSweeper(const HeightField& field) : shape_(std::make_unique<Shape>()) {
  const int cols = field.cols(), rows = field.rows();
  field.visit([&](const auto& grid) {
    for (int row = rows - 1; row >= 0; --row) {
      for (int col = 0; col < cols; ++col)
        shape_->heights.push_back(static_cast<float>(field.height_from_sample(static_cast<double>(grid.at(col, row)))));
    }
  });
  const auto low = static_cast<float>(field.min_height()), high = static_cast<float>(field.max_height());
  shape_->ground = std::make_unique<btHeightfieldTerrainShape>(cols, rows, shape_->heights.data(), low, high, 2,
                                                               /*flipQuadEdges=*/true);
  shape_->ground->setMargin(0);
  shape_->object = std::make_unique<btCollisionObject>();
  shape_->object->setCollisionShape(shape_->ground.get());
  // Bullet centres the shape on its origin.
  btTransform place = btTransform::getIdentity();
  place.setOrigin({0.5F * static_cast<float>(cols - 1), 0.5F * static_cast<float>(rows - 1), 0.5F * (low + high)});
  shape_->object->setWorldTransform(place);
}

BulletSweeper::~BulletSweeper() = default;

std::optional<double> BulletSweeper::sweep(const Capsule& capsule, const dvec3& motion) const {
  const auto radius = static_cast<btScalar>(capsule.radius);
  const btSphereShape sphere(radius);
  const btCapsuleShapeZ upright(radius, static_cast<btScalar>(length(capsule.b - capsule.a)));
  const bool is_sphere = capsule.a == capsule.b;
  const btConvexShape* shape = is_sphere ? static_cast<const btConvexShape*>(&sphere) : &upright;
  btTransform from = btTransform::getIdentity(), to = from;
  const dvec3 middle = 0.5 * (capsule.a + capsule.b);
  from.setOrigin(bullet(middle));
  to.setOrigin(bullet(middle + motion));
  btCollisionWorld::ClosestConvexResultCallback nearest(from.getOrigin(), to.getOrigin());
  btCollisionWorld::objectQuerySingle(shape, from, to, shape_->object.get(), shape_->ground.get(),
                                      shape_->object->getWorldTransform(), nearest, 0);
  if (!nearest.hasHit()) return {};
  return static_cast<double>(nearest.m_closestHitFraction);
}

}  // namespace scarp::bench
