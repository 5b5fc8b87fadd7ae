// SPDX-License-Identifier: MIT
// `scarp voxelise`: converts every input to voxels, as a MagicaVoxel, binvox or OpenVDB file.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "app/cli/commands.h"
#include "app/cli/options/field_options.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/open_input.h"
#include "app/cli/options/raster_options.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/progress.h"
#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/render/surface/voxel_colours.h"
#ifdef SCARP_EMBREE
#include "scarp/scene/mesh/scene_mesh.h"
#endif
#include "scarp/scene/file/to_vdb.h"
#include "scarp/scene/file/to_vox.h"
#include "scarp/scene/voxelised.h"
#include "scarp/source/voxel/binvox.h"

namespace scarp::cli {
namespace {

struct VoxeliseOptions : InputOptions {
  std::string output, within, ramp = "hypsometric";
  double voxel = 0;  // 0: not given
  int count = 0;     // 0: not given
  int threads = 0;
};

constexpr int kUsualCount = 256;

// Materials that colour the voxels.
std::vector<Material> materials_of(const OpenedInput& input, const std::string& ramp) {
  if (input.document) return input.document->materials;
  const HeightField* field = input.scene.only_heights();
  if (!field) return {};
  if (!field->has_ground())
    throw Error(
        fmt::format("{}: there is no ground between its samples (at least 2 x 2 valid ones are needed)", input.path));
  return {HeightRamp{ramp, field->min_height(), field->max_height()}};
}

std::optional<WorldBox> box_of(const VoxeliseOptions& options) {
  if (options.within.empty()) return {};
  const auto n = numbers_from(options.within, ',', 6, 6, "--within",
                              "XLOW,YLOW,ZLOW,XHIGH,YHIGH,ZHIGH in metres, for example 0,0,-10,100,100,40");
  return WorldBox{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
}

double side_of(const VoxeliseOptions& options, InputKind kind, const Scene& scene,
               const std::optional<WorldBox>& within) {
  if (!within && scene.endless())
    throw Error("--within is required: the scene is endless (give XLOW,YLOW,ZLOW,XHIGH,YHIGH,ZHIGH)");
  if (options.voxel > 0) return options.voxel;
  // Voxel inputs keep their size.
  if (options.count == 0 && kind == InputKind::voxels) return scene.cell_side();
  const WorldBox& box = within ? *within : scene.box();
  const dvec3 size = box.high - box.low;
  // One less, because the lattice is not aligned with the box.
  return std::max({size.x, size.y, size.z}) / std::max(1, (options.count > 0 ? options.count : kUsualCount) - 1);
}

[[noreturn]] void refuse_empty(const std::string& name, const Scene& scene, double side) {
#ifdef SCARP_EMBREE
  for (const SceneFieldPtr& field : scene.fields()) {
    if (const auto edges = mesh_edges(*field); edges && edges->open > 0)
      throw Error(
          fmt::format("'{}': the mesh is open and has no inside: {} of {} edges belong to an odd number of triangles",
                      name, edges->open, edges->all));
  }
#endif
  throw Error(fmt::format("'{}': no voxel of {:.6g} m has its middle inside; take smaller ones", name, side));
}

void run(const VoxeliseOptions& options, const Command& command) {
  const std::string extension = extension_of(options.output);
  if (extension != ".vox" && extension != ".binvox" && extension != ".vdb") {
    throw Error(
        fmt::format("output '{}': voxels are MagicaVoxel, binvox or OpenVDB files (name it *.vox, *.binvox or *.vdb)",
                    options.output));
  }
  const std::optional<WorldBox> within = box_of(options);
  const ThreadLimit limit(options.threads);
  const InputKind kind = kind_of_input(command, options);
  command.require_effect({kind});
  const OpenedInput input = open_input(kind, options);
  const std::vector<Material> materials = materials_of(input, options.ramp);
  keep_inputs(options.output, input.files);
  stop_if_interrupted();
  const double side = side_of(options, kind, input.scene, within);
  const std::string name = options.inputs.empty() ? "--function" : options.inputs.front();
  // Large worlds are possible for terrain, in file formats that support them.
  const HeightField* const ground = extension == ".vdb" ? input.scene.only_heights() : nullptr;
  const int most = ground ? VoxelGrid::kMaxSide : VoxelGrid::kMaxModelSide;
  const VoxelLattice lattice = naming(name, [&] { return lattice_around(input.scene, side, within, most); });
  const Progress progress = terminal_progress("voxelise");
  const VoxelGrid grid = ground ? voxelised_ground(*ground, lattice, progress)
                                : voxelised(input.scene, lattice, voxel_colours(materials), progress);
  if (grid.solid_count() == 0) refuse_empty(name, input.scene, side);
  bool exact_colours = true;
  if (extension == ".vox") {
    write_vox(options.output, vox_file_of(grid, lattice.box.low, exact_colours));
  } else if (extension == ".vdb") {
    write_vdb(options.output, vdb_of(grid, lattice.box.low, side));
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
  print_notes(input.notes);
  if (!exact_colours)
    fmt::print(stderr, "note: more than 255 colours; each is the nearest of 252 evenly spaced ones\n");
  fmt::print("{}: {} x {} x {} voxels of {:.6g} m, {} solid\n", options.output, grid.size().x, grid.size().y,
             grid.size().z, side, grid.solid_count());
}

}  // namespace

void add_voxelise(Program& program) {
  Command& command =
      program.add("voxelise", "Convert terrain, voxels, a mesh or a scene to voxels: .vox, .binvox or .vdb");
  const auto options = std::make_shared<VoxeliseOptions>();
  VoxeliseOptions& o = *options;
  add_raster_inputs(command, o.inputs, kEveryFile);
  add_output_option(command, o.output, "voxels: .vox, .binvox or .vdb (without colours)", "vox binvox vdb");
  command.add(&o.voxel, {.names = "--voxel",
                         .help = "side of a voxel",
                         .unit = "metres",
                         .range = kAboveZero,
                         .fallback = "derived from --count; for voxels: as in the file"});
  command.add(&o.count, {.names = "--count",
                         .help = "voxels along the longest side; over 2,048 only for terrain in .vdb",
                         .range = {2, VoxelGrid::kMaxSide},
                         .fallback = fmt::format("{}", kUsualCount),
                         .excludes = {"--voxel"}});
  command.add(&o.within, {.names = "--within",
                          .value = "BOX",
                          .help = "box in metres, XLOW,YLOW,ZLOW,XHIGH,YHIGH,ZHIGH",
                          .fallback = "all"});
  command.add(&o.ramp, {.names = "--ramp",
                        .value = "RAMP",
                        .help = "colours by height",
                        .choices = {ramp_names().begin(), ramp_names().end()},
                        .inputs = {kTerrain, "only terrain is coloured by height"}});
  add_threads_option(command, o.threads);
  add_raster_options(command, o.raster);
  add_field_options(command, o.field, BeyondBorders::none);
  add_vox_options(command, o.vox);
  add_mesh_up_option(command, o.mesh);
  command.example("scarp voxelise dem.tif -o dem.vox --count 200");
  command.runs([options, &command] {
    keep_inputs(options->output, command.typed_values());
    run(*options, command);
  });
}

}  // namespace scarp::cli
