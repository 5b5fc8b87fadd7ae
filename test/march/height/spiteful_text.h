// SPDX-License-Identifier: MIT
// Adversarial fields and rays in pairs, for tests that run once for each pair; and rays and hits as text, for failures.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <vector>

#include "march/height/spiteful.h"

namespace scarp::test {

struct Pair {
  std::size_t field, ray;
};

/// All pairs of rays and fields in which the field has the features that the rays target.
inline std::vector<Pair> pairs() {
  std::vector<Pair> pairs;
  for (std::size_t field = 0; field < spiteful_fields().size(); ++field) {
    for (std::size_t ray = 0; ray < spiteful_rays().size(); ++ray) {
      const unsigned needed = spiteful_rays()[ray].aims_at;
      if ((spiteful_fields()[field].has & needed) == needed) pairs.push_back({field, ray});
    }
  }
  return pairs;
}

inline std::string test_name(std::string name) {
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
}

inline std::string name_of_pair(const testing::TestParamInfo<Pair>& info) {
  return test_name(
      fmt::format("{}__{}", spiteful_fields()[info.param.field].name, spiteful_rays()[info.param.ray].name));
}

inline std::string text(const Ray& ray) {
  return fmt::format("origin ({:a}, {:a}, {:a}) direction ({:a}, {:a}, {:a}) t [{:a}, {:a}] {} cell ({}, {})",
                     ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z,
                     ray.t_min, ray.t_max, ray.start == RayStart::free ? "free" : "on surface", ray.start_cell.col,
                     ray.start_cell.row);
}

inline std::string text(const Hit& hit) {
  static constexpr const char* kNames[] = {"miss", "hit", "below", "exhausted"};
  return fmt::format("{}{} t={:a} cell ({}, {}) u={} v={}", kNames[static_cast<int>(hit.status)],
                     hit.wall ? " wall" : "", hit.t, hit.cell.col, hit.cell.row, hit.u, hit.v);
}

}  // namespace scarp::test
