// SPDX-License-Identifier: MIT
// How long loops of a shader may be. C++ and GLSL.
//
// Mesa's lavapipe leaves all loops of an invocation, without a word, after 65,535 turns in all
// (LP_MAX_TGSI_LOOP_ITERATIONS of llvmpipe); invocations share a vector, so that a turn counts when any of them takes
// it. And other drivers stop what takes seconds. So loops are interrupted before, and go on in the next run.
#ifndef SCARP_VK_LOOP_TURNS_GLSL_H
#define SCARP_VK_LOOP_TURNS_GLSL_H

#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Turns of loops in one run of an invocation, at most: a tenth is left for short loops that nobody counts.
const int kScarpLoopTurns = 60000;

SCARP_GLSL_END

#endif
