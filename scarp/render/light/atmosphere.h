// SPDX-License-Identifier: MIT
// The radiance of a clear sky, integrated through a spherical atmosphere as in E. Bruneton, F. Neyret, "Precomputed
// atmospheric scattering", EGSR 2008, with the light that is scattered more than once as in S. Hillaire, "A scalable
// and production ready sky and atmosphere rendering technique", EGSR 2020.
//
//   air       Rayleigh scattering, scale height 8 km
//   aerosols  Angstrom's turbidity formula (A. J. Preetham, P. Shirley, B. Smits, SIGGRAPH 1999, appendix A.1), scale
//             height 1.2 km; phase function of Henyey and Greenstein
//   ozone     absorption between 10 and 40 km; it makes twilight blue
//   depths    air masses by C. Schueler, "An approximation to the Chapman grazing-incidence function", GPU Pro 3, 2012:
//             within 7 % of F. Kasten's (1965) from 10 degrees on
//
// Light scattered more than once has no direction: at each point it is the mean of the light scattered once, times the
// sum of a geometric series. Red, green and blue are single wavelengths: 680, 550 and 440 nm.
#pragma once

#include <array>

#include "scarp/base/vec.h"

namespace scarp {

class Atmosphere {
 public:
  /// `turbidity`: extinction relative to pure air, 2..10. `altitude` of the sun in radians, also below the horizon.
  Atmosphere(double turbidity, double altitude);

  /// Unit vector to the sun, at y = 0.
  const dvec3& to_sun() const { return to_sun_; }
  /// Radiance of the sky 1,000 m above the sea towards a unit vector with z >= 0, for a sun with an irradiance of 1 in
  /// each channel outside the atmosphere. Without the sun itself.
  dvec3 radiance(const dvec3& direction) const;
  /// Irradiance of a surface at that height that faces a sun at this altitude, radians, 0 or more.
  dvec3 sunlight(double altitude) const;

 private:
  struct End;
  template <class F>
  End walk(const dvec3& from, const dvec3& direction, int steps, const F& at) const;
  dvec3 sun_at(double radius, double cosine) const;
  dvec3 scattered_often(double radius, double altitude) const;
  dvec3 more_at(double radius, double altitude) const;

  static constexpr int kHeights = 6, kSuns = 9;

  dvec3 air_, aerosol_, ozone_;  // vertical optical depths from sea level
  double altitude_;
  dvec3 to_sun_;
  std::array<std::array<dvec3, kSuns>, kHeights> more_;  // by height, and by altitude of the sun
};

}  // namespace scarp
