// SPDX-License-Identifier: MIT
#include "app/viewer/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/viewer/kept_settings.h"
#include "app/viewer/keys.h"
#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

constexpr float kFontPixels = 13;  // size for which Dear ImGui's font is drawn
constexpr float kMostScale = 8;    // limit for fonts in textures

}  // namespace

namespace {

double limited_scale(float x, float y) { return std::clamp(std::max(x, y), 1.0f, kMostScale); }

}  // namespace

Glfw::Screen Glfw::screen() {
  Screen screen;
  glfwSetErrorCallback([](int, const char*) {});
  GLFWmonitor* const monitor = glfwInit() ? glfwGetPrimaryMonitor() : nullptr;
  if (!monitor) return screen;
  float x = 1, y = 1;
  glfwGetMonitorContentScale(monitor, &x, &y);
  screen.scale = limited_scale(x, y);
  int left = 0, top = 0;
  glfwGetMonitorWorkarea(monitor, &left, &top, &screen.width, &screen.height);
  return screen;
}

Glfw::Glfw(int width, int height, const std::string& title) {
  glfwSetErrorCallback([](int, const char*) {});
  if (!glfwInit())
    throw Error(
        "window: there is no display to open it on (is DISPLAY or WAYLAND_DISPLAY set? `scarp render` needs none)");
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!window_) {
    glfwTerminate();
    throw Error("window: it cannot be opened on this display");
  }
}

Glfw::~Glfw() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Glfw::toggle_full_screen() {
  if (glfwGetWindowMonitor(window_)) return glfwSetWindowMonitor(window_, nullptr, x_, y_, width_, height_, 0);
  glfwGetWindowPos(window_, &x_, &y_);
  glfwGetWindowSize(window_, &width_, &height_);
  int count = 0;
  GLFWmonitor* const* const monitors = glfwGetMonitors(&count);
  for (int i = 0; i < count; ++i) {
    int left = 0, top = 0;
    glfwGetMonitorPos(monitors[i], &left, &top);
    const GLFWvidmode* const mode = glfwGetVideoMode(monitors[i]);
    if (!mode) continue;
    const int col = x_ + width_ / 2 - left, row = y_ + height_ / 2 - top;
    const bool here = col >= 0 && row >= 0 && col < mode->width && row < mode->height;
    if (here || i + 1 == count)
      return glfwSetWindowMonitor(window_, monitors[i], 0, 0, mode->width, mode->height, mode->refreshRate);
  }
}

void listen(GLFWwindow* window, WindowListener listener) {
  static WindowListener kept;
  kept = std::move(listener);
  glfwSetCursorPosCallback(
      window, [](GLFWwindow*, double x, double y) { kept.event({.kind = WindowEvent::Kind::move, .x = x, .y = y}); });
  glfwSetMouseButtonCallback(window, [](GLFWwindow*, int button, int action, int modifiers) {
    kept.event(
        {.kind = WindowEvent::Kind::button, .code = button, .down = action == GLFW_PRESS, .modifiers = modifiers});
  });
  glfwSetKeyCallback(window, [](GLFWwindow*, int key, int scancode, int action, int modifiers) {
    const int letter = letter_of(key, scancode);
    if (action == GLFW_REPEAT && !repeats(letter)) return;
    kept.event({.kind = WindowEvent::Kind::key,
                .code = key,
                .letter = letter,
                .down = action != GLFW_RELEASE,
                .modifiers = modifiers});
  });
  glfwSetCharCallback(window, [](GLFWwindow*, unsigned code) {
    if (!ImGui::GetIO().WantTextInput) return;
    std::array<char, 5> text{};
    ImTextCharToUtf8(text.data(), code);
    kept.event({.kind = WindowEvent::Kind::text, .text = text.data()});
  });
  glfwSetScrollCallback(
      window, [](GLFWwindow*, double x, double y) { kept.event({.kind = WindowEvent::Kind::wheel, .x = x, .y = y}); });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow*) { kept.refreshed(); });
  glfwSetDropCallback(window, [](GLFWwindow*, int count, const char** files) {
    if (count > 0) kept.dropped({files, files + count});
  });
  glfwSetWindowFocusCallback(window, [](GLFWwindow*, int focused) {
    if (!focused) kept.left();
  });
}

Imgui::Imgui(GLFWwindow* window, bool listens, double text) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  float x = 1, y = 1;
  glfwGetWindowContentScale(window, &x, &y);
  screen_ = limited_scale(x, y);
  // Scaled fonts are blurred: each size has its own.
  for (const double size : kTextSizes) {
    ImFontConfig font;
    font.SizePixels = std::round(kFontPixels * static_cast<float>(screen_ * size));
    io.Fonts->AddFontDefault(&font);
  }
  set_text(text);
  ImGui_ImplGlfw_InitForVulkan(window, listens);
}

void Imgui::set_text(double size) {
  text_ = size;
  const auto at = std::find(kTextSizes.begin(), kTextSizes.end(), size) - kTextSizes.begin();
  ImGuiIO& io = ImGui::GetIO();
  io.FontDefault = io.Fonts->Fonts[static_cast<int>(at) % io.Fonts->Fonts.Size];
  ImGui::GetStyle() = ImGuiStyle();
  ImGui::StyleColorsDark();
  ImGui::GetStyle().ScaleAllSizes(static_cast<float>(scale()));
}

double Imgui::scale() const { return std::round(kFontPixels * screen_ * text_) / kFontPixels; }

Imgui::~Imgui() {
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

}  // namespace scarp::viewer
