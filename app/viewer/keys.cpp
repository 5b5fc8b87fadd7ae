// SPDX-License-Identifier: MIT
#include "app/viewer/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace scarp::viewer {
namespace {

template <class Value, std::size_t Count>
std::optional<Value> find(const std::array<std::pair<int, Value>, Count>& table, int key) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto& row) { return row.first == key; });
  return found == table.end() ? std::nullopt : std::optional(found->second);
}

constexpr std::array<std::pair<int, WindowAction>, 29> kActions = {{
    {GLFW_KEY_O, WindowAction::orbit},        {GLFW_KEY_F, WindowAction::fly},
    {GLFW_KEY_G, WindowAction::walk},         {GLFW_KEY_T, WindowAction::top},
    {GLFW_KEY_H, WindowAction::first_view},   {GLFW_KEY_M, WindowAction::measure},
    {GLFW_KEY_K, WindowAction::keep_in_path}, {GLFW_KEY_C, WindowAction::copy},
    {GLFW_KEY_P, WindowAction::save},         {GLFW_KEY_X, WindowAction::through_ground},
    {GLFW_KEY_V, WindowAction::observe},      {GLFW_KEY_N, WindowAction::horizon},
    {GLFW_KEY_U, WindowAction::sun},          {GLFW_KEY_SPACE, WindowAction::play_sun},
    {GLFW_KEY_R, WindowAction::copy_reading}, {GLFW_KEY_F11, WindowAction::full_screen},
    {GLFW_KEY_EQUAL, WindowAction::nearer},   {GLFW_KEY_KP_ADD, WindowAction::nearer},
    {GLFW_KEY_MINUS, WindowAction::farther},  {GLFW_KEY_KP_SUBTRACT, WindowAction::farther},
    {GLFW_KEY_LEFT, WindowAction::look_left}, {GLFW_KEY_RIGHT, WindowAction::look_right},
    {GLFW_KEY_UP, WindowAction::look_up},     {GLFW_KEY_DOWN, WindowAction::look_down},
    {GLFW_KEY_F5, WindowAction::reopen},      {GLFW_KEY_TAB, WindowAction::panel},
    {GLFW_KEY_F6, WindowAction::panel_keys},  {GLFW_KEY_F1, WindowAction::help},
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

// The label of a position, in capitals: "Z" for W on an AZERTY keyboard. Before there is a window, the US label.
std::string label_of(int key) {
  const char* const name = glfwGetKeyName(key, 0);
  std::string label = name && *name ? name : std::string(1, static_cast<char>(key));
  if (label.size() == 1) label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  return label;
}

}  // namespace

int letter_of(int key, int scancode) {
  if (key != GLFW_KEY_UNKNOWN && (key < GLFW_KEY_SPACE || key > GLFW_KEY_WORLD_2)) return key;
  const char* const name = glfwGetKeyName(key, scancode);
  if (!name || !name[0] || name[1]) return key;
  if (name[0] == '+') return GLFW_KEY_EQUAL;
  if (name[0] == '-') return GLFW_KEY_MINUS;
  const int capital = std::toupper(static_cast<unsigned char>(name[0]));
  return capital >= GLFW_KEY_A && capital <= GLFW_KEY_Z ? capital : key;
}

bool repeats(int letter) {
  const auto action = action_of(letter);
  return action &&
         (*action == WindowAction::observe || (*action >= WindowAction::nearer && *action <= WindowAction::look_down));
}

std::optional<WindowAction> action_of(int letter) { return find(kActions, letter); }
std::optional<MoveKey> move_key_of(int key) { return find(kMoves, key); }

std::vector<HelpLine> help_lines() {
  std::string moves;
  for (const int key : {GLFW_KEY_W, GLFW_KEY_A, GLFW_KEY_S, GLFW_KEY_D}) moves += label_of(key) + ' ';
  moves.back() = ',';
  moves += ' ' + label_of(GLFW_KEY_Q) + ' ' + label_of(GLFW_KEY_E) + ", Shift";
  return {{"left drag", "turn, look around; top: shift"},
          {"right or middle drag", "shift"},
          {"Ctrl and left drag", "move the sun"},
          {"drag of the line", "compared pictures: show more of one of them"},
          {"arrows, +, -", "as a drag, as the wheel"},
          {"wheel", "towards the cursor; fly and walk: speed"},
          {"double click", "go there"},
          {moves, "fly and walk: move; down and up; faster"},
          {"O, F, G, T", "orbit, fly, walk, top (a map of everything)"},
          {"X", "let the eye go through the ground, or not"},
          {"H", "the first view"},
          {"Ctrl 1 to 9, 1 to 9", "keep a view, return to it"},
          {"M", "measure between two clicks"},
          {"V", "what one sees from under the cursor (held: follows it)"},
          {"N", "the horizon under the cursor, as a polar plot"},
          {"U, Space", "the sun of a date and time; play its day"},
          {"K", "add the view to a path, for scarp render --path"},
          {"C", "copy the command of the picture, or of the answers shown"},
          {"P", "save the picture"},
          {"R", "copy the coordinates under the cursor"},
          {"Ctrl Z, Ctrl Y", "take a change of the panel back, make it again"},
          {"F5", "open the input again"},
          {"F6", "keys for the panel: Tab, Space, arrows; Esc ends it"},
          {"Ctrl +, Ctrl -", "larger, smaller text"},
          {"Tab, F11", "hide the panel; full screen"},
          {"F1", "this list"},
          {"Esc", "remove the observer, end measuring, close lists, the window"},
          {"Ctrl Q", "close the window"}};
}

}  // namespace scarp::viewer
