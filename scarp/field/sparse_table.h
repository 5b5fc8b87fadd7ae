// SPDX-License-Identifier: MIT
// A table of numbers, most of them 0, for grids with more cells than fit in memory. A table of up to kFlat entries is
// one array; a larger one consists of chunks of kChunk entries. Chunks of zeros share storage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace scarp {

template <class T>
class SparseTable {
 public:
  static constexpr int kChunkBits = 12;
  static constexpr std::size_t kChunk = std::size_t{1} << kChunkBits, kFlat = std::size_t{1} << 21;

  SparseTable() : SparseTable(0) {}
  explicit SparseTable(std::size_t count) : count_(count) {
    if (count <= kFlat) {
      values_.resize(count + kReadBeyond);
    } else {
      chunks_.resize((count + kChunk - 1) / kChunk + kReadBeyond);
      values_.resize(kChunk + kReadBeyond);
    }
  }

  std::size_t size() const { return count_; }
  bool flat() const { return chunks_.empty(); }
  T operator[](std::size_t index) const {
    return flat() ? values_[index] : values_[chunks_[index >> kChunkBits] + (index & (kChunk - 1))];
  }
  /// Reference valid until the next call of a non-const function.
  T& at(std::size_t index) {
    if (flat()) return values_[index];
    std::uint32_t& chunk = chunks_[index >> kChunkBits];
    if (chunk == 0) {
      // A chunk is kept until the table is destroyed, even if all its entries become 0 again.
      const std::size_t first = values_.size() - kReadBeyond;
      values_.resize(values_.size() + kChunk);
      chunk = static_cast<std::uint32_t>(first);
    }
    return values_[chunk + (index & (kChunk - 1))];
  }
  /// Returns the first index >= `index` whose chunk may contain a number other than 0, or size().
  std::size_t next(std::size_t index) const {
    if (flat() || index >= count_ || chunks_[index >> kChunkBits] != 0) return index < count_ ? index : count_;
    std::size_t chunk = index >> kChunkBits;
    while (chunk + kReadBeyond < chunks_.size() && chunks_[chunk] == 0) ++chunk;
    return chunk << kChunkBits < count_ ? chunk << kChunkBits : count_;
  }

  /// For vector code: entry i is values()[i] if flat(), otherwise values()[chunks()[i / kChunk] + i % kChunk]. One
  /// extra element of each is readable.
  std::span<const T> values() const { return values_; }
  std::span<const std::uint32_t> chunks() const { return chunks_; }
  std::size_t bytes() const { return values_.size() * sizeof(T) + chunks_.size() * sizeof(std::uint32_t); }

  /// Compares entries, regardless of how they are stored.
  friend bool operator==(const SparseTable& a, const SparseTable& b) {
    if (a.count_ != b.count_) return false;
    for (std::size_t i = 0; i < a.count_; ++i) {
      const std::size_t next_a = a.next(i), next_b = b.next(i);
      i = next_a < next_b ? next_a : next_b;
      if (i < a.count_ && a[i] != b[i]) return false;
    }
    return true;
  }

 private:
  static constexpr std::size_t kReadBeyond = 1;

  std::size_t count_;
  std::vector<std::uint32_t> chunks_;  // first value of each
  std::vector<T> values_;
};

}  // namespace scarp
