// SPDX-License-Identifier: MIT
// Distances of shapes for shaders: an interpreter of the program of a distance field (field/distance_program.h), in
// floats; the formulas are those of field/distance_solids.h. Error bounds: doc/dev/numerics.md, "Distance fields in
// single precision".
//
// Compiles as C++ and GLSL, including GLSL ES 3.0. The including file must define
//
//   ScarpShapeInstruction scarp_shape_instruction(uint i);      the i-th of the program
//   float scarp_shape_number(uint i);                           the i-th of its constants
//   bool scarp_shape_uses(uint op);                             whether an instruction is in it; true is always valid
//   float scarp_shape_function(uint index, float x, float y);   height of the index-th ground, a function's
//   float scarp_shape_field(uint index, vec3 q, float shrink);  scarp_field_ground() of shape_grounds.glsl.h
#ifndef SCARP_MARCH_SHAPE_DISTANCE_GLSL_H
#define SCARP_MARCH_SHAPE_DISTANCE_GLSL_H

#include "scarp/accel/shape_buffers.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// Defined by the including file.
ScarpShapeInstruction scarp_shape_instruction(uint i);
float scarp_shape_number(uint i);
bool scarp_shape_uses(uint op);
float scarp_shape_function(uint index, float x, float y);
float scarp_shape_field(uint index, vec3 q, float shrink);

/// Maximum coordinate of terrain functions, in metres from their origin in x and y; beyond it the ground is constant.
const float kScarpFunctionReach = 1073741824.0f;

/// Returns the length of a 2D vector.
SCARP_FN float scarp_length2(float x, float y) { return sqrt(x * x + y * y); }
/// Returns the length of a 3D vector.
SCARP_FN float scarp_length3(float x, float y, float z) { return sqrt(x * x + y * y + z * z); }
/// Returns three of the program's constants, from the k-th on.
SCARP_FN vec3 scarp_numbers3(uint k) {
  return vec3(scarp_shape_number(k), scarp_shape_number(k + 1u), scarp_shape_number(k + 2u));
}

/// Returns the distance to the quadrant where all coordinates are negative.
SCARP_FN float scarp_corner2(float x, float y) {
  return scarp_length2(max(x, 0.0f), max(y, 0.0f)) + min(max(x, y), 0.0f);
}
/// Returns the distance to the octant where all coordinates are negative.
SCARP_FN float scarp_corner3(float x, float y, float z) {
  return scarp_length3(max(x, 0.0f), max(y, 0.0f), max(z, 0.0f)) + min(max(max(x, y), z), 0.0f);
}

/// Returns the distance to a cone, upright about the origin, given its radii at the lower and the upper end and half
/// its height.
SCARP_FN float scarp_cone(vec3 q, float below, float above, float half_) {
  float r = scarp_length2(q.x, q.y);
  float beyond = abs(q.z) - half_;
  // To the nearer disc, and to the side, at the fraction `along` of its length from the upper end.
  float disc = scarp_length2(max(r - (q.z < 0.0f ? below : above), 0.0f), beyond);
  float dr = below - above;
  float dz = -2.0f * half_;
  float along = clamp(((r - above) * dr + (q.z - half_) * dz) / (dr * dr + dz * dz), 0.0f, 1.0f);
  float side_r = r - (above + along * dr);
  float side_z = q.z - (half_ + along * dz);
  float away = min(disc, scarp_length2(side_r, side_z));
  return side_r < 0.0f && beyond < 0.0f ? -away : away;
}

/// Returns a solid's value at a position; its constants start at k.
SCARP_FN float scarp_solid(uint op, uint k, vec3 p) {
  vec3 first = scarp_numbers3(k);
  vec3 n = scarp_numbers3(k + 3u);
  vec3 q = vec3(p.x - first.x, p.y - first.y, p.z - first.z);
  if (scarp_shape_uses(kScarpShapeSphere) && op == kScarpShapeSphere) return scarp_length3(q.x, q.y, q.z) - n.x;
  if (scarp_shape_uses(kScarpShapeBox) && op == kScarpShapeBox)
    return scarp_corner3(abs(q.x) - n.x, abs(q.y) - n.y, abs(q.z) - n.z) - scarp_shape_number(k + 6u);
  if (scarp_shape_uses(kScarpShapePlane) && op == kScarpShapePlane)
    return first.x * p.x + first.y * p.y + first.z * p.z - n.x;
  if (scarp_shape_uses(kScarpShapeCapsule) && op == kScarpShapeCapsule)
    return scarp_length3(q.x, q.y, max(abs(q.z) - n.x, 0.0f)) - n.y;
  if (scarp_shape_uses(kScarpShapeCylinder) && op == kScarpShapeCylinder)
    return scarp_corner2(scarp_length2(q.x, q.y) - n.x, abs(q.z) - n.y);
  if (scarp_shape_uses(kScarpShapeCone) && op == kScarpShapeCone) return scarp_cone(q, n.x, n.y, n.z);
  if (scarp_shape_uses(kScarpShapeTorus) && op == kScarpShapeTorus)
    return scarp_length2(scarp_length2(q.x, q.y) - n.x, q.z) - n.y;
  return (scarp_length3(q.x / n.x, q.y / n.y, q.z / n.z) - 1.0f) * scarp_shape_number(k + 6u);
}

/// Returns the smaller of two distances; if they are within `radius` of each other, less than both by up to radius / 4.
SCARP_FN float scarp_smooth_union(float a, float b, float radius) {
  float t = clamp(0.5f + 0.5f * (b - a) / radius, 0.0f, 1.0f);
  return b + t * (a - b) - radius * t * (1.0f - t);
}

/// Returns the distance to a box, 0 inside; k: low, high.
SCARP_FN float scarp_outside(vec3 p, uint k) {
  vec3 low = scarp_numbers3(k);
  vec3 high = scarp_numbers3(k + 3u);
  return scarp_length3(max(max(low.x - p.x, p.x - high.x), 0.0f), max(max(low.y - p.y, p.y - high.y), 0.0f),
                       max(max(low.z - p.z, p.z - high.z), 0.0f));
}

/// Index of the nearest copy along an axis, and the offset from its centre.
struct ScarpCopy {
  float number;
  float off;
  float period;
  float count;
  float half_;
};
/// Returns the copy nearest to a coordinate; k: the first constant of the repetition, axis: 0 to 2.
SCARP_FN ScarpCopy scarp_nearest_copy(float p, uint k, uint axis) {
  ScarpCopy copy;
  copy.period = scarp_shape_number(k + 3u + axis);
  copy.count = scarp_shape_number(k + 6u + axis);
  copy.half_ = scarp_shape_number(k + 9u + axis);
  float away = p - scarp_shape_number(k + axis);
  copy.number = 0.0f;
  copy.off = away;
  if (copy.period != 0.0f) {
    float number = floor(away / copy.period + 0.5f);
    if (copy.count > 0.0f) number = clamp(number, -copy.count, copy.count);
    copy.number = number;
    copy.off = away - number * copy.period;
  }
  return copy;
}
/// Returns a coordinate in the frame of the nearest copy, or of the adjacent one.
SCARP_FN float scarp_folded(float p, uint k, uint axis, bool next) {
  ScarpCopy copy = scarp_nearest_copy(p, k, axis);
  float number = copy.number + (next ? (copy.off < 0.0f ? -1.0f : 1.0f) : 0.0f);
  return p - number * copy.period;
}
/// Returns a position in the frame of a copy; a bit of the mask per axis selects the adjacent copy.
SCARP_FN vec3 scarp_folded3(vec3 p, uint k, uint mask) {
  return vec3(scarp_folded(p.x, k, 0u, (mask & 1u) != 0u), scarp_folded(p.y, k, 1u, (mask & 2u) != 0u),
              scarp_folded(p.z, k, 2u, (mask & 4u) != 0u));
}
/// Returns a lower bound of the distance to a copy along an axis: the nearest, or its neighbour on the position's side;
/// kScarpEndless if there is none.
SCARP_FN float scarp_copy_away(float p, uint k, uint axis, bool next) {
  ScarpCopy copy = scarp_nearest_copy(p, k, axis);
  float away = abs(copy.off);
  if (next) {
    bool there = copy.count == 0.0f || (copy.off < 0.0f ? copy.number > -copy.count : copy.count > copy.number);
    if (!there) return kScarpEndless;
    away = copy.period - away;
  }
  return max(away - copy.half_, 0.0f);
}
/// Returns a lower bound of the distance to the copy selected by a mask; kScarpEndless if there is none.
SCARP_FN float scarp_neighbour_bound(vec3 p, uint k, uint mask) {
  float x = scarp_copy_away(p.x, k, 0u, (mask & 1u) != 0u);
  float y = scarp_copy_away(p.y, k, 1u, (mask & 2u) != 0u);
  float z = scarp_copy_away(p.z, k, 2u, (mask & 4u) != 0u);
  if (max(max(x, y), z) >= kScarpEndless) return kScarpEndless;
  return scarp_length3(x, y, z);
}
/// Returns a lower bound of the distance to all copies except the nearest and its neighbours.
SCARP_FN float scarp_rest_bound(vec3 p, uint k) {
  ScarpCopy x = scarp_nearest_copy(p.x, k, 0u);
  ScarpCopy y = scarp_nearest_copy(p.y, k, 1u);
  ScarpCopy z = scarp_nearest_copy(p.z, k, 2u);
  float near_x = max(abs(x.off) - x.half_, 0.0f);
  float near_y = max(abs(y.off) - y.half_, 0.0f);
  float near_z = max(abs(z.off) - z.half_, 0.0f);
  float least = kScarpEndless;
  if (x.period != 0.0f) least = min(least, scarp_length3(max(abs(x.off) + x.period - x.half_, 0.0f), near_y, near_z));
  if (y.period != 0.0f) least = min(least, scarp_length3(near_x, max(abs(y.off) + y.period - y.half_, 0.0f), near_z));
  if (z.period != 0.0f) least = min(least, scarp_length3(near_x, near_y, max(abs(z.off) + z.period - z.half_, 0.0f)));
  return least;
}

/// Returns the value of a ground at a position.
SCARP_FN float scarp_ground(ScarpShapeInstruction at, uint k, vec3 p) {
  vec3 c = scarp_numbers3(k);
  float scale = scarp_shape_number(k + 3u);
  float shrink = scarp_shape_number(k + 4u);
  vec3 q = vec3((p.x - c.x) / scale, (p.y - c.y) / scale, (p.z - c.z) / scale);
  float value = 0.0f;
  if (scarp_shape_uses(kScarpShapeFunctionGround) && at.op == kScarpShapeFunctionGround) {
    float x = clamp(q.x, -kScarpFunctionReach, kScarpFunctionReach);
    float y = clamp(q.y, -kScarpFunctionReach, kScarpFunctionReach);
    value = (q.z - scarp_shape_function(at.index, x, y)) * shrink;
  } else if (scarp_shape_uses(kScarpShapeFieldGround)) {
    value = scarp_shape_field(at.index, q, shrink);
  }
  return value * scale;
}

/// Returns the value at a position: at most the distance to the surface, negative inside.
SCARP_FN float scarp_shape_distance(uint count, vec3 position) {
  vec3 p[kScarpShapeRegisters];
  float v[kScarpShapeRegisters];
  p[0] = position;
  v[0] = 0.0f;
  for (uint i = 0u; i < count; ++i) {
    ScarpShapeInstruction at = scarp_shape_instruction(i);
    uint k = at.number;
    if (at.op <= kScarpShapeNeighbour) {
      vec3 from = p[at.a];
      vec3 to = from;
      if (at.op == kScarpShapeTurn) {
        vec3 c = scarp_numbers3(k);
        vec3 q = vec3(from.x - c.x, from.y - c.y, from.z - c.z);
        vec3 r0 = scarp_numbers3(k + 3u);
        vec3 r1 = scarp_numbers3(k + 6u);
        vec3 r2 = scarp_numbers3(k + 9u);
        to = vec3(r0.x * q.x + r0.y * q.y + r0.z * q.z, r1.x * q.x + r1.y * q.y + r1.z * q.z,
                  r2.x * q.x + r2.y * q.y + r2.z * q.z);
      } else if (scarp_shape_uses(kScarpShapeFold)) {
        to = scarp_folded3(from, k, at.op == kScarpShapeFold ? 0u : at.mask);
      }
      p[at.to] = to;
    } else if (at.op <= kScarpShapeEllipsoid) {
      v[at.to] = scarp_solid(at.op, k, p[at.a]);
    } else if (at.op <= kScarpShapeFieldGround) {
      v[at.to] = scarp_ground(at, k, p[at.a]);
    } else if (at.op <= kScarpShapeSmoothSubtract) {
      // max(a, b) = -min(-a, -b); subtraction intersects with the complement of b.
      bool unites = at.op == kScarpShapeUnite || at.op == kScarpShapeSmoothUnite;
      bool cuts = at.op == kScarpShapeSubtract || at.op == kScarpShapeSmoothSubtract;
      float a = unites ? v[at.a] : -v[at.a];
      float b = unites || cuts ? v[at.b] : -v[at.b];
      float least = min(a, b);
      if (at.op >= kScarpShapeSmoothUnite) least = scarp_smooth_union(a, b, scarp_shape_number(k));
      v[at.to] = unites ? least : -least;
    } else if (at.op == kScarpShapeClamp) {
      float away = scarp_outside(p[at.b], k);
      v[at.to] = away > 0.0f ? max(v[at.a], away) : v[at.a];
    } else if (at.op == kScarpShapeRestBound) {
      v[at.to] =
          at.mask != 0u || !scarp_shape_uses(kScarpShapeFold) ? v[at.a] : min(v[at.a], scarp_rest_bound(p[at.b], k));
    } else if (at.op == kScarpShapeSkipFar) {
      float away = scarp_outside(p[at.b], k);
      float a = at.mask != 0u ? -v[at.a] : v[at.a];
      if (away > 0.0f && a <= away - scarp_shape_number(k + 6u)) i += at.index;
    } else if (scarp_shape_uses(kScarpShapeFold)) {
      float away = scarp_neighbour_bound(p[at.b], k, at.mask);
      if (away > 0.0f && v[at.a] <= away) i += at.index;
    }
  }
  return v[0];
}

SCARP_GLSL_END

#endif
