// SPDX-License-Identifier: MIT
// Edits change the objects of a scene and record which; update() then updates the scene's derived data, once per call
// of edit(), regardless of the number of moves.
#include "scarp/scene/live_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/turnstile.h"
#include "scarp/scene/object_boxes.h"
#include "scarp/scene/scene_answers.h"
#include "scarp/scene/tree/box_tree_editor.h"

namespace scarp {
namespace {

// Placeholder for removed objects and fields.
class Nothing final : public SceneField {
 public:
  std::string_view kind() const override { return "nothing"; }
  std::string_view march() const override { return "nothing"; }
  std::optional<WorldBox> box() const override { return WorldBox{}; }
  bool is_backdrop() const override { return true; }
  Hit closest_hit(const Ray&, const Hit*, MarchStats* stats) const override {
    if (stats) *stats = {};
    return {};
  }
  bool occluded(const Ray&, const Hit*) const override { return false; }
  FieldSurface surface(const Ray&, const Hit&) const override { return {}; }
  std::optional<FieldSurface> within(const dvec3&) const override { return {}; }
};

bool touches_side(const WorldBox& inner, const WorldBox& outer) {
  return glm::any(glm::lessThanEqual(inner.low, outer.low)) || glm::any(glm::greaterThanEqual(inner.high, outer.high));
}

}  // namespace

struct LiveScene::State {
  // The scene's data derived from a field, and the number of objects that use it.
  struct Field {
    std::optional<WorldBox> box, extent;
    double farthest_voxel = 0;
    bool batches = false, backdrop = false;
    bool special = false;  // Scene::find_special() depends on it
    std::uint32_t users = 0;
  };
  struct Object {
    WorldBox extent;
    double farthest = 0;  // farthest_of()
    bool exists = false, changed = false;
    bool unbounded = false, batched = false;  // whether it is in these sets
    bool beside_tree = false, in_tree = false;
  };

  explicit State(const Scene& from);

  std::uint32_t take_field(SceneFieldPtr field);
  void release_field(std::uint32_t index);
  void describe(std::uint32_t index);
  void change(std::uint32_t object);
  void require_exists(std::uint32_t object) const;

  void update();
  void update_fields();
  void update_boxes(std::uint32_t object);
  std::vector<std::uint32_t> choose_beside_tree();
  void update_tree(std::uint32_t object);
  void update_box();
  void update_rooms();

  Scene scene;
  std::vector<Field> fields;
  std::unordered_map<const SceneField*, std::uint32_t> index_of;
  std::vector<std::uint32_t> free_fields;
  std::vector<Object> objects;
  std::vector<WorldBox> boxes;  // box per object; empty for unbounded objects
  std::vector<std::uint32_t> free_objects;
  std::uint32_t nothing = 0;  // the field of removed objects
  std::uint32_t others = 0;   // objects that are not backdrops

  std::set<std::uint32_t> unbounded;
  std::set<std::pair<double, std::uint32_t>> batched;  // by size, the largest first, as in Scene
  std::set<std::pair<double, std::uint32_t>> voxels;   // by farthest_of()
  std::uint32_t placed_voxels = 0;                     // number of voxel objects that are not in place
  BoxTreeEditor tree{scene.tree_};

  // Since the last update().
  std::vector<std::uint32_t> changed;
  bool special_changed = false, box_shrunk = false;

  std::uint64_t epoch = 0;
  std::atomic<std::int64_t> readings{0};
  Turnstile turnstile;
};

LiveScene::State::State(const Scene& from) : scene(from), objects(from.objects().size()), boxes(objects.size()) {
  if (scene.on_device()) throw Error("scene: a live scene cannot be on a device (call scene_on() with its readings)");
  scene.require_current();
  nothing = static_cast<std::uint32_t>(scene.fields_.size());
  scene.fields_.push_back(std::make_shared<Nothing>());
  fields.resize(scene.fields_.size());
  for (std::uint32_t i = 0; i < fields.size(); ++i) describe(i), index_of.emplace(scene.fields_[i].get(), i);
  fields[nothing].users = 1;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    objects[i].exists = true;
    Field& field = fields[scene.objects_[i].field];
    ++field.users;
    others += !field.backdrop;
    change(i);
  }
  tree.rebuild(boxes, {});
  update();
}

void LiveScene::State::describe(std::uint32_t index) {
  const SceneField& field = *scene.fields_[index];
  Field& known = fields[index];
  known.box = field.box(), known.extent = field.extent(), known.farthest_voxel = field.farthest_voxel();
  known.batches = field.likes_batches(), known.backdrop = field.is_backdrop();
  const bool nothing_there = known.backdrop && known.box && known.box->empty();
  known.special = !nothing_there && (!known.box || !known.extent || known.backdrop || height_field_of(field));
}

std::uint32_t LiveScene::State::take_field(SceneFieldPtr field) {
  if (field->outdated()) field = field->rebuilt();
  if (const auto known = index_of.find(field.get()); known != index_of.end()) return known->second;
  std::uint32_t index;
  if (free_fields.empty()) {
    index = static_cast<std::uint32_t>(fields.size());
    fields.emplace_back();
    scene.fields_.emplace_back();
  } else {
    index = free_fields.back();
    free_fields.pop_back();
  }
  index_of.emplace(field.get(), index);
  scene.fields_[index] = std::move(field);
  describe(index);
  scene.watch_field(index);
  return index;
}

void LiveScene::State::release_field(std::uint32_t index) {
  if (--fields[index].users > 0) return;
  index_of.erase(scene.fields_[index].get());
  scene.fields_[index] = scene.fields_[nothing];
  scene.unwatch_field(index);
  describe(index);
  free_fields.push_back(index);
}

void LiveScene::State::require_exists(std::uint32_t object) const {
  if (object < objects.size() && objects[object].exists) return;
  throw Error(fmt::format("scene: object {} does not exist", object));
}

void LiveScene::State::change(std::uint32_t object) {
  special_changed = special_changed || fields[scene.objects_[object].field].special;
  if (objects[object].changed) return;
  objects[object].changed = true;
  changed.push_back(object);
}

std::uint32_t LiveScene::Editor::add(const Scene& part, const Placement& placement,
                                     std::optional<std::uint32_t> material) {
  if (part.on_device()) throw Error("scene: a part on a device cannot be added (add it, then call scene_on())");
  if (part.objects().size() != 1)
    throw Error(fmt::format("scene: the added part has {} objects (add them one by one)", part.objects().size()));
  State& state = *live_.state_;
  SceneObject object = part.objects()[0];
  object.placement = placed(placement, object.placement);
  if (material) object.material = *material;
  const bool reused = !state.free_objects.empty();
  const auto number = reused ? state.free_objects.back() : static_cast<std::uint32_t>(state.objects.size());
  require_placement(object.placement, number);
  object.field = state.take_field(part.fields()[object.field]);
  if (reused) {
    state.free_objects.pop_back();
  } else {
    state.objects.emplace_back(), state.boxes.emplace_back();
    state.scene.objects_.emplace_back(), state.scene.in_place_.emplace_back(), state.scene.frames_.emplace_back();
    state.scene.rooms_.emplace_back();
  }
  state.scene.objects_[number] = object;
  state.objects[number].exists = true;
  State::Field& field = state.fields[object.field];
  ++field.users;
  state.special_changed = state.special_changed || state.others < 2;
  state.others += !field.backdrop;
  state.change(number);
  return number;
}

void LiveScene::Editor::move(std::uint32_t object, const Placement& placement) {
  State& state = *live_.state_;
  state.require_exists(object);
  require_placement(placement, object);
  state.scene.objects_[object].placement = placement;
  state.special_changed = state.special_changed || state.others < 2;
  state.change(object);
}

void LiveScene::Editor::set_mask(std::uint32_t object, std::uint32_t mask) {
  State& state = *live_.state_;
  state.require_exists(object);
  if (mask == 0) throw Error(fmt::format("scene: object {}: its mask is 0, so no query would see it", object));
  state.scene.objects_[object].mask = mask;
}

void LiveScene::Editor::remove(std::uint32_t object) {
  State& state = *live_.state_;
  state.require_exists(object);
  state.change(object);
  const std::uint32_t field = state.scene.objects_[object].field;
  state.others -= !state.fields[field].backdrop;
  state.special_changed = state.special_changed || state.others < 2;
  state.release_field(field);
  state.scene.objects_[object] = {.field = state.nothing};
  state.objects[object].exists = false;
  state.free_objects.push_back(object);
}

// Updates the boxes of objects whose fields were edited.
void LiveScene::State::update_fields() {
  const std::uint64_t edits = edits_of_all_fields.load(std::memory_order_relaxed);
  if (edits == scene.seen_.value()) return;
  std::vector<std::uint8_t> edited(fields.size(), 0);
  bool any = false;
  for (Scene::Editable& editable : scene.editable_) {
    const std::uint64_t now = *scene.fields_[editable.field]->edits();
    if (now == editable.edits) continue;
    editable.edits = now;
    edited[editable.field] = any = true;
    SceneFieldPtr& field = scene.fields_[editable.field];
    if (field->outdated()) {
      index_of.erase(field.get());
      field = field->rebuilt();
      index_of.emplace(field.get(), editable.field);
    }
    describe(editable.field);
  }
  scene.seen_.set(edits);
  if (!any) return;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    if (edited[scene.objects_[i].field]) change(i);
  }
}

void LiveScene::State::update_boxes(std::uint32_t index) {
  Object& object = objects[index];
  const Placement& placement = scene.objects_[index].placement;
  const Field& field = fields[scene.objects_[index].field];
  if (object.farthest > 0) {
    voxels.erase({object.farthest, index});
    placed_voxels -= !scene.in_place_[index];
  }
  scene.in_place_[index] = placement.identity();
  scene.frames_[index] = frame_of(placement);

  const auto in_world = [&](const std::optional<WorldBox>& box) {
    return box ? world_box(placement, *box) : WorldBox{};
  };
  box_shrunk = box_shrunk || (!object.extent.empty() && touches_side(object.extent, scene.box_));
  object.extent = in_world(field.extent);
  scene.box_ = around(scene.box_, object.extent);
  object.farthest = farthest_of(placement, field.farthest_voxel, object.extent);
  if (object.farthest > 0) {
    voxels.emplace(object.farthest, index);
    placed_voxels += !scene.in_place_[index];
  }

  if (object.unbounded) unbounded.erase(index);
  if (object.batched) batched.erase({-half_area(boxes[index]), index});
  boxes[index] = in_world(field.box);
  object.unbounded = !field.box;
  object.batched = field.batches && !boxes[index].empty();
  if (object.unbounded) unbounded.insert(index);
  if (object.batched) batched.emplace(-half_area(boxes[index]), index);
}

// As Scene's constructor does. Returns the objects that exist now or did before.
std::vector<std::uint32_t> LiveScene::State::choose_beside_tree() {
  std::vector<std::uint32_t> affected = std::move(scene.beside_tree_);
  for (const std::uint32_t object : affected) objects[object].beside_tree = false;
  scene.beside_tree_.assign(unbounded.begin(), unbounded.end());
  for (auto of_set = batched.begin(); of_set != batched.end(); ++of_set) {
    if (scene.beside_tree_.size() == unbounded.size() + kMostBesideTree) break;
    scene.beside_tree_.push_back(of_set->second);
  }
  for (const std::uint32_t object : scene.beside_tree_) objects[object].beside_tree = true;
  affected.insert(affected.end(), scene.beside_tree_.begin(), scene.beside_tree_.end());
  return affected;
}

void LiveScene::State::update_tree(std::uint32_t index) {
  Object& object = objects[index];
  const bool in_tree = !object.beside_tree && !boxes[index].empty();
  if (object.in_tree && in_tree) {
    if (object.changed) tree.move(index, boxes[index]);
  } else if (object.in_tree) {
    tree.remove(index);
  } else if (in_tree) {
    tree.insert(index, boxes[index]);
  }
  object.in_tree = in_tree;
}

void LiveScene::State::update_box() {
  scene.box_ = {};
  for (const Object& object : objects) scene.box_ = around(scene.box_, object.extent);
}

// As Scene's constructor does.
void LiveScene::State::update_rooms() {
  const double before = scene.room_;
  scene.room_ = voxels.size() > 1 || placed_voxels > 0 ? room_of_voxels(voxels.rbegin()->first) : 0;
  if (scene.room_ == before) {
    for (const std::uint32_t object : changed) scene.find_room(object);
  } else {
    for (std::uint32_t i = 0; i < objects.size(); ++i) scene.find_room(i);
  }
}

void LiveScene::State::update() {
  update_fields();
  for (const std::uint32_t object : changed) update_boxes(object);
  update_rooms();
  for (const std::uint32_t object : choose_beside_tree()) update_tree(object);
  for (const std::uint32_t object : changed) update_tree(object), objects[object].changed = false;
  changed.clear();
  if (tree.needs_rebuild()) {
    std::vector<std::uint32_t> in_tree;
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
      if (objects[i].in_tree) in_tree.push_back(i);
    }
    tree.rebuild(boxes, std::move(in_tree));
  }
  if (box_shrunk) update_box();
  if (special_changed) scene.find_special();
  box_shrunk = special_changed = false;
}

LiveScene::LiveScene() : LiveScene(Scene({}, {})) {}
LiveScene::LiveScene(const Scene& scene) : state_(std::make_unique<State>(scene)) {}
LiveScene::~LiveScene() { assert(state_->readings == 0 && "a Reading outlives its LiveScene"); }

std::uint64_t LiveScene::edit(const std::function<void(Editor&)>& change) {
  const auto alone = state_->turnstile.edit();
  Editor editor(*this);
  try {
    change(editor);
  } catch (...) {
    state_->update();
    ++state_->epoch;
    throw;
  }
  state_->update();
  return ++state_->epoch;
}

LiveScene::Reading::Reading(const LiveScene& live) : live_(&live), held_(live.state_->turnstile.read()) {
  ++live.state_->readings;
}
LiveScene::Reading::Reading(Reading&& other) noexcept
    : live_(std::exchange(other.live_, nullptr)), held_(std::move(other.held_)) {}
LiveScene::Reading::~Reading() {
  if (live_) --live_->state_->readings;
}
const Scene& LiveScene::Reading::scene() const { return live_->state_->scene; }
std::uint64_t LiveScene::Reading::epoch() const { return live_->state_->epoch; }

}  // namespace scarp
