// SPDX-License-Identifier: MIT
// Progress of a long task, and the way to stop it.
#pragma once

#include <functional>

namespace scarp {

/// Called now and then with the share that is done, 0..1, from one thread at a time. It never falls; where a task has
/// parts, such as the files of a scene, it begins anew with each. Returning false stops the task, which then throws
/// Interrupted. An empty function means: no reports, no stop.
using Progress = std::function<bool(double)>;

}  // namespace scarp
