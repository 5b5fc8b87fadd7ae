// SPDX-License-Identifier: MIT
// Arbitrary rays are judged like the rays of the look `error`.
#include "scarp/render/look/judged_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/terrain.h"
#include "scarp/base/error.h"
#include "scarp/render/frame/picture.h"

namespace scarp {
namespace {

TEST(JudgedRays, AreCountedAsInThePicture) {
  std::vector<float> samples;
  for (int row = 0; row < 65; ++row) {
    for (int col = 0; col < 65; ++col)
      samples.push_back(static_cast<float>(8 * std::sin(0.7 * col) * std::cos(0.6 * row)));
  }
  const HeightField field = HeightField::own(std::move(samples), 65, 65);
  for (const std::string_view march : {"naive", "max-mip"}) {
    const Scene scene = test::terrain(field, march);
    const Camera camera = Camera::look_at({32, -30, 25}, {32, 32, 0}, 50, 64, 48);
    const ErrorSettings settings{.tolerance = 0.5};
    PictureSettings picture;
    picture.width = 64, picture.height = 48;
    picture.look = Look::error, picture.error = settings;
    const ErrorCounts counts = *render_picture(scene, camera, picture).errors;
    picture.look = Look::steps;
    const double mean_steps = render_picture(scene, camera, picture).steps->mean;
    std::vector<Ray> rays;
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) rays.push_back(camera.ray(x + 0.5, y + 0.5));
    }
    const JudgedRays judged = judge_rays(scene, scene.judge(), rays, settings);
    for (int i = 0; i < kVerdicts; ++i) {
      const auto verdict = static_cast<Verdict>(i);
      EXPECT_EQ(judged[verdict], counts[verdict]) << march << ": " << name_of(verdict);
    }
    EXPECT_DOUBLE_EQ(judged.mean_steps, mean_steps) << march;
    EXPECT_EQ(judged[Verdict::early] + judged[Verdict::late] + judged[Verdict::lost] > 0, march == "naive");
    EXPECT_THROW(judge_rays(scene, scene.judge(), rays, settings, [](double) { return false; }), Interrupted);
  }
}

}  // namespace
}  // namespace scarp
