// SPDX-License-Identifier: MIT
// Mouse and key events as text, one event per line: "1.25 move 320 240". A recording is played with a simulated clock,
// so it ends at the same view on every machine. "2 option --water 120" and "2 compare march naive" set options of the
// panel, independent of the position of its controls.
#pragma once

#include <string>
#include <vector>

namespace scarp::viewer {

struct WindowEvent {
  enum class Kind { move, button, key, wheel, text, option, compare };
  double seconds = 0;  ///< since the window opened
  Kind kind = Kind::move;
  int code = 0;         ///< GLFW's number of the button, or of the key's position on a US keyboard
  int letter = 0;       ///< keys: GLFW's number of the letter that the user's layout has there; 0: as `code`
  bool down = false;    ///< pressed
  int modifiers = 0;    ///< GLFW's bits
  double x = 0, y = 0;  ///< move: the cursor, in pixels; wheel: y is the steps
  std::string text{};   ///< text: what was typed, UTF-8; option: "--water 120", or "--water" to remove it; compare:
                        ///< "march naive"
  int line = 0;         ///< line number in the file
};

struct Recording {
  int width = 1280, height = 720;  ///< of the window
  std::vector<WindowEvent> events{};
};

/// Throws Error naming the file and the line.
Recording read_recording(const std::string& file);
/// Throws Error if the file cannot be written.
void write_recording(const std::string& file, const Recording& recording);

}  // namespace scarp::viewer
