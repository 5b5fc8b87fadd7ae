// SPDX-License-Identifier: MIT
#include "app/cli/commands/voxel_section_ray.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/march_trace.h"
#include "scarp/march/voxel/voxel_table.h"
#include "scarp/scene/voxel/voxel_model.h"

namespace scarp::cli {
namespace {

constexpr int kSide = 20;         // of a voxel in the picture, in its units
constexpr int kCaption = 26;      // height of a line of text
constexpr int kGap = 24;          // between panels
constexpr int kMostWidth = 1600;  // of panels beside one another
constexpr const char* kForm = "X,Y,Z,DX,DY,DZ in voxels, for example -2,3.5,4.5,1,0.4,0";

// Panels beside one another: as many in each row, with the fewest rows.
int panels_per_row(int panels, int width) {
  const int most = std::max(1, (kMostWidth + kGap) / (width + kGap)), rows = (panels + most - 1) / most;
  return (panels + rows - 1) / rows;
}

// A point of the grid in a panel.
class Panel {
 public:
  Panel(const VoxelGrid& grid, int axis) : across_(axis == 0 ? 1 : 0), up_(axis == 2 ? 1 : 2), size_(grid.size()) {}

  int cols() const { return size_[across_]; }
  int rows() const { return size_[up_]; }
  int width() const { return cols() * kSide; }
  int height() const { return rows() * kSide; }
  double x(const dvec3& p) const { return p[across_] * kSide; }
  double y(const dvec3& p) const { return (rows() - p[up_]) * kSide; }
  ivec3 voxel(int axis, int at, int col, int row) const {
    ivec3 v(0);
    v[axis] = at, v[across_] = col, v[up_] = row;
    return v;
  }
  /// Attributes of the square with this lowest corner.
  std::string square(const ivec3& low, int side) const {
    return fmt::format("x=\"{:.6g}\" y=\"{:.6g}\" width=\"{}\" height=\"{}\"", x(dvec3(low)),
                       y(dvec3(low)) - side * kSide, side * kSide, side * kSide);
  }

 private:
  int across_, up_;
  ivec3 size_;
};

// Where the ray leaves a voxel.
dvec3 exit_of(const VoxelRay& ray, const ivec3& voxel) {
  double t = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis];
    if (d != 0) t = std::min(t, (voxel[axis] + (d > 0 ? 1 : 0) - ray.origin[axis]) / d);
  }
  return ray.origin + ray.direction * t;
}

std::string layer_of(const VoxelGrid& grid, const Panel& panel, int axis, int at) {
  std::string svg = fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n<g fill=\"#3b6ea5\">\n",
                                panel.width(), panel.height());
  for (int row = 0; row < panel.rows(); ++row) {
    for (int col = 0; col < panel.cols(); ++col) {
      const ivec3 voxel = panel.voxel(axis, at, col, row);
      if (grid.solid(voxel)) svg += fmt::format("<rect {}/>\n", panel.square(voxel, 1));
    }
  }
  return svg + "</g>\n";
}

std::string grid_lines(const Panel& panel) {
  std::string path;
  for (int col = 0; col <= panel.cols(); ++col) path += fmt::format("M{} 0V{}", col * kSide, panel.height());
  for (int row = 0; row <= panel.rows(); ++row) path += fmt::format("M0 {}H{}", row * kSide, panel.width());
  return fmt::format("<path d=\"{}\" stroke=\"#c8ced5\" stroke-width=\"0.6\" fill=\"none\"/>\n", path);
}

// Voxels in which the march looked, and the bodies that it skipped.
std::string steps_of(const MarchTrace& trace, const Panel& panel, const VoxelRay& ray) {
  std::string visited = "<g fill=\"#f6be6e\" fill-opacity=\"0.75\">\n";
  std::string bodies = "<g fill=\"#2a9d5c\" fill-opacity=\"0.09\" stroke=\"#15703c\" stroke-width=\"1.4\">\n";
  std::string points = "<g fill=\"#222\">\n";
  for (const TraceStep& step : trace.steps) {
    if (step.kind == TraceKind::solid) continue;
    visited += fmt::format("<rect {}/>\n", panel.square(step.voxel, 1));
    const dvec3 from = ray.origin + ray.direction * step.t;
    points += fmt::format("<circle cx=\"{:.6g}\" cy=\"{:.6g}\" r=\"2.4\"/>\n", panel.x(from), panel.y(from));
    if (step.kind == TraceKind::cube) {
      bodies += fmt::format("<rect {}/>\n", panel.square(step.low, step.size));
    } else if (step.kind == TraceKind::sphere && step.size > 0) {
      const dvec3 centre = exit_of(ray, step.voxel);
      bodies += fmt::format("<circle cx=\"{:.6g}\" cy=\"{:.6g}\" r=\"{}\"/>\n", panel.x(centre), panel.y(centre),
                            step.size * kSide);
    }
  }
  return visited + "</g>\n" + bodies + "</g>\n" + points + "</g>\n";
}

std::string ray_of(const Panel& panel, const VoxelRay& ray, const VoxelHit& hit) {
  const double far = 2.0 * (panel.cols() + panel.rows()) + length(ray.origin);
  const dvec3 end = ray.origin + ray.direction * (hit ? hit.t : far / length(ray.direction));
  std::string svg = fmt::format(
      "<line x1=\"{:.6g}\" y1=\"{:.6g}\" x2=\"{:.6g}\" y2=\"{:.6g}\" stroke=\"#222\" stroke-width=\"1.4\"/>\n",
      panel.x(ray.origin), panel.y(ray.origin), panel.x(end), panel.y(end));
  if (hit) {
    svg += fmt::format(
        "<rect {} fill=\"none\" stroke=\"#c1121f\" stroke-width=\"2.4\"/>\n<circle cx=\"{:.6g}\" cy=\"{:.6g}\" r=\"4\" "
        "fill=\"#c1121f\"/>\n",
        panel.square(hit.voxel, 1), panel.x(end), panel.y(end));
  }
  return svg;
}

}  // namespace

std::vector<std::string> section_marches() {
  std::vector<std::string> names;
  for (const VoxelMarchEntry& march : voxel_marches()) {
    if (march.traced) names.emplace_back(march.name);
  }
  return names;
}

SectionRay typed_section_ray(const std::string& text, const std::string& axis) {
  const auto n = ground_numbers_from(text, 6, 6, "--ray", kForm);
  SectionRay ray{{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}}, 2, 0};
  const dvec3& direction = ray.ray.direction;
  if (direction == dvec3(0.0)) throw Error(fmt::format("--ray '{}': the direction is zero", text));
  if (axis.empty()) {
    while (ray.axis > 0 && direction[ray.axis] != 0) --ray.axis;
  } else {
    ray.axis = axis[0] - 'x';
  }
  if (direction[ray.axis] != 0) {
    throw Error(fmt::format("--ray '{}': leaves its layer (one of DX, DY and DZ must be 0: that of --axis)", text));
  }
  ray.at = static_cast<int>(std::floor(ray.ray.origin[ray.axis]));
  return ray;
}

SectionDrawing draw_section(const std::function<VoxelGrid()>& grid, int margin, const SectionRay& typed,
                            const std::vector<std::string>& marches) {
  SectionDrawing drawing;
  VoxelRay ray = typed.ray;
  ray.origin += dvec3(margin);
  int width = 0, height = 0, x = 0, y = 0;
  std::string panels;
  for (const std::string& name : marches) {
    const VoxelMarchEntry& march = find_voxel_march(name);
    const VoxelModel model(grid(), march, {}, VoxelModel::Extent::grid);
    const Panel panel(model.grid(), typed.axis);
    const VoxelTarget target = model.target();
    const auto quantised = quantise(ray, target.box);
    if (!quantised) throw Error("--ray: does not pass through the model and its margin (see --margin)");
    MarchTrace trace;
    MarchStats stats;
    const VoxelHit hit = march.traced(target, *quantised, &stats, trace);
    const ivec3 voxel = hit.voxel - margin;
    const std::string caption =
        fmt::format("{}: {} steps, {}", name, stats.steps,
                    hit ? fmt::format("hits voxel {},{},{}", voxel.x, voxel.y, voxel.z) : "no hit");
    drawing.lines.push_back(caption);
    const int place = static_cast<int>(drawing.lines.size()) - 1;
    if (place > 0 && place % panels_per_row(static_cast<int>(marches.size()), panel.width()) == 0)
      x = 0, y = height + kGap;
    panels += fmt::format(
        "<text x=\"{}\" y=\"{}\">{}</text>\n<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">\n{}{}{}{}</svg>\n", x,
        y + kCaption - 9, caption, x, y + kCaption, panel.width(), panel.height(),
        layer_of(model.grid(), panel, typed.axis, typed.at + margin) + grid_lines(panel), steps_of(trace, panel, ray),
        ray_of(panel, ray, hit),
        fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#555\" stroke-width=\"2\"/>\n",
                    panel.width(), panel.height()));
    width = std::max(width, x + panel.width());
    height = std::max(height, y + kCaption + panel.height());
    x += panel.width() + kGap;
  }
  drawing.svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"-4 0 {0} {1}\" "
      "font-family=\"DejaVu "
      "Sans, sans-serif\" font-size=\"15\">\n<rect x=\"-4\" width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n{2}</svg>\n",
      width + 8, height + 4, panels);
  return drawing;
}

}  // namespace scarp::cli
