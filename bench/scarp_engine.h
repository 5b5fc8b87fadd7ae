// SPDX-License-Identifier: MIT
// The marches of Scarp as engines.
#pragma once

#include <vector>

#include "bench/engine.h"
#include "bench/fields.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/height/max_mip_simd.h"

namespace scarp::bench {

/// A field ready for all marches; outlives the engines made from it.
class ScarpGround {
 public:
  /// Builds the pyramid and measures the time.
  explicit ScarpGround(const HeightField& field);
  ScarpGround(const ScarpGround&) = delete;
  ScarpGround& operator=(const ScarpGround&) = delete;

  /// One march of the table under the given settings. Any-hit rays use the march's any-hit function if it has one.
  Engine engine(const HeightMarchEntry& march, const MarchSettings& settings = {}) const;

  /// The same, but any-hit rays use the closest-hit function.
  Engine closest_only(const HeightMarchEntry& march, const MarchSettings& settings = {}) const;

  /// `max-mip` in vectors, with all or some of the optimisations.
  Engine vectors(const std::string& mode, const VectorOptions& options = {}) const;

  /// `max-mip` in fans, for sets that are fans.
  Engine fans() const;

  /// Every march of the table except the judge.
  std::vector<Engine> engines() const;

  HeightTarget target() const { return {&field_, &pyramid_, slope_bound_}; }

 private:
  HeightField field_;
  double build_s_ = 0;
  MaxPyramid pyramid_;
  double slope_bound_;
};

}  // namespace scarp::bench
