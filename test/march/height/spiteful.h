// SPDX-License-Identifier: MIT
// Adversarial fields and rays: every kind that height-field engines are known to get wrong.
#pragma once

#include <functional>
#include <random>
#include <string_view>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/field/height_field.h"

namespace scarp::test {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high);
int whole(Random& random, int low, int high);  // both ends included

/// Features of a field, or of fields that a kind of rays targets: a sum of these.
enum Feature : unsigned { kPlain = 0, kHoles = 1, kTriangles = 2, kWraps = 4 };

struct FieldKind {
  std::string_view name;
  std::function<HeightField(Random&)> make;
  unsigned has = kPlain;
};

/// Over a wrapped field the range of all rays is finite.
struct RayKind {
  std::string_view name;
  std::function<Ray(const HeightField&, Random&)> make;
  unsigned aims_at = kPlain;
};

const std::vector<FieldKind>& spiteful_fields();
/// Fields of more than one tile of 1,024 cells, on which marches in single precision start a new frame.
const std::vector<FieldKind>& wide_fields();
const std::vector<RayKind>& spiteful_rays();
/// Rays over wide fields: over long distances, through nodes and along lines where tiles meet.
const std::vector<RayKind>& rays_across_tiles();

/// Random heights up to `most` above or below 0, in 2 to most_side samples per side and cells of 0.3 to 2 m; some of
/// the samples are holes. Takes all `settings` except the cell sizes.
HeightField rugged(Random& random, int most_side, double most, double hole_share, HeightFieldSettings settings);

/// Hills of several widths: rays along the ground go far before they hit, and any-hit looks ahead.
HeightField hills(int cols, int rows, Surface surface);
/// A ray along such hills, from their surface or within some metres of it.
Ray along_hills(const HeightField& field, Random& random, bool from_surface);

/// Rays with NaN, infinite, tiny and huge numbers, which queries need not accept, in every member of a ray.
std::vector<Ray> rays_of_unusual_numbers(const HeightField& field);

}  // namespace scarp::test
