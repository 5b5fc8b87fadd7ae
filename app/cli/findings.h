// SPDX-License-Identifier: MIT
// What `scarp render` found besides the picture.
#pragma once

#include "scarp/render/frame/picture.h"

namespace scarp::cli {

/// Steps, heights, verdicts: those that the picture's look has.
void print_findings(const Picture& picture);

}  // namespace scarp::cli
