// SPDX-License-Identifier: MIT
// Radiation of the sun under a clear sky, by the model of the European Solar Radiation Atlas: C. Rigollier, O. Bauer,
// L. Wald, "On the clear sky model of the ESRA - European Solar Radiation Atlas - with respect to the Heliosat method",
// Solar Energy 68(1), 2000; the optical thickness and the air mass are those of F. Kasten, "The Linke turbidity factor
// based on improved values of the integral Rayleigh optical thickness", Solar Energy 56(3), 1996, and F. Kasten,
// A. T. Young, "Revised optical air mass tables and approximation formula", Applied Optics 28(22), 1989. Or by one
// transmittance of the atmosphere: B. Y. H. Liu, R. C. Jordan, "The interrelationship and characteristic distribution
// of direct, diffuse and total solar radiation", Solar Energy 4(3), 1960.
#pragma once

#include <optional>

namespace scarp {

/// Watts per square metre, 0 or more.
struct ClearSky {
  double beam = 0;     ///< on a plane that faces the sun
  double diffuse = 0;  ///< of the whole sky, on a horizontal plane
};

/// `altitude`: of the sun, radians, without refraction; 0 or less: no radiation. `height`: metres above the sea.
/// `day_of_year`: 1 to 366. `linke`: turbidity of Linke for an air mass of 2, 1 (clean and dry) to 8 (polluted).
ClearSky clear_sky(double altitude, double height, double day_of_year, double linke);

/// With a transmittance, above 0, at most 1, that of the beam from the zenith down to the sea, instead of `linke`: the
/// beam is transmittance^(air mass) of that outside the atmosphere, and the diffuse 0.2710 - 0.2939 transmittance^(air
/// mass above the sea) of what falls on a horizontal plane there; 0 where that is negative, in air clearer than the
/// formula's. nullopt: by `linke`.
ClearSky clear_sky(double altitude, double height, double day_of_year, double linke,
                   std::optional<double> transmittance);

}  // namespace scarp
