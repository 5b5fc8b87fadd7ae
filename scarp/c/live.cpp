// SPDX-License-Identifier: MIT
#include "scarp/c/scene_handle.h"
#include "scarp/c/threads.h"
#include "scarp/scene/live_scene.h"

/// `view` is what callbacks query: its parts are edited with the objects, while nobody reads.
struct scarp_live {
  scarp_live() {
    view.of_live = true;
    view.queries = &live.read().scene();  // edits replace it in place
  }
  scarp::LiveScene live{};
  scarp_scene view{};
  std::vector<std::vector<std::shared_ptr<const void>>> memory{};  // by object, as Parts::memory
};

struct scarp_editor {
  scarp_live& live;
  scarp::LiveScene::Editor& editor;
};

namespace scarp::c {
namespace {

// A thread that waited for itself would wait forever.
thread_local bool in_callback = false;

class Callback {
 public:
  Callback() {
    if (in_callback) throw Error("live: a callback must not read or edit a live scene (return from it first)");
    in_callback = true;
  }
  ~Callback() { in_callback = false; }
  Callback(const Callback&) = delete;
  Callback& operator=(const Callback&) = delete;
};

}  // namespace
}  // namespace scarp::c

using namespace scarp::c;

scarp_status scarp_live_create(scarp_live** live) {
  return guarded([&] { required(live, "live") = new scarp_live; });
}

scarp_status scarp_live_read(const scarp_live* live, void (*query)(const scarp_scene* scene, void* user_data),
                             void* user_data) {
  return guarded([&] {
    required(live, "live");
    if (!query) throw scarp::Error("live: query is NULL");
    const Callback callback;
    const auto reading = live->live.read();
    query(&live->view, user_data);
  });
}

scarp_status scarp_live_edit(scarp_live* live, void (*change)(scarp_editor* editor, void* user_data), void* user_data) {
  return guarded_on_threads([&] {
    required(live, "live");
    if (!change) throw scarp::Error("live: change is NULL");
    const Callback callback;
    live->live.edit([&](scarp::LiveScene::Editor& editor) {
      scarp_editor own{*live, editor};
      change(&own, user_data);
    });
  });
}

scarp_status scarp_editor_add(scarp_editor* editor, const scarp_part* part, uint32_t* object) {
  return guarded([&] {
    required(editor, "editor");
    required(object, "object");
    const scarp::ScenePart placed = part_from(required(part, "part"));
    const Parts& given = part->scene->parts;
    if (given.objects.size() != 1)
      throw scarp::Error(fmt::format("part: the scene has {} objects (must be 1)", given.objects.size()));
    auto& objects = editor->live.view.parts.objects;
    auto& memory = editor->live.memory;
    // Room first: the object must not be added without its part.
    objects.reserve(objects.size() + 1);
    memory.reserve(objects.size() + 1);
    Part own = given.objects[0];
    auto own_memory = given.memory;
    const std::uint32_t number = editor->editor.add(placed.scene, placed.placement);
    if (number >= objects.size()) objects.resize(number + 1), memory.resize(number + 1);
    objects[number] = std::move(own);
    memory[number] = std::move(own_memory);
    if (placed.mask) editor->editor.set_mask(number, *placed.mask);
    *object = number;
  });
}

scarp_status scarp_editor_move(scarp_editor* editor, uint32_t object, const scarp_part* place) {
  return guarded([&] {
    const scarp::Placement placement = placement_from(required(place, "place"));
    require_reach(placement);
    required(editor, "editor").editor.move(object, placement);
  });
}

scarp_status scarp_editor_remove(scarp_editor* editor, uint32_t object) {
  return guarded([&] {
    required(editor, "editor").editor.remove(object);
    editor->live.view.parts.objects[object] = {};
    editor->live.memory[object].clear();
  });
}

void scarp_live_release(scarp_live* live) { delete live; }
