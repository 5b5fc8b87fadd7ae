// SPDX-License-Identifier: MIT
#include "scarp/render/look/step_look.h"

#include <algorithm>
#include <numeric>

namespace scarp {

StepRange range_of_steps(std::span<const std::uint32_t> steps, const std::optional<StepScale>& scale) {
  const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
  const double sum = std::accumulate(steps.begin(), steps.end(), 0.0);
  return {*least, *most, sum / static_cast<double>(steps.size()),
          scale.value_or(StepScale{static_cast<double>(*least), static_cast<double>(*most)})};
}

Image image_of_steps(ImageSize size, std::span<const std::uint32_t> steps, const Ramp& ramp) {
  Image image(size.width, size.height);
  const auto width = static_cast<std::size_t>(size.width);
  for (std::size_t i = 0; i < steps.size(); ++i)
    set_pixel(image, static_cast<int>(i % width), static_cast<int>(i / width), ramp(steps[i]));
  return image;
}

}  // namespace scarp
