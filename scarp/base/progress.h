// SPDX-License-Identifier: MIT
// Progress of a long task, and a way to stop it.
#pragma once

#include <functional>

namespace scarp {

/// Callback that receives the completed fraction, 0..1, from one thread at a time. The fraction never decreases, but
/// starts again at 0 with each part of a task (each file of a scene). If the callback returns false, the task throws
/// Interrupted. An empty function disables reports.
using Progress = std::function<bool(double)>;

}  // namespace scarp
