// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "scarp/c/scene_handle.h"
#include "scarp/c/settings.h"
#include "scarp/c/structures.h"
#include "scarp/c/threads.h"

namespace scarp::c {
namespace {

// Calls `release` of the caller when the last scene is gone, unless opening fails.
struct CallerMemory {
  explicit CallerMemory(const scarp_heights& given) : heights(given) {}
  CallerMemory(const CallerMemory&) = delete;
  CallerMemory& operator=(const CallerMemory&) = delete;
  ~CallerMemory() {
    if (opened) heights.release(heights.samples, heights.user_data);
  }

  scarp_heights heights;
  bool opened = false;
};

template <class T>
const T* aligned(const void* samples) {
  if (reinterpret_cast<std::uintptr_t>(samples) % alignof(T) != 0)
    throw Error("heights: samples are not aligned as their type");
  return static_cast<const T*>(samples);
}

HeightFieldSettings settings_of(const scarp_heights& given) {
  if (given.reserved != 0) throw Error("heights: reserved is not 0");
  HeightFieldSettings settings = ground_from(given);
  settings.wrap = choice(given.wrap, Wrap::shared_border, "wrap");
  settings.solid = flag(given.solid, "solid");
  return settings;
}

// Calls body(pointer to samples of their type).
template <class Body>
auto visit_samples(std::int32_t type, const void* samples, const Body& body) {
  switch (type) {
    case SCARP_FLOAT32:
      return body(aligned<float>(samples));
    case SCARP_INT16:
      return body(aligned<std::int16_t>(samples));
    case SCARP_UINT16:
      return body(aligned<std::uint16_t>(samples));
    default:
      throw Error(fmt::format("heights: type is {} (must be 0..2)", type));
  }
}

std::int32_t type_of(const HeightField& field) {
  switch (field.sample_type()) {
    case SampleType::int16:
      return SCARP_INT16;
    case SampleType::uint16:
      return SCARP_UINT16;
    case SampleType::float32:
      break;
  }
  return SCARP_FLOAT32;
}

Terrain viewed(const scarp_heights& given, const std::weak_ptr<const void>& memory) {
  const HeightFieldSettings settings = settings_of(given);
  return visit_samples(given.type, given.samples, [&](const auto* samples) {
    return Terrain::view(samples, given.cols, given.rows, settings, static_cast<std::ptrdiff_t>(given.row_stride),
                         memory);
  });
}

Terrain copied(const scarp_heights& given) {
  const HeightFieldSettings settings = settings_of(given);
  return visit_samples(given.type, given.samples, [&]<class T>(const T* samples) {
    const std::int64_t stride = given.row_stride == 0 ? given.cols : given.row_stride;
    if (!samples || given.cols < 1 || given.rows < 1 || std::abs(stride) < given.cols)
      throw Error(fmt::format(
          "heights: {} x {} samples, {} apart (need a pointer, at least 1 x 1, and rows that do not overlap)",
          given.cols, given.rows, stride));
    std::vector<T> own(static_cast<std::size_t>(given.cols) * static_cast<std::size_t>(given.rows));
    for (std::ptrdiff_t row = 0; row < given.rows; ++row)
      std::copy_n(samples + row * static_cast<std::ptrdiff_t>(stride), given.cols, own.data() + row * given.cols);
    return Terrain::own(std::move(own), given.cols, given.rows, settings);
  });
}

SampleRect rect_from(const scarp_rect* rect) {
  required(rect, "rect");
  return {rect->col, rect->row, rect->cols, rect->rows};
}

}  // namespace
}  // namespace scarp::c

using namespace scarp::c;

scarp_status scarp_heights_view(const scarp_heights* heights, scarp_scene** scene) {
  return guarded_on_threads([&] {
    required(scene, "scene");
    const scarp_heights given = read(heights, "heights");
    std::shared_ptr<CallerMemory> memory;
    if (given.release) memory = std::make_shared<CallerMemory>(given);
    auto whole = opened(viewed(given, memory));
    if (memory) {
      whole->parts.memory.push_back(memory);
      memory->opened = true;
    }
    *scene = whole.release();
  });
}

scarp_status scarp_heights_copy(const scarp_heights* heights, scarp_scene** scene) {
  return guarded_on_threads([&] {
    required(scene, "scene");
    const scarp_heights given = read(heights, "heights");
    if (given.release) throw scarp::Error("heights: release is for scarp_heights_view() (leave it NULL)");
    *scene = opened(copied(given)).release();
  });
}

scarp_status scarp_heights_changed(scarp_scene* scene, const scarp_rect* rect) {
  return guarded_on_threads([&] { only<scarp::Terrain>(scene, "heights").samples_changed(rect_from(rect)); });
}

scarp_status scarp_heights_set(scarp_scene* scene, const scarp_rect* rect, const void* samples, int64_t row_stride) {
  return guarded_on_threads([&] {
    auto& terrain = only<scarp::Terrain>(scene, "heights");
    visit_samples(type_of(terrain.field()), samples, [&](const auto* own) {
      terrain.set_samples(rect_from(rect), own, static_cast<std::ptrdiff_t>(row_stride));
    });
  });
}
