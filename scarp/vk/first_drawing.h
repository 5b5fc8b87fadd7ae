// SPDX-License-Identifier: MIT
// Private to the station: the first drawing of a device.
#pragma once

#include "scarp/vk/device.h"

namespace scarp {

/// Draws a triangle on a device that has not drawn yet, before anything is asked of it that would take long. Throws
/// Error if that does not finish within seconds: some drivers offer graphics that never answer, and what waits for them
/// would wait for the limit of the settings.
void try_first_drawing(const Device& device);

}  // namespace scarp
