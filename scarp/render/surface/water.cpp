// SPDX-License-Identifier: MIT
#include "scarp/render/surface/water.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scarp/base/setting.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/render/surface/water.glsl.h"

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Pure water, per metre at 650, 550 and 450 nm: R. M. Pope and E. S. Fry, "Absorption spectrum (380-700 nm) of pure
// water. II", Applied Optics 36, 1997, table 3.
constexpr vec3 kPureWater(0.340f, 0.0565f, 0.00922f);

// Wave i is shorter than the previous one by this factor and rotated by the golden angle, so no two coincide.
constexpr std::size_t kWaves = glsl::kScarpWaves;
constexpr double kShorter = 0.71;
constexpr double kTurn = 2.399963229728653;
// Directions of the waves.
const std::array<dvec2, kWaves> kAlong = [] {
  std::array<dvec2, kWaves> along;
  for (std::size_t i = 0; i < kWaves; ++i) {
    const double angle = kTurn * static_cast<double>(i) + 0.4;
    along[i] = {std::cos(angle), std::sin(angle)};
  }
  return along;
}();

// The range of t in which a ray is in [0, high] along one axis.
struct Span {
  double from = -kInfinity, to = kInfinity;
};
Span span_in(double origin, double direction, double high) {
  if (direction == 0) return origin >= 0 && origin <= high ? Span{} : Span{kInfinity, -kInfinity};
  const double a = -origin / direction, b = (high - origin) / direction;
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

void validate(const WaterSettings& settings) {
  require_setting("water", std::isfinite(settings.level), "the level", settings.level, "a finite height in metres");
  require_setting("water", std::isfinite(settings.turbidity) && settings.turbidity >= 0, "the turbidity",
                  settings.turbidity, "0 or more per metre");
  require_setting("water", settings.waves >= 0 && settings.waves <= 0.5, "the waves' slope", settings.waves,
                  "0 to 0.5");
  require_setting("water", std::isfinite(settings.wavelength) && settings.wavelength >= 0, "the wavelength",
                  settings.wavelength, "0 or more metres");
  for (int i = 0; i < 3; ++i) {
    require_setting("water", settings.srgb[i] >= 0 && settings.srgb[i] <= 1, "a part of the colour", settings.srgb[i],
                    "0 to 1");
  }
}

double schlick(double cosine, double index) { return glsl::scarp_schlick(cosine, index); }

Water::Water(const WaterSettings& settings, const Scene& scene)
    : settings_(settings),
      scene_(scene),
      field_(scene.terrain()),
      basin_(scene.box()),
      level_(settings.level * (field_ ? field_->settings().exaggeration : 1)),
      wavelength_(settings.wavelength > 0 ? settings.wavelength : 2 * (scene.cell_side() > 0 ? scene.cell_side() : 1)),
      deep_(linear_from_srgb(settings.srgb)),
      per_metre_(kPureWater + static_cast<float>(settings.turbidity)) {}

std::optional<Water::Meeting> Water::from_above(const Ray& ray, double t) const {
  const dvec3 p = ray.at(t);
  Meeting meeting{t, {0, 0, 1}};
  const auto ground = scene_.height(p.x, p.y);
  // A ray that hits the level below higher ground comes from below the ground.
  if (ground && *ground > level_) return {};
  if (!field_) return meeting;
  const auto place = field_->place(p.x, p.y);
  if (place && !ground) return {};
  if (place && is_sea(place->cell)) {
    meeting.sea.emplace();
    meeting.sea->object = scene_.terrain_object();
    meeting.sea->cell = place->cell;
  }
  return meeting;
}

std::optional<Water::Meeting> Water::meets(const Ray& ray) const {
  const dvec3 &o = ray.origin, &d = ray.direction;
  if (scene_.endless()) {
    const double t = (level_ - o.z) / d.z;
    if (!(d.z < 0) || !(t >= ray.t_min && t <= ray.t_max)) return {};
    return from_above(ray, t);
  }
  // The ray enters through the last of the basin's three borders that it crosses.
  const Span x = span_in(o.x - basin_.low.x, d.x, basin_.high.x - basin_.low.x),
             y = span_in(o.y - basin_.low.y, d.y, basin_.high.y - basin_.low.y);
  Span z;
  if (d.z == 0) {
    if (o.z > level_) return {};
  } else {
    (d.z < 0 ? z.from : z.to) = (level_ - o.z) / d.z;
  }
  const double t = std::max({x.from, y.from, z.from}), end = std::min({x.to, y.to, z.to});
  if (!(t < end) || !(t >= ray.t_min && t <= ray.t_max)) return {};
  if (t == z.from) return from_above(ray, t);
  // A side, above the ground of a terrain, otherwise above the floor of the box.
  const bool through_x = t == x.from;
  dvec3 p = ray.at(t);
  p.x = std::clamp(p.x, basin_.low.x, basin_.high.x);
  p.y = std::clamp(p.y, basin_.low.y, basin_.high.y);
  const auto ground = scene_.height(p.x, p.y);
  if (ground ? p.z <= *ground : field_ != nullptr || p.z <= basin_.low.z) return {};
  return Meeting{t, through_x ? dvec3(d.x > 0 ? -1 : 1, 0, 0) : dvec3(0, d.y > 0 ? -1 : 1, 0)};
}

bool Water::is_sea(const Hit& hit) const {
  if (!field_ || !hit || hit.wall || hit.object != scene_.terrain_object()) return false;
  // Most ground is far above the water. Heights of hits are accurate to a thousandth of a cell.
  const HeightFieldSettings& settings = field_->settings();
  return hit.height <= level_ + std::min(settings.cell_x, settings.cell_y) && is_sea(hit.cell);
}

bool Water::is_sea(Cell cell) const {
  const auto heights = field_->cell_heights(cell);
  if (!heights) return false;
  for (const double sample : {heights->h00, heights->h01, heights->h10, heights->h11}) {
    if (field_->height_from_sample(sample) != level_) return false;
  }
  return true;
}

double Water::leaves(const Ray& ray) const {
  if (scene_.endless()) return kInfinity;
  const dvec3 &o = ray.origin, &d = ray.direction;
  // Terrain is itself the floor of the basin.
  const double floor = field_ || !(d.z < 0) ? kInfinity : (basin_.low.z - o.z) / d.z;
  return std::min({span_in(o.x - basin_.low.x, d.x, basin_.high.x - basin_.low.x).to,
                   span_in(o.y - basin_.low.y, d.y, basin_.high.y - basin_.low.y).to, floor});
}

dvec3 Water::normal_at(const dvec3& position, double footprint) const {
  if (settings_.waves == 0) return {0, 0, 1};
  dvec2 tilt(0.0);
  double wavelength = wavelength_;
  for (std::size_t i = 0; i < kWaves; ++i, wavelength *= kShorter) {
    const double seen = glsl::scarp_wave_seen(wavelength, footprint);
    if (seen == 0) break;
    const dvec2& along = kAlong[i];
    const double turns = (along.x * position.x + along.y * position.y) / wavelength;
    tilt += seen * glsl::scarp_wave_slope(static_cast<int>(i), turns, settings_.waves) * along;
  }
  return normalize(dvec3(-tilt.x, -tilt.y, 1));
}

double Water::roughness_at(double footprint) const {
  double roughness = 0;
  for (int i = 0; i < glsl::kScarpWaves; ++i)
    roughness += glsl::scarp_wave_roughness(glsl::scarp_wave_seen(wavelength(i), footprint), settings_.waves);
  return roughness;
}

dvec2 Water::wave_direction(int i) { return kAlong[static_cast<std::size_t>(i)]; }
double Water::wavelength(int i) const { return wavelength_ * std::pow(kShorter, i); }

vec3 Water::through(vec3 behind, double distance) const {
  return glsl::scarp_through_water(behind, deep_, per_metre_, static_cast<float>(distance));
}

vec3 Water::sunlight(double depth, const dvec3& to_sun) const {
  const double way = glsl::scarp_sun_way(depth, to_sun.z, kWaterIndex);
  return glsl::scarp_left_after(per_metre_, static_cast<float>(way));
}

dvec3 reflected(const dvec3& direction, const dvec3& normal) { return glsl::scarp_reflected(direction, normal); }

dvec3 refracted(const dvec3& direction, const dvec3& normal, double index) {
  return glsl::scarp_refracted(direction, normal, index);
}

}  // namespace scarp
