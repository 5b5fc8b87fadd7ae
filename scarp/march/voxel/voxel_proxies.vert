// SPDX-License-Identifier: MIT
// The box of a voxel object: an instance of 36 vertices, six faces of two triangles. Faces towards the eye are drawn,
// or all six if the eye is inside; the others collapse to a point.
//
// The ray of each pixel through the box must produce a fragment. Rasterisers move corners by up to 2^-5 pixel, corners
// are rounded to float, and the ray of a pixel may be up to half a pixel off its centre. Boxes are therefore enlarged
// by `margin` at the depth of their far end, a pixel there and more elsewhere, and by 2^-18 of the distance of that
// end: clip coordinates have errors of a few units of 2^-24 of it.
//
// All corners of an object have the same depth, which is in front of all hits in it: depths are thus correct no matter
// how close the eye is, and nothing near it is clipped.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require

#include "scarp/march/voxel/voxel_proxies.glsl.h"

layout(location = 0) flat out uint proxy_object;

const double kRoomPerDistance = 1.0lf / 262144.0lf;
// Fraction of a voxel: the displacement of a quantised ray (voxel_ray.h) for 2^12 voxels a side, plus the rounding of
// the matrix.
const double kRoomOfVoxel = 1.0lf / 16384.0lf;
// Rasterisers may round the depth by a few units of 2^-24.
const double kNearer = 1.0lf - 1.0lf / 1024.0lf;

// A box with this centre and half size along the axes.
double least_along(dvec3 row, dvec3 middle, dvec3 axes[3], dvec3 reach) {
  double sum = dot(row, middle);
  for (int i = 0; i < 3; ++i) sum -= abs(dot(row, axes[i])) * reach[i];
  return sum;
}
double most_along(dvec3 row, dvec3 middle, dvec3 axes[3], dvec3 reach) {
  return -least_along(-row, middle, axes, reach);
}

void main() {
  VoxelObjects scene = VoxelObjects(push.objects);
  ScarpVoxelView view = VoxelViews(push.view).is;
  ScarpVoxelObject object = VoxelObjectList(scene.is.objects).of[gl_InstanceIndex];
  ScarpVoxelTurn turn = VoxelTurns(scene.is.turns).of[object.turn];
  ivec3 low = VoxelGrids(scene.is.grids).grids[object.grid].low,
        high = VoxelGrids(scene.is.grids).grids[object.grid].high;
  proxy_object = uint(gl_InstanceIndex);
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
  if (any(greaterThanEqual(low, high))) return;

  // World from grid: a rotation and a scale.
  dvec3 axes[3];
  for (int i = 0; i < 3; ++i) axes[i] = turn.rows[i] / dot(turn.rows[i], turn.rows[i]);
  dvec3 middle_in_grid = 0.5lf * dvec3(low + high), half_size = 0.5lf * dvec3(high - low);
  dvec3 corner = object.origin - view.origin;
  dvec3 middle = corner;
  for (int i = 0; i < 3; ++i) middle += axes[i] * middle_in_grid[i];
  double side = length(axes[0]);
  double far = view.parallel != 0u ? 1.0lf : most_along(view.w, middle, axes, half_size);
  if (!(far > 0.0lf)) return;
  double distance = length(middle) + side * length(half_size);
  double room = (view.margin * far + kRoomPerDistance * distance) / side + kRoomOfVoxel;
  half_size += room;

  // Selects the faces towards the eye, or against the direction.
  int face = gl_VertexIndex / 6, axis = face >> 1;
  bool upper = (face & 1) != 0;
  bool inside = view.parallel == 0u, shown = false;
  for (int i = 0; i < 3; ++i) {
    double eye = dot(turn.rows[i], -corner) - middle_in_grid[i], direction = dot(turn.rows[i], view.direction);
    inside = inside && abs(eye) <= half_size[i] + room;
    if (i == axis) {
      if (view.parallel != 0u) {
        shown = upper ? direction < 0.0lf : direction > 0.0lf;
      } else {
        shown = upper ? eye > half_size[i] : eye < -half_size[i];
      }
    }
  }
  if (!shown && !inside) return;

  // Two triangles: corners 0 1 2 and 2 1 3 of the face.
  int index = gl_VertexIndex % 6, at = index < 3 ? index : index == 3 ? 2 : index == 4 ? 1 : 3;
  bvec3 above;
  above[axis] = upper;
  above[(axis + 1) % 3] = (at & 1) != 0;
  above[(axis + 2) % 3] = (at & 2) != 0;
  dvec3 p = middle;
  for (int i = 0; i < 3; ++i) p += axes[i] * (above[i] ? half_size[i] : -half_size[i]);
  dvec3 clip = dvec3(dot(view.x, p), dot(view.y, p), dot(view.w, p));
  if (view.parallel != 0u) clip += dvec3(-1.0lf, -1.0lf, 1.0lf);
  double nearest = least_along(view.depth, middle, axes, half_size);
  float depth = inside || !(nearest > 0.0lf) ? 1.0 : uintBitsToFloat(scarp_depth_bits(nearest * kNearer));
  float w = float(clip.z);
  gl_Position = vec4(float(clip.x), float(clip.y), depth * w, w);
}
