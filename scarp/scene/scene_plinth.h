// SPDX-License-Identifier: MIT
// The plinth below a terrain as an object of a scene: it is seen, but throws no shadow and is no ground.
#pragma once

#include "scarp/scene/scene.h"

namespace scarp {

/// The plinth of a field, down to plinth_base(). The field must have valid samples and must not wrap round.
SceneFieldPtr scene_plinth(const HeightField& field);

/// A scene of one height field with its plinth; the same scene where there can be none: ground that wraps round, or
/// has nothing to see.
Scene with_plinth(const Scene& terrain);

}  // namespace scarp
