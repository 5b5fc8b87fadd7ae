// SPDX-License-Identifier: MIT
// `scarp render --compare`: the same view by several marches in one picture, a vertical strip each, with the steps and
// errors of each march over the whole view.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/options/picture_format.h"
#include "app/cli/picture/prepared_scene.h"
#include "scarp/output/figure.h"
#include "scarp/render/frame/picture.h"

namespace scarp::cli {

/// Throws Error unless the options compare at least two different marches in a format that has labels.
void check_comparison(const RenderOptions& options, const PictureFormat& format);

/// Returns the options with one of the marches that they compare, and no comparison.
RenderOptions with_march(RenderOptions options, std::string_view march);

class Comparison {
 public:
  /// `first` renders the first of `marches`, and must outlive the comparison. With fewer than two marches there is
  /// nothing to compare.
  Comparison(InputKind kind, PreparedScene& first, const std::vector<std::string>& marches);

  explicit operator bool() const { return !others_.empty(); }
  /// Reads the inputs for all marches but the first. Throws Error naming the file.
  void open();
  /// The strips of a figure that has room for the labels, before anything is rendered.
  std::vector<FigureStrip> blank_strips() const;
  /// Renders the whole view by each march. Returns the picture of their strips, with a legend for all of them.
  Picture render(const Camera& camera);
  /// The labels of the strips of the last picture.
  std::vector<FigureStrip> strips() const;
  void print() const;
  nlohmann::ordered_json describe() const;

 private:
  struct Side {
    PreparedScene* scene;
    std::string march;
    Picture picture{}, steps{}, errors{};
    double render_s = 0;
  };

  static Picture render(Side& side, const Camera& camera, const PictureRequest& request, std::string_view what);
  /// Sets the scale of numbers that the pictures need in common; returns false if there is none.
  bool share_scale(PictureRequest& request) const;
  Picture joined() const;

  std::vector<std::unique_ptr<PreparedScene>> others_;
  std::vector<Side> sides_;
};

}  // namespace scarp::cli
