// SPDX-License-Identifier: MIT
// Films (.gif, .mp4): frames in a temporary folder, encoded by the program ffmpeg.
#pragma once

#include <string>

#include "scarp/base/replace_file.h"

namespace scarp::cli {

/// Whether the name ends in .gif or .mp4.
bool is_film(const std::string& output);

class Film {
 public:
  /// Reserves the output and creates the folder. Throws Error naming the output if it cannot be written, or if ffmpeg
  /// is not installed.
  explicit Film(std::string output);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// Name of the frames to render, "FOLDER/frame-######.png", numbered from 0.
  std::string frames() const;
  /// Encodes the frames and commits the output. Throws Error with the last line of ffmpeg's messages if it fails,
  /// Interrupted after a signal.
  void finish(double frames_per_second);

 private:
  std::string output_;
  ReplaceFile file_;
  std::string program_, folder_;
};

}  // namespace scarp::cli
