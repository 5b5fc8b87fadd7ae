// SPDX-License-Identifier: MIT
// resolve(): a request takes precedence over the input's request, and the latter over the defaults.
#include <gtest/gtest.h>

#include <cmath>

#include "scarp/base/error.h"
#include "scarp/render/frame/picture_request.h"

namespace scarp::test {
namespace {

TEST(PictureRequest, EmptyRequestGivesTheDefaultSettings) {
  const PictureSettings picture = resolve({}, {}), usual;
  EXPECT_EQ(picture.width, usual.width);
  EXPECT_EQ(picture.height, usual.height);
  EXPECT_EQ(picture.look, usual.look);
  EXPECT_EQ(picture.sun.azimuth_deg, usual.sun.azimuth_deg);
  EXPECT_EQ(picture.haze, usual.haze);
  EXPECT_TRUE(picture.shadows);
  EXPECT_FALSE(picture.water);
}

TEST(PictureRequest, OverridesTheRequestOfTheInput) {
  PictureSubject subject;
  subject.own.samples = 4, subject.own.sun_azimuth_deg = 235, subject.own.shadows = false, subject.own.width = 400;
  PictureRequest asked;
  asked.samples = 16;
  const PictureSettings picture = resolve(asked, subject);
  EXPECT_EQ(picture.samples, 16);
  EXPECT_EQ(picture.sun.azimuth_deg, 235);
  EXPECT_EQ(picture.width, 400);
  EXPECT_FALSE(picture.shadows);
}

TEST(PictureRequest, FogKindReplacesAllFogOfTheInput) {
  PictureSubject subject;
  subject.own.fog = FogKind::height, subject.own.visibility = 900, subject.own.fog_falloff = 14;
  EXPECT_EQ(resolve({}, subject).fog.visibility, 900);
  PictureRequest asked;
  asked.fog = FogKind::height;
  const FogSettings fog = resolve(asked, subject).fog;
  EXPECT_EQ(fog.visibility, FogSettings{}.visibility);
  EXPECT_NE(fog.falloff, 14);
}

TEST(PictureRequest, HazeReplacesTheHazeDistanceOfTheInput) {
  PictureSubject subject;
  subject.own.haze = 0, subject.own.haze_distance = 500;
  EXPECT_EQ(resolve({}, subject).haze_distance, 500);
  PictureRequest asked;
  asked.haze = 0.3;
  EXPECT_EQ(resolve(asked, subject).haze, 0.3);
  EXPECT_TRUE(std::isinf(resolve(asked, subject).haze_distance));
}

TEST(PictureRequest, ExaggeratesHeightsLikeTheGround) {
  PictureSubject subject;
  subject.heights = {200, 600}, subject.exaggeration = 2;
  PictureRequest asked;
  asked.snow_line = 200, asked.water_level = 120;
  const PictureSettings picture = resolve(asked, subject);
  EXPECT_DOUBLE_EQ(picture.ground.snow_share, 0.5);
  EXPECT_EQ(picture.water->level, 120);  // Water exaggerates its level itself.
  EXPECT_DOUBLE_EQ(picture.fog.base, 240);
  EXPECT_DOUBLE_EQ(picture.fog.falloff, 100);
}

TEST(PictureRequest, DistantCamerasSeeFartherThroughFog) {
  PictureSubject subject;
  subject.across = 1000;
  subject.box = {{0, 0, 0}, {100, 100, 10}};
  const Camera camera = Camera::look_at({50, -300, 5}, {50, 50, 5}, 30, 64, 36);
  EXPECT_DOUBLE_EQ(resolve({}, subject).fog.visibility, 1000);
  EXPECT_DOUBLE_EQ(resolve({}, subject, &camera).fog.visibility, 1000 + 10 * 300);
  PictureRequest asked;
  asked.visibility = 700;
  EXPECT_DOUBLE_EQ(resolve(asked, subject, &camera).fog.visibility, 700);
}

TEST(PictureRequest, MapHasTheShapeOfTheGroundByDefault) {
  PictureSubject subject;
  subject.map = WorldBox{{0, 0, 0}, {2000, 500, 10}};
  const PictureSettings picture = resolve({}, subject);
  EXPECT_EQ(picture.width, 1280);
  EXPECT_EQ(picture.height, 320);
  PictureRequest asked;
  asked.width = 100, asked.height = 100;
  EXPECT_EQ(resolve(asked, subject).height, 100);
}

TEST(PictureRequest, HeightsInLargePixelsUseTheRaysOfComanche) {
  PictureRequest asked;
  asked.look = Look::height, asked.low_resolution = ImageSize{80, 60}, asked.aa = 4;
  const PictureSettings picture = resolve(asked, {});
  EXPECT_EQ(picture.look, Look::comanche);
  EXPECT_TRUE(picture.comanche.heights);
  EXPECT_EQ(picture.width, 80);
  EXPECT_EQ(picture.aa, 1);
  EXPECT_FALSE(picture.shadows);
}

TEST(PictureRequest, ErrorNamesTheSettingOutOfRange) {
  PictureRequest asked;
  asked.sun_azimuth_deg = 0, asked.sun_altitude_deg = -5;
  try {
    resolve(asked, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("altitude"), std::string::npos);
  }
}

TEST(PictureRequest, OnlyAScatteringSkyHasTwilight) {
  PictureRequest asked;
  asked.sun_altitude_deg = 0;
  EXPECT_THROW(resolve(asked, {}), Error);
  asked.sky = SkyKind::scattering;
  for (const double altitude : {0.0, -4.0, kLowestSun}) {
    asked.sun_altitude_deg = altitude;
    EXPECT_EQ(resolve(asked, {}).sun.altitude_deg, altitude);
  }
  asked.sun_altitude_deg = kLowestSun - 0.1;
  EXPECT_THROW(resolve(asked, {}), Error);
}

}  // namespace
}  // namespace scarp::test
