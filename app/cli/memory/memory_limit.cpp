// SPDX-License-Identifier: MIT
#include "app/cli/memory/memory_limit.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "app/cli/memory/file_memory.h"

namespace scarp::cli {
namespace {

constexpr std::size_t kLargeArray = std::size_t{2} << 20;
// The program without arrays, with GDAL's blocks.
constexpr double kProgram = 176 << 20;

// Read by operator new on any thread.
std::atomic<bool> is_limited{false};
std::atomic<std::size_t> most_private{0};  // bytes
char scratch_folder[4096];                 // written before is_limited

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
  const double rest = std::max(0.0, bytes - kProgram), file_pages = rest * kOfFilePages;
  std::snprintf(scratch_folder, sizeof scratch_folder, "%s", folder_.c_str());
  const Resident now = resident();
  most_private = now.privately + static_cast<std::size_t>(rest - file_pages);
  is_limited = true;
  watcher_ = std::thread([this, most = now.of_files + static_cast<std::size_t>(file_pages)] { watch(most); });
}

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

double machine_memory() {
  double bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  for (const char* limit : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    double of_group = 0;
    if (std::ifstream(limit) >> of_group && of_group > 0) bytes = std::min(bytes, of_group);
  }
  return bytes;
}

void* beyond_memory_limit(std::size_t bytes, std::size_t alignment) {
  if (bytes < kLargeArray || !is_limited || resident().privately + bytes <= most_private) return nullptr;
  return allocate_in_file(bytes, alignment, scratch_folder);
}

}  // namespace scarp::cli
