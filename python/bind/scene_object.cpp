// SPDX-License-Identifier: MIT
#include "python/bind/scene_object.h"

namespace scarp::python {

void require_memory(const SceneObject& object) {
  for (const auto& guard : object.guards())
    if (guard->memory) guard->memory->require_unchanged();
}

std::vector<std::shared_lock<std::shared_mutex>> shared_locks(const SceneObject& object) {
  std::vector<std::shared_lock<std::shared_mutex>> locks;
  locks.reserve(object.guards().size());
  for (const auto& guard : object.guards()) locks.push_back(guard->turnstile.read());
  return locks;
}

Query::Checked::Checked(const SceneObject& object) { require_memory(object); }

Query::Query(const SceneObject& object) : checked_(object), release_(), locks_(shared_locks(object)) {}

}  // namespace scarp::python
