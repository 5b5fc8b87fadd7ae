// SPDX-License-Identifier: MIT
// Contacts of scenes with many objects: bit for bit those of each object alone, after any edits, and found without
// querying most objects.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/refusal.h"
#include "cases.h"
#include "scarp/scarp.h"
#include "scarp/scene/live_scene.h"
#include "scarp/scene/scene_plinth.h"
#include "scarp/scene/scene_query.h"
#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp::test {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  dvec3 inside(double side) { return {in(-side, side), in(-side, side), in(-side, side)}; }
  glm::dmat3 turn() {
    return glm::dmat3(glm::rotate(glm::dmat4(1), in(0, 6.3), normalize(inside(1) + dvec3(0, 0, 1.1))));
  }
  Placement place(double side) { return {turn(), in(0.5, 2), inside(side)}; }

 private:
  std::mt19937_64 engine_;
};

HeightField hills(Random& random, const HeightFieldSettings& settings = {}) {
  std::vector<float> samples(25);
  for (float& sample : samples) sample = static_cast<float>(random.below(4));
  return HeightField::own(std::move(samples), 5, 5, settings);
}

std::shared_ptr<const VoxelModel> model(Random& random) {
  VoxelGrid grid({4, 4, 4}, 8);
  grid.edit(grid.box(), [&](const ivec3&, const VoxelGrid::Voxel&) {
    return random.below(3) == 0 ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
  });
  return std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"));
}

SceneFieldPtr crowd(Random& random) {
  PlacedVoxels voxels{.models = {model(random), model(random)}};
  for (std::uint32_t i = 0; i < 12; ++i) voxels.places.push_back({i % 2, 0.4 * random.turn(), random.inside(3)});
  return scene_voxels(std::move(voxels));
}

// Arguments of queries for contacts and closest points.
struct Asked {
  Capsule capsule;
  dvec3 motion;
  TurnedBox box;
  double max_distance;
};

Asked somewhere(Random& random, double side) {
  const dvec3 a = random.inside(1.3 * side);
  return {{a, random.below(2) ? a : a + random.inside(1), random.in(0, 1)},
          random.below(8) == 0 ? dvec3(0.0) : random.inside(random.below(2) ? 1 : side),
          {a, abs(random.inside(1)), random.turn()},
          random.below(2) ? random.in(0, 3) : std::numeric_limits<double>::infinity()};
}

// Every object that the mask selects, queried alone.
template <class Answer, class Ask, class Key>
std::optional<std::pair<Answer, std::uint32_t>> first_of(const Scene& scene, std::uint32_t mask, const Ask& ask,
                                                         const Key& key) {
  std::optional<std::pair<Answer, std::uint32_t>> best;
  for (std::uint32_t i = 0; i < scene.objects().size(); ++i) {
    if (!(scene.objects()[i].mask & mask) || scene.field_of(i).is_backdrop()) continue;
    const auto answer = ask(scene.field_of(i), scene.objects()[i].placement);
    if (answer && (!best || key(*answer) < key(best->first))) best = {*answer, i};
  }
  return best;
}

void expect_same_place(const FieldPlace& place, const FieldPlace& expected) {
  ASSERT_EQ(place.cell, expected.cell);
  ASSERT_EQ(place.voxel, expected.voxel);
  ASSERT_EQ(place.part, expected.part);
}

struct Found {
  int touched = 0, met = 0, close = 0;
};

void expect_contacts_of_each_alone(const Scene& scene, std::uint32_t mask, const Asked& asked, Found& count) {
  const SceneQuery query = scene.query({.mask = mask});
  // Names of a binding cannot be captured by lambdas (C++20 by clang 14).
  const Capsule& capsule = asked.capsule;
  const dvec3& motion = asked.motion;
  const TurnedBox& box = asked.box;
  const double max_distance = asked.max_distance;
  const auto touch = first_of<FieldContact>(
      scene, mask,
      [&](const SceneField& field, const Placement& to) {
        auto found =
            field.sweep({to.field_from_world(capsule.a), to.field_from_world(capsule.b), capsule.radius / to.scale},
                        to.field_from_world(Ray{.direction = motion}).direction);
        if (found) found->depth *= to.scale;
        if (found)
          found->point = to.world_from_field(found->point), found->normal = to.world_from_normal(found->normal);
        return found;
      },
      [](const FieldContact& contact) { return contact.t; });
  const auto contact = query.sweep(capsule, motion);
  ASSERT_EQ(contact.has_value(), touch.has_value());
  if (contact) {
    ++count.touched;
    ASSERT_EQ(contact->object, touch->second);
    ASSERT_EQ(contact->t, touch->first.t);
    ASSERT_EQ(contact->point, touch->first.point);
    ASSERT_EQ(contact->normal, touch->first.normal);
    ASSERT_EQ(contact->depth, touch->first.depth);
    expect_same_place(contact->place, touch->first.place);
  }
  const auto close = first_of<FieldPoint>(
      scene, mask,
      [&](const SceneField& field, const Placement& to) {
        auto found = field.closest_point(to.field_from_world(capsule.a), max_distance / to.scale);
        if (found) found->distance *= to.scale;
        if (found)
          found->point = to.world_from_field(found->point), found->normal = to.world_from_normal(found->normal);
        return found;
      },
      [](const FieldPoint& point) { return point.distance; });
  const auto point = query.closest_point(capsule.a, max_distance);
  ASSERT_EQ(point.has_value(), close.has_value());
  if (point) {
    ++count.close;
    ASSERT_EQ(point->object, close->second);
    ASSERT_EQ(point->distance, close->first.distance);
    ASSERT_EQ(point->point, close->first.point);
    ASSERT_EQ(point->normal, close->first.normal);
    expect_same_place(point->place, close->first.place);
  }
  const auto meets = first_of<bool>(
      scene, mask,
      [&](const SceneField& field, const Placement& to) {
        const bool met =
            field.overlaps({to.field_from_world(box.centre), box.half / to.scale, transpose(to.turn) * box.turn});
        return met ? std::optional(true) : std::nullopt;
      },
      [](bool) { return 0; });
  ASSERT_EQ(query.overlaps(box), meets.has_value());
  count.met += meets.has_value();
}

std::vector<SceneFieldPtr> all_kinds(Random& random) {
  const HeightField bilinear = hills(random), triangles = hills(random, {.surface = Surface::triangles});
  return {scene_heights(bilinear),
          scene_heights(triangles),
          scene_heights(hills(random, {.solid = true})),
          scene_voxels({.models = {model(random)}, .places = {{0, glm::dmat3(0.5), {1, 2, 3}}}}),
          crowd(random),
          scene_plinth(bilinear)};
}

TEST(SceneContacts, MatchPerObjectContacts) {
  Found count;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    const double side = seed == 4 ? 1e5 : 12;
    const dvec3 away = seed == 3 ? dvec3(5e6, -3e6, 200) : dvec3(0.0);
    std::vector<SceneObject> objects;
    for (int i = 0; i < 150; ++i) {
      SceneObject object{static_cast<std::uint32_t>(random.below(6)), 0, random.place(side), 1u << random.below(3)};
      object.placement.origin += away;
      objects.push_back(object);
      // Other objects at the same position, touched at the same time.
      if (i % 3 == 0) objects.push_back({object.field, 0, object.placement, 1u << random.below(3)});
    }
    const Scene scene(all_kinds(random), objects);
    for (int i = cases(20000, 800, 50); i > 0; --i) {
      Asked asked = somewhere(random, side);
      asked.capsule.a += away, asked.capsule.b += away, asked.box.centre += away;
      expect_contacts_of_each_alone(scene, static_cast<std::uint32_t>(1 + random.below(7)), asked, count);
      if (HasFatalFailure()) return;
    }
  }
  // The other queries have no answer, which tests less.
  EXPECT_GT(count.touched, cases(2000, 100, 20));
  EXPECT_GT(count.met, cases(1000, 50, 10));
  EXPECT_GT(count.close, cases(2000, 100, 20));
}

// Upright, at whole metres and in pairs, queried at half metres: many points of an object are equally close.
TEST(SceneContacts, MatchPerObjectContactsOnALattice) {
  Random random(9);
  const auto whole = [&](int side) { return dvec3(random.below(side), random.below(side), random.below(side)); };
  Found count;
  for (int scenes = cases(300, 15, 3); scenes > 0; --scenes) {
    VoxelGrid grid({16, 16, 16}, 8);
    for (int i = 0; i < 200; ++i) grid.fill_sphere(whole(16) + 0.5, 0.1, 1);
    std::vector<float> samples(400);
    for (float& sample : samples) sample = static_cast<float>(random.below(3));
    const auto voxels = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"));
    std::vector<SceneObject> objects;
    for (std::uint32_t i = 0; i < 20; ++i) objects.push_back({i % 2, 0, {.origin = whole(40)}});
    objects.insert(objects.end(), objects.begin(), objects.end());
    const Scene scene({scene_heights(HeightField::own(std::move(samples), 20, 20)),
                       scene_voxels({.models = {voxels}, .places = {{}}})},
                      objects);
    for (int i = 0; i < 60; ++i) {
      const dvec3 a = 0.5 * whole(100);
      const Asked asked{{a, a, 0.5}, whole(9) - 4.0, {a, 0.5 * whole(4)}, random.below(2) ? 4.0 : 50.0};
      expect_contacts_of_each_alone(scene, 1, asked, count);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(count.touched, cases(2000, 100, 20));
}

TEST(SceneContacts, MatchPerObjectContactsAfterEdits) {
  Random random(7);
  constexpr double kSide = 15;
  std::vector<float> samples(25, 1.0f);
  HeightField ground = HeightField::own(samples, 5, 5);
  Voxels voxels{VoxelGrid({4, 4, 4})};
  std::vector<Scene> parts{scene_heights(ground), voxels};
  for (const SceneFieldPtr& field : all_kinds(random)) parts.emplace_back(field);
  LiveScene live;
  std::vector<std::uint32_t> objects;
  Found count;
  for (int step = cases(3000, 300, 30); step > 0; --step) {
    live.edit([&](LiveScene::Editor& editor) {
      for (int i = objects.size() < 60 ? 12 : 5; i > 0; --i) {
        const auto which =
            objects.empty() ? 0 : static_cast<std::size_t>(random.below(static_cast<int>(objects.size())));
        const int what = objects.size() < 60 ? 0 : random.below(8);
        if (what < 2) {
          objects.push_back(editor.add(parts[static_cast<std::size_t>(random.below(static_cast<int>(parts.size())))],
                                       random.place(kSide)));
          editor.set_mask(objects.back(), 1u << random.below(3));
        } else if (what < 4) {
          editor.move(objects[which], random.place(kSide));
        } else if (what == 4) {
          editor.set_mask(objects[which], 1u << random.below(3));
        } else if (what == 5) {
          const auto sample = static_cast<float>(random.in(0, 9));
          ground.set_samples({2, 2, 1, 1}, &sample, 1);
        } else if (what == 6) {
          voxels.edit([&](VoxelGrid& grid) {
            return random.below(2) ? grid.fill_sphere(random.inside(4), 2, 1) : grid.clear_sphere(random.inside(4), 3);
          });
        } else {
          editor.remove(objects[which]);
          objects.erase(objects.begin() + static_cast<std::ptrdiff_t>(which));
        }
      }
    });
    const auto reading = live.read();
    for (int i = 0; i < 4; ++i) {
      expect_contacts_of_each_alone(reading.scene(), ~0u << random.below(2), somewhere(random, kSide), count);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(count.touched, cases(200, 20, 2));
  EXPECT_GT(count.met, cases(100, 10, 1));
}

TEST(SceneContacts, MatchPerPlaceContactsOfVoxels) {
  Random random(8);
  PlacedVoxels voxels{.models = {model(random), model(random)}};
  for (std::uint32_t i = 0; i < 100; ++i) {
    voxels.places.push_back({i % 2, random.in(0.3, 0.9) * random.turn(), random.inside(8)});
    if (i % 3 == 0) voxels.places.push_back(voxels.places.back());
  }
  const VoxelObjects all(voxels);
  std::vector<VoxelObjects> each;
  for (const VoxelPlace& place : voxels.places) each.emplace_back(PlacedVoxels{voxels.models, {place}});
  int touched = 0;
  for (int i = 0; i < 500; ++i) {
    const auto [capsule, motion, box, max_distance] = somewhere(random, 8);
    std::optional<FieldContact> touch;
    std::optional<FieldPoint> close;
    bool met = false;
    for (std::uint32_t part = 0; part < each.size(); ++part) {
      const auto contact = each[part].sweep(capsule, motion);
      if (contact && (!touch || contact->t < touch->t)) touch = contact, touch->place.part = part;
      const auto point = each[part].closest_point(capsule.a, max_distance);
      if (point && (!close || point->distance < close->distance)) close = point, close->place.part = part;
      met = met || each[part].overlaps(box);
    }
    const auto contact = all.sweep(capsule, motion);
    ASSERT_EQ(contact.has_value(), touch.has_value());
    if (contact) {
      ++touched;
      ASSERT_EQ(contact->t, touch->t);
      ASSERT_EQ(contact->point, touch->point);
      expect_same_place(contact->place, touch->place);
    }
    const auto point = all.closest_point(capsule.a, max_distance);
    ASSERT_EQ(point.has_value(), close.has_value());
    if (point) {
      ASSERT_EQ(point->distance, close->distance);
      ASSERT_EQ(point->point, close->point);
      expect_same_place(point->place, close->place);
    }
    ASSERT_EQ(all.overlaps(box), met);
  }
  EXPECT_GT(touched, 50);
}

// A unit cube at the origin that counts its queries.
class CountedCube final : public SceneField {
 public:
  std::string_view kind() const override { return "cube"; }
  std::string_view march() const override { return "none"; }
  std::optional<WorldBox> box() const override {
    ++asked;
    return WorldBox{dvec3(0.0), dvec3(1.0)};
  }
  Hit closest_hit(const Ray&, const Hit*, MarchStats*) const override { return {}; }
  bool occluded(const Ray&, const Hit*) const override { return false; }
  FieldSurface surface(const Ray&, const Hit&) const override { return {}; }
  std::optional<FieldSurface> within(const dvec3&) const override { return {}; }
  std::string no_contacts() const override { return {}; }
  std::optional<FieldContact> sweep(const Capsule& capsule, const dvec3& motion) const override {
    ++asked;
    const double t = sweep_bound(capsule, motion, dvec3(0.0), dvec3(1.0), 1);
    return t <= 1 ? std::optional(FieldContact{{t, {}, {}}, {}}) : std::nullopt;
  }
  bool overlaps(const TurnedBox& box) const override {
    ++asked;
    return scarp::overlaps(box, dvec3(0.0), dvec3(1.0));
  }
  std::optional<FieldPoint> closest_point(const dvec3& p, double max_distance) const override {
    ++asked;
    const double distance = length(glm::clamp(p, 0.0, 1.0) - p);
    return distance <= max_distance ? std::optional(FieldPoint{{}, {}, distance, {}}) : std::nullopt;
  }

  mutable int asked = 0;
};

TEST(SceneContacts, TestFewObjects) {
  const auto cube = std::make_shared<CountedCube>();
  std::vector<SceneObject> objects;
  for (int i = 0; i < 8000; ++i) objects.push_back({0, 0, {.origin = 3.0 * dvec3(i % 20, i / 20 % 20, i / 400)}});
  const Scene scene({cube}, objects);
  const SceneQuery query = scene.query({});
  cube->asked = 0;
  const auto contact = query.sweep({{0.5, 0.5, 100}, {0.5, 0.5, 100}, 0.2}, {0, 0, -100});
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->object, 7600u);
  EXPECT_LE(cube->asked, 2);
  EXPECT_TRUE(query.overlaps({{1.5, 1.5, 1.5}, {0.6, 0.6, 0.6}}));
  EXPECT_EQ(query.closest_point({0.5, 0.5, 60})->object, 7600u);
  EXPECT_LE(cube->asked, 10);
  EXPECT_FALSE(query.overlaps({{2, 2, 2}, {0.5, 0.5, 0.5}}));
  EXPECT_FALSE(query.sweep({{2, 2, 70}, {2, 2, 70}, 0.2}, {0, 0, -100}));
  EXPECT_LE(cube->asked, 10);
}

TEST(SceneContacts, RejectUnsupportedObjectsByMask) {
  const Scene scene =
      combine({{scene_heights(HeightField::own(std::vector<float>(4, 1), 2, 2))},
               {scene_shape(DistanceField(make_shape(shape::Sphere{1}))), {.origin = {1e6, 0, 0}}, {}, 2}});
  const Capsule ball{{0.5, 0.5, 2}, {0.5, 0.5, 2}, 0.25};
  EXPECT_NE(refusal([&] { scene.query({}).sweep(ball, {0, 0, -1}); }), "");
  EXPECT_NE(refusal([&] { scene.query({}).overlaps({ball.a, dvec3(1)}); }), "");
  EXPECT_NE(refusal([&] { scene.query({}).closest_point(ball.a); }), "");
  EXPECT_TRUE(scene.query({.mask = 1}).sweep(ball, {0, 0, -1}));
  const Scene wrapped(scene_heights(HeightField::own(std::vector<float>(4, 1), 2, 2, {.wrap = Wrap::periodic})));
  EXPECT_NE(refusal([&] { wrapped.query({}).sweep(ball, {0, 0, -1}); }), "");
}

}  // namespace
}  // namespace scarp::test
