// SPDX-License-Identifier: MIT
// Counts edits to fields, so that structures built from a field can detect that they are out of date.
#pragma once

#include <atomic>
#include <cstdint>

namespace scarp {

/// Number of edits to all fields in this process: while it does not change, no field does. Scenes compare it before
/// every query and check their own fields only if it changed.
extern std::atomic<std::uint64_t> edits_of_all_fields;

/// Number of edits to one field. Copies start from the same number.
class EditCount {
 public:
  void add() {
    ++edits_;
    edits_of_all_fields.fetch_add(1, std::memory_order_relaxed);
  }
  std::uint64_t value() const { return edits_; }

 private:
  std::uint64_t edits_ = 0;
};

/// The value of edits_of_all_fields at which a scene last compared its own fields. May be read and set concurrently.
class EditsSeen {
 public:
  EditsSeen() = default;
  EditsSeen(const EditsSeen& other) : edits_(other.value()) {}
  EditsSeen& operator=(const EditsSeen& other) {
    set(other.value());
    return *this;
  }
  std::uint64_t value() const { return edits_.load(std::memory_order_relaxed); }
  void set(std::uint64_t edits) { edits_.store(edits, std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> edits_{0};
};

}  // namespace scarp
