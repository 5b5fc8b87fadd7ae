// SPDX-License-Identifier: MIT
// A lock for many readers or one editor, in turn: an edit waits for current readers, and later readers wait for the
// edit, so neither side starves. std::shared_mutex alone does not promise this.
#pragma once

#include <mutex>
#include <shared_mutex>

namespace scarp {

/// Locks for readers and editors. Thread-safe; a thread that holds one of its locks must not request another.
class Turnstile {
 public:
  [[nodiscard]] std::shared_lock<std::shared_mutex> read() {
    const std::scoped_lock in_turn(turn_);
    return std::shared_lock(held_);
  }
  [[nodiscard]] std::unique_lock<std::shared_mutex> edit() {
    const std::scoped_lock in_turn(turn_);
    return std::unique_lock(held_);
  }

 private:
  std::mutex turn_;  // held while an edit waits: later readers queue here
  std::shared_mutex held_;
};

}  // namespace scarp
