// SPDX-License-Identifier: MIT
// Embree 3.13 on the same samples, used as its documentation recommends: no filter functions, denormals off in the
// threads that trace, packets and streams laid out beforehand.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/engine.h"
#include "bench/fields.h"

struct RTCSceneTy;

namespace scarp::bench {

enum class EmbreeSurface { triangles, grid };
enum class EmbreeQuality { medium, high };
/// Throws Error listing the names when it is neither "medium" nor "high".
EmbreeQuality find_embree_quality(std::string_view name);

/// A scene over a field; outlives the engines made from it.
class EmbreePeer {
 public:
  /// Builds the scene and measures the time, including that for its vertices and indices. Throws Error with Embree's
  /// message. `robust`: sets RTC_SCENE_FLAG_ROBUST; otherwise no flag is set.
  EmbreePeer(const HeightField& field, EmbreeSurface surface, EmbreeQuality quality, bool robust = true);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  /// One for each of embree_modes(), x1 first: "embree-tri" or "embree-grid"; "-default" follows if not robust.
  std::vector<Engine> engines() const;
  /// Embree's own handle, for rays that depend on one another.
  RTCSceneTy* scene() const;

  /// "3.13.5"
  static std::string version();

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace scarp::bench
