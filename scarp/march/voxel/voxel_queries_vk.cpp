// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_queries_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/march/ray_runs_vk.h"
#include "scarp/march/voxel/voxel_batch.glsl.h"
#include "scarp/march/voxel/voxel_ray_vk.h"
#include "scarp/vk/loop_turns.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kMarchesWords[] = {
#include "scarp/march/voxel/voxel_marches.comp.inc"
};
constexpr std::uint32_t kMarchesWordsWords[] = {
#include "scarp/march/voxel/voxel_marches_words.comp.inc"
};

struct VoxelRays {
  using Prepared = PreparedVoxelRay;
  using Ray = glsl::ScarpVoxelRay;
  using Hit = glsl::ScarpVoxelHit;
  static Hit none() { return {}; }
  static void add(const Hit& answered, Hit& hit) { hit = answered; }
  static bool under_way(const Hit&) { return false; }
  static void go_on(Ray&, const Hit&) {}
};

ShaderProgram program_of(bool any, std::uint32_t march, std::uint32_t levels, bool words, bool int64, bool entries) {
  const bool mixed = march == glsl::kScarpVoxelMarches;
  return {int64 ? "scarp/march/voxel/voxel_marches.comp" : "scarp/march/voxel/voxel_marches_words.comp",
          fmt::format("{}{}", mixed ? "several" : voxel_march_name(march), any ? " any" : ""),
          int64 ? std::span<const std::uint32_t>(kMarchesWords) : kMarchesWordsWords,
          sizeof(glsl::VoxelBatch),
          {RayRuns<VoxelRays>::kThreads, any, march, levels, words, entries}};
}

void require_doubles(const Device& device) {
  if (device.description().abilities.float64) return;
  throw Error(
      fmt::format("voxels: device '{}' has no 64-bit floating point numbers (shaderFloat64), in which rays are "
                  "quantised: use the CPU",
                  device.description().name));
}

std::uint32_t march_of_all(const DeviceVoxels& grids, std::span<const glsl::ScarpVoxelObject> objects) {
  std::uint32_t march = glsl::kScarpVoxelMarches;
  for (const glsl::ScarpVoxelObject& object : objects) {
    const std::uint32_t own = grids.layout()[object.grid].march;
    if (&object != &objects.front() && own != march) return glsl::kScarpVoxelMarches;
    march = own;
  }
  return march;
}

// Buffers must not be empty.
template <class T>
DeviceBuffer filled(const Device& device, std::span<const T> from, const std::string& name) {
  DeviceBuffer buffer(device, std::max<std::size_t>(from.size_bytes(), sizeof(T)), name);
  if (!from.empty()) upload(buffer, 0, from.data(), from.size_bytes());
  return buffer;
}

constexpr std::size_t kMaxNodes = std::size_t{1} << 28;  // a word of the stack holds a node and four bits

constexpr glsl::ScarpVoxelTurn kNoTurn{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0, 1, {}};

// One box around a grid. Its sides are integers, which are exact in float; half a voxel exceeds the rounding errors.
glsl::ScarpBoxNode node_around(const glsl::ScarpVoxelGrid& grid) {
  constexpr float kRoom = 0.5f;
  glsl::ScarpBoxNode node;
  constexpr float kEndless = std::numeric_limits<float>::infinity();
  node.low_x = node.low_y = node.low_z = glsl::vec4(kEndless);  // the others are empty
  node.high_x = node.high_y = node.high_z = glsl::vec4(-kEndless);
  node.low_x.x = static_cast<float>(grid.low.x) - kRoom;
  node.low_y.x = static_cast<float>(grid.low.y) - kRoom;
  node.low_z.x = static_cast<float>(grid.low.z) - kRoom;
  node.high_x.x = static_cast<float>(grid.high.x) + kRoom;
  node.high_y.x = static_cast<float>(grid.high.y) + kRoom;
  node.high_z.x = static_cast<float>(grid.high.z) + kRoom;
  node.child = glsl::uvec4(glsl::kScarpBoxLeaf);
  return node;
}

}  // namespace

DeviceVoxelObjects::DeviceVoxelObjects(const Device& device, const DeviceVoxels& grids,
                                       std::span<const glsl::ScarpVoxelObject> objects,
                                       std::span<const glsl::ScarpVoxelTurn> turns, const DeviceBoxes& boxes)
    : march_(march_of_all(grids, objects)),
      levels_(boxes.levels),
      count_(static_cast<std::uint32_t>(objects.size())),
      objects_(filled(device, objects, "voxel objects")),
      turns_(filled(device, turns, "turns of voxel objects")),
      nodes_(filled(device, boxes.nodes, "boxes of voxel objects")),
      header_(device, sizeof(glsl::ScarpVoxelObjects), "the voxel objects' layout") {
  require_doubles(device);
  if (boxes.levels > DeviceBoxes::kMaxLevels || boxes.nodes.size() >= kMaxNodes)
    throw Error(fmt::format("voxels: a hierarchy of {} boxes on {} levels (devices take {} and {}): use the CPU",
                            boxes.nodes.size(), boxes.levels, kMaxNodes, DeviceBoxes::kMaxLevels));
  for (const glsl::ScarpVoxelObject& object : objects) {
    const glsl::ScarpVoxelTurn& turn = turns[object.turn];
    voxel_side_ = std::max(voxel_side_, 1 / length(turn.rows[0]));
    if (are_numbers_of_devices(object.origin) && are_numbers_of_devices(turn.rows[0]) &&
        are_numbers_of_devices(turn.rows[1]) && are_numbers_of_devices(turn.rows[2]))
      continue;
    throw Error(
        fmt::format("voxels: object {}: its place has numbers beyond 2^-200 or 2^200: use the CPU", object.part));
  }
  const glsl::ScarpVoxelObjects header{grids.address(), objects_.address(), turns_.address(), nodes_.address(),
                                       boxes.middle,    boxes.low,          boxes.high};
  upload(header_, 0, &header, sizeof header);
}

DeviceVoxelObjects::DeviceVoxelObjects(const Device& device, const DeviceVoxels& grids, std::uint32_t grid)
    : DeviceVoxelObjects(device, grids, std::array{glsl::ScarpVoxelObject{dvec3(0.0), grid, 0, 0, 0}},
                         std::array{kNoTurn},
                         {std::array{node_around(grids.layout()[grid])}, dvec3(0.0),
                          dvec3(grids.layout()[grid].low) - 1.0, dvec3(grids.layout()[grid].high) + 1.0, 1}) {}

struct DeviceVoxelQueries::Impl {
  Impl(const Device& device_, const DeviceVoxelSettings& settings_)
      : device(device_),
        settings(settings_),
        runs(device_, settings_.rays_at_once),
        scratch(device_, std::uint64_t{settings_.rays_at_once} * sizeof(glsl::ScarpVoxelScratch), "scratch of rays") {}

  // Specialised on first use.
  const ComputePipeline& pipeline(const DeviceVoxelObjects& objects, bool any, bool entries) {
    const bool int64 = device.description().abilities.int64;
    const ShaderProgram program =
        program_of(any, objects.march(), std::bit_ceil(objects.levels()), settings.words, int64, entries);
    const auto made = pipelines.find(program.constants);
    if (made != pipelines.end()) return made->second;
    return pipelines.try_emplace(program.constants, device, program, program.variant).first->second;
  }

  // Calls answer(i, hit, t) for each finished ray. Returns the others.
  template <class Answer>
  std::vector<std::size_t> ask(const DeviceVoxelObjects& objects, bool any, bool entries, std::span<const Ray> asked,
                               std::span<const Hit* const> from, const Answer& answer) {
    glsl::VoxelBatch batch{};
    batch.objects = objects.address();
    batch.scratch = scratch.address();
    batch.turns = glsl::kScarpLoopTurns;
    std::vector<std::uint8_t> left(asked.size());
    runs.ask(
        pipeline(objects, any, entries), batch, asked.size(),
        [&](std::size_t i) { return prepared_voxel_ray(asked[i], from.empty() ? nullptr : from[i]); },
        [&](std::size_t i, const VoxelRays::Prepared& prepared, const glsl::ScarpVoxelHit& hit) {
          left[i] = prepared.left || hit.status == glsl::kScarpVoxelUnfinished;
          answer(i, hit, std::ldexp(hit.t, -prepared.exponent));
        });
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (left[i]) indices.push_back(i);
    }
    return indices;
  }

  Device device;
  DeviceVoxelSettings settings;
  RayRuns<VoxelRays> runs;
  DeviceBuffer scratch;
  std::map<std::vector<std::uint32_t>, ComputePipeline> pipelines;  // by specialisation
};

DeviceVoxelQueries::DeviceVoxelQueries(const Device& device, const DeviceVoxelSettings& settings) {
  require_doubles(device);
  impl_ = std::make_unique<Impl>(device, settings);
}
DeviceVoxelQueries::DeviceVoxelQueries(DeviceVoxelQueries&&) noexcept = default;
DeviceVoxelQueries& DeviceVoxelQueries::operator=(DeviceVoxelQueries&&) noexcept = default;
DeviceVoxelQueries::~DeviceVoxelQueries() = default;

std::vector<std::size_t> DeviceVoxelQueries::closest_hits(const DeviceVoxelObjects& objects, std::span<const Ray> rays,
                                                          std::span<const Hit* const> from, std::span<Hit> hits,
                                                          const DeviceVoxelDetails& details) {
  require_room(rays.size(), hits.size(), from.size());
  require_room(rays.size(), rays.size(), details.steps.size());
  require_room(rays.size(), rays.size(), details.entries.size());
  return impl_->ask(objects, false, !details.entries.empty(), rays, from,
                    [&](std::size_t i, const glsl::ScarpVoxelHit& found, double t) {
                      hits[i] = hit_of(found, t);
                      if (!details.steps.empty()) details.steps[i] = found.steps;
                      if (!details.entries.empty()) details.entries[i] = found.entry;
                    });
}

std::vector<std::size_t> DeviceVoxelQueries::occluded(const DeviceVoxelObjects& objects, std::span<const Ray> rays,
                                                      std::span<const Hit* const> from,
                                                      std::span<std::uint8_t> blocked) {
  require_room(rays.size(), blocked.size(), from.size());
  return impl_->ask(objects, true, false, rays, from, [&](std::size_t i, const glsl::ScarpVoxelHit& found, double) {
    blocked[i] = found.status == glsl::kScarpVoxelHit;
  });
}

const std::vector<PassTime>& DeviceVoxelQueries::passes() const { return impl_->runs.passes(); }

std::vector<ShaderProgram> voxel_query_shaders() {
  constexpr std::uint32_t kLevels = 16;
  std::vector<ShaderProgram> all;
  for (const bool any : {false, true}) {
    for (std::uint32_t march = 0; march <= glsl::kScarpVoxelMarches; ++march)
      all.push_back(program_of(any, march, kLevels, false, true, false));
  }
  for (std::uint32_t march = 0; march < glsl::kScarpVoxelMarches; ++march)
    all.push_back(program_of(false, march, kLevels, true, false, false));
  return all;
}

}  // namespace scarp
