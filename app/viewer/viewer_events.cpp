// SPDX-License-Identifier: MIT
// Events of the mouse and the keys.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <cmath>

#include "app/viewer/kept_settings.h"
#include "app/viewer/viewer_window.h"

namespace scarp::viewer {
namespace {

constexpr double kDoubleClick = 0.35;  // seconds between two clicks
constexpr double kClickPixels = 4;     // a longer movement is a drag
constexpr double kArrow = 0.03;        // drag of an arrow key, in heights of the window

}  // namespace

void Viewer::set_mode(MoveMode mode) {
  if (!navigator_->set_mode(mode, size())) return say("there is no ground to walk on here");
  if (mode == MoveMode::fly || mode == MoveMode::walk) say(fmt::format("{:.3g} m/s (wheel)", navigator_->speed()));
}

void Viewer::listen() {
  viewer::listen(glfw_->get(), {.event = [this](const WindowEvent& event) { note(event); },
                                .refreshed = [this] { redraws_ = kRedraws; },
                                .dropped = [this](const std::vector<std::string>& files) { open_files(files); },
                                .left = [this] { navigator_->release_keys(); }});
}

void Viewer::note(WindowEvent event) {
  event.seconds = seconds();
  timings_.event(generation_);
  if (!options_.record.empty()) recorded_.events.push_back(event);
  take(event);
}

void Viewer::take(const WindowEvent& event) {
  redraws_ = kRedraws;
  const ImGuiIO& io = ImGui::GetIO();
  switch (event.kind) {
    case WindowEvent::Kind::move: {
      const dvec2 to(event.x, event.y), drag = to - cursor_;
      cursor_ = to;
      if (dragging_ >= 0) take_drag(drag);
      return;
    }
    case WindowEvent::Kind::button:
      return take_button(event, io.WantCaptureMouse);
    case WindowEvent::Kind::wheel:
      if (!io.WantCaptureMouse) navigator_->wheel(event.y, pointed(), size());
      return;
    case WindowEvent::Kind::key:
      if (!io.WantTextInput || !event.down) take_key(event);
      return;
    case WindowEvent::Kind::text:
      return;
    case WindowEvent::Kind::option: {
      const std::size_t space = event.text.find(' ');
      const bool is_set = space != std::string::npos;
      return change({event.text.substr(0, space), is_set ? std::optional(event.text.substr(space + 1)) : std::nullopt});
    }
    case WindowEvent::Kind::compare:
      return compare(event.text);
  }
}

void Viewer::take_drag(const dvec2& drag) {
  way_ += std::hypot(drag.x, drag.y);
  if (dragging_ != GLFW_MOUSE_BUTTON_LEFT) return navigator_->shift(drag, size());
  switch (dragged_) {
    case Dragged::view:
      return navigator_->turn(drag, size());
    case Dragged::sun:
      return drag_sun(drag);
    case Dragged::line:
      line_.drag_to(pointed().x, size().x);
      show_sides();
  }
}

void Viewer::take_button(const WindowEvent& event, bool on_panel) {
  if (event.down) {
    panel_.keyboard = false;
    if (on_panel || dragging_ >= 0) return;
    dragging_ = event.code;
    dragged_ = compares() && line_.is_at(pointed(), size()) ? Dragged::line
               : (event.modifiers & GLFW_MOD_CONTROL) != 0  ? Dragged::sun
                                                            : Dragged::view;
    way_ = 0;
    return;
  }
  if (event.code != dragging_) return;
  dragging_ = -1;
  if (way_ > kClickPixels || event.code != GLFW_MOUSE_BUTTON_LEFT || dragged_ != Dragged::view) return;
  const double now = seconds();
  const std::optional<Reading> clicked = reading_at(pointed());
  if (panel_.measures) {
    if (clicked) measure(clicked->point);
  } else if (now - last_click_ < kDoubleClick) {
    if (clicked) navigator_->go_to(clicked->point);
  }
  last_click_ = now;
}

void Viewer::measure(const dvec3& point) {
  if (!line_from_) {
    line_from_ = point;
    return;
  }
  measure(*line_from_, point);
  line_from_.reset();
  panel_.measures = false;
  panel_.message = {};
  worked_ = true;
}

void Viewer::measure(const dvec3& from, const dvec3& to) {
  constexpr double kAbove = 1.7;  // metres, of eyes at both ends
  const cli::PreparedScene& prepared = subject_->prepared();
  panel_.line = measure_line(prepared.given_scene(), from, to, kAbove, prepared.exaggeration());
}

bool Viewer::panel_takes(int letter, int modifiers) {
  if (!panel_.keyboard) return false;
  switch (letter) {
    case GLFW_KEY_TAB:
      panel_.tabs = (modifiers & GLFW_MOD_SHIFT) != 0 ? -1 : 1;
      return true;
    case GLFW_KEY_ESCAPE:
      if (!panel_.lists_open) panel_.keyboard = false;
      return true;  // lists close themselves
    case GLFW_KEY_LEFT:
    case GLFW_KEY_RIGHT:
    case GLFW_KEY_UP:
    case GLFW_KEY_DOWN:
    case GLFW_KEY_SPACE:
    case GLFW_KEY_ENTER:
      return true;
    default:
      return false;
  }
}

void Viewer::take_key(const WindowEvent& event) {
  const int letter = event.letter != 0 ? event.letter : event.code;
  if (event.down && (event.modifiers & GLFW_MOD_CONTROL) != 0) {
    if (letter == GLFW_KEY_Q) return glfwSetWindowShouldClose(glfw_->get(), GLFW_TRUE);
    if (letter == GLFW_KEY_Z) return (event.modifiers & GLFW_MOD_SHIFT) != 0 ? redo() : undo();
    if (letter == GLFW_KEY_Y) return redo();
    const auto action = action_of(letter);
    if (action == WindowAction::nearer) return set_text(text_size_after(text_, 1));
    if (action == WindowAction::farther) return set_text(text_size_after(text_, -1));
  }
  if (event.down && panel_takes(letter, event.modifiers)) return;
  if (const auto key = move_key_of(event.code)) {
    navigator_->key(*key, event.down);
    // Some layouts have the letter of an action there.
    if (navigator_->moves_by_keys()) return;
  }
  if (!event.down) return;
  if (event.code >= GLFW_KEY_1 && event.code <= GLFW_KEY_9) {
    std::optional<Pose>& bookmark = bookmarks_[static_cast<std::size_t>(event.code - GLFW_KEY_1)];
    const int number = event.code - GLFW_KEY_0;
    if ((event.modifiers & GLFW_MOD_CONTROL) != 0) {
      bookmark = navigator_->pose();
      worked_ = true;
      say(fmt::format("the view is kept: {} returns to it", number));
    } else if (bookmark) {
      navigator_->set_pose(*bookmark);
    } else {
      say(fmt::format("no view is kept there (Ctrl {} keeps one)", number));
    }
    return;
  }
  if (const auto action = action_of(letter)) act(*action);
}

void Viewer::act(WindowAction action) {
  switch (action) {
    case WindowAction::orbit:
      return set_mode(MoveMode::orbit);
    case WindowAction::fly:
      return set_mode(MoveMode::fly);
    case WindowAction::walk:
      return set_mode(MoveMode::walk);
    case WindowAction::top:
      return set_mode(MoveMode::top);
    case WindowAction::first_view:
      return navigator_->set_pose(first_);
    case WindowAction::measure:
      panel_.measures = !panel_.measures;
      line_from_.reset();
      if (panel_.measures) say("click both ends of a line");
      return;
    case WindowAction::copy_reading:
      return copy_reading();
    case WindowAction::observe:
      return observe();
    case WindowAction::horizon:
      return toggle_horizon();
    case WindowAction::sun:
      return toggle_sun();
    case WindowAction::play_sun:
      sun_time_.plays = sun_clock_ && !sun_time_.plays;
      return;
    case WindowAction::full_screen:
      return glfw_->toggle_full_screen();
    case WindowAction::nearer:
      return navigator_->wheel(1, 0.5 * size(), size());
    case WindowAction::farther:
      return navigator_->wheel(-1, 0.5 * size(), size());
    case WindowAction::look_left:
      return navigator_->turn({kArrow * size().y, 0}, size());
    case WindowAction::look_right:
      return navigator_->turn({-kArrow * size().y, 0}, size());
    case WindowAction::look_up:
      return navigator_->turn({0, kArrow * size().y}, size());
    case WindowAction::look_down:
      return navigator_->turn({0, -kArrow * size().y}, size());
    case WindowAction::through_ground: {
      const bool keeps = !navigator_->keeps_above_ground();
      navigator_->keep_above_ground(keeps);
      return say(keeps ? "the eye stays above the ground" : "the eye goes through the ground");
    }
    case WindowAction::keep_in_path:
      return keep_in_path();
    case WindowAction::copy:
      return copy_command();
    case WindowAction::save:
      saves_ = true;
      save_line_ = played_line_;
      return;
    case WindowAction::panel:
      shows_panel_ = !shows_panel_;
      panel_.keyboard = false;
      return lay_out(imgui_->scale());
    case WindowAction::panel_keys:
      if (!shows_panel_) act(WindowAction::panel);
      panel_.keyboard = !panel_.keyboard;
      panel_.tabs = 1;
      if (panel_.keyboard) say("the panel has the keyboard: Tab goes on, Space changes, Esc goes back");
      return;
    case WindowAction::reopen:
      return reopen();
    case WindowAction::help:
      panel_.help = !panel_.help;
      return;
    case WindowAction::escape:
      return escape();
  }
}

// Ends the last thing that was begun. A window with work in it is not closed by mistake.
void Viewer::escape() {
  if (panel_.lists_open) {
    panel_.close_lists = true;
  } else if (panel_.measures || panel_.help) {
    panel_.measures = panel_.help = false;
  } else if (answers_->pinned()) {
    answers_->unpin();
    note_change();
  } else if (worked_) {
    say("Ctrl Q closes the window");
  } else {
    glfwSetWindowShouldClose(glfw_->get(), GLFW_TRUE);
  }
}

}  // namespace scarp::viewer
