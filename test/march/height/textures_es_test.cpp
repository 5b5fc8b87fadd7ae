// SPDX-License-Identifier: MIT
// The installed text for WebGL 2, run as GLSL ES 3.0 by EGL without a window: rays of floats (scarp_ray_from), closest
// hit and any hit over textures, judged as those of the same text in C++. ES has no word for `precise`: the bound holds
// as far as the driver's compiler leaves the arithmetic alone, which is seen here.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "march/height/rounding_judge.h"
#include "march/height/shader_ray.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "march/height/texture_levels.h"
#include "scarp/march/height/device_ray.h"

namespace scarp::test {
namespace {

constexpr int kWidth = 16, kHeight = 16;  // a pixel for each ray

std::string installed_text(const std::string& name) {
  std::ifstream file(SCARP_FLAT_TEXTS "/" + name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

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
// One triangle over all pixels.
const std::string kVertices = R"(#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }
)";

// A context without a window; none: why.
class EsContext {
 public:
  EsContext() {
    const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (get) display_ = get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr)) {
      why_not = "EGL has no display without a window";
      return;
    }
    eglBindAPI(EGL_OPENGL_ES_API);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT || !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      why_not = "EGL has no OpenGL ES 3.0";
      return;
    }
    const std::string has = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
    if (has.find("GL_EXT_color_buffer_float") == std::string::npos) why_not = "floats cannot be drawn";
  }
  ~EsContext() {
    if (display_ != EGL_NO_DISPLAY) eglTerminate(display_);
  }
  EsContext(const EsContext&) = delete;
  EsContext& operator=(const EsContext&) = delete;

  std::string why_not;

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

GLuint compiled(GLenum kind, const std::string& text) {
  const GLuint shader = glCreateShader(kind);
  const char* start = text.c_str();
  glShaderSource(shader, 1, &start, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  std::array<char, 2000> said{};
  if (!good) glGetShaderInfoLog(shader, said.size(), nullptr, said.data());
  EXPECT_TRUE(good) << said.data();
  return shader;
}

// Textures as the head of textures.glsl.h wants them; the unit is where the shader finds it.
void fill(GLenum unit, GLint format, GLenum channels, const std::vector<TextureLevel>& levels) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const TextureLevel& of = levels[level];
    glTexImage2D(GL_TEXTURE_2D, static_cast<GLint>(level), format, static_cast<GLsizei>(of.cols),
                 static_cast<GLsizei>(of.rows), 0, channels, GL_FLOAT, of.texels.data());
  }
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, levels.size() > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

class TexturesAsEs : public testing::Test {
 protected:
  void SetUp() override {
    if (!context_.why_not.empty()) GTEST_SKIP() << context_.why_not;
    program_ = glCreateProgram();
    glAttachShader(program_, compiled(GL_VERTEX_SHADER, kVertices));
    glAttachShader(program_, compiled(GL_FRAGMENT_SHADER, kHead + installed_text("textures.glsl") +
                                                              installed_text("max_mip.glsl") + kMain));
    glLinkProgram(program_);
    glUseProgram(program_);
    GLuint frame = 0;
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    std::array<GLuint, 3> targets{};
    glGenTextures(targets.size(), targets.data());
    std::array<GLenum, 3> attachments{};
    for (GLuint i = 0; i < targets.size(); ++i) {
      attachments[i] = GL_COLOR_ATTACHMENT0 + i;
      glBindTexture(GL_TEXTURE_2D, targets[i]);
      glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, kWidth, kHeight);
      glFramebufferTexture2D(GL_FRAMEBUFFER, attachments[i], GL_TEXTURE_2D, targets[i], 0);
    }
    glDrawBuffers(attachments.size(), attachments.data());
    glViewport(0, 0, kWidth, kHeight);
    ASSERT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_COMPLETE});
    glUniform1i(at("scarp_heights"), 0);
    glUniform1i(at("scarp_bounds"), 1);
    glUniform1i(at("origins"), 2);
    glUniform1i(at("directions"), 3);
  }

  GLint at(const char* uniform) const { return glGetUniformLocation(program_, uniform); }
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
  static std::vector<float> pixels_of(GLenum attachment) {
    std::vector<float> pixels(std::size_t{4} * kWidth * kHeight);
    glReadBuffer(attachment);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_FLOAT, pixels.data());
    return pixels;
  }

  EsContext context_;
  GLuint program_ = 0;
};

TEST_F(TexturesAsEs, MaxMipDecidesAsTheSurfaceDoes) {
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
    while (rays.size() < std::size_t{kWidth} * kHeight) {
      // The first four kinds are free and begin at 0.
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

}  // namespace
}  // namespace scarp::test
