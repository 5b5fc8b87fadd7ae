// SPDX-License-Identifier: MIT
// Progress of a long task, and the way to stop it.
#pragma once

#include <functional>

namespace scarp {

/// Called now and then with the share that is done, 0..1 and never less than before, from one thread at a time.
/// Returning false stops the task, which then throws Interrupted. An empty function means: no reports, no stop.
using Progress = std::function<bool(double)>;

}  // namespace scarp
