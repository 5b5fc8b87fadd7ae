// SPDX-License-Identifier: MIT
#include "app/viewer/viewer.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <tuple>
#include <utility>

#include "app/cli/progress.h"
#include "app/cli/render_stage.h"
#include "app/viewer/kept_settings.h"
#include "app/viewer/navigation.h"
#include "app/viewer/panel.h"
#include "app/viewer/picture_worker.h"
#include "app/viewer/presenter.h"
#include "app/viewer/reading.h"
#include "app/viewer/recording.h"
#include "app/viewer/timings.h"
#include "app/viewer/view_output.h"
#include "app/viewer/window.h"
#include "scarp/base/error.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/height/height_table.h"
#include "scarp/output/png.h"

namespace scarp::viewer {
namespace {

constexpr double kRest = 0.15;          // seconds without a change until the picture is completed
constexpr double kDoubleClick = 0.35;   // seconds between two clicks
constexpr double kClickPixels = 4;      // a longer way is a drag
constexpr double kPlayStep = 1.0 / 60;  // seconds of a recording's own time per step
constexpr double kSignalWait = 0.5;     // seconds between two looks for Ctrl-C
constexpr int kRedraws = 3;             // frames that Dear ImGui needs to come to rest after an event
constexpr int kBookmarks = 9;

std::vector<std::string> marches_for(cli::InputKind kind) {
  std::vector<std::string> names;
  if (kind == cli::InputKind::terrain) {
    for (const HeightMarchEntry& march : height_marches()) names.emplace_back(march.name);
  } else if (kind == cli::InputKind::function) {
    for (const FunctionMarchEntry& march : function_marches()) names.emplace_back(march.name);
  }
  return names;
}

class Viewer {
 public:
  explicit Viewer(Opening opening)
      : opening_(std::move(opening)), options_(*opening_.options), timings_(options_.timings) {
    if (!options_.play.empty()) played_ = read_recording(options_.play);
    if (played_) {
      width_ = played_->width, height_ = played_->height;
    } else {
      const KeptSettings kept = read_settings(settings_file());
      const bool typed = !options_.size.empty();
      width_ = typed ? options_.picture.width : kept.width;
      height_ = typed ? options_.picture.height : kept.height;
      shows_panel_ = kept.panel;
    }
    settle(open_stage(opening_));
    glfw_ = std::make_unique<Glfw>(width_, height_, title());
    if (!played_) listen();
    imgui_ = std::make_unique<Imgui>(glfw_->get(), !played_);
    presenter_ = std::make_unique<Presenter>(glfw_->get(), options_.window_device, options_.validation);
    start_worker();
    describe_input();
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
    const auto& inputs = opening_.options->inputs;
    return inputs.empty() ? "Scarp" : std::filesystem::path(inputs.front()).filename().string() + " - Scarp";
  }

  std::unique_ptr<cli::RenderStage> open_stage(const Opening& opening) const {
    cli::RenderOptions options = *opening.options;
    options.picture.width = width_, options.picture.height = height_;
    auto stage = std::make_unique<cli::RenderStage>(opening.kind, std::move(options), opening.view);
    stage->open();
    return stage;
  }

  // Goes over to another input, from its first view, without a worker. If this throws, nothing has changed.
  void settle(std::unique_ptr<cli::RenderStage> stage) {
    const Camera first = stage->camera();
    auto frames = std::make_unique<ReadingFrames>(stage->input().raster);
    // Rays of single points are the CPU's.
    auto navigator =
        std::make_unique<Navigator>(stage->given_scene(), first, stage->input().view.fov_deg, stage->input().across);
    worker_.reset();
    navigator_ = std::move(navigator), frames_ = std::move(frames), stage_ = std::move(stage);
    settings_ = stage_->picture();
    first_ = navigator_->pose();
    camera_.reset();
    line_from_.reset();
    settings_changed_ = true;
    // Generations begin again.
    generation_ = 0;
    if (shown_) shown_->generation = 0;
  }

  void describe_input() {
    panel_.marches = marches_for(opening_.kind);
    panel_.march = std::string(cli::march_of(*opening_.options, opening_.kind));
    panel_.parameters = parameters_of(opening_, panel_.march);
    panel_.device = stage_->there().device.empty() ? "the CPU" : stage_->there().device;
  }

  // As `scarp render` makes the picture of this camera.
  void start_worker() {
    worker_ = std::make_unique<PictureWorker>(
        [this](const Camera& seen, const PictureSettings& asked, const Progress& progress) {
          Camera camera = seen;
          PictureSettings settings = asked;
          stage_->finish(camera);
          cli::see_from_afar(stage_->options().look_options, stage_->scene_box(), camera, settings);
          cli::look_through(stage_->there(), camera, settings.look == Look::shaded ? settings.aa : 1);
          return render_picture(stage_->scene(), camera, settings, progress);
        },
        [] { glfwPostEmptyEvent(); });
  }

  // --- events -------------------------------------------------------------------------------------------------------

  void listen() {
    GLFWwindow* const window = glfw_->get();
    glfwSetWindowUserPointer(window, this);
    const auto of = [](GLFWwindow* from) { return static_cast<Viewer*>(glfwGetWindowUserPointer(from)); };
    static const auto self = of;
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
      self(w)->note({.kind = WindowEvent::Kind::move, .x = x, .y = y});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int modifiers) {
      self(w)->note(
          {.kind = WindowEvent::Kind::button, .code = button, .down = action == GLFW_PRESS, .modifiers = modifiers});
    });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
      if (action != GLFW_REPEAT)
        self(w)->note(
            {.kind = WindowEvent::Kind::key, .code = key, .down = action == GLFW_PRESS, .modifiers = modifiers});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
      self(w)->note({.kind = WindowEvent::Kind::wheel, .x = x, .y = y});
    });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { self(w)->redraws_ = kRedraws; });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** files) {
      if (count > 0) self(w)->open_file(files[0]);
    });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
      if (!focused) self(w)->navigator_->release_keys();
    });
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
        if (dragging_ < 0) return;
        way_ += std::hypot(drag.x, drag.y);
        if (dragging_ == GLFW_MOUSE_BUTTON_LEFT) {
          navigator_->turn(drag, size());
        } else {
          navigator_->shift(drag, size());
        }
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
    }
  }

  void take_button(const WindowEvent& event, bool on_panel) {
    if (event.down) {
      if (on_panel || dragging_ >= 0) return;
      dragging_ = event.code;
      way_ = 0;
      return;
    }
    if (event.code != dragging_) return;
    dragging_ = -1;
    if (way_ > kClickPixels || event.code != GLFW_MOUSE_BUTTON_LEFT) return;
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
    panel_.line = measure_line(stage_->given_scene(), *line_from_, point, kAbove, stage_->exaggeration());
    line_from_.reset();
    panel_.measures = false;
  }

  void take_key(const WindowEvent& event) {
    const auto move = [&](MoveKey key) { navigator_->key(key, event.down); };
    switch (event.code) {
      case GLFW_KEY_W:
        return move(MoveKey::forward);
      case GLFW_KEY_S:
        return move(MoveKey::back);
      case GLFW_KEY_A:
        return move(MoveKey::left);
      case GLFW_KEY_D:
        return move(MoveKey::right);
      case GLFW_KEY_E:
        return move(MoveKey::up);
      case GLFW_KEY_Q:
        return move(MoveKey::down);
      case GLFW_KEY_LEFT_SHIFT:
      case GLFW_KEY_RIGHT_SHIFT:
        return move(MoveKey::fast);
      default:
        break;
    }
    if (!event.down) return;
    if (event.code >= GLFW_KEY_1 && event.code < GLFW_KEY_1 + kBookmarks) {
      std::optional<Pose>& bookmark = bookmarks_[static_cast<std::size_t>(event.code - GLFW_KEY_1)];
      if ((event.modifiers & GLFW_MOD_CONTROL) != 0) {
        bookmark = navigator_->pose();
      } else if (bookmark) {
        navigator_->set_pose(*bookmark);
      }
      return;
    }
    switch (event.code) {
      case GLFW_KEY_O:
        return navigator_->set_mode(MoveMode::orbit);
      case GLFW_KEY_F:
        return navigator_->set_mode(MoveMode::fly);
      case GLFW_KEY_G:
        return navigator_->set_mode(MoveMode::walk);
      case GLFW_KEY_T:
        return navigator_->set_mode(MoveMode::top);
      case GLFW_KEY_H:
        return navigator_->set_pose(first_);
      case GLFW_KEY_M:
        panel_.measures = !panel_.measures;
        line_from_.reset();
        return;
      case GLFW_KEY_K:
        return keep_in_path();
      case GLFW_KEY_C:
        return copy_command();
      case GLFW_KEY_P:
        saves_ = true;
        return;
      case GLFW_KEY_TAB:
        shows_panel_ = !shows_panel_;
        return;
      case GLFW_KEY_F5:
        return reopen();
      case GLFW_KEY_F1:
        panel_.help = !panel_.help;
        return;
      case GLFW_KEY_ESCAPE:
        if (panel_.measures || panel_.help) {
          panel_.measures = panel_.help = false;
        } else {
          glfwSetWindowShouldClose(glfw_->get(), GLFW_TRUE);
        }
        return;
      default:
        return;
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
      // New pictures at once. The rest of the window changes no faster than they do: a present by a CPU driver takes
      // the processors from the worker.
      const double wait = drawn_at_ + 1 / PictureWorker::kFramesPerSecond - now;
      if (redraws_ > 0 && (unpresented_ || wait <= 0)) {
        --redraws_;
        drawn_at_ = now;
        draw(nullptr);
      } else if (redraws_ > 0) {
        glfwWaitEventsTimeout(wait);
      } else if (!asked_rest_) {
        // Until the view counts as being at rest.
        glfwWaitEventsTimeout(kRest / 4);
      }
    }
  }

  // The view after `since` more seconds: asks for pictures, takes them.
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
  }

  void ask(bool moving) {
    PictureSettings settings = settings_;
    settings.width = width_, settings.height = height_;
    // A copy: the navigator moves on.
    const Navigator there = *navigator_;
    generation_ =
        worker_->request({[there](int width, int height) { return there.camera(width, height); }, settings, moving});
    camera_ = navigator_->camera(width_, height_);
  }

  void show(WorkedPicture worked) {
    redraws_ = kRedraws;
    if (!worked.error.empty()) {
      fail(worked.error);
      render_failed_ = worked.generation == generation_;
      return;
    }
    render_failed_ = false;
    presenter_->set_image(worked.picture.image);
    shown_ = std::move(worked);
    unpresented_ = true;
    if (saves_ && shown_->stage == PictureStage::converged && shown_->generation == generation_) save_picture();
  }

  std::optional<Reading> reading_at(const dvec2& at) const {
    if (!camera_) return {};
    try {
      return read_under(stage_->given_scene(), *camera_, at, *frames_, stage_->exaggeration());
    } catch (const Error&) {
      return {};  // fields that the device alone answers
    }
  }

  void draw(Image* seen) {
    presenter_->begin_frame();
    ImGui_ImplGlfw_NewFrame();
    if (played_) {
      ImGuiIO& io = ImGui::GetIO();
      io.DeltaTime = static_cast<float>(kPlayStep);
      io.MousePos = {static_cast<float>(cursor_.x), static_cast<float>(cursor_.y)};
    }
    ImGui::NewFrame();
    PanelActions actions;
    if (shows_panel_) {
      panel_.picture = &settings_;
      panel_.mode = navigator_->pose().mode;
      panel_.speed = navigator_->speed();
      panel_.shown = shown_ ? &*shown_ : nullptr;
      panel_.times = !played_;  // no two runs take as long
      panel_.busy = worker_->busy();
      panel_.reading = reading_at(cursor_);
      actions = draw_panel(panel_);
    }
    ImGui::Render();
    if (presenter_->present(seen)) {
      if (std::exchange(unpresented_, false)) timings_.present(*shown_);
    } else if (int across = 0, down = 0; glfwGetFramebufferSize(glfw_->get(), &across, &down), across > 0 && down > 0) {
      redraws_ = kRedraws;  // again: the size changed meanwhile
    }
    act(actions);
  }

  void act(const PanelActions& actions) {
    settings_changed_ |= actions.picture_changed;
    if (actions.mode) navigator_->set_mode(*actions.mode);
    if (actions.copy) copy_command();
    if (actions.save) saves_ = true;
    if (saves_ && shown_ && shown_->stage == PictureStage::converged && shown_->generation == generation_)
      save_picture();
    if (actions.march) opening_.options->march = *actions.march;
    if (actions.march || actions.parameter_changed) reopen();
  }

  // Opens the input again, as with other settings of the march. View and look stay. If it fails, as when the file is
  // gone, the window goes on with what it has.
  void reopen() {
    try {
      auto stage = open_stage(opening_);
      const Pose pose = navigator_->pose();
      const PictureSettings kept = settings_;
      settle(std::move(stage));
      settings_ = kept;
      navigator_->set_pose(pose);
      start_worker();
      marched_ = {opening_.options->march, opening_.options->march_settings};
    } catch (const std::exception& error) {
      fail(error.what());
      std::tie(opening_.options->march, opening_.options->march_settings) = marched_;
    }
    describe_input();
  }

  // Goes over to a file that was dropped on the window, if it can be opened.
  void open_file(const std::string& file) {
    redraws_ = kRedraws;
    try {
      Opening opening = opening_of(file);
      auto stage = open_stage(opening);
      settle(std::move(stage));
      opening_ = std::move(opening);
      marched_ = {opening_.options->march, opening_.options->march_settings};
      bookmarks_ = {};
      panel_.line.reset();
      panel_.message.clear();
      start_worker();
      describe_input();
      glfwSetWindowTitle(glfw_->get(), title().c_str());
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }

  // Errors are seen even if the panel was hidden; the last good picture stays.
  void fail(const std::string& message) {
    panel_.message = message;
    shows_panel_ = true;
    redraws_ = kRedraws;
  }

  // --- what leaves the window ---------------------------------------------------------------------------------------

  void save_picture() {
    saves_ = false;
    redraws_ = kRedraws;
    try {
      const std::string name = save_numbered(shown_->picture.image);
      panel_.message = name + " is saved";
      fmt::print("{}: {}\n", name, command(name));
      std::fflush(stdout);
    } catch (const Error& error) {
      fail(error.what());
    }
  }

  std::string command(const std::string& output) const {
    PictureSettings picture = settings_;
    picture.width = width_, picture.height = height_;
    return render_command(*opening_.options, navigator_->pose(), picture, output) +
           parameter_words(opening_, panel_.march);
  }

  void copy_command() {
    const std::string text = command("picture.png");
    glfwSetClipboardString(glfw_->get(), text.c_str());
    panel_.message = "the command is copied";
    fmt::print("{}\n", text);
    std::fflush(stdout);
  }

  void keep_in_path() {
    try {
      panel_.message = "the view is in " + add_to_path(navigator_->pose());
    } catch (const Error& error) {
      fail(error.what());
    }
  }

  // --- recordings ---------------------------------------------------------------------------------------------------

  // Steps of one length, whatever the time they take; then the picture is waited for.
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
    const auto is_complete = [&] {
      return shown_ && shown_->generation == generation_ && shown_->stage == PictureStage::converged &&
             !worker_->busy();
    };
    while (!is_complete() || saves_) {
      glfwWaitEventsTimeout(kRest);
      if (cli::caught_signal() != 0) throw Interrupted();
      play_seconds_ += kPlayStep;
      step(play_seconds_, kPlayStep, kPlayStep);
      draw(nullptr);
      if (render_failed_ && !worker_->busy()) throw Error(panel_.message);
    }
    Image seen;
    for (int i = 0; i < kRedraws; ++i) draw(&seen);
    if (!options_.screenshot.empty()) write_png(options_.screenshot, {seen.rgb.data(), seen.width, seen.height});
  }

  void take_played(const WindowEvent& event) {
    ImGuiIO& io = ImGui::GetIO();
    if (event.kind == WindowEvent::Kind::button && event.code >= 0 && event.code < IM_ARRAYSIZE(io.MouseDown))
      io.MouseDown[event.code] = event.down;
    take(event);
  }

  Opening opening_;
  const cli::ViewOptions options_;  // of the window itself
  Timings timings_;
  int width_ = 0, height_ = 0;
  std::optional<Recording> played_;
  Recording recorded_;
  std::unique_ptr<cli::RenderStage> stage_;
  std::pair<std::string, MarchSettings> marched_{opening_.options->march,
                                                 opening_.options->march_settings};  // by stage_
  std::unique_ptr<ReadingFrames> frames_;
  PictureSettings settings_;  // of the converged picture, as the panel has them
  std::unique_ptr<Navigator> navigator_;
  Pose first_;
  std::array<std::optional<Pose>, kBookmarks> bookmarks_;
  std::unique_ptr<Glfw> glfw_;
  std::unique_ptr<Imgui> imgui_;
  std::unique_ptr<Presenter> presenter_;
  PanelState panel_{nullptr};
  std::optional<WorkedPicture> shown_;
  std::optional<Camera> camera_;  // of the view as it is, at the window's size
  std::uint64_t generation_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double play_seconds_ = 0, changed_at_ = 0, drawn_at_ = -1, last_click_ = -1, way_ = 0;
  bool asked_rest_ = false, settings_changed_ = true, saves_ = false, shows_panel_ = true;
  bool render_failed_ = false;
  bool unpresented_ = false;  // shown_ is newer than what the window shows
  int redraws_ = kRedraws, dragging_ = -1;
  dvec2 cursor_{-1.0};
  std::optional<dvec3> line_from_;
  std::unique_ptr<PictureWorker> worker_;  // ends first
};

}  // namespace

void run_viewer(Opening opening) { Viewer(std::move(opening)).run(); }

}  // namespace scarp::viewer
