// SPDX-License-Identifier: MIT
// The shader source reads samples and quads through its host. Here the host reads memory, and a trace records the
// addresses.

#include "bench/simt_note.h"
// Included after the definition of SCARP_COUNT, like all files that include the shader source.
#include "bench/simt_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/accel/max_quads.glsl.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/sampling/device_sampling.h"

namespace scarp::bench {

struct SimtGround::Impl {
  const HeightField& field;
  const MaxPyramid& pyramid;
  glsl::ScarpField shader_field;
  glsl::ScarpLeanCodes codes;
  const float* samples = nullptr;
  std::ptrdiff_t row_stride = 0;
  glsl::uint quad_cols, quad_rows, quad_stride;
  std::vector<glsl::uvec2> quads;

  Impl(const HeightField& field_, const MaxPyramid& pyramid_);
  glsl::uint cell_code(int col, int row) const;
  void build_quads(int level);
};

namespace {

thread_local const SimtGround::Impl* ground = nullptr;

// Disjoint from the addresses of samples.
constexpr std::uint64_t kQuadsBegin = std::uint64_t{1} << 40;
constexpr std::int64_t kRowsPerPiece = 64;

glsl::uint highest_of(glsl::uvec2 quad) {
  return std::max({quad.x & 0xffffu, quad.x >> 16, quad.y & 0xffffu, quad.y >> 16});
}

}  // namespace
}  // namespace scarp::bench

// The shader source and its host are local to this file: the library and its tests have their own hosts.
#undef SCARP_GLSL_BEGIN
#undef SCARP_GLSL_END
#define SCARP_GLSL_BEGIN  \
  namespace scarp::glsl { \
  namespace {
#define SCARP_GLSL_END \
  }                    \
  }

SCARP_GLSL_BEGIN

std::uint64_t sample_address(int col, int row) {
  const auto cols = static_cast<std::uint64_t>(bench::ground->field.cols());
  return (static_cast<std::uint64_t>(row) * cols + static_cast<std::uint64_t>(col)) * sizeof(float);
}
float scarp_sample(int col, int row) {
  bench::note_fetch(sample_address(col, row), sizeof(float));
  return bench::ground->samples[row * bench::ground->row_stride + col];
}
// By two loads of two samples.
vec4 scarp_corners(int col, int row) {
  for (const int south : {0, 1}) bench::note_fetch(sample_address(col, row + south), 2 * sizeof(float));
  const float* const at = bench::ground->samples + row * bench::ground->row_stride + col;
  const float* const below = at + bench::ground->row_stride;
  return {at[0], at[1], below[0], below[1]};
}
bool scarp_is_nodata(float) { return false; }
uvec2 scarp_quad(int level, int col, int row) {
  const auto& at = *bench::ground;
  const uint index = ground_quad(at.quad_cols, at.quad_rows, at.quad_stride, static_cast<uint>(level),
                                 static_cast<uint>(col), static_cast<uint>(row));
  bench::note_fetch(bench::kQuadsBegin + std::uint64_t{index} * sizeof(uvec2), sizeof(uvec2));
  return at.quads[index];
}
// For the second pass, which is not traced.
float scarp_maximum(int level, int col, int row) {
  const MaxPyramid::Level& at = bench::ground->pyramid.levels()[static_cast<std::size_t>(level - 1)];
  return bench::ground->pyramid.maximum_code(at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col);
}
float scarp_minimum(int level, int col, int row) {
  const MaxPyramid::Level& at = bench::ground->pyramid.levels()[static_cast<std::size_t>(level - 1)];
  return bench::ground->pyramid.minima()[at.begin + static_cast<std::ptrdiff_t>(row) * at.cols + col];
}

SCARP_GLSL_END

#include "scarp/march/height/height_marches_lean.glsl.h"
#include "scarp/march/height/max_mip.glsl.h"
#include "scarp/march/height/max_mip_lean.glsl.h"

namespace scarp::bench {
namespace {

// Sets the host of the shader source during the march of a ray.
struct Hosted {
  Hosted(const SimtGround& on, SimtTrace* trace) {
    ground = &on.impl();
    noted = trace;
  }
  ~Hosted() {
    ground = nullptr;
    noted = nullptr;
  }
  Hosted(const Hosted&) = delete;
  Hosted& operator=(const Hosted&) = delete;
};

SimtAnswer answer_of(const Ray& ray, const DeviceRay& prepared, const glsl::ScarpHit& hit, bool any) {
  constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();
  const Hit found = hit_from_device(ray, prepared, hit);
  SimtAnswer result{
      {static_cast<bool>(found), found.status == HitStatus::exhausted, found && !any ? found.t : kNoTime, {}}};
  result.answer.stats.steps = hit.steps;
  return result;
}

// The part of a ray's range in which it is no higher than the highest sample.
Ray clipped(const HeightField& field, Ray ray) {
  const double rise = ray.direction.z, over = field.max_height() - ray.origin.z;
  if (rise > 0) ray.t_max = std::min(ray.t_max, std::max(ray.t_min, over / rise));
  if (rise < 0) ray.t_min = std::max(ray.t_min, std::min(ray.t_max, over / rise));
  return ray;
}

}  // namespace

SimtGround::Impl::Impl(const HeightField& field_, const MaxPyramid& pyramid_)
    : field(field_),
      pyramid(pyramid_),
      shader_field(device_field(field, &pyramid)),
      codes(device_codes(field, pyramid)) {
  if (field.sample_type() != SampleType::float32 || shader_field.flags != 0 || shader_field.top_level == 0)
    throw Error("simt: counts bilinear fields of float32 samples without holes, walls and wrap");
  field.visit([&](const auto& grid) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(*grid.data)>, float>) {
      samples = grid.data;
      row_stride = grid.row_stride;
    }
  });
  const MaxPyramid::Level& finest = pyramid.levels().front();
  quad_cols = static_cast<glsl::uint>(finest.cols);
  quad_rows = static_cast<glsl::uint>(finest.rows);
  quad_stride = glsl::ground_quad_stride(quad_cols, static_cast<glsl::uint>(pyramid.top_level()));
  const std::size_t rows = quad_rows + (pyramid.top_level() > 1 ? std::size_t(pyramid.levels()[1].rows) : 0);
  quads.resize(rows * quad_stride);
  for (int level = 1; level <= pyramid.top_level(); ++level) build_quads(level);
}

glsl::uint SimtGround::Impl::cell_code(int col, int row) const {
  const float* const north = samples + row * row_stride + col;
  const float* const south = north + row_stride;
  return glsl::scarp_code_above(std::max({north[0], north[1], south[0], south[1]}), shader_field.code_base,
                                shader_field.code_base_low, codes.per_step);
}

// As max_quads.comp does.
void SimtGround::Impl::build_quads(int level) {
  const MaxPyramid::Level& at = pyramid.levels()[static_cast<std::size_t>(level - 1)];
  const int cols = level == 1 ? field.cell_cols() : pyramid.levels()[static_cast<std::size_t>(level - 2)].cols,
            rows = level == 1 ? field.cell_rows() : pyramid.levels()[static_cast<std::size_t>(level - 2)].rows;
  const auto quad = [&](int of, int col, int row) -> glsl::uvec2& {
    return quads[glsl::ground_quad(quad_cols, quad_rows, quad_stride, static_cast<glsl::uint>(of),
                                   static_cast<glsl::uint>(col), static_cast<glsl::uint>(row))];
  };
  const auto code = [&](int col, int row) -> glsl::uint {
    if (col >= cols || row >= rows) return 0;
    return level == 1 ? cell_code(col, row) : highest_of(quad(level - 1, col, row));
  };
  parallel_for(at.rows, kRowsPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (int row = static_cast<int>(begin); row < end; ++row) {
      for (int col = 0; col < at.cols; ++col) {
        const int x = 2 * col, y = 2 * row;
        quad(level, col, row) = {code(x, y) | code(x + 1, y) << 16, code(x, y + 1) | code(x + 1, y + 1) << 16};
      }
    }
  });
}

SimtGround::SimtGround(const HeightField& field, const MaxPyramid& pyramid)
    : impl_(std::make_unique<Impl>(field, pyramid)) {}
SimtGround::~SimtGround() = default;

SimtAnswer trace_max_mip(const SimtGround& on, const Ray& ray, bool any, SimtTrace* trace) {
  const DeviceRay prepared = device_ray(on.impl().field, ray);
  const glsl::ScarpField& field = on.impl().shader_field;
  const Hosted hosted(on, trace);
  glsl::ScarpHit hit;
  glsl::ScarpLean at = glsl::scarp_lean_begin();
  while (!glsl::scarp_lean_on(field, on.impl().codes, prepared.ray, any, at, hit)) {
  }
  SCARP_COUNT(answer);
  const bool second = hit.status == glsl::kScarpDoubtful;
  if (second) {
    noted = nullptr;
    hit = glsl::scarp_max_mip(field, prepared.ray, any);
  }
  SimtAnswer result = answer_of(ray, prepared, hit, any);
  result.second_pass = second;
  return result;
}

SimtAnswer trace_naive(const SimtGround& on, const Ray& ray, bool any, const SimtNaive& naive, SimtTrace* trace) {
  const HeightField& field = on.impl().field;
  const Ray marched = naive.clipped ? clipped(field, ray) : ray;
  const DeviceRay prepared = sampled_device_ray(field, marched);
  MarchSettings settings;
  settings.naive = naive.settings;
  const HeightFieldSettings& scales = field.settings();
  const glsl::ScarpSampling sampling =
      device_sampling(Sampling::naive, settings, 0, 0, scales.scale * scales.exaggeration);
  const glsl::ScarpField& shader_field = on.impl().shader_field;
  const Hosted hosted(on, trace);
  glsl::ScarpHit hit = glsl::scarp_no_hit();
  glsl::ScarpStretch at = glsl::scarp_stretch_begin(shader_field, prepared.ray, sampling);
  while (!glsl::scarp_stretch_on(shader_field, prepared.ray, sampling, any, at, hit)) {
  }
  SCARP_COUNT(answer);
  const bool second = hit.status == glsl::kScarpDoubtful;
  if (second) {
    noted = nullptr;
    hit = glsl::scarp_sampled(shader_field, prepared.ray, sampling);
  }
  SimtAnswer result = answer_of(marched, prepared, hit, any);
  result.second_pass = second;
  return result;
}

}  // namespace scarp::bench
