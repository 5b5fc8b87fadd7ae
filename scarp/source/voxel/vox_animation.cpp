// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/vox_animation.h"

#include <algorithm>
#include <optional>

#include "scarp/source/voxel/vox_bytes.h"

namespace scarp {
namespace {

std::int64_t frame_of(const VoxAttributes& attributes) {
  const auto text = find_attribute(attributes, "_f");
  return text ? whole_number(*text, "frame") : 0;
}

// Maps any frame to the frame of the loop, first..last, that is shown.
std::int64_t looped(std::int64_t frame, std::int64_t first, std::int64_t last) {
  const std::int64_t length = last - first + 1, turn = (frame - first) % length;
  return first + (turn < 0 ? turn + length : turn);
}

}  // namespace

std::vector<std::int64_t> vox_keyframes(const VoxNode& node) {
  std::vector<std::int64_t> frames;
  if (const auto* transform = std::get_if<VoxTransform>(&node.content)) {
    for (const VoxAttributes& attributes : transform->frames) frames.push_back(frame_of(attributes));
  } else if (const auto* shape = std::get_if<VoxShape>(&node.content)) {
    for (const VoxModelUse& use : shape->models) frames.push_back(frame_of(use.attributes));
  }
  return frames;
}

VoxMoment vox_moment(std::span<const std::int64_t> keyframes, bool loop, std::int64_t frame) {
  const auto [first, last] = std::minmax_element(keyframes.begin(), keyframes.end());
  frame = loop ? looped(frame, *first, *last) : std::clamp(frame, *first, *last);
  std::optional<std::size_t> before, after;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (keyframes[i] <= frame) {
      if (!before || keyframes[i] >= keyframes[*before]) before = i;
    } else if (!after || keyframes[i] <= keyframes[*after]) {
      after = i;
    }
  }
  if (!after) return {*before, *before};
  return {*before, *after, frame - keyframes[*before], keyframes[*after] - keyframes[*before]};
}

bool vox_loops(const VoxNode& node) { return find_attribute(node.attributes, "_loop") == "1"; }

VoxAnimation vox_animation(const VoxFile& file) {
  VoxAnimation animation;
  if (file.nodes.empty()) {
    if (!file.pack || file.models.size() < 2) return animation;
    return {static_cast<std::int64_t>(file.models.size()), false, true};
  }
  for (const VoxNode& node : file.nodes) {
    const std::vector<std::int64_t> frames = vox_keyframes(node);
    if (frames.size() < 2) continue;
    animation.frames = std::max(animation.frames, 1 + *std::max_element(frames.begin(), frames.end()));
    (vox_loops(node) ? animation.loops : animation.ends) = true;
  }
  return animation;
}

}  // namespace scarp
