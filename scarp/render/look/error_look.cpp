// SPDX-License-Identifier: MIT
#include "scarp/render/look/error_look.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "scarp/march/height/wall.h"
#include "scarp/render/frame/sight.h"
#include "scarp/render/frame/tile_work.h"
#include "scarp/render/light/light.h"
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
    {"invented", "magenta", {0.86f, 0.15f, 0.80f}},
    {"early", "blue", {0.15f, 0.40f, 0.92f}},
    {"late", "orange", {0.98f, 0.55f, 0.05f}},
    {"gave up", "yellow", {0.98f, 0.92f, 0.20f}},
    {"not judged", "brown", {0.30f, 0.25f, 0.22f}},
}};

const Style& style_of(Verdict verdict) { return kStyles[static_cast<std::size_t>(verdict)]; }

// A ray judged by `exhaustive` may take a millisecond: a device waits for the judge, and so does whoever wants to stop.
constexpr std::size_t kMostRays = kMostRaysOfRound;

}  // namespace

std::string_view name_of(Verdict verdict) { return style_of(verdict).name; }
std::string_view colour_name_of(Verdict verdict) { return style_of(verdict).colour_name; }
vec3 srgb_of(Verdict verdict) { return style_of(verdict).srgb; }

Verdict judge(const Hit& answer, const Hit& truth, double tolerance) {
  if (truth.status == HitStatus::below) return Verdict::not_judged;
  if (answer.status == HitStatus::exhausted) return Verdict::gave_up;
  if (!truth) return answer ? Verdict::invented : Verdict::right_miss;
  if (!answer) return Verdict::lost;
  if (std::abs(answer.t - truth.t) <= tolerance) return Verdict::right_hit;
  return answer.t < truth.t ? Verdict::early : Verdict::late;
}

namespace {

class ErrorTile final : public TileWork {
 public:
  ErrorTile(const TerrainScene& oracle, const Camera& camera, const PixelTile& tile, const Light& light,
            std::vector<Verdict>& verdicts, ErrorPicture& picture)
      : oracle_(oracle), camera_(camera), tile_(tile), light_(light), verdicts_(verdicts), picture_(picture) {}

  bool next(RayRound& round) override {
    if (!asked_) {
      asked_ = true;
      round.question = RayRound::Question::closest;
      round.rays = rays_through_middles(camera_, tile_);
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
    const Hit truth = oracle_.closest_hit(ray);
    const Verdict verdict = judge(answer, truth, picture_.counts.tolerance_m);
    vec3 colour = linear_from_srgb(style_of(verdict).srgb);
    // Unshadowed relief behind all colours of ground, so that one sees where the errors are.
    if (truth) {
      const dvec3 normal =
          truth.wall ? wall_normal(ray, truth) : oracle_.field().shading_normal(truth.cell, truth.u, truth.v);
      colour *= light_.on(normal, true);
    }
    set_pixel(picture_.image, x, y, colour);
    verdicts_[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.image.width) +
              static_cast<std::size_t>(x)] = verdict;
  }

  const TerrainScene& oracle_;
  const Camera& camera_;
  PixelTile tile_;
  const Light& light_;
  std::vector<Verdict>& verdicts_;
  ErrorPicture& picture_;
  bool asked_ = false;
};

}  // namespace

ErrorPicture render_error(const TerrainScene& scene, const Camera& camera, int width, int height, double tolerance,
                          const Progress& progress) {
  const HeightField& field = scene.field();
  const TerrainScene oracle(field, find_height_march("exhaustive"));
  const Light light(SunSettings{}, 0);
  ErrorPicture picture{Image(width, height), {}};
  picture.counts.tolerance_m = tolerance * std::min(field.settings().cell_x, field.settings().cell_y);
  std::vector<Verdict> verdicts(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  work_on_tiles(
      scene, PixelTiles(width, height, 1), kMostRays,
      [&](const PixelTile& tile) {
        return std::make_unique<ErrorTile>(oracle, camera, tile, light, verdicts, picture);
      },
      progress);
  for (const Verdict verdict : verdicts) ++picture.counts.pixels[static_cast<std::size_t>(verdict)];
  return picture;
}

}  // namespace scarp
