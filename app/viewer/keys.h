// SPDX-License-Identifier: MIT
// Bindings of mouse and keys: one table for the window and for its help.
#pragma once

#include <optional>
#include <span>

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
  help,
  escape
};

struct HelpLine {
  const char* input;   ///< "left drag"
  const char* effect;  ///< "turn, look around; top: shift"
};

/// The action of a key press, by GLFW's number.
std::optional<WindowAction> action_of(int key);
/// The movement of a key while it is held.
std::optional<MoveKey> move_key_of(int key);
std::span<const HelpLine> help_lines();

}  // namespace scarp::viewer
