// SPDX-License-Identifier: MIT
// Whole programs, measured from start to end.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace scarp::bench {

struct ProgramRun {
  double wall_s = 0;
  double cpu_s = 0;  ///< of the program and all processes that it started
  /// Peak resident memory of the largest of these processes in MB; nullopt without GNU time.
  std::optional<double> peak_mb = std::nullopt;
};

/// Runs a program in a folder, without input and output. Returns nullopt if it takes longer than `limit_s`; it is then
/// stopped with its children. Throws Error if it cannot be started or fails.
std::optional<ProgramRun> run_program(std::vector<std::string> words, const std::string& folder, double limit_s);

/// Whether a program with this name is on PATH.
bool is_installed(const std::string& program);

/// A folder for temporary files, removed with all its contents.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace scarp::bench
