// SPDX-License-Identifier: MIT
// A batch of rays over a terrain function on a device: what the compute shaders and the C++ that calls them
// (function_queries_vk.h) agree upon.
//
//   FunctionBatch ──code──▶ ScarpInstruction ...      the function's program
//        │  └─────rays──▶ ScarpFunctionRay ...      one invocation each
//        └────────hits──▶ ScarpFunctionHit ...      the answers, in the same order
#ifndef SCARP_MARCH_FUNCTION_BATCH_GLSL_H
#define SCARP_MARCH_FUNCTION_BATCH_GLSL_H

#include "scarp/accel/function_buffers.glsl.h"
#include "scarp/march/function/function_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"
#include "scarp/vk/loop_turns.glsl.h"

SCARP_GLSL_BEGIN

// A march is interrupted after run_steps steps and goes on in the next run: loop_turns.glsl.h says why. The
// interpreter's turns count, which kScarpMostInstructions limits.
//
// Specialisation constants: threads of a workgroup; which march (function_marches.comp), or whether any hit will do
// (lipschitz_local.comp); what the program has (scarp_uses), so that a shader is made of what it needs: some drivers go
// through all branches of an instruction.

/// Evaluations that may follow the last step of a run: halvings, secants, and what a ray begins and ends with.
const int kScarpLastEvaluations = 70;
/// Of a program: so that a run has some steps.
const int kScarpMostInstructions = 600;

/// The push constants. Settings that a march has none of mean nothing; see ScarpFunctionMarch.
struct FunctionBatch {
  Address code;
  Address rays;
  Address hits;
  uint count;
  uint instructions;
  uint result;  ///< register
  float factor;
  float least;
  float tolerance;
  float metres;
  int max_steps;
  uint refinement;
  int halvings;
  int run_steps;
};

#ifndef __cplusplus

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint batch_choice = 0;
layout(constant_id = 2) const uint batch_parts = 0xffffffffu;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer FunctionCode {
  ScarpInstruction instructions[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer FunctionRays { ScarpFunctionRay rays[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer FunctionHits { ScarpFunctionHit hits[]; };
layout(push_constant, scalar) uniform Push { FunctionBatch batch; };

ScarpInstruction scarp_instruction(uint i) { return FunctionCode(batch.code).instructions[i]; }
bool scarp_uses(uint part) { return (batch_parts & (1u << part)) != 0u; }

#endif

SCARP_GLSL_END

#endif
