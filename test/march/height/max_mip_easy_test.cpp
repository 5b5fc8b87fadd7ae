// SPDX-License-Identifier: MIT
// max-mip-easy: the shader text as C++ and the row of the table, by the bound that it is documented with.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "cases.h"
#include "march/height/easy_judge.h"
#include "march/height/entering_rays.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/height/max_mip_easy_ground.h"
#include "scarp/scene/scene_field.h"

namespace scarp::test {
namespace {

using easy::Ground;

[[maybe_unused]] const HeightMarchEntry& easy_march() { return find_height_march("max-mip-easy"); }

const int kRaysPerPair = cases(20'000, 2'000, 40);
constexpr int kRaysPerField = 250;
const int kAimedRays = cases(3'000'000, 300'000, 3'000);

std::vector<std::size_t> plain_kinds(const std::vector<FieldKind>& kinds) {
  std::vector<std::size_t> plain;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    Random random(i);
    if (kinds[i].has == kPlain && takes(HeightFields::plain, kinds[i].make(random))) plain.push_back(i);
  }
  return plain;
}

// As the text asks for.
bool is_within_limits(glm::vec3 origin, glm::vec3 direction) {
  constexpr float kLimit = 1e6f;
  const auto longest = [](glm::vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  return longest(origin) <= kLimit && longest(direction) <= kLimit && longest(direction) >= 1 / kLimit;
}

EasyAnswer answer_of(const Ground::EasyHit& hit) {
  return {hit.hit, hit.below, double{hit.t}, {hit.cell.x, hit.cell.y}, double{hit.place.x}, double{hit.place.y}};
}

// Casts a ray of floats, closest and any; returns what is wrong.
std::string cast(const HeightField& field, const MaxPyramid& pyramid, glm::vec3 origin, glm::vec3 direction, float t_max,
                 double* worst = nullptr) {
  Ground ground(field, pyramid);
  const Ground::EasyHit hit = ground.max_mip_easy(origin, direction, t_max, false);
  if (ground.max_mip_easy(origin, direction, t_max, true).hit != hit.hit) return "any-hit contradicts closest-hit";
  const EasyJudge judge(field, {dvec3(origin), dvec3(direction)}, double{t_max});
  const std::string objection = judge.objection(answer_of(hit));
  if (worst) *worst = std::max(*worst, judge.worst());
  return objection;
}

TEST(MaxMipEasy, AnswersAsRaysDisplacedByTheBound) {
  double worst = 0;
  for (const auto* fields : {&spiteful_fields(), &wide_fields()}) {
    const auto& kinds = fields == &spiteful_fields() ? spiteful_rays() : rays_across_tiles();
    const int rays_per_pair = fields == &spiteful_fields() ? kRaysPerPair : kRaysPerPair / 20;
    for (const std::size_t of : plain_kinds(*fields)) {
      for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
        Random random(1000 * of + kind);
        for (int done = 0; done < rays_per_pair; done += kRaysPerField) {
          const HeightField field = (*fields)[of].make(random);
          if (!field.has_cells()) continue;
          const MaxPyramid pyramid(field);
          for (int i = 0; i < std::min(rays_per_pair, kRaysPerField); ++i) {
            const Ray ray = kinds[kind].make(field, random);
            const GridRay local = field.grid_from_world(ray);
            const glm::vec3 origin(local.origin + ray.t_min * local.direction), direction(local.direction);
            if (!is_within_limits(origin, direction)) continue;
            const float t_max = static_cast<float>(std::min(ray.t_max - ray.t_min, 1e9));
            ASSERT_EQ(cast(field, pyramid, origin, direction, t_max, &worst), "")
                << (*fields)[of].name << ", " << kinds[kind].name << ": "
                << fmt::format("({}, {}, {}) + t ({}, {}, {}), t_max {}", origin.x, origin.y, origin.z, direction.x,
                               direction.y, direction.z, t_max);
          }
        }
      }
    }
  }
  RecordProperty("worst", fmt::format("{}", worst));
  fmt::print("worst {}\n", worst);
}

}  // namespace
}  // namespace scarp::test
