// SPDX-License-Identifier: MIT
// Computes the colours of a tile's points, in rounds of rays:
//
//   camera rays ──▶ rays that water and metal send on ──▶ rays from all hit surfaces to sun and sky, in as many rounds
//   as these need
#pragma once

#include <optional>
#include <vector>

#include "scarp/render/film/tile_work.h"
#include "scarp/render/frame/frame_view.h"

namespace scarp {

/// Maximum number of rays of a tile in one round.
std::size_t most_rays_of(const FrameView& view);

/// Whether a picture counts the steps of its camera rays.
bool counts_steps(const FrameView& view);

class FrameTile {
 public:
  /// aa x aa points per pixel. `sights`: what a fan has found for the camera rays of the tile, or null. `view` and
  /// `sights` must outlive the tile.
  FrameTile(const FrameView& view, const PixelTile& tile, int aa, const CameraSights* sights = nullptr);
  ~FrameTile();
  FrameTile(const FrameTile&) = delete;
  FrameTile& operator=(const FrameTile&) = delete;

  /// As TileWork::next.
  bool next(RayRound& round);
  /// Colours of points and mean colours of pixels, row by row, in linear light. Valid after the last round.
  std::vector<vec3> colours() const;
  std::vector<vec3> pixels() const;
  /// Whether the points show a surface or water, not the sky or the plinth. Valid after the last round.
  std::vector<bool> shown() const;
  /// The water that a camera ray hits before anything else.
  std::optional<Water::Meeting> water_of(const Ray& ray, const Hit& hit) const;

 private:
  struct WaterPoint {
    std::size_t point;
    double t;
    double reflectance;
    vec3 glitter;                       // glitter of the sun, if the mirrored ray hits nothing
    std::size_t mirror;                 // in sent_
    std::optional<std::size_t> bottom;  // likewise
  };
  // A mirroring surface hit by a camera ray.
  struct MirrorPoint {
    std::size_t point;
    float share;  // fraction of the light of `mirror`, tinted; the rest is the surface's own
    vec3 tint;
    std::size_t mirror;  // in sent_
  };
  // Hit of a camera ray, or of one that water or metal sent on. There are many, so they do not hold surfaces.
  struct Seen {
    Ray ray;
    Hit hit;
    std::uint32_t point = 0;
    std::uint32_t steps = 0;  // steps of the march, if counted
    vec3 colour{0.0f};        // of lit surfaces without the air in front; of everything else with it
    bool lit = false;         // whether it is such a surface
  };
  // A surface whose light rays have been requested.
  struct Open {
    Seen* seen;
    SceneSurface surface;
    LightRays asked;
  };
  enum class RoundKind { look, sent, light };

  // Whether the picture shows iterations, without colours.
  bool shows_steps() const;
  bool look(RayRound& round);
  void take_look(const RayRound& round);
  bool ask_sent(RayRound& round);
  void take_sent(const RayRound& round);
  // By index, seen_ before sent_; null after the last.
  Seen* seen_or_sent(std::size_t i);
  bool ask_light(RayRound& round);
  void take_light(const RayRound& round);
  void find_water();
  void find_mirrors();
  // `deep`: whether there may be a bottom below it.
  void add_water(std::size_t point, const Water::Meeting& meeting, bool deep = true);
  // Distance within which a surface is in the plane of the water.
  double coincidence(double t) const;
  bool is_before(const Water::Meeting& meeting, const Hit& hit) const;
  static void add(std::vector<Seen>& all, std::size_t point, const Ray& ray);
  std::size_t send(std::size_t point, const Water::Meeting& meeting, const dvec3& direction, double t_max);
  void light(const Open& open, const RayRound& round) const;
  vec3 water_colour(const WaterPoint& water) const;
  vec3 colour_of(const Seen& seen) const;
  // Grey level of a point in a picture of iterations: 0 to 1, the fraction of `most` steps.
  float share_of_steps(std::size_t point, double most) const;

  const FrameView& view_;
  PixelTile tile_;
  int aa_;
  const CameraSights* sights_;
  std::vector<PicturePoint> points_;
  std::vector<Seen> seen_, sent_;
  std::vector<WaterPoint> water_;
  std::vector<MirrorPoint> mirrors_;
  std::vector<const Hit*> sent_from_;  // surfaces on which rays of sent_ start; null for rays from water
  std::vector<std::optional<Water::Meeting>> meetings_;  // by point; empty without water
  RoundKind round_ = RoundKind::look;                    // kind of the current round
  bool asked_ = false;
  std::size_t asked_points_ = 0;
  std::vector<Open> open_;
};

}  // namespace scarp
