// SPDX-License-Identifier: MIT
// The colours of a tile's points where there is water, in rounds: rays of the camera; rays that the water reflects, and
// those that go on to its bottom; then the light of all ground that they meet.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "scarp/render/frame/shader.h"
#include "scarp/render/frame/tile_work.h"
#include "scarp/render/look/comanche.h"
#include "scarp/render/surface/water.h"

namespace scarp {

/// What does not change from tile to tile; all must outlive the tiles.
struct LakeView {
  const Camera& camera;
  const std::optional<Plinth>& plinth;
  const Shader& shader;
  const Water* water;      ///< null: none
  const StepMarch* march;  ///< answers rays of camera and water instead of the scene; null: the scene does
  bool iterations;         ///< a picture of steps instead
  int aa;
};

/// What a picture with water needs but rays. Refers to scene, camera and settings.
class Lake {
 public:
  Lake(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth, const PictureSettings& settings);
  Lake(const Lake&) = delete;
  Lake& operator=(const Lake&) = delete;

  const LakeView& view() const { return *view_; }
  /// What a tile asks at most in a round.
  std::size_t most_rays() const;

 private:
  Shader shader_;
  std::optional<Plinth> plinth_;
  std::optional<Water> water_;
  std::optional<StepMarch> march_;
  std::optional<LakeView> view_;
};

class LakeTile {
 public:
  LakeTile(const LakeView& view, const PixelTile& tile);

  /// As TileWork::next.
  bool next(RayRound& round);
  /// The water that a ray of the camera meets before what else it meets.
  std::optional<Water::Meeting> water_of(const Ray& ray, const Sight& sight) const;
  /// The mean colours of the pixels, row by row, in linear light, when there is no further round.
  std::vector<vec3> pixels() const;

 private:
  // What a ray of the camera, or one that the water sent on, has come to.
  struct Seen {
    std::size_t point;
    Ray ray;
    Sight sight;
    vec3 light{0.0f};  // of the ground that it met, without air
  };
  struct WaterPoint {
    std::size_t point;
    double t;
    double reflectance;
    std::optional<std::size_t> mirror, bottom;  // in water_rays_
  };
  // Ground whose light has been asked for.
  struct Open {
    Seen* seen;
    GroundPoint ground;
    LightRays asked;
  };
  enum class Stage { look, water, light };

  void ask_camera(RayRound& round);
  bool is_sea(const Hit& hit) const;
  void find_water();
  void add_water(std::size_t point, const Water::Meeting& meeting);
  bool ask_water(RayRound& round);
  bool ask_light(RayRound& round);
  void take_light(const RayRound& round);
  Seen* ground(std::size_t i);
  vec3 water_colour(const WaterPoint& water) const;
  vec3 colour_of(const Seen& seen) const;

  const LakeView& view_;
  std::vector<PicturePoint> points_;
  std::vector<Seen> seen_, water_rays_;
  std::vector<WaterPoint> water_;
  std::vector<std::optional<Water::Meeting>> meetings_;
  SightRound looking_;
  Stage stage_ = Stage::look;
  bool asked_ = false;
  std::size_t asked_points_ = 0;
  std::vector<Open> open_;
};

}  // namespace scarp
