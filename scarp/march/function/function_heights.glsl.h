// SPDX-License-Identifier: MIT
// Heights of a terrain function for shaders: an interpreter of its program (field/function_program.h), whose
// instructions are data. One shader runs every function.
//
// Registers hold two floats because positions do: far from the origin a single float does not resolve the position
// within a noise cell. Noise itself is computed in floats. function_single.h bounds the error of heights.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0. The including file must define
//
//   ScarpInstruction scarp_instruction(uint i);      the i-th of the program
//   bool scarp_uses(uint part);                      whether the program contains an instruction, or kScarpNoiseBit +
//                                                    kind; true is always valid, constants let compilers drop the rest
#ifndef SCARP_MARCH_FUNCTION_HEIGHTS_GLSL_H
#define SCARP_MARCH_FUNCTION_HEIGHTS_GLSL_H

#include "scarp/accel/function_buffers.glsl.h"
#include "scarp/march/function/noise.glsl.h"
#include "scarp/march/two_float.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Defined by the including file.
ScarpInstruction scarp_instruction(uint i);
bool scarp_uses(uint part);

/// Returns whether an instruction is this one; constant false if no program contains it.
SCARP_FN bool scarp_is(ScarpInstruction at, uint op) { return scarp_uses(op) && at.op == op; }

/// A program and its result register.
struct ScarpProgram {
  uint count;   ///< number of instructions
  uint result;  ///< register
};

/// Returns the first constant of an instruction as two floats.
SCARP_FN ScarpTwoFloat scarp_k0(ScarpInstruction at) {
  ScarpTwoFloat k;
  k.high = at.k0;
  k.low = at.k0_low;
  return k;
}
/// Returns the second constant.
SCARP_FN ScarpTwoFloat scarp_k1(ScarpInstruction at) {
  ScarpTwoFloat k;
  k.high = at.k1;
  k.low = at.k1_low;
  return k;
}
/// Returns the third constant.
SCARP_FN ScarpTwoFloat scarp_k2(ScarpInstruction at) {
  ScarpTwoFloat k;
  k.high = at.k2;
  k.low = at.k2_low;
  return k;
}

/// Sine and cosine, accurate to 2^-22 and 2^-43 of the angle: removes quarter turns, then evaluates a polynomial. For
/// angles below 2^40.
SCARP_FN void scarp_sine(ScarpTwoFloat angle, SCARP_OUT(float) sine, SCARP_OUT(float) cosine) {
  // Twice: for large angles the first pass leaves the error of the float number of turns.
  ScarpTwoFloat turn;  // -2 pi
  turn.high = -6.283185482025146484375f;
  turn.low = 1.74845553e-7f;
  float turns = floor(angle.high * 0.15915494f + 0.5f);
  ScarpTwoFloat left = scarp_two_add(angle, scarp_two_multiply(scarp_two(turns), turn));
  turns = floor(left.high * 0.15915494f + 0.5f);
  left = scarp_two_add(left, scarp_two_multiply(scarp_two(turns), turn));
  float quarters = floor(left.high * 0.63661977f + 0.5f);
  ScarpTwoFloat quarter;  // -pi / 2
  quarter.high = -1.57079637050628662109375f;
  quarter.low = 4.37113883e-8f;
  float x = scarp_two_add(left, scarp_two_multiply(scarp_two(quarters), quarter)).high;
  // The series up to x^9 and x^8: the remainder is below 2^-23 for |x| <= pi / 4.
  float x2 = x * x;
  float s = x + x * x2 * (-0.16666667f + x2 * (0.0083333333f + x2 * (-0.00019841270f + x2 * 2.7557319e-6f)));
  float c = 1.0f + x2 * (-0.5f + x2 * (0.041666667f + x2 * (-0.0013888889f + x2 * 2.4801587e-5f)));
  bool swaps = abs(quarters) == 1.0f;
  sine = swaps ? quarters * c : abs(quarters) == 2.0f ? -s : s;
  cosine = swaps ? -quarters * s : abs(quarters) == 2.0f ? -c : c;
}

/// Weight of a in the smooth minimum of a and b = a - apart.
SCARP_FN float scarp_smooth_share(float apart, float radius) { return clamp(0.5f - 0.5f * apart / radius, 0.0f, 1.0f); }
/// Returns the minimum of a and b; if they are within `radius` of each other, lower than both by up to radius / 4.
SCARP_FN ScarpTwoFloat scarp_smooth_minimum(ScarpTwoFloat a, ScarpTwoFloat b, float radius) {
  float apart = scarp_two_add(a, scarp_two_negate(b)).high;
  float t = scarp_smooth_share(apart, radius);
  return scarp_two_add(b, scarp_two(t * apart - radius * t * (1.0f - t)));
}

/// Returns a in steps of `step`, rising in the last `rise` of each.
SCARP_FN ScarpTwoFloat scarp_terrace(ScarpTwoFloat a, ScarpTwoFloat step, ScarpTwoFloat per_step, float rise) {
  ScarpLattice at = scarp_lattice(scarp_two_multiply(a, per_step));
  float phase = clamp((at.place - (1.0f - rise)) / rise, 0.0f, 1.0f);
  return scarp_two_multiply(step, scarp_two_add(at.whole, scarp_two(scarp_fade(phase))));
}

/// Returns the mask at distance sqrt(dx^2 + dy^2) from its centre.
SCARP_FN float scarp_radial(float dx, float dy, float inner, float outer) {
  return scarp_fade(clamp((outer - sqrt(dx * dx + dy * dy)) / (outer - inner), 0.0f, 1.0f));
}

/// Returns the noise of an instruction.
SCARP_FN ScarpNoise scarp_program_noise(ScarpInstruction at, ScarpTwoFloat x, ScarpTwoFloat y) {
  if (at.kind == kScarpSimplexNoise && scarp_uses(kScarpNoiseBit + kScarpSimplexNoise))
    return scarp_simplex_noise(at.seed, x, y);
  if (at.kind == kScarpPerlinNoise && scarp_uses(kScarpNoiseBit + kScarpPerlinNoise))
    return scarp_perlin_noise(at.seed, scarp_lattice(x), scarp_lattice(y));
  return scarp_value_noise(at.seed, scarp_lattice(x), scarp_lattice(y));
}

/// Returns the height at (x, y), in metres.
SCARP_FN ScarpTwoFloat scarp_height(ScarpProgram program, ScarpTwoFloat x, ScarpTwoFloat y) {
  ScarpTwoFloat r[kScarpRegisters];
  r[0] = x;
  r[1] = y;
  for (uint i = 0u; i < program.count; ++i) {
    ScarpInstruction at = scarp_instruction(i);
    ScarpTwoFloat a = r[at.a];
    ScarpTwoFloat b = r[at.b];
    ScarpTwoFloat to = a;
    if (scarp_is(at, kScarpConstant)) {
      to = scarp_k0(at);
    } else if (scarp_is(at, kScarpCombine)) {
      to = scarp_two_combine(scarp_k0(at), a, scarp_k1(at), b, scarp_k2(at));
    } else if (scarp_is(at, kScarpTurn)) {
      ScarpTwoFloat none = scarp_two(0.0f);
      to = scarp_two_combine(scarp_k0(at), a, scarp_two_negate(scarp_k1(at)), b, none);
      r[at.to_x] = scarp_two_combine(scarp_k1(at), a, scarp_k0(at), b, none);
    } else if (scarp_is(at, kScarpMultiply)) {
      to = scarp_two_multiply(a, b);
    } else if (scarp_is(at, kScarpSquare)) {
      to = scarp_two_multiply(a, a);
    } else if (scarp_is(at, kScarpAbsolute)) {
      if (a.high < 0.0f) to = scarp_two_negate(a);
    } else if (scarp_is(at, kScarpClamp)) {
      if (scarp_two_less(a, scarp_k0(at))) to = scarp_k0(at);
      if (scarp_two_less(scarp_k1(at), a)) to = scarp_k1(at);
    } else if (scarp_is(at, kScarpSine)) {
      float sine;
      float cosine;
      scarp_sine(a, sine, cosine);
      to = scarp_two(sine);
    } else if (scarp_is(at, kScarpMinimum)) {
      if (scarp_two_less(b, a)) to = b;
    } else if (scarp_is(at, kScarpMaximum)) {
      if (scarp_two_less(a, b)) to = b;
    } else if (scarp_is(at, kScarpSmoothMinimum)) {
      to = scarp_smooth_minimum(a, b, at.k0);
    } else if (scarp_is(at, kScarpReciprocal)) {
      to = scarp_two(1.0f / a.high);
    } else if (scarp_is(at, kScarpNoiseOp) || scarp_is(at, kScarpNoiseSlope)) {
      ScarpNoise noise = scarp_program_noise(at, a, b);
      to = scarp_two(noise.n);
      if (at.op == kScarpNoiseSlope) {
        r[at.to_x] = scarp_two(noise.x);
        r[at.to_y] = scarp_two(noise.y);
      }
    } else if (scarp_is(at, kScarpTerrace)) {
      to = scarp_terrace(a, scarp_k0(at), scarp_k2(at), at.k1);
    } else if (scarp_is(at, kScarpRadial)) {
      float dx = scarp_two_add(a, scarp_two_negate(scarp_k0(at))).high;
      float dy = scarp_two_add(b, scarp_two_negate(scarp_k1(at))).high;
      to = scarp_two(scarp_radial(dx, dy, at.k2, at.k3));
    }
    r[at.to] = to;
  }
  return r[program.result];
}

SCARP_GLSL_END

#endif
