// SPDX-License-Identifier: MIT
#include "scarp/render/look/look.h"

#include <array>
#include <cstddef>

#include "scarp/base/setting.h"

namespace scarp {
namespace {

constexpr std::array<LookEntry, kLookCount> kLooks = {{
    {.look = Look::shaded, .name = "shaded", .lit = true, .antialiased = true},
    {.look = Look::hillshade, .name = "hillshade"},
    {.look = Look::height, .name = "height"},
    {.look = Look::steps, .name = "steps", .measures = true},
    {.look = Look::cost, .name = "cost", .measures = true},
    {.look = Look::error, .name = "error", .measures = true},
    {.look = Look::comanche, .name = "comanche", .lit = true, .large_pixels = true},
    {.look = Look::level, .name = "level", .measures = true},
    {.look = Look::slope, .name = "slope", .measures = true},
    {.look = Look::aspect, .name = "aspect", .measures = true},
    {.look = Look::multidirectional, .name = "multidirectional", .measures = true},
}};

constexpr std::array<std::string_view, kLooks.size()> look_names() {
  std::array<std::string_view, kLooks.size()> all{};
  for (std::size_t i = 0; i < kLooks.size(); ++i) all[i] = kLooks[i].name;
  return all;
}
constexpr auto kLookNames = look_names();

static_assert([] {
  for (std::size_t i = 0; i < kLooks.size(); ++i) {
    if (static_cast<std::size_t>(kLooks[i].look) != i) return false;
  }
  return true;
}());

}  // namespace

std::span<const LookEntry> looks() { return kLooks; }

const LookEntry& entry_of(Look look) { return kLooks[static_cast<std::size_t>(look)]; }

std::string_view name_of(Look look) { return entry_of(look).name; }

Look find_look(std::string_view name) { return static_cast<Look>(find_setting("look", kLookNames, name)); }

}  // namespace scarp
