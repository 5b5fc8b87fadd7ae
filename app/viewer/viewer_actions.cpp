// SPDX-License-Identifier: MIT
// Changes of settings and inputs; what the window writes and says.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "app/viewer/view_output.h"
#include "app/viewer/viewer_window.h"
#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

constexpr double kErrorToast = 10;  // seconds that an error is over the picture
constexpr double kOneChange = 1;    // seconds between two movements of one slider

}  // namespace

// The movement of a slider is one change.
void Viewer::change(const OptionChange& change) {
  const bool goes_on = change.option == last_option_ && seconds() - last_change_ < kOneChange;
  last_option_ = change.option, last_change_ = seconds();
  worked_ = true;
  attempt([&] { return subject_->change(change, goes_on); });
}

void Viewer::undo() { go_back(&Subject::undo, "there is no change to take back"); }
void Viewer::redo() { go_back(&Subject::redo, "there is no change to make again"); }

void Viewer::go_back(std::optional<bool> (Subject::*way)(), const char* none) {
  last_option_.clear();
  bool found = true;
  attempt([&] {
    const std::optional<bool> again = ((*subject_).*way)();
    found = again.has_value();
    return again.value_or(false);
  });
  if (!found) say(none);
}

// Errors are shown when the change is made.
bool Viewer::reopens(const OptionChange& change) const {
  try {
    return subject_->reopens(change);
  } catch (const std::exception&) {
    return false;
  }
}

void Viewer::reopen() {
  attempt([&] {
    subject_->reopen();
    return true;
  });
}

// `changed` returns whether the input was reopened; the view stays.
void Viewer::attempt(const std::function<bool()>& changed) {
  const double height = subject_->prepared().exaggeration();
  const Pose pose = navigator_->pose();
  try {
    if (changed()) {
      navigate(subject_->first_camera());
      navigator_->set_pose(with_heights_times(pose, subject_->prepared().exaggeration() / height));
    }
    panel_.message = {};
  } catch (const std::exception& error) {
    fail(error.what(), played_line_);
  }
  note_change();
}

void Viewer::compare(const std::string& with) {
  try {
    subject_->compare(with);
  } catch (const std::exception& error) {
    fail(error.what(), played_line_);
  }
  note_change();
}

void Viewer::drag_sun(const dvec2& drag) {
  const SunSettings sun = subject_->settings().sun;
  const dvec2 to = dragged_sun({sun.azimuth_deg, sun.altitude_deg}, drag, size());
  change({"--sun", fmt::format("{:.2f},{:.2f}", to.x, to.y)});
}

// Switches to files that were dropped on the window, if they can be opened together.
void Viewer::open_files(const std::vector<std::string>& files) {
  redraws_ = kRedraws;
  try {
    auto subject = std::make_unique<Subject>(opening_of(files), area_.width, area_.height);
    keep_view();
    panel_.message = {};
    show_first_view(std::move(subject));
    glfwSetWindowTitle(glfw_->get(), title().c_str());
  } catch (const std::exception& error) {
    fail(error.what(), played_line_);
  }
}

void Viewer::say(const std::string& message) {
  panel_.message = {message, false, seconds() + kToast};
  redraws_ = kRedraws;
}

std::string Viewer::command(std::size_t side, const std::string& output) const {
  return render_command(*subject_->openings()[side], subject_->prepared().places(), navigator_->pose(), area_.width,
                        area_.height, output);
}

// The last good picture stays. `line` is the line of a recording that
// caused the error; 0: none. Recordings end there.
void Viewer::fail(const std::string& message, int line) {
  if (line > 0) throw Error(fmt::format("'{}', line {}: {}", options_.play, line, message));
  panel_.message = {message, true, seconds() + kErrorToast};
  redraws_ = kRedraws;
}

void Viewer::copy_reading() {
  const std::optional<Reading> reading = area_.contains(cursor_) ? reading_at(pointed()) : std::nullopt;
  if (!reading) return say("there is nothing under the cursor");
  glfwSetClipboardString(glfw_->get(), reading->place.c_str());
  say(reading->place);
  fmt::print("{}\n", reading->place);
  std::fflush(stdout);
}

// Saves the picture as the window shows it, with the names of its sides and the measured line, if anything is drawn
// over it. Returns the file's name.
std::string Viewer::save_drawn() {
  const bool drawn = compares() || panel_.line || answers_->pinned();
  Image seen;
  if (drawn) draw(&seen, true);
  if (seen.width != width_ || seen.height != height_) return {};
  Image part(area_.width, area_.height);
  for (int y = 0; y < part.height; ++y) {
    std::copy_n(seen.pixel(area_.left, y), std::ptrdiff_t{3} * part.width, part.pixel(0, y));
  }
  std::string name = save_numbered(part);
  fmt::print("{}: the picture with what is drawn over it in the window\n", name);
  return name;
}

// Maps by `scarp render` draw vectors: the measured line as one, with the command of the map.
void Viewer::save_line_of_map() {
  if (!panel_.line || !frames_->lonlat || navigator_->pose().mode != MoveMode::top) return;
  std::array<dvec3, 2> ends{panel_.line->from, panel_.line->to};
  if (frames_->lonlat->from_local(ends)) return;
  const std::string name = save_line({ends[0].x, ends[0].y}, {ends[1].x, ends[1].y});
  fmt::print("{}: {} --draw {}\n", name, command(0, "map.png"), name);
}

// Saves both sides if there are two.
void Viewer::save_picture() {
  saves_ = false;
  redraws_ = kRedraws;
  try {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < shown_->sides.size(); ++i) {
      const std::string name = save_numbered(shown_->sides[i].image);
      names.push_back(name);
      fmt::print("{}: {}\n", name, command(i, name));
      if (answers_->seen()) fmt::print("{}: shows the map of {}\n", name, answers_->commands().front());
    }
    if (std::string drawn = save_drawn(); !drawn.empty()) names.push_back(std::move(drawn));
    save_line_of_map();
    const std::string last = names.back();
    names.pop_back();
    say(names.empty() ? last + " is saved" : fmt::format("{} and {} are saved", fmt::join(names, ", "), last));
    std::fflush(stdout);
  } catch (const Error& error) {
    fail(error.what(), save_line_);
  }
}

void Viewer::copy_command() {
  if (const std::vector<std::string> commands = answer_commands(); !commands.empty()) {
    const std::string text = fmt::format("{}", fmt::join(commands, "\n"));
    glfwSetClipboardString(glfw_->get(), text.c_str());
    fmt::print("{}\n", text);
    std::fflush(stdout);
    return say(commands.size() > 1 ? "the commands of the answers are copied" : "the command of the answer is copied");
  }
  const bool two = subject_->openings().size() > 1;
  std::string text = command(0, two ? "left.png" : "picture.png");
  if (two) text += "\n" + command(1, "right.png");
  glfwSetClipboardString(glfw_->get(), text.c_str());
  say(two ? "the commands are copied" : "the command is copied");
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

void Viewer::keep_in_path() {
  try {
    if (path_.empty()) path_ = next_path();
    const Pose pose = navigator_->perspective(size());
    add_to_path(path_, pose);
    say(fmt::format("the view is in {}, for scarp render --path --fov {:.4g}", path_, pose.fov_deg));
  } catch (const Error& error) {
    fail(error.what(), played_line_);
  }
}

}  // namespace scarp::viewer
