// SPDX-License-Identifier: MIT
#include "scarp/render/look/step_look.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace scarp {
namespace {

// The words for all fields of a scene, each once. Fields whose word is empty have no march.
template <class WordOf>
std::string words_for(const Scene& scene, const WordOf& word_of) {
  std::vector<std::string_view> words;
  std::string all;
  for (const SceneFieldPtr& field : scene.fields()) {
    const std::string_view word = word_of(*field);
    if (word.empty() || std::find(words.begin(), words.end(), word) != words.end()) continue;
    all += (words.empty() ? "" : ", ") + std::string(word);
    words.push_back(word);
  }
  return all;
}

// Null for fields of another kind, and for those whose march has no back end (SceneField::parts()).
const HeightMarchEntry* height_march_of(const SceneField& field) {
  const SceneFieldParts parts = field.parts();
  const auto* heights = std::get_if<SceneFieldParts::Heights>(&parts.of);
  return heights ? heights->march : nullptr;
}

std::string_view steps_in(const SceneField& field) {
  const std::string_view kind = field.kind();
  if (kind == "heights" || kind == "function") {
    if (field.sampling() != Sampling::none) return "samples";
    if (kind == "function") return "bounds";
    const HeightMarchEntry* march = height_march_of(field);
    return march && !march->needs_pyramid ? "cells" : "blocks and cells";
  }
  return kind == "tiles"    ? "blocks and cells"
         : kind == "shape"  ? "distances"
         : kind == "voxels" ? "voxels"
         : kind == "mesh"   ? "triangles"
                            : "";
}

std::string_view reads_in(const SceneField& field) {
  const std::string_view kind = field.kind();
  if (kind == "heights") return steps_in(field) == "blocks and cells" ? "heights and blocks" : "heights";
  return kind == "function" || kind == "shape" ? "evaluations"
         : kind == "voxels"                    ? "voxels"
         : kind == "mesh"                      ? "triangles"
                                               : "";
}

}  // namespace

StepRange range_of_steps(std::span<const std::uint32_t> steps, const std::optional<StepScale>& scale, std::string of) {
  const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
  const double sum = std::accumulate(steps.begin(), steps.end(), 0.0);
  return {*least, *most, sum / static_cast<double>(steps.size()),
          scale.value_or(StepScale{static_cast<double>(*least), static_cast<double>(*most)}), std::move(of)};
}

Image image_of_steps(ImageSize size, std::span<const std::uint32_t> steps, const Ramp& ramp) {
  Image image(size.width, size.height);
  const auto width = static_cast<std::size_t>(size.width);
  for (std::size_t i = 0; i < steps.size(); ++i)
    set_pixel(image, static_cast<int>(i % width), static_cast<int>(i / width), ramp(steps[i]));
  return image;
}

std::string steps_of(const Scene& scene) { return words_for(scene, steps_in); }
std::string reads_of(const Scene& scene) { return words_for(scene, reads_in); }

}  // namespace scarp
