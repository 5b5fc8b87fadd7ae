// SPDX-License-Identifier: MIT
// Notices that files were written, by their times and sizes.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace scarp::viewer {

class FileWatch {
 public:
  explicit FileWatch(std::vector<std::string> files = {}) : files_(std::move(files)), seen_(states()), last_(seen_) {}

  /// Whether a file was written since the last call that said so, and none is written now: all exist, and are as at the
  /// last call.
  bool changed();

 private:
  using State = std::pair<std::filesystem::file_time_type, std::uintmax_t>;  // time and size
  std::vector<State> states() const;

  std::vector<std::string> files_;
  std::vector<State> seen_, last_;
};

}  // namespace scarp::viewer
