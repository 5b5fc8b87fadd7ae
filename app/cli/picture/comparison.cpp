// SPDX-License-Identifier: MIT
#include "app/cli/picture/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/cli/picture/findings.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

// Steps per ray of labels that are not known yet.
constexpr double kUsualSteps = 1000;

std::vector<std::string> label_of(const std::string& march, double steps, std::int64_t lost, std::int64_t late) {
  return {march, fmt::format("{:.1f} steps per ray", steps), fmt::format("{} lost, {} late", lost, late)};
}

// The counts per ray of a picture, if it has any.
const std::optional<StepRange>& counts_of(const Picture& picture) {
  return picture.steps ? picture.steps : picture.cost;
}

}  // namespace

void check_comparison(const RenderOptions& options, const PictureFormat& format) {
  const std::vector<std::string>& marches = options.compared;
  if (marches.empty()) return;
  const std::string text = fmt::format("--compare '{}'", fmt::join(marches, ","));
  if (marches.size() < 2) throw Error(text + ": expected two or more marches, for example naive,max-mip");
  for (auto one = marches.begin(); one != marches.end(); ++one) {
    if (std::find(marches.begin(), one, *one) != one)
      throw Error(fmt::format("{}: names {} twice (leave one out)", text, *one));
  }
  if (!format.holds.empty()) {
    throw Error(fmt::format("--compare: {} files cannot hold its labels (name the output *.png)", format.name));
  }
#ifndef SCARP_CAIRO
  throw Error("--compare: this scarp was built without Cairo (SCARP_CAIRO=OFF)");
#endif
}

RenderOptions with_march(RenderOptions options, std::string_view march) {
  options.march = march;
  options.compared.clear();
  return options;
}

Comparison::Comparison(InputKind kind, PreparedScene& first, const std::vector<std::string>& marches) {
  if (marches.size() < 2) return;
  for (std::size_t i = 1; i < marches.size(); ++i)
    others_.push_back(std::make_unique<PreparedScene>(kind, with_march(first.options(), marches[i])));
  sides_.push_back({&first, marches.front()});
  for (std::size_t i = 1; i < marches.size(); ++i) sides_.push_back({others_[i - 1].get(), marches[i]});
}

void Comparison::open() {
  for (const auto& other : others_) other->open();
}

std::vector<FigureStrip> Comparison::blank_strips() const {
  std::vector<FigureStrip> strips;
  for (const Side& side : sides_) {
    const PictureSettings& settings = side.scene->picture();
    const std::int64_t pixels = std::int64_t{settings.width} * settings.height;
    strips.push_back({label_of(side.march, kUsualSteps, pixels, pixels)});
  }
  return strips;
}

std::vector<FigureStrip> Comparison::strips() const {
  std::vector<FigureStrip> strips;
  for (const Side& side : sides_) {
    const ErrorCounts& errors = *side.errors.errors;
    strips.push_back({label_of(side.march, side.steps.steps->mean, errors[Verdict::lost], errors[Verdict::late])});
  }
  return strips;
}

Picture Comparison::render(Side& side, const Camera& camera, const PictureRequest& request, std::string_view what) {
  RenderOptions options = side.scene->options();
  options.picture = request;
  Camera seen = camera;
  side.scene->finish(seen, options);
  const PictureSettings settings = side.scene->picture(options, &seen);
  look_through(side.scene->there(), seen, entry_of(settings.look).antialiased ? settings.aa : 1);
  return render_picture(side.scene->scene(), seen, settings, terminal_progress(fmt::format("{} {}", side.march, what)));
}

// Strips that show numbers have one scale, from the least of all marches to the most.
bool Comparison::share_scale(PictureRequest& request) const {
  std::optional<StepScale> steps;
  std::optional<ReliefRange> heights;
  const auto widen = [](auto& scale, double low, double high) {
    scale = {scale ? std::min(scale->low, low) : low, scale ? std::max(scale->high, high) : high};
  };
  for (const Side& side : sides_) {
    const Picture& picture = side.picture;
    if (const auto& counts = counts_of(picture)) widen(steps, counts->least, counts->most);
    if (picture.heights) widen(heights, picture.heights->low, picture.heights->high);
  }
  const bool by_steps = steps && steps->low < steps->high && !request.step_scale;
  const bool by_heights = heights && heights->low < heights->high && !request.ramp_range;
  if (by_steps) request.step_scale = steps;
  if (by_heights) request.ramp_range = heights;
  return by_steps || by_heights;
}

Picture Comparison::render(const Camera& camera) {
  const PictureRequest asked = sides_.front().scene->options().picture;
  const auto with = [&](Look look) {
    PictureRequest request = asked;
    request.look = look;
    return request;
  };
  for (Side& side : sides_) {
    const auto begin = std::chrono::steady_clock::now();
    side.picture = render(side, camera, asked, "render");
    side.render_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    side.steps = side.picture.steps ? side.picture : render(side, camera, with(Look::steps), "steps");
    side.errors = side.picture.errors ? side.picture : render(side, camera, with(Look::error), "errors");
  }
  if (PictureRequest shared = asked; share_scale(shared)) {
    for (Side& side : sides_) side.picture = render(side, camera, shared, "render");
  }
  return joined();
}

Picture Comparison::joined() const {
  Picture whole = sides_.front().picture;
  const auto count = static_cast<int>(sides_.size());
  std::vector<std::string> counted;  // "samples", "blocks and cells"
  if (const auto& counts = counts_of(whole)) counted.push_back(counts->of);
  for (int i = 1; i < count; ++i) {
    const Picture& picture = sides_[static_cast<std::size_t>(i)].picture;
    const int from = i * whole.image.width / count, to = (i + 1) * whole.image.width / count;
    for (int y = 0; y < whole.image.height; ++y)
      std::copy_n(picture.image.pixel(from, y), 3 * (to - from), whole.image.pixel(from, y));
    if (!whole.legend || !picture.legend) continue;
    if (const auto& counts = counts_of(picture);
        counts && std::find(counted.begin(), counted.end(), counts->of) == counted.end()) {
      counted.push_back(counts->of);
      whole.legend->title += ", " + counts->of;
    }
    for (const PictureLegend::Class& one : picture.legend->classes) {
      std::vector<PictureLegend::Class>& classes = whole.legend->classes;
      if (std::none_of(classes.begin(), classes.end(), [&](const auto& other) { return other.name == one.name; }))
        classes.push_back(one);
    }
  }
  return whole;
}

void Comparison::print() const {
  for (const Side& side : sides_) {
    const ErrorCounts& errors = *side.errors.errors;
    std::string wrong;
    for (const Verdict verdict : {Verdict::lost, Verdict::false_hit, Verdict::early, Verdict::late, Verdict::gave_up})
      wrong += fmt::format("{}{} {}", wrong.empty() ? "" : ", ", name_of(verdict), errors[verdict]);
    fmt::print("{}: {:.1f} steps per ray ({}); pixels: {}; build {:.2f} s, render {:.2f} s\n", side.march,
               side.steps.steps->mean, side.steps.steps->of, wrong, side.scene->build_seconds(), side.render_s);
  }
}

nlohmann::ordered_json Comparison::describe() const {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Side& side : sides_) {
    nlohmann::ordered_json one{{"march", side.march}};
    one["read_s"] = side.scene->read_seconds(), one["build_s"] = side.scene->build_seconds();
    one["render_s"] = side.render_s;
    for (const Picture* picture : {&side.steps, &side.errors, &side.picture}) one.update(describe_findings(*picture));
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace scarp::cli
