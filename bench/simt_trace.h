// SPDX-License-Identifier: MIT
// The shader source of max-mip and naive, run on the CPU one ray at a time, with a record of what each ray does.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bench/judge.h"
#include "bench/simt_bundle.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"
#include "scarp/march/march_settings.h"

namespace scarp::bench {

/// A field in its device-memory layout (accel/ground_buffers.glsl.h). float32 samples without holes; neither copied nor
/// owned.
class SimtGround {
 public:
  /// Builds the quads, on all threads. Throws Error for a field for which the counted shaders are not compiled.
  SimtGround(const HeightField& field, const MaxPyramid& pyramid);
  ~SimtGround();

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// The answer to a ray, and whether the first pass left it to the second.
struct SimtAnswer {
  Judge::Answer answer;
  bool second_pass = false;
};

/// Runs both passes, as on devices; traces the first. `trace` may be null.
SimtAnswer trace_max_mip(const SimtGround& ground, const Ray& ray, bool any, SimtTrace* trace);

struct SimtNaive {
  NaiveSettings settings;
  bool clipped;  ///< whether rays start and end no higher than the field's highest sample
};
SimtAnswer trace_naive(const SimtGround& ground, const Ray& ray, bool any, const SimtNaive& naive, SimtTrace* trace);

}  // namespace scarp::bench
