// SPDX-License-Identifier: MIT
#include "app/cli/memory/file_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/statfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <utility>

namespace scarp::cli {
namespace {

// An array in a file. The list is not a container of the standard library, which would call operator new.
struct Mapping {
  std::byte* begin;
  std::size_t bytes;
  int file;
  Mapping* next;
};

std::mutex mutex;
Mapping* mappings = nullptr;
std::atomic<std::size_t> all_bytes{0};
// Files that stay open; further ones are used through their mapping alone. Systems allow a program about 1,000.
constexpr int kMostOpen = 256;
int open_files = 0;

int open_nameless(const char* folder) {
#ifdef O_TMPFILE
  const int file = ::open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT && errno != EINVAL)) return file;
#endif
  // A file system without such files.
  char name[4096];
  if (std::snprintf(name, sizeof name, "%s/.scarp-XXXXXX", folder) >= static_cast<int>(sizeof name)) return -1;
  const int named = ::mkstemp(name);
  if (named >= 0) ::unlink(name);
  return named;
}

// Reserves the blocks on the disk: writing to a mapping ends the program if there is no room.
int reserve(int file, std::size_t bytes) {
  const auto length = static_cast<off_t>(bytes);
#ifdef __linux__
  if (::fallocate(file, 0, 0, length) == 0) return 0;
  if (errno != EOPNOTSUPP) return errno;
#endif
  return ::posix_fallocate(file, 0, length);
}

// Maps the file at a multiple of `alignment`; MAP_FAILED if that fails.
void* map_aligned(int file, std::size_t bytes, std::size_t alignment) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t more = alignment > page ? alignment : 0, length = (bytes + page - 1) / page * page;
  void* const room = ::mmap(nullptr, length + more, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) return room;
  const auto first = reinterpret_cast<std::uintptr_t>(room), step = more > 0 ? alignment : page;
  const std::uintptr_t at = (first + step - 1) / step * step;
  if (at > first) ::munmap(room, at - first);
  if (const std::size_t after = first + length + more - (at + length); after > 0)
    ::munmap(reinterpret_cast<void*>(at + length), after);
  void* const memory =
      ::mmap(reinterpret_cast<void*>(at), length, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, file, 0);
  if (memory == MAP_FAILED) ::munmap(reinterpret_cast<void*>(at), length);
  return memory;
}

// A piece of an array in a file.
struct Piece {
  int file = -1;  // -1: not in a file
  off_t offset = 0;
};

Piece piece_at(const void* memory, std::size_t bytes) noexcept {
  if (all_bytes == 0) return {};
  const auto* const at = static_cast<const std::byte*>(memory);
  const std::lock_guard lock(mutex);
  for (const Mapping* one = mappings; one; one = one->next)
    if (at >= one->begin && at + bytes <= one->begin + one->bytes) return {one->file, at - one->begin};
  return {};
}

// Calls step(done) for the bytes that are left, which returns how many it has copied.
template <class Step>
bool copy_by_steps(std::size_t bytes, const Step& step) noexcept {
  for (std::size_t done = 0; done < bytes;) {
    const ssize_t more = step(done);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) return false;
    done += static_cast<std::size_t>(more);
  }
  return true;
}

}  // namespace

NoFileMemory::NoFileMemory(std::size_t bytes, const char* folder, const char* why) noexcept {
  std::snprintf(text_, sizeof text_,
                "arrays of %.1f GiB beyond --memory do not fit into files in '%s': %s (free some space there, name "
                "another folder with --scratch, or raise --memory)",
                static_cast<double>(bytes) / (1 << 30), folder, why);
}

void* allocate_in_file(std::size_t bytes, std::size_t alignment, const char* folder) {
  const auto fail = [&](int number) { throw NoFileMemory(bytes + all_bytes, folder, std::strerror(number)); };
  auto* const entry = static_cast<Mapping*>(std::malloc(sizeof(Mapping)));
  if (!entry) throw std::bad_alloc();
  void* memory = MAP_FAILED;
  int reason = ENAMETOOLONG;
  int file = open_nameless(folder);
  if (file >= 0) {
    reason = reserve(file, bytes);
    if (reason == 0) {
      memory = map_aligned(file, bytes, alignment);
      reason = errno;
    }
    if (memory == MAP_FAILED) ::close(file);
  } else {
    reason = errno;
  }
  if (memory == MAP_FAILED) {
    std::free(entry);
    fail(reason);
  }
  const std::lock_guard lock(mutex);
  if (open_files < kMostOpen) {
    ++open_files;
  } else {
    ::close(std::exchange(file, -1));  // the mapping keeps the file
  }
  *entry = {static_cast<std::byte*>(memory), bytes, file, mappings};
  mappings = entry;
  all_bytes += bytes;
  return memory;
}

bool release_in_file(void* memory) noexcept {
  if (all_bytes == 0) return false;
  const std::lock_guard lock(mutex);
  for (Mapping** at = &mappings; *at; at = &(*at)->next) {
    Mapping* const found = *at;
    if (found->begin != memory) continue;
    *at = found->next;
    all_bytes -= found->bytes;
    ::munmap(memory, found->bytes);
    if (found->file >= 0) ::close(found->file), --open_files;
    std::free(found);
    return true;
  }
  return false;
}

bool read_in_file(void* to, const void* from, std::size_t bytes) noexcept {
  const Piece piece = piece_at(from, bytes);
  return piece.file >= 0 && copy_by_steps(bytes, [&](std::size_t done) {
           return ::pread(piece.file, static_cast<std::byte*>(to) + done, bytes - done,
                          piece.offset + static_cast<off_t>(done));
         });
}

bool write_in_file(void* to, const void* from, std::size_t bytes) noexcept {
  const Piece piece = piece_at(to, bytes);
  return piece.file >= 0 && copy_by_steps(bytes, [&](std::size_t done) {
           return ::pwrite(piece.file, static_cast<const std::byte*>(from) + done, bytes - done,
                           piece.offset + static_cast<off_t>(done));
         });
}

void forget_pages_in_files() noexcept {
  const std::lock_guard lock(mutex);
  for (const Mapping* one = mappings; one; one = one->next) ::madvise(one->begin, one->bytes, MADV_DONTNEED);
}

std::size_t bytes_in_files() noexcept { return all_bytes; }

bool is_in_memory(const std::string& folder) {
#ifdef __linux__
  struct statfs about {};
  constexpr auto kTmpfs = 0x01021994, kRamfs = static_cast<int>(0x858458f6);
  if (::statfs(folder.c_str(), &about) != 0) return false;
  return static_cast<int>(about.f_type) == kTmpfs || static_cast<int>(about.f_type) == kRamfs;
#else
  static_cast<void>(folder);
  return false;
#endif
}

}  // namespace scarp::cli
