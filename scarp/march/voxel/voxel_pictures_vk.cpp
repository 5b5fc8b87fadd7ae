// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_pictures_vk.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/matrix.hpp>
#include <map>
#include <optional>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/ray_runs_vk.h"
#include "scarp/march/voxel/voxel_proxies.glsl.h"
#include "scarp/march/voxel/voxel_ray_vk.h"
#include "scarp/vk/loop_turns.glsl.h"
#include "scarp/vk/raster.h"

namespace scarp {
namespace {

constexpr std::uint32_t kVertexWords[] = {
#include "scarp/march/voxel/voxel_proxies.vert.inc"
};
constexpr std::uint32_t kFragmentWords[] = {
#include "scarp/march/voxel/voxel_proxies.frag.inc"
};
constexpr std::uint32_t kFragmentOfWordsWords[] = {
#include "scarp/march/voxel/voxel_proxies_words.frag.inc"
};
constexpr std::uint32_t kHitsWords[] = {
#include "scarp/march/voxel/voxel_proxies.comp.inc"
};

constexpr std::uint32_t kPictureThreads = 64;  // of a workgroup
constexpr std::uint32_t kRowOfGroups = 1024;   // a dispatch has at most 65,535 workgroups along one side
constexpr std::uint32_t kCorners = 36;         // vertices of a box
constexpr std::int64_t kPixelsPerPiece = 4096;
constexpr double kRoomOfVoxel = 0x1p-14;  // as in voxel_proxies.vert

dvec3 row_of(const glm::dmat3& m, int i) { return {m[0][i], m[1][i], m[2][i]}; }

glsl::ScarpVoxelView view_of(const VoxelPicture& picture) {
  const bool parallel = picture.parallel();
  const dvec3 &right = parallel ? picture.origin_right : picture.right,
              &down = parallel ? picture.origin_down : picture.down;
  const glm::dmat3 world(right, down, picture.direction);
  const double volume = determinant(world);
  if (!std::isfinite(volume) || volume == 0 ||
      (parallel && (picture.right != dvec3(0.0) || picture.down != dvec3(0.0))))
    throw Error("voxels: a picture whose rays do not span space");
  // Maps positions to pixels and to t in the form of VoxelPicture, whose rays are not normalised.
  const glm::dmat3 pixels = inverse(world);
  const dvec3 t = row_of(pixels, 2), w = parallel ? dvec3(0.0) : t;
  glsl::ScarpVoxelView view{};
  view.origin = picture.origin;
  view.x = row_of(pixels, 0) * (2.0 / picture.width) - w;
  view.y = row_of(pixels, 1) * (2.0 / picture.height) - w;
  view.w = w;
  view.depth = t;
  view.direction = picture.direction;
  // A ball of this radius reaches a pixel in all directions.
  view.margin = std::sqrt(dot(right, right) + dot(down, down));
  view.parallel = parallel;
  return view;
}

// Device memory of a picture's pixels.
struct PictureMemory {
  PictureMemory(const Device& device, std::uint32_t width, std::uint32_t height)
      : target(device, width, height, 2, RasterColours::words),
        rays(device, pixels() * sizeof(glsl::ScarpVoxelRay), "rays of a picture"),
        first(device, pixels() * sizeof(glsl::uvec4), "pixels of a picture"),
        second(device, pixels() * sizeof(glsl::uvec4), "pixels of a picture"),
        hits(device, pixels() * sizeof(glsl::ScarpVoxelHit), "hits of a picture") {}

  std::uint64_t pixels() const { return std::uint64_t{target.width()} * target.height(); }
  std::uint64_t bytes() const {
    // Two colours and a depth.
    return pixels() * (2 * sizeof(glsl::uvec4) + 4) + rays.bytes() + first.bytes() + second.bytes() + hits.bytes();
  }

  RasterTarget target;
  DeviceBuffer rays, first, second, hits;
};

ShaderProgram fragments_of(std::uint32_t march, bool words, bool int64, bool entries) {
  return {int64 ? "scarp/march/voxel/voxel_proxies.frag" : "scarp/march/voxel/voxel_proxies_words.frag",
          march == glsl::kScarpVoxelMarches ? "several" : std::string(voxel_march_name(march)),
          int64 ? std::span<const std::uint32_t>(kFragmentWords) : kFragmentOfWordsWords,
          sizeof(glsl::VoxelProxies),
          {march, words, entries},
          kVertexWords,
          2};
}
ShaderProgram hits_of(std::uint32_t levels) {
  return {
      "scarp/march/voxel/voxel_proxies.comp", "", kHitsWords, sizeof(glsl::VoxelProxies), {kPictureThreads, levels}};
}

}  // namespace

struct DeviceVoxelPictures::Impl {
  Impl(const Device& device_, std::shared_ptr<DeviceVoxelQueries> queries_, bool words_)
      : device(device_),
        queries(std::move(queries_)),
        words(words_),
        view(device_, sizeof(glsl::ScarpVoxelView), "view of a picture") {}

  // Specialised on first use.
  const RasterPipeline& boxes(std::uint32_t march, bool entries) {
    const ShaderProgram program = fragments_of(march, words, device.description().abilities.int64, entries);
    const auto made = box_pipelines.find(program.constants);
    if (made != box_pipelines.end()) return made->second;
    const RasterSettings settings{
        .push_bytes = program.push_bytes, .colours = program.colours, .of = RasterColours::words};
    return box_pipelines
        .try_emplace(program.constants, device, program.vertex, program.spirv, "boxes " + program.variant, settings,
                     program.constants)
        .first->second;
  }
  const ComputePipeline& hits(std::uint32_t levels) {
    const auto made = hit_pipelines.find(levels);
    if (made != hit_pipelines.end()) return made->second;
    return hit_pipelines.try_emplace(levels, device, hits_of(levels), "hits of boxes").first->second;
  }

  void draw(const DeviceVoxelObjects& objects, const VoxelPicture& picture, bool entries) {
    if (!memory || memory->target.width() != picture.width || memory->target.height() != picture.height) {
      memory.reset();
      memory.emplace(device, picture.width, picture.height);
    }
    const glsl::ScarpVoxelView at = view_of(picture);
    upload(view, 0, &at, sizeof at);
    upload(memory->rays, 0, rays.data(), memory->rays.bytes());
    const glsl::VoxelProxies push{objects.address(),
                                  memory->rays.address(),
                                  view.address(),
                                  memory->first.address(),
                                  memory->second.address(),
                                  memory->hits.address(),
                                  picture.width,
                                  static_cast<glsl::uint>(memory->pixels()),
                                  glsl::kScarpLoopTurns,
                                  static_cast<float>(objects.voxel_side() * kRoomOfVoxel)};
    commands.draw(memory->target, {draw_call(boxes(objects.march(), entries), push, kCorners, objects.count())});
    commands.copy(memory->target, 0, memory->first);
    commands.copy(memory->target, 1, memory->second);
    commands.barrier();
    const std::uint32_t groups = (push.count + kPictureThreads - 1) / kPictureThreads,
                        row = std::min(groups, kRowOfGroups);
    commands.dispatch(hits(std::bit_ceil(objects.levels())), push, {row, (groups + row - 1) / row, 1});
    commands.run();
    found.resize(rays.size());
    download(memory->hits, 0, found.data(), memory->hits.bytes());
    passes = commands.passes();
  }

  Device device;
  std::shared_ptr<DeviceVoxelQueries> queries;
  bool words;
  DeviceBuffer view;
  std::map<std::vector<std::uint32_t>, RasterPipeline> box_pipelines;  // by specialisation
  std::map<std::uint32_t, ComputePipeline> hit_pipelines;              // by levels
  std::optional<PictureMemory> memory;
  Commands commands{device};  // declared after what its runs use: it waits for them
  std::vector<glsl::ScarpVoxelRay> rays;
  std::vector<glsl::ScarpVoxelHit> found;
  std::vector<PassTime> passes;
  std::size_t tied = 0;
};

DeviceVoxelPictures::DeviceVoxelPictures(const Device& device, std::shared_ptr<DeviceVoxelQueries> queries, bool words)
    : impl_(std::make_unique<Impl>(device, std::move(queries), words)) {}
DeviceVoxelPictures::DeviceVoxelPictures(DeviceVoxelPictures&&) noexcept = default;
DeviceVoxelPictures& DeviceVoxelPictures::operator=(DeviceVoxelPictures&&) noexcept = default;
DeviceVoxelPictures::~DeviceVoxelPictures() = default;

std::vector<std::size_t> DeviceVoxelPictures::draw(const DeviceVoxelObjects& objects, const VoxelPicture& picture,
                                                   std::span<const Ray> rays, std::span<Hit> hits,
                                                   const DeviceVoxelDetails& details) {
  const std::size_t pixels = std::size_t{picture.width} * picture.height;
  require_room(rays.size(), hits.size(), 0);
  require_room(pixels, rays.size(), details.steps.size());
  require_room(pixels, rays.size(), details.entries.size());
  Impl& all = *impl_;
  all.rays.resize(pixels);
  std::vector<std::uint8_t> left(pixels);
  parallel_for(static_cast<std::int64_t>(pixels), kPixelsPerPiece, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      const PreparedVoxelRay prepared = prepared_voxel_ray(rays[i], nullptr);
      all.rays[i] = prepared.ray;
      if (prepared.marches && prepared.exponent == 0) continue;
      // An empty range: hits nothing.
      left[i] = 1;
      all.rays[i] = {dvec3(0.0), dvec3(1.0), 1, 0, glsl::kScarpNoPart, {}, 0, 0};
    }
  });
  all.draw(objects, picture, !details.entries.empty());
  std::vector<std::size_t> again, none;
  std::vector<Ray> asked;
  for (std::size_t i = 0; i < pixels; ++i) {
    const glsl::ScarpVoxelHit& found = all.found[i];
    hits[i] = hit_of(found, found.t);
    if (!details.steps.empty()) details.steps[i] = found.steps;
    if (!details.entries.empty()) details.entries[i] = found.entry;
    if (found.status == glsl::kScarpVoxelTied) {
      again.push_back(i);
      asked.push_back(rays[i]);
    } else if (left[i] || found.status == glsl::kScarpVoxelUnfinished) {
      none.push_back(i);
    }
  }
  all.tied = again.size();
  if (again.empty()) return none;
  std::vector<Hit> answers(again.size());
  std::vector<std::uint32_t> steps(details.steps.empty() ? 0 : again.size()),
      entries(details.entries.empty() ? 0 : again.size());
  for (const std::size_t i : all.queries->closest_hits(objects, asked, {}, answers, {steps, entries}))
    none.push_back(again[i]);
  for (std::size_t i = 0; i < again.size(); ++i) {
    hits[again[i]] = answers[i];
    if (!steps.empty()) details.steps[again[i]] = steps[i];
    if (!entries.empty()) details.entries[again[i]] = entries[i];
  }
  const std::vector<PassTime>& more = all.queries->passes();
  all.passes.insert(all.passes.end(), more.begin(), more.end());
  return none;
}

std::size_t DeviceVoxelPictures::tied() const { return impl_->tied; }
const std::vector<PassTime>& DeviceVoxelPictures::passes() const { return impl_->passes; }
std::uint64_t DeviceVoxelPictures::bytes() const { return impl_->memory ? impl_->memory->bytes() : 0; }

std::vector<ShaderProgram> voxel_picture_shaders() {
  std::vector<ShaderProgram> all{hits_of(16)};
  for (std::uint32_t march = 0; march <= glsl::kScarpVoxelMarches; ++march)
    all.push_back(fragments_of(march, false, true, false));
  for (std::uint32_t march = 0; march < glsl::kScarpVoxelMarches; ++march)
    all.push_back(fragments_of(march, true, false, false));
  return all;
}

}  // namespace scarp
