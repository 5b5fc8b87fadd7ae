// SPDX-License-Identifier: MIT
// Edited scenes: after any edits the answers equal those of a new scene, objects keep their numbers, and queries during
// edits see whole epochs. Also run under the thread sanitizer.
#include "scarp/scene/live_scene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "base/refusal.h"
#include "cases.h"
#include "scarp/scarp.h"
#include "scarp/scene/scene_plinth.h"

namespace scarp {
namespace {

using test::refusal;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  dvec3 inside(double side) { return {in(-side, side), in(-side, side), in(-side, side)}; }

 private:
  std::mt19937_64 engine_;
};

Terrain ground(int side, Random& random) {
  std::vector<float> samples(static_cast<std::size_t>(side * side));
  for (float& sample : samples) sample = static_cast<float>(random.in(0, 4));
  return Terrain::own(std::move(samples), side, side);
}

Voxels block() {
  VoxelGrid grid({8, 8, 8});
  grid.fill_sphere({4, 4, 4}, 3, 1);
  return Voxels(std::move(grid));
}

SceneFieldPtr ball(double radius) { return scene_shape(DistanceField(make_shape(shape::Sphere{radius}))); }

SceneFieldPtr waves() {
  return scene_function(HeightFunction(make_function(Sines{{{.amplitude = 2, .wavelength = 31}}})));
}

Placement somewhere(Random& random, double side) {
  const double a = random.in(0, 6.3);
  Placement placement{.scale = random.in(0.5, 3), .origin = random.inside(side)};
  placement.turn = glm::dmat3({std::cos(a), std::sin(a), 0}, {-std::sin(a), std::cos(a), 0}, {0, 0, 1});
  return placement;
}

std::vector<Ray> rays_through(Random& random, int count, double side) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Ray ray{.origin = random.inside(2 * side)};
    ray.direction = random.inside(side) - ray.origin;
    if (i % 3 == 0) ray.t_max = random.in(0.1, 2);
    rays.push_back(ray);
  }
  return rays;
}

void expect_same_answers(const Scene& scene, const Scene& fresh, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size()), expected(rays.size());
  std::vector<std::uint8_t> blocked(rays.size()), expected_blocked(rays.size());
  cast(scene, rays, hits);
  cast(fresh, rays, expected);
  occluded(scene, rays, blocked);
  occluded(fresh, rays, expected_blocked);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(hits[i], expected[i]) << i;
  ASSERT_EQ(blocked, expected_blocked);
  for (std::size_t i = 0; i < rays.size(); i += 5) {
    ASSERT_EQ(cast(scene, rays[i]), expected[i]) << i;
    ASSERT_EQ(occluded(scene, rays[i]), expected_blocked[i] != 0) << i;
  }
}

// Queries other than rays.
void expect_same_facts(const Scene& scene, const Scene& fresh) {
  ASSERT_EQ(scene.box().low, fresh.box().low);
  ASSERT_EQ(scene.box().high, fresh.box().high);
  ASSERT_EQ(scene.endless(), fresh.endless());
  ASSERT_EQ(scene.wraps(), fresh.wraps());
  ASSERT_EQ(scene.terrain(), fresh.terrain());
  ASSERT_EQ(scene.only_heights(), fresh.only_heights());
  ASSERT_EQ(scene.only_field(), fresh.only_field());
  ASSERT_EQ(scene.marches(), fresh.marches());
  ASSERT_EQ(scene.height(3, 3), fresh.height(3, 3));
}

// A new scene of the remaining objects, and their numbers.
Scene without_removed(const Scene& scene, std::vector<std::uint32_t>& numbers) {
  std::vector<SceneObject> objects;
  for (std::uint32_t i = 0; i < scene.objects().size(); ++i) {
    if (scene.field_of(i).kind() == "nothing") continue;
    objects.push_back(scene.objects()[i]);
    numbers.push_back(i);
  }
  return Scene(scene.fields(), std::move(objects));
}

TEST(LiveScene, MatchesANewSceneAfterEdits) {
  constexpr double kWorld = 40;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Random random(seed);
    std::vector<Terrain> terrains;
    for (int i = 0; i < 7; ++i) terrains.push_back(ground(9 + 4 * i, random));
    std::vector<Voxels> voxels;
    for (int i = 0; i < 4; ++i) voxels.push_back(block());
    HeightField loose = HeightField::own(std::vector<std::int16_t>(81, 1), 9, 9);
    const std::vector<SceneFieldPtr> fields{
        ball(1), ball(3), waves(),
        scene_heights(HeightField::own(std::vector<float>(25, 2.0f), 5, 5, {.solid = true}))};
    // The last two objects have been edited since then.
    const auto field = [&](int i) {
      return i < 4   ? fields[static_cast<std::size_t>(i)]
             : i < 5 ? scene_heights(loose)
                     : scene_plinth(terrains[0].field());
    };
    LiveScene live;
    std::vector<std::uint32_t> numbers;
    const int steps = test::cases(600, 150, 60);
    for (int step = 0; step < steps; ++step) {
      live.edit([&](LiveScene::Editor& editor) {
        for (int i = random.below(5); i >= 0; --i) {
          const int what = random.below(step < 30 ? 6 : 12);
          const Placement placement = random.below(9) == 0 ? Placement{} : somewhere(random, kWorld);
          if (what < 2) {
            numbers.push_back(editor.add(terrains[static_cast<std::size_t>(random.below(7))], placement));
          } else if (what == 2) {
            numbers.push_back(editor.add(voxels[static_cast<std::size_t>(random.below(4))], placement));
          } else if (what < 5) {
            numbers.push_back(editor.add(field(random.below(6)), placement, 7));
          } else if (what == 5) {
            const float height = static_cast<float>(random.in(0, 40));
            terrains[static_cast<std::size_t>(random.below(7))].set_samples({4, 4, 1, 1}, &height);
            const auto sample = static_cast<std::int16_t>(random.below(30));
            if (step % 4 == 0) loose.set_samples({4, 4, 1, 1}, &sample, 1);
          } else if (what == 6) {
            voxels[static_cast<std::size_t>(random.below(4))].edit([&](VoxelGrid& grid) {
              const dvec3 centre = random.inside(8);
              return random.below(2) ? grid.fill_sphere(centre, 3, 2) : grid.clear_sphere(centre, 5);
            });
          } else if (!numbers.empty()) {
            const auto which = static_cast<std::size_t>(random.below(static_cast<int>(numbers.size())));
            if (what < 9) {
              editor.move(numbers[which], placement);
            } else {
              editor.remove(numbers[which]);
              numbers.erase(numbers.begin() + static_cast<std::ptrdiff_t>(which));
            }
          }
        }
      });
      const auto reading = live.read();
      const Scene& scene = reading.scene();
      const std::vector<Ray> rays = rays_through(random, 40, kWorld);
      const Scene fresh(scene.fields(), scene.objects());
      expect_same_facts(scene, fresh);
      expect_same_answers(scene, fresh, rays);
      std::vector<std::uint32_t> number_of;
      const Scene left = without_removed(scene, number_of);
      ASSERT_EQ(number_of.size(), numbers.size());
      for (const Ray& ray : rays) {
        Hit expected = left.closest_hit(ray);
        if (expected) expected.object = number_of[expected.object];
        const Hit hit = scene.closest_hit(ray);
        ASSERT_EQ(hit.status, expected.status);
        if (hit) {
          ASSERT_EQ(hit, expected);
        }
      }
      if (HasFatalFailure()) return;
    }
  }
}

// Hits, and the number of objects queried per ray, match a new scene of the same objects.
void expect_good_tree(LiveScene& live, Random& random, double side) {
  const auto reading = live.read();
  const Scene& scene = reading.scene();
  const Scene fresh(scene.fields(), scene.objects());
  std::uint64_t boxes = 0, fresh_boxes = 0, hits = 0;
  for (const Ray& ray : rays_through(random, 300, side)) {
    MarchStats stats, fresh_stats;
    const Hit hit = scene.closest_hit(ray, nullptr, &stats);
    ASSERT_EQ(hit, fresh.closest_hit(ray, nullptr, &fresh_stats));
    ASSERT_EQ(scene.occluded(ray), bool(hit));
    boxes += stats.boxes, fresh_boxes += fresh_stats.boxes, hits += bool(hit);
  }
  EXPECT_GT(hits, 0u);
  EXPECT_LE(boxes, fresh_boxes + fresh_boxes / 10 + 10);
}

TEST(LiveScene, KeepsItsHierarchyEfficient) {
  Random random(5);
  const SceneFieldPtr small = ball(0.4);
  constexpr int kBalls = 1000;
  LiveScene live;
  // One by one, sorted: the worst order for a tree that only grows.
  for (int i = 0; i < kBalls; ++i) {
    live.edit([&](auto& editor) {
      editor.add(small, {.origin = {0.9 * (i % 10), 0.9 * (i / 10 % 10), 0.9 * (i / 100)}});
    });
  }
  expect_good_tree(live, random, 9);
  // Objects move to other positions, far from their neighbours, a few at a time.
  for (std::uint32_t i = 0; i < kBalls; ++i) {
    live.edit([&](auto& editor) { editor.move(i * 7 % kBalls, {.origin = random.inside(20)}); });
    if (i % 250 == 100) expect_good_tree(live, random, 20);
  }
  // All objects to one position, then one of them far away and back, then all in a row of a million metres.
  live.edit([&](auto& editor) {
    for (std::uint32_t i = 0; i < kBalls; ++i) editor.move(i, {.origin = {1, 2, 3}});
  });
  expect_good_tree(live, random, 4);
  for (const double away : {1e9, 5.0, 1e300, 5.0}) {
    live.edit([&](auto& editor) { editor.move(3, {.origin = {away, 2, 3}}); });
    const auto reading = live.read();
    EXPECT_EQ(cast(reading.scene(), {.origin = {-9, 2, 3}, .direction = {1, 0, 0}}).object, 0u);
  }
  live.edit([&](auto& editor) {
    for (std::uint32_t i = 0; i < kBalls; ++i) editor.move(i, {.origin = {1000.0 * i, 0, 0}});
  });
  for (std::uint32_t i = 0; i < kBalls; i += 10) {
    const auto reading = live.read();
    EXPECT_EQ(cast(reading.scene(), {.origin = {1000.0 * i, 0, 9}, .direction = {0, 0, -1}}).object, i);
  }
  // Removes all objects, then adds one.
  for (std::uint32_t i = 0; i < kBalls; ++i) live.edit([&](auto& editor) { editor.remove((i * 3) % kBalls); });
  EXPECT_FALSE(cast(live.read().scene(), {.origin = {-9, 0, 0}, .direction = {1, 0, 0}}));
  EXPECT_TRUE(live.read().scene().box().empty());
  live.edit([&](auto& editor) { editor.add(small); });
  EXPECT_TRUE(cast(live.read().scene(), {.origin = {-9, 0, 0}, .direction = {1, 0, 0}}));
}

// Cubes side by side at rounded positions; Ray::room depends on where all of them are.
TEST(LiveScene, ClosesSeamsOfMovedVoxels) {
  VoxelGrid grid({1, 1, 1});
  grid.fill(grid.box(), 1);
  const Voxels cube(std::move(grid));
  const glm::dmat3 half_turn({-1, 0, 0}, {0, -1, 0}, {0, 0, 1});
  LiveScene live;
  std::uint32_t first = 0, second = 0;
  live.edit([&](LiveScene::Editor& edit) { first = edit.add(cube), second = edit.add(cube); });
  for (const double far : {0.0, 4000.0, 0.0}) {
    for (int k = 0; k < 100; ++k) {
      const double side = 0.1;
      const Placement left{.scale = side, .origin = {far + k * side, 0, 0}};
      const Placement right{.turn = half_turn, .scale = side, .origin = {far + (k + 2) * side, side, 0}};
      live.edit([&](LiveScene::Editor& edit) { edit.move(first, left), edit.move(second, right); });
      const Ray ray{.origin = {far + (k + 1) * side, side / 2, 1}};
      const LiveScene::Reading reading = live.read();
      const Hit hit = cast(reading.scene(), ray);
      ASSERT_TRUE(hit) << far << ' ' << k;
      ASSERT_EQ(hit, cast(combine({{cube, left}, {cube, right}}), ray));
    }
  }
}

TEST(LiveScene, KeepsObjectNumbers) {
  LiveScene live(combine({{ball(1)}, {ball(1), {.origin = {10, 0, 0}}}, {ball(1), {.origin = {20, 0, 0}}}}));
  const auto object_at = [&](double x) {
    const auto reading = live.read();
    const Hit hit = cast(reading.scene(), {.origin = {x, 0, 9}, .direction = {0, 0, -1}});
    return hit ? static_cast<int>(hit.object) : -1;
  };
  live.edit([](auto& editor) { editor.remove(1); });
  EXPECT_EQ(object_at(0), 0);
  EXPECT_EQ(object_at(10), -1);
  EXPECT_EQ(object_at(20), 2);
  EXPECT_EQ(live.read().scene().fields().size(), 4u);
  std::uint32_t added = 0;
  live.edit([&](auto& editor) { added = editor.add(ball(2), {.origin = {30, 0, 0}}, 5); });
  EXPECT_EQ(added, 1u);
  EXPECT_EQ(object_at(30), 1);
  EXPECT_EQ(live.read().scene().objects()[1].material, 5u);
  // The slot of the removed field is reused by the new one.
  EXPECT_EQ(live.read().scene().fields().size(), 4u);
}

TEST(LiveScene, MissesRemovedObjects) {
  LiveScene live{Scene(ball(1))};
  const Ray ray{.origin = {0, 0, 9}, .direction = {0, 0, -1}};
  const Hit before = cast(live.read().scene(), ray);
  EXPECT_EQ(live.edit([](auto& editor) { editor.remove(0); }), 1u);
  const auto reading = live.read();
  EXPECT_EQ(reading.epoch(), 1u);
  EXPECT_EQ(cast(reading.scene(), ray).status, HitStatus::miss);
  EXPECT_FALSE(occluded(reading.scene(), ray));
  // A hit from an earlier epoch does no harm.
  EXPECT_FALSE(occluded(reading.scene(), {.origin = {0, 0, 1}, .direction = {0, 0, -1}}, &before));
  EXPECT_EQ(reading.scene().surface(ray, before).normal, dvec3(0.0));
  EXPECT_FALSE(reading.scene().within({0, 0, 0}));
}

TEST(LiveScene, ReportsEditsThatBypassIt) {
  Random random(1);
  Terrain terrain = ground(9, random);
  LiveScene live{terrain.scene()};
  const float height = 50;
  const Ray ray{.origin = {-1, 4, 40}, .direction = {1, 0, 0}};
  terrain.set_samples({4, 4, 1, 1}, &height);
  EXPECT_NE(refusal([&] { cast(live.read().scene(), ray); }).find("LiveScene::edit()"), std::string::npos);
  live.edit([](auto&) {});
  EXPECT_TRUE(cast(live.read().scene(), ray));
  EXPECT_TRUE(cast(Scene(live.read().scene()), ray));
}

TEST(LiveScene, RejectsBadEditsAndKeepsTheOthers) {
  LiveScene live{Scene(ball(1))};
  const auto refused = [&](const std::function<void(LiveScene::Editor&)>& change) {
    return refusal([&] { live.edit(change); });
  };
  EXPECT_EQ(refused([](auto& editor) { editor.move(1, {}); }), "scene: object 1 does not exist");
  EXPECT_EQ(refused([](auto& editor) { editor.remove(7); }), "scene: object 7 does not exist");
  EXPECT_EQ(refused([](auto& editor) { editor.move(0, {.scale = 0}); }),
            "scene: object 0: its placement must be a rotation, a scale above 0, a finite place");
  EXPECT_NE(refused([](auto& editor) { editor.add(ball(1), {.origin = {NAN, 0, 0}}); }), "");
  EXPECT_EQ(refused([](auto& editor) {
              editor.add(combine({{ball(1)}, {ball(2)}}));
            }),
            "scene: the added part has 2 objects (add them one by one)");
  EXPECT_EQ(live.read().scene().objects().size(), 1u);
  EXPECT_THROW(live.edit([](auto& editor) {
    editor.move(0, {.origin = {100, 0, 0}});
    throw std::runtime_error("");
  }),
               std::runtime_error);
  EXPECT_TRUE(cast(live.read().scene(), {.origin = {100, 0, 9}, .direction = {0, 0, -1}}));
  live.edit([](auto& editor) { editor.remove(0); });
  EXPECT_EQ(refused([](auto& editor) { editor.remove(0); }), "scene: object 0 does not exist");
}

// Two states that edits alternate between: a third of the balls, a hill and a pit in the voxels.
TEST(LiveScene, EveryReadingSeesOneEpoch) {
  Random random(3);
  Terrain terrain = ground(33, random);
  Voxels voxels = block();
  constexpr std::uint32_t kBalls = 60;
  std::vector<Placement> places[2];
  LiveScene live;
  live.edit([&](auto& editor) {
    const SceneFieldPtr small = ball(1);
    for (std::uint32_t i = 0; i < kBalls; ++i) {
      places[0].push_back(somewhere(random, 16)), places[1].push_back(somewhere(random, 16));
      editor.add(small, places[0][i]);
    }
    editor.add(terrain, {.origin = {-16, -16, -4}});
    editor.add(voxels, {.scale = 2});
  });
  const auto change = [&](int phase) {
    live.edit([&](auto& editor) {
      const auto& to = places[phase];
      for (std::uint32_t i = 0; i < kBalls; i += 3) editor.move(i, to[i]);
      const float height = phase ? 30 : 0;
      terrain.set_samples({16, 16, 1, 1}, &height);
      voxels.edit([&](VoxelGrid& grid) {
        return phase ? grid.clear_sphere({4, 4, 8}, 4) : grid.fill_sphere({4, 4, 8}, 4, 1);
      });
    });
  };
  const std::vector<Ray> rays = rays_through(random, test::cases(2000, 1000, 200), 16);
  const auto answers = [&](const Scene& scene) {
    std::vector<Hit> hits(rays.size());
    cast(scene, rays, hits);
    return hits;
  };
  change(0);
  std::vector<Hit> expected[2];
  for (const int phase : {1, 0}) {
    change(phase);
    expected[phase] = answers(live.read().scene());
  }
  ASSERT_NE(expected[0], expected[1]);
  const std::uint64_t first = live.read().epoch();

  constexpr int kBatches = 30, kEdits = 30;
  std::atomic<int> torn{0}, backwards{0};
  std::vector<std::thread> readers;
  for (int reader = 0; reader < 2; ++reader) {
    readers.emplace_back([&] {
      std::uint64_t last = 0;
      for (int i = 0; i < kBatches; ++i) {
        const auto reading = live.read();
        backwards += reading.epoch() < last;
        last = reading.epoch();
        torn += answers(reading.scene()) != expected[(last - first) % 2];
      }
    });
  }
  for (int i = 1; i <= kEdits; ++i) change(i % 2);
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(backwards, 0);
  EXPECT_EQ(live.read().epoch(), first + kEdits);
}

}  // namespace
}  // namespace scarp
