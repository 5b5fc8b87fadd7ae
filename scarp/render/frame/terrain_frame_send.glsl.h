// SPDX-License-Identifier: MIT
// Sends rays to the march, for the stages that make some and include this. GLSL.

#include "scarp/march/height/ray_blocks.glsl.h"

// Writes the state of a ray that is known before it is marched. The rest is set if the ray hits ground.
void keep(uint i, FrameSeen seen) {
  Seens(push.seens).of[i].line = seen.line;
  Seens(push.seens).of[i].metres = seen.metres;
  Seens(push.seens).of[i].kind = seen.kind;
  Seens(push.seens).of[i].t = seen.t;
  Seens(push.seens).of[i].per_time = seen.per_time;
  Seens(push.seens).of[i].steps = seen.steps;
}

// Time between two samples of a stepped ray.
float step_of(FrameSeen seen, bool of_camera) {
  Settings s = settings();
  float step = s.is.step / (of_camera && s.is.shells == 0 ? 1.0 : seen.metres);
  if (s.is.step_by_view != 0) step /= max(length(direction_of(seen.line).xy), 0.125);
  return step;
}

// Length of a stepped ray, in its time. Less than 0: none.
float stepped_end(ScarpField field, FrameSeen seen, float step) {
  float end = min(seen.end.high, step * float(settings().is.steps));
  if (!(seen.line.direction.z > 0.0)) return end;
  float leaves = ((field.highest - seen.line.origin.z) - seen.line.origin_low.z) / seen.line.direction.z;
  return leaves < 0.0 ? -1.0 : min(end, leaves + step);
}

// Appends a ray of scarp_send() to the list. `step`: time between its samples; `seen`: the index of its FrameSeen.
void list_ray(ScarpSent sent, float step, uint seen) {
  uint at = atomicAdd(Counters(push.counters).are.rays, 1u);
  // The march counts steps in cells; the ray holds the time per cell.
  if (stepped) sent.ray.cell_time *= step;
  put_ray(RayBlockTo(ray_block_address(push.rays, at, kRayBlockBytes)), at % kRayBlock, sent.ray);
  Indices(push.owners).of[at] = seen;
}
