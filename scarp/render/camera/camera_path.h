// SPDX-License-Identifier: MIT
// A smooth flight through all of a list of points, at a speed that follows their distances.
//
// Eye and target each run along a Catmull-Rom spline in its centripetal form (C. Yuksel et al., "Parameterization and
// applications of Catmull-Rom curves", 2011), which has neither loops nor cusps between its points. Both share the
// eye's parameter: at every station the camera looks at the station's target.
#pragma once

#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

struct CameraStation {
  dvec3 eye;     ///< metres
  dvec3 target;  ///< metres, not the eye
};

class CameraPath {
 public:
  /// Throws Error if there are no stations.
  explicit CameraPath(std::vector<CameraStation> stations);

  /// Returns the station at a fraction of the path, 0 (the first) to 1 (the last).
  CameraStation at(double share) const;

 private:
  std::vector<CameraStation> stations_;
  std::vector<double> knots_;  // ascending; one per station
};

}  // namespace scarp
