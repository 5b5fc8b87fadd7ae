// SPDX-License-Identifier: MIT
#include "scarp/render/look/step_look.h"

#include <algorithm>
#include <numeric>

#include "scarp/render/surface/ramp.h"

namespace scarp {

Picture picture_of_steps(const PictureSettings& settings, std::span<const std::uint32_t> steps) {
  const auto width = static_cast<std::size_t>(settings.width);
  const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
  const double sum = std::accumulate(steps.begin(), steps.end(), 0.0);
  const StepScale scale =
      settings.step_scale.value_or(StepScale{static_cast<double>(*least), static_cast<double>(*most)});
  Picture picture{Image(settings.width, settings.height),
                  StepRange{*least, *most, sum / static_cast<double>(steps.size()), scale}};
  const Ramp ramp = ramp_over(settings, scale.low, scale.high);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    set_pixel(picture.image, static_cast<int>(i % width), static_cast<int>(i / width), ramp(steps[i]));
  }
  return picture;
}

}  // namespace scarp
