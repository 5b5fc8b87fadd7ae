// SPDX-License-Identifier: MIT
#include "scarp/base/array_files.h"

#include <atomic>
#include <cstring>

namespace scarp {
namespace {

std::atomic<const ArrayFiles*> array_files{nullptr};

}  // namespace

void set_array_files(const ArrayFiles* files) { array_files = files; }

bool has_array_files() {
  const ArrayFiles* const files = array_files.load(std::memory_order_relaxed);
  return files && files->any();
}

void read_array(void* to, const void* from, std::size_t bytes) {
  const ArrayFiles* const files = array_files;
  if (!files || !files->read(to, from, bytes)) std::memcpy(to, from, bytes);
}

void write_array(void* to, const void* from, std::size_t bytes) {
  const ArrayFiles* const files = array_files;
  if (!files || !files->write(to, from, bytes)) std::memcpy(to, from, bytes);
}

}  // namespace scarp
