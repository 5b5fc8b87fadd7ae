// SPDX-License-Identifier: MIT
// --ground: a model of the bare ground, on which observers and targets stand, below a surface model, which hides.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/options/map_input.h"
#include "scarp/analysis/line_of_sight.h"

namespace scarp::cli {

/// Declares --ground.
void add_bare_ground_option(Command& command, std::string& path, std::vector<std::string> excludes = {});

class BareGround {
 public:
  /// Opens the file with the options of the surface. Throws Error unless it has the samples of the surface: their
  /// number and their places.
  BareGround(const std::string& path, const MapOptions& options, const MapInput& surface);

  /// Reads the part of the surface that was read, unless it has been read.
  void follow(const MapInput& surface);
  /// Closes the file, as MapInput::close(): the part that was read is the last.
  void close() { input_.close(); }
  MapInput& input() { return input_; }
  /// Moves the notes to those of the surface, unless it has them.
  void move_notes(MapInput& surface);
  const std::string& path() const { return input_.path(); }

  /// Returns the height above sea at a position in columns and rows of the raster; nullopt on a hole. The part that was
  /// read must contain it.
  std::optional<double> height_at(const dvec2& at) const;

  /// Returns an end whose height above the bare ground becomes a height above sea. The part that was read must contain
  /// it. Throws Error "observer: X,Y is on nodata of FILE ...".
  SightEnd stand_on(SightEnd end, std::string_view who) const;

 private:
  MapOptions options_;
  MapInput input_;
};

}  // namespace scarp::cli
