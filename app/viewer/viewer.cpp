// SPDX-License-Identifier: MIT
#include "app/viewer/viewer.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "app/cli/progress.h"
#include "app/viewer/film_size.h"
#include "app/viewer/kept_settings.h"
#include "app/viewer/viewer_window.h"
#include "scarp/base/error.h"
#include "scarp/output/png.h"

namespace scarp::viewer {
namespace {

constexpr double kRest = 0.15;          // seconds without a change until the picture is completed
constexpr double kPlayStep = 1.0 / 60;  // seconds of a recording's own time per step
constexpr double kSignalWait = 0.5;     // seconds between two checks for Ctrl-C
constexpr double kWatch = 0.5;          // seconds between two looks at the input's files
constexpr std::array<const char*, 6> kCameraOptions = {"--view", "--eye", "--eye-above", "--target", "--top", "--area"};

constexpr int kFirstWidth = 1280, kFirstHeight = 720;  // pixels at a scale of 1

// The size of a window that has not been used before: it fits on the screen.
ImageSize first_size(const Glfw::Screen& screen) {
  const auto side = [&](int pixels, int most) {
    const auto scaled = static_cast<int>(pixels * screen.scale);
    return most > 0 ? std::min(scaled, most) : scaled;
  };
  return {side(kFirstWidth, screen.width), side(kFirstHeight, screen.height)};
}

}  // namespace

Viewer::Viewer(Opening opening) : options_(*opening.options), timings_(options_.timings) {
  const Glfw::Screen screen = Glfw::screen();
  if (!options_.play.empty()) played_ = read_recording(options_.play);
  if (played_) {
    width_ = played_->width, height_ = played_->height;
  } else {
    const KeptSettings kept = read_settings(settings_file());
    const ImageSize first = kept.width > 0 ? ImageSize{kept.width, kept.height} : first_size(screen);
    const ImageSize size = window_size(options_.picture).value_or(first);
    width_ = size.width, height_ = size.height;
    shows_panel_ = kept.panel;
    text_ = kept.text;
  }
  answers_ = std::make_unique<MapAnswers>([] { glfwPostEmptyEvent(); });
  lay_out(screen.scale * text_);
  show_first_view(std::make_unique<Subject>(std::move(opening), area_.width, area_.height));
  glfw_ = std::make_unique<Glfw>(width_, height_, title());
  if (!played_) listen();
  imgui_ = std::make_unique<Imgui>(glfw_->get(), !played_, text_);
  panel_.reopens = [this](const OptionChange& change) { return reopens(change); };
  presenter_ = std::make_unique<Presenter>(glfw_->get(), options_.window_device, options_.validation);
  lay_out(imgui_->scale());
  worker_ = std::make_unique<PictureWorker>([] { glfwPostEmptyEvent(); });
}

void Viewer::run() {
  if (played_) {
    play();
  } else {
    loop();
    keep_view();
    write_settings(settings_file(), {width_, height_, shows_panel_, text_});
  }
  worker_.reset();
  if (!options_.record.empty()) {
    recorded_.width = width_, recorded_.height = height_;
    write_recording(options_.record, recorded_);
  }
  const int objections = presenter_->objections();
  if (objections > 0) throw Error(fmt::format("--validation: {} objections", objections));
}

std::string Viewer::title() const {
  const auto& inputs = subject_->opening().options->inputs;
  return inputs.empty() ? "Scarp" : std::filesystem::path(inputs.front()).filename().string() + " - Scarp";
}

// Switches to another input, at its first view.
void Viewer::show_first_view(std::unique_ptr<Subject> subject) {
  std::swap(subject_, subject);  // the previous one lives until nothing refers to it
  answers_->unpin();
  sun_clock_.reset();
  navigate(subject_->first_camera());
  first_ = navigator_->pose();
  bookmarks_ = {};
  path_.clear();
  panel_.line.reset();
  worked_ = false;
  watch_ = FileWatch(subject_->opening().options->inputs);
  if (!played_) restore_view();
}

std::string Viewer::kept_file() const { return view_file(settings_file(), subject_->opening().options->inputs); }

// Shows what the last window on this input showed, unless a view was asked for.
void Viewer::restore_view() {
  const KeptView kept = read_view(kept_file());
  const double exaggeration = subject_->prepared().exaggeration();
  const auto here = [&](const Pose& pose) { return with_heights_times(pose, exaggeration); };
  for (std::size_t i = 0; i < bookmarks_.size(); ++i) {
    if (kept.bookmarks[i]) bookmarks_[i] = here(*kept.bookmarks[i]);
  }
  if (kept.line) {
    const dvec3 scale(1, 1, exaggeration);
    measure(scale * kept.line->first, scale * kept.line->second);
  }
  const cli::Command& command = subject_->opening().command();
  const bool asked = std::any_of(kCameraOptions.begin(), kCameraOptions.end(),
                                 [&](const char* option) { return command.given(option); });
  if (!kept.pose || asked) return;
  navigator_->set_pose(here(*kept.pose));
  say("the view of the last time (H: the first view)");
}

void Viewer::keep_view() const {
  const double exaggeration = subject_->prepared().exaggeration();
  const auto kept = [&](const Pose& pose) { return with_heights_times(pose, 1 / exaggeration); };
  KeptView view;
  view.pose = kept(navigator_->pose());
  for (std::size_t i = 0; i < bookmarks_.size(); ++i) {
    if (bookmarks_[i]) view.bookmarks[i] = kept(*bookmarks_[i]);
  }
  const dvec3 scale(1, 1, 1 / exaggeration);
  if (panel_.line) view.line = {scale * panel_.line->from, scale * panel_.line->to};
  write_view(kept_file(), view);
}

// Opens the input again after its files were written.
void Viewer::watch() {
  const double now = seconds();
  if (now - watched_at_ < kWatch) return;
  watched_at_ = now;
  if (!watch_.changed()) return;
  reopen();
  if (!panel_.message.is_error) say("the input has changed and was opened again");
}

void Viewer::navigate(const Camera& first) {
  const cli::RenderInput& input = subject_->prepared().input();
  // The CPU traces single rays.
  const bool above = !navigator_ || navigator_->keeps_above_ground();
  navigator_ = std::make_unique<Navigator>(subject_->prepared().given_scene(), first,
                                           subject_->prepared().view().fov_deg, input.subject.across);
  navigator_->keep_above_ground(above);
  frames_ = std::make_unique<ReadingFrames>(input.raster);
  answers_->follow(*subject_);
  camera_.reset();
  line_from_.reset();
  note_change();
}

// The picture and the panel have changed.
void Viewer::note_change() {
  settings_changed_ = true;
  redraws_ = kRedraws;
  describe();
}

void Viewer::describe() {
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

// --- the loop

double Viewer::seconds() const {
  return played_ ? play_seconds_ : std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

bool Viewer::is_complete() const {
  return shown_ && shown_->pass == PicturePass::converged && shown_->generation == generation_ && !settings_changed_ &&
         !answers_->busy();
}

void Viewer::loop() {
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
    watch();
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
void Viewer::step(double now, double, double since) {
  int across = 0, down = 0;
  glfwGetFramebufferSize(glfw_->get(), &across, &down);
  take_answers();
  move_sun(since);
  const bool resized = across > 0 && down > 0 && (across != width_ || down != height_) && !played_;
  if (resized) {
    width_ = across, height_ = down;
    lay_out(imgui_->scale());
  }
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

void Viewer::ask(bool moving) {
  // A copy: the navigator moves on.
  const Navigator there = *navigator_;
  std::vector<PictureSide> sides = subject_->sides(area_.width, area_.height);
  for (PictureSide& side : sides) answers_->paint(side.settings);
  generation_ = worker_->request(
      {[there](int width, int height) { return there.camera(width, height); }, std::move(sides), moving, !moving});
  camera_ = navigator_->camera(area_.width, area_.height);
}

void Viewer::show(WorkedPicture worked) {
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

void Viewer::show_sides() {
  if (!shown_) return;
  std::vector<Image> images;
  for (const Picture& side : shown_->sides) {
    // Large pixels keep sharp edges; a picture next to them has a different size.
    images.push_back(shown_->large_pixels ? stretched(side.image, area_.width, area_.height) : side.image);
  }
  if (images.size() > 1) {
    presenter_->set_image(split_image(images[0], images[1], line_.column(images[0].width)));
  } else {
    presenter_->set_image(images[0]);
  }
}

// The picture and the panel change their places; the old picture is stretched until there is one of the new size.
void Viewer::lay_out(double scale) {
  area_ = layout_of(width_, height_, shows_panel_, scale);
  if (presenter_) presenter_->set_left(area_.left);
  settings_changed_ = true;
}

void Viewer::set_text(double size) {
  text_ = size;
  imgui_->set_text(size);
  lay_out(imgui_->scale());
  say(fmt::format("text of {:.0f} %", 100 * size));
}

std::optional<Reading> Viewer::reading_at(const dvec2& at) const {
  if (!camera_) return {};
  const cli::PreparedScene& prepared = subject_->prepared();
  try {
    return read_under(prepared.given_scene(), *camera_, at, *frames_, prepared.exaggeration());
  } catch (const Error&) {
    return {};  // fields available only on the device
  }
}

PanelActions Viewer::draw_controls() {
  panel_.mode = navigator_->pose().mode;
  panel_.speed = navigator_->speed();
  panel_.fov_deg = navigator_->pose().fov_deg;
  panel_.first_fov_deg = first_.fov_deg;
  panel_.text = text_;
  panel_.shown = shown_ ? &*shown_ : nullptr;
  panel_.verdict = verdict_ && verdict_->generation == generation_ ? &*verdict_ : nullptr;
  panel_.times = !played_;  // times differ from run to run
  panel_.busy = worker_->busy();
  const bool inside = camera_ && area_.contains(cursor_) && !ImGui::GetIO().WantCaptureMouse;
  panel_.reading = inside ? reading_at(pointed()) : std::nullopt;
  // Where a march finds nothing, too: that may be its error.
  panel_.pixel = inside ? subject_->judged(camera_->ray(pointed().x, pointed().y)) : std::vector<JudgedPixel>{};
  return draw_panel(panel_, area_);
}

void Viewer::draw(Image* seen, bool clean) {
  presenter_->begin_frame();
  ImGui_ImplGlfw_NewFrame();
  if (played_) {
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = static_cast<float>(kPlayStep);
    io.MousePos = {static_cast<float>(cursor_.x), static_cast<float>(cursor_.y)};
    std::copy(played_buttons_.begin(), played_buttons_.end(), std::begin(io.MouseDown));
  }
  let_panel_have_keys(panel_);
  ImGui::NewFrame();
  if (panel_.line && camera_)
    draw_measured(*panel_.line, subject_->prepared().given_scene(), *camera_, subject_->prepared().exaggeration(),
                  area_);
  draw_answers(clean);
  if (compares()) draw_split(area_.left + line_.share() * area_.width, panel_.names);
  PanelActions actions;
  if (shows_panel_ && !clean) actions = draw_controls();
  if (!clean && !panel_.message.text.empty() && seconds() < panel_.message.until) draw_toast(panel_.message, area_);
  panel_.lists_open = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  ImGui::Render();
  if (presenter_->present(seen)) {
    if (std::exchange(unpresented_, false)) timings_.present(*shown_);
  } else if (int across = 0, down = 0; glfwGetFramebufferSize(glfw_->get(), &across, &down), across > 0 && down > 0) {
    redraws_ = kRedraws;  // again: the size changed meanwhile
  }
  if (!clean) act(actions);
}

void Viewer::act(const PanelActions& actions) {
  if (actions.text) set_text(*actions.text);
  if (actions.mode) set_mode(*actions.mode);
  if (actions.fov_deg) navigator_->set_fov(*actions.fov_deg);
  if (!actions.error.empty()) fail(actions.error, 0);
  if (actions.copy) copy_command();
  if (actions.save) saves_ = true, save_line_ = 0;
  if (saves_ && is_complete()) save_picture();
  if (actions.change) change(*actions.change);
  if (actions.compare) compare(*actions.compare);
}

// --- recordings

// Plays steps of constant recorded length, however long they take; then waits for the picture.
void Viewer::play() {
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
  navigator_->release_keys();  // a key that is still held would move the view for ever
  sun_time_.plays = false;
  while (!is_complete() || saves_ || worker_->busy() || answers_->busy()) {
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

void Viewer::take_played(const WindowEvent& event) {
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

void run_viewer(Opening opening) { Viewer(std::move(opening)).run(); }

}  // namespace scarp::viewer
