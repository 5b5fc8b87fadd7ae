// SPDX-License-Identifier: MIT
// The installed text for WebGL 2, run as GLSL ES 3.0 by EGL without a window: rays of floats (scarp_ray_from), closest
// hit and any hit over textures, judged like those of the same text in C++. GLSL ES lacks the qualifier `precise`: the
// bound holds as long as the driver's compiler does not change the arithmetic, which is tested here.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "march/height/es_context.h"
#include "march/height/rounding_judge.h"
#include "march/height/sampled_twin.h"
#include "march/height/shader_ray.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/sampling/shrink_factor.h"

namespace scarp::test {
namespace {

const std::string kHead = R"(#version 300 es
precision highp float;
precision highp int;
uniform highp sampler2D scarp_heights, scarp_bounds;
uniform highp float scarp_nodata;
)";
const std::string kMain = R"(
uniform highp sampler2D origins, directions;  // w of the second: the ray's end
uniform ivec2 cells, samples;
uniform int top_level;
uniform uint flags;
uniform float code_base, code_base_low, code_step, lowest, highest;
layout(location = 0) out vec4 told;
layout(location = 1) out vec4 place;
layout(location = 2) out vec4 begin;
void main() {
  ScarpField field = ScarpField(cells, samples, top_level, flags, code_base, code_base_low, code_step, lowest, highest);
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 direction = texelFetch(directions, at, 0);
  ScarpRay ray;
  bool marches = scarp_ray_from(field, texelFetch(origins, at, 0).xyz, direction.xyz, direction.w, ray);
  ScarpHit hit = scarp_no_hit();
  ScarpHit any = hit;
  if (marches) {
    hit = scarp_max_mip(field, ray, false);
    any = scarp_max_mip(field, ray, true);
  }
  told = vec4(float(hit.status), float(any.status), hit.time, hit.time_low);
  place = vec4(hit.cell, hit.place);
  begin = vec4(marches ? 1.0 : 0.0, marches ? ray.travelled : 0.0, 0.0, 0.0);
}
)";
// The other marches, as doc/library/glsl.md calls them.
const std::string kSampledMain = R"(
uniform highp sampler2D origins, directions;  // w of the second: the ray's end
uniform ivec2 cells, samples;
uniform int march;
uniform float lowest, highest, shrink;
layout(location = 0) out vec4 told;
layout(location = 1) out vec4 unused_1;
layout(location = 2) out vec4 unused_2;
void main() {
  ScarpField field = ScarpField(cells, samples, 1, 0u, 0.0, 0.0, 0.0, lowest, highest);
  ScarpSampling settings = scarp_naive(0.7, 1.0 / 512.0, 0.001, 1024);
  if (march == 1) settings = scarp_relaxed(0.4, 0.0015, 300);
  if (march == 2) settings = scarp_lipschitz(shrink, 0.0005, 1024);
  if (march == 3) settings = scarp_fixed_step(0.5, kScarpRefineSecant, 16384);
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 direction = texelFetch(directions, at, 0);
  ScarpRay ray;
  ScarpHit hit = scarp_no_hit();
  if (scarp_ray_from(field, texelFetch(origins, at, 0).xyz, direction.xyz, direction.w, ray))
    hit = scarp_sampled(field, ray, settings);
  told = vec4(float(hit.status), hit.time + hit.time_low, ray.travelled, 0.0);
  unused_1 = vec4(0.0);
  unused_2 = vec4(0.0);
}
)";

class TexturesAsEs : public EsTest {
 protected:
  void SetUp() override {
    if (!context_.why_not.empty()) GTEST_SKIP() << context_.why_not;
    use_text("max_mip.glsl", kMain);
  }

  void use_text(const char* march, const std::string& main) {
    use(kHead + installed_text("textures.glsl") + installed_text(march) + main);
    glUniform1i(at("scarp_heights"), 0);
    glUniform1i(at("scarp_bounds"), 1);
    glUniform1i(at("origins"), 2);
    glUniform1i(at("directions"), 3);
  }

  void set_field(const HeightField& field, const MaxPyramid& pyramid) {
    fill(0, GL_R32F, GL_RED, heights_of(field));
    fill(1, GL_RG32F, GL_RG, bounds_of(pyramid));
    const glsl::ScarpField of = device_field(field, &pyramid);
    glUniform1f(at("scarp_nodata"), static_cast<float>(field.settings().nodata.value_or(NAN)));
    glUniform2i(at("cells"), of.cells.x, of.cells.y);
    glUniform2i(at("samples"), of.samples.x, of.samples.y);
    glUniform1i(at("top_level"), of.top_level);
    glUniform1ui(at("flags"), of.flags);
    glUniform1f(at("code_base"), of.code_base);
    glUniform1f(at("code_base_low"), of.code_base_low);
    glUniform1f(at("code_step"), of.code_step);
    glUniform1f(at("lowest"), of.lowest);
    glUniform1f(at("highest"), of.highest);
  }
};

TEST_F(TexturesAsEs, MaxMipMatchesTheSurface) {
  int hits = 0;
  for (const FieldKind& fields : spiteful_fields()) {
    Random random(17);
    const HeightField field = fields.make(random);
    if (!field.has_cells() || field.all_nodata()) continue;
    const MaxPyramid pyramid(field);
    set_field(field, pyramid);
    TextureLevel origins{kWidth, kHeight, {}}, directions{kWidth, kHeight, {}};
    std::vector<Ray> rays;
    std::vector<double> speeds;
    while (rays.size() < kPixels) {
      // The first four kinds are free and start at 0.
      const auto made = shader_ray(field, spiteful_rays()[rays.size() % 4].make(field, random));
      if (!made) continue;
      const auto [origin, direction, speed, end, ray] = *made;
      rays.push_back(ray);
      speeds.push_back(speed);
      origins.texels.insert(origins.texels.end(), {origin.x, origin.y, origin.z, 0});
      directions.texels.insert(directions.texels.end(), {direction.x, direction.y, direction.z, end});
    }
    fill(2, GL_RGBA32F, GL_RGBA, {origins});
    fill(3, GL_RGBA32F, GL_RGBA, {directions});
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const std::vector<float> told = pixels_of(GL_COLOR_ATTACHMENT0), place = pixels_of(GL_COLOR_ATTACHMENT1),
                             begin = pixels_of(GL_COLOR_ATTACHMENT2);
    ASSERT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      DeviceRay prepared;
      prepared.marches = begin[4 * i] != 0;
      prepared.begin = double{begin[4 * i + 1]};
      prepared.per_time = 1 / speeds[i];
      glsl::ScarpHit answer{};
      answer.status = static_cast<int>(told[4 * i]);
      answer.time = told[4 * i + 2];
      answer.time_low = told[4 * i + 3];
      answer.cell = {static_cast<int>(place[4 * i]), static_cast<int>(place[4 * i + 1])};
      answer.place = {place[4 * i + 2], place[4 * i + 3]};
      const Hit hit = hit_from_device(rays[i], prepared, answer);
      hits += static_cast<bool>(hit);
      const int any = static_cast<int>(told[4 * i + 1]);
      EXPECT_EQ(any == glsl::kScarpHit || any == glsl::kScarpWall, static_cast<bool>(hit)) << text(rays[i]);
      ASSERT_EQ(RoundingJudge(field, rays[i], 1024, 0x1p-24).objection(hit), "")
          << fields.name << ": " << text(rays[i]) << "\n  " << text(hit);
    }
  }
  EXPECT_GT(hits, 1000);
}

// The pasted text of the sampling marches gives the answers of `cast`.
TEST_F(TexturesAsEs, SamplingMarchesAnswerAsCast) {
  use_text("height_marches.glsl", kSampledMain);
  const HeightField field = Twins::hills();
  const MaxPyramid pyramid(field);
  const double slope = slope_bound(field);
  set_field(field, pyramid);
  glUniform1f(at("shrink"), static_cast<float>(largest_proven_shrink(slope)));
  constexpr int kBatches = 4, kRays = kBatches * static_cast<int>(kPixels);
  for (std::size_t march = 0; march < Twins::kMarches.size(); ++march) {
    glUniform1i(at("march"), static_cast<GLint>(march));
    Twins twins({&field, &pyramid, slope});
    for (int first = 0; first < kRays; first += static_cast<int>(kPixels)) {
      TextureLevel origins{kWidth, kHeight, {}}, directions{kWidth, kHeight, {}};
      std::vector<ShaderRay> rays;
      for (int i = first; i < first + static_cast<int>(kPixels); ++i) {
        rays.push_back(Twins::ray(field, i, kRays));
        const auto& [origin, direction, speed, end, ray] = rays.back();
        origins.texels.insert(origins.texels.end(), {origin.x, origin.y, origin.z, 0});
        directions.texels.insert(directions.texels.end(), {direction.x, direction.y, direction.z, end});
      }
      fill(2, GL_RGBA32F, GL_RGBA, {origins});
      fill(3, GL_RGBA32F, GL_RGBA, {directions});
      glDrawArrays(GL_TRIANGLES, 0, 3);
      const std::vector<float> told = pixels_of(GL_COLOR_ATTACHMENT0);
      ASSERT_EQ(glGetError(), GLenum{GL_NO_ERROR});
      for (std::size_t i = 0; i < rays.size(); ++i) {
        twins.judge(Twins::kMarches[march], rays[i], static_cast<int>(told[4 * i]),
                    double{told[4 * i + 1]} + double{told[4 * i + 2]});
      }
    }
    twins.conclude();
  }
}

}  // namespace
}  // namespace scarp::test
