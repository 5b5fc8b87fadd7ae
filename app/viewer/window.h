// SPDX-License-Identifier: MIT
// Owners of GLFW's window and Dear ImGui's state.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/viewer/recording.h"

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
  /// Fills the screen that the window is on, or goes back to a window.
  void toggle_full_screen();

 private:
  GLFWwindow* window_ = nullptr;
  int x_ = 0, y_ = 0, width_ = 0, height_ = 0;  // of the window, while it fills the screen
};

/// Called for the events of a window.
struct WindowListener {
  std::function<void(const WindowEvent&)> event;
  std::function<void()> refreshed;
  std::function<void(const std::vector<std::string>&)> dropped;
  std::function<void()> left;  ///< the keyboard is another window's
};
/// The window keeps the listener. Called once.
void listen(GLFWwindow* window, WindowListener listener);

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
