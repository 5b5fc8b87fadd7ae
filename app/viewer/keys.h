// SPDX-License-Identifier: MIT
// What mouse and keys do: one table for the window and for its help.
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

/// What a key does when it is pressed, by GLFW's number.
std::optional<WindowAction> action_of(int key);
/// The key that moves while it is held.
std::optional<MoveKey> move_key_of(int key);
std::span<const HelpLine> help_lines();

}  // namespace scarp::viewer
