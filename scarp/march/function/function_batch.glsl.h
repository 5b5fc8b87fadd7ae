// SPDX-License-Identifier: MIT
// A batch of rays over a terrain function on a device: shared by the compute shaders and the C++ code that dispatches
// them (function_queries_vk.h).
//
//   FunctionBatch ──code──▶ ScarpInstruction ...      the function's program
//        │  └─────rays──▶ ScarpFunctionRay ...      one invocation each
//        └────────hits──▶ ScarpFunctionHit ...      the answers, in the same order
#ifndef SCARP_MARCH_FUNCTION_BATCH_GLSL_H
#define SCARP_MARCH_FUNCTION_BATCH_GLSL_H

#include "scarp/accel/function_buffers.glsl.h"
#include "scarp/march/function/function_frame.glsl.h"
#include "scarp/march/sampling/sampling.glsl.h"
#include "scarp/vk/glsl_cpp.h"
#include "scarp/vk/loop_turns.glsl.h"

SCARP_GLSL_BEGIN

// A march is interrupted after run_steps steps and continues in the next run; see loop_turns.glsl.h. The iterations of
// the interpreter count, too; kScarpMostInstructions limits them.
//
// Specialisation constants: threads per workgroup; the march (function_marches.comp), or any hit
// (lipschitz_local.comp); contents of the program (scarp_uses), so that a shader contains only what it needs: some
// drivers execute all branches of an instruction.

/// Evaluations that may follow the last step of a run: bisections, secants, and those at a ray's start and end.
const int kScarpLastEvaluations = 70;
/// Maximum instructions of a program, so that a run has some steps.
const int kScarpMostInstructions = 600;

/// Push constants. lipschitz-local reads only `tolerance` and `max_steps` of the settings.
struct FunctionBatch {
  Address code;
  Address rays;
  Address hits;
  uint count;
  uint instructions;
  uint result;  ///< register
  ScarpSampling settings;
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
