// SPDX-License-Identifier: MIT
#include "app/cli/picture/contour_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

namespace scarp::cli {
namespace {

// In text heights: grid of the search, width of a character, width of the space at both ends, distance between labelled
// lines, and maximum distance of a line from the middle of its text.
constexpr double kStep = 0.5, kCharacter = 0.6, kEnds = 0.6, kApart = 1.1, kMostBend = 0.35;
constexpr int kChecks = 4;  // on either side of the label's middle

class Search {
 public:
  Search(const HeightField& field, const Camera& camera, const ContourLabelSettings& settings)
      : field_(field),
        camera_(camera),
        settings_(settings),
        exaggeration_(field.settings().exaggeration),
        step_(kStep * settings.text) {}

  std::vector<FigureLabel> labels() {
    const dvec2 size = settings_.per_pixel * camera_.size();
    const int cols = static_cast<int>(size.x / step_), rows = static_cast<int>(size.y / step_);
    for (int row = 0; row <= rows; ++row) {
      for (int col = 0; col <= cols; ++col) {
        const dvec2 here = step_ * dvec2(col, row);
        const auto h = height(here);
        if (!h) continue;
        for (const dvec2& along : {dvec2(step_, 0), dvec2(0, step_)}) {
          if (const auto next = height(here + along)) try_between(here, *h, along, *next);
        }
      }
    }
    std::stable_sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.bend < b.bend; });
    std::vector<FigureLabel> labels;
    for (Found& found : found_) labels.push_back(std::move(found.label));
    return labels;
  }

 private:
  struct Found {
    double bend;  // maximum deviation of the line from a straight one, in pixels
    FigureLabel label;
  };

  // Without exaggeration.
  std::optional<double> height(const dvec2& pixel) const {
    const dvec3 p = camera_.ray(pixel.x / settings_.per_pixel, pixel.y / settings_.per_pixel).origin;
    const std::optional<double> h = field_.height(p.x, p.y);
    return h ? std::optional(*h / exaggeration_) : std::nullopt;
  }

  // Whether a labelled contour line crosses the segment between two points.
  void try_between(const dvec2& from, double low, const dvec2& way, double high) {
    const double interval = settings_.interval;
    const double line = std::ceil(std::min(low, high) / interval);
    if (low == high || line * interval > std::max(low, high)) return;
    const double level = line * interval;
    if (level <= settings_.above) return;
    const dvec2 middle = from + (level - low) / (high - low) * way;
    const auto east = height(middle + dvec2(step_, 0)), west = height(middle - dvec2(step_, 0)),
               south = height(middle + dvec2(0, step_)), north = height(middle - dvec2(0, step_));
    if (!east || !west || !south || !north) return;
    const dvec2 slope = dvec2(*east - *west, *south - *north) / (2 * step_);
    const double steep = length(slope);  // metres per pixel
    if (!(interval > kApart * settings_.text * steep) || steep == 0) return;
    // + 0.0: no "-0".
    const std::string text = fmt::format("{:.6g}", level + 0.0);
    const double half = (kCharacter * static_cast<double>(text.size()) + kEnds) / 2 * settings_.text;
    const dvec2 along = dvec2(-slope.y, slope.x) / steep;
    double bend = 0;
    for (int i = -kChecks; i <= kChecks; ++i) {
      const auto h = height(middle + half * i / kChecks * along);
      if (!h) return;
      bend = std::max(bend, std::abs(*h - level) / steep);
    }
    if (bend > kMostBend * settings_.text) return;
    double angle = std::atan2(along.y, along.x);
    // Keeps the text upright.
    if (angle > std::numbers::pi / 2) angle -= std::numbers::pi;
    if (angle <= -std::numbers::pi / 2) angle += std::numbers::pi;
    found_.push_back({bend, {{middle.x, middle.y}, angle, text}});
  }

  const HeightField& field_;
  const Camera& camera_;
  const ContourLabelSettings& settings_;
  double exaggeration_, step_;
  std::vector<Found> found_;
};

}  // namespace

std::vector<FigureLabel> contour_labels_of(const HeightField& field, const Camera& camera,
                                           const ContourLabelSettings& settings) {
  return Search(field, camera, settings).labels();
}

}  // namespace scarp::cli
