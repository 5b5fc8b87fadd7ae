// SPDX-License-Identifier: MIT
// Access to arrays that a program may keep in files, for loops that use them place by place: a page of a mapped file
// that is touched becomes part of the program's memory, with those around it. Copies of pieces do not.
#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

namespace scarp {

/// How a program reads and writes arrays in files. Both return false for memory that is not in a file. Thread-safe.
struct ArrayFiles {
  bool (*any)() noexcept;  ///< whether there are arrays in files at present
  bool (*read)(void* to, const void* from, std::size_t bytes) noexcept;
  bool (*write)(void* to, const void* from, std::size_t bytes) noexcept;
};

/// Sets them for the process; null, as at the start: no array is in a file. `files` must outlive all uses.
void set_array_files(const ArrayFiles* files);
/// Whether some array may be in a file.
bool has_array_files();

/// Copies a piece of an array that may be in a file.
void read_array(void* to, const void* from, std::size_t bytes);
/// Copies to a piece of such an array.
void write_array(void* to, const void* from, std::size_t bytes);

/// A piece of such an array while it is used: the piece itself, or a copy that the destructor writes back.
template <class T>
class ArrayPiece {
 public:
  ArrayPiece(T* piece, std::size_t count) : piece_(piece) {
    if (!has_array_files()) return;
    copy_.resize(count);
    read_array(copy_.data(), piece, count * sizeof(T));
  }
  ~ArrayPiece() {
    if constexpr (!std::is_const_v<T>)
      if (!copy_.empty()) write_array(piece_, copy_.data(), copy_.size() * sizeof(T));
  }
  ArrayPiece(const ArrayPiece&) = delete;
  ArrayPiece& operator=(const ArrayPiece&) = delete;

  T* data() { return copy_.empty() ? piece_ : copy_.data(); }
  T& operator[](std::size_t i) { return data()[i]; }

 private:
  T* piece_;
  std::vector<std::remove_const_t<T>> copy_;
};

}  // namespace scarp
