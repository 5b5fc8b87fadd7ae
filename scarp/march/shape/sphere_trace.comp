// SPDX-License-Identifier: MIT
// `sphere-trace` for a batch of rays, one invocation per ray.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "scarp/march/shape/shape_batch.glsl.h"
// The march reads its instructions and grounds through the batch.
#include "scarp/march/function/function_heights.glsl.h"
#include "scarp/march/shape/shape_grounds.glsl.h"
#include "scarp/march/shape/sphere_trace.glsl.h"

float scarp_shape_function(uint index, float x, float y) {
  shape_ground = ShapeGrounds(batch.grounds).grounds[index];
  return scarp_height(ScarpProgram(shape_ground.count, shape_ground.result), scarp_two(x), scarp_two(y)).high;
}

float scarp_shape_field(uint index, vec3 q, float shrink) {
  shape_ground = ShapeGrounds(batch.grounds).grounds[index];
  Ground ground = Ground(shape_ground.data);
  ScarpSolidField field;
  field.cells = ivec2(ground.is.cell_cols, ground.is.cell_rows);
  field.samples = ivec2(ground.is.cols, ground.is.rows);
  field.cell_x = ground.is.cell_x;
  field.cell_y = ground.is.cell_y;
  field.metres_per_sample = ground.is.metres_per_sample;
  field.metres_at_zero = ground.is.metres_at_zero;
  field.triangles = ground.is.triangles != 0u;
  field.wraps = ground.is.wrap != kGroundWrapNone;
  field.has_holes = shape_ground.has_holes != 0u;
  return scarp_field_ground(field, q, shrink);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= batch.count) return;
  ScarpFunctionRay ray = ShapeRays(batch.rays).rays[i];
  ShapeHits(batch.hits).hits[i] = scarp_sphere_trace(
      batch.instructions, ray, ScarpSphereTrace(batch.tolerance, batch.max_steps, batch.run_steps, batch.growth),
      batch_any != 0u);
}
