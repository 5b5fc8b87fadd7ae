// SPDX-License-Identifier: MIT
// The window: it opens an input, takes events, asks the worker for pictures and shows them. Defined in parts:
// viewer.cpp has its life and its loop, viewer_events.cpp the mouse and the keys, viewer_actions.cpp settings and
// output.
#pragma once

#include <imgui.h>

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/file_watch.h"
#include "app/viewer/kept_view.h"
#include "app/viewer/keys.h"
#include "app/viewer/layout.h"
#include "app/viewer/map_answers.h"
#include "app/viewer/navigation.h"
#include "app/viewer/panel.h"
#include "app/viewer/picture_worker.h"
#include "app/viewer/presenter.h"
#include "app/viewer/reading.h"
#include "app/viewer/recording.h"
#include "app/viewer/split.h"
#include "app/viewer/subject.h"
#include "app/viewer/sun_clock.h"
#include "app/viewer/timings.h"
#include "app/viewer/window.h"

namespace scarp::viewer {

class Viewer {
 public:
  explicit Viewer(Opening opening);

  ~Viewer() { worker_.reset(); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  void run();

 private:
  static constexpr int kRedraws = 3;   // frames that Dear ImGui needs to settle after an event
  static constexpr double kToast = 3;  // seconds that a message is over the picture

  // The object that a drag with the left button moves.
  enum class Dragged { view, sun, line };

  std::string title() const;

  void show_first_view(std::unique_ptr<Subject> subject);
  std::string kept_file() const;
  void restore_view();
  void keep_view() const;
  void watch();
  void navigate(const Camera& first);
  void note_change();
  void describe();

  // --- settings -----------------------------------------------------------------------------------------------------

  // If it fails, for example because the file is gone, the window keeps its current state.
  void change(const OptionChange& change);
  bool reopens(const OptionChange& change) const;
  void undo();
  void redo();
  void go_back(std::optional<bool> (Subject::*way)(), const char* none);
  void reopen();
  void attempt(const std::function<bool()>& changed);
  void compare(const std::string& with);
  void drag_sun(const dvec2& drag);

  // --- events -------------------------------------------------------------------------------------------------------

  void listen();
  void note(WindowEvent event);

  double seconds() const;

  // The size of the picture.
  dvec2 size() const { return {static_cast<double>(area_.width), static_cast<double>(area_.height)}; }
  // The cursor in the picture.
  dvec2 pointed() const { return area_.in_picture(cursor_); }

  void take(const WindowEvent& event);
  void take_drag(const dvec2& drag);
  void take_button(const WindowEvent& event, bool on_panel);
  void measure(const dvec3& point);
  void measure(const dvec3& from, const dvec3& to);
  void take_key(const WindowEvent& event);
  void act(WindowAction action);

  void set_mode(MoveMode mode);
  // Whether the panel takes this key, while the keyboard is its own.
  bool panel_takes(int letter, int modifiers);

  void escape();

  // --- the loop -----------------------------------------------------------------------------------------------------

  void loop();
  void step(double now, double, double since);
  void ask(bool moving);
  void show(WorkedPicture worked);

  bool is_complete() const;
  std::optional<dvec3> ground_under_cursor() const;
  void observe();
  void take_answers();
  // `clean`: without panels.
  void draw_answers(bool clean);
  void draw_answer_panels(bool clean);
  void toggle_horizon();
  void toggle_sun();
  void move_sun(double seconds);
  void shine();
  std::vector<std::string> answer_commands() const;
  // Independent of the displayed picture, so recordings end at the same view regardless of rendering times.
  bool compares() const { return !subject_->compared().empty(); }

  void show_sides();
  void lay_out(double scale);
  void set_text(double size);
  std::optional<Reading> reading_at(const dvec2& at) const;
  // `clean`: without the panel and messages.
  void draw(Image* seen, bool clean = false);
  PanelActions draw_controls();
  void act(const PanelActions& actions);
  void open_files(const std::vector<std::string>& files);

  void say(const std::string& message);

  void fail(const std::string& message, int line);

  // --- output -------------------------------------------------------------------------------------------------------

  void save_picture();
  std::string save_drawn();
  void save_line_of_map();

  std::string command(std::size_t side, const std::string& output) const;

  void copy_command();
  void copy_reading();
  void keep_in_path();

  // --- recordings ---------------------------------------------------------------------------------------------------

  void play();
  void take_played(const WindowEvent& event);

  const cli::ViewOptions options_;  // of the window itself
  Timings timings_;
  int width_ = 0, height_ = 0;  // of the window
  WindowLayout area_;
  double text_ = 1;  // size of text
  std::optional<Recording> played_;
  std::array<bool, ImGuiMouseButton_COUNT> played_buttons_{};
  Recording recorded_;
  std::unique_ptr<Subject> subject_;
  std::unique_ptr<ReadingFrames> frames_;
  std::unique_ptr<Navigator> navigator_;
  Pose first_;
  std::array<std::optional<Pose>, 9> bookmarks_;
  std::string path_{};   // file that K adds to; empty: none yet
  bool worked_ = false;  // something would be lost with the window
  FileWatch watch_;      // of the input's files
  double watched_at_ = 0;
  std::string last_option_{};
  double last_change_ = 0;
  std::unique_ptr<Glfw> glfw_;
  std::unique_ptr<Imgui> imgui_;
  std::unique_ptr<Presenter> presenter_;
  PanelState panel_;
  std::optional<WorkedPicture> shown_;
  std::optional<WorkedVerdict> verdict_;
  std::optional<Camera> camera_;  // of the current view, at the window's size
  std::uint64_t generation_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double play_seconds_ = 0, changed_at_ = 0, drawn_at_ = -1, last_click_ = -1, way_ = 0;
  bool asked_rest_ = false, settings_changed_ = true, saves_ = false, shows_panel_ = true;
  bool render_failed_ = false;
  int played_line_ = 0, save_line_ = 0;  // lines of the recording: of the current event, and of the last P
  bool unpresented_ = false;             // shown_ is newer than what the window shows
  int redraws_ = kRedraws, dragging_ = -1;
  Dragged dragged_ = Dragged::view;
  SplitLine line_;
  dvec2 cursor_{-1.0};
  std::optional<dvec3> line_from_;
  std::unique_ptr<MapAnswers> answers_;
  std::optional<SunClock> sun_clock_{};  // while the sun of a date is shown
  SunTime sun_time_{};
  std::unique_ptr<PictureWorker> worker_;  // ends first
};

}  // namespace scarp::viewer
