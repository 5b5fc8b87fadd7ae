// SPDX-License-Identifier: MIT
// Results of `scarp render` besides the picture.
#pragma once

#include "scarp/render/frame/picture.h"

namespace scarp::cli {

/// Prints steps, heights or verdicts, depending on the look.
void print_findings(const Picture& picture);

}  // namespace scarp::cli
