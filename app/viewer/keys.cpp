// SPDX-License-Identifier: MIT
#include "app/viewer/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <utility>

namespace scarp::viewer {
namespace {

template <class Value, std::size_t Count>
std::optional<Value> find(const std::array<std::pair<int, Value>, Count>& table, int key) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto& row) { return row.first == key; });
  return found == table.end() ? std::nullopt : std::optional(found->second);
}

constexpr std::array<std::pair<int, WindowAction>, 13> kActions = {{
    {GLFW_KEY_O, WindowAction::orbit},
    {GLFW_KEY_F, WindowAction::fly},
    {GLFW_KEY_G, WindowAction::walk},
    {GLFW_KEY_T, WindowAction::top},
    {GLFW_KEY_H, WindowAction::first_view},
    {GLFW_KEY_M, WindowAction::measure},
    {GLFW_KEY_K, WindowAction::keep_in_path},
    {GLFW_KEY_C, WindowAction::copy},
    {GLFW_KEY_P, WindowAction::save},
    {GLFW_KEY_F5, WindowAction::reopen},
    {GLFW_KEY_TAB, WindowAction::panel},
    {GLFW_KEY_F1, WindowAction::help},
    {GLFW_KEY_ESCAPE, WindowAction::escape},
}};

constexpr std::array<std::pair<int, MoveKey>, 8> kMoves = {{
    {GLFW_KEY_W, MoveKey::forward},
    {GLFW_KEY_S, MoveKey::back},
    {GLFW_KEY_A, MoveKey::left},
    {GLFW_KEY_D, MoveKey::right},
    {GLFW_KEY_E, MoveKey::up},
    {GLFW_KEY_Q, MoveKey::down},
    {GLFW_KEY_LEFT_SHIFT, MoveKey::fast},
    {GLFW_KEY_RIGHT_SHIFT, MoveKey::fast},
}};

constexpr std::array<HelpLine, 17> kHelp = {{
    {"left drag", "turn, look around; top: shift"},
    {"right or middle drag", "shift"},
    {"Ctrl and left drag", "move the sun"},
    {"drag of the line", "compared pictures: show more of one of them"},
    {"wheel", "nearer; fly and walk: speed"},
    {"double click", "go there"},
    {"W A S D, Q E, Shift", "fly and walk: move; down and up; faster"},
    {"O, F, G, T", "orbit, fly, walk, top (a map)"},
    {"H", "the first view"},
    {"Ctrl 1 to 9, 1 to 9", "keep a view, return to it"},
    {"M", "measure between two clicks"},
    {"K", "add the view to scarp-path.csv, for scarp render --path"},
    {"C", "copy the command that makes the picture again"},
    {"P", "save the picture"},
    {"F5", "open the input again"},
    {"Tab", "hide the panel"},
    {"F1, Esc", "this list; close"},
}};

}  // namespace

std::optional<WindowAction> action_of(int key) { return find(kActions, key); }
std::optional<MoveKey> move_key_of(int key) { return find(kMoves, key); }
std::span<const HelpLine> help_lines() { return kHelp; }

}  // namespace scarp::viewer
