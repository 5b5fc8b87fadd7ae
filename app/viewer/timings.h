// SPDX-License-Identifier: MIT
// Times of events and presented pictures, as a table for bench/view.sh.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "app/viewer/picture_worker.h"

namespace scarp::viewer {

class Timings {
 public:
  /// Writes the header. Throws Error if the file cannot be written. With an empty name, no times are recorded.
  explicit Timings(const std::string& file);
  ~Timings();
  Timings(const Timings&) = delete;
  Timings& operator=(const Timings&) = delete;

  /// Records an event while `generation` was the last requested one: pictures of later generations include it.
  void event(std::uint64_t generation);
  /// Records that a picture was presented for the first time.
  void present(const WorkedPicture& shown);

 private:
  std::FILE* file_ = nullptr;
};

}  // namespace scarp::viewer
