// SPDX-License-Identifier: MIT
#include "scarp/render/look/error_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/march/function/function_exhaustive.h"
#include "scarp/render/film/middles.h"
#include "scarp/render/film/tile_work.h"
#include "scarp/render/light/light.h"
#include "scarp/render/look/judged_rays.h"
#include "scarp/render/surface/ramp.h"

namespace scarp {
namespace {

struct Style {
  std::string_view name, colour_name;
  vec3 srgb;
};

// In the order of Verdict.
constexpr std::array<Style, kVerdicts> kStyles{{
    {"right hit", "grey", {0.80f, 0.80f, 0.80f}},
    {"right miss", "dark grey", {0.16f, 0.16f, 0.16f}},
    {"lost", "red", {0.86f, 0.10f, 0.10f}},
    {"false", "magenta", {0.86f, 0.15f, 0.80f}},
    {"early", "blue", {0.15f, 0.40f, 0.92f}},
    {"late", "orange", {0.98f, 0.55f, 0.05f}},
    {"gave up", "yellow", {0.98f, 0.92f, 0.20f}},
    {"not judged", "brown", {0.30f, 0.25f, 0.22f}},
}};

const Style& style_of(Verdict verdict) { return kStyles[static_cast<std::size_t>(verdict)]; }

// A ray judged by `exhaustive` may take a millisecond; meanwhile the device and any request to stop must wait.
constexpr std::size_t kMostRays = kMostRaysOfRound;

}  // namespace

std::string_view name_of(Verdict verdict) { return style_of(verdict).name; }
std::string_view colour_name_of(Verdict verdict) { return style_of(verdict).colour_name; }
vec3 srgb_of(Verdict verdict) { return style_of(verdict).srgb; }

Verdict judge(const Hit& answer, const Hit& truth, double tolerance) {
  if (truth.status == HitStatus::below) return Verdict::not_judged;
  if (answer.status == HitStatus::exhausted) return Verdict::gave_up;
  if (!truth) return answer ? Verdict::false_hit : Verdict::right_miss;
  if (!answer) return Verdict::lost;
  if (std::abs(answer.t - truth.t) <= tolerance) return Verdict::right_hit;
  return answer.t < truth.t ? Verdict::early : Verdict::late;
}

double error_metres(Verdict verdict, const Ray& ray, const Hit& answer, const Hit& truth) {
  if (!has_metres(verdict)) return 0;
  const double t = verdict == Verdict::lost        ? truth.t
                   : verdict == Verdict::false_hit ? answer.t
                                                   : std::abs(answer.t - truth.t);
  return t * length(ray.direction);
}

std::vector<float> ErrorMap::metres_of(Verdict verdict) const {
  std::vector<float> chosen(metres.size(), 0.f);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (verdicts[i] == verdict) chosen[i] = metres[i];
  }
  return chosen;
}

namespace {

// Sums are in the order of the pixels, so that they do not depend on threads.
ErrorMetres summary_of(std::vector<float> metres) {
  ErrorMetres summary;
  if (metres.empty()) return summary;
  summary.mean = std::accumulate(metres.begin(), metres.end(), 0.0) / static_cast<double>(metres.size());
  const auto p99 = metres.begin() + static_cast<std::ptrdiff_t>((99 * metres.size() + 99) / 100 - 1);
  std::nth_element(metres.begin(), p99, metres.end());
  summary.p99 = static_cast<double>(*p99);
  summary.most = static_cast<double>(*std::max_element(p99, metres.end()));
  return summary;
}

ErrorMetres summary_of(const ErrorMap& map, Verdict verdict) {
  std::vector<float> metres;
  for (std::size_t i = 0; i < map.metres.size(); ++i) {
    if (map.verdicts[i] == verdict) metres.push_back(map.metres[i]);
  }
  return summary_of(std::move(metres));
}

constexpr int kProvenEvery = 8;  // in both directions

// Whether interval bisection contradicts the judge.
bool contradicts(const Hit& hit, const FunctionJudgement& judgement, const Ray& ray, double tolerance) {
  if (judgement.verdict == FunctionVerdict::clear) return static_cast<bool>(hit);
  if (judgement.verdict != FunctionVerdict::crossing) return false;
  // Any crossing within the tolerance is correct, and so is a point within the tolerance of a crossing.
  const double slack = tolerance * (judgement.crossed_by - ray.t_min);
  return !hit || hit.t > judgement.crossed_by + slack;
}

// The function of a scene of one function at the origin, else null.
const HeightFunction* only_function(const Scene& scene) {
  if (!scene.only_field()) return nullptr;
  const SceneFieldParts parts = scene.only_field()->parts();
  const auto* function = std::get_if<SceneFieldParts::Function>(&parts.of);
  return function ? function->field : nullptr;
}

// Counts of all tiles.
struct Tally {
  std::array<std::atomic<std::int64_t>, kVerdicts> pixels{};
  std::atomic<std::int64_t> proven = 0, contradictions = 0;
};

class ErrorTile final : public TileWork {
 public:
  ErrorTile(const Scene& judges, const Camera& camera, const PixelTile& tile, const ErrorSettings& settings,
            const Light& light, Tally& tally, ErrorPicture& picture)
      : judges_(judges),
        function_(only_function(judges)),
        camera_(camera),
        tile_(tile),
        settings_(settings),
        light_(light),
        tally_(tally),
        picture_(picture) {}

  bool next(RayRound& round) override {
    if (!asked_) {
      asked_ = true;
      round.question = RayRound::Question::closest;
      round.rays = rays_through_middles(camera_, tile_);
      round.from.clear();
      return true;
    }
    std::size_t i = 0;
    for (int y = tile_.y0; y < tile_.y1; ++y) {
      for (int x = tile_.x0; x < tile_.x1; ++x, ++i) judge_pixel(x, y, round.rays[i], round.hits[i]);
    }
    return false;
  }

 private:
  void judge_pixel(int x, int y, const Ray& ray, const Hit& answer) const {
    const Hit truth = judges_.closest_hit(ray);
    const Verdict verdict = judge(answer, truth, hit_tolerance(judges_, truth, settings_));
    ++tally_.pixels[static_cast<std::size_t>(verdict)];
    const auto pixel = static_cast<std::size_t>(std::int64_t{y} * picture_.image.width + x);
    picture_.map.verdicts[pixel] = verdict;
    picture_.map.metres[pixel] = static_cast<float>(error_metres(verdict, ray, answer, truth));
    vec3 colour = linear_from_srgb(style_of(verdict).srgb);
    // Shades the colours of surfaces without shadows, so that the relief shows where the errors are.
    if (truth) {
      const SceneSurface surface = judges_.surface(ray, truth);
      if (surface.normal != dvec3(0.0)) colour *= light_.on(surface.shading_normal, true);
    }
    set_pixel(picture_.image, x, y, colour);
    const bool chosen = x % kProvenEvery == kProvenEvery / 2 && y % kProvenEvery == kProvenEvery / 2;
    if (function_ && chosen && truth.status != HitStatus::below && std::isfinite(ray.t_max)) prove(ray, truth);
  }

  void prove(const Ray& ray, const Hit& truth) const {
    const FunctionJudgement judgement = judge_function(function_->function(), ray);
    tally_.proven += judgement.verdict != FunctionVerdict::undecided;
    tally_.contradictions += contradicts(truth, judgement, ray, LipschitzLocalSettings{}.tolerance);
  }

  const Scene& judges_;
  const HeightFunction* function_;
  const Camera& camera_;
  PixelTile tile_;
  const ErrorSettings& settings_;
  const Light& light_;
  Tally& tally_;
  ErrorPicture& picture_;
  bool asked_ = false;
};

}  // namespace

void validate(const ErrorSettings& settings) {
  const auto good = [](double x) { return std::isfinite(x) && x >= 0; };
  if (!good(settings.tolerance)) {
    throw Error(
        fmt::format("picture: the error tolerance is {} (must be 0 or more sides of a cell)", settings.tolerance));
  }
  if (!good(settings.share)) {
    throw Error(fmt::format("picture: the error tolerance is {} of the distance (must be 0 or more)", settings.share));
  }
}

ErrorPicture render_error(const Scene& scene, const Camera& camera, int width, int height,
                          const ErrorSettings& settings, const Progress& progress) {
  const Scene judges = scene.judge();
  const Light light(SunSettings{}, 0);
  ErrorPicture picture{Image(width, height), {}, {}};
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  picture.map.verdicts.resize(pixels), picture.map.metres.resize(pixels);
  picture.counts.judges = judges.marches();
  picture.counts.caveats = scene.caveats();
  picture.counts.tolerance_m = settings.tolerance * judges.cell_side();
  picture.counts.share = settings.share;
  Tally tally;
  work_on_tiles(
      scene, PixelTiles(width, height, 1), kMostRays,
      [&](const PixelTile& tile) {
        return std::make_unique<ErrorTile>(judges, camera, tile, settings, light, tally, picture);
      },
      progress);
  std::copy(tally.pixels.begin(), tally.pixels.end(), picture.counts.pixels.begin());
  for (int i = 0; i < kVerdicts; ++i) {
    if (const auto verdict = static_cast<Verdict>(i); has_metres(verdict))
      picture.counts.metres[static_cast<std::size_t>(i)] = summary_of(picture.map, verdict);
  }
  picture.counts.proven = tally.proven;
  picture.counts.contradictions = tally.contradictions;
  return picture;
}

}  // namespace scarp
