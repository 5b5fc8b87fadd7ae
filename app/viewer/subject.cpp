// SPDX-License-Identifier: MIT
#include "app/viewer/subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/cli/options/device_option.h"
#include "app/viewer/film_size.h"
#include "scarp/base/error.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/voxel/voxel_table.h"

namespace scarp::viewer {
namespace {

constexpr int kJudgedRays = 1000;
constexpr ErrorSettings kOneCell{.tolerance = 1};

std::vector<std::string> marches_for(cli::InputKind kind) {
  std::vector<std::string> names;
  const auto add = [&](const auto& table) {
    for (const MarchEntry& march : table) names.emplace_back(march.name);
  };
  if (kind == cli::InputKind::terrain) add(height_marches());
  if (kind == cli::InputKind::function) add(function_marches());
  if (kind == cli::InputKind::voxels) add(voxel_marches());
  return names;
}

// Rays through pixels spread evenly over the picture: the additive recurrence R2, based on the plastic number.
std::vector<Ray> sampled_rays(const Camera& camera) {
  constexpr double kStepX = 0.75487766624669276, kStepY = 0.56984029099805327;
  std::vector<Ray> rays;
  for (int i = 0; i < kJudgedRays; ++i) {
    const double x = std::fmod(0.5 + i * kStepX, 1.0), y = std::fmod(0.5 + i * kStepY, 1.0);
    rays.push_back(camera.ray(std::floor(x * camera.size().x) + 0.5, std::floor(y * camera.size().y) + 0.5));
  }
  return rays;
}

}  // namespace

Subject::Subject(Opening opening, int width, int height)
    : width_(width),
      height_(height),
      main_(open(std::move(opening))),
      first_camera_(main_.opened->prepared.camera()),
      device_(prepared().there().device.empty() ? "the CPU" : prepared().there().device) {}

Subject::Side Subject::open(Opening opening) const {
  cli::RenderOptions options = *opening.options;
  const ImageSize film = film_size(options.picture, width_, height_);
  if (options.picture.width || entry_of(look_of(options.picture)).large_pixels)
    options.picture = for_window(options.picture, width_, height_);
  auto opened = std::make_shared<Opened>(opening.kind, std::move(options), film);
  opened->prepared.open();
  return side_by(opened, std::move(opening));
}

// The options of the opening then have the current values, for the controls.
Subject::Side Subject::side_by(const std::shared_ptr<Opened>& opened, Opening opening) {
  const cli::PreparedScene& prepared = opened->prepared;
  auto options = std::make_shared<const cli::RenderOptions>(*opening.options);
  PictureSettings settings = prepared.picture(*options, nullptr);
  opening.options->picture = merged(options->picture, prepared.input().subject.own);
  return {std::move(opening), opened, std::move(options), std::move(settings)};
}

Subject::Side Subject::side_of(Opening opening, const Side& like, const Side* or_like) const {
  const cli::InputRequest request = input_request(opening.kind, *opening.options);
  for (const Side* side : {&like, or_like}) {
    if (side && side->opened->prepared.serves(request)) return side_by(side->opened, std::move(opening));
  }
  return open(std::move(opening));
}

bool Subject::reopens(const OptionChange& change) const {
  const Opening next = changed(main_.opening, change);
  return !prepared().serves(input_request(next.kind, *next.options));
}

bool Subject::change(const OptionChange& change, bool goes_on) {
  if (std::find(cli::kWindowOptions.begin(), cli::kWindowOptions.end(), change.option) != cli::kWindowOptions.end()) {
    throw cli::WrongUsage(
        fmt::format("{}: takes effect only when the window opens (mouse and keys move its view)", change.option));
  }
  Given before = main_.opening.given;
  const bool again = take(changed(main_.opening, change));
  if (!goes_on || done_.empty()) done_.push_back(std::move(before));
  undone_.clear();
  return again;
}

std::optional<bool> Subject::go_back(std::vector<Given>& from, std::vector<Given>& to) {
  if (from.empty()) return {};
  Given now = main_.opening.given;
  const bool again = take(with_options(main_.opening, from.back()));
  from.pop_back();
  to.push_back(std::move(now));
  return again;
}

std::optional<bool> Subject::undo() { return go_back(done_, undone_); }
std::optional<bool> Subject::redo() { return go_back(undone_, done_); }

// Returns whether the input was reopened.
bool Subject::take(Opening opening) {
  Side main = side_of(std::move(opening), main_, nullptr);
  std::optional<Side> other = beside(main);
  const bool again = main.opened != main_.opened;
  main_ = std::move(main), other_ = std::move(other);
  return again;
}

void Subject::reopen() {
  Side main = open(main_.opening);
  std::optional<Side> other;
  if (!compared_.empty()) other = side_of(changed(main.opening, comparison()), main, nullptr);
  main_ = std::move(main), other_ = std::move(other);
}

std::vector<std::string> Subject::comparisons() const {
  std::vector<std::string> words;
  for (const std::string& march : marches_for(opening().kind)) words.push_back("march " + march);
  for (const LookEntry& look : looks()) {
    // Large pixels have a different size, and levels a number.
    if (!look.large_pixels && look.look != Look::level) words.push_back("look " + std::string(look.name));
  }
  return words;
}

// "--march", "naive" of "march naive".
OptionChange Subject::comparison() const {
  const std::size_t space = compared_.find(' ');
  return {"--" + compared_.substr(0, space), compared_.substr(space + 1)};
}

std::string Subject::comparable() const {
  if (compared_.starts_with("look")) return "look " + std::string(name_of(main_.options->picture.look));
  return "march " + prepared().given_scene().marches();
}

std::optional<Subject::Side> Subject::beside(const Side& main) const {
  if (compared_.empty()) return {};
  return side_of(changed(main.opening, comparison()), main, other_ ? &*other_ : nullptr);
}

void Subject::compare(const std::string& with) {
  std::string before = std::exchange(compared_, with);
  try {
    other_ = beside(main_);
  } catch (...) {
    compared_ = std::move(before);
    throw;
  }
}

// As in `scarp render`.
PictureSide Subject::picture_side(const Side& side, int width, int height) {
  auto shown = std::make_shared<cli::RenderOptions>(*side.options);
  shown->picture = for_window(shown->picture, width, height);
  const std::shared_ptr<const cli::RenderOptions> options = shown;
  PictureSide picture;
  picture.settings = side.opened->prepared.picture(*options, nullptr);
  picture.render = [opened = side.opened, options](const Camera& seen, const PictureSettings& asked,
                                                   const Progress& progress) {
    Camera camera = seen;
    cli::PreparedScene& prepared = opened->prepared;
    prepared.finish(camera, *options);
    PictureSettings settings = asked;
    settings.fog.visibility = prepared.picture(*options, &camera).fog.visibility;
    cli::look_through(prepared.there(), camera, entry_of(settings.look).antialiased ? settings.aa : 1);
    return render_picture(prepared.scene(), camera, settings, progress);
  };
  // Coarser voxels differ in every picture, and the look comanche has its own rays.
  if (side.opened->prepared.input().coarse_voxels || entry_of(picture.settings.look).large_pixels) return picture;
  picture.judge = [opened = side.opened, options](const Camera& seen,
                                                  const Progress& progress) -> std::optional<JudgedRays> {
    Camera camera = seen;
    cli::RenderOptions judged = *options;
    judged.picture.look = Look::error;  // rays end where the judge's rays end
    opened->prepared.finish(camera, judged);
    const Scene& scene = opened->prepared.scene();
    if (!opened->judges) opened->judges = scene.judge();
    if (opened->judges->marches() == scene.marches()) return {};
    return judge_rays(scene, *opened->judges, sampled_rays(camera), kOneCell, progress);
  };
  return picture;
}

std::vector<PictureSide> Subject::sides(int width, int height) const {
  std::vector<PictureSide> sides{picture_side(main_, width, height)};
  if (other_) sides.push_back(picture_side(*other_, width, height));
  return sides;
}

std::vector<JudgedPixel> Subject::judged(const Ray& ray) const {
  std::vector<JudgedPixel> pixels;
  for (const Side* side : {&main_, other_ ? &*other_ : nullptr}) {
    if (!side) continue;
    Opened& opened = *side->opened;
    if (opened.prepared.input().coarse_voxels || entry_of(side->settings.look).large_pixels) return {};
    const Scene& scene = opened.prepared.given_scene();
    try {
      if (!opened.pixel_judges) opened.pixel_judges = scene.judge();
      pixels.push_back(judge_pixel(scene, *opened.pixel_judges, ray, kOneCell));
    } catch (const Error&) {
      return {};
    }
  }
  return pixels;
}

std::vector<const Opening*> Subject::openings() const {
  std::vector<const Opening*> openings{&main_.opening};
  if (other_) openings.push_back(&other_->opening);
  return openings;
}

std::vector<Control> Subject::controls(const std::optional<StepScale>& steps) const {
  ControlScales scales;
  const cli::RenderInput& input = prepared().input();
  scales.exaggeration = prepared().exaggeration();
  scales.low = input.subject.heights.low / input.subject.exaggeration;
  scales.high = input.subject.heights.high / input.subject.exaggeration;
  if (input.subject.across > 0) scales.across = input.subject.across;
  if (steps) scales.steps_low = steps->low, scales.steps_high = steps->high;
  scales.marches = marches_for(opening().kind);
  scales.march = prepared().given_scene().marches();
  scales.own_water = input.subject.own.water_level.has_value();
  const PictureSettings& settings = main_.settings;
  scales.in_force = {{"--ramp", std::string(ramp_of(settings))},
                     {"--haze", fmt::format("{:.4g}", settings.haze)},
                     {"--detail", fmt::format("{:.4g}", settings.ground.detail)}};
  return controls_of(opening(), scales);
}

}  // namespace scarp::viewer
