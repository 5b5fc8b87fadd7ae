// SPDX-License-Identifier: MIT
// Private to the station: the check of a batch before its queries.
#pragma once

#include <cstddef>
#include <span>

#include "scarp/scene/scene.h"

namespace scarp {

/// Throws Error for the first invalid ray, whichever the threads find first. The rays are those from `first` on of a
/// batch of `all`, for the message.
void require_valid(std::span<const Ray> rays, std::span<const Hit* const> from, const Scene& scene, std::size_t first,
                   std::size_t all);

}  // namespace scarp
