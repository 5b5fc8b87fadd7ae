// SPDX-License-Identifier: MIT
#include "app/viewer/viewer.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include "app/cli/progress.h"
#include "app/viewer/film_size.h"
#include "app/viewer/kept_settings.h"
#include "app/viewer/keys.h"
#include "app/viewer/navigation.h"
#include "app/viewer/panel.h"
#include "app/viewer/picture_worker.h"
#include "app/viewer/presenter.h"
#include "app/viewer/reading.h"
#include "app/viewer/recording.h"
#include "app/viewer/split.h"
#include "app/viewer/subject.h"
#include "app/viewer/timings.h"
#include "app/viewer/view_output.h"
#include "app/viewer/window.h"
#include "scarp/base/error.h"
#include "scarp/output/png.h"

namespace scarp::viewer {
namespace {

constexpr double kRest = 0.15;          // seconds without a change until the picture is completed
constexpr double kDoubleClick = 0.35;   // seconds between two clicks
constexpr double kClickPixels = 4;      // a longer movement is a drag
constexpr double kPlayStep = 1.0 / 60;  // seconds of a recording's own time per step
constexpr double kSignalWait = 0.5;     // seconds between two checks for Ctrl-C
constexpr int kRedraws = 3;             // frames that Dear ImGui needs to settle after an event
constexpr int kBookmarks = 9;
constexpr double kToast = 3, kErrorToast = 10;  // seconds that a message is over the picture

// The object that a drag with the left button moves.
enum class Dragged { view, sun, line };

class Viewer {
 public:
  explicit Viewer(Opening opening) : options_(*opening.options), timings_(options_.timings) {
    if (!options_.play.empty()) played_ = read_recording(options_.play);
    if (played_) {
      width_ = played_->width, height_ = played_->height;
    } else {
      const KeptSettings kept = read_settings(settings_file());
      const ImageSize size = window_size(options_.picture).value_or(ImageSize{kept.width, kept.height});
      width_ = size.width, height_ = size.height;
      shows_panel_ = kept.panel;
    }
    show_first_view(std::make_unique<Subject>(std::move(opening), width_, height_));
    glfw_ = std::make_unique<Glfw>(width_, height_, title());
    if (!played_) listen();
    imgui_ = std::make_unique<Imgui>(glfw_->get(), !played_);
    panel_.reopens = [this](const OptionChange& change) { return reopens(change); };
    presenter_ = std::make_unique<Presenter>(glfw_->get(), options_.window_device, options_.validation);
    worker_ = std::make_unique<PictureWorker>([] { glfwPostEmptyEvent(); });
  }

  ~Viewer() { worker_.reset(); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void run() {
    if (played_) {
      play();
    } else {
      loop();
      write_settings(settings_file(), {width_, height_, shows_panel_});
    }
    worker_.reset();
    if (!options_.record.empty()) {
      recorded_.width = width_, recorded_.height = height_;
      write_recording(options_.record, recorded_);
    }
    const int objections = presenter_->objections();
    if (objections > 0) throw Error(fmt::format("--validation: {} objections", objections));
  }

 private:
  std::string title() const {
    const auto& inputs = subject_->opening().options->inputs;
    return inputs.empty() ? "Scarp" : std::filesystem::path(inputs.front()).filename().string() + " - Scarp";
  }

  // Switches to another input, at its first view.
  void show_first_view(std::unique_ptr<Subject> subject) {
    std::swap(subject_, subject);  // the previous one lives until nothing refers to it
    navigate(subject_->first_camera());
    first_ = navigator_->pose();
  }

  void navigate(const Camera& first) {
    const cli::RenderInput& input = subject_->prepared().input();
    // The CPU traces single rays.
    navigator_ = std::make_unique<Navigator>(subject_->prepared().given_scene(), first,
                                             subject_->prepared().view().fov_deg, input.subject.across);
    frames_ = std::make_unique<ReadingFrames>(input.raster);
    camera_.reset();
    line_from_.reset();
    note_change();
  }

  // The picture and the panel have changed.
  void note_change() {
    settings_changed_ = true;
    redraws_ = kRedraws;
    describe();
  }

  void describe() {
    std::optional<StepScale> scale;
    if (shown_ && !shown_->sides.empty()) {
      const Picture& first = shown_->sides.front();
      if (const auto& counts = first.steps ? first.steps : first.cost) scale = counts->scale;
    }
    panel_.controls = subject_->controls(scale);
    panel_.comparisons = subject_->comparisons();
    panel_.compared = subject_->compared();
    panel_.device = subject_->device();
    panel_.names = {subject_->comparable(), subject_->compared()};
  }

  // --- settings -----------------------------------------------------------------------------------------------------

  // If it fails, for example because the file is gone, the window keeps its current state.
  void change(const OptionChange& change) {
    worked_ = true;
    attempt([&] { return subject_->change(change); });
  }
  // Errors are shown when the change is made.
  bool reopens(const OptionChange& change) const {
    try {
      return subject_->reopens(change);
    } catch (const std::exception&) {
      return false;
    }
  }
  void reopen() {
    attempt([&] {
      subject_->reopen();
      return true;
    });
  }
  // `changed` returns whether the input was reopened; the view stays.
  void attempt(const std::function<bool()>& changed) {
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

  void compare(const std::string& with) {
    try {
      subject_->compare(with);
    } catch (const std::exception& error) {
      fail(error.what(), played_line_);
    }
    note_change();
  }

  void drag_sun(const dvec2& drag) {
    const SunSettings sun = subject_->settings().sun;
    const dvec2 to = dragged_sun({sun.azimuth_deg, sun.altitude_deg}, drag, size());
    change({"--sun", fmt::format("{:.2f},{:.2f}", to.x, to.y)});
  }

  // --- events -------------------------------------------------------------------------------------------------------

  void listen() {
    viewer::listen(glfw_->get(), {.event = [this](const WindowEvent& event) { note(event); },
                                  .refreshed = [this] { redraws_ = kRedraws; },
                                  .dropped = [this](const std::vector<std::string>& files) { open_files(files); },
                                  .left = [this] { navigator_->release_keys(); }});
  }

  void note(WindowEvent event) {
    event.seconds = seconds();
    timings_.event(generation_);
    if (!options_.record.empty()) recorded_.events.push_back(event);
    take(event);
  }

  double seconds() const {
    return played_ ? play_seconds_ : std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

  dvec2 size() const { return {static_cast<double>(width_), static_cast<double>(height_)}; }

  void take(const WindowEvent& event) {
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
        if (!io.WantCaptureMouse) navigator_->wheel(event.y, cursor_, size());
        return;
      case WindowEvent::Kind::key:
        if (!io.WantTextInput || !event.down) take_key(event);
        return;
      case WindowEvent::Kind::text:
        return;
      case WindowEvent::Kind::option: {
        const std::size_t space = event.text.find(' ');
        const bool is_set = space != std::string::npos;
        return change(
            {event.text.substr(0, space), is_set ? std::optional(event.text.substr(space + 1)) : std::nullopt});
      }
      case WindowEvent::Kind::compare:
        return compare(event.text);
    }
  }

  void take_drag(const dvec2& drag) {
    way_ += std::hypot(drag.x, drag.y);
    if (dragging_ != GLFW_MOUSE_BUTTON_LEFT) return navigator_->shift(drag, size());
    switch (dragged_) {
      case Dragged::view:
        return navigator_->turn(drag, size());
      case Dragged::sun:
        return drag_sun(drag);
      case Dragged::line:
        line_.drag_to(cursor_.x, size().x);
        show_sides();
    }
  }

  void take_button(const WindowEvent& event, bool on_panel) {
    if (event.down) {
      if (on_panel || dragging_ >= 0) return;
      dragging_ = event.code;
      dragged_ = compares() && line_.is_at(cursor_, size())  ? Dragged::line
                 : (event.modifiers & GLFW_MOD_CONTROL) != 0 ? Dragged::sun
                                                             : Dragged::view;
      way_ = 0;
      return;
    }
    if (event.code != dragging_) return;
    dragging_ = -1;
    if (way_ > kClickPixels || event.code != GLFW_MOUSE_BUTTON_LEFT || dragged_ != Dragged::view) return;
    const double now = seconds();
    const std::optional<Reading> clicked = reading_at(cursor_);
    if (panel_.measures) {
      if (clicked) measure(clicked->point);
    } else if (now - last_click_ < kDoubleClick) {
      if (clicked) navigator_->go_to(clicked->point);
    }
    last_click_ = now;
  }

  void measure(const dvec3& point) {
    if (!line_from_) {
      line_from_ = point;
      return;
    }
    constexpr double kAbove = 1.7;  // metres, of eyes at both ends
    const cli::PreparedScene& prepared = subject_->prepared();
    panel_.line = measure_line(prepared.given_scene(), *line_from_, point, kAbove, prepared.exaggeration());
    line_from_.reset();
    panel_.measures = false;
    worked_ = true;
  }

  void take_key(const WindowEvent& event) {
    const int letter = event.letter != 0 ? event.letter : event.code;
    if (event.down && letter == GLFW_KEY_Q && (event.modifiers & GLFW_MOD_CONTROL) != 0)
      return glfwSetWindowShouldClose(glfw_->get(), GLFW_TRUE);
    if (const auto key = move_key_of(event.code)) {
      navigator_->key(*key, event.down);
      // Some layouts have the letter of an action there.
      if (navigator_->moves_by_keys()) return;
    }
    if (!event.down) return;
    if (event.code >= GLFW_KEY_1 && event.code < GLFW_KEY_1 + kBookmarks) {
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

  void act(WindowAction action) {
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

  void set_mode(MoveMode mode) {
    if (!navigator_->set_mode(mode, size())) return say("there is no ground to walk on here");
    if (mode == MoveMode::fly || mode == MoveMode::walk) say(fmt::format("{:.3g} m/s (wheel)", navigator_->speed()));
  }

  // Ends the last thing that was begun. A window with work in it is not closed by mistake.
  void escape() {
    if (panel_.lists_open) {
      panel_.close_lists = true;
    } else if (panel_.measures || panel_.help) {
      panel_.measures = panel_.help = false;
    } else if (worked_) {
      say("Ctrl Q closes the window");
    } else {
      glfwSetWindowShouldClose(glfw_->get(), GLFW_TRUE);
    }
  }

  // --- the loop -----------------------------------------------------------------------------------------------------

  void loop() {
    begin_ = std::chrono::steady_clock::now();
    double before = seconds();
    while (!glfwWindowShouldClose(glfw_->get())) {
      const bool waits = redraws_ == 0 && !navigator_->moving() && asked_rest_;
      if (waits) {
        glfwWaitEventsTimeout(kSignalWait);
      } else {
        glfwPollEvents();
      }
      if (cli::caught_signal() != 0) throw Interrupted();
      const double now = seconds();
      step(now, now - before, waits ? 0.0 : now - before);
      before = now;
      // Shows new pictures immediately. The rest of the window is not updated more often than pictures: presenting with
      // a CPU driver takes processor time from the worker.
      const double wait = drawn_at_ + 1 / PictureWorker::kFramesPerSecond - now;
      if (redraws_ > 0 && (unpresented_ || wait <= 0)) {
        --redraws_;
        drawn_at_ = now;
        draw(nullptr);
      } else if (redraws_ > 0) {
        glfwWaitEventsTimeout(wait);
      } else if (!asked_rest_) {
        // Waits until the view counts as being at rest.
        glfwWaitEventsTimeout(kRest / 4);
      }
    }
  }

  // Advances the view by `since` seconds: requests pictures, and takes finished ones.
  void step(double now, double, double since) {
    int across = 0, down = 0;
    glfwGetFramebufferSize(glfw_->get(), &across, &down);
    const bool resized = across > 0 && down > 0 && (across != width_ || down != height_) && !played_;
    if (resized) width_ = across, height_ = down;
    if (navigator_->advance(since) || settings_changed_ || resized) {
      settings_changed_ = false;
      changed_at_ = now;
      asked_rest_ = false;
      redraws_ = kRedraws;
      ask(true);
    } else if (!asked_rest_ && now - changed_at_ > kRest) {
      asked_rest_ = true;
      ask(false);
    }
    if (auto worked = worker_->take()) show(std::move(*worked));
    if (auto verdict = worker_->take_verdict()) {
      verdict_ = std::move(verdict);
      redraws_ = kRedraws;
    }
  }

  void ask(bool moving) {
    // A copy: the navigator moves on.
    const Navigator there = *navigator_;
    generation_ = worker_->request({[there](int width, int height) { return there.camera(width, height); },
                                    subject_->sides(width_, height_), moving});
    camera_ = navigator_->camera(width_, height_);
  }

  void show(WorkedPicture worked) {
    redraws_ = kRedraws;
    if (!worked.error.empty()) {
      fail(worked.error, 0);
      render_failed_ = worked.generation == generation_;
      return;
    }
    render_failed_ = false;
    shown_ = std::move(worked);
    unpresented_ = true;
    show_sides();
    // The panel shows the range of the picture's counts.
    if (const Look look = subject_->settings().look; is_complete() && (look == Look::steps || look == Look::cost))
      describe();
    if (saves_ && is_complete()) save_picture();
  }

  bool is_complete() const {
    return shown_ && shown_->pass == PicturePass::converged && shown_->generation == generation_;
  }
  // Independent of the displayed picture, so recordings end at the same view regardless of rendering times.
  bool compares() const { return !subject_->compared().empty(); }

  void show_sides() {
    if (!shown_) return;
    std::vector<Image> images;
    for (const Picture& side : shown_->sides) {
      // Large pixels keep sharp edges; a picture next to them has a different size.
      images.push_back(shown_->large_pixels ? stretched(side.image, width_, height_) : side.image);
    }
    if (images.size() > 1) {
      presenter_->set_image(split_image(images[0], images[1], line_.column(images[0].width)));
    } else {
      presenter_->set_image(images[0]);
    }
  }

  std::optional<Reading> reading_at(const dvec2& at) const {
    if (!camera_) return {};
    const cli::PreparedScene& prepared = subject_->prepared();
    try {
      return read_under(prepared.given_scene(), *camera_, at, *frames_, prepared.exaggeration());
    } catch (const Error&) {
      return {};  // fields available only on the device
    }
  }

  void draw(Image* seen) {
    presenter_->begin_frame();
    ImGui_ImplGlfw_NewFrame();
    if (played_) {
      ImGuiIO& io = ImGui::GetIO();
      io.DeltaTime = static_cast<float>(kPlayStep);
      io.MousePos = {static_cast<float>(cursor_.x), static_cast<float>(cursor_.y)};
      std::copy(played_buttons_.begin(), played_buttons_.end(), std::begin(io.MouseDown));
    }
    ImGui::NewFrame();
    if (compares()) draw_split(line_.share() * ImGui::GetIO().DisplaySize.x, panel_.names);
    PanelActions actions;
    if (shows_panel_) {
      panel_.mode = navigator_->pose().mode;
      panel_.speed = navigator_->speed();
      panel_.fov_deg = navigator_->pose().fov_deg;
      panel_.shown = shown_ ? &*shown_ : nullptr;
      panel_.verdict = verdict_ && verdict_->generation == generation_ ? &*verdict_ : nullptr;
      panel_.times = !played_;  // times differ from run to run
      panel_.busy = worker_->busy();
      panel_.reading = reading_at(cursor_);
      actions = draw_panel(panel_);
    }
    if (!panel_.message.text.empty() && seconds() < panel_.message.until) draw_toast(panel_.message);
    panel_.lists_open = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    ImGui::Render();
    if (presenter_->present(seen)) {
      if (std::exchange(unpresented_, false)) timings_.present(*shown_);
    } else if (int across = 0, down = 0; glfwGetFramebufferSize(glfw_->get(), &across, &down), across > 0 && down > 0) {
      redraws_ = kRedraws;  // again: the size changed meanwhile
    }
    act(actions);
  }

  void act(const PanelActions& actions) {
    if (actions.mode) set_mode(*actions.mode);
    if (actions.fov_deg) navigator_->set_fov(*actions.fov_deg);
    if (!actions.error.empty()) fail(actions.error, 0);
    if (actions.copy) copy_command();
    if (actions.save) saves_ = true, save_line_ = 0;
    if (saves_ && is_complete()) save_picture();
    if (actions.change) change(*actions.change);
    if (actions.compare) compare(*actions.compare);
  }

  // Switches to files that were dropped on the window, if they can be opened together.
  void open_files(const std::vector<std::string>& files) {
    redraws_ = kRedraws;
    try {
      show_first_view(std::make_unique<Subject>(opening_of(files), width_, height_));
      bookmarks_ = {};
      path_.clear();
      worked_ = false;
      panel_.line.reset();
      panel_.message = {};
      glfwSetWindowTitle(glfw_->get(), title().c_str());
    } catch (const std::exception& error) {
      fail(error.what(), played_line_);
    }
  }

  void say(const std::string& message) {
    panel_.message = {message, false, seconds() + kToast};
    redraws_ = kRedraws;
  }

  // The last good picture stays. `line` is the line of a recording that
  // caused the error; 0: none. Recordings end there.
  void fail(const std::string& message, int line) {
    if (line > 0) throw Error(fmt::format("'{}', line {}: {}", options_.play, line, message));
    panel_.message = {message, true, seconds() + kErrorToast};
    redraws_ = kRedraws;
  }

  // --- output -------------------------------------------------------------------------------------------------------

  // Saves both sides if there are two.
  void save_picture() {
    saves_ = false;
    redraws_ = kRedraws;
    try {
      std::string names;
      for (std::size_t i = 0; i < shown_->sides.size(); ++i) {
        const std::string name = save_numbered(shown_->sides[i].image);
        names += (names.empty() ? "" : " and ") + name;
        fmt::print("{}: {}\n", name, command(i, name));
      }
      say(names + (shown_->sides.size() > 1 ? " are saved" : " is saved"));
      std::fflush(stdout);
    } catch (const Error& error) {
      fail(error.what(), save_line_);
    }
  }

  std::string command(std::size_t side, const std::string& output) const {
    return render_command(*subject_->openings()[side], subject_->prepared().places(), navigator_->pose(), width_,
                          height_, output);
  }

  void copy_command() {
    const bool two = subject_->openings().size() > 1;
    std::string text = command(0, two ? "left.png" : "picture.png");
    if (two) text += "\n" + command(1, "right.png");
    glfwSetClipboardString(glfw_->get(), text.c_str());
    say(two ? "the commands are copied" : "the command is copied");
    fmt::print("{}\n", text);
    std::fflush(stdout);
  }

  void keep_in_path() {
    try {
      if (path_.empty()) path_ = next_path();
      const Pose pose = navigator_->perspective(size());
      add_to_path(path_, pose);
      say(fmt::format("the view is in {}, for scarp render --path --fov {:.4g}", path_, pose.fov_deg));
    } catch (const Error& error) {
      fail(error.what(), played_line_);
    }
  }

  // --- recordings ---------------------------------------------------------------------------------------------------

  // Plays steps of constant recorded length, however long they take; then waits for the picture.
  void play() {
    const std::vector<WindowEvent>& events = played_->events;
    std::size_t next = 0;
    const double end = (events.empty() ? 0 : events.back().seconds) + 2 * kRest;
    for (int i = 0; play_seconds_ < end; ++i) {
      play_seconds_ = i * kPlayStep;
      glfwPollEvents();
      if (cli::caught_signal() != 0) throw Interrupted();
      while (next < events.size() && events[next].seconds <= play_seconds_) take_played(events[next++]);
      step(play_seconds_, kPlayStep, kPlayStep);
      draw(nullptr);
    }
    while (!is_complete() || saves_ || worker_->busy()) {
      glfwWaitEventsTimeout(kRest);
      if (cli::caught_signal() != 0) throw Interrupted();
      play_seconds_ += kPlayStep;
      step(play_seconds_, kPlayStep, kPlayStep);
      draw(nullptr);
      if (render_failed_ && !worker_->busy()) throw Error(panel_.message.text);
    }
    step(play_seconds_, kPlayStep, 0);  // takes the verdict, which the worker produces last
    if (!panel_.message.is_error) play_seconds_ += kToast;
    Image seen;
    for (int i = 0; i < kRedraws; ++i) draw(&seen);
    if (!options_.screenshot.empty()) write_png(options_.screenshot, {seen.rgb.data(), seen.width, seen.height});
  }

  void take_played(const WindowEvent& event) {
    ImGuiIO& io = ImGui::GetIO();
    if (event.kind == WindowEvent::Kind::button && event.code >= 0 && event.code < ImGuiMouseButton_COUNT)
      played_buttons_[static_cast<std::size_t>(event.code)] = event.down;
    // A drag or a click may have had no effect when it was recorded.
    if (event.kind == WindowEvent::Kind::key && event.code >= 0 && event.code < IM_ARRAYSIZE(io.KeysDown)) {
      io.KeysDown[event.code] = event.down;
      io.KeyCtrl = (event.modifiers & GLFW_MOD_CONTROL) != 0, io.KeyShift = (event.modifiers & GLFW_MOD_SHIFT) != 0;
    }
    if (event.kind == WindowEvent::Kind::text) io.AddInputCharactersUTF8(event.text.c_str());
    const bool may_fail = event.kind == WindowEvent::Kind::move || event.kind == WindowEvent::Kind::button;
    played_line_ = may_fail ? 0 : event.line;
    take(event);
    played_line_ = 0;
  }

  const cli::ViewOptions options_;  // of the window itself
  Timings timings_;
  int width_ = 0, height_ = 0;
  std::optional<Recording> played_;
  std::array<bool, ImGuiMouseButton_COUNT> played_buttons_{};
  Recording recorded_;
  std::unique_ptr<Subject> subject_;
  std::unique_ptr<ReadingFrames> frames_;
  std::unique_ptr<Navigator> navigator_;
  Pose first_;
  std::array<std::optional<Pose>, kBookmarks> bookmarks_;
  std::string path_{};   // file that K adds to; empty: none yet
  bool worked_ = false;  // something would be lost with the window
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
  std::unique_ptr<PictureWorker> worker_;  // ends first
};

}  // namespace

void run_viewer(Opening opening) { Viewer(std::move(opening)).run(); }

}  // namespace scarp::viewer
