// SPDX-License-Identifier: MIT
#include "scarp/march/marches.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "scarp/base/error.h"
#include "scarp/march/exhaustive.h"
#include "scarp/march/lipschitz.h"
#include "scarp/march/max_mip.h"
#include "scarp/march/max_mip_simd.h"
#include "scarp/march/naive.h"
#include "scarp/march/relaxed.h"

namespace scarp {
namespace {

constexpr std::array kMarches = {
    MarchEntry{"exhaustive", "height field", Guarantee::exact, false, false, march_exhaustive, nullptr, nullptr,
               nullptr, false, "", "every cell under the ray on its own, in double: the judge of the others, slow"},
    MarchEntry{"naive", "height field", Guarantee::approximate, false, false, march_naive, nullptr, nullptr, nullptr,
               false, "step factor 0.7, least step 1/512 of the way out, tolerance 0.001 of the distance, 1024 steps",
               "steps by the vertical distance to the ground; steps over steep ground"},
    MarchEntry{"relaxed", "height field", Guarantee::approximate, false, false, march_relaxed, nullptr, nullptr,
               nullptr, false, "step factor 0.4, tolerance 0.0015 of the distance, 300 steps",
               "the shader writers' t += 0.4 h: closes in on calm ground, steps through steep ground"},
    MarchEntry{"lipschitz", "height field", Guarantee::conservative, true, true, march_lipschitz, nullptr, nullptr,
               nullptr, false,
               "shrink factor 1/sqrt(1 + c^2), c the slope bound, tolerance 0.0005 of the distance, 1024 steps",
               "steps by a distance that the steepest slope allows; never passes, slow near steep ground"},
    MarchEntry{"max-mip", "height field", Guarantee::exact, true, false, march_max_mip, occluded_max_mip,
               closest_hits_max_mip_simd, occluded_max_mip_simd, false, "",
               "hierarchical walk through a maximum mipmap, closed form in the bilinear cell"},
    MarchEntry{"max-mip-bisect", "height field", Guarantee::approximate, true, false, march_max_mip_bisect, nullptr,
               nullptr, nullptr, false, "16 halvings",
               "the same walk with the paper's binary search in the cell; passes rays that dip into a cell"},
};

void require(bool good, std::string_view name, double value, std::string_view range) {
  if (!good) throw Error(fmt::format("march setting {}: is {}; it must be {}", name, value, range));
}

bool positive(double x) { return std::isfinite(x) && x > 0; }

}  // namespace

std::string_view name_of(Guarantee guarantee) {
  switch (guarantee) {
    case Guarantee::exact:
      return "exact";
    case Guarantee::conservative:
      return "conservative";
    case Guarantee::approximate:
      break;
  }
  return "approximate";
}

void validate(const MarchSettings& settings) {
  const auto& naive = settings.naive;
  require(positive(naive.step_factor), "naive step factor", naive.step_factor, "above 0");
  require(positive(naive.min_step) && naive.min_step <= 1, "naive least step", naive.min_step, "above 0 and at most 1");
  require(std::isfinite(naive.tolerance) && naive.tolerance >= 0, "naive tolerance", naive.tolerance, "0 or more");
  require(naive.max_steps >= 1, "naive step limit", naive.max_steps, "1 or more");
  const auto& relaxed = settings.relaxed;
  require(positive(relaxed.step_factor), "relaxed step factor", relaxed.step_factor, "above 0");
  require(positive(relaxed.tolerance), "relaxed tolerance", relaxed.tolerance, "above 0");
  require(relaxed.max_steps >= 1, "relaxed step limit", relaxed.max_steps, "1 or more");
  const auto& lipschitz = settings.lipschitz;
  require(lipschitz.shrink >= 0 && lipschitz.shrink <= 1, "lipschitz shrink factor", lipschitz.shrink,
          "above 0 and at most 1, or 0 for that of the slope bound");
  require(std::isfinite(lipschitz.tolerance) && lipschitz.tolerance >= 0, "lipschitz tolerance", lipschitz.tolerance,
          "0 or more");
  require(lipschitz.max_steps >= 1, "lipschitz step limit", lipschitz.max_steps, "1 or more");
  require(settings.bisect.halvings >= 1 && settings.bisect.halvings <= 60, "bisect halvings", settings.bisect.halvings,
          "1 to 60");
}

std::span<const MarchEntry> marches() { return kMarches; }

const MarchEntry& find_march(std::string_view name) {
  std::string names;
  for (const MarchEntry& entry : kMarches) {
    if (entry.name == name) return entry;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", entry.name);
  }
  throw Error(fmt::format("march '{}': unknown; there are: {}", name, names));
}

}  // namespace scarp
