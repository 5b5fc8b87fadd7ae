// SPDX-License-Identifier: MIT
// Noise in the plane for shaders: field/noise.h in single precision, on a bit-identical lattice.
//
//   position, two floats ──▶ lattice point, an integer modulo 2^32, exact ──▶ hash, identical on all machines
//                       └──▶ position in the cell, 0 to 1, a float ──▶ noise and its derivatives
//
// The low half keeps what a single float loses far from the origin, so noise is as accurate there as at the origin. Its
// error bounds are derived in doc/dev/numerics.md ("Functions in single precision"), see scarp_noise_bound(). Sources:
// those of field/noise.h.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0. Has no dependencies.
#ifndef SCARP_MARCH_NOISE_GLSL_H
#define SCARP_MARCH_NOISE_GLSL_H

#include "scarp/march/two_float.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

// Values of NoiseKind.
const uint kScarpValueNoise = 0u;
const uint kScarpPerlinNoise = 1u;
const uint kScarpSimplexNoise = 2u;

/// Noise, its gradient and its second derivatives at a point.
struct ScarpNoise {
  float n;
  float x, y;
  float xx, xy, yy;
};

/// Bounds that hold everywhere (NoiseBound), and error bounds of computed values.
struct ScarpNoiseBound {
  float height, slope, curvature, third;
  float n_off, slope_off, curvature_off;
};
/// Returns the bounds of a kind of noise; numerics.md derives them.
SCARP_FN ScarpNoiseBound scarp_noise_bound(uint kind) {
  ScarpNoiseBound bound;
  bound.height = 1.0f;
  bound.n_off = 7.62939453125e-6f;        // 2^-17
  bound.slope_off = 3.0517578125e-5f;     // 2^-15
  bound.curvature_off = 1.220703125e-4f;  // 2^-13
  if (kind == kScarpValueNoise) {
    bound.n_off = 3.814697265625e-6f;     // 2^-18
    bound.slope_off = 7.62939453125e-6f;  // 2^-17
    bound.slope = 3.77f;
    bound.curvature = 14.14f;
    bound.third = 120.6f;
  } else if (kind == kScarpPerlinNoise) {
    bound.height = 1.001f;
    bound.slope = 2.95f;
    bound.curvature = 13.2f;
    bound.third = 138.5f;
  } else {
    bound.slope = 7.38f;
    bound.curvature = 56.0f;
    bound.third = 533.0f;
    bound.n_off = 3.0517578125e-5f;     // 2^-15
    bound.slope_off = 4.8828125e-4f;    // 2^-11
    bound.curvature_off = 3.90625e-3f;  // 2^-8
  }
  return bound;
}

/// Mixes the bits of a number, as field/noise.h does.
SCARP_FN uint scarp_mix(uint x) {
  uint a = (x ^ (x >> 16)) * 0x7feb352du;
  uint b = (a ^ (a >> 15)) * 0x846ca68bu;
  return b ^ (b >> 16);
}
/// Hash of a lattice point, lattice_hash() of field/noise.h.
SCARP_FN uint scarp_lattice_hash(uint seed, uint i, uint j) { return scarp_mix(scarp_mix(seed + i) + j); }
/// Returns a number in [-1, 1): the first 24 bits of lattice_value().
SCARP_FN float scarp_lattice_value(uint hash) { return float(hash >> 8) * 1.1920928955078125e-7f - 1.0f; }
/// Returns one of 12 directions of length 1, lattice_direction().
SCARP_FN vec2 scarp_lattice_direction(uint hash) {
  // hash * 12 / 2^32 in 32 bits: a quarter turn, and one of three directions in it.
  uint k = ((hash >> 16) * 12u + (((hash & 0xffffu) * 12u) >> 16)) >> 16;
  uint quarter = k / 3u;
  uint third = k - quarter * 3u;
  float x = third == 0u ? 1.0f : third == 1u ? 0.8f : 0.6f;
  float y = third == 0u ? 0.0f : third == 1u ? 0.6f : 0.8f;
  return quarter == 0u ? vec2(x, y) : quarter == 1u ? vec2(-y, x) : quarter == 2u ? vec2(-x, -y) : vec2(y, -x);
}

/// A position along one axis of the lattice.
struct ScarpLattice {
  uint cell;            ///< modulo 2^32
  ScarpTwoFloat whole;  ///< the cell's integer, as far as two floats represent it
  float place;          ///< position in it, 0..1, both ends included
};
/// Returns an integer below 2^48 modulo 2^32.
SCARP_FN uint scarp_wrapped(float whole) {
  float high = floor(whole * 1.52587890625e-5f);  // 2^-16
  float low = whole - high * 65536.0f;
  float rest = high - floor(high * 1.52587890625e-5f) * 65536.0f;
  return (uint(rest) << 16) + uint(low);
}
/// Splits a coordinate in lattice cells.
SCARP_FN ScarpLattice scarp_lattice(ScarpTwoFloat p) {
  float whole = floor(p.high);
  SCARP_PRECISE float rest = (p.high - whole) + p.low;
  float carry = floor(rest);
  ScarpLattice at;
  at.cell = scarp_wrapped(whole) + uint(int(carry));
  at.whole = scarp_two_sum(whole, carry);
  at.place = rest - carry;
  return at;
}

/// Quintic fade from 0 to 1; evaluated from its nearer end, which keeps its error below 7 units.
SCARP_FN float scarp_fade(float t) {
  float r = min(t, 1.0f - t);
  SCARP_PRECISE float f = r * r * r * (r * (r * 6.0f - 15.0f) + 10.0f);
  return t < 0.5f ? f : 1.0f - f;
}
/// First derivative of the fade.
SCARP_FN float scarp_fade_slope(float t) { return 30.0f * (t * t) * ((t - 1.0f) * (t - 1.0f)); }
/// Second derivative of the fade.
SCARP_FN float scarp_fade_curvature(float t) { return 60.0f * t * (t * 2.0f - 1.0f) * (t - 1.0f); }
/// Linear interpolation: a at t = 0, b at t = 1.
SCARP_FN float scarp_lerp(float a, float b, float t) { return a + t * (b - a); }

/// Value noise: numbers at the corners, blended by the fade, with derivatives per lattice cell; errors within
/// scarp_noise_bound().
SCARP_FN ScarpNoise scarp_value_noise(uint seed, ScarpLattice x, ScarpLattice y) {
  uint west = scarp_mix(seed + x.cell);
  uint east_side = scarp_mix(seed + (x.cell + 1u));
  float a = scarp_lattice_value(scarp_mix(west + y.cell));
  float b = scarp_lattice_value(scarp_mix(east_side + y.cell));
  float c = scarp_lattice_value(scarp_mix(west + (y.cell + 1u)));
  float d = scarp_lattice_value(scarp_mix(east_side + (y.cell + 1u)));
  float u = scarp_fade(x.place);
  float v = scarp_fade(y.place);
  float du = scarp_fade_slope(x.place);
  float dv = scarp_fade_slope(y.place);
  float east = scarp_lerp(b - a, d - c, v);
  float north = scarp_lerp(c - a, d - b, u);
  ScarpNoise noise;
  noise.n = scarp_lerp(scarp_lerp(a, b, u), scarp_lerp(c, d, u), v);
  noise.x = du * east;
  noise.y = dv * north;
  noise.xx = scarp_fade_curvature(x.place) * east;
  noise.yy = scarp_fade_curvature(y.place) * north;
  noise.xy = du * dv * ((d - c) - (b - a));
  return noise;
}

/// Perlin noise: slopes at the corners, blended by the fade, with derivatives per lattice cell; errors within
/// scarp_noise_bound().
SCARP_FN ScarpNoise scarp_perlin_noise(uint seed, ScarpLattice x, ScarpLattice y) {
  const float kScale = 1.41421356f;
  uint west = scarp_mix(seed + x.cell);
  uint east_side = scarp_mix(seed + (x.cell + 1u));
  vec2 a = scarp_lattice_direction(scarp_mix(west + y.cell));
  vec2 b = scarp_lattice_direction(scarp_mix(east_side + y.cell));
  vec2 c = scarp_lattice_direction(scarp_mix(west + (y.cell + 1u)));
  vec2 d = scarp_lattice_direction(scarp_mix(east_side + (y.cell + 1u)));
  float dx = x.place;
  float dy = y.place;
  float na = a.x * dx + a.y * dy;
  float nb = b.x * (dx - 1.0f) + b.y * dy;
  float nc = c.x * dx + c.y * (dy - 1.0f);
  float nd = d.x * (dx - 1.0f) + d.y * (dy - 1.0f);
  float u = scarp_fade(dx);
  float v = scarp_fade(dy);
  float fu = scarp_fade_slope(dx);
  float fv = scarp_fade_slope(dy);
  float du = kScale * fu;
  float dv = kScale * fv;
  float east = scarp_lerp(nb - na, nd - nc, v);
  float north = scarp_lerp(nc - na, nd - nb, u);
  ScarpNoise noise;
  noise.n = kScale * scarp_lerp(scarp_lerp(na, nb, u), scarp_lerp(nc, nd, u), v);
  noise.x = kScale * scarp_lerp(scarp_lerp(a.x, b.x, u), scarp_lerp(c.x, d.x, u), v) + du * east;
  noise.y = kScale * scarp_lerp(scarp_lerp(a.y, b.y, u), scarp_lerp(c.y, d.y, u), v) + dv * north;
  noise.xx = 2.0f * du * scarp_lerp(b.x - a.x, d.x - c.x, v) + kScale * scarp_fade_curvature(dx) * east;
  noise.yy = 2.0f * dv * scarp_lerp(c.y - a.y, d.y - b.y, u) + kScale * scarp_fade_curvature(dy) * north;
  noise.xy = dv * scarp_lerp(c.x - a.x, d.x - b.x, u) + du * scarp_lerp(b.y - a.y, d.y - c.y, v) +
             du * fv * ((nd - nc) - (nb - na));
  return noise;
}

/// Adds the contribution of a triangle corner to a point at (dx, dy) from it.
SCARP_FN void scarp_simplex_corner(uint hash, float dx, float dy, SCARP_INOUT(ScarpNoise) noise) {
  float m = 0.5f - dx * dx - dy * dy;
  if (m <= 0.0f) return;
  vec2 g = scarp_lattice_direction(hash);
  float gx = 99.0f * g.x;
  float gy = 99.0f * g.y;
  float plane = gx * dx + gy * dy;
  float m2 = m * m;
  float k = 8.0f * m2 * m;
  noise.n += m2 * m2 * plane;
  noise.x += m2 * m2 * gx - k * dx * plane;
  noise.y += m2 * m2 * gy - k * dy * plane;
  noise.xx += (48.0f * m2 * dx * dx - k) * plane - 2.0f * k * dx * gx;
  noise.yy += (48.0f * m2 * dy * dy - k) * plane - 2.0f * k * dy * gy;
  noise.xy += 48.0f * m2 * dx * dy * plane - k * (dx * gy + dy * gx);
}

/// Simplex noise: slopes at the corners of triangles, with x and y in units of the noise, as in field/noise.h. Errors
/// within scarp_noise_bound().
SCARP_FN ScarpNoise scarp_simplex_noise(uint seed, ScarpTwoFloat x, ScarpTwoFloat y) {
  ScarpTwoFloat skew;  // (sqrt(3) - 1) / 2
  skew.high = 0.3660254180431365966796875f;
  skew.low = -1.42586982e-8f;
  ScarpTwoFloat unskew;  // (3 - sqrt(3)) / 6
  unskew.high = 0.211324870586395263671875f;
  unskew.low = -5.18120835e-9f;
  ScarpTwoFloat skewed = scarp_two_multiply(scarp_two_add(x, y), skew);
  ScarpLattice i = scarp_lattice(scarp_two_add(x, skewed));
  ScarpLattice j = scarp_lattice(scarp_two_add(y, skewed));
  ScarpTwoFloat back = scarp_two_multiply(scarp_two_add(i.whole, j.whole), unskew);
  float x0 = scarp_two_add(scarp_two_add(x, scarp_two_negate(i.whole)), back).high;
  float y0 = scarp_two_add(scarp_two_add(y, scarp_two_negate(j.whole)), back).high;
  // Which of the two triangles of the rhombus.
  uint east = x0 > y0 ? 1u : 0u;
  ScarpNoise noise;
  noise.n = 0.0f;
  noise.x = 0.0f;
  noise.y = 0.0f;
  noise.xx = 0.0f;
  noise.xy = 0.0f;
  noise.yy = 0.0f;
  // No loop: callers that run noise programs count loop iterations (function_batch.glsl.h).
  scarp_simplex_corner(scarp_lattice_hash(seed, i.cell, j.cell), x0, y0, noise);
  scarp_simplex_corner(scarp_lattice_hash(seed, i.cell + east, j.cell + (1u - east)), x0 - (float(east) - unskew.high),
                       y0 - (float(1u - east) - unskew.high), noise);
  scarp_simplex_corner(scarp_lattice_hash(seed, i.cell + 1u, j.cell + 1u), x0 - (1.0f - 2.0f * unskew.high),
                       y0 - (1.0f - 2.0f * unskew.high), noise);
  return noise;
}

/// Returns noise of a kind at a position, with its derivatives. |x| and |y| must be below 2^47.
SCARP_FN ScarpNoise scarp_noise(uint kind, uint seed, ScarpTwoFloat x, ScarpTwoFloat y) {
  if (kind == kScarpSimplexNoise) return scarp_simplex_noise(seed, x, y);
  if (kind == kScarpPerlinNoise) return scarp_perlin_noise(seed, scarp_lattice(x), scarp_lattice(y));
  return scarp_value_noise(seed, scarp_lattice(x), scarp_lattice(y));
}

SCARP_GLSL_END

#endif
