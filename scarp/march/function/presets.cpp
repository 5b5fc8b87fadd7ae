// SPDX-License-Identifier: MIT
#include "scarp/march/function/presets.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// No minimum step: `naive` requires one above 0.
constexpr double kNoLeastStep = 0x1p-40;

MarchPreset elevated() {
  MarchPreset p{"elevated",
                "relaxed",
                {},
                "t += 0.4 h, stops at |h| < 0.0015 t, 300 steps",
                "the clipping plane: here the certified range of heights",
                "I. Quilez, \"Elevated\", 2009; the founding text on height-field ray casting has the same"};
  p.settings.relaxed = {.step_factor = 0.4, .tolerance = 0.0015, .max_steps = 300};
  return p;
}

MarchPreset rainforest() {
  MarchPreset p{"rainforest",
                "naive",
                {},
                "t += 0.8 h, stops at h < 0.001 t, 400 steps, secant through the last two samples",
                "steps of 0.2 h at cliffs, which only its own terrain knows",
                "I. Quilez, \"Rainforest\", 2016"};
  p.settings.naive = {.step_factor = 0.8, .min_step = kNoLeastStep, .tolerance = 0.001, .max_steps = 400};
  p.settings.sampling.refinement = Refinement::secant;
  return p;
}

MarchPreset iq2002() {
  MarchPreset p{"iq2002",
                "fixed-step",
                {},
                "steps of 0.01 units (1 unit: 1000 m), stops at h < 0, interpolates the last two samples",
                "the far plane at 10 units: here the ray's end; its second form, whose steps grow with t, is "
                "--function-step-share 0.01",
                "I. Quilez, \"Terrain raymarching\", 2002"};
  p.settings.fixed_step.interpolate = true;
  p.settings.function.step = 10;
  return p;
}

MarchPreset snowy() {
  MarchPreset p{"snowy",
                "naive",
                {},
                "t += 0.6 h, stops at h < 0, 64 steps",
                "the step limit: sky there, a separate status here",
                "A. Alekseev (TDM), \"Snowy\""};
  p.settings.naive = {.step_factor = 0.6, .min_step = kNoLeastStep, .tolerance = 0, .max_steps = 64};
  return p;
}

MarchPreset castle() {
  MarchPreset p{
      "castle", "naive", {}, "t += h, stops at h < 0.001 units (1 unit: 1 m), 1000 steps", "", "the shader \"Castle\""};
  p.settings.naive = {.step_factor = 1, .min_step = kNoLeastStep, .tolerance = 0, .max_steps = 1000};
  p.settings.sampling.tolerance = 0.001;
  return p;
}

}  // namespace

std::span<const MarchPreset> march_presets() {
  static const std::array presets = {elevated(), rainforest(), iq2002(), snowy(), castle()};
  return presets;
}

const MarchPreset& find_march_preset(std::string_view name) {
  std::string names;
  for (const MarchPreset& preset : march_presets()) {
    if (preset.name == name) return preset;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", preset.name);
  }
  throw Error(fmt::format("preset '{}': unknown (available: {})", name, names));
}

}  // namespace scarp
