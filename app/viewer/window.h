// SPDX-License-Identifier: MIT
// Owners of GLFW's window and Dear ImGui's state.
#pragma once

#include <string>

struct GLFWwindow;

namespace scarp::viewer {

class Glfw {
 public:
  /// Throws Error if there is no display.
  Glfw(int width, int height, const std::string& title);
  ~Glfw();
  Glfw(const Glfw&) = delete;
  Glfw& operator=(const Glfw&) = delete;
  GLFWwindow* get() const { return window_; }

 private:
  GLFWwindow* window_ = nullptr;
};

/// Must be destroyed before the window.
class Imgui {
 public:
  /// With `listens`, receives the window's events after the installed callbacks. The font and the panels are scaled for
  /// the window's screen.
  Imgui(GLFWwindow* window, bool listens);
  ~Imgui();
  Imgui(const Imgui&) = delete;
  Imgui& operator=(const Imgui&) = delete;
};

}  // namespace scarp::viewer
