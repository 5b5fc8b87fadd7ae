// SPDX-License-Identifier: MIT
// Progress of a task that consists of several equal parts.
#pragma once

#include "scarp/base/progress.h"

namespace scarp {

/// Progress of part `i`, from 0, of `count` equal parts of a task.
inline Progress progress_part(const Progress& all, double i, double count) {
  return all ? Progress([all, i, count](double share) { return all((i + share) / count); }) : Progress();
}

}  // namespace scarp
