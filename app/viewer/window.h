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
  /// The screen on which windows open.
  struct Screen {
    double scale = 1;           ///< pixels per pixel of an ordinary screen, >= 1
    int width = 0, height = 0;  ///< without the desktop's bars, in pixels; 0: unknown
  };
  /// Answers without a display, too.
  static Screen screen();
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
  /// the window's screen, and by the size of text, one of kTextSizes.
  Imgui(GLFWwindow* window, bool listens, double text);
  ~Imgui();
  Imgui(const Imgui&) = delete;
  Imgui& operator=(const Imgui&) = delete;
  /// Call between frames.
  void set_text(double size);
  /// Pixels for a pixel at a scale of 1, by the screen and the size of text.
  double scale() const;

 private:
  double screen_ = 1, text_ = 1;
};

}  // namespace scarp::viewer
