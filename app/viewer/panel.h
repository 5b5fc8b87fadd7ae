// SPDX-License-Identifier: MIT
// The panel over the picture: what can be set, what the picture costs, what is under the cursor.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/viewer/navigation.h"
#include "app/viewer/opening.h"
#include "app/viewer/picture_worker.h"
#include "app/viewer/reading.h"
#include "scarp/render/frame/picture.h"

namespace scarp::viewer {

/// What the panel shows and changes.
struct PanelState {
  PictureSettings* picture;                  ///< changed in place
  std::vector<std::string> marches{};        ///< that the input has
  std::string march{};                       ///< in use; a change asks for the input to be opened again
  std::vector<MarchParameter> parameters{};  ///< of the march; changed in place
  MoveMode mode = MoveMode::orbit;           ///< as `march`
  double speed = 0;                          ///< metres per second
  std::string device{};                      ///< that answers rays
  const WorkedPicture* shown = nullptr;      ///< the picture in the window
  bool times = true;                         ///< how long it took, too
  bool busy = false;
  std::optional<Reading> reading{};
  std::optional<MeasuredLine> line{};
  bool measures = false;  ///< clicks set the ends of a line
  bool help = false;
  std::string message{};  ///< the last one: saved, copied, failed
};

struct PanelActions {
  bool picture_changed = false, parameter_changed = false, save = false, copy = false;
  std::optional<std::string> march{};
  std::optional<MoveMode> mode{};
};

/// Draws the panel between ImGui::NewFrame() and ImGui::Render().
PanelActions draw_panel(PanelState& state);

}  // namespace scarp::viewer
