// SPDX-License-Identifier: MIT
// The ground of a shadow map: linear at crossings of grid lines (sight.h), or bilinear (bilinear_ground.h).
#pragma once

#include <vector>

#include "scarp/analysis/bilinear_ground.h"
#include "scarp/analysis/map_part.h"
#include "scarp/analysis/sight.h"

namespace scarp {

/// A plain view of either kind of ground. Converts implicitly from both.
class SunGround {
 public:
  SunGround(const HeightField& field) : ground_(field) {}
  SunGround(const BilinearGround& ground) : ground_(ground.field()), bilinear_(&ground) {}

  const SightGround& heights() const { return ground_; }
  const HeightField& field() const { return ground_.field(); }

  /// Returns the shade of a node.
  Shade shade(const SunRay& sun, Node node) const;
  /// Returns the codes of the band under one sun. Throws as shadow_rows() does.
  std::vector<Shade> rows(const SunDirection& sun, const RowBand& band, const Progress& progress = {}) const;

 private:
  SightGround ground_;
  const BilinearGround* bilinear_ = nullptr;
};

}  // namespace scarp
