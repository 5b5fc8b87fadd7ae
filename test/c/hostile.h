// SPDX-License-Identifier: MIT
// Calls of the C interface with random and hostile arguments: by hostile_test and the fuzz target c_interface. Only the
// functions of scarp_c.h, as another language calls them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "scarp/scarp_c.h"

namespace scarp::test {

/// Samples of a side of the fields, and rays of a batch.
constexpr int kSide = 9, kRays = 8;

/// `bits` returns random numbers, of which the lowest 16 bits are used.
template <class Bits>
class Hostile {
 public:
  explicit Hostile(Bits bits) : bits_(std::move(bits)) {
    for (std::size_t i = 0; i < samples_.size(); ++i) samples_[i] = static_cast<float>(i * i % 7);
    for (std::size_t i = 0; i < voxels_.size(); ++i) voxels_[i] = i % 5 == 0;
    scarp_heights heights{};
    heights.struct_size = sizeof heights;
    heights.samples = samples_.data();
    heights.cols = heights.rows = kSide;
    open_ = {};
    expect_ok(scarp_heights_copy(&heights, &open_[0]));
    heights.wrap = SCARP_WRAP_PERIODIC;
    expect_ok(scarp_heights_view(&heights, &open_[1]));
    heights.wrap = SCARP_WRAP_NONE, heights.solid = 1;
    expect_ok(scarp_heights_copy(&heights, &open_[2]));
    scarp_voxels voxels{};
    voxels.struct_size = sizeof voxels;
    voxels.indices = voxels_.data();
    voxels.size[0] = voxels.size[1] = voxels.size[2] = 5;
    expect_ok(scarp_voxels_copy(&voxels, &open_[3]));
    scarp_tile_layout layout{};
    layout.struct_size = sizeof layout;
    layout.cols = layout.rows = 2;
    layout.cell_cols = layout.cell_rows = kSide - 1;
    expect_ok(scarp_tiles_create(&layout, &tiles_));
    expect_ok(scarp_live_create(&live_));
  }
  ~Hostile() {
    for (scarp_scene* scene : open_) scarp_scene_release(scene);
    scarp_tiles_release(tiles_);
    scarp_live_release(live_);
  }
  Hostile(const Hostile&) = delete;
  Hostile& operator=(const Hostile&) = delete;

  /// Makes a random call. Throws std::runtime_error unless its status is expected, and a refusal has one line as
  /// message.
  void call() {
    const scarp_status status = called();
    if (status < SCARP_OK || status >= SCARP_FAILED) throw std::runtime_error(scarp_last_error());
    const std::string_view message = scarp_last_error();
    if (status != SCARP_OK && (message.empty() || message.find_first_of("\r\n") != std::string_view::npos))
      throw std::runtime_error("a refusal without a line that says why");
    ++counts[status == SCARP_OK];
  }
  Bits& bits() { return bits_; }

  std::array<int, 2> counts{};  // refused, answered

 private:
  static void expect_ok(scarp_status status) {
    if (status != SCARP_OK) throw std::runtime_error(scarp_last_error());
  }
  int below(int count) { return static_cast<int>(bits_() % static_cast<std::uint32_t>(count)); }
  bool rarely() { return below(12) == 0; }

  double number() {
    static constexpr double kBad[] = {std::numeric_limits<double>::quiet_NaN(),
                                      std::numeric_limits<double>::infinity(),
                                      -std::numeric_limits<double>::infinity(),
                                      std::numeric_limits<double>::max(),
                                      std::numeric_limits<double>::denorm_min(),
                                      -1e300,
                                      1e18,
                                      0.0,
                                      -0.0};
    if (below(40) == 0) return kBad[below(9)];
    return 0.01 * (below(2000) - 500);
  }
  std::int32_t integer() {
    static constexpr std::int32_t kBad[] = {std::numeric_limits<std::int32_t>::max(),
                                            std::numeric_limits<std::int32_t>::min(), -1, 1 << 20};
    return rarely() ? kBad[below(4)] : below(kSide + 2);
  }
  template <class T>
  T* maybe(T* pointer) {
    return below(50) == 0 ? nullptr : pointer;
  }
  std::size_t size(std::size_t right) {
    static constexpr std::size_t kBad[] = {0, 7, 4096, 1 << 20, ~std::size_t{0}};
    // 4096 may be read: the structures are in the buffer of given().
    return below(30) == 0 ? kBad[below(5)] : right;
  }
  // A structure in a buffer large enough for every size that is accepted.
  template <class T>
  const T* given(const T& value) {
    std::memset(room_.data(), below(30) == 0, room_.size());
    std::memcpy(room_.data(), &value, sizeof value);
    return reinterpret_cast<const T*>(room_.data());
  }

  scarp_scene* scene() { return maybe(open_[static_cast<std::size_t>(below(static_cast<int>(open_.size())))]); }
  scarp_ray ray() {
    scarp_ray ray;
    for (double& value : ray.origin) value = number();
    for (double& value : ray.direction) value = number();
    ray.t_min = rarely() ? number() : 0;
    ray.t_max = below(3) == 0 ? number() : below(2) ? 100 : std::numeric_limits<double>::infinity();
    return ray;
  }
  scarp_hit hit() {
    if (below(3) == 0) return last_;
    scarp_hit hit = last_;
    switch (below(7)) {
      case 0:
        hit.object = static_cast<std::uint32_t>(integer());
        break;
      case 1:
        hit.col = integer(), hit.row = integer();
        break;
      case 2:
        for (std::int32_t& value : hit.voxel) value = integer();
        break;
      case 3:
        hit.part = static_cast<std::uint32_t>(integer());
        break;
      case 4:
        hit.u = number(), hit.v = number(), hit.t = number(), hit.height = number();
        break;
      case 5:
        hit.status = static_cast<std::uint8_t>(below(256)), hit.wall = static_cast<std::uint8_t>(below(256));
        break;
      default:
        hit.face = static_cast<std::uint8_t>(below(256));
    }
    return hit;
  }
  scarp_part part() {
    scarp_part part{};
    part.scene = scene();
    if (below(3) == 0) part.scale = number();
    if (below(4) == 0) part.turn[0] = number();
    for (double& value : part.origin) value = number();
    part.mask = static_cast<std::uint32_t>(below(3));
    part.reserved = below(30) == 0;
    return part;
  }
  void keep(scarp_status status, scarp_scene* scene) {
    if (status != SCARP_OK) return;
    scarp_scene*& place = open_[static_cast<std::size_t>(4 + below(4))];
    scarp_scene_release(place);
    place = scene;
  }

  scarp_status called() {
    switch (below(19)) {
      case 0:
      case 1:
        return cast();
      case 2: {
        const scarp_ray own = ray();
        const scarp_hit from = hit();
        std::uint8_t blocked;
        return scarp_occluded(scene(), maybe(&own), below(2) ? &from : nullptr, maybe(&blocked));
      }
      case 3:
        return batch();
      case 4:
        return arrays();
      case 5: {
        scarp_surface surface{};
        surface.struct_size = below(30) == 0 ? 3 : sizeof surface;
        const scarp_ray own = ray();
        const scarp_hit from = hit();
        return scarp_surface_at(scene(), maybe(&own), maybe(&from), maybe(&surface));
      }
      case 6: {
        const scarp_ray own = ray();
        std::size_t count = 0;
        return scarp_all_hits(scene(), maybe(&own), hits_.data(), kRays, maybe(&count));
      }
      case 7: {
        const double x[2] = {number(), number()}, y[2] = {number(), number()};
        double heights[2];
        return scarp_heights_at(scene(), maybe(x), maybe(y), maybe(heights), static_cast<std::size_t>(below(3)));
      }
      case 8:
        return fan();
      case 9:
        return contact();
      case 10:
        return open();
      case 11: {
        const scarp_part parts[2] = {part(), part()};
        scarp_scene* whole = nullptr;
        // Sizes double with every combination of combinations.
        if (scarp_scene_objects(parts[0].scene) + scarp_scene_objects(parts[1].scene) > 20) return SCARP_OK;
        const scarp_status status = scarp_scene_combine(maybe(parts), static_cast<std::size_t>(below(3)), &whole);
        return keep(status, whole), status;
      }
      case 12: {
        const scarp_rect rect{integer(), integer(), integer(), integer()};
        return below(2) ? scarp_heights_changed(scene(), maybe(&rect))
                        : scarp_heights_set(scene(), maybe(&rect), maybe(samples_.data()), 0);
      }
      case 13: {
        const std::int32_t low[3] = {integer(), integer(), integer()}, high[3] = {integer(), integer(), integer()};
        return scarp_voxels_set_box(scene(), maybe(low), maybe(high), integer());
      }
      case 14: {
        const double centre[3] = {number(), number(), number()};
        return scarp_voxels_set_sphere(scene(), maybe(centre), number(), integer());
      }
      case 15:
        return tiles();
      case 16:
        return live();
      case 17: {
        scarp_scene_set_user_data(scene(), this);
        return scarp_scene_user_data(nullptr) ? SCARP_FAILED : SCARP_OK;
      }
      default: {
        scarp_threads threads{};
        threads.struct_size = size(sizeof threads);
        threads.run = maybe(+[](void*, std::int64_t pieces, void (*piece)(void*, std::int64_t), void* context) {
          for (std::int64_t i = 0; i < pieces; ++i) piece(context, i);
        });
        return scarp_use_threads(below(2) ? given(threads) : nullptr);
      }
    }
  }

  scarp_status cast() {
    const scarp_ray own = ray();
    const scarp_hit from = hit();
    scarp_hit found{};
    const scarp_status status = scarp_cast(scene(), maybe(&own), below(3) == 0 ? &from : nullptr, maybe(&found));
    if (status == SCARP_OK && found.status == SCARP_HIT) last_ = found;
    return status;
  }
  scarp_status batch() {
    std::array<scarp_ray, kRays> rays;
    std::array<scarp_hit, kRays> from;
    std::array<std::uint8_t, kRays> blocked;
    for (int i = 0; i < kRays; ++i) {
      rays[static_cast<std::size_t>(i)] = ray();
      from[static_cast<std::size_t>(i)] = hit();
    }
    const auto count = static_cast<std::size_t>(below(kRays + 1));
    const scarp_hit* start = below(2) ? from.data() : nullptr;
    return below(2) ? scarp_cast_batch(scene(), maybe(rays.data()), start, maybe(hits_.data()), count)
                    : scarp_occluded_batch(scene(), maybe(rays.data()), start, maybe(blocked.data()), count);
  }
  scarp_status arrays() {
    for (float& value : floats_) value = static_cast<float>(number() / 1e280 * 1e280);
    scarp_ray_arrays rays{};
    rays.struct_size = size(sizeof rays);
    rays.origin_x = maybe(floats_.data()), rays.origin_y = floats_.data() + 8, rays.origin_z = floats_.data() + 16;
    rays.direction_x = floats_.data() + 24, rays.direction_y = floats_.data() + 32;
    rays.direction_z = maybe(floats_.data() + 40);
    std::array<float, 5 * kRays> out;
    scarp_hit_arrays to{};
    to.struct_size = sizeof to;
    to.t = maybe(out.data()), to.u = out.data() + 8;
    to.normal_x = out.data() + 16, to.normal_y = out.data() + 24, to.normal_z = maybe(out.data() + 32);
    return scarp_cast_arrays(scene(), given(rays), maybe(&to), static_cast<std::size_t>(below(kRays + 1)));
  }
  scarp_status fan() {
    std::array<float, 8 * 8> t;
    std::array<std::int32_t, 8 * 8> col;
    scarp_fan_answers to{};
    to.struct_size = sizeof to;
    to.t = t.data(), to.col = col.data();
    const auto side = [&] { return below(20) == 0 ? -1 : below(9); };
    if (below(2)) {
      scarp_camera camera{};
      camera.struct_size = size(sizeof camera);
      for (double& value : camera.eye) value = number();
      for (double& value : camera.forward) value = number();
      if (below(4) == 0) camera.up[below(3)] = number();
      camera.tan_half_width = number(), camera.columns = side(), camera.rows = side();
      camera.t_max = below(2) ? number() : 0;
      return scarp_cast_camera(scene(), given(camera), maybe(&to));
    }
    scarp_fan fan{};
    fan.struct_size = size(sizeof fan);
    for (double& value : fan.eye) value = number();
    fan.dx = maybe(floats_.data()), fan.dy = floats_.data(), fan.dz = maybe(floats_.data());
    fan.columns = std::min(side(), 6), fan.rows = side();
    fan.t_max = below(2) ? number() : 0;
    return scarp_cast_fan(scene(), given(fan), maybe(&to));
  }
  scarp_status contact() {
    const double a[3] = {number(), number(), number()}, b[3] = {number(), number(), number()};
    const double motion[3] = {number(), number(), number()};
    const auto mask = static_cast<std::uint32_t>(below(4));
    scarp_contact found;
    std::uint8_t overlaps;
    switch (below(3)) {
      case 0:
        return scarp_sweep(scene(), maybe(a), below(2) ? a : b, number(), maybe(motion), mask, maybe(&found));
      case 1:
        return scarp_overlaps(scene(), maybe(a), maybe(b), nullptr, mask, maybe(&overlaps));
      default:
        return scarp_closest_point(scene(), maybe(a), number(), mask, maybe(&found));
    }
  }
  scarp_status open() {
    scarp_scene* opened = nullptr;
    scarp_status status;
    if (below(2)) {
      scarp_heights heights{};
      heights.struct_size = size(sizeof heights);
      heights.samples = maybe(reinterpret_cast<const char*>(samples_.data()) + (rarely() ? 1 : 0));
      heights.cols = 1 + below(kSide), heights.rows = rarely() ? -1 : below(kSide);
      heights.row_stride = rarely() ? below(kSide) : 0;
      heights.type = below(4), heights.surface = below(3), heights.wrap = below(4), heights.solid = below(2);
      heights.cell_x = below(2) ? number() : 0, heights.exaggeration = below(4) ? 0 : number();
      heights.nodata = number(), heights.has_nodata = below(2);
      status = scarp_heights_view(given(heights), &opened);
    } else {
      scarp_voxels voxels{};
      voxels.struct_size = size(sizeof voxels);
      voxels.indices = maybe(voxels_.data());
      for (std::int32_t& side : voxels.size) side = rarely() ? below(2) * 20000 : 1 + below(5);
      // The caller's array must have as many bytes as it says.
      for (const std::int32_t side : voxels.size) voxels.indices = side > 5 && side <= 16384 ? nullptr : voxels.indices;
      voxels.side = below(2) ? number() : 0;
      status = scarp_voxels_copy(given(voxels), &opened);
    }
    return keep(status, opened), status;
  }
  scarp_status tiles() {
    if (below(3) == 0) {
      scarp_scene* opened = nullptr;
      const scarp_status status = scarp_tiles_read(maybe(tiles_), &opened);
      return keep(status, opened), status;
    }
    // Views of samples_ outlive their tiles.
    const scarp_tile_change changes[2] = {{below(3), below(2), below(2) ? scene() : nullptr},
                                          {integer(), integer(), below(2) ? scene() : nullptr}};
    return scarp_tiles_edit(maybe(tiles_), maybe(changes), static_cast<std::size_t>(below(3)));
  }
  scarp_status live() {
    if (below(2)) {
      return scarp_live_read(
          maybe(live_),
          [](const scarp_scene* scene, void* user_data) {
            auto& self = *static_cast<Hostile*>(user_data);
            const scarp_ray own = self.ray();
            const scarp_hit from = self.hit();
            scarp_hit found;
            scarp_cast(scene, &own, self.below(2) ? &from : nullptr, &found);
          },
          this);
    }
    return scarp_live_edit(
        maybe(live_),
        [](scarp_editor* editor, void* user_data) {
          auto& self = *static_cast<Hostile*>(user_data);
          const scarp_part part = self.part();
          std::uint32_t object = 0;
          scarp_editor_add(editor, self.maybe(&part), self.maybe(&object));
          scarp_editor_move(editor, static_cast<std::uint32_t>(self.integer()), &part);
          scarp_editor_remove(editor, static_cast<std::uint32_t>(self.below(3)));
        },
        this);
  }

  Bits bits_;
  std::vector<float> samples_ = std::vector<float>(kSide * kSide + 1);
  std::array<std::uint8_t, 5 * 5 * 5> voxels_{};
  std::array<float, 6 * kRays> floats_{};
  std::array<scarp_hit, kRays> hits_{};
  alignas(std::max_align_t) std::array<unsigned char, 4096> room_{};
  std::array<scarp_scene*, 8> open_{};
  scarp_tiles* tiles_ = nullptr;
  scarp_live* live_ = nullptr;
  scarp_hit last_{};
};

}  // namespace scarp::test
