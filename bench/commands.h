// SPDX-License-Identifier: MIT
// The commands of scarp-bench and their options.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/fields.h"
#include "bench/protocol.h"
#include "bench/rays.h"
#include "bench/report.h"

namespace scarp::bench {

/// Which ground, rays and threads; shared by the commands that trace rays.
struct TraceOptions {
  FieldOptions field;
  RayCounts rays;
  std::uint64_t ray_seed = 1;
  std::vector<double> exaggerations{1};
  std::vector<int> threads{1};
  int repeats = 3;
  double pass_limit_s = 10;
  std::int64_t judged = 20000;             ///< rays per class that the judge also traces
  std::string instruction_set = "native";  ///< bench/instruction_set.h (heights, survey)
};

/// `heights`: all marches beside all modes of Embree in several ray classes.
struct HeightsOptions {
  TraceOptions trace;
  std::vector<int> sizes{2049};
  std::vector<std::string> classes{"primary", "shadow",       "grazing", "ao",     "nodes",
                                   "lidar",   "lidar-ground", "near",    "lidar64"};
  std::vector<std::string> marches;  ///< modes of scarp, as rows name them; empty: all
  std::vector<std::string> engines{"scarp", "embree-tri", "embree-grid"};  ///< and "bullet", which is slow
  std::string embree_quality = "high";
};
void run_heights(const HeightsOptions& options, const ReportOptions& report);

/// `naive`: the comparison of the max-mip article, with naive marching fine enough to be correct.
struct NaiveOptions {
  TraceOptions trace;
  double miss_limit = 0.001;  ///< fraction of the judge's hits that naive may miss
};
void run_naive(const NaiveOptions& options, const ReportOptions& report);

/// `survey`: Scarp's best mode over its peers' best over several fields, cameras and suns; the median and the worst.
struct SurveyOptions {
  TraceOptions trace;
  std::vector<std::string> kinds{"ridged", "fbm"};
  std::vector<std::string> dems;
  std::vector<std::string> classes{"primary", "shadow", "grazing", "ao", "lidar", "lidar-ground", "near"};
  std::vector<std::string> peers{"embree-tri", "embree-grid"};
};
void run_survey(const SurveyOptions& options, const ReportOptions& report);

/// `batches`: the library's batch calls with batches of several sizes.
struct BatchesOptions {
  TraceOptions trace;
  std::vector<std::string> classes{"primary", "ao"};
  std::vector<double> batches{10, 100, 1e3, 1e4, 1e6, 1e7};  ///< rays
};
void run_batches(const BatchesOptions& options, const ReportOptions& report);

/// `simd`: the vectors beside the scalar walk, one thread, with each optimisation disabled in turn.
struct SimdOptions {
  TraceOptions trace;
  std::vector<std::string> classes{"primary", "shadow", "grazing", "ao", "nodes"};
};
void run_simd(const SimdOptions& options, const ReportOptions& report);

/// `pyramid`: build speed of the pyramid of maxima.
struct PyramidOptions {
  std::vector<int> sizes{2049, 8193};
  int repeats = 5;
};
void run_pyramid(const PyramidOptions& options, const ReportOptions& report);

/// `maps`: viewsheds, shadows and least visible heights of all nodes of procedural DEMs; `scarp` beside other programs.
struct MapsOptions {
  std::vector<int> sizes{1024, 2048, 4096};
  std::string kind = "fbm";  ///< or "ridged"
  std::uint64_t seed = 1;
  int observer_height = 2;                   ///< metres; the observer is in the middle
  int azimuth_deg = 135, altitude_deg = 20;  ///< of the sun
  int repeats = 3;
  std::int64_t judged = 100'000;  ///< nodes per map that are also decided by a ray
  int lines = 1'000'000;          ///< of sight
  std::vector<std::string> programs{"scarp", "gdal_viewshed", "r.viewshed", "r.sunmask", "saga"};
  std::string scarp;             ///< path of the program
  int observers = 500;           ///< of a cumulative viewshed; 0: none
  double program_limit_s = 120;  ///< programs that take longer are stopped, and not run at larger sizes
};
/// Throws Error, after the report, if a node differs from its ray.
void run_maps(const MapsOptions& options, const ReportOptions& report);

/// `view`: the window, measured by view.sh on a display without a screen.
struct ViewOptions {
  std::vector<int> sizes{2049, 4097, 8193};
  std::string csv;  ///< file to write the rows to; empty: the output
};
/// Throws Error if the script cannot be started; otherwise does not return.
[[noreturn]] void run_view(const ViewOptions& options);

/// `devices`: the Vulkan devices of this machine; with SCARP_VULKAN, as `gpu` and `shaders`.
struct DevicesOptions {
  std::string device = "auto";  ///< DeviceSettings::choice
};
/// Throws Error if there is no device, or none matches the choice.
void run_devices(const DevicesOptions& options);

/// `gpu`: the marches on a Vulkan device, and the article's comparison there.
struct GpuOptions {
  FieldOptions field;
  std::string device = "auto";    ///< DeviceSettings::choice
  std::vector<int> sizes;         ///< samples per side; empty: 1025, 4097 and, except on CPU devices, 16385
  std::optional<RayCounts> rays;  ///< nullopt: those of RayCounts, for CPU devices a sixteenth
  std::int64_t judged = 0;        ///< rays per class that the oracle also traces; 0: 20,000, for CPU devices 4096
  std::uint64_t ray_seed = 1;
  std::vector<std::string> classes{"chunk", "primary", "shadow", "grazing", "ao"};
  std::vector<double> exaggerations{1};
  double miss_limit = 0.001;  ///< fraction of the hits that naive-missed may miss
  int repeats = 5;
  double pass_limit_s = 10;
  bool raster = false;
};
/// `gpu --raster`: primary rays beside the same triangles drawn; sizes 1025, 2049, 4097, 16385, on CPU
/// devices 257, 513, 1025, 2049, 4097.
void run_gpu_raster(const GpuOptions& options, const ReportOptions& report);
void run_gpu(const GpuOptions& options, const ReportOptions& report);

/// `shaders`: RADV's statistics of each shader, for cards that need not be installed.
struct ShadersOptions {
  std::vector<std::string> families{"polaris10", "vega10", "navi10", "navi21", "gfx1100"};  ///< of AMD cards
  std::string shader{};  ///< only shaders whose path contains this
  std::string update{};  ///< a table of shader_table.h to write; empty: none
};
/// Throws Error if RADV is missing or does not know a family, or if no shader has the name.
void run_shaders(const ShadersOptions& options, const ReportOptions& report);

/// `simt`: rays in lockstep, by the shaders' text on the CPU: costs of bundles with max-mip and with naive.
struct SimtOptions {
  FieldOptions field;
  std::vector<int> sizes{1025, 4097};
  std::vector<std::string> classes{"chunk", "primary", "shadow", "grazing", "ao"};
  RayCounts rays;
  std::int64_t groups = 512;  ///< of 64 successive rays, spread evenly over each class; all are judged
  std::uint64_t ray_seed = 1;
  double wrong_limit = 0.001;  ///< fraction of rays that naive may get wrong
  std::string blocks;          ///< table of instructions by block; empty: bench/simt_blocks.csv of the sources
  bool recount = false;        ///< with Vulkan: by the blocks as this build compiles them (simt_recount.h)
  std::string disassembly{};   ///< a folder for the counted disassemblies; empty: none
  std::string update{};        ///< a file to write the recounted table to, instead of tracing rays
  bool voxels = false;         ///< instead: the marches of voxels, in pictures of the sets of voxel_sets.h
  std::vector<std::string> voxel_sets{"standard", "degenerate", "far-wall"};
  std::vector<int> voxel_layers{1, 16};  ///< of 1,024 objects
  int voxel_stride = 4;                  ///< one tile of 8 x 8 pixels in stride x stride
};
void run_simt(const SimtOptions& options, const ReportOptions& report);

/// `leaks`: rays of the kinds that engines lose, each judged.
struct LeaksOptions {
  std::int64_t rays = 10'000'000;
  std::uint64_t seed = 1;
  int large = 2049;                       ///< side of the large field, in samples
  std::int64_t judge_every = 4096;        ///< one in this many rays over a small field is also traced by exhaustive
  std::int64_t embree_rays = 10'000'000;  ///< at most about this many are also traced by Embree; 0: none
  std::string dump;                       ///< file for the first failing rays; empty: leaks-SEED.txt
  bool fans = false;                      ///< instead: fans beside the scalar march
  double fan_margin = 1;                  ///< factor of their margin; below 1, hits may be lost
};
/// Throws Error, after the report, when a ray was lost, false or contradictory.
void run_leaks(const LeaksOptions& options, const ReportOptions& report);
void run_fan_leaks(const LeaksOptions& options, const ReportOptions& report);

/// `edits`: time until an edit of a rectangle is visible to queries.
struct EditsOptions {
  int size = 16385;  ///< samples per side
  int rect = 256;    ///< samples per side of the rectangle
  int edits = 200;
};
void run_edits(const EditsOptions& options, const ReportOptions& report);

/// `extents`: the largest fields, int16, compared with windows cut out of them.
struct ExtentsOptions {
  std::vector<std::pair<int, int>> sizes{{65536, 512}, {65536, 65536}};  ///< columns and rows
  std::int64_t windows = 256;                                            ///< each with 256 rays
};
void run_extents(const ExtentsOptions& options, const ReportOptions& report);

/// `voxels`: the tables of the founding post for the marches of voxel grids.
struct VoxelsOptions {
  std::vector<std::string> sets{"standard", "degenerate", "empty", "far-wall"};
  std::vector<int> thousands{1, 2, 4, 8, 16};  ///< of objects, 1..16
  int stride = 4;                              ///< one tile of 8 x 8 pixels in stride x stride of 1920 x 1080
  int width = 128;                             ///< pixels per side of the pictures of one grid, from eight sides
  int block = 8;                               ///< objects per side of the larger one of these grids
  int repeats = 3;
  double pass_limit_s = 10;  ///< a slower technique traces part of the rays
  std::string device;        ///< instead: both drawing methods of a Vulkan device
  int height = 1080;         ///< of its pictures, 16 : 9
};
void run_voxels(const VoxelsOptions& options, const ReportOptions& report);
void run_device_voxels(const VoxelsOptions& options, const ReportOptions& report);  // with SCARP_VULKAN

/// `voxel-edits`: time that voxel accelerators take to follow an edit.
struct VoxelEditsOptions {
  int side = 256;     ///< voxels
  double radius = 8;  ///< of the sphere that is added and removed, in voxels
  int edits = 40;
};
void run_voxel_edits(const VoxelEditsOptions& options, const ReportOptions& report);

/// `voxel-worlds`: procedural ground as voxels, thousands a side.
struct VoxelWorldsOptions {
  int side = 4096;  ///< voxels
  int width = 256;  ///< pixels per side of the pictures, from four corners, a multiple of 8
  int repeats = 3;
  bool planes = false;  ///< also voxel-planes, which visits every voxel
  bool nanovdb = true;  ///< also NanoVDB, where installed
};
void run_voxel_worlds(const VoxelWorldsOptions& options, const ReportOptions& report);

/// `voxel-models`: all voxel marches over models from files.
struct VoxelModelsOptions {
  std::vector<std::string> files;  ///< .vox and .binvox
  int width = 256;                 ///< pixels per side of the pictures, from eight sides
  int repeats = 5;
};
void run_voxel_models(const VoxelModelsOptions& options, const ReportOptions& report);

/// `volumes`: from a file of numbers to voxels, compared with reading its bytes.
struct VolumesOptions {
  int side = 1024;  ///< voxels
  int repeats = 3;
};
void run_volumes(const VolumesOptions& options, const ReportOptions& report);

/// `voxel-leaks`: all voxel marches on very many rays, at grids and then, as many, at scenes.
struct VoxelLeaksOptions {
  std::int64_t rays = 10'000'000;
  std::uint64_t seed = 1;
  int judge_every = 64;    ///< one in this many is also traced by voxel-exhaustive
  std::string of = "all";  ///< "grids": single ones; "scenes": of rotated objects
};
void run_voxel_leaks(const VoxelLeaksOptions& options, const ReportOptions& report);

/// `pixel-match`: pictures of voxels compared with the same drawn as quads.
struct PixelMatchOptions {
  std::vector<std::string> sets{"standard", "degenerate"};
  std::vector<int> thousands{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};  ///< of objects, the post's camera
  std::vector<std::string> marches{"voxel-bricks"};
  std::string cameras = "all";  ///< or "post"
  int width = 1920, height = 1080;
  std::string device;  ///< both drawing methods of a Vulkan device; empty: the CPU
};
/// Throws Error, after the report, when a pixel differs.
void run_pixel_match(const PixelMatchOptions& options, const ReportOptions& report);

/// `scenes`: hierarchies over many objects.
struct ScenesOptions {
  std::vector<int> objects{1000, 10000, 100000};
  int rays = 100000;
  int contacts = 10000;  // queries of each kind
  int repeats = 5;
};
void run_scenes(const ScenesOptions& options, const ReportOptions& report);
/// `seams`: rays at the lines where height fields meet.
struct SeamsOptions {
  std::int64_t rays = 10'000'000;
  std::uint64_t seed = 1;
};
/// Throws Error, after the report, if a ray is lost.
void run_seams(const SeamsOptions& options, const ReportOptions& report);
/// `pitches`: cameras that look down by 0 to 90 degrees, by fans, batches and the choice between both.
struct PitchesOptions {
  FieldOptions field;
  int width = 640, height = 480;  ///< pixels; the width is rounded down to a multiple of 32
  int step = 10;                  ///< degrees
  int repeats = 3;                ///< timed passes of each; the median counts
};
void run_pitches(const PitchesOptions& options, const ReportOptions& report);

/// `sweeps`: spheres and capsules that move over ground, compared with Bullet and judged.
struct SweepsOptions {
  int size = 1025;      ///< samples per side of the field, >= 1025
  int sweeps = 20'000;  ///< of each class beside Bullet; 0: none
  int repeats = 5;
  std::int64_t judged = 100'000;  ///< random ones over small fields and voxels
  std::uint64_t seed = 1;
};
/// Throws Error, after the report, if a capsule tunnelled or a contact is false.
void run_sweeps(const SweepsOptions& options, const ReportOptions& report);
/// `render`: frames of the look `comanche`.
struct FramesOptions {
  int period = 1024;  ///< samples from repetition to repetition, even, 64..8192
  int width = 320, height = 240, steps = 256;
  int threads = 2, cameras = 8, repeats = 9;
  std::uint64_t seed = 1;
  int judge_every = 16;  ///< one pixel in this many is also traced by exhaustive
  std::string device;    ///< a Vulkan device besides the CPU, as in `scarp render --device`; empty: none
};
/// Throws Error, after the report, if the exact march has a wrong pixel, on a device more than one in a thousand: in
/// single precision a ray may pass a crest on its other side.
void run_frames(const FramesOptions& options, const ReportOptions& report);

/// `functions`: the marches over terrain functions, checked by proofs.
struct FunctionsOptions {
  int width = 480, height = 270;  ///< pixels
  int octaves = 9;                ///< of the fractals
  std::uint64_t seed = 1;
  int repeats = 3;
  std::int64_t judged = 4000;  ///< about this many rays per function are judged
  bool presets = false;        ///< instead of the marches: the presets of known shaders and lipschitz-local
  std::string device;          ///< a Vulkan device, as in `scarp render --device`; empty: none
};
/// Throws Error, after the report, if a conservative march lost a crossing.
void run_functions(const FunctionsOptions& options, const ReportOptions& report);

/// `function-leaks`: the conservative marches over the example functions, every ray judged.
struct FunctionLeaksOptions {
  std::int64_t rays = 1'000'000;  ///< in all
  std::uint64_t seed = 1;
  bool all = false;  ///< the approximate marches as well
};
/// Throws Error, after the report, if a conservative march was wrong.
void run_function_leaks(const FunctionLeaksOptions& options, const ReportOptions& report);

/// `shapes`: sphere-trace over distance fields, compared with plain sphere tracing and checked by proofs.
struct ShapesOptions {
  int width = 480, height = 270;  ///< pixels
  int repeats = 3;
  std::int64_t judged = 1000;  ///< about this many rays per shape are judged
};
/// Throws Error, after the report, if sphere-trace lost a crossing.
void run_shapes(const ShapesOptions& options, const ReportOptions& report);

}  // namespace scarp::bench
