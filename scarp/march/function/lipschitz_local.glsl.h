// SPDX-License-Identifier: MIT
// `lipschitz-local` for shaders: lipschitz_local.h in single precision, with the same steps from bounds in floats
// (function_bounds.glsl.h).
//
// Guarantee: conservative, including rounding: it misses no crossing. A hit is a crossing, or a touch: a point where
// the bounds of a segment of 2^-22 of the time, or 4 times the rounding of clearances, do not separate the ray from the
// ground. A ray from the surface starts at the height computed there, and may be below the ground by 4 times the width
// of the bounds of a point, until it is proven to be above. Unlike the other implementations, this one needs no bound
// on the ground's slope.
//
// Compiles as C++ and GLSL, including GLSL ES 3.0, which lacks `precise`. The including file must define
// scarp_instruction(), see function_heights.glsl.h.
#ifndef SCARP_MARCH_LIPSCHITZ_LOCAL_GLSL_H
#define SCARP_MARCH_LIPSCHITZ_LOCAL_GLSL_H

#include "scarp/march/function/function_bounds.glsl.h"
#include "scarp/march/function/function_frame.glsl.h"
#include "scarp/vk/glsl_cpp.h"

SCARP_GLSL_BEGIN

/// LipschitzLocalSettings of march_settings.h.
struct ScarpLipschitzLocal {
  float tolerance;  ///< length of the last interval, per unit of distance travelled, >= 0
  int max_steps;    ///< >= 1; beyond it: kScarpFunctionExhausted
  int run_steps;    ///< steps per run, a bound and possibly a height each, before the march is interrupted, >= 1
};

/// Proven facts about a segment: the ray is above the ground until `until`, and below it at `sunk`.
struct ScarpProof {
  float until;
  float sunk;    ///< kScarpNeverSunk: unknown
  float middle;  ///< the bounds are over times middle - half_ to middle + half_, slightly longer than requested
  float half_;
  float begin;  ///< minimum and maximum height above the ground at their start, in metres
  float begin_most;
  float end;  ///< the same at their end
  float end_most;
  float wide;  ///< half the width of the bounds
};
const float kScarpNeverSunk = 1.0e30f;

// As in lipschitz_local_walk.h, except the shortest segment: floats resolve 2^-24 of the time.
const float kScarpShortest = 2.384185791015625e-7f;  // 2^-22 of the time
const float kScarpShort = 0.99999904632568359375f;   // 1 - 2^-20
const float kScarpBeyond = 1.0009765625f;            // 1 + 2^-10
const float kScarpGrowth = 1.3f;
const float kScarpShrink = 0.5f;
const float kScarpRisingGrowth = 1.5f;
const float kScarpRisingClear = 3.0f;
const int kScarpMostSecants = 11;

/// A coordinate over times middle - half to middle + half.
SCARP_FN ScarpBound scarp_coordinate(ScarpTwoFloat mid, float origin, float direction, float half_, float last) {
  ScarpBound t;
  t.mid = mid;
  t.slope = direction * half_;
  t.rest = kScarpTwoSlack * (abs(origin) + abs(direction) * last) + kScarpSlack * abs(t.slope);
  float reach = (abs(t.slope) + t.rest) * (1.0f + kScarpSlack) + kScarpSlack * abs(mid.high);
  t.low = mid.high - reach;
  t.high = mid.high + reach;
  return t;
}

/// Returns the proof for the ray, or for one that is `lift` metres higher.
SCARP_FN ScarpProof scarp_proof(ScarpProgram program, ScarpFunctionRay ray, float lift, float s0, float s1) {
  float middle = 0.5f * (s0 + s1);
  // Longer by the rounding of the middle and the half.
  float half_ = 0.5f * (s1 - s0) * (1.0f + kScarpSlack) + 1.1920928955078125e-7f * s1;
  ScarpBound ground =
      scarp_bound(program, scarp_coordinate(scarp_ray_x(ray, middle), ray.origin.x, ray.direction.x, half_, s1),
                  scarp_coordinate(scarp_ray_y(ray, middle), ray.origin.y, ray.direction.y, half_, s1));
  ScarpTwoFloat z = scarp_ray_z(ray, middle);
  float rise = ray.direction.z * half_;
  ScarpProof proof;
  proof.until = s1;
  proof.sunk = kScarpNeverSunk;
  float lowest = z.high - abs(rise);
  float over = lowest - ground.high + lift - kScarpSlack * (abs(z.high) + abs(rise) + abs(ground.high) + lift);
  // The clearance is within `wide` of mid + slope * s.
  float mid = scarp_two_add(z, scarp_two_negate(ground.mid)).high + lift;
  float slope = rise - ground.slope;
  float wide = ground.rest + kScarpTwoSlack * (abs(ray.origin.z) + abs(ray.direction.z) * s1 + abs(ground.mid.high)) +
               kScarpSlack * (abs(mid) + lift + abs(rise) + abs(ground.slope));
  float begin = mid - slope - wide;
  float end = mid + slope - wide;
  proof.wide = wide;
  proof.middle = middle;
  proof.half_ = half_;
  proof.begin = begin;
  proof.begin_most = begin + 2.0f * wide;
  proof.end = end;
  proof.end_most = end + 2.0f * wide;
  if (over > 0.0f) {
    proof.begin = max(begin, over);
    proof.end = max(end, over);
    return proof;
  }
  // Where a line from s0 to s1, of length 2 half_, is 0, minus the rounding of the time.
  float times = 2.0f * half_;
  float rounded = 2.384185791015625e-7f * s1;
  if (begin <= 0.0f)
    proof.until = s0;
  else if (end <= 0.0f)
    proof.until = max(s0, middle - half_ + (kScarpShort * times * (begin / (begin - end)) - rounded));
  if (proof.end_most < 0.0f) {
    proof.sunk = proof.begin_most > 0.0f
                     ? middle - half_ + (times * (proof.begin_most / (proof.begin_most - proof.end_most)) + rounded)
                     : s0;
  }
  return proof;
}

/// Returns the crossing between s0, above the ground, and s1, where the clearance is h1 <= 0, by secants that weigh the
/// retained end less and less ("Illinois"), until no float is left in between; s0 if the computed clearance there is
/// not positive. Neighbouring clearances share most of their rounding error, so they are useful even below
/// ray.rounding.
SCARP_FN float scarp_crossing(ScarpProgram program, ScarpFunctionRay ray, float s0, float s1, float h1,
                              SCARP_INOUT(ScarpFunctionHit) hit) {
  float from = s0;
  float to = s1;
  float above = 0.0f;
  float below = h1;
  int kept = 0;
  // The first iteration evaluates s0.
  for (int i = 0; i < kScarpMostSecants; ++i) {
    float s = i == 0 ? s0 : from + (to - from) * (above / (above - below));
    if (i > 0 && !(s > from && s < to)) return to;
    hit.heights += 1u;
    float h = scarp_clearance(program, ray, s);
    if (i == 0) {
      above = h;
      if (h <= 0.0f) return s0;
    } else if (h == 0.0f) {
      return s;
    } else if (h > 0.0f) {
      from = s;
      above = h;
      if (kept == 1) below *= 0.5f;
      kept = 1;
    } else {
      to = s;
      below = h;
      if (kept == -1) above *= 0.5f;
      kept = -1;
    }
  }
  return to;
}

// Which bounds the march requests.
const int kScarpAskOpen = 0;     ///< at the start: width of the bounds of a point
const int kScarpAskSegment = 1;  ///< the next segment
const int kScarpAskPoint = 2;    ///< its start, if the segment proves nothing

/// Closest hit over the ground of a program, within its tolerance; with `any`, the hit's time is undefined. Misses no
/// crossing, including rounding (ray.rounding).
SCARP_FN ScarpFunctionHit scarp_lipschitz_local(ScarpProgram program, ScarpFunctionRay ray_,
                                                ScarpLipschitzLocal settings, bool any) {
  ScarpFunctionHit hit = scarp_function_miss();
  ScarpFunctionRay ray = ray_;
  bool from_surface = (ray.flags & kScarpFromSurface) != 0u;
  bool begins = ray.state.steps == 0;
  float s = ray.state.s;
  float length_ = begins ? ray.exit : ray.state.before;
  float lift = ray.state.h_before;
  if (begins || from_surface) {
    hit.heights += 1u;
    float h = scarp_clearance(program, ray, 0.0f);
    if (from_surface) {
      // The ray starts at the height that floats compute there.
      ScarpTwoFloat z = scarp_two_add(scarp_ray_z(ray, 0.0f), scarp_two(-h));
      ray.origin.z = z.high;
      ray.origin_low.z = z.low;
    } else if (abs(h) <= ray.rounding) {
      scarp_function_tell(kScarpFunctionHit, 0.0f, hit);
      return hit;
    } else if (h < 0.0f) {
      hit.status = kScarpFunctionBelow;
      return hit;
    }
  }
  int ask = begins && from_surface ? kScarpAskOpen : kScarpAskSegment;
  int first = max(1, ray.state.steps);  // 0 marks rays that have not started
  int steps = first;
  float end = s;
  float below = 0.0f;  // clearance at `end`
  bool crosses = false;
  while (s < ray.exit) {
    if (steps > settings.max_steps) {
      scarp_function_tell(kScarpFunctionExhausted, s, hit);
      return hit;
    }
    if (steps - first >= settings.run_steps) {
      hit.status = kScarpFunctionUnderWay;
      hit.state.s = s;
      hit.state.before = length_;
      hit.state.h_before = lift;
      hit.state.steps = steps;
      return hit;
    }
    hit.bounds += 1u;
    ++steps;
    end = ask == kScarpAskSegment ? min(s + length_, ray.exit) : s;
    ScarpProof proof = scarp_proof(program, ray, lift, s, end);
    if (ask == kScarpAskOpen) {
      lift = 4.0f * proof.wide;
      ask = kScarpAskSegment;
      continue;
    }
    if (ask == kScarpAskSegment && proof.until == end) {
      if (proof.end > lift) lift = 0.0f;
      s = end;
      length_ = ray.direction.z > 0.0f
                    ? max(kScarpRisingGrowth * length_, kScarpRisingClear * max(0.0f, proof.end) / ray.speed)
                    : kScarpGrowth * length_;
      continue;
    }
    if (ask == kScarpAskPoint) {
      // If bounds of the point itself do not separate it from the ground, shorter segments do not either.
      if (!(proof.begin > 0.0f)) {
        scarp_function_tell(kScarpFunctionHit, s, hit);
        return hit;
      }
      ask = kScarpAskSegment;
      continue;
    }
    float shortest = kScarpShortest * (s + length_);
    float least = max(shortest, settings.tolerance * (s + ray.travelled));
    if (length_ <= least) {
      hit.heights += 1u;
      below = scarp_clearance(program, ray, end);
      if (below <= 0.0f || length_ <= shortest) {
        crosses = true;
        break;
      }
      // No known crossing; the bounds are only too wide for so little clearance. Try shorter segments.
      least = shortest;
    }
    if (proof.until == s && proof.wide <= 4.0f * ray.rounding) ask = kScarpAskPoint;
    // The first crossing is before `sunk`; otherwise it may be anywhere in the rest of the segment, or nowhere.
    float gained = proof.until - s;
    length_ = max(least, proof.sunk < end ? min((proof.sunk - proof.until) * kScarpBeyond, kScarpShrink * length_)
                                          : max(gained, kScarpShrink * (end - proof.until)));
    s = proof.until;
  }
  if (!crosses) return hit;
  // Outside the loop: neighbours in a vector, which get here at different steps, execute it together.
  if (below <= 0.0f && !any) s = scarp_crossing(program, ray, s, end, below, hit);
  scarp_function_tell(kScarpFunctionHit, s, hit);
  return hit;
}

SCARP_GLSL_END

#endif
