// SPDX-License-Identifier: MIT
// Answers about the ground around an observer, for the window: the line of sight to a point, and the viewshed. They are
// those of `scarp los` and `scarp viewshed` on the same input: without exaggeration, with curvature and refraction.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/options/map_input.h"
#include "app/cli/picture/prepared_scene.h"
#include "app/viewer/opening.h"
#include "scarp/analysis/horizon.h"
#include "scarp/analysis/profile.h"
#include "scarp/analysis/viewshed.h"
#include "scarp/base/progress.h"
#include "scarp/render/surface/ground_paint.h"

namespace scarp::viewer {

/// An observer on a sample.
struct Observer {
  Node node;
  double height = 2;         ///< metres above ground, >= 0
  double target_height = 0;  ///< metres above ground, >= 0
  double reach = 0;          ///< maximum distance of targets in metres; 0: unlimited

  bool operator==(const Observer&) const = default;
};

/// The visibility of the samples in a part of the raster.
struct SeenGround {
  RasterWindow part{};        ///< the nodes of `codes`
  std::vector<Seen> codes{};  ///< rows from north to south
  double share = 0;           ///< visible part of the targets, 0..1
  double reach = 0;           ///< metres; 0: unlimited
  bool complete = false;      ///< includes the whole distance limit
  std::shared_ptr<const Drape> drape{};
};

/// A viewshed to compute; owns what it needs.
struct ViewshedTask {
  /// Within `reach` metres, or 0: up to the limit of the observer. Throws Error, and Interrupted if the progress
  /// returns false.
  std::function<SeenGround(double reach, const Progress& progress)> compute;
  double quick_reach = 0;  ///< metres in which it takes little time; 0: all
  double reach = 0;        ///< of the observer; smaller than requested if samples farther away are off the metric plane
};

/// The line of sight from an observer to a point of the ground.
struct SightAnswer {
  LineOfSight line;
  struct Point {
    dvec3 at{0.0};  ///< world metres
    bool visible = true;
  };
  std::vector<Point> ground{};  ///< from the observer to the target
};

/// The horizon of a sample, as `scarp horizon --at` writes it.
struct HorizonPlot {
  Node node;
  double reach = 0;                  ///< metres; 0: unlimited
  std::vector<HorizonView> views{};  ///< for azimuths of 0, 1, ... degrees clockwise from true north

  double highest() const;              ///< radians; -pi/2 without ground
  double highest_azimuth_deg() const;  ///< 0..359
};

/// Computes a horizon; owns what it needs.
using HorizonTask = std::function<HorizonPlot(const Progress& progress)>;

class GroundAnswers {
 public:
  /// Opens the header of the raster again. Throws Error for inputs other than one raster without wrap, and for a raster
  /// of which the window shows a coarser version.
  GroundAnswers(const Opening& opening, std::shared_ptr<const cli::PreparedScene> prepared);

  int cols() const { return input_->cols(); }
  int rows() const { return input_->rows(); }
  /// The sample nearest to a point in world metres; the point of the ground at a node.
  Node node_at(const dvec3& point) const;
  dvec3 point_at(Node node) const;

  /// Throws Error for an observer on a hole, or who cannot see as far as requested on a metric plane.
  ViewshedTask viewshed(const Observer& observer);
  /// Throws Error for a point on a hole, or too far for a metric plane.
  SightAnswer sight(const Observer& observer, const dvec3& point);

  /// The horizon of a sample, on a thread. Throws Error for a hole, also from the task.
  HorizonTask horizon(Node node);

  /// The command that writes the horizon as a table to `output`.
  std::string horizon_command(const HorizonPlot& plot, const std::string& output) const;
  /// The command that writes the viewshed to `output`.
  std::string command(const Observer& observer, const std::string& output) const;

 private:
  // The heights of the window, exaggerated.
  const HeightField& shown() const { return *prepared_->given_scene().only_heights(); }
  std::pair<dvec2, double> plane_around(Node node, double reach);
  HeightField part_of(const RasterWindow& part, const dvec2& cells) const;

  cli::MapOptions options_{};
  std::string words_;  // of the input, for commands
  std::shared_ptr<const cli::PreparedScene> prepared_;
  std::unique_ptr<cli::MapInput> input_;
};

}  // namespace scarp::viewer
