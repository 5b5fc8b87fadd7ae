// SPDX-License-Identifier: MIT
// Private to the station: the first drawing of a device.
#pragma once

#include "scarp/vk/device.h"

namespace scarp {

/// Draws a triangle on a device that has not drawn yet. Throws Error if that does not finish within ten seconds: some
/// drivers offer graphics that never finish, and programs would wait for the time limit of the settings.
void try_first_drawing(const Device& device);

}  // namespace scarp
