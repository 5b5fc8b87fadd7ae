// SPDX-License-Identifier: MIT
// Bullet 3.24 on the same samples: btHeightfieldTerrainShape with its accelerator (a grid of height ranges over chunks
// of 16 x 16 cells), queried by performRaycast() with a custom triangle callback, one ray at a time.
#pragma once

#include <memory>

#include "bench/engine.h"
#include "bench/fields.h"

namespace scarp::bench {

/// A shape over a field of cells of 1 m; outlives the engine made from it.
class BulletPeer {
 public:
  BulletPeer(const HeightField& field, bool accelerated);
  ~BulletPeer();
  BulletPeer(const BulletPeer&) = delete;
  BulletPeer& operator=(const BulletPeer&) = delete;

  Engine engine() const;

 private:
  struct Shape;
  std::unique_ptr<Shape> shape_;
};

}  // namespace scarp::bench
