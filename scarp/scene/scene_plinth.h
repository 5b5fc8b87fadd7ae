// SPDX-License-Identifier: MIT
// The plinth below a terrain as an object of a scene: it is visible, but casts no shadow and is not ground.
#pragma once

#include "scarp/scene/scene.h"

namespace scarp {

/// The plinth of a field, down to plinth_base(). The field must have valid samples and must not wrap.
SceneFieldPtr scene_plinth(const HeightField& field);

/// Returns a scene of one height field with its plinth. Returns the same scene if it cannot have one: the ground wraps,
/// or nothing is visible.
Scene with_plinth(const Scene& terrain);

}  // namespace scarp
