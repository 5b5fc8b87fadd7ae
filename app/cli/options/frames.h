// SPDX-License-Identifier: MIT
// Many pictures: a flight along a path, one turn on a turntable, or an animation of other options.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/cli/options/places.h"
#include "app/options/command.h"
#include "scarp/render/camera/camera.h"

namespace scarp::cli {

/// Typed options.
struct FrameOptions {
  std::string path;
  int frames = 0;  // 0: one per row of the path
  bool turntable = false, overwrite = false;
  std::vector<std::string> animated;                // values of --animate
  double per_second = 25;                           // of films
  std::string film{};                               // output that the frames are for; empty: the frames themselves
  std::function<void()> add_to_film{}, end_film{};  // after each frame, and after the last
  bool quiet = false;                               // no summary

  /// Whether the frames have their own cameras.
  bool fly() const { return turntable || !path.empty(); }
  bool several() const { return fly() || !animated.empty(); }
  /// Number of frames of turntables and animations.
  int chosen() const;
};

void add_frame_options(Command& command, FrameOptions& options);

/// Throws Error if several frames would have the same output name, which lacks a placeholder for the number. Films
/// need none.
void check_frames(const FrameOptions& options, const std::string& output);

/// Converts positions of a table to world metres.
struct PathPlaces {
  const Places& places;
  const Scene& scene;  ///< targets without z are on its surface
  /// Returns the eye over (x, y) of a position; null: every eye needs z.
  std::function<dvec3(const dvec3& at, const std::string& what)> above_surface{};
};

/// Returns the cameras of the frames. `framed` creates those of a turntable, which starts at `view`. Eyes without z
/// follow the surface, also between the rows of the table. Throws Error naming file and line.
std::vector<Camera> frame_cameras(const FrameOptions& options, const ViewSettings& view, int width, int height,
                                  const std::function<Camera(const ViewSettings&)>& framed, const PathPlaces& path);

/// The output's name with the number of frame i (from 0) in place of its #s, padded to that many digits. Without #s the
/// name itself.
std::string frame_name(const std::string& output, int i);

/// A frame: the file to write, and its name in messages.
struct FrameFile {
  std::string path, shown;
};

/// Calls make(i, file) for those of `count` frames that do not exist yet, and prints a summary. Stops at the first
/// frame that fails; earlier frames are kept. Each frame of a film has the same file, from which the film takes it.
void make_frames(const FrameOptions& options, const std::string& output, int count,
                 const std::function<void(int, const FrameFile&)>& make);

}  // namespace scarp::cli
