// SPDX-License-Identifier: MIT
// Targets that lack a part required by a march are rejected.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/refusal.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/queries.h"

namespace scarp::test {
namespace {

TEST(Targets, WithMissingPartsAreRejectedByEveryQuery) {
  const HeightField field = HeightField::own(std::vector<float>(25, 1.0f), 5, 5);
  const MaxPyramid pyramid(field);
  std::vector<Ray> rays(40, Ray{{1.5, 1.5, 9}});
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  for (const HeightMarchEntry& march : height_marches()) {
    SCOPED_TRACE(march.name);
    const auto refusals = [&](const HeightTarget& target, const std::string& part) {
      const auto expect = [&](const std::string& message) {
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_EQ(message.empty(), part.empty()) << message;
      };
      expect(refusal([&] { march.cpu(target, rays[0], {}, nullptr); }));
      expect(refusal([&] { march.occluded(target, rays[0], {}); }));
      expect(refusal([&] { march.batch(target, rays, hits, {}); }));
      expect(refusal([&] { march.occluded_batch(target, rays, blocked, {}); }));
      expect(refusal([&] { closest_hits(target, rays, hits, march, {}); }));
      expect(refusal([&] { occluded(target, rays, blocked, march, {}); }));
    };
    refusals({.pyramid = &pyramid, .slope = 0}, "has no field");
    refusals({.field = &field, .slope = 0}, march.needs_pyramid ? "needs a maximum pyramid" : "");
    refusals({.field = &field, .pyramid = &pyramid}, march.needs_slope ? "needs a bound of the slope" : "");
    refusals({.field = &field, .pyramid = &pyramid, .slope = slope_bound(field)}, "");
  }
  EXPECT_NE(refusal([&] { all_hits_max_mip({.field = &field}, rays[0], hits); }), "");
}

}  // namespace
}  // namespace scarp::test
