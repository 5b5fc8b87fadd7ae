// SPDX-License-Identifier: MIT
#include "scarp/render/error_look.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scarp/march/wall.h"
#include "scarp/render/light.h"
#include "scarp/render/ramp.h"

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

}  // namespace

std::string_view name_of(Verdict verdict) { return style_of(verdict).name; }
std::string_view colour_name_of(Verdict verdict) { return style_of(verdict).colour_name; }

Verdict judge(const Hit& answer, const Hit& truth, double tolerance) {
  if (truth.status == HitStatus::below) return Verdict::not_judged;
  if (answer.status == HitStatus::exhausted) return Verdict::gave_up;
  if (!truth) return answer ? Verdict::invented : Verdict::right_miss;
  if (!answer) return Verdict::lost;
  if (std::abs(answer.t - truth.t) <= tolerance) return Verdict::right_hit;
  return answer.t < truth.t ? Verdict::early : Verdict::late;
}

ErrorPicture render_error(const TerrainScene& scene, const Camera& camera, int width, int height, double tolerance,
                          const Progress& progress) {
  const HeightField& field = scene.field();
  const TerrainScene oracle(field, find_march("exhaustive"));
  const Light light(SunSettings{}, 0);
  ErrorPicture picture{Image(width, height), {}};
  picture.counts.tolerance_m = tolerance * std::min(field.settings().cell_x, field.settings().cell_y);
  std::vector<Verdict> verdicts(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for_each_pixel(
      width, height,
      [&](int x, int y) {
        const Ray ray = camera.ray(x + 0.5, y + 0.5);
        const Hit truth = oracle.closest_hit(ray);
        const Verdict verdict = judge(scene.closest_hit(ray), truth, picture.counts.tolerance_m);
        vec3 colour = linear_from_srgb(style_of(verdict).srgb);
        // Unshadowed relief behind all colours of ground, so that one sees where the errors are.
        if (truth) {
          const dvec3 normal =
              truth.wall ? wall_normal(ray, truth) : field.shading_normal(truth.cell, truth.u, truth.v);
          colour *= light.on(normal, true);
        }
        set_pixel(picture.image, x, y, colour);
        verdicts[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = verdict;
      },
      progress);
  for (const Verdict verdict : verdicts) ++picture.counts.pixels[static_cast<std::size_t>(verdict)];
  return picture;
}

}  // namespace scarp
