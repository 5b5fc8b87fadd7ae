// SPDX-License-Identifier: MIT
#include "scarp/source/vertical_unit.h"

#include <gtest/gtest.h>

namespace scarp {
namespace {

TEST(VerticalUnit, MetresHaveManyNames) {
  for (const char* name : {"m", "M", "metre", "Metres", "meter", "METERS"})
    EXPECT_EQ(1, metres_per_vertical_unit(name)) << name;
}

TEST(VerticalUnit, TheTwoFeetDiffer) {
  for (const char* name : {"ft", "foot", "Feet", "International foot", "foot (international)"})
    EXPECT_EQ(0.3048, metres_per_vertical_unit(name)) << name;
  for (const char* name : {"us-ft", "ftUS", "US survey foot", "U.S. Survey Feet", "Foot_US"})
    EXPECT_EQ(1200.0 / 3937, metres_per_vertical_unit(name)) << name;
}

TEST(VerticalUnit, WhatIsNoLengthIsNone) {
  for (const char* name : {"", " ", "K", "degrees", "furlong", "metre foot"})
    EXPECT_FALSE(metres_per_vertical_unit(name).has_value()) << name;
}

}  // namespace
}  // namespace scarp
