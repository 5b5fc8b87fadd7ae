// SPDX-License-Identifier: MIT
// The window of `scarp view`: events move the navigator, the worker renders its views, and the presenter shows them.
#pragma once

#include "app/viewer/opening.h"

namespace scarp::viewer {

/// Opens the window and returns when it is closed, or when the recording has been played. Throws Error if there is no
/// display or device, or an input cannot be read.
void run_viewer(Opening opening);

}  // namespace scarp::viewer
