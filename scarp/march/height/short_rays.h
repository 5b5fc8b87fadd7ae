// SPDX-License-Identifier: MIT
// Rays over few cells: preparing vectors for them takes longer than the scalar walk, which starts at their first cell.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "scarp/field/height_field.h"

namespace scarp::max_mip {

/// Whether the ray crosses less than this many cells, or none.
inline bool crosses_few_cells(const HeightField& field, const Ray& ray, double cells) {
  const HeightField::GridScales scales = field.grid_scales();
  const double per_t = std::abs(ray.direction.x) * scales.per_cell_x + std::abs(ray.direction.y) * scales.per_cell_y;
  return per_t == 0 || per_t * (ray.t_max - ray.t_min) < cells;
}

/// Sets answers[i] to alone(rays[i]).
template <class Answer, class Alone>
void answer_alone(std::span<const Ray> rays, std::span<Answer> answers, const Alone& alone) {
  for (std::size_t i = 0; i < rays.size(); ++i) answers[i] = alone(rays[i]);
}

/// Answers rays that cross less than `cells` cells by alone(ray), and all others by together(rays, answers).
template <class Answer, class Alone, class Together>
void answer_by_length(const HeightField& field, double cells, std::span<const Ray> rays, std::span<Answer> answers,
                      const Alone& alone, const Together& together) {
  const auto few = [&](const Ray& ray) { return crosses_few_cells(field, ray, cells); };
  const auto first = static_cast<std::size_t>(std::find_if(rays.begin(), rays.end(), few) - rays.begin());
  if (first == rays.size()) return together(rays, answers);
  std::vector<Ray> others(rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(first));
  std::vector<std::size_t> at(first);
  std::iota(at.begin(), at.end(), std::size_t{0});
  for (std::size_t i = first; i < rays.size(); ++i) {
    if (few(rays[i])) {
      answers[i] = alone(rays[i]);
    } else {
      others.push_back(rays[i]), at.push_back(i);
    }
  }
  if (others.empty()) return;
  std::vector<Answer> found(others.size());
  together(others, std::span<Answer>(found));
  for (std::size_t i = 0; i < at.size(); ++i) answers[at[i]] = found[i];
}

}  // namespace scarp::max_mip
