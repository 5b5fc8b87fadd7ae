// SPDX-License-Identifier: MIT
#include "scarp/render/frame/terrain_frame_vk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "scarp/base/error.h"
#include "scarp/base/two_floats.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/render/frame/frame_stages_vk.h"
#include "scarp/render/frame/frame_view.h"
#include "scarp/render/frame/kept_buffer_vk.h"
#include "scarp/render/frame/terrain_frame.glsl.h"
#include "scarp/render/light/sample_directions.h"
#include "scarp/scene/plinth.h"
#include "scarp/scene/scene_vk.h"
#include "scarp/vk/memory.h"

namespace scarp {
namespace {

constexpr double kFarthestCell = 0x1p22;

void split(const dvec3& value, vec3& high, vec3& low) {
  for (int axis = 0; axis < 3; ++axis) scarp::split(value[axis], high[axis], low[axis]);
}
void split(const dvec2& value, glm::vec2& high, glm::vec2& low) {
  for (int axis = 0; axis < 2; ++axis) scarp::split(value[axis], high[axis], low[axis]);
}
float never_if_infinite(double value) { return std::isinf(value) ? glsl::kScarpNever : static_cast<float>(value); }

// A line in grid units; `origin` is a position, or a difference of positions.
glsl::ScarpLine line_of(const HeightField& field, const dvec3& origin, bool place, const dvec3& direction) {
  const auto difference = [&](const dvec3& d) {
    Ray ray;
    ray.direction = d;
    return field.grid_from_world(ray).direction;
  };
  Ray ray;
  ray.origin = origin;
  glsl::ScarpLine line;
  split(place ? field.grid_from_world(ray).origin : difference(origin), line.origin, line.origin_low);
  split(difference(direction), line.direction, line.direction_low);
  return line;
}

void set_camera(glsl::FrameSettings& s, const HeightField& field, const Camera& camera,
                const PictureSettings& settings) {
  const Camera::PixelRays rays = camera.pixel_rays();
  s.line = line_of(field, rays.origin, true, rays.direction);
  s.line_right = line_of(field, rays.origin_right, false, rays.right);
  s.line_down = line_of(field, rays.origin_down, false, rays.down);
  s.forward = vec3(camera.forward());
  s.reach = never_if_infinite(camera.reach());
  s.pixel_width = static_cast<float>(camera.pixel_width(1));
  s.orthographic = camera.orthographic();
  s.width = settings.width;
  s.height = settings.height;
  s.aa = settings.aa;
}

// Origin of a frame's heights: near the field's lowest point, on a heavy contour.
double zero_of_heights(const HeightField& field, const GroundPaint& paint) {
  const double low = field.min_height(), apart = paint.heavy_contour_interval();
  return apart > 0 ? std::floor(low / apart) * apart : low;
}

void set_field(glsl::FrameSettings& s, const HeightField& field, const std::optional<Plinth>& plinth,
               double zero_of_heights) {
  const HeightFieldSettings& settings = field.settings();
  const dvec2 cell(settings.cell_x, settings.cell_y);
  split(cell, s.cell, s.cell_low);
  s.per_cell = glm::vec2(1.0 / cell);
  s.metres_per_sample = static_cast<float>(settings.scale * settings.exaggeration);
  s.per_metre = static_cast<float>(1 / (settings.scale * settings.exaggeration));
  s.base_of_heights = static_cast<float>(field.min_sample());
  s.metres_at_base =
      static_cast<float>(field.height_from_sample(static_cast<double>(s.base_of_heights)) - zero_of_heights);
  s.last_row = static_cast<float>(field.rows() - 1);
  s.plinth = plinth.has_value();
  if (plinth) scarp::split(plinth->base_sample(), s.base_sample, s.base_sample_low);
}

void set_steps(glsl::FrameSettings& s, const Scene& scene, const Camera& camera, const PictureSettings& settings) {
  const HeightField& field = *scene.only_heights();
  const ComancheSettings& comanche = settings.comanche;
  const double reach = std::isfinite(camera.reach()) ? camera.reach() : default_reach(field);
  const bool stepped = scene.sampling() == Sampling::fixed_step;
  s.step = static_cast<float>(reach / comanche.steps);
  s.steps = comanche.steps;
  s.interpolate = comanche.interpolate;
  s.shells = comanche.shells;
  s.step_by_view = comanche.step_by_view;
  const FixedStepSettings& march = scene.device_terrain()->settings.fixed_step;
  s.sun_step = static_cast<float>(march.step * std::min(field.settings().cell_x, field.settings().cell_y));
  s.sun_steps = march.max_steps;
  s.sun_interpolate = march.interpolate;
  s.iterations = settings.look == Look::comanche && comanche.iterations;
  s.most_steps = stepped ? comanche.steps : 256;
}

// The sample whose height is the water's level to the last bit, if there is one.
std::optional<float> sea_sample(const HeightField& field, double level) {
  const HeightFieldSettings& settings = field.settings();
  const auto near = static_cast<float>((level / settings.exaggeration - settings.offset) / settings.scale);
  constexpr float kEndless = std::numeric_limits<float>::infinity();
  for (const float candidate :
       {near, std::round(near), std::nextafter(near, kEndless), std::nextafter(near, -kEndless)}) {
    if (field.height_from_sample(static_cast<double>(candidate)) == level) return candidate;
  }
  return {};
}

void set_water(glsl::FrameSettings& s, const HeightField& field, const Water* water, double zero_of_heights) {
  s.water = water != nullptr;
  if (!water) return;
  const HeightFieldSettings& settings = field.settings();
  s.level = static_cast<float>(water->level() - zero_of_heights);
  scarp::split((water->level() / settings.exaggeration - settings.offset) / settings.scale, s.level_sample,
               s.level_sample_low);
  const std::optional<float> sea = sea_sample(field, water->level());
  s.has_sea = sea.has_value();
  s.sea_sample = sea.value_or(0.0f);
  s.reflection = water->settings().reflection;
  s.refraction = water->settings().refraction;
  s.waves = static_cast<float>(water->settings().waves);
  s.deep = water->deep();
  s.water_per_metre = water->per_metre();
  for (int i = 0; i < glsl::kScarpWaves; ++i) {
    glsl::FrameWave& wave = s.wave[i];
    const dvec2 along = Water::wave_direction(i);
    wave.along = glm::vec2(along);
    split(along / water->wavelength(i), wave.turns, wave.turns_low);
    wave.metres = static_cast<float>(water->wavelength(i));
  }
}

void set_air(glsl::FrameSettings& s, const HeightField& field, const FrameView& view, double zero_of_heights) {
  const FogSettings& fog = view.fog().settings();
  s.fog = static_cast<int>(fog.kind);
  s.fog_per_metre = static_cast<float>(view.fog().per_metre());
  s.fog_base = static_cast<float>(fog.base - zero_of_heights);
  s.fog_falloff = static_cast<float>(fog.falloff);
  s.sun_tint = static_cast<float>(fog.sun_tint);
  s.haze_per_metre = static_cast<float>(view.haze().per_metre);
  s.clear_distance = static_cast<float>(view.haze().clear_distance);
  s.no_descent = view.horizon_below();
  const Light& light = view.lighting().light();
  s.shadows = view.lighting().shadows();
  s.to_sun = vec3(light.to_sun());
  const glsl::ScarpLine line = line_of(field, {}, false, light.to_sun());
  s.sun_line = line.direction;
  s.sun_line_low = line.direction_low;
  s.sky_side = vec3(light.sky_side());
  s.sun = light.sun();
  s.skylight = light.skylight();
  s.sky = view.sky().numbers();
  s.earth = view.earth();
  s.unlit_wall = view.unlit_wall();
  s.unlit = view.settings().unlit;
  s.tone_curve = uses_tone_curve(view.settings());
  s.alpha = view.settings().alpha;
}

void set_samples(glsl::FrameSettings& s, const Lighting& lighting) {
  s.sun_rays = lighting.sun_rays();
  s.sky_rays = lighting.sky_rays();
  s.sun_depth = static_cast<float>(cap_depth(lighting.sun_radius()));
  s.ao_distance = static_cast<float>(lighting.ao_distance());
  s.samples = lighting.samples();
  s.seed = lighting.pattern().seed();
  s.index_bits = lighting.pattern().index_bits();
}

void set_ground(glsl::FrameSettings& s, const HeightField& field, const GroundPaint& paint, double zero_of_heights) {
  const GroundPaintSettings& settings = paint.settings();
  s.natural = settings.natural;
  s.snow_share = static_cast<float>(settings.snow_share);
  s.low = static_cast<float>(field.min_height() - zero_of_heights);
  // Stands in for the relief of level ground; any positive float would be valid.
  constexpr double kLevelRelief = 1e-30;
  s.per_relief = static_cast<float>(1 / std::max(field.max_height() - field.min_height(), kLevelRelief));
  s.from_sun = glm::vec2(paint.away_from_sun());
  s.detail = static_cast<float>(settings.detail);
  s.detail_size = static_cast<float>(paint.detail_size());
  s.contours = static_cast<float>(settings.contours > 0 ? paint.contour_interval() : 0);
  for (int i = 0; i < glsl::kFramePatches; ++i) {
    const GroundPaint::Patch patch = paint.patch(i / glsl::kFrameOctaves, i % glsl::kFrameOctaves);
    split(patch.along, s.patches[i].along, s.patches[i].along_low);
    split(patch.across, s.patches[i].across, s.patches[i].across_low);
  }
}

// The features of the picture: drivers compile only the shaders for these.
std::uint32_t parts_of(const glsl::FrameSettings& s, bool stepped, std::uint32_t field_flags) {
  const bool plinth = s.plinth != 0 && !stepped;  // does not affect steps
  const bool rims = (field_flags & (glsl::kScarpHoles | glsl::kScarpSolid)) == glsl::kScarpHoles;
  const bool lit = s.unlit == 0, soft = s.samples > 0 && s.sun_rays + s.sky_rays > 0;
  std::uint32_t parts = 0;
  const auto add = [&](bool has, std::uint32_t part) { parts |= has ? part : 0; };
  add(s.water != 0, glsl::kFrameHasWater);
  add(lit && s.shadows != 0, glsl::kFrameHasShadows);
  add(s.natural != 0 || (s.detail > 0 && s.texture_size.x == 0), glsl::kFrameHasPatches);
  add(s.drape_width > 0, glsl::kFrameHasDrape);
  add(s.contours > 0, glsl::kFrameHasContours);
  add(s.fog != glsl::kScarpNoFog, glsl::kFrameHasFog);
  add(s.sky.scattering != 0, glsl::kFrameHasScattering);
  add(lit && soft, glsl::kFrameHasSamples);
  add(plinth, glsl::kFrameHasPlinth);
  add(plinth && rims, glsl::kFrameHasRims);
  add(s.texture_size.x > 0, glsl::kFrameHasTexture);
  return parts;
}

class FrameMaker {
 public:
  // The march and the field of a scene.
  explicit FrameMaker(const Scene& scene)
      : device_(scene.device_terrain()->device),
        stepped_(scene.sampling() == Sampling::fixed_step),
        flags_(device_field((*scene.only_heights()), nullptr).flags),
        stages_(device_, stepped_) {}

  Image make(const Scene& scene, const glsl::FrameSettings& numbers, const GroundPaint& paint, double zero_of_heights,
             const Progress& progress, FrameReport& report) {
    glsl::FrameSettings s = numbers;
    set_ramp(s, paint.ramp(), zero_of_heights);
    if (const Drape* drape = paint.settings().drape.get()) set_drape(s, *drape);
    if (paint.settings().detail > 0 && paint.settings().detail_texture) set_texture(s, paint);
    FrameWork work;
    work.numbers = &s;
    work.settings = settings_.keep(device_, std::span<const glsl::FrameSettings>(&s, 1));
    work.ground = scene.device_terrain()->ground.address();
    work.parts = parts_of(s, stepped_, flags_);
    work.field_flags = flags_;
    work.sample_type = scene.device_terrain()->ground.layout().sample_type;
    work.exact_only = leaves_first_pass(*scene.only_heights());
    if (report.tells_sightings) {
      report.sightings.resize(static_cast<std::size_t>(s.width) * s.height);
      work.sights = sights_.reserve(device_, report.sightings.size() * sizeof(glsl::FrameSight)).address();
    }
    Image image(s.width, s.height);
    report.device_s = stages_.run(work, progress, [&](std::int64_t first, std::span<const std::uint32_t> words) {
      std::uint8_t* rgb = image.rgb.data() + 3 * first;
      for (const std::uint32_t word : words) {
        *rgb++ = static_cast<std::uint8_t>(word);
        *rgb++ = static_cast<std::uint8_t>(word >> 8);
        *rgb++ = static_cast<std::uint8_t>(word >> 16);
        if (s.alpha != 0) image.alpha.push_back(static_cast<std::uint8_t>(word >> 24));
      }
    });
    if (work.sights != 0) take_sights(sights_.buffer(), report.sightings);
    if (progress && !progress(1.0)) throw Interrupted();
    return image;
  }

 private:
  void set_ramp(glsl::FrameSettings& s, const Ramp& ramp, double zero_of_heights) {
    std::vector<glsl::FrameRampPiece> pieces;
    std::vector<vec3> colours;
    for (const Ramp::Piece& piece : ramp.pieces()) {
      pieces.push_back({static_cast<float>(piece.low - zero_of_heights),
                        static_cast<float>(piece.high - zero_of_heights), static_cast<std::uint32_t>(colours.size()),
                        static_cast<std::uint32_t>(piece.colours.size())});
      colours.insert(colours.end(), piece.colours.begin(), piece.colours.end());
    }
    s.ramp_count = static_cast<int>(pieces.size());
    s.ramp_pieces = pieces_.keep(device_, std::span<const glsl::FrameRampPiece>(pieces));
    s.ramp_colours = colours_.keep(device_, std::span<const vec3>(colours));
  }

  void set_drape(glsl::FrameSettings& s, const Drape& drape) {
    s.drape_width = drape.width;
    s.drape_height = drape.height;
    s.drape_first = glm::vec2(drape.first);
    s.drape_last = glm::vec2(drape.last);
    s.drape_mirrored = drape.mirrored;
    s.drape = drape_.keep(device_, std::span<const std::uint8_t>(drape.rgba));
  }

  void set_texture(glsl::FrameSettings& s, const GroundPaint& paint) {
    const DetailTexture& texture = *paint.settings().detail_texture;
    const double width = paint.detail_size(), height = width * texture.height() / texture.width();
    split(dvec2(1 / width, 0), s.texture_place.along, s.texture_place.along_low);
    split(dvec2(0, 1 / height), s.texture_place.across, s.texture_place.across_low);
    s.texture_size = {texture.width(), texture.height()};
    s.texels_per_metre = static_cast<float>(texture.width() / width);
    s.texture = texture_.keep(device_, texture.texels());
  }

  static void take_sights(const DeviceBuffer& from, std::vector<FrameSighting>& sightings) {
    std::vector<glsl::FrameSight> sights(sightings.size());
    download(from, 0, sights.data(), sights.size() * sizeof(glsl::FrameSight));
    for (std::size_t i = 0; i < sights.size(); ++i) {
      const glsl::FrameSight& sight = sights[i];
      sightings[i] = {static_cast<FrameSighting::Kind>(sight.kind),
                      static_cast<double>(sight.t),
                      {sight.cell.x, sight.cell.y},
                      sight.steps};
    }
  }

  Device device_;
  bool stepped_;
  std::uint32_t flags_;
  FrameStages stages_;
  KeptBuffer settings_{"a frame's settings"}, pieces_{"a ramp"}, colours_{"a ramp's colours"}, drape_{"an overlay"},
      texture_{"a detail texture"}, sights_{"a frame's sights"};
};

}  // namespace

bool makes_whole_frames(const Scene& scene, const Camera& camera, const PictureSettings& settings) {
  const DeviceTerrain* terrain = scene.device_terrain();
  // The shader paints the ground's own colours.
  if (!terrain || scene.objects()[0].material < settings.materials.size()) return false;
  const Sampling march = scene.sampling();
  const bool stepped = march == Sampling::fixed_step && settings.look == Look::comanche;
  if (!stepped && march != Sampling::none) return false;  // max-mip is the only march without sampling on devices
  Ray eye;
  eye.origin = camera.eye();
  const dvec3 place = (*scene.only_heights()).grid_from_world(eye).origin;
  return std::abs(place.x) < kFarthestCell && std::abs(place.y) < kFarthestCell;
}

Image render_whole_frame(const Scene& scene, const Camera& camera, const PictureSettings& settings,
                         const Progress& progress, FrameReport* report) {
  const DeviceTerrain& terrain = *scene.device_terrain();
  if (!terrain.kept) terrain.kept = std::make_shared<FrameMaker>(scene);
  const HeightField& field = *scene.only_heights();
  const FrameView view(scene, camera, settings);
  glsl::FrameSettings numbers{};
  set_camera(numbers, field, camera, settings);
  const double zero = zero_of_heights(field, view.paint());
  // In a scene of only_heights(), any other object is the terrain's plinth.
  std::optional<Plinth> plinth;
  if (scene.objects().size() > 1) plinth.emplace(field, plinth_base(field));
  set_field(numbers, field, plinth, zero);
  set_steps(numbers, scene, camera, settings);
  set_water(numbers, field, view.water(), zero);
  set_air(numbers, field, view, zero);
  set_samples(numbers, view.lighting());
  set_ground(numbers, field, view.paint(), zero);
  FrameReport unasked;
  FrameReport& found = report ? *report : unasked;
  return static_cast<FrameMaker*>(terrain.kept.get())->make(scene, numbers, view.paint(), zero, progress, found);
}

std::vector<ShaderProgram> terrain_frame_shaders() { return FrameStages::shaders(); }

}  // namespace scarp
