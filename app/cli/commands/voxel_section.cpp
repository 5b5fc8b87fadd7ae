// SPDX-License-Identifier: MIT
// `scarp section`: draws one layer of a voxel model with the radius of the empty sphere or cube around each voxel, as
// in figure 5 of C. Leak, "Raymarching voxel rendering"; or the steps of marches along a ray in the layer.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/commands/voxel_section_ray.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/options/vox_input.h"
#include "app/cli/progress.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/voxel_bytes.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

struct SectionOptions {
  std::string input, output, radii = "spheres", axis, ray;
  std::vector<std::string> marches{"voxel-cubes"};
  int at = -1, model = 0, margin = 4;
  bool outlines = false;
  VoxOptions vox;
};

constexpr int kCell = 20;  // of the picture, in its units
constexpr int kMostCells = 256;
constexpr const char* kAxes[] = {"x", "y", "z"};

// Radii as colours: white for 0, deeper with every voxel, up to the largest of the layer.
std::string shade(int radius, int largest) {
  const double share = largest > 0 ? static_cast<double>(radius) / largest : 0;
  const auto mix = [&](double from, double to) { return static_cast<int>(from + share * (to - from) + 0.5); };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(255, 246), mix(255, 190), mix(255, 110));
}

// The shape alone, surrounded by empty voxels.
VoxelGrid with_margin(const VoxelGrid& grid, int margin) {
  VoxelGrid larger(grid.size() + 2 * margin, 1);
  larger.edit(larger.box(), [&](const ivec3& v, const VoxelGrid::Voxel&) {
    const ivec3 from = v - margin;
    return grid.box().contains(from) && grid.solid(from) ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
  });
  return larger;
}

// `size` includes the margin.
void require_size(const std::string& input, const ivec3& size, int axis) {
  const int cols = size[axis == 0 ? 1 : 0], rows = size[axis == 2 ? 1 : 2];
  if (std::max(cols, rows) > kMostCells)
    throw Error(
        fmt::format("{}: the layer with its margin is {} x {} voxels (limited to {} per side; try another "
                    "--axis, --margin or --model)",
                    input, cols, rows, kMostCells));
  if (size[axis] > kMaxAcceleratedSide)
    throw Error(
        fmt::format("{}: the model with its margin has {} layers (limited to {}; try another --axis or --model)", input,
                    size[axis], kMaxAcceleratedSide));
}

// An empty body in the layer: the columns and rows around its centre that its radius reaches.
struct SectionBody {
  int col, row, radius;
};

// Bodies that cover all empty voxels with a radius, the largest first, and of equal ones the first of the layer.
// `radii`: of the voxels of the layer by rows; 0 of solid ones.
std::vector<SectionBody> covering_bodies(const std::vector<int>& radii, int cols, bool spheres) {
  const int rows = static_cast<int>(radii.size()) / cols;
  std::vector<SectionBody> all, chosen;
  for (int i = 0; i < static_cast<int>(radii.size()); ++i) {
    if (const int radius = radii[static_cast<std::size_t>(i)]; radius > 0) all.push_back({i % cols, i / cols, radius});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const SectionBody& a, const SectionBody& b) { return a.radius > b.radius; });
  std::vector<char> covered(radii.size(), 0);
  for (const SectionBody& body : all) {
    if (covered[static_cast<std::size_t>(body.row * cols + body.col)]) continue;
    chosen.push_back(body);
    for (int row = std::max(body.row - body.radius, 0); row <= std::min(body.row + body.radius, rows - 1); ++row) {
      for (int col = std::max(body.col - body.radius, 0); col <= std::min(body.col + body.radius, cols - 1); ++col) {
        const int x = col - body.col, y = row - body.row;
        if (!spheres || x * x + y * y <= body.radius * body.radius)
          covered[static_cast<std::size_t>(row * cols + col)] = 1;
      }
    }
  }
  return chosen;
}

// A cube is a square around its voxel. A sphere is what a ray may travel from anywhere in its voxel, a square with
// round corners.
std::string outline_of(const SectionBody& body, bool spheres) {
  const int x = (body.col - body.radius) * kCell, y = (body.row - body.radius) * kCell;
  const int side = (2 * body.radius + 1) * kCell;
  return fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"{}\" fill=\"none\" stroke=\"#b33a1e\" "
      "stroke-width=\"2\"/>\n",
      x, y, side, side, spheres ? body.radius * kCell : 0);
}

template <class Radius>
std::string svg_of(const VoxelGrid& grid, const SectionOptions& options, int axis, int at, const Radius& radius) {
  const int across = axis == 0 ? 1 : 0, up = axis == 2 ? 1 : 2;
  const int cols = grid.size()[across], rows = grid.size()[up];
  const auto voxel = [&](int col, int row) {
    ivec3 v(0);
    v[axis] = at, v[across] = col, v[up] = rows - 1 - row;
    return v;
  };
  std::vector<int> radii;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) radii.push_back(grid.solid(voxel(col, row)) ? 0 : radius(voxel(col, row)));
  }
  const int largest = *std::max_element(radii.begin(), radii.end());
  const int width = cols * kCell, height = rows * kCell;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"-1 -1 {2} {3}\">\n"
      "<g stroke=\"#9aa3ad\" stroke-width=\"0.6\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"{4}\" "
      "text-anchor=\"middle\">\n",
      width + 2, height + 2, width + 2, height + 2, kCell * 11 / 20);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const ivec3 v = voxel(col, row);
      const bool solid = grid.solid(v);
      const int x = col * kCell, y = row * kCell;
      svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>", x, y, kCell, kCell,
                         solid ? "#3b6ea5" : shade(radius(v), largest));
      if (!solid) {
        svg += fmt::format("<text x=\"{}\" y=\"{}\" stroke=\"none\" fill=\"#333\">{}</text>", x + kCell / 2,
                           y + kCell * 7 / 10, radius(v));
      }
      svg += '\n';
    }
  }
  svg += "</g>\n";
  if (options.outlines) {
    const bool spheres = options.radii == "spheres";
    for (const SectionBody& body : covering_bodies(radii, cols, spheres)) svg += outline_of(body, spheres);
  }
  return svg + "</svg>\n";
}

int axis_of(const SectionOptions& options) { return options.axis == "x" ? 0 : options.axis == "y" ? 1 : 2; }

void draw_ray(const SectionOptions& options, const VoxelModel& model, const std::vector<std::string>& notes) {
  const SectionRay ray = typed_section_ray(options.ray, options.axis);
  const int layers = model.grid().size()[ray.axis];
  if (ray.at < -options.margin || ray.at >= layers + options.margin) {
    throw Error(fmt::format("--ray: layer {} along {} is beside the model, whose layers are 0 to {}", ray.at,
                            kAxes[ray.axis], layers - 1));
  }
  require_size(options.input, model.grid().size() + 2 * options.margin, ray.axis);
  const SectionDrawing drawing =
      draw_section([&] { return with_margin(model.grid(), options.margin); }, options.margin, ray, options.marches);
  write_whole_file(options.output, drawing.svg);
  print_notes(notes);
  for (const std::string& line : drawing.lines) fmt::print("{}: {}\n", options.output, line);
}

void run(const SectionOptions& options) {
  if (extension_of(options.output) != ".svg")
    throw Error(fmt::format("output '{}': sections are written as SVG (name it *.svg)", options.output));
  if (!is_vox_input({options.input}, options.vox))
    throw Error(fmt::format(
        "'{}': not a voxel file (expected .vox, .binvox, .qb, .kv6, .vxl, .vdb, .nvdb, or --volume)", options.input));
  const VoxInput input = read_voxels(options.input, options.vox, {}, {});
  const auto& models = input.voxels.models;
  if (options.model >= static_cast<int>(models.size()))
    throw Error(fmt::format("--model {}: there are {}, counted from 0", options.model, models.size()));
  const VoxelModel& model = *models[static_cast<std::size_t>(options.model)];
  if (!options.ray.empty()) return draw_ray(options, model, input.notes);
  const int axis = axis_of(options);
  const int side = model.grid().size()[axis], at = options.at < 0 ? side / 2 : options.at;
  if (at >= side) {
    throw Error(fmt::format("--at {}: the box around the model's voxels has layers 0 to {} along {}", at, side - 1,
                            kAxes[axis]));
  }
  require_size(options.input, model.grid().size() + 2 * options.margin, axis);
  const VoxelGrid grid = with_margin(model.grid(), options.margin);
  std::string svg;
  if (options.radii == "spheres") {
    const EmptySpheres spheres(grid);
    svg = svg_of(grid, options, axis, at + options.margin, [&](const ivec3& v) { return spheres.distance(v); });
  } else {
    const EmptyCubes cubes(grid);
    svg = svg_of(grid, options, axis, at + options.margin, [&](const ivec3& v) { return cubes.distance(v) - 1; });
  }
  write_whole_file(options.output, svg);
  print_notes(input.notes);
  fmt::print("{}: model {}, layer {} of {} along {}, radii of {}\n", options.output, options.model, at, side,
             kAxes[axis], options.radii);
}

}  // namespace

void add_section(Program& program) {
  Command& command =
      program.add("section", "Draw one layer of a voxel model with its empty spheres or cubes, or a ray, as SVG");
  const auto options = std::make_shared<SectionOptions>();
  SectionOptions& o = *options;
  command.add(&o.input, {.names = "IN",
                         .help = "voxel file (.vox, .binvox, .qb, .kv6, .vxl, .vdb, .nvdb) or volume",
                         .files = "vox binvox qb kv6 vxl vdb nvdb npy raw",
                         .required = true});
  add_output_option(command, o.output, "SVG to write", "svg");
  command.add(&o.radii, {.names = "--radii",
                         .value = "KIND",
                         .help = "shape of the empty bodies",
                         .choices = {"spheres", "cubes"},
                         .closed = true,
                         .excludes = {"--ray"}});
  command.add(&o.outlines, {.names = "--outlines",
                            .help = "outlines of empty bodies that cover the layer, the largest first",
                            .excludes = {"--ray"}});
  command.add(&o.ray, {.names = "--ray",
                       .value = "X,Y,Z,DX,DY,DZ",
                       .help = "ray in a layer, with the steps of --march, in voxels",
                       .note = "one of DX, DY and DZ is 0",
                       .fallback = "none: radii",
                       .excludes = {"--at"}});
  command.add(List<std::string>{&o.marches},
              {.names = "--march",
               .value = "NAME[,NAME]",
               .help = "marches whose visited voxels and empty bodies are drawn, each in a panel",
               .choices = section_marches(),
               .closed = true,
               .rules = {needs("--ray X,Y,Z,DX,DY,DZ", [&o] { return !o.ray.empty(); })}});
  command.add(&o.axis, {.names = "--axis",
                        .value = "AXIS",
                        .help = "axis perpendicular to the layer",
                        .choices = {"x", "y", "z"},
                        .closed = true,
                        .fallback = "z; with --ray an axis the ray does not follow"});
  command.add(&o.at, {.names = "--at",
                      .help = "index of the layer in the box around the voxels",
                      .range = {0, VoxelGrid::kMaxModelSide - 1},
                      .fallback = "the middle"});
  command.add(&o.model, {.names = "--model", .help = "index of the model in the file", .range = {0, 1 << 20}});
  command.add(
      &o.margin,
      {.names = "--margin", .help = "width of the empty border around the model, in voxels", .range = {0, 100}});
  add_vox_options(command, o.vox);
  command.example("scarp section model.vox -o section.svg --axis y");
  command.example("scarp section model.vox --ray=-3,0.5,4.5,1,0.3,0 --march voxel-spheres,voxel-cubes -o ray.svg");
  command.runs([options, &command] {
    command.require_effect({.kind = InputKind::voxels});
    keep_inputs(options->output, command.typed_values());
    run(*options);
  });
}

}  // namespace scarp::cli
