// SPDX-License-Identifier: MIT
// max-mip-easy: the hit of a ray with a height field. One file to paste into a shader: WebGL 2 (GLSL ES 3.00),
// GLSL 3.30 and later, Shadertoy. No extensions, no buffers, no doubles.
//
//   level 2:  [        ]   lowest ray height over the block > its maximum: on to the next block
//   level 1:  [   ][   ]   otherwise: down one level
//   level 0:  [ ][ ][ ][ ] a cell: intersect the bilinear surface between its four heights
//
// Provide two 32-bit float textures with the filter NEAREST (maxima: NEAREST_MIPMAP_NEAREST as minification filter):
//   easy_heights   texel (col, row): the height of a node of the grid
//   easy_maxima    mip level l, texel (col, row): the maximum height of block (col, row) of 2^l x 2^l cells. A cell is
//                  the square between four nodes, and level 0 holds the maximum of these four. Both sides are powers of
//                  two, at least as long as the cells; texels beyond the cells are never read
// or define MAX_MIP_EASY_HOST and the four functions below. Then call
//   EasyHit hit = max_mip_easy(origin, direction, 1.0e9, false);
// The ray is in grid units: x in columns, y in rows, z in units of height, node (0, 0) at the origin. It may start
// anywhere. Coordinates, the direction's components and heights are limited to 1e6 (the longest component at least
// 1e-6), t_max to 1e12. `precision highp float; precision highp int;` is required in GLSL ES.
//
// The ground is a solid body: a ray that starts below it, or enters it through the border, hits there at once
// (`below`). For a shadow ray, start at easy_above(hit): a hit itself may be below the ground by rounding.
//
// No hit is lost between cells. The ray is cut into pieces, one for each block or cell, without gaps: each piece starts
// at the time at which the last one ended. A block is skipped only if the ray is above its maximum all along the piece,
// and a cell only if the ray is above the surface at both ends of the piece and between them. Both tests are one-sided
// and concern one piece alone: no sign is handed on that could differ between neighbours. If rounding places a piece in
// the neighbouring cell, the ray is within rounding of their common edge, where both cells have the same height.
//
// Guarantee: conservative up to the rounding of floats. The answer is that of a ray displaced by at most
//   e = 2^-21 (cells + |origin| + length of the path in the field + 1) cells on either axis, and vertically by
//   h = 2^-20 (|origin.z| + |rise of the path| + |heights|);
// so a ray passes no point that is below the ground by more than delta = h + 2 e r, where r is the largest height
// difference within a cell there, and it is at most delta above the ground where it hits. e is 0.0015 cells in a field
// of 1,024 cells. No comparison needs two floats to be equal, so `precise` is not required: compilers may fuse and
// reorder operations, which stays within the bound. Derivation: doc/dev/numerics.md, "The easy text".
//
// Source: A. Tevs, I. Ihrke, H.-P. Seidel, "Maximum mipmaps for fast, accurate, and scalable dynamic height field
// rendering", I3D 2008.

#ifndef MAX_MIP_EASY_HOST
uniform highp sampler2D easy_heights, easy_maxima;
// Columns and rows of cells: one less than those of heights.
ivec2 easy_cells() { return textureSize(easy_heights, 0) - 1; }
// The last level, which has one block.
int easy_top_level() {
  ivec2 size = textureSize(easy_maxima, 0);
  return int(log2(float(max(size.x, size.y))) + 0.5f);
}
// The height of a node.
float easy_height(ivec2 node) { return texelFetch(easy_heights, node, 0).x; }
// The maximum height of a block, or an upper bound of it; level 0: of a cell.
float easy_maximum(ivec2 block, int level) { return texelFetch(easy_maxima, block, level).x; }
#endif

// The answer. Without a hit, and for any_hit, only `hit` and `steps` are defined.
struct EasyHit {
  bool hit;
  bool below;     // the ray starts below the ground, or enters it through the border: the hit is there
  float t;        // position = origin + t * direction
  vec3 position;  // column, row, height
  ivec2 cell;     // column and row of the cell
  vec2 place;     // position in it, 0..1
  int steps;      // blocks and cells examined
};

const float kEasyUnit = 5.9604645e-8f;   // rounding unit of floats, 2^-24
const float kEasyLeast = 1.0e-30f;       // above ground at height 0
const float kEasyFarthest = 1.0e12f;     // no time is later
const float kEasySlowest = 1.0e-25f;     // a ray slower than this along an axis does not move on it
const float kEasyBelowOne = 0.9999999f;  // position in the last cell of nodes on the last line ...
const float kEasyAboveOne = 1.0000001f;  // ... from which a ray along that line is in the field

// Heights of the corners of a cell: (0, 0), (1, 0), (0, 1), (1, 1), counted from a corner `node` in steps of +-1.
vec4 easy_corners(ivec2 node, ivec2 onward) {
  return vec4(easy_height(node), easy_height(node + ivec2(onward.x, 0)), easy_height(node + ivec2(0, onward.y)),
              easy_height(node + onward));
}

// Height of the bilinear surface above the first corner of a cell, at a position in it.
float easy_rise(vec4 corners, vec2 place) {
  float along_x = corners.y - corners.x;
  float twist = (corners.w - corners.z) - along_x;
  return place.x * along_x + place.y * ((corners.z - corners.x) + place.x * twist);
}

// Where f(s) = above + slope s + bend s^2 first falls to 0, s from 0 to 1, if it does.
float easy_root(float above, float slope, float bend) {
  if (above <= 0.0f) return 0.0f;
  float root = sqrt(max(0.0f, slope * slope - 4.0f * bend * above));
  float s = 1.0f;
  if (slope < 0.0f)
    s = 2.0f * above / (root - slope);
  else if (bend < 0.0f)
    s = (slope + root) / (-2.0f * bend);
  return clamp(s, 0.0f, 1.0f);
}

// The first hit of origin + t * direction, 0 <= t <= t_max; or only whether there is any, for shadow rays.
EasyHit max_mip_easy(vec3 origin, vec3 direction, float t_max, bool any_hit) {
  EasyHit hit;
  hit.hit = false;
  hit.below = false;
  hit.t = t_max;
  hit.position = origin;
  hit.cell = ivec2(0);
  hit.place = vec2(0.0f);
  hit.steps = 0;
  ivec2 cells = easy_cells();
  vec2 size = vec2(cells);
  int top = easy_top_level();

  // Mirrored, so that the ray advances towards +x and +y. -1: this axis is mirrored, and cell c is counted as ~c.
  ivec2 mirror = ivec2(direction.x < 0.0f ? -1 : 0, direction.y < 0.0f ? -1 : 0);
  vec2 start = vec2(mirror.x < 0 ? size.x - origin.x : origin.x, mirror.y < 0 ? size.y - origin.y : origin.y);
  vec2 speed = vec2(abs(direction.x), abs(direction.y));
  vec2 per_speed = 1.0f / max(speed, vec2(kEasySlowest));

  // Clipped to the border and to the highest ground.
  vec2 enter = -start * per_speed;
  vec2 leave = (size * kEasyAboveOne - start) * per_speed;
  float highest = easy_maximum(ivec2(0), top);
  float t_in = max(0.0f, max(enter.x, enter.y));
  float t_out = min(min(t_max, kEasyFarthest), min(leave.x, leave.y));
  bool above = origin.z + direction.z * t_in > highest;
  if (above) {
    if (!(direction.z < 0.0f)) return hit;
    t_in = max(t_in, (highest - origin.z) / direction.z);
  } else if (direction.z > 0.0f) {
    t_out = min(t_out, (highest - origin.z) / direction.z);
  }
  if (!(t_in <= t_out)) return hit;

  // From here on, times count from t_in, and positions from the first cell.
  vec2 at = clamp(start + speed * t_in, vec2(0.0f), size);
  ivec2 first = min(ivec2(at), cells - 1);
  vec2 place = clamp(at - vec2(first), vec2(0.0f), vec2(kEasyBelowOne));
  first += mirror * cells;
  ivec2 border = cells + mirror * cells;
  float z = origin.z + direction.z * t_in;
  float t_end = t_out - t_in;
  float t = 0.0f;
  ivec2 cell = first;
  int level = top / 2;
  // Each iteration advances by a column or a row, or goes down a level; it goes up at most as often as it advances.
  int turns = 2 * (cells.x + cells.y) + top;
  for (int turn = 0; turn < turns; ++turn) {
    // The piece from t to t_to is in the block of `cell` on this level. `line`: its far lines.
    ivec2 line = (cell | ((1 << level) - 1)) + 1;
    vec2 t_line = (vec2(line - first) - place) * per_speed;
    float t_to = max(t, min(t_end, min(t_line.x, t_line.y)));
    float lowest = z + direction.z * (direction.z < 0.0f ? t_to : t);
    bool free = lowest > easy_maximum((cell ^ mirror) >> level, level);
    hit.steps += 1;
    if (!free && level == 0) {
      // The clearance f along the piece is a parabola, from f_in to f_out.
      ivec2 onward = mirror | 1;
      vec4 corners = easy_corners((cell ^ mirror) - mirror, onward);
      vec2 corner = place - vec2(cell - first);
      vec2 p_in = clamp(corner + speed * t, vec2(0.0f), vec2(1.0f));
      vec2 p_out = clamp(corner + speed * t_to, vec2(0.0f), vec2(1.0f));
      float f_in = ((z - corners.x) + direction.z * t) - easy_rise(corners, p_in);
      float f_out = ((z - corners.x) + direction.z * t_to) - easy_rise(corners, p_out);
      float twist = (corners.w - corners.z) - (corners.y - corners.x);
      float bend = -twist * (p_out.x - p_in.x) * (p_out.y - p_in.y);
      float slope = (f_out - f_in) - bend;
      float least = min(f_in, f_out);
      if (bend > abs(f_out - f_in)) least = f_in - slope * slope / (4.0f * bend);
      if (least <= 0.0f) {
        hit.hit = true;
        if (any_hit) return hit;
        float s = easy_root(f_in, slope, bend);
        vec2 p = p_in + s * (p_out - p_in);
        float t_hit = t + s * (t_to - t);
        hit.below = !above && t <= 0.0f && f_in < 0.0f;
        hit.t = t_in + t_hit;
        hit.cell = cell ^ mirror;
        hit.place = vec2(mirror.x < 0 ? 1.0f - p.x : p.x, mirror.y < 0 ? 1.0f - p.y : p.y);
        hit.position = vec3(vec2(hit.cell) + hit.place, z + direction.z * t_hit);
        return hit;
      }
      free = true;
    }
    // On to the block behind the nearer line, and up if it has another parent; or down.
    bool over_x = t_line.x <= t_line.y;
    ivec2 next = clamp(first + ivec2(place + speed * t_to), cell, line - 1);
    next = over_x ? ivec2(line.x, next.y) : ivec2(next.x, line.y);
    if (free && (t_to >= t_end || next.x >= border.x || next.y >= border.y)) return hit;
    bool up = (((over_x ? line.x : line.y) >> level) & 1) == 0 && level < top;
    t = free ? t_to : t;
    cell = free ? next : cell;
    level += free ? (up ? 1 : 0) : -1;
  }
  return hit;
}

// The upward normal at a hit, in grid units, not normalised. For columns, rows and units of height that are x, y and h
// long: normalize(easy_normal(hit) / vec3(x, y, h)).
vec3 easy_normal(EasyHit hit) {
  vec4 corners = easy_corners(hit.cell, ivec2(1));
  float twist = (corners.w - corners.z) - (corners.y - corners.x);
  return vec3((corners.x - corners.y) - twist * hit.place.y, (corners.x - corners.z) - twist * hit.place.x, 1.0f);
}

// Start for rays from a hit: a point above the surface by more than rounding, so that no ray hits where it starts.
vec3 easy_above(EasyHit hit) {
  vec4 corners = easy_corners(hit.cell, ivec2(1));
  ivec2 cells = easy_cells();
  float low = min(min(corners.x, corners.y), min(corners.z, corners.w));
  float high = max(max(corners.x, corners.y), max(corners.z, corners.w));
  float lift = 64.0f * kEasyUnit * (max(abs(low), abs(high)) + float(max(cells.x, cells.y) + 1) * (high - low));
  return vec3(hit.position.x, hit.position.y, (corners.x + easy_rise(corners, hit.place)) + max(lift, kEasyLeast));
}
