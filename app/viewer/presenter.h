// SPDX-License-Identifier: MIT
// A window's picture on the screen: an image scaled to the window, and Dear ImGui on top of it, by Vulkan.
//
//   image ──upload──▶ texture ──blit──▶ image of the swapchain ──ImGui──▶ present
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "scarp/render/frame/film.h"

struct GLFWwindow;

namespace scarp::viewer {

class Presenter {
 public:
  /// `device`: "auto" or part of a device's name. With `validation`, objections of the validation layer are counted and
  /// printed. Throws Error naming what is missing: loader, device, layer.
  Presenter(GLFWwindow* window, const std::string& device, bool validation);
  ~Presenter();
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;

  /// Replaces the picture, which fills the window.
  void set_image(const Image& image);
  /// ImGui::NewFrame() comes after this.
  void begin_frame();
  /// Shows the picture and what ImGui::Render() has made. With `seen`, also returns what was presented. Returns false
  /// if there is nothing to show on, as in a minimised window. Throws Error if the device is lost.
  bool present(Image* seen = nullptr);

  std::string device_name() const;
  /// Number of objections of the validation layer.
  int objections() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scarp::viewer
