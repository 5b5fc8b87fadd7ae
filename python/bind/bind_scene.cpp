// SPDX-License-Identifier: MIT
// The class Scene of the module: several terrains, voxels and scenes under placements.
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "python/bind/bind.h"
#include "scarp/base/error.h"
#include "scarp/scene/combine.h"

namespace scarp::python {
namespace {

namespace py = pybind11;

// A part: its origin, scale and rotation (row by row).
using PlacedPart = std::tuple<const SceneObject*, std::array<double, 3>, double, std::array<double, 9>>;

Placement placement_of(const PlacedPart& part) {
  const auto& origin = std::get<1>(part);
  const auto& rows = std::get<3>(part);
  Placement placement;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      placement.turn[column][row] = rows[static_cast<std::size_t>(3 * row + column)];
  placement.scale = std::get<2>(part);
  placement.origin = {origin[0], origin[1], origin[2]};
  return placement;
}

// The guards of all parts, each once: a lock cannot be shared twice by one thread.
FieldGuards guards_of(const std::vector<PlacedPart>& parts) {
  FieldGuards all;
  for (const PlacedPart& part : parts)
    for (const auto& guard : std::get<0>(part)->guards())
      if (std::find(all.begin(), all.end(), guard) == all.end()) all.push_back(guard);
  return all;
}

class CombinedScene : public SceneObject {
 public:
  // Python keeps the parts alive (keep_alive).
  explicit CombinedScene(std::vector<PlacedPart> parts) : SceneObject(guards_of(parts)), parts_(std::move(parts)) {
    const Query query(*this);
    scene();
  }

  // Combines again after an edit of a part.
  const Scene& scene() const override {
    const std::lock_guard lock(mutex_);
    std::uint64_t edits = 0;
    for (const auto& guard : guards()) edits += guard->edits;
    if (!scene_ || edits != edits_) {
      std::vector<ScenePart> placed;
      for (const PlacedPart& part : parts_) placed.push_back({std::get<0>(part)->scene(), placement_of(part)});
      scene_.emplace(combine(placed));
      edits_ = edits;
    }
    return *scene_;
  }

 private:
  std::vector<PlacedPart> parts_;
  mutable std::mutex mutex_;
  mutable std::optional<Scene> scene_;
  mutable std::uint64_t edits_ = 0;
};

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<CombinedScene, SceneObject>(module, "Scene")
      .def(py::init<std::vector<PlacedPart>>(), py::arg("parts"), py::keep_alive<1, 2>());
}

}  // namespace scarp::python
