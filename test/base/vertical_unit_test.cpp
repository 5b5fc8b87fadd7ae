// SPDX-License-Identifier: MIT
#include "scarp/base/vertical_unit.h"

#include <gtest/gtest.h>

namespace scarp {
namespace {

TEST(VerticalUnit, MetresHaveManyNames) {
  for (const char* name : {"m", "M", "metre", "Metres", "meter", "METERS"})
    EXPECT_EQ(1, metres_per_vertical_unit(name)) << name;
}

TEST(VerticalUnit, DistinguishesTheTwoFeet) {
  for (const char* name : {"ft", "foot", "Feet", "International foot", "foot (international)"})
    EXPECT_EQ(0.3048, metres_per_vertical_unit(name)) << name;
  for (const char* name : {"us-ft", "ftUS", "US survey foot", "U.S. Survey Feet", "Foot_US"})
    EXPECT_EQ(1200.0 / 3937, metres_per_vertical_unit(name)) << name;
}

TEST(VerticalUnit, RecognisesAFootByItsLength) {
  EXPECT_EQ("ft", foot_of(0.3048));
  EXPECT_EQ("us-ft", foot_of(0.30480060960121924));
  EXPECT_EQ("ft", foot_of(0.3047972654)) << "Clarke's";
  EXPECT_EQ("ft", foot_of(0.30479951)) << "the Indian";
  for (const double other : {0.0, 1.0, 0.9144, 0.3, 0.31, 0.201168}) EXPECT_EQ("", foot_of(other)) << other;
}

TEST(VerticalUnit, RejectsUnitsThatAreNotLengths) {
  for (const char* name :
       {"", " ", "K", "degrees", "furlong", "metre foot", "1/3 ft", "10 m", "m/s", "m^2", "m*0.1", "% m"})
    EXPECT_FALSE(metres_per_vertical_unit(name).has_value()) << name;
}

}  // namespace
}  // namespace scarp
