// SPDX-License-Identifier: MIT
// max-mip-easy as pasted into a shader: the installed text over two textures, run as GLSL ES 3.0, judged by the bound
// of its C++ text.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "march/height/easy_judge.h"
#include "march/height/es_context.h"
#include "march/height/spiteful.h"
#include "scarp/march/height/height_target.h"

namespace scarp::test {
namespace {

const std::string kHead = R"(#version 300 es
precision highp float;
precision highp int;
)";
const std::string kMain = R"(
uniform highp sampler2D origins, directions;  // w of the second: the ray's end
layout(location = 0) out vec4 told;
layout(location = 1) out vec4 place;
layout(location = 2) out vec4 lit;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec3 origin = texelFetch(origins, at, 0).xyz;
  vec4 direction = texelFetch(directions, at, 0);
  EasyHit hit = max_mip_easy(origin, direction.xyz, direction.w, false);
  EasyHit any = max_mip_easy(origin, direction.xyz, direction.w, true);
  told = vec4(hit.hit, any.hit, hit.below, hit.t);
  place = vec4(hit.cell, hit.place);
  // Straight up from the hit, which nothing is above.
  lit = vec4(0.0);
  if (hit.hit) lit = vec4(easy_normal(hit), max_mip_easy(easy_above(hit), vec3(0.0, 0.0, 1.0), 1.0e9, true).hit);
}
)";

class MaxMipEasyAsEs : public EsTest {
 protected:
  void SetUp() override {
    if (!context_.why_not.empty()) GTEST_SKIP() << context_.why_not;
    use(kHead + installed_text("max_mip_easy.glsl") + kMain);
    glUniform1i(at("easy_heights"), 0);
    glUniform1i(at("easy_maxima"), 1);
    glUniform1i(at("origins"), 2);
    glUniform1i(at("directions"), 3);
  }
};

TEST_F(MaxMipEasyAsEs, MatchesARayDisplacedByTheBound) {
  int hits = 0;
  std::vector<FieldKind> kinds = spiteful_fields();
  kinds.push_back({"hills", [](Random&) { return hills(700, 900, Surface::bilinear); }});
  for (const FieldKind& fields : kinds) {
    Random random(18);
    const HeightField field = fields.make(random);
    if (!field.has_cells() || !takes(HeightFields::plain, field)) continue;
    fill(0, GL_R32F, GL_RED, heights_of(field));
    fill(1, GL_R32F, GL_RED, maxima_of(field));
    TextureLevel origins{kWidth, kHeight, {}}, directions{kWidth, kHeight, {}};
    std::vector<GridRay> rays;
    std::vector<double> ends;
    while (rays.size() < kPixels) {
      // The first four kinds are free and begin at 0.
      const Ray ray = spiteful_rays()[rays.size() % 4].make(field, random);
      const GridRay local = field.grid_from_world(ray);
      const glm::vec3 o(local.origin), d(local.direction);
      const float end = static_cast<float>(std::min(ray.t_max, 1e9));
      rays.push_back({dvec3(o), dvec3(d)});
      ends.push_back(double{end});
      origins.texels.insert(origins.texels.end(), {o.x, o.y, o.z, 0});
      directions.texels.insert(directions.texels.end(), {d.x, d.y, d.z, end});
    }
    fill(2, GL_RGBA32F, GL_RGBA, {origins});
    fill(3, GL_RGBA32F, GL_RGBA, {directions});
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const std::vector<float> told = pixels_of(GL_COLOR_ATTACHMENT0), place = pixels_of(GL_COLOR_ATTACHMENT1),
                             lit = pixels_of(GL_COLOR_ATTACHMENT2);
    ASSERT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::size_t at = 4 * i;
      const EasyAnswer answer{told[at] != 0,         told[at + 2] != 0,
                              double{told[at + 3]},  {static_cast<int>(place[at]), static_cast<int>(place[at + 1])},
                              double{place[at + 2]}, double{place[at + 3]}};
      const auto words = [&] {
        const auto& [o, d] = rays[i];
        return fmt::format("{}: ({}, {}, {}) + t ({}, {}, {}), t_max {}", fields.name, o.x, o.y, o.z, d.x, d.y, d.z,
                           ends[i]);
      };
      ASSERT_EQ(EasyJudge(field, rays[i], ends[i]).objection(answer), "") << words();
      ASSERT_EQ(told[at] != 0, told[at + 1] != 0) << words();
      if (!answer.hit) continue;
      ++hits;
      EXPECT_EQ(lit[at + 2], 1) << words();
      // Nothing is above a height field.
      EXPECT_EQ(lit[at + 3], 0) << words();
    }
  }
  EXPECT_GT(hits, 1000);
}

}  // namespace
}  // namespace scarp::test
