// SPDX-License-Identifier: MIT
// The panel over the picture: settings, the cost of the picture, readings under the cursor.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/controls.h"
#include "app/viewer/layout.h"
#include "app/viewer/navigation.h"
#include "app/viewer/overlay.h"
#include "app/viewer/picture_worker.h"
#include "app/viewer/reading.h"
#include "app/viewer/verdict_text.h"

namespace scarp::viewer {

/// A slider whose value is typed.
struct TypedValue {
  std::string id{};           ///< of the slider; empty: none
  std::string text{}, was{};  ///< now, and at first
  bool focuses = false;       ///< takes the keyboard when it is drawn next
};

/// The state that the panel shows and changes.
struct PanelState {
  std::vector<Control> controls{};  ///< sliders change the numbers here; a completed change is an action
  /// Whether a change reopens the input: sliders then apply it when the mouse is released, otherwise while they move.
  std::function<bool(const OptionChange&)> reopens{};
  std::vector<std::string> comparisons{};  ///< possible comparisons
  std::string compared{};                  ///< current comparison; empty: none
  MoveMode mode = MoveMode::orbit;         ///< a change is an action
  double speed = 0;                        ///< metres per second
  double fov_deg = 30;                     ///< a change is an action
  double first_fov_deg = 30;               ///< of the first view
  std::string device{};                    ///< device that traces rays
  const WorkedPicture* shown = nullptr;    ///< the picture in the window
  const WorkedVerdict* verdict = nullptr;  ///< verdict on that picture
  std::vector<std::string> names{};        ///< names of its sides
  bool times = true;                       ///< whether to show the time of the picture
  bool busy = false;
  std::optional<Reading> reading{};
  std::size_t reading_lines = 1;     ///< the most so far: readings take as much room, so that controls stay
  std::vector<JudgedPixel> pixel{};  ///< under the cursor, of each side
  std::optional<MeasuredLine> line{};
  bool measures = false;  ///< clicks set the ends of a line
  bool help = false;
  bool lists_open = false;   ///< of the last frame
  bool close_lists = false;  ///< closes open lists and text fields; draw_panel() resets it
  Toast message{};           ///< the last message: saved, copied, failed
  TypedValue typed{};        ///< the number that is being typed
  bool beside = false;       ///< the layout of the last frame
  double text = 1;           ///< size of text; a change is an action
  bool keyboard = false;     ///< whether the keyboard is the panel's
  int tabs = 0;              ///< controls to go on by, until the next frame
  bool on_slider = false;    ///< whether a slider has it
  int focused = -1;          ///< number of the control with the keyboard, from 0; -1: none
};

struct PanelActions {
  bool save = false, copy = false;
  std::optional<OptionChange> change{};
  std::optional<std::string> compare{};  ///< empty: nothing
  std::optional<MoveMode> mode{};
  std::optional<double> fov_deg{}, text{};
  std::string error{};  ///< of typed text
};

/// The text without as much of its middle as does not fit into `width` pixels.
std::string fitted(const std::string& text, float width);
/// Gives the keyboard to the panel or takes it away; call before ImGui::NewFrame().
void let_panel_have_keys(const PanelState& state);
/// Draws the panel between ImGui::NewFrame() and ImGui::Render().
PanelActions draw_panel(PanelState& state, const WindowLayout& layout);

}  // namespace scarp::viewer
