// SPDX-License-Identifier: MIT
// Bindings of mouse and keys: one table for the window and for its help. Actions have the letters of the user's layout,
// movements the positions of W A S D Q E on a US keyboard.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/viewer/navigation.h"

namespace scarp::viewer {

enum class WindowAction {
  orbit,
  fly,
  walk,
  top,
  first_view,
  measure,
  keep_in_path,
  copy,
  save,
  reopen,
  panel,
  panel_keys,
  help,
  through_ground,
  copy_reading,
  observe,
  horizon,
  sun,
  play_sun,
  full_screen,
  nearer,
  farther,
  look_left,
  look_right,
  look_up,
  look_down,
  escape
};

struct HelpLine {
  std::string input;   ///< "left drag"
  const char* effect;  ///< "turn, look around; top: shift"
};

/// The key that the user's layout labels with the same letter as GLFW's number of a key does on a US keyboard; that
/// key itself without a Latin letter.
int letter_of(int key, int scancode);
/// Whether a held key acts again and again.
bool repeats(int letter);
/// The action of a key press, by GLFW's number of its letter.
std::optional<WindowAction> action_of(int letter);
/// The movement of a key while it is held, by GLFW's number of its position.
std::optional<MoveKey> move_key_of(int key);
/// Bindings, with the labels that the user's layout gives to positions.
std::vector<HelpLine> help_lines();

}  // namespace scarp::viewer
