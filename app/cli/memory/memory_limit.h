// SPDX-License-Identifier: MIT
// Keeps the program within a limit of memory, whatever it computes: operator new puts arrays that no longer fit into
// nameless files (file_memory.h), and pages of these are dropped from memory when they become too many. Algorithms do
// not know it, so results are the same for every limit; those that use memory in order lose little time.
//
//   in memory    the program and GDAL's blocks, then arrays until half of the rest is used
//   in files     all other arrays of 16 KiB and more; the other half of the rest holds their pages
//
// doc/dev/decisions/cli.md has the alternatives.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

namespace scarp::cli {

/// One at a time.
class MemoryLimit {
 public:
  /// Least limit in bytes: the program and its libraries take about 100 MiB, GDAL's blocks up to 64 MiB.
  static constexpr double kLeast = 256 << 20;

  /// `bytes` >= kLeast. `folder` for files; it is not examined before memory runs out.
  MemoryLimit(double bytes, const std::string& folder);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

  double bytes() const { return bytes_; }
  /// Bytes of arrays that are in memory at once: half of them for arrays that stay there.
  double bytes_of_arrays() const;
  const std::string& folder() const { return folder_; }

 private:
  void watch(std::size_t most_file_pages);

  double bytes_;
  std::string folder_;
  std::mutex mutex_;
  std::condition_variable ends_;
  bool ended_ = false;
  std::thread watcher_;
};

/// Memory that the program may use, in bytes: that of the machine or of its control groups.
double machine_memory();
/// The least limit of the control groups in a text like /proc/self/cgroup, and of those above them, in bytes; infinity:
/// none. `root`: /sys/fs/cgroup.
double memory_of_groups(const std::string& groups, const std::string& root);

/// Returns memory in a file for an array that does not fit below the limit; nullptr if it does, or if there is no
/// limit. Throws std::bad_alloc. For operator new, as the functions below.
void* beyond_memory_limit(std::size_t bytes, std::size_t alignment);
/// After nullptr: counts an array in memory. `usable`: the size of its block; 0: none, because memory ran out.
void count_granted(std::size_t bytes, std::size_t usable) noexcept;
/// Before an array in memory is released.
void count_released(std::size_t usable) noexcept;

}  // namespace scarp::cli
