// SPDX-License-Identifier: MIT
// What Python holds of a scene: the scene, the arrays that it reads, and locks between queries and edits.
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <shared_mutex>
#include <utility>
#include <vector>

#include "python/bind/arrays.h"
#include "scarp/base/turnstile.h"
#include "scarp/scene/scene.h"

namespace scarp::python {

/// The lock of one field, and its array if it has one. Queries share it; edits own it.
struct FieldGuard {
  Turnstile turnstile{};
  std::unique_ptr<ArrayMemory> memory{};
  std::uint64_t edits = 0;  // changed under the lock
};
using FieldGuards = std::vector<std::shared_ptr<FieldGuard>>;

/// Base of all Python classes that answer rays.
class SceneObject {
 public:
  virtual ~SceneObject() = default;
  /// The scene of the current fields. Call only within a Query.
  virtual const Scene& scene() const = 0;
  const FieldGuards& guards() const { return guards_; }

 protected:
  // In the same order in all scenes, so that two queries never wait for each other.
  explicit SceneObject(FieldGuards guards) : guards_(std::move(guards)) { std::sort(guards_.begin(), guards_.end()); }

 private:
  FieldGuards guards_;
};

/// While it lives, this thread has given up the interpreter's lock and no edit of these fields runs. Throws Error if an
/// array was resized.
class Query {
 public:
  explicit Query(const SceneObject& object);

 private:
  struct Checked {
    explicit Checked(const SceneObject& object);
  };
  Checked checked_;
  pybind11::gil_scoped_release release_;
  std::vector<std::shared_lock<std::shared_mutex>> locks_;
};

/// Throws Error if an array of these fields was resized. Requires the interpreter's lock.
void require_memory(const SceneObject& object);
/// Locks the fields for a query in another thread than that of the interpreter.
std::vector<std::shared_lock<std::shared_mutex>> shared_locks(const SceneObject& object);

}  // namespace scarp::python
