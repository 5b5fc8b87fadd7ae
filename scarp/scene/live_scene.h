// SPDX-License-Identifier: MIT
// A scene that is edited while other threads query it: objects are added, moved and removed, and the fields under them
// are edited. Queries and edits alternate on one scene, as on a LiveField (accel/live_field.h).
//
//   scarp::LiveScene live;
//   std::uint32_t car = 0;
//   live.edit([&](auto& editor) {
//     editor.add(terrain);
//     car = editor.add(body, {.origin = {10, 20, 5}});
//   });
//
//   // one thread                                  // others
//   live.edit([&](auto& editor) {                  const auto reading = live.read();
//     editor.move(car, next_place);                scarp::cast(reading.scene(), rays, hits);
//     terrain.set_samples(rect, samples);          if (hits[0] && hits[0].object == car) ...
//   });
//
// The number of an object is its index in Scene::objects(), and the value of Hit::object. It does not change while the
// object exists. Later objects reuse the numbers of removed ones; until then no ray hits those numbers.
//
// Queries return the same results as a new scene of the same objects. Only the boxes on the path from the root of the
// hierarchy to an object are updated: a move in a scene of 10,000 objects takes about 5 us. When edits have degraded
// the hierarchy (box_tree_editor.h), an edit rebuilds it, at about 1 us per object, spread over at least 8 edits per
// object.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <shared_mutex>

#include "scarp/scene/scene.h"

namespace scarp {

class LiveScene {
 public:
  /// A scene without objects.
  LiveScene();
  /// Takes over the objects of a scene and their numbers. Throws Error if it is on a device.
  explicit LiveScene(const Scene& scene);
  /// No Reading may exist; asserted in debug builds.
  ~LiveScene();
  LiveScene(const LiveScene&) = delete;
  LiveScene& operator=(const LiveScene&) = delete;

  /// The scene at one epoch, the number of edits before it. Edits wait while a Reading exists: hold it for a ray, a
  /// batch or a frame. A thread that holds one must not call edit() or read(): it would wait for itself.
  class Reading {
   public:
    /// Valid while the Reading exists. A copy of it is a plain Scene, which throws Error after edits of its fields.
    const Scene& scene() const;
    std::uint64_t epoch() const;
    Reading(Reading&& other) noexcept;
    Reading& operator=(Reading&&) = delete;
    ~Reading();

   private:
    friend class LiveScene;
    explicit Reading(const LiveScene& live);
    const LiveScene* live_;
    std::shared_lock<std::shared_mutex> held_;
  };

  /// Returns a Reading of the current state. Waits for edits that are running or already waiting. Thread-safe.
  Reading read() const { return Reading(*this); }

  /// Changes objects, in edit().
  class Editor {
   public:
    /// Adds an object and returns its number. `part` is a field, a Terrain, Voxels, or another scene of one object;
    /// the object is placed as by combine(). Throws Error if the part has not exactly one object or is on a device, or
    /// for a placement as Scene's constructor does.
    std::uint32_t add(const Scene& part, const Placement& placement = {}, std::optional<std::uint32_t> material = {});
    /// Places an object. Throws Error if it does not exist, or for a placement as Scene's constructor does.
    void move(std::uint32_t object, const Placement& placement);
    /// Sets the mask of an object (SceneObject::mask). Throws Error if it does not exist or the mask is 0.
    void set_mask(std::uint32_t object, std::uint32_t mask);
    /// Removes an object, and its field unless another object uses it. Throws Error if it does not exist.
    void remove(std::uint32_t object);

   private:
    friend class LiveScene;
    explicit Editor(LiveScene& live) : live_(live) {}
    LiveScene& live_;
  };

  /// Calls `change` while no query runs, and returns the new epoch: queries see all of its edits at once. Inside it,
  /// fields of this scene may be edited by their own functions (Terrain::set_samples(), Voxels::edit(), ...); the scene
  /// detects which ones were. Only fields built by scene_heights(field) are rebuilt completely: edit a Terrain instead.
  /// If `change` throws, its edits before that remain, and the exception is rethrown. Thread-safe; `change` must not
  /// call edit() or read().
  std::uint64_t edit(const std::function<void(Editor&)>& change);

 private:
  struct State;

  std::unique_ptr<State> state_;
};

}  // namespace scarp
