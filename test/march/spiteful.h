// SPDX-License-Identifier: MIT
// Fields and rays chosen to hurt: every kind that height-field engines are known to get wrong.
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

struct FieldKind {
  std::string_view name;
  std::function<HeightField(Random&)> make;
};

struct RayKind {
  std::string_view name;
  std::function<Ray(const HeightField&, Random&)> make;
};

const std::vector<FieldKind>& spiteful_fields();
const std::vector<RayKind>& spiteful_rays();

}  // namespace scarp::test
