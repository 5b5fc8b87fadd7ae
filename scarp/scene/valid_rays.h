// SPDX-License-Identifier: MIT
// Private to the station: the check of a batch before its queries.
#pragma once

#include <cstddef>
#include <span>

#include "scarp/scene/scene.h"

namespace scarp {

/// Throws Error for the first invalid ray, even if a thread finds another one earlier. For the message, the rays are
/// part of a batch of `all` rays and start at its index `first`.
void require_valid(std::span<const Ray> rays, std::span<const Hit* const> from, const Scene& scene, std::size_t first,
                   std::size_t all);

/// The rays of a batch that cannot be traced. At their indices `rays` and `from` get a ray that can.
std::vector<std::size_t> replace_invalid(std::span<Ray> rays, std::span<const Hit*> from, const Scene& scene);

}  // namespace scarp
