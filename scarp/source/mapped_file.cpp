// SPDX-License-Identifier: MIT
#include "scarp/source/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scarp/base/error.h"
#include "scarp/base/input_file.h"

namespace scarp {
namespace {

// Closes a file descriptor; the mapping stays.
struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) close(number);
  }
};

}  // namespace

MappedFile::MappedFile(const std::string& path) {
  refuse_special_file(path);
  const Descriptor file{open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.number < 0) throw Error("cannot be opened");
  struct stat facts {};
  if (fstat(file.number, &facts) != 0 || !S_ISREG(facts.st_mode)) throw Error("cannot be read (is it a file?)");
  if (facts.st_size == 0) return;  // mmap() fails for a length of 0
  const auto size = static_cast<std::size_t>(facts.st_size);
  void* const at = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number, 0);
  if (at == MAP_FAILED) throw Error("cannot be mapped into memory");
  // A hint: the system starts to read before the first use.
  madvise(at, size, MADV_WILLNEED);
  bytes_ = {static_cast<const char*>(at), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

}  // namespace scarp
