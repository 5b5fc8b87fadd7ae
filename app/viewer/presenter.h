// SPDX-License-Identifier: MIT
// Shows a window's picture on the screen with Vulkan: an image scaled to the window, with Dear ImGui on top.
//
//   image ──upload──▶ texture ──blit──▶ image of the swapchain ──ImGui──▶ present
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "scarp/render/film/film.h"

struct GLFWwindow;

namespace scarp::viewer {

class Presenter {
 public:
  /// `device`: "auto" or part of a device's name. With `validation`, messages of the validation layer are counted and
  /// printed. Throws Error naming the missing part: loader, device, layer.
  Presenter(GLFWwindow* window, const std::string& device, bool validation);
  ~Presenter();
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;

  /// Replaces the picture, which fills the window, or its part right of set_left().
  void set_image(const Image& image);
  /// Sets the column of the window at which the picture starts; left of it the window is black.
  void set_left(int column);
  /// Call before ImGui::NewFrame().
  void begin_frame();
  /// Shows the picture and the output of ImGui::Render(). With `seen`, also returns the presented image. Returns false
  /// if there is no surface to show it on, as with a minimised window. Throws Error if the device is lost.
  bool present(Image* seen = nullptr);

  std::string device_name() const;
  /// Number of messages of the validation layer.
  int objections() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp::viewer
