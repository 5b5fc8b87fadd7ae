// SPDX-License-Identifier: MIT
// Ray queries of every scene: closest hits, occlusion, heights. Rays are converted piece by piece; hits are written
// where NumPy keeps them.
#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "python/bind/arrays.h"
#include "python/bind/bind.h"
#include "python/bind/tasks.h"
#include "python/bind/terrain_object.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/fan_batch.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/scene/cast.h"

namespace scarp::python {
namespace {

namespace py = pybind11;

// Rays that fit a thread's L2 cache, and enough of them for all threads.
constexpr std::size_t kRaysAtOnce = 1 << 16;
constexpr std::int64_t kRaysPerColumn = 8192, kNormalsPerPiece = 1024, kRaysOfAllHits = 256;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

// One number for all rays, or one per ray.
class Numbers {
 public:
  Numbers(const py::object& value, double fallback, std::size_t count, const char* name) : fallback_(fallback) {
    if (value.is_none()) return;
    const Doubles array(value);
    if (array.size() == 1) {
      fallback_ = *array.data();
    } else if (static_cast<std::size_t>(array.size()) == count) {
      values_ = array.data();
      array_ = array;
    } else {
      throw Error(fmt::format("{}: {} values for {} rays (expected one, or one per ray)", name, array.size(), count));
    }
  }
  double operator[](std::size_t i) const { return values_ ? values_[i] : fallback_; }

 private:
  double fallback_;
  py::object array_{};  // keeps the values
  const double* values_ = nullptr;
};

// A batch of rays in arrays.
struct Rays {
  Rays(const py::array& origin_array, const py::array& direction_array, const py::object& first, const py::object& last)
      : origins(origin_array, "origins"),
        directions(direction_array, "directions"),
        t_min(first, 0, origins.count(), "t_min"),
        t_max(last, std::numeric_limits<double>::infinity(), origins.count(), "t_max") {
    if (origins.count() != directions.count())
      throw Error(
          fmt::format("rays: {} origins, {} directions (expected as many)", origins.count(), directions.count()));
  }
  std::size_t count() const { return origins.count(); }
  Ray operator[](std::size_t i) const {
    Ray ray;
    ray.origin = origins[i];
    ray.direction = directions[i];
    ray.t_min = t_min[i];
    ray.t_max = t_max[i];
    return ray;
  }

  Vectors origins, directions;
  Numbers t_min, t_max;
};

// Names a ray of a piece by its index in the whole batch.
[[noreturn]] void throw_named(const Scene& scene, std::span<const Ray> piece, std::size_t first, std::size_t all,
                              const Error& error) {
  for (std::size_t i = 0; i < piece.size(); ++i) {
    try {
      validate(piece[i], scene);
    } catch (const Error& of_ray) {
      std::string_view what = of_ray.what();
      if (what.starts_with("ray: ")) what.remove_prefix(5);
      throw Error(fmt::format("ray {} of {}: {}", first + i, all, what));
    }
  }
  throw error;
}

// The number of rays of a piece, given the first ones: whole rows of a camera or a scanner, which are faster as a fan.
std::size_t rays_at_once(const SceneObject& object, std::span<const Ray> first) {
  const auto* terrain = dynamic_cast<const TerrainObject*>(&object);
  const auto fan = terrain ? fan_batch(terrain->terrain().target(), first) : std::nullopt;
  return fan ? first.size() / fan->run * fan->run : first.size();
}

// Calls answer(first, rays, from) for pieces of the batch. `start`: the hits on whose surfaces rays start, or null.
template <class Answer>
void for_each_piece(const SceneObject& object, const Rays& rays, const Hit* start, const Answer& answer) {
  const Scene& scene = object.scene();
  std::vector<Ray> piece;
  std::vector<const Hit*> from;
  std::size_t at_once = kRaysAtOnce;
  for (std::size_t first = 0; first < rays.count(); first += piece.size()) {
    if (first > 0) check_signals();
    piece.resize(std::min(at_once, rays.count() - first));
    if (start) from.resize(piece.size());
    parallel_for(static_cast<std::int64_t>(piece.size()), kRaysPerColumn, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        piece[i] = rays[first + i];
        if (start) from[i] = start[first + i] ? &start[first + i] : nullptr;
      }
    });
    if (first == 0 && piece.size() < rays.count()) {
      at_once = rays_at_once(object, piece);
      piece.resize(at_once);
      if (start) from.resize(at_once);
    }
    try {
      answer(first, std::span<const Ray>(piece), std::span<const Hit* const>(from));
    } catch (const Error& error) {
      throw_named(scene, piece, first, rays.count(), error);
    }
  }
}

const Hit* start_of(const py::object& start, std::size_t count) {
  if (start.is_none()) return nullptr;
  auto array = py::reinterpret_borrow<py::array>(start);
  return static_cast<const Hit*>(require_room(array, count, sizeof(Hit), "start"));
}

// Room for a vector per ray; null for None.
dvec3* vectors_in(const py::object& out, std::size_t count, const char* name) {
  if (out.is_none()) return nullptr;
  if (!py::isinstance<py::array_t<double>>(out))
    throw py::type_error(fmt::format("{}: is not an array of float64", name));
  auto array = py::reinterpret_borrow<py::array>(out);
  return static_cast<dvec3*>(require_room(array, count, sizeof(dvec3), name));
}

void cast_rays(const SceneObject& self, const py::array& origins, const py::array& directions, py::array& hits,
               const py::object& positions, const py::object& normals, const py::object& t_min, const py::object& t_max,
               const py::object& start) {
  const Rays rays(origins, directions, t_min, t_max);
  const std::size_t count = rays.count();
  auto* found = static_cast<Hit*>(require_room(hits, count, sizeof(Hit), "out"));
  dvec3* points = vectors_in(positions, count, "out.position");
  dvec3* upward = vectors_in(normals, count, "out.normal");
  const Hit* from = start_of(start, count);
  const Query query(self);
  const Scene& scene = self.scene();
  const auto complete = [&](const Ray& ray, std::size_t i) {
    const Hit& hit = found[i];
    if (points) points[i] = hit ? ray.at(hit.t) : dvec3(std::numeric_limits<double>::quiet_NaN());
    if (upward) upward[i] = hit ? scene.surface(ray, hit).normal : dvec3(0.0);
  };
  if (count == 1) {
    const Ray ray = rays[0];
    found[0] = cast(scene, ray, from && from[0] ? from : nullptr);
    return complete(ray, 0);
  }
  for_each_piece(self, rays, from,
                 [&](std::size_t first, std::span<const Ray> piece, std::span<const Hit* const> starts) {
                   cast(scene, piece, std::span(found + first, piece.size()), starts);
                   if (!points && !upward) return;
                   parallel_for(static_cast<std::int64_t>(piece.size()), kNormalsPerPiece,
                                [&](std::int64_t begin, std::int64_t end) {
                                  for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
                                    complete(piece[i], first + i);
                                });
                 });
}

// Whether these are arrays (n, 3) of floats and room for n answers: such calls need no preparation in Python.
bool plain(const py::object& origins, const py::object& directions, const py::array& answers) {
  if (!py::isinstance<py::array>(origins) || !py::isinstance<py::array>(directions)) return false;
  const auto a = py::reinterpret_borrow<py::array>(origins), b = py::reinterpret_borrow<py::array>(directions);
  return Vectors::readable(a) && Vectors::readable(b) && answers.ndim() == 1 && a.shape(0) == b.shape(0) &&
         answers.shape(0) == a.shape(0);
}

bool cast_plain(const SceneObject& self, const py::object& origins, const py::object& directions, py::array& hits,
                const py::object& positions, const py::object& normals) {
  if (!plain(origins, directions, hits)) return false;
  cast_rays(self, origins.cast<py::array>(), directions.cast<py::array>(), hits, positions, normals, py::none(),
            py::none(), py::none());
  return true;
}

void occluded_rays(const SceneObject& self, const py::array& origins, const py::array& directions, py::array& blocked,
                   const py::object& t_min, const py::object& t_max, const py::object& start) {
  const Rays rays(origins, directions, t_min, t_max);
  auto* answers = static_cast<std::uint8_t*>(require_room(blocked, rays.count(), 1, "out"));
  const Hit* from = start_of(start, rays.count());
  const Query query(self);
  const Scene& scene = self.scene();
  if (rays.count() == 1) {
    answers[0] = occluded(scene, rays[0], from && from[0] ? from : nullptr);
    return;
  }
  for_each_piece(self, rays, from,
                 [&](std::size_t first, std::span<const Ray> piece, std::span<const Hit* const> starts) {
                   occluded(scene, piece, std::span(answers + first, piece.size()), starts);
                 });
}

bool occluded_plain(const SceneObject& self, const py::object& origins, const py::object& directions,
                    py::array& blocked) {
  if (!plain(origins, directions, blocked)) return false;
  occluded_rays(self, origins.cast<py::array>(), directions.cast<py::array>(), blocked, py::none(), py::none(),
                py::none());
  return true;
}

void heights(const SceneObject& self, const Doubles& xs, const Doubles& ys, py::array_t<double>& out) {
  const auto count = static_cast<std::size_t>(xs.size());
  auto* found = static_cast<double*>(require_room(out, count, sizeof(double), "out"));
  const std::span x(xs.data(), count), y(ys.data(), static_cast<std::size_t>(ys.size()));
  const Query query(self);
  heights_at(self.scene(), x, y, std::span(found, count));
}

// All hits along each ray: the bytes of the hits, and the index of the first of each ray, with the number of all last.
py::tuple all_hits(const TerrainObject& self, const py::array& origins, const py::array& directions,
                   const py::object& t_min, const py::object& t_max) {
  const Rays rays(origins, directions, t_min, t_max);
  require_memory(self);
  auto [found, first] = result_of_task(py::none(), [&](const Progress& report) {
    const auto locks = shared_locks(self);
    std::vector<Hit> found_here;
    std::vector<std::int64_t> first_here{0};
    const Scene& scene = self.scene();
    const HeightTarget target = self.terrain().target();
    for (std::size_t i = 0; i < rays.count(); ++i) {
      try {
        validate(rays[i], scene);
      } catch (const Error& error) {
        const Ray ray = rays[i];
        throw_named(scene, std::span(&ray, 1), i, rays.count(), error);
      }
    }
    std::vector<std::vector<Hit>> of_ray(rays.count());
    parallel_for(
        static_cast<std::int64_t>(rays.count()), kRaysOfAllHits,
        [&](std::int64_t begin, std::int64_t end) {
          for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            if (all_hits_max_mip(target, rays[i], of_ray[i]) != HitStatus::hit) of_ray[i].clear();
        },
        report);
    for (const auto& hits : of_ray) {
      found_here.insert(found_here.end(), hits.begin(), hits.end());
      first_here.push_back(static_cast<std::int64_t>(found_here.size()));
    }
    return std::pair(std::move(found_here), std::move(first_here));
  });
  const auto starts = static_cast<py::ssize_t>(first.size());
  auto kept = std::make_unique<std::vector<Hit>>(std::move(found));
  const auto bytes = static_cast<py::ssize_t>(kept->size() * sizeof(Hit));
  const auto* data = reinterpret_cast<const std::uint8_t*>(kept->data());
  py::capsule owner(kept.get(), [](void* hits) { delete static_cast<std::vector<Hit>*>(hits); });
  kept.release();
  return py::make_tuple(py::array_t<std::uint8_t>({bytes}, data, owner),
                        handed_over<std::int64_t>(std::move(first), {starts}));
}

}  // namespace

void bind_queries(py::module_& module, py::class_<SceneObject>& base) {
  py::dict offsets;
  offsets["status"] = offsetof(Hit, status);
  offsets["wall"] = offsetof(Hit, wall);
  offsets["face"] = offsetof(Hit, face);
  offsets["object"] = offsetof(Hit, object);
  offsets["t"] = offsetof(Hit, t);
  offsets["cell"] = offsetof(Hit, cell);
  offsets["u"] = offsetof(Hit, u);
  offsets["v"] = offsetof(Hit, v);
  offsets["height"] = offsetof(Hit, height);
  offsets["voxel"] = offsetof(Hit, voxel);
  offsets["part"] = offsetof(Hit, part);
  module.attr("HIT_OFFSETS") = offsets;
  module.attr("HIT_BYTES") = sizeof(Hit);
  base.def("_cast", &cast_rays, py::arg("origins"), py::arg("directions"), py::arg("hits"), py::arg("positions"),
           py::arg("normals"), py::arg("t_min"), py::arg("t_max"), py::arg("start"))
      .def("_cast_plain", &cast_plain, py::arg("origins"), py::arg("directions"), py::arg("hits"), py::arg("positions"),
           py::arg("normals"))
      .def("_occluded", &occluded_rays, py::arg("origins"), py::arg("directions"), py::arg("blocked"), py::arg("t_min"),
           py::arg("t_max"), py::arg("start"))
      .def("_occluded_plain", &occluded_plain, py::arg("origins"), py::arg("directions"), py::arg("blocked"))
      .def("_heights_at", &heights, py::arg("xs"), py::arg("ys"), py::arg("out"));
  module.def("all_hits", &all_hits, py::arg("terrain"), py::arg("origins"), py::arg("directions"), py::arg("t_min"),
             py::arg("t_max"));
}

}  // namespace scarp::python
