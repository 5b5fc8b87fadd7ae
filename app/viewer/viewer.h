// SPDX-License-Identifier: MIT
// The window of `scarp view`: events move the navigator, its views go to the worker, whose pictures are presented.
#pragma once

#include "app/viewer/opening.h"

namespace scarp::viewer {

/// Opens the window and returns when it is closed, or when the recording was played. Throws Error: no display, no
/// device, an input that cannot be read.
void run_viewer(Opening opening);

}  // namespace scarp::viewer
