// SPDX-License-Identifier: MIT
// Words of the window's input for the commands of maps.
#pragma once

#include <string>

#include "app/options/command.h"

namespace scarp::viewer {

/// The typed words of `scarp view` that name a raster and say how it is read, with a space in front.
std::string raster_words(const cli::Command& view);

}  // namespace scarp::viewer
