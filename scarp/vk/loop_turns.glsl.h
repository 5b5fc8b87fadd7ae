// SPDX-License-Identifier: MIT
// Iteration limit for shader loops, in C++ and GLSL.
//
// Mesa's lavapipe silently leaves all loops of an invocation after 65,535 iterations in total
// (LP_MAX_TGSI_LOOP_ITERATIONS of llvmpipe). Invocations share a vector, so an iteration counts if any of them executes
// it. Other drivers stop shaders that run for seconds. Loops therefore stop earlier and continue in the next run.
//
// After a loop, Mesa 22.3's lavapipe also takes values that each iteration recomputes from the last invocation in the
// vector. A value that is used after a loop must therefore be carried from iteration to iteration, or be set before a
// `break`.
#ifndef SCARP_VK_LOOP_TURNS_GLSL_H
#define SCARP_VK_LOOP_TURNS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Maximum loop iterations per invocation and run. A tenth of lavapipe's limit remains for short loops that are not
/// counted.
const int kScarpLoopTurns = 60000;

SCARP_GLSL_END

#endif
