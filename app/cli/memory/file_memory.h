// SPDX-License-Identifier: MIT
// Memory in a temporary file: the system writes its pages to the disk when memory is short, and reads them when they
// are used again. The file has no name, so that nothing is left of it however the program ends.
#pragma once

#include <cstddef>
#include <new>
#include <string>

namespace scarp::cli {

/// The file system has no room for memory that was requested.
class NoFileMemory : public std::bad_alloc {
 public:
  /// `why`: the message of the operating system.
  NoFileMemory(std::size_t bytes, const char* folder, const char* why) noexcept;
  const char* what() const noexcept override { return text_; }

 private:
  char text_[512];
};

/// Returns `bytes` > 0 bytes of zeros in a file in `folder`. `alignment`: a power of two. Throws NoFileMemory.
/// Thread-safe, as all functions here.
void* allocate_in_file(std::size_t bytes, std::size_t alignment, const char* folder);

/// Releases memory of allocate_in_file(). Returns false, and does nothing, for any other address.
bool release_in_file(void* memory) noexcept;

/// Copies `bytes` of such memory by reading its file, or to it by writing, so that none of its pages becomes part of
/// the program's memory. Returns false, and does nothing, for any other address.
bool read_in_file(void* to, const void* from, std::size_t bytes) noexcept;
bool write_in_file(void* to, const void* from, std::size_t bytes) noexcept;

/// Removes the pages of all such memory from the program's memory; they stay in the file.
void forget_pages_in_files() noexcept;

/// Bytes of such memory at present.
std::size_t bytes_in_files() noexcept;

/// Whether a folder's files lie in memory (tmpfs). False for a folder that cannot be examined.
bool is_in_memory(const std::string& folder);

}  // namespace scarp::cli
