// SPDX-License-Identifier: MIT
#include "app/cli/memory/memory_limit.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include "app/cli/memory/file_memory.h"
#include "scarp/base/array_files.h"

namespace scarp::cli {
namespace {

// Arrays that count. Maps of many observers or directions have thousands of bands, each of some ten kilobytes or more.
constexpr std::size_t kCounted = std::size_t{16} << 10;
// Arrays that may lie in files even if there are few of them.
constexpr std::size_t kLargeArray = std::size_t{2} << 20;
// Share of the memory for arrays that large ones leave to others: to buffers of a row or a block, which algorithms
// allocate and release again and again.
constexpr double kOfOthers = 0.2;
// The program without arrays, with GDAL's blocks.
constexpr double kProgram = 176 << 20;

// Read by operator new on any thread.
std::atomic<bool> is_limited{false};
std::atomic<std::size_t> most_private{0}, most_granted{0}, most_granted_to_large{0};  // bytes
// Of counted arrays in memory. Pages that are not yet used are not resident.
std::atomic<std::size_t> granted_bytes{0};
char scratch_folder[4096];  // written before is_limited

constexpr ArrayFiles kArrayFiles{[]() noexcept { return bytes_in_files() > 0; }, read_in_file, write_in_file};

struct Resident {
  std::size_t privately = 0, of_files = 0;  // bytes
};

// Without memory of its own: operator new calls it.
Resident resident() {
  const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return {};
  char text[256] = {};
  const ssize_t length = ::read(file, text, sizeof text - 1);
  ::close(file);
  unsigned long size = 0, all = 0, shared = 0;
  if (length <= 0 || std::sscanf(text, "%lu %lu %lu", &size, &all, &shared) != 3) return {};
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return {(all - std::min(all, shared)) * page, shared * page};
}

}  // namespace

MemoryLimit::MemoryLimit(double bytes, const std::string& folder)
    : bytes_(bytes), folder_(folder.empty() ? "." : folder) {
  constexpr double kOfFilePages = 0.5;
  const double rest = bytes_of_arrays(), file_pages = rest * kOfFilePages;
  std::snprintf(scratch_folder, sizeof scratch_folder, "%s", folder_.c_str());
  const Resident now = resident();
  const auto in_memory = static_cast<std::size_t>(rest - file_pages);
  most_private = now.privately + in_memory;
  most_granted = granted_bytes + in_memory;
  most_granted_to_large = granted_bytes + static_cast<std::size_t>((1 - kOfOthers) * static_cast<double>(in_memory));
  is_limited = true;
  set_array_files(&kArrayFiles);
  watcher_ = std::thread([this, most = now.of_files + static_cast<std::size_t>(file_pages)] { watch(most); });
}

double MemoryLimit::bytes_of_arrays() const { return std::max(0.0, bytes_ - kProgram); }

MemoryLimit::~MemoryLimit() {
  is_limited = false;
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ends_.notify_all();
  watcher_.join();
}

void MemoryLimit::watch(std::size_t most_file_pages) {
  // A processor maps pages of a file at up to about 2 GB/s, so that 5 ms add 10 MB for each thread.
  constexpr std::chrono::milliseconds kPeriod(5);
  std::unique_lock lock(mutex_);
  while (!ends_.wait_for(lock, kPeriod, [&] { return ended_; }))
    if (bytes_in_files() > 0 && resident().of_files > most_file_pages) forget_pages_in_files();
}

double memory_of_groups(const std::string& groups, const std::string& root) {
  double least = std::numeric_limits<double>::infinity();
  const auto read = [&](const std::string& file) {
    double bytes = 0;
    if (std::ifstream(file) >> bytes && bytes > 0) least = std::min(least, bytes);  // "max" is none
  };
  // Each group has the limits of the groups above it.
  const auto walk = [&](const std::string& mount, std::string group, const char* file) {
    for (;; group.resize(group.rfind('/'))) {
      while (group.ends_with('/')) group.pop_back();
      read(fmt::format("{}{}/{}", mount, group, file));
      if (group.empty()) return;
    }
  };
  std::istringstream lines(groups);
  // "0::/slurm/job_7" (version 2), or "4:memory:/slurm/job_7" (version 1).
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos || line.find('/', second) != second + 1) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",",
                      group = line.substr(second + 1);
    if (controllers == ",,") walk(root, group, "memory.max");
    if (controllers.find(",memory,") != std::string::npos) walk(root + "/memory", group, "memory.limit_in_bytes");
  }
  return least;
}

double machine_memory() {
  const double bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  std::ifstream file("/proc/self/cgroup");
  const std::string groups{std::istreambuf_iterator<char>(file), {}};
  // In a container, the file may name the group outside of it.
  return std::min(bytes, memory_of_groups(groups + "\n0::/\n1:memory:/\n", "/sys/fs/cgroup"));
}

void* beyond_memory_limit(std::size_t bytes, std::size_t alignment) {
  if (bytes < kCounted) return nullptr;
  // Before the check, so that arrays that threads allocate at the same time count one another.
  const std::size_t all = granted_bytes += bytes;
  if (!is_limited) return nullptr;
  const bool is_large = bytes >= kLargeArray;
  // Asking the system takes longer than allocating a small array.
  if (all <= (is_large ? most_granted_to_large : most_granted) &&
      (!is_large || resident().privately + bytes <= most_private))
    return nullptr;
  granted_bytes -= bytes;
  return allocate_in_file(bytes, alignment, scratch_folder);
}

void count_granted(std::size_t bytes, std::size_t usable) noexcept {
  if (bytes >= kCounted) granted_bytes -= bytes;
  if (usable >= kCounted) granted_bytes += usable;
}

void count_released(std::size_t usable) noexcept {
  if (usable >= kCounted) granted_bytes -= usable;
}

}  // namespace scarp::cli
