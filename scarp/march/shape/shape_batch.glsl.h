// SPDX-License-Identifier: MIT
// A batch of rays over a distance field on a device: shared by sphere_trace.comp and the C++ code that dispatches it
// (shape_queries_vk.h). Marches are interrupted as described in function_batch.glsl.h.
//
//   ShapeBatch ──code, numbers──▶ the shape's program, ──grounds──▶ its functions and height fields
//       │  └───────rays──▶ ScarpFunctionRay ...      one invocation each
//       └──────────hits──▶ ScarpFunctionHit ...      the answers, in the same order
#ifndef SCARP_MARCH_SHAPE_BATCH_GLSL_H
#define SCARP_MARCH_SHAPE_BATCH_GLSL_H

#include "scarp/accel/function_buffers.glsl.h"
#include "scarp/accel/ground_buffers.glsl.h"
#include "scarp/accel/shape_buffers.glsl.h"
#include "scarp/march/ray_states.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Specialisation constants: threads per workgroup; any hit or closest hit; contents of the program (scarp_shape_uses);
// contents of its functions (scarp_uses).

/// Push constants; see ScarpSphereTrace.
struct ShapeBatch {
  Address code;
  Address numbers;
  Address grounds;
  Address rays;
  Address hits;
  uint count;
  uint instructions;
  float tolerance;
  int max_steps;
  int run_steps;
  float growth;
};

#ifndef __cplusplus

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint batch_any = 0;
layout(constant_id = 2) const uint batch_parts = 0xffffffffu;
layout(constant_id = 3) const uint batch_function_parts = 0xffffffffu;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ShapeCode {
  ScarpShapeInstruction instructions[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ShapeNumbers { float numbers[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ShapeGrounds {
  ScarpShapeGround grounds[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ShapeFunction {
  ScarpInstruction instructions[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ShapeRays { ScarpFunctionRay rays[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer ShapeHits { ScarpFunctionHit hits[]; };
layout(push_constant, scalar) uniform Push { ShapeBatch batch; };

ScarpShapeInstruction scarp_shape_instruction(uint i) { return ShapeCode(batch.code).instructions[i]; }
float scarp_shape_number(uint i) { return ShapeNumbers(batch.numbers).numbers[i]; }
bool scarp_shape_uses(uint op) { return (batch_parts & (1u << op)) != 0u; }

// The ground being evaluated.
ScarpShapeGround shape_ground;

ScarpInstruction scarp_instruction(uint i) { return ShapeFunction(shape_ground.data).instructions[i]; }
bool scarp_uses(uint part) { return (batch_function_parts & (1u << part)) != 0u; }
float scarp_field_sample(int col, int row) {
  Ground ground = Ground(shape_ground.data);
  return ground_sample_value(ground, ground_sample_bits(ground, uint(col), uint(row)));
}
bool scarp_field_hole(int col, int row) {
  vec4 heights;
  return !ground_cell(Ground(shape_ground.holes), uint(col), uint(row), heights);
}

#endif

SCARP_GLSL_END

#endif
