// SPDX-License-Identifier: MIT
// The pinned observer of the window: its events, its drawings over the picture, and its panel.
#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "app/viewer/answer_panels.h"
#include "app/viewer/observer_panel.h"
#include "app/viewer/viewer_window.h"
#include "scarp/base/error.h"

namespace scarp::viewer {

std::optional<dvec3> Viewer::ground_under_cursor() const {
  const std::optional<Reading> reading = area_.contains(cursor_) ? reading_at(pointed()) : std::nullopt;
  return reading ? std::optional(reading->point) : std::nullopt;
}

void Viewer::observe() {
  const std::optional<dvec3> ground = ground_under_cursor();
  if (!ground) return say("there is no ground under the cursor to stand on");
  try {
    answers_->pin(*ground);
    worked_ = true;
  } catch (const Error& error) {
    fail(error.what(), 0);
  }
}

void Viewer::take_answers() {
  try {
    if (answers_->deliver()) note_change();
    if (answers_->deliver_horizon()) redraws_ = kRedraws;
  } catch (const std::exception& error) {
    fail(error.what(), 0);
  }
}

void Viewer::toggle_horizon() {
  try {
    answers_->toggle_horizon();
  } catch (const Error& error) {
    fail(error.what(), 0);
  }
}

// Recordings have a day of their own.
void Viewer::toggle_sun() {
  if (sun_clock_) {
    sun_clock_.reset();
    sun_time_.plays = false;
    return;
  }
  namespace chrono = std::chrono;
  try {
    sun_clock_.emplace(subject_->opening());
  } catch (const Error& error) {
    return fail(error.what(), 0);
  }
  if (sun_time_.day == chrono::sys_days{})
    sun_time_.day = played_ ? chrono::sys_days(chrono::year(2026) / chrono::June / 21)
                            : chrono::floor<chrono::days>(chrono::system_clock::now());
  shine();
}

// Nights are passed over.
void Viewer::move_sun(double seconds) {
  if (!sun_clock_ || !sun_time_.plays || seconds == 0) return;
  constexpr int kSteps = 96;  // of a quarter of an hour each: a day
  const int before = static_cast<int>(sun_time_.minutes);
  sun_time_.advance(seconds);
  const auto is_night = [&] {
    return sun_clock_->at(sun_time_.day, static_cast<int>(sun_time_.minutes)).altitude <= 0;
  };
  for (int i = 0; i < kSteps && is_night(); ++i) sun_time_.advance(0.25);
  if (is_night()) sun_time_.plays = false;  // in winter near a pole
  if (static_cast<int>(sun_time_.minutes) != before) shine();
}

// Turns the sun of the picture to that of the time.
void Viewer::shine() {
  redraws_ = kRedraws;
  const SunPosition sun = sun_clock_->at(sun_time_.day, static_cast<int>(sun_time_.minutes));
  if (sun.altitude <= 0) return;
  const int line = std::exchange(played_line_, 0);  // a look without sunlight does not end a recording
  change({"--sun",
          fmt::format("{:.4f},{:.4f}", sun.azimuth * cli::kDegreesPerRadian, sun.altitude * cli::kDegreesPerRadian)});
  played_line_ = line;
  if (panel_.message.is_error) sun_time_.plays = false;
}

// The answers that are shown, each with its command.
std::vector<std::string> Viewer::answer_commands() const {
  std::vector<std::string> commands = answers_->commands();
  if (sun_clock_)
    commands.push_back(sun_clock_->command(sun_time_.day, static_cast<int>(sun_time_.minutes), "shadow.tif"));
  return commands;
}

void Viewer::draw_answer_panels(bool clean) {
  answers_->look_from(answers_->shows_horizon() ? ground_under_cursor() : std::nullopt);
  if (!shows_panel_ || clean) return;
  const float below = answers_->shows_horizon() ? draw_horizon(answers_->horizon()) : 0;
  if (!sun_clock_) return;
  const int minutes = static_cast<int>(sun_time_.minutes);
  const SunActions actions =
      draw_sun(sun_time_, sun_clock_->time_text(sun_time_.day, minutes), sun_clock_->at(sun_time_.day, minutes), below);
  if (actions.play) sun_time_.plays = !sun_time_.plays;
  try {
    if (actions.date) sun_time_.day = SunClock::day_of(*actions.date);
  } catch (const Error& error) {
    fail(error.what(), 0);
  }
  if (actions.minutes) sun_time_.minutes = *actions.minutes;
  if (actions.date || actions.minutes) shine();
}

void Viewer::draw_answers(bool clean) {
  draw_answer_panels(clean);
  if (!answers_->pinned()) return;
  constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255);
  const SightAnswer* const sight = answers_->sight_to(ground_under_cursor());
  if (camera_) {
    if (sight) draw_sight(*sight, subject_->prepared().given_scene(), *camera_, area_);
    draw_mark(answers_->place(), kWhite, *camera_, area_);
  }
  if (!shows_panel_ || clean) return;
  const ObserverActions actions = draw_observer(*answers_);
  if (actions.copy) copy_command();
  if (actions.remove) {
    answers_->unpin();
    note_change();
  } else if (actions.change) {
    try {
      answers_->set(*actions.change);
    } catch (const Error& error) {
      fail(error.what(), 0);
    }
  }
}

}  // namespace scarp::viewer
