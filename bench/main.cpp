// SPDX-License-Identifier: MIT
// scarp-bench: Scarp and its peers on the same rays in the same run. See bench/README.md for the method.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>

#include "app/cli/numbers.h"
#include "bench/commands.h"
#include "bench/gpu_command.h"
#include "bench/rays.h"
#include "bench/wrong_usage.h"
#include "scarp/base/error.h"

namespace {

using namespace scarp::bench;
using scarp::cli::kAboveZero, scarp::cli::number_in;

std::pair<int, int> size_from(const std::string& text) {
  int cols = 0, rows = 0, end = 0;
  if (std::sscanf(text.c_str(), "%dx%d%n", &cols, &rows, &end) != 2 || text.c_str()[end] != '\0' ||
      std::max(cols, rows) > 65537 || std::min(cols, rows) < 1) {
    throw scarp::Error("--sizes '" + text + "': expected COLSxROWS, each at most 65537, for example 65536x512");
  }
  return {cols, rows};
}

// Threads, repeats and rays.
void add_measure_options(CLI::App& command, TraceOptions& trace) {
  command.add_option("--threads", trace.threads, "numbers of threads, one or several")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command.add_option("--repeats", trace.repeats, "counted passes per engine")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_option("--ray-seed", trace.ray_seed, "of the rays")->capture_default_str();
  command
      .add_option("--pass-limit", trace.pass_limit_s,
                  "seconds; an engine that takes longer for a pass traces part of the rays")
      ->check(number_in(kAboveZero))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--rays",
          [&trace](const std::string& size) {
            if (size == "small") trace.rays = {160, 88, 4096, 4096, 1024, 32, 128};
          },
          "full: 1920 x 1080 pixels and 2^20 rays for each other class; small: 160 x 88 and 2^12, to see that all "
          "works")
      ->check(CLI::IsMember({"full", "small"}));
}

void add_trace_options(CLI::App& command, TraceOptions& trace) {
  command.add_option("--dem", trace.field.dem, "a raster file without holes, instead of a procedural DEM");
  command.add_option("--kind", trace.field.kind, "procedural DEM")
      ->check(CLI::IsMember({"ridged", "fbm"}))
      ->capture_default_str();
  command.add_option("--seed", trace.field.seed, "of the procedural DEM")->capture_default_str();
  command.add_option("--exaggerations", trace.exaggerations, "vertical, one or several")
      ->delimiter(',')
      ->check(number_in(kAboveZero))
      ->capture_default_str();
  add_measure_options(command, trace);
  command.add_option("--judged", trace.judged, "rays per class that the oracle answers, too")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
}

// Restricted to one instruction set, and over these samples and surface.
void add_field_options(CLI::App& command, TraceOptions& trace) {
  const auto choice = [&](const char* name, std::string& value, const char* text, std::vector<std::string> values) {
    command.add_option(name, value, text)->check(CLI::IsMember(std::move(values)))->capture_default_str();
  };
  choice("--target", trace.instruction_set, "instruction set of Scarp and Embree", {"native", "avx2", "avx512"});
  choice("--samples", trace.field.samples, "of the procedural DEM", {"float32", "int16"});
  choice("--surface", trace.field.surface, "of Scarp", {"bilinear", "triangles"});
}

void add_json_option(CLI::App& command, ReportOptions& report) {
  command.add_option("--json", report.json, "file to write {machine, command, date, rows} to")->check(writable);
  command.add_option("--csv", report.csv, "file to write the rows to, as in bench/results")->check(writable);
}

int run(int argc, char** argv) {
  CLI::App app("Scarp beside its peers, on the same rays in the same run.", "scarp-bench");
  app.require_subcommand(1);
  ReportOptions report;
  for (int i = 0; i < argc; ++i) report.command += (i ? " " : "") + std::string(i ? argv[i] : "scarp-bench");

  HeightsOptions heights;
  CLI::App* heights_command = app.add_subcommand("heights", "all marches beside all modes of Embree");
  heights_command->add_option("--sizes", heights.sizes, "samples per side of the procedural DEM, one or several")
      ->delimiter(',')
      ->check(CLI::Range(kLeastSize, kMostSize))
      ->capture_default_str();
  heights_command->add_option("--classes", heights.classes, "of rays")
      ->delimiter(',')
      ->check(CLI::IsMember(heights.classes))
      ->capture_default_str();
  heights_command->add_option("--engines", heights.engines, "to measure")
      ->delimiter(',')
      ->check(CLI::IsMember({"scarp", "embree-tri", "embree-grid", "bullet"}))
      ->capture_default_str();
  heights_command->add_option("--embree-quality", heights.embree_quality, "of Embree's build")
      ->check(CLI::IsMember({"medium", "high"}))
      ->capture_default_str();
  heights_command->add_option("--marches", heights.marches, "modes of scarp to measure (all)")->delimiter(',');
  add_field_options(*heights_command, heights.trace);
  add_trace_options(*heights_command, heights.trace);
  add_json_option(*heights_command, report);

  SurveyOptions survey;
  CLI::App* survey_command =
      app.add_subcommand("survey", "Scarp over Embree in several fields, from several cameras: median and worst");
  survey_command->add_option("--size", survey.trace.field.size, "samples per side of the procedural DEMs")
      ->check(CLI::Range(kLeastSize, kMostSize))
      ->capture_default_str();
  survey_command->add_option("--kinds", survey.kinds, "of procedural DEMs, one or several")
      ->delimiter(',')
      ->check(CLI::IsMember({"ridged", "fbm"}))
      ->capture_default_str();
  survey_command->add_option("--dems", survey.dems, "raster files without holes, too")->delimiter(',');
  survey_command->add_option("--classes", survey.classes, "of rays")
      ->delimiter(',')
      ->check(CLI::IsMember(survey.classes))
      ->capture_default_str();
  survey_command->add_option("--peers", survey.peers, "to measure")
      ->delimiter(',')
      ->check(CLI::IsMember(survey.peers))
      ->capture_default_str();
  add_field_options(*survey_command, survey.trace);
  add_measure_options(*survey_command, survey.trace);
  add_json_option(*survey_command, report);

  NaiveOptions naive;
  naive.trace.exaggerations = {1, 4, 16};
  CLI::App* naive_command =
      app.add_subcommand("naive", "the max-mip article's comparison, naive made as fine as it takes");
  naive_command->add_option("--size", naive.trace.field.size, "samples per side of the procedural DEM")
      ->check(CLI::Range(kLeastSize, kMostSize))
      ->capture_default_str();
  naive_command->add_option("--miss-limit", naive.miss_limit, "share of the hits that naive may miss")
      ->check(number_in({0, 1}))
      ->capture_default_str();
  add_trace_options(*naive_command, naive.trace);
  add_json_option(*naive_command, report);

  BatchesOptions batches;
  CLI::App* batches_command = app.add_subcommand("batches", "the library's batch calls, from ten rays to ten million");
  batches_command->add_option("--size", batches.trace.field.size, "samples per side of the procedural DEM")
      ->check(CLI::Range(33, 32767))
      ->capture_default_str();
  batches_command->add_option("--classes", batches.classes, "of rays")
      ->delimiter(',')
      ->check(CLI::IsMember({"primary", "shadow", "grazing", "ao"}))
      ->capture_default_str();
  batches_command->add_option("--batches", batches.batches, "rays in a batch, one or several")
      ->delimiter(',')
      ->check(number_in({1, 1e8}))
      ->capture_default_str();
  add_trace_options(*batches_command, batches.trace);
  add_json_option(*batches_command, report);

  std::vector<std::string> all_classes;
  for (const RayClass ray_class : kRayClasses) all_classes.emplace_back(name_of(ray_class));
  SimdOptions simd;
  CLI::App* simd_command = app.add_subcommand("simd", "the vectors beside the scalar walk, and what each idea gains");
  simd_command->add_option("--size", simd.trace.field.size, "samples per side of the procedural DEM")
      ->check(CLI::Range(kLeastSize, kMostSize))
      ->capture_default_str();
  simd_command->add_option("--classes", simd.classes, "of rays")
      ->delimiter(',')
      ->check(CLI::IsMember(all_classes))
      ->capture_default_str();
  add_trace_options(*simd_command, simd.trace);
  add_json_option(*simd_command, report);

  VolumesOptions volumes;
  CLI::App* volumes_command = app.add_subcommand("volumes", "how fast files of numbers become voxels");
  volumes_command->add_option("--side", volumes.side, "voxels per side")
      ->check(CLI::Range(8, 2048))
      ->capture_default_str();
  volumes_command->add_option("--repeats", volumes.repeats, "counted passes")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_json_option(*volumes_command, report);

  PyramidOptions pyramid;
  CLI::App* pyramid_command = app.add_subcommand("pyramid", "how fast the pyramid of maxima is built");
  pyramid_command->add_option("--sizes", pyramid.sizes, "samples per side, one or several")
      ->delimiter(',')
      ->check(CLI::Range(2, 65536))
      ->capture_default_str();
  pyramid_command->add_option("--repeats", pyramid.repeats, "counted builds")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_json_option(*pyramid_command, report);

  MapsOptions maps;
  CLI::App* maps_command = app.add_subcommand("maps", "viewsheds and shadows of all nodes");
  maps_command->add_option("--sizes", maps.sizes, "samples per side, one or several")
      ->delimiter(',')
      ->check(CLI::Range(2, 32768))
      ->capture_default_str();
  maps_command->add_option("--kind", maps.kind, "procedural DEM")
      ->check(CLI::IsMember({"fbm", "ridged"}))
      ->capture_default_str();
  maps_command->add_option("--seed", maps.seed, "of the DEM")->capture_default_str();
  maps_command->add_option("--observer-height", maps.observer_height, "metres above ground")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  maps_command->add_option("--sun-azimuth", maps.azimuth_deg, "degrees")
      ->check(CLI::Range(0, 360))
      ->capture_default_str();
  maps_command->add_option("--sun-altitude", maps.altitude_deg, "degrees")
      ->check(CLI::Range(1, 90))
      ->capture_default_str();
  maps_command->add_option("--repeats", maps.repeats, "counted passes")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  maps_command->add_option("--judged", maps.judged, "nodes per map that a ray answers, too")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  maps_command->add_option("--lines", maps.lines, "of sight, of 500 cells each; 0: none")
      ->check(CLI::Range(0, 100'000'000))
      ->capture_default_str();
#ifdef SCARP_BENCH_GDAL
  maps.scarp = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "scarp").string();
  std::vector<std::string> map_programs = maps.programs;
  map_programs.emplace_back("none");
  maps_command->add_option("--programs", maps.programs, "programs to measure as whole processes, if installed")
      ->delimiter(',')
      ->check(CLI::IsMember(map_programs))
      ->capture_default_str();
  maps_command->add_option("--scarp", maps.scarp, "path of scarp, one of the programs")
      ->check(CLI::ExistingFile)
      ->default_str("beside scarp-bench");
  maps_command->add_option("--observers", maps.observers, "of a cumulative viewshed; 0: none")
      ->check(CLI::Range(0, 65533))
      ->capture_default_str();
  maps_command->add_option("--program-limit", maps.program_limit_s, "seconds that a program may take")
      ->check(number_in(kAboveZero))
      ->capture_default_str();
#endif
  add_json_option(*maps_command, report);

  ViewOptions view;
  CLI::App* view_command = app.add_subcommand("view", "the window on a display without a screen");
  view_command->add_option("--sizes", view.sizes, "samples per side, one or several")
      ->delimiter(',')
      ->check(CLI::Range(kLeastSize, kMostSize))
      ->capture_default_str();
  view_command->add_option("--csv", view.csv, "file to write the rows to, as in bench/results");

#ifdef SCARP_BENCH_VULKAN
  DevicesOptions devices;
  CLI::App* devices_command = add_devices_command(app, devices);
  GpuOptions gpu;
  CLI::App* gpu_command = add_gpu_command(app, gpu);
  add_json_option(*gpu_command, report);

  ShadersOptions shaders;
  CLI::App* shaders_command = app.add_subcommand(
      "shaders", "each shader compiled for AMD cards that need not be there: size, registers, spills");
  shaders_command->add_option("--families", shaders.families, "of cards as RADV names them, one or several")
      ->delimiter(',')
      ->capture_default_str();
  CLI::Option* only = shaders_command->add_option("--shader", shaders.shader, "only those whose path contains this");
  shaders_command
      ->add_option("--update", shaders.update,
                   "table to rewrite with these figures: bench/shader_statistics.csv, with navi21 alone")
      ->excludes(only);
  add_json_option(*shaders_command, report);
#endif

  SimtOptions simt;
  CLI::App* simt_command = app.add_subcommand(
      "simt", "what bundles of rays in lockstep pay with max-mip and with naive, counted on the CPU");
  simt_command->add_option("--sizes", simt.sizes, "samples per side of the procedural DEM, one or several")
      ->delimiter(',')
      ->check(CLI::Range(kLeastSize, kMostSize))
      ->capture_default_str();
  simt_command->add_option("--kind", simt.field.kind, "procedural DEM")
      ->check(CLI::IsMember({"ridged", "fbm"}))
      ->capture_default_str();
  simt_command->add_option("--seed", simt.field.seed, "of the procedural DEM")->capture_default_str();
  simt_command->add_option("--classes", simt.classes, "of rays")
      ->delimiter(',')
      ->check(CLI::IsMember(simt.classes))
      ->capture_default_str();
  simt_command->add_option("--groups", simt.groups, "of 64 successive rays, spread evenly over each class")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 20))
      ->capture_default_str();
  simt_command->add_option("--ray-seed", simt.ray_seed, "of the rays")->capture_default_str();
  simt_command
      ->add_option_function<std::string>(
          "--rays",
          [&simt](const std::string& size) {
            if (size == "small") simt.rays = {160, 88, 4096, 4096, 64};
          },
          "full: groups of 1920 x 1080 pixels and 2^20 rays for each other class; small: of 160 x 88 and 2^12, to see "
          "that all works")
      ->check(CLI::IsMember({"full", "small"}));
  simt_command->add_flag("--voxels", simt.voxels, "instead: the voxel marches, in pictures of many objects");
  simt_command->add_option("--wrong-limit", simt.wrong_limit, "share of rays that naive may get wrong")
      ->check(number_in({0, 1}))
      ->capture_default_str();
  simt_command->add_option("--blocks", simt.blocks,
                           "table of instructions by block (bench/simt_blocks.csv of the sources)");
#ifdef SCARP_BENCH_VULKAN
  simt_command->add_flag("--recount", simt.recount,
                         "count the instructions by RADV, as this build compiles the shaders");
  simt_command->add_option("--disassembly", simt.disassembly, "folder for what --recount counts")->needs("--recount");
  simt_command->add_option("--update", simt.update, "table to write after --recount; traces no rays")
      ->needs("--recount");
#endif
  add_json_option(*simt_command, report);

  LeaksOptions leaks;
  CLI::App* leaks_command =
      app.add_subcommand("leaks", "very many rays at what engines lose; fails when Scarp loses one");
  // Written as 1e9, too.
  double leak_rays = static_cast<double>(leaks.rays), embree_rays = static_cast<double>(leaks.embree_rays);
  leaks_command->add_option("--rays", leak_rays, "in all")->check(number_in({1, 1e15}))->capture_default_str();
  leaks_command->add_option("--seed", leaks.seed, "of fields and rays")->capture_default_str();
  leaks_command->add_option("--large", leaks.large, "samples per side of the large field")
      ->check(CLI::Range(kLeastSize, kMostSize))
      ->capture_default_str();
  leaks_command->add_option("--judge-every", leaks.judge_every, "one in so many is also answered by exhaustive")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40))
      ->capture_default_str();
  leaks_command->add_option("--embree-rays", embree_rays, "at most about so many are also given to Embree")
      ->check(number_in({0, 1e15}))
      ->capture_default_str();
  leaks_command->add_option("--dump", leaks.dump, "file for the first failing rays (leaks-SEED.txt)");
  leaks_command->add_flag("--fans", leaks.fans, "instead: fans beside the scalar march");
  leaks_command->add_option("--fan-margin", leaks.fan_margin, "factor of the fans' margin; below 1, hits may be lost")
      ->check(number_in({0, 1e6}))
      ->capture_default_str()
      ->needs("--fans");
  add_json_option(*leaks_command, report);

  EditsOptions edits;
  CLI::App* edits_command = app.add_subcommand("edits", "how soon an edit is visible to queries");
  edits_command->add_option("--size", edits.size, "samples per side")
      ->check(CLI::Range(2, 65536))
      ->capture_default_str();
  edits_command->add_option("--rect", edits.rect, "samples per side of the rectangle that is edited")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  edits_command->add_option("--edits", edits.edits, "counted edits")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  add_json_option(*edits_command, report);

  ExtentsOptions extents;
  std::vector<std::string> extent_sizes{"65536x512", "65536x65536"};
  CLI::App* extents_command = app.add_subcommand("extents", "the largest fields, beside windows cut out of them");
  extents_command->add_option("--sizes", extent_sizes, "COLSxROWS, one or several; 65536x65536 takes 15 GB")
      ->delimiter(',')
      ->capture_default_str();
  extents_command->add_option("--windows", extents.windows, "windows, of 256 rays each")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  add_json_option(*extents_command, report);

  VoxelsOptions voxels;
  CLI::App* voxels_command =
      app.add_subcommand("voxels", "the founding post's tables: 1k to 16k objects of 32^3 voxels");
  voxels_command->add_option("--sets", voxels.sets, "of objects")
      ->delimiter(',')
      ->check(CLI::IsMember(voxels.sets))
      ->capture_default_str();
  voxels_command->add_option("--thousands", voxels.thousands, "thousands of objects, one or several")
      ->delimiter(',')
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  voxels_command->add_option("--stride", voxels.stride, "one tile of 8 x 8 pixels in N x N of 1920 x 1080")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  voxels_command->add_option("--width", voxels.width, "pixels per side of the pictures of one grid, a multiple of 8")
      ->check(CLI::Range(8, 2048))
      ->capture_default_str();
  voxels_command->add_option("--block", voxels.block, "objects per side of the larger one of these grids")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  voxels_command->add_option("--repeats", voxels.repeats, "counted passes")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  voxels_command
      ->add_option("--pass-limit", voxels.pass_limit_s,
                   "seconds; a technique that takes longer traces part of the rays")
      ->check(number_in(kAboveZero))
      ->capture_default_str();
#ifdef SCARP_BENCH_VULKAN
  voxels_command->add_option("--device", voxels.device,
                             "instead: both ways of drawing of a Vulkan device, and its triangles: cpu, gpu, auto or "
                             "part of a name");
  voxels_command->add_option("--height", voxels.height, "pixels of the pictures of --device, 16 : 9")
      ->check(CLI::Range(9, 1080))
      ->capture_default_str();
#endif
  add_json_option(*voxels_command, report);

  VoxelEditsOptions voxel_edits;
  CLI::App* voxel_edits_command =
      app.add_subcommand("voxel-edits", "how long accelerators of voxels take to follow an edit");
  voxel_edits_command->add_option("--side", voxel_edits.side, "voxels per side")
      ->check(CLI::Range(16, 512))
      ->capture_default_str();
  voxel_edits_command
      ->add_option("--radius", voxel_edits.radius, "of the spheres that are added and removed, in voxels")
      ->check(number_in(kAboveZero))
      ->capture_default_str();
  voxel_edits_command->add_option("--edits", voxel_edits.edits, "spheres")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  add_json_option(*voxel_edits_command, report);

  VoxelWorldsOptions voxel_worlds;
  CLI::App* voxel_worlds_command = app.add_subcommand("voxel-worlds", "ground of voxels, thousands a side");
  voxel_worlds_command->add_option("--side", voxel_worlds.side, "voxels per side")
      ->check(CLI::Range(33, 16384))
      ->capture_default_str();
  voxel_worlds_command->add_option("--width", voxel_worlds.width, "pixels per side of the pictures, a multiple of 8")
      ->check(CLI::Range(8, 2048))
      ->capture_default_str();
  voxel_worlds_command->add_option("--repeats", voxel_worlds.repeats, "counted passes")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  voxel_worlds_command->add_flag("--planes", voxel_worlds.planes, "also voxel-planes, which visits every voxel");
  voxel_worlds_command->add_flag("!--no-nanovdb", voxel_worlds.nanovdb, "without NanoVDB");
  add_json_option(*voxel_worlds_command, report);

  VoxelModelsOptions voxel_models;
  CLI::App* voxel_models_command =
      app.add_subcommand("voxel-models", "all voxel marches over the models of files: building, memory, speed");
  voxel_models_command->add_option("files", voxel_models.files, ".vox and .binvox")
      ->required()
      ->check(CLI::ExistingFile);
  voxel_models_command->add_option("--width", voxel_models.width, "pixels per side of the pictures, a multiple of 8")
      ->check(CLI::Range(8, 2048))
      ->capture_default_str();
  voxel_models_command->add_option("--repeats", voxel_models.repeats, "counted passes")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_json_option(*voxel_models_command, report);

  VoxelLeaksOptions voxel_leaks;
  double voxel_leak_rays = static_cast<double>(voxel_leaks.rays);
  CLI::App* voxel_leaks_command =
      app.add_subcommand("voxel-leaks", "very many rays at voxel grids; fails when marches differ");
  voxel_leaks_command->add_option("--rays", voxel_leak_rays, "in all")
      ->check(number_in({1, 1e15}))
      ->capture_default_str();
  voxel_leaks_command->add_option("--seed", voxel_leaks.seed, "of grids and rays")->capture_default_str();
  voxel_leaks_command
      ->add_option("--judge-every", voxel_leaks.judge_every, "one in so many is also answered by voxel-exhaustive")
      ->check(CLI::Range(1, 1 << 30))
      ->capture_default_str();
  voxel_leaks_command->add_option("--of", voxel_leaks.of, "grids, scenes of turned objects, or all")
      ->check(CLI::IsMember({"grids", "scenes", "all"}))
      ->capture_default_str();
  add_json_option(*voxel_leaks_command, report);

  ScenesOptions scenes;
  CLI::App* scenes_command = app.add_subcommand("scenes", "hierarchies over many objects: how soon built, how fast");
  scenes_command->add_option("--objects", scenes.objects, "one or several")
      ->delimiter(',')
      ->check(CLI::Range(1, 1 << 24))
      ->capture_default_str();
  scenes_command->add_option("--rays", scenes.rays, "per pass")->check(CLI::Range(1, 1 << 28))->capture_default_str();
  scenes_command->add_option("--contacts", scenes.contacts, "sweeps, overlaps and closest points per pass")
      ->check(CLI::Range(1, 1 << 24))
      ->capture_default_str();
  scenes_command->add_option("--repeats", scenes.repeats, "passes")->check(CLI::Range(1, 1000))->capture_default_str();
  add_json_option(*scenes_command, report);
  SeamsOptions seams;
  CLI::App* seams_command =
      app.add_subcommand("seams", "rays at the lines where height fields meet: how many are lost");
  seams_command->add_option("--rays", seams.rays, "in all")->check(number_in({1, 1e15}))->capture_default_str();
  seams_command->add_option("--seed", seams.seed, "of terrains and rays")->capture_default_str();
  add_json_option(*seams_command, report);

  PitchesOptions pitches;
  CLI::App* pitches_command = app.add_subcommand(
      "pitches", "cameras that look down by 0 to 90 degrees: rays by fans, by batches, and by the choice between both");
  pitches_command->add_option("--size", pitches.field.size, "samples per side of the procedural DEM")
      ->check(CLI::Range(64, 1 << 14))
      ->capture_default_str();
  pitches_command->add_option("--repeats", pitches.repeats, "timed passes of each; the median counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  pitches_command->add_option("--step", pitches.step, "degrees")->check(CLI::Range(1, 90))->capture_default_str();
  add_json_option(*pitches_command, report);
  SweepsOptions sweeps;
  CLI::App* sweeps_command = app.add_subcommand(
      "sweeps", "spheres and capsules that move over ground, beside Bullet; random ones, judged by all triangles");
  sweeps_command->add_option("--size", sweeps.size, "samples per side of the field")
      ->check(number_in({1025, 16385}))
      ->capture_default_str();
  sweeps_command->add_option("--sweeps", sweeps.sweeps, "of each class beside Bullet; 0: none")
      ->check(number_in({0, 1e8}))
      ->capture_default_str();
  sweeps_command->add_option("--repeats", sweeps.repeats, "timed passes; the median counts")
      ->check(number_in({1, 1000}))
      ->capture_default_str();
  sweeps_command->add_option("--judged", sweeps.judged, "random sweeps before the judge")
      ->check(number_in({0, 1e12}))
      ->capture_default_str();
  sweeps_command->add_option("--seed", sweeps.seed, "of the sweeps")->capture_default_str();
  add_json_option(*sweeps_command, report);
  FramesOptions frames;
  CLI::App* frames_command =
      app.add_subcommand("render", "frames of the look comanche over endless ground: milliseconds and wrong pixels");
  frames_command->add_option("--period", frames.period, "samples from repetition to repetition, an even number")
      ->check(CLI::Range(64, 8192))
      ->capture_default_str();
  frames_command->add_option("--width", frames.width, "pixels")->check(CLI::Range(1, 16384))->capture_default_str();
  frames_command->add_option("--height", frames.height, "pixels")->check(CLI::Range(1, 16384))->capture_default_str();
  frames_command->add_option("--steps", frames.steps, "of fixed-step")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  frames_command->add_option("--threads", frames.threads, "at once")->check(CLI::Range(1, 1024))->capture_default_str();
  frames_command->add_option("--cameras", frames.cameras, "along a flight")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  frames_command->add_option("--repeats", frames.repeats, "counted passes over the flight")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  frames_command->add_option("--seed", frames.seed, "of the ground")->capture_default_str();
  frames_command->add_option("--judge-every", frames.judge_every, "one pixel in so many is answered by exhaustive, too")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  frames_command->add_option("--device", frames.device,
                             "a Vulkan device beside the CPU: cpu, gpu, auto, part of a name");
  add_json_option(*frames_command, report);

  FunctionsOptions functions;
  CLI::App* functions_command = app.add_subcommand("functions", "the marches over terrain functions, beside proofs");
  functions_command->add_option("--width", functions.width, "pixels")
      ->check(CLI::Range(1, 16384))
      ->capture_default_str();
  functions_command->add_option("--height", functions.height, "pixels")
      ->check(CLI::Range(1, 16384))
      ->capture_default_str();
  functions_command->add_option("--octaves", functions.octaves, "of the fractals")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  functions_command->add_option("--seed", functions.seed, "of the noise")->capture_default_str();
  functions_command->add_option("--repeats", functions.repeats, "counted passes")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  functions_command->add_option("--judged", functions.judged, "rays per function that the judge answers, about")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40))
      ->capture_default_str();
  functions_command->add_flag("--presets", functions.presets,
                              "the presets of known shaders beside lipschitz-local, instead of the marches");
  functions_command->add_option("--device", functions.device,
                                "cpu, gpu, auto or part of a name: the marches on that Vulkan device, too");
  add_json_option(*functions_command, report);

  FunctionLeaksOptions function_leaks;
  CLI::App* function_leaks_command =
      app.add_subcommand("function-leaks", "very many rays at terrain functions; fails when Scarp loses one");
  double function_leak_rays = static_cast<double>(function_leaks.rays);
  function_leaks_command->add_option("--rays", function_leak_rays, "in all")
      ->check(number_in({1, 1e15}))
      ->capture_default_str();
  function_leaks_command->add_option("--seed", function_leaks.seed, "of the rays")->capture_default_str();
  function_leaks_command->add_flag("--all", function_leaks.all, "the approximate marches as well");
  add_json_option(*function_leaks_command, report);

  ShapesOptions shapes;
  CLI::App* shapes_command =
      app.add_subcommand("shapes", "sphere-trace over distance fields, beside balls alone and proofs");
  shapes_command->add_option("--width", shapes.width, "pixels")->check(CLI::Range(1, 16384))->capture_default_str();
  shapes_command->add_option("--height", shapes.height, "pixels")->check(CLI::Range(1, 16384))->capture_default_str();
  shapes_command->add_option("--repeats", shapes.repeats, "counted passes")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  shapes_command->add_option("--judged", shapes.judged, "rays per shape that the judge answers, about")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40))
      ->capture_default_str();
  add_json_option(*shapes_command, report);

  PixelMatchOptions pixel_match;
  CLI::App* pixel_match_command = app.add_subcommand(
      "pixel-match", "pictures of voxels beside the same drawn as quads; fails when a pixel differs");
  pixel_match_command->add_option("--sets", pixel_match.sets, "of objects")
      ->delimiter(',')
      ->check(CLI::IsMember({"standard", "degenerate", "far-wall"}))
      ->capture_default_str();
  pixel_match_command->add_option("--thousands", pixel_match.thousands, "thousands of objects, one or several")
      ->delimiter(',')
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  pixel_match_command->add_option("--marches", pixel_match.marches, "one or several")
      ->delimiter(',')
      ->capture_default_str();
  pixel_match_command->add_option("--cameras", pixel_match.cameras, "post or all")
      ->check(CLI::IsMember({"post", "all"}))
      ->capture_default_str();
  pixel_match_command->add_option("--width", pixel_match.width, "pixels")
      ->check(CLI::Range(2, 2048))
      ->capture_default_str();
  pixel_match_command->add_option("--height", pixel_match.height, "pixels")
      ->check(CLI::Range(2, 2048))
      ->capture_default_str();
#ifdef SCARP_BENCH_VULKAN
  pixel_match_command->add_option("--device", pixel_match.device,
                                  "both ways of drawing of a Vulkan device instead of the CPU, and its triangles: cpu, "
                                  "gpu, auto or part of a name");
#endif
  add_json_option(*pixel_match_command, report);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    std::fprintf(stderr, "scarp-bench: %s\n", scarp::bench::wrong_usage(error, app).c_str());
    return scarp::bench::kWrongUsage;
  }
  voxel_leaks.rays = static_cast<std::int64_t>(voxel_leak_rays);
  leaks.rays = static_cast<std::int64_t>(leak_rays);
  function_leaks.rays = static_cast<std::int64_t>(function_leak_rays);
  leaks.embree_rays = static_cast<std::int64_t>(embree_rays);
  if (*heights_command) run_heights(heights, report);
  if (*survey_command) run_survey(survey, report);
  if (*naive_command) run_naive(naive, report);
  if (*batches_command) run_batches(batches, report);
  if (*simd_command) run_simd(simd, report);
  if (*volumes_command) run_volumes(volumes, report);
  if (*pyramid_command) run_pyramid(pyramid, report);
  if (*maps_command) run_maps(maps, report);
  if (*view_command) run_view(view);
#ifdef SCARP_BENCH_VULKAN
  if (*devices_command) run_devices(devices);
  if (*gpu_command) (gpu.raster ? run_gpu_raster : run_gpu)(gpu, report);
  if (*shaders_command) run_shaders(shaders, report);
  if (*voxels_command && !voxels.device.empty()) run_device_voxels(voxels, report);
#endif
  if (*voxels_command && voxels.device.empty()) run_voxels(voxels, report);
  if (*simt_command) run_simt(simt, report);
  if (*leaks_command) leaks.fans ? run_fan_leaks(leaks, report) : run_leaks(leaks, report);
  if (*voxel_edits_command) run_voxel_edits(voxel_edits, report);
  if (*voxel_worlds_command) run_voxel_worlds(voxel_worlds, report);
  if (*voxel_models_command) run_voxel_models(voxel_models, report);
  if (*voxel_leaks_command) run_voxel_leaks(voxel_leaks, report);
  if (*pixel_match_command) run_pixel_match(pixel_match, report);
  if (*edits_command) run_edits(edits, report);
  if (*scenes_command) run_scenes(scenes, report);
  if (*seams_command) run_seams(seams, report);
  if (*pitches_command) run_pitches(pitches, report);
  if (*sweeps_command) run_sweeps(sweeps, report);
  if (*frames_command) run_frames(frames, report);
  if (*functions_command) run_functions(functions, report);
#ifdef SCARP_BENCH_GDAL
  if (*function_leaks_command) run_function_leaks(function_leaks, report);
#else
  if (*function_leaks_command)
    throw scarp::Error("function-leaks: this scarp-bench was built without GDAL; build with SCARP_GDAL=ON");
#endif
  if (*shapes_command) run_shapes(shapes, report);
  if (*extents_command) {
    extents.sizes.clear();
    for (const std::string& text : extent_sizes) extents.sizes.push_back(size_from(text));
    run_extents(extents, report);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scarp-bench: %s\n", error.what());
    return 1;
  }
}
