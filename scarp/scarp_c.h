// SPDX-License-Identifier: MIT
// The C interface, for other languages and for programs that need a stable ABI (doc/library/c.md). Link scarp::c.
//
//   scarp_heights heights = {.struct_size = sizeof heights, .samples = samples, .cols = 512, .rows = 512,
//                            .cell_x = 10, .cell_y = 10};
//   scarp_scene* scene = NULL;
//   if (scarp_heights_view(&heights, &scene)) puts(scarp_last_error());
//   scarp_ray ray = {{0, 0, 500}, {7, 7, -1}, 0, INFINITY};
//   scarp_hit hit;
//   scarp_cast(scene, &ray, NULL, &hit);
//   if (hit.status == SCARP_HIT) use(hit.t);
//   scarp_scene_release(scene);
//
// World space is right-handed, in metres: x east, y north, z up. Every function that returns scarp_status returns
// SCARP_OK, or leaves its outputs unset and a message in scarp_last_error(). Arrays of a batch may be partly written
// then. No C++ exception leaves a function. Pointers must not be NULL unless stated. Any number of threads may query a
// scene at once, but not while it is edited; scarp_live supports both at once.
//
// Lengths, coordinates of placements and scales are at most 1e30, and scales and sides at least 1e-30, because boxes of
// scenes are compared in floats, whose largest value is 3e38.
//
// Structures with `struct_size` may grow at their end: set it to the size of the structure. Members that are 0 have
// their default. All other structures keep their layout.
#ifndef SCARP_SCARP_C_H
#define SCARP_SCARP_C_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32) && defined(SCARP_C_BUILD)
#define SCARP_C_API __declspec(dllexport)
#elif defined(_WIN32)
#define SCARP_C_API __declspec(dllimport)
#elif defined(__GNUC__)
#define SCARP_C_API __attribute__((visibility("default")))
#else
#define SCARP_C_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/// Version of this header; 0.2.1 is 201.
#define SCARP_C_VERSION 100
/// Returns SCARP_C_VERSION of the library that runs.
SCARP_C_API int32_t scarp_version(void);

typedef int32_t scarp_status;
enum {
  SCARP_OK = 0,
  SCARP_REFUSED = 1,      ///< an argument, or the state of a scene, is wrong
  SCARP_UNSUPPORTED = 2,  ///< the scene has no such query
  SCARP_NO_MEMORY = 3,
  SCARP_FAILED = 4  ///< a defect of the library, or an exception of a callback
};
/// Returns the message of the last function that failed in this thread, one line of UTF-8; "" if none did. Valid until
/// another one fails in this thread. Functions that succeed do not change it.
SCARP_C_API const char* scarp_last_error(void);

/// Objects with queries: heights, voxels, tiles, or several of them.
typedef struct scarp_scene scarp_scene;

/// The points origin + t * direction for t from t_min to t_max. The direction has any length but 0, the unit of t.
typedef struct scarp_ray {
  double origin[3];
  double direction[3];
  double t_min;  ///< finite
  double t_max;  ///< >= t_min; INFINITY for a ray without an end
} scarp_ray;

enum { SCARP_MISS = 0, SCARP_HIT = 1, SCARP_BELOW = 2, SCARP_EXHAUSTED = 3 };
enum {
  SCARP_LOW_X = 0,
  SCARP_HIGH_X = 1,
  SCARP_LOW_Y = 2,
  SCARP_HIGH_Y = 3,
  SCARP_LOW_Z = 4,
  SCARP_HIGH_Z = 5,
  SCARP_INSIDE = 6
};

/// The closest hit of a ray. Members other than `status` are set for SCARP_HIT only, `t` also for SCARP_EXHAUSTED, and
/// those that name a kind of object for that kind.
typedef struct scarp_hit {
  uint8_t status;    ///< SCARP_MISS, SCARP_HIT, SCARP_BELOW (starts below ground, hits nothing), SCARP_EXHAUSTED
  uint8_t wall;      ///< 1: a wall of solid ground
  uint8_t face;      ///< voxels: SCARP_LOW_X, ...; SCARP_INSIDE: the ray starts in the voxel
  uint8_t reserved;  ///< unspecified
  uint32_t object;   ///< index of the object
  double t;          ///< in units of the length of the direction
  int32_t col, row;  ///< heights, tiles: cell
  double u, v;       ///< heights, tiles: position in the cell, 0..1, towards the next column and row
  double height;     ///< heights, tiles: z of the hit, in the space of the object
  int32_t voxel[3];  ///< voxels: position in the grid
  uint32_t part;     ///< tiles: row * cols + col of the tile
} scarp_hit;

enum { SCARP_FLOAT32 = 0, SCARP_INT16 = 1, SCARP_UINT16 = 2 };
enum { SCARP_BILINEAR = 0, SCARP_TRIANGLES = 1 };
enum { SCARP_WRAP_NONE = 0, SCARP_WRAP_PERIODIC = 1, SCARP_WRAP_SHARED_BORDER = 2 };

/// Heights in memory of the caller: rows from north to south, each from west to east. The south-west sample is at
/// x = y = 0; z = (sample * scale + offset) * exaggeration.
typedef struct scarp_heights {
  size_t struct_size;
  const void* samples;  ///< aligned as its type
  int64_t row_stride;   ///< samples from one row to the next; 0: cols; negative: the northernmost row is last in memory
  int32_t cols, rows;   ///< samples, >= 1
  int32_t type;         ///< SCARP_FLOAT32 (NaN is a hole), SCARP_INT16, SCARP_UINT16
  int32_t surface;      ///< SCARP_BILINEAR, SCARP_TRIANGLES
  int32_t wrap;         ///< SCARP_WRAP_NONE, SCARP_WRAP_PERIODIC, SCARP_WRAP_SHARED_BORDER
  int32_t solid;        ///< 1: the volume below the ground is solid, with walls at its border
  double cell_x, cell_y;              ///< metres between columns and rows, > 0; 0: 1
  double scale, offset, exaggeration; /* scale and exaggeration > 0; 0: 1 */
  double nodata;                      ///< sample value of a hole, if has_nodata
  int32_t has_nodata;                 ///< 1 or 0
  int32_t reserved;                   ///< 0
  /// Called once with `samples` and `user_data` when no scene uses the samples any longer, on the thread that released
  /// the last one; not if scarp_heights_view() fails. NULL: the samples must outlive all scenes that use them.
  void (*release)(const void* samples, void* user_data);
  void* user_data;
} scarp_heights;

/// Opens a view of heights without a copy of the samples, and builds a pyramid over them on all threads.
SCARP_C_API scarp_status scarp_heights_view(const scarp_heights* heights, scarp_scene** scene);
/// As above, but copies the samples; `release` must be NULL.
SCARP_C_API scarp_status scarp_heights_copy(const scarp_heights* heights, scarp_scene** scene);

/// A rectangle of samples.
typedef struct scarp_rect {
  int32_t col, row, cols, rows;
} scarp_rect;
/// Updates a scene of scarp_heights_view() after the caller changed these samples. After an edit, scenes that contain
/// this one are refused by queries until they are combined again. Unless the samples are valid, the scene must not be
/// used until another call succeeds.
SCARP_C_API scarp_status scarp_heights_changed(scarp_scene* scene, const scarp_rect* rect);
/// Overwrites samples of a scene of scarp_heights_copy(). `samples` are of its type, `row_stride` apart; 0: rect->cols.
/// Changes nothing if it fails. Scenes that contain this one as above.
SCARP_C_API scarp_status scarp_heights_set(scarp_scene* scene, const scarp_rect* rect, const void* samples,
                                           int64_t row_stride);

/// A volume of one byte per voxel: x fastest, then y, then z. 0 is empty. Voxel v is the cube from v * side to
/// (v + 1) * side.
typedef struct scarp_voxels {
  size_t struct_size;
  const uint8_t* indices;
  int32_t size[3];         ///< 1..16384 each
  int32_t palette_count;   ///< colours; 0: all voxels have one colour
  const uint8_t* palette;  ///< red, green and blue of index 0, of index 1, ...; indices beyond it are refused
  double side;             ///< of a voxel in metres, > 0; 0: 1
} scarp_voxels;
/// Copies voxels, and builds their accelerator.
SCARP_C_API scarp_status scarp_voxels_copy(const scarp_voxels* voxels, scarp_scene** scene);
/// Sets all voxels low <= v < high, or those with a centre within `radius` of `centre`, both in voxels, to an index,
/// 0..255; 0 clears them. Ignores voxels outside the grid. Scenes that contain this one as for scarp_heights_changed().
SCARP_C_API scarp_status scarp_voxels_set_box(scarp_scene* scene, const int32_t low[3], const int32_t high[3],
                                              int32_t index);
SCARP_C_API scarp_status scarp_voxels_set_sphere(scarp_scene* scene, const double centre[3], double radius,
                                                 int32_t index);

/// A scene and its placement: p_world = scale * turn * p + origin.
typedef struct scarp_part {
  const scarp_scene* scene;
  double turn[9];     ///< a rotation, row by row; all 0: none
  double scale;       ///< > 0; 0: 1
  double origin[3];   ///< metres
  uint32_t mask;      ///< of its objects, for `mask` of queries; 0: as in the scene, which is 1 for new ones
  uint32_t reserved;  ///< 0
} scarp_part;
/// Opens a scene of all objects of all parts, in order; scarp_hit::object counts them. Shares their fields.
SCARP_C_API scarp_status scarp_scene_combine(const scarp_part* parts, size_t count, scarp_scene** scene);
/// Returns the number of objects; 0 for NULL.
SCARP_C_API size_t scarp_scene_objects(const scarp_scene* scene);
/// Stores a pointer of the caller, and returns it; NULL at first.
SCARP_C_API void scarp_scene_set_user_data(scarp_scene* scene, void* user_data);
SCARP_C_API void* scarp_scene_user_data(const scarp_scene* scene);
/// Destroys a scene. Scenes that contain it keep working. NULL is allowed.
SCARP_C_API void scarp_scene_release(scarp_scene* scene);

/// Finds the closest hit. `from`: the hit of this scene on whose surface the ray starts, for shadow and reflection rays
/// (do not offset the origin), or NULL.
SCARP_C_API scarp_status scarp_cast(const scarp_scene* scene, const scarp_ray* ray, const scarp_hit* from,
                                    scarp_hit* hit);
/// Sets *blocked to 1 if anything blocks the ray, else to 0. `from` as for scarp_cast().
SCARP_C_API scarp_status scarp_occluded(const scarp_scene* scene, const scarp_ray* ray, const scarp_hit* from,
                                        uint8_t* blocked);

/// scarp_cast() and scarp_occluded() for `count` rays, on all threads. `from` is NULL or has an element per ray; rays
/// whose element is no SCARP_HIT start anywhere. `hits` and `from` may be the same array.
SCARP_C_API scarp_status scarp_cast_batch(const scarp_scene* scene, const scarp_ray* rays, const scarp_hit* from,
                                          scarp_hit* hits, size_t count);
SCARP_C_API scarp_status scarp_occluded_batch(const scarp_scene* scene, const scarp_ray* rays, const scarp_hit* from,
                                              uint8_t* blocked, size_t count);

/// Rays as arrays of floats.
typedef struct scarp_ray_arrays {
  size_t struct_size;
  const float *origin_x, *origin_y, *origin_z;
  const float *direction_x, *direction_y, *direction_z;
  const float *t_min, *t_max;  ///< NULL: 0 and infinity
} scarp_ray_arrays;
/// Members of hits as arrays; NULL: not wanted. Without a hit t is infinite, cells are -1, all others 0.
typedef struct scarp_hit_arrays {
  size_t struct_size;
  float* t;
  uint8_t* status;
  uint32_t *object, *part;
  int32_t *col, *row;
  float *u, *v;
  float *normal_x, *normal_y, *normal_z;  ///< outward unit normals in world space; all or none
} scarp_hit_arrays;
/// scarp_cast() and scarp_occluded() for `count` rays, on all threads.
SCARP_C_API scarp_status scarp_cast_arrays(const scarp_scene* scene, const scarp_ray_arrays* rays,
                                           const scarp_hit_arrays* hits, size_t count);
SCARP_C_API scarp_status scarp_occluded_arrays(const scarp_scene* scene, const scarp_ray_arrays* rays, uint8_t* blocked,
                                               size_t count);

/// Finds all hits of a ray in order of t, at most one per cell. Sets *count to their number; stores the first `room` of
/// them. SCARP_UNSUPPORTED unless the scene was opened as heights.
SCARP_C_API scarp_status scarp_all_hits(const scarp_scene* scene, const scarp_ray* ray, scarp_hit* hits, size_t room,
                                        size_t* count);
/// Sets heights[i] to the z of the highest ground at (xs[i], ys[i]), NaN where there is none. Uses all threads.
SCARP_C_API scarp_status scarp_heights_at(const scarp_scene* scene, const double* xs, const double* ys, double* heights,
                                          size_t count);

/// The surface at a hit, in world space.
typedef struct scarp_surface {
  size_t struct_size;
  double position[3];
  double normal[3];          ///< unit, outward; 0 in a voxel
  double shading_normal[3];  ///< unit, outward, smooth; 0 in a voxel
  uint32_t object;
  uint8_t colour[3];   ///< sRGB, if has_colour
  uint8_t has_colour;  ///< 1: voxels
} scarp_surface;
/// Sets the members of `surface`, whose struct_size is set, for a hit of this ray.
SCARP_C_API scarp_status scarp_surface_at(const scarp_scene* scene, const scarp_ray* ray, const scarp_hit* hit,
                                          scarp_surface* surface);

/// A perspective camera. The direction of a pixel has length 1 along `forward`: t is the depth.
typedef struct scarp_camera {
  size_t struct_size;
  double eye[3];
  double forward[3];      ///< of any length but 0
  double up[3];           ///< not along `forward`; all 0: z
  double tan_half_width;  ///< tangent of half the horizontal angle of view, > 0; pixels are square
  double t_min, t_max;    /* t_max 0: infinity */
  int32_t columns, rows;  ///< pixels
} scarp_camera;
/// A scanner that turns about the vertical. Directions have length 1: t is the range.
typedef struct scarp_scanner {
  size_t struct_size;
  double eye[3];
  const double* elevations;  ///< of the rows, in radians above the horizon; faster if they rise or fall
  double first_azimuth;      ///< radians from north, clockwise
  double azimuth_step;       ///< radians
  double t_min, t_max;       /* t_max 0: infinity */
  int32_t columns, rows;     ///< azimuths, elevations
} scarp_scanner;
/// Any directions from one eye, in rows; faster if rows are in the order of their slope.
typedef struct scarp_fan {
  size_t struct_size;
  double eye[3];
  const float *dx, *dy, *dz;  ///< columns * rows directions, of any length; without direction a ray misses
  double t_min, t_max;        /* t_max 0: infinity */
  int32_t columns, rows;
} scarp_fan;
/// Answers at row * columns + column; NULL: not wanted.
typedef struct scarp_fan_answers {
  size_t struct_size;
  float* t;            ///< infinity if the ray hits nothing
  int32_t *col, *row;  ///< cell of the hit; -1 if there is none
  float *u, *v;        ///< position in the cell, 0..1
  uint8_t* status;
  float *nx, *ny, *nz;  ///< unit normals in world space, 0 if there is no hit; all or none
} scarp_fan_answers;
/// Finds the closest hits of all rays of a camera, a scanner or a fan, on all threads; faster than scarp_cast_batch().
/// A ray hits if it does for scarp_cast(); t, u and v are rounded to floats. SCARP_UNSUPPORTED unless the scene was
/// opened as heights.
SCARP_C_API scarp_status scarp_cast_camera(const scarp_scene* scene, const scarp_camera* camera,
                                           const scarp_fan_answers* answers);
SCARP_C_API scarp_status scarp_cast_scanner(const scarp_scene* scene, const scarp_scanner* scanner,
                                            const scarp_fan_answers* answers);
SCARP_C_API scarp_status scarp_cast_fan(const scarp_scene* scene, const scarp_fan* fan,
                                        const scarp_fan_answers* answers);

/// A contact or a closest point.
typedef struct scarp_contact {
  double t;          ///< of scarp_sweep(): fraction of the motion, 0..1; 0: in contact at the start
  double distance;   ///< metres; of scarp_sweep() if t is 0: minus the way along the normal after which it only touches
  double point[3];   ///< on the surface
  double normal[3];  ///< unit, towards the moving body; outward for a closest point, 0 in a voxel
  uint32_t object;   ///< as in scarp_hit, like part, col, row and voxel
  uint32_t part;
  int32_t col, row;
  int32_t voxel[3];
  uint32_t found;  ///< 1; 0: there is none, and all other members are 0
} scarp_contact;
/// Finds the first contact of a capsule, or of a sphere if a is b, that moves along `motion`, with objects whose mask
/// shares a bit with `mask`. Refused over heights that wrap, and if no object matches. Sides of the ground do not
/// count.
SCARP_C_API scarp_status scarp_sweep(const scarp_scene* scene, const double a[3], const double b[3], double radius,
                                     const double motion[3], uint32_t mask, scarp_contact* contact);
/// Sets *overlaps to 1 if a box overlaps a surface of heights or tiles, or a voxel, else to 0. `half`: half of each
/// side; `turn`: as in scarp_part, or NULL. Refused as scarp_sweep().
SCARP_C_API scarp_status scarp_overlaps(const scarp_scene* scene, const double centre[3], const double half[3],
                                        const double turn[9], uint32_t mask, uint8_t* overlaps);
/// Finds the closest point on a surface of heights or tiles, or a voxel, within `max_distance` (INFINITY: any). Refused
/// as scarp_sweep().
SCARP_C_API scarp_status scarp_closest_point(const scarp_scene* scene, const double point[3], double max_distance,
                                             uint32_t mask, scarp_contact* contact);

/// A grid of tiles of heights that share their border samples and are one object. Tiles change while other threads
/// query: they read the tiles as they were.
typedef struct scarp_tiles scarp_tiles;
/// The layout; tile (0, 0) is the north-west one. The south-west sample of the whole grid is at x = y = 0.
typedef struct scarp_tile_layout {
  size_t struct_size;
  int32_t cols, rows;            ///< tiles, 1..65536
  int32_t cell_cols, cell_rows;  ///< cells of a tile; it has one sample more in each direction
  double cell_x, cell_y;         ///< these and the others as in scarp_heights, for all tiles
  double scale, offset, exaggeration;
  double nodata;
  int32_t has_nodata;
  int32_t surface;
} scarp_tile_layout;
/// A change of one tile.
typedef struct scarp_tile_change {
  int32_t col, row;
  const scarp_scene* heights;  ///< opened as heights: added, sharing its samples; NULL: the tile is removed
} scarp_tile_change;
/// Creates tiles, all missing: holes.
SCARP_C_API scarp_status scarp_tiles_create(const scarp_tile_layout* layout, scarp_tiles** tiles);
/// Makes several changes in one step, or none of them if it fails. Tiles that share a border must be equal there.
/// Heights may have cells 2, 4, 8, ... times as long. Any thread may call it at any time.
SCARP_C_API scarp_status scarp_tiles_edit(scarp_tiles* tiles, const scarp_tile_change* changes, size_t count);
/// Opens a scene of the tiles as they are now. Never waits. Any thread may call it at any time.
SCARP_C_API scarp_status scarp_tiles_read(const scarp_tiles* tiles, scarp_scene** scene);
/// Destroys tiles; scenes of them keep working. NULL is allowed.
SCARP_C_API void scarp_tiles_release(scarp_tiles* tiles);

/// A scene that threads query while others edit its objects and their fields.
typedef struct scarp_live scarp_live;
typedef struct scarp_editor scarp_editor;
/// Creates one without objects.
SCARP_C_API scarp_status scarp_live_create(scarp_live** live);
/// Calls `query` with the scene as it is now; edits wait until it returns. The scene is valid only during the call.
/// `query` must not call scarp_live_read() or scarp_live_edit(), which are refused. Any thread may call it at any time.
SCARP_C_API scarp_status scarp_live_read(const scarp_live* live,
                                         void (*query)(const scarp_scene* scene, void* user_data), void* user_data);
/// Calls `change` while no query runs; queries see all its edits at once. It may call the scarp_editor functions, and
/// edit the fields of the objects: scarp_heights_set(), scarp_voxels_set_box(), ...; otherwise as scarp_live_read().
SCARP_C_API scarp_status scarp_live_edit(scarp_live* live, void (*change)(scarp_editor* editor, void* user_data),
                                         void* user_data);
/// Adds a scene of one object, and sets *object to its number, scarp_hit::object. Numbers of removed objects are used
/// again.
SCARP_C_API scarp_status scarp_editor_add(scarp_editor* editor, const scarp_part* part, uint32_t* object);
/// Places an object as `place` says, whose scene and mask are not used.
SCARP_C_API scarp_status scarp_editor_move(scarp_editor* editor, uint32_t object, const scarp_part* place);
SCARP_C_API scarp_status scarp_editor_remove(scarp_editor* editor, uint32_t object);
/// Destroys a live scene; no call on it may be running. NULL is allowed.
SCARP_C_API void scarp_live_release(scarp_live* live);

/// Threads of the caller.
typedef struct scarp_threads {
  size_t struct_size;
  /// Calls piece(context, i) once for each i from 0 to pieces - 1, on any threads and in any order, and returns when
  /// all calls have returned. Several threads may call it at once.
  void (*run)(void* user_data, int64_t pieces, void (*piece)(void* context, int64_t index), void* context);
  void* user_data;
} scarp_threads;
/// Batches and builds that this thread starts from now on run on these threads; NULL: on all threads, by oneTBB.
SCARP_C_API scarp_status scarp_use_threads(const scarp_threads* threads);

#ifdef __cplusplus
}
#endif

#endif
