// SPDX-License-Identifier: MIT
// Films (.gif, .mp4): frames are piped to the program ffmpeg as soon as they are rendered.
#pragma once

#include <memory>
#include <string>

#include "scarp/base/replace_file.h"

namespace scarp::cli {

/// Whether the name ends in .gif or .mp4.
bool is_film(const std::string& output);

class Film {
 public:
  /// Reserves the output. Throws Error naming the output if it cannot be written, or if ffmpeg is not installed.
  explicit Film(std::string output);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// The file to write a frame to, a PNG beside the output. It is deleted with this object, or by a signal.
  const std::string& frame() const { return frame_.temporary_path(); }
  /// Encodes the frame in frame(), which the next one may then replace; the first one starts ffmpeg. Throws Error with
  /// the last line of ffmpeg's messages if it fails, Interrupted after a signal; so does finish().
  void add_frame(double frames_per_second);
  /// Waits for ffmpeg and commits the output.
  void finish();

 private:
  class Encoder;

  [[noreturn]] void refuse() const;

  std::string output_, program_;
  ReplaceFile file_, frame_;
  std::unique_ptr<Encoder> encoder_;  // last: it ends before its file is deleted
};

}  // namespace scarp::cli
