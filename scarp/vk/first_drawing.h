// SPDX-License-Identifier: MIT
// Private to the station: the first drawing on a device.
#pragma once

#include "scarp/vk/device.h"

namespace scarp {

/// Draws a triangle on a device that has not drawn yet. Throws Error if this does not finish within ten seconds: with
/// some drivers, drawing never finishes, and programs would wait for the time limit of the settings.
void try_first_drawing(const Device& device);

}  // namespace scarp
