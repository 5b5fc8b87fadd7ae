// SPDX-License-Identifier: MIT
#include "scarp/scene/tree/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace scarp {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

dvec3 point(Random& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

// Whether the ray hits the closed box, in long double.
bool meets(const Ray& ray, const WorldBox& box) {
  long double t_in = ray.t_min, t_out = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const long double o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) {
      if (o < box.low[axis] || o > box.high[axis]) return false;
      continue;
    }
    const long double a = (box.low[axis] - o) / d, b = (box.high[axis] - o) / d;
    t_in = std::max(t_in, std::min(a, b));
    t_out = std::min(t_out, std::max(a, b));
  }
  return t_in <= t_out;
}

// Rays side by side.
class RaysOfBeam {
 public:
  RaysOfBeam(const std::vector<Ray>& rays, const std::vector<double>& t_max)
      : rays_{rays.size(), {}, {}, nullptr, nullptr} {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i];
      for (int axis = 0; axis < 3; ++axis)
        numbers_[axis][i] = ray.origin[axis], numbers_[3 + axis][i] = ray.direction[axis];
      numbers_[6][i] = ray.t_min, numbers_[7][i] = t_max[i];
    }
    for (int axis = 0; axis < 3; ++axis)
      rays_.origin[axis] = numbers_[axis].data(), rays_.direction[axis] = numbers_[3 + axis].data();
    rays_.t_min = numbers_[6].data(), rays_.t_max = numbers_[7].data();
  }
  RaysOfBeam(const RaysOfBeam&) = delete;
  operator const BoxTree::Rays&() const { return rays_; }

 private:
  std::array<std::array<double, BoxTree::Beam::kRays + 7>, 8> numbers_{};
  BoxTree::Rays rays_;
};

std::vector<WorldBox> random_boxes(Random& random, int count, double spread, double size) {
  std::vector<WorldBox> boxes;
  for (int i = 0; i < count; ++i) {
    const dvec3 at = point(random, spread), half = glm::abs(point(random, size));
    boxes.push_back({at - half, at + half});
  }
  return boxes;
}

void expect_no_box_is_lost(const std::vector<WorldBox>& boxes, const Ray& ray) {
  const BoxTree tree(boxes);
  std::set<std::uint32_t> visited;
  tree.traverse(ray, [&](std::uint32_t object) {
    EXPECT_TRUE(visited.insert(object).second);
    return ray.t_max;
  });
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (meets(ray, boxes[i])) {
      EXPECT_TRUE(visited.contains(i)) << i;
    }
  }
}

TEST(BoxTree, FindsEveryBox) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const int count = static_cast<int>(uniform(random, 1, 40));
    const double spread = std::pow(10.0, uniform(random, -3, 6));
    const auto boxes = random_boxes(random, count, spread, spread * uniform(random, 0, 0.3));
    Ray ray;
    ray.direction = point(random, std::pow(10.0, uniform(random, -6, 6)));
    if (i % 3 == 0) ray.direction[i / 3 % 3] = 0;
    // At a corner of a box, a grazing touch.
    const WorldBox& target = boxes[static_cast<std::size_t>(i) % boxes.size()];
    ray.origin =
        (i % 2 ? target.low : target.high) - uniform(random, 0, 10) * spread / length(ray.direction) * ray.direction;
    if (i % 5 == 0) ray.origin = point(random, spread);
    expect_no_box_is_lost(boxes, ray);
  }
}

TEST(BoxTree, FindsBoxesFromFarAway) {
  Random random(2);
  const auto boxes = random_boxes(random, 200, 100, 5);
  for (int i = 0; i < 200; ++i) {
    Ray ray;
    ray.direction = normalize(point(random, 1));
    ray.origin = boxes[static_cast<std::size_t>(i)].low + 0.5 - 1e7 * ray.direction;
    expect_no_box_is_lost(boxes, ray);
  }
}

TEST(BoxTree, VisitsNoBoxBeyondTMax) {
  std::vector<WorldBox> row;
  for (int i = 0; i < 1000; ++i) row.push_back({dvec3(10.0 * i, 0, 0), dvec3(10.0 * i + 1, 1, 1)});
  const BoxTree tree(row);
  Ray ray;
  ray.origin = {-1, 0.5, 0.5};
  ray.direction = {1, 0, 0};
  int visits = 0;
  tree.traverse(ray, [&](std::uint32_t object) {
    EXPECT_EQ(object, static_cast<std::uint32_t>(visits));  // nearest first
    return ++visits == 3 ? 15.0 : ray.t_max;
  });
  EXPECT_EQ(visits, 3);
}

TEST(BoxTree, HandlesManyCoincidentBoxes) {
  const std::vector<WorldBox> same(5000, WorldBox{dvec3(1.0), dvec3(2.0)});
  Ray ray;
  ray.origin = {1.5, 1.5, 9};
  int visits = 0;
  BoxTree(same).traverse(ray, [&](std::uint32_t) {
    ++visits;
    return ray.t_max;
  });
  EXPECT_EQ(visits, 5000);
  BoxTree().traverse(ray, [&](std::uint32_t) { return ADD_FAILURE(), 0.0; });
}

TEST(BoxTree, HandlesBoxesWhoseDistancesOverflow) {
  std::vector<WorldBox> far;
  for (int i = 0; i < 20; ++i) {
    const double x = (i - 9.5) * 1.8e307;
    far.push_back({{x, -1, -1}, {x + 1, 1, 1}});
  }
  Ray ray;
  ray.direction = {1, 0, 0};
  int visits = 0;
  BoxTree(far).traverse(ray, [&](std::uint32_t) {
    ++visits;
    return ray.t_max;
  });
  EXPECT_GE(visits, 10);
}

// The nearest box to a point, from any position, in worlds of any size.
TEST(BoxTree, SearchFindsEveryBox) {
  Random random(5);
  std::size_t visits = 0, possible = 0;
  for (int i = 0; i < 2000; ++i) {
    const double spread = std::pow(10.0, i % 10 == 0 ? uniform(random, 30, 60) : uniform(random, -3, 6));
    const auto boxes = random_boxes(random, static_cast<int>(uniform(random, 1, 60)), spread, spread * 0.1);
    const dvec3 p = i % 3 == 0 ? boxes[0].low : point(random, 2 * spread);
    const auto distance = [&](const WorldBox& box) { return length(glm::clamp(p, box.low, box.high) - p); };
    double least = std::numeric_limits<double>::infinity();
    for (const WorldBox& box : boxes) least = std::min(least, distance(box));
    std::set<std::uint32_t> visited;
    double end = std::numeric_limits<double>::infinity();
    BoxTree(boxes).search(end, distance, [&](std::uint32_t object) {
      EXPECT_TRUE(visited.insert(object).second);
      return end = std::min(end, distance(boxes[object]));
    });
    EXPECT_EQ(end, least);
    for (std::uint32_t b = 0; b < boxes.size(); ++b) {
      if (distance(boxes[b]) == least) {
        EXPECT_TRUE(visited.contains(b)) << "round " << i << ", box " << b;
      }
    }
    if (spread < 1e30) visits += visited.size(), possible += boxes.size();
  }
  EXPECT_LT(visits, possible / 3);
  int visits_to_end = 0;
  BoxTree(std::vector<WorldBox>(100, WorldBox{dvec3(1.0), dvec3(2.0)}))
      .search(
          0, [](const WorldBox&) { return 0; }, [&](std::uint32_t) { return ++visits_to_end < 3 ? 0.0 : -1.0; });
  EXPECT_EQ(visits_to_end, 3);
}

TEST(BoxTree, BeamsFindEveryBox) {
  Random random(3);
  int beams = 0, met = 0;
  std::size_t visits = 0, possible = 0;
  for (int i = 0; i < 2000; ++i) {
    const double spread = std::pow(10.0, uniform(random, -3, 6));
    const auto boxes = random_boxes(random, static_cast<int>(uniform(random, 1, 60)), spread, spread * 0.1);
    const BoxTree tree(boxes);
    const WorldBox& target = boxes[0];
    dvec3 along = point(random, std::pow(10.0, uniform(random, -3, 3)));
    if (i % 4 == 0) along[i / 4 % 3] = 0;
    if (i % 16 == 1) along = dvec3(0), along[i / 16 % 3] = i % 32 == 1 ? -1 : 1;
    const double away = uniform(random, 0, 10) * spread / length(along);
    const double wide = std::pow(10.0, uniform(random, -6, -1));
    std::vector<Ray> rays(static_cast<std::size_t>(uniform(random, 1, 65)));
    std::vector<double> t_max;
    for (Ray& ray : rays) {
      ray.direction = along + wide * point(random, length(along));
      if (i % 32 == 1) ray.direction = along;
      // Some rays touch a corner of a box.
      ray.origin = (i % 2 ? target.low : target.high) - away * ray.direction;
      if (i % 3 == 0) ray.origin += point(random, 0.1 * spread);
      if (i % 5 == 0) ray.t_max = uniform(random, 0, 2) * away;
      t_max.push_back(ray.t_max);
    }
    const auto beam = tree.beam(RaysOfBeam(rays, t_max));
    if (!beam) continue;
    ++beams;
    std::set<std::uint32_t> visited;
    tree.traverse(*beam, [&](std::uint32_t object) {
      EXPECT_TRUE(visited.insert(object).second);
      return beam->end;
    });
    visits += visited.size(), possible += boxes.size();
    for (std::uint32_t b = 0; b < boxes.size(); ++b) {
      if (std::none_of(rays.begin(), rays.end(), [&](const Ray& ray) { return meets(ray, boxes[b]); })) continue;
      ++met;
      EXPECT_TRUE(visited.contains(b)) << "round " << i << ", box " << b;
    }
  }
  EXPECT_GT(beams, 1000);
  EXPECT_GT(met, 2000);
  EXPECT_LT(visits, possible / 3);
}

// The beam ends where the last of its rays ends.
TEST(BoxTree, BeamsEndWithTheirRays) {
  std::vector<WorldBox> row;
  for (int i = 0; i < 1000; ++i) row.push_back({dvec3(10.0 * i, 0, 0), dvec3(10.0 * i + 1, 1, 1)});
  const BoxTree tree(row);
  std::vector<Ray> rays(2, Ray{{-1, 0.5, 0.5}, {1, 0, 0}});
  rays[1].direction = {0.5, 0, 0};
  std::vector<double> t_max(2, std::numeric_limits<double>::infinity());
  const auto beam = tree.beam(RaysOfBeam(rays, t_max));
  ASSERT_TRUE(beam);
  int visits = 0;
  tree.traverse(*beam, [&](std::uint32_t object) {
    EXPECT_EQ(object, static_cast<std::uint32_t>(visits));  // nearest first
    if (++visits == 3) t_max = {15, 72};
    return beam->end_of(t_max);
  });
  EXPECT_EQ(visits, 4);  // 0.5 * 72 - 1 = 35
  rays[1] = Ray{{5, 0.5, 0.5}, {-1, 0, 0}};
  EXPECT_FALSE(tree.beam(RaysOfBeam(rays, t_max)));
  rays[1] = Ray{{-0.2, 0.5, 0.5}, {1, 1, 0}};
  EXPECT_FALSE(tree.beam(RaysOfBeam(rays, t_max)));
}

}  // namespace
}  // namespace scarp
