// SPDX-License-Identifier: MIT
// `scarp voxelise`: terrain and scenes made voxels, as a MagicaVoxel or binvox file.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "app/cli/commands.h"
#include "app/cli/field_options.h"
#include "app/cli/input_kind.h"
#include "app/cli/kept_inputs.h"
#include "app/cli/numbers.h"
#include "app/cli/progress.h"
#include "app/cli/raster_options.h"
#include "app/cli/scene_input.h"
#include "app/cli/vox_input.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/render/surface/voxel_colours.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/scene/file/to_vox.h"
#include "scarp/scene/voxelised.h"
#include "scarp/source/binvox.h"
#include "scarp/source/read_raster.h"

namespace scarp::cli {
namespace {

struct VoxeliseOptions {
  std::vector<std::string> inputs;
  std::string output, within, ramp = "hypsometric";
  RasterOptions raster;
  FieldOptions field;
  VoxOptions vox;
  double voxel = 0;  // 0: not given
  int count = 0;     // 0: not given
  int threads = 0;
  std::vector<std::string> given;  // the names of the options that were typed
};

constexpr int kUsualCount = 256;

struct Input {
  Scene scene;
  std::vector<Material> materials;
  std::vector<std::string> notes;
  std::vector<std::string> files;  // that were read, beside those that were typed
};

Input terrain(const VoxeliseOptions& options) {
  Raster raster = read_tiles(options.inputs, options.raster, terminal_progress("read"));
  stop_if_interrupted();
  const std::string path = raster.path;
  std::vector<std::string> notes = raster.notes, files = raster.files;
  HeightField field = height_field_from(std::move(raster), options.field);
  if (!field.has_cells() || field.all_nodata())
    throw Error(fmt::format("raster '{}': there is no ground between its samples", path));
  const HeightRamp ramp{options.ramp, field.min_height(), field.max_height()};
  return {Scene(scene_heights(std::move(field))), {ramp}, std::move(notes), std::move(files)};
}

Input voxels(const VoxeliseOptions& options) {
  VoxInput input = read_voxels(options.inputs.front(), options.vox, {}, {});
  return {Scene(scene_voxels(std::move(input.scene), VoxelSceneOptions{}.march)), {}, {}, {}};
}

Input input_of(const VoxeliseOptions& options) {
  const bool vox = is_vox_input(options.inputs, options.vox), scene = !vox && is_scene_input(options.inputs);
  require_options_of(vox ? InputKind::voxels : scene ? InputKind::scene : InputKind::terrain, options.given);
  require_company({{{"--ramp"}, !vox && !scene, "terrain, whose heights it colours"}}, options.given);
  if (vox) return voxels(options);
  if (!scene) return terrain(options);
  SceneFile document = read_scene(options.inputs.front(), terminal_progress("read"));
  return {std::move(document.scene), std::move(document.materials), std::move(document.notes),
          std::move(document.files)};
}

std::optional<WorldBox> box_of(const VoxeliseOptions& options) {
  if (options.within.empty()) return {};
  const auto n = numbers_from(options.within, ',', 6, 6, "--within",
                              "XLOW,YLOW,ZLOW,XHIGH,YHIGH,ZHIGH in metres, for example 0,0,-10,100,100,40");
  return WorldBox{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
}

double side_of(const VoxeliseOptions& options, const Scene& scene, const std::optional<WorldBox>& within) {
  if (!within && scene.endless())
    throw Error("--within: the scene has no end; say of which box voxels are made, XLOW,YLOW,ZLOW,XHIGH,YHIGH,ZHIGH");
  if (options.voxel > 0) return options.voxel;
  // Voxels stay what they are.
  if (options.count == 0 && is_vox_input(options.inputs, options.vox)) return 1;
  const WorldBox& box = within ? *within : scene.box();
  const dvec3 size = box.high - box.low;
  // One less, for the lattice does not begin where the box does.
  return std::max({size.x, size.y, size.z}) / std::max(1, (options.count > 0 ? options.count : kUsualCount) - 1);
}

void run(const VoxeliseOptions& options) {
  const std::string extension = extension_of(options.output);
  if (extension != ".vox" && extension != ".binvox") {
    throw Error(
        fmt::format("output '{}': voxels are written as MagicaVoxel or binvox; let the name end in .vox or "
                    ".binvox",
                    options.output));
  }
  const std::optional<WorldBox> within = box_of(options);
  const ThreadLimit limit(options.threads);
  const Input input = input_of(options);
  keep_inputs(options.output, input.files);
  stop_if_interrupted();
  const double side = side_of(options, input.scene, within);
  const VoxelLattice lattice = lattice_around(input.scene, side, within);
  const VoxelGrid grid = voxelised(input.scene, lattice, voxel_colours(input.materials), terminal_progress("voxelise"));
  if (grid.solid_count() == 0)
    throw Error(fmt::format("'{}': no voxel of {:.6g} m has its middle inside; take smaller ones",
                            options.inputs.front(), side));
  bool exact_colours = true;
  if (extension == ".vox") {
    write_vox(options.output, vox_file_of(grid, lattice.box.low, exact_colours));
  } else {
    Binvox binvox;
    binvox.size = grid.size();
    binvox.translate = side * dvec3(lattice.box.low);
    binvox.scale = side * std::max({grid.size().x, grid.size().y, grid.size().z});
    binvox.clear();
    for_each_voxel(grid.bounds(), [&](const ivec3& v) {
      if (grid.solid(v)) binvox.set(v);
    });
    write_binvox(options.output, binvox);
  }
  for (const std::string& note : input.notes) fmt::print(stderr, "note: {}\n", note);
  if (!exact_colours)
    fmt::print(stderr, "note: more than 255 colours; each is the nearest of 252 evenly spaced ones\n");
  fmt::print("{}: {} x {} x {} voxels of {:.6g} m, {} solid\n", options.output, grid.size().x, grid.size().y,
             grid.size().z, side, grid.solid_count());
}

}  // namespace

void add_voxelise(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("voxelise", "Make voxels of terrain, a scene or other voxels: .vox or .binvox");
  const auto options = std::make_shared<VoxeliseOptions>();
  VoxeliseOptions& o = *options;
  add_raster_inputs(*command, o.inputs);
  command->add_option("-o,--output", o.output, "the .vox or .binvox file to write")->required();
  CLI::Option* voxel =
      command->add_option("--voxel", o.voxel, "metres of a voxel's side")->check(number_in(kAboveZero));
  command->add_option("--count", o.count, "voxels along the longest side, 2 to 2048 (256)")
      ->check(CLI::Range(2, VoxelGrid::kMaxSide))
      ->excludes(voxel);
  command->add_option("--within", o.within, "XLOW,YLOW,ZLOW,XHIGH,YHIGH,ZHIGH: a box in metres (all)");
  command->add_option("--ramp", o.ramp, "colours by height, of terrain")->capture_default_str();
  command->add_option("--threads", o.threads, "threads, 0 for all")->check(CLI::Range(0, 1024))->capture_default_str();
  add_raster_options(*command, o.raster);
  add_field_options(*command, o.field, BeyondBorders::none);
  add_vox_options(*command, o.vox);
  command->callback([options, command] {
    options->given = given_options(*command);
    keep_inputs(options->output, typed_values(*command));
    run(*options);
  });
}

}  // namespace scarp::cli
