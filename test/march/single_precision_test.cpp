// SPDX-License-Identifier: MIT
// The shader text of max-mip, compiled as C++ with floats, on the oracle's fields and rays: no GPU is needed to know
// that its decisions are right. RoundingJudge says what an answer may be.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "march/glsl_host.h"
#include "march/rounding_judge.h"
#include "march/spiteful.h"
#include "march/spiteful_text.h"
#include "scarp/march/device_ray.h"
#include "scarp/march/max_mip.glsl.h"
#include "scarp/march/max_mip.h"

namespace scarp::test {
namespace {

#ifdef NDEBUG
constexpr int kRaysPerPair = 10'000;
#else
constexpr int kRaysPerPair = 500;
#endif
constexpr int kRaysPerField = 250;

class SinglePrecision : public testing::TestWithParam<Pair> {};

TEST_P(SinglePrecision, MaxMipDecidesAsTheSurfaceDoes) {
  const FieldKind& fields = spiteful_fields()[GetParam().field];
  const RayKind& kind = spiteful_rays()[GetParam().ray];
  Random random(1000 * GetParam().field + GetParam().ray);
  int other_status = 0, bad = 0;
  for (int done = 0; done < kRaysPerPair && bad < 3; done += kRaysPerField) {
    const HeightField field = fields.make(random);
    const MaxPyramid pyramid(field);
    glsl::host_field = &field;
    glsl::host_pyramid = &pyramid;
    for (int i = 0; i < kRaysPerField && bad < 3; ++i) {
      const Ray ray = kind.make(field, random);
      const DeviceRay prepared = device_ray(field, ray);
      glsl::ScarpHit answer{}, any{};
      if (prepared.marches) {
        const glsl::ScarpField ground = device_field(field, &pyramid);
        answer = glsl::scarp_max_mip(ground, prepared.ray, false);
        any = glsl::scarp_max_mip(ground, prepared.ray, true);
      }
      const Hit hit = hit_from_device(ray, prepared, answer);
      const bool blocked = prepared.marches && (any.status == glsl::kScarpHit || any.status == glsl::kScarpWall);
      const RoundingJudge judge(field, ray);
      const Hit exact = march_max_mip({&field, &pyramid}, ray);
      other_status += exact.status != hit.status;
      std::string objection = judge.objection(hit);
      if (objection.empty() && blocked != static_cast<bool>(hit)) objection = "any-hit contradicts";
      // The judge must be no stricter than double precision.
      const std::string self = judge.objection(exact);
      if (!self.empty()) objection += " / the march in double: " + self;
      if (objection.empty()) continue;
      ++bad;
      ADD_FAILURE() << objection << "\n  on " << fields.name << ", ray " << kind.name << ": " << text(ray)
                    << "\n  in double " << text(exact) << "\n  in single " << text(hit);
    }
  }
  // Rays that were not aimed at anything meet a rounding tie once in a blue moon.
  if (kind.name == "random" || kind.name == "from above") {
    EXPECT_LE(other_status, kRaysPerPair / 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(Spiteful, SinglePrecision, testing::ValuesIn(pairs()), name_of_pair);

}  // namespace
}  // namespace scarp::test
