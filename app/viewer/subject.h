// SPDX-License-Identifier: MIT
// The content of the window: an input with its options and, for comparisons, the same input with another march or look.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/picture/prepared_scene.h"
#include "app/viewer/controls.h"
#include "app/viewer/opening.h"
#include "app/viewer/picture_worker.h"
#include "app/viewer/verdict_text.h"

namespace scarp::viewer {

class Subject {
 public:
  /// Opens the input, for pictures of a window of this size. Throws Error.
  Subject(Opening opening, int width, int height);

  const Opening& opening() const { return main_.opening; }
  const cli::PreparedScene& prepared() const { return main_.opened->prepared; }
  /// The same, for owners that may outlive a change of the input.
  std::shared_ptr<const cli::PreparedScene> shared() const { return {main_.opened, &main_.opened->prepared}; }
  /// The settings of the picture, for any camera and of any size.
  const PictureSettings& settings() const { return main_.settings; }
  /// The camera of the options.
  const Camera& first_camera() const { return first_camera_; }
  /// Where rays are traced: a device's name, or "the CPU".
  const std::string& device() const { return device_; }

  /// Changes an option. Returns whether the input was reopened, which replaces prepared(). If it throws Error, nothing
  /// has changed. Throws Error for options of the window itself (kWindowOptions). With `goes_on`, undo() takes it back
  /// together with the change before, as for the movement of a slider.
  bool change(const OptionChange& change, bool goes_on = false);
  /// Takes the last change back, or makes one again that was taken back. Returns whether the input was reopened;
  /// nullopt: there is no such change. Throws as change().
  std::optional<bool> undo();
  std::optional<bool> redo();

  /// Whether change() would reopen the input. Throws Error for a change that the options reject.
  bool reopens(const OptionChange& change) const;

  /// Reopens the input, as after a change of its file. If it throws Error, nothing has changed.
  void reopen();

  /// The possible comparisons: "march naive", "look steps".
  std::vector<std::string> comparisons() const;
  /// Shows this comparison; empty: none. If it throws Error, nothing has changed.
  void compare(const std::string& with);
  const std::string& compared() const { return compared_; }
  /// The main picture in the form of compared(): "march max-mip" for "march naive".
  std::string comparable() const;

  /// The pictures for a window of this size: that of the input, and that of the comparison.
  std::vector<PictureSide> sides(int width, int height) const;
  /// The verdict on one ray of each side, in the same order, by the CPU; empty where a side cannot be judged: large
  /// pixels, coarser voxels, fields that are only on a device.
  std::vector<JudgedPixel> judged(const Ray& ray) const;
  /// The inputs with their options, in the same order.
  std::vector<const Opening*> openings() const;

  std::vector<Control> controls(const std::optional<StepScale>& steps) const;

 private:
  // Once opened, the scene belongs to the worker.
  struct Opened {
    Opened(cli::InputKind kind, cli::RenderOptions options, ImageSize size)
        : prepared(kind, std::move(options), size) {}
    cli::PreparedScene prepared;
    std::optional<Scene> judges{};        // created on request
    std::optional<Scene> pixel_judges{};  // the same for single pixels, on the window's thread
  };
  struct Side {
    Opening opening;
    std::shared_ptr<Opened> opened;
    std::shared_ptr<const cli::RenderOptions> options;  ///< as typed; those of the opening have the current values
    PictureSettings settings{};                         ///< for any camera
  };

  Side open(Opening opening) const;
  static Side side_by(const std::shared_ptr<Opened>& opened, Opening opening);
  // Avoids rereading the inputs if possible.
  Side side_of(Opening opening, const Side& like, const Side* or_like) const;
  std::optional<Side> beside(const Side& main) const;
  OptionChange comparison() const;
  static PictureSide picture_side(const Side& side, int width, int height);

  int width_, height_;
  using Given = std::vector<GivenOption>;
  std::optional<bool> go_back(std::vector<Given>& from, std::vector<Given>& to);
  bool take(Opening opening);

  std::vector<Given> undone_{}, done_{};  // the options before each change, the newest last
  Side main_;
  std::string compared_{};
  std::optional<Side> other_{};
  Camera first_camera_;
  std::string device_;
};

}  // namespace scarp::viewer
