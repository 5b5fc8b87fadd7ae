// SPDX-License-Identifier: MIT
// Installed shader texts, run as GLSL ES 3.0 by EGL without a window: a pixel for each ray.
#pragma once

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "march/height/texture_levels.h"

namespace scarp::test {

/// A text of share/scarp/glsl.
inline std::string installed_text(const std::string& name) {
  std::ifstream file(SCARP_FLAT_TEXTS "/" + name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// One triangle over all pixels.
inline const std::string kVertices = R"(#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }
)";

/// A context without a window; `why_not` gives the reason if there is none.
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

inline GLuint compiled(GLenum kind, const std::string& text) {
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

/// A three-dimensional texture of unsigned integers, one byte or two words per texel, for texelFetch.
inline void fill_3d(GLenum unit, GLint format, const std::array<int, 3>& size, const void* texels) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_3D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const bool words = format == GL_RG32UI;
  glTexImage3D(GL_TEXTURE_3D, 0, format, size[0], size[1], size[2], 0, words ? GL_RG_INTEGER : GL_RED_INTEGER,
               words ? GL_UNSIGNED_INT : GL_UNSIGNED_BYTE, texels);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

/// A texture of 32-bit floats for texelFetch, bound to the texture unit that the shader reads.
inline void fill(GLenum unit, GLint format, GLenum channels, const std::vector<TextureLevel>& levels) {
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

/// A fragment shader with three results of four floats, or of four words.
class EsTest : public testing::Test {
 protected:
  static constexpr int kWidth = 16, kHeight = 16;
  static constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

  void use(const std::string& fragment_text, GLenum results = GL_RGBA32F) {
    program_ = glCreateProgram();
    glAttachShader(program_, compiled(GL_VERTEX_SHADER, kVertices));
    glAttachShader(program_, compiled(GL_FRAGMENT_SHADER, fragment_text));
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
      glTexStorage2D(GL_TEXTURE_2D, 1, results, kWidth, kHeight);
      glFramebufferTexture2D(GL_FRAMEBUFFER, attachments[i], GL_TEXTURE_2D, targets[i], 0);
    }
    glDrawBuffers(attachments.size(), attachments.data());
    glViewport(0, 0, kWidth, kHeight);
    ASSERT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_COMPLETE});
  }
  GLint at(const char* uniform) const { return glGetUniformLocation(program_, uniform); }
  static std::vector<float> pixels_of(GLenum attachment) {
    std::vector<float> pixels(4 * kPixels);
    glReadBuffer(attachment);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_FLOAT, pixels.data());
    return pixels;
  }

  static std::vector<GLuint> words_of(GLenum attachment) {
    std::vector<GLuint> words(4 * kPixels);
    glReadBuffer(attachment);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA_INTEGER, GL_UNSIGNED_INT, words.data());
    return words;
  }

  EsContext context_;

 private:
  GLuint program_ = 0;
};

}  // namespace scarp::test
