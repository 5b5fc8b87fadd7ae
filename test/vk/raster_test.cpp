// SPDX-License-Identifier: MIT
// Triangles into colours and depths, on a real device.
#include "scarp/vk/raster.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "scarp/vk/commands.h"
#include "test/vk/corners.glsl.h"
#include "test/vk/device_under_test.h"

namespace scarp {
namespace {

constexpr std::uint32_t kVertex[] = {
#include "test/vk/corners.vert.inc"
};
constexpr std::uint32_t kFragment[] = {
#include "test/vk/corners.frag.inc"
};

constexpr std::uint32_t kWidth = 64, kHeight = 32;
using glm::vec4;

using test::refusal;

class Drawing : public test::OnDevice {
 protected:
  DeviceBuffer buffer_of(const std::vector<vec4>& corners) {
    DeviceBuffer buffer(device(), sizeof(vec4) * corners.size(), "corners");
    upload(buffer, 0, corners.data(), buffer.bytes());
    return buffer;
  }
  RasterPipeline pipeline(const RasterSettings& settings = {.push_bytes = sizeof(glsl::CornersPush)}) {
    return {device(), kVertex, kFragment, "corners", settings};
  }

  struct Images {
    std::vector<vec4> colours = std::vector<vec4>(kWidth * kHeight);
    std::vector<float> depths = std::vector<float>(kWidth * kHeight);
    std::vector<PassTime> passes;
  };
  Images draw(std::initializer_list<DrawCall> calls) {
    const RasterTarget target(device(), kWidth, kHeight, 1);
    const DeviceBuffer colours(device(), 16 * kWidth * kHeight, "colours"),
        depths(device(), 4 * kWidth * kHeight, "depths");
    Commands commands(device());
    commands.draw(target, calls);
    commands.copy(target, 0, colours);
    commands.copy(target, 1, depths);
    commands.run();
    Images images;
    download(colours, 0, images.colours.data(), colours.bytes());
    download(depths, 0, images.depths.data(), depths.bytes());
    images.passes = commands.passes();
    return images;
  }
};

constexpr vec4 kRed(1, 0, 0, 1), kBlue(0, 0, 1, 0.5f), kNothing(0);

// Corners on whole pixels: the picture's rows go down, as clip y does.
TEST_F(Drawing, CoversThePixelsWhoseCentresAreInside) {
  const DeviceBuffer corners = buffer_of({{-1, -1, 0.5, 1}, {1, -1, 0.5, 1}, {-1, 1, 0.5, 1}});
  const RasterPipeline red = pipeline();
  const glsl::CornersPush push{corners.address(), kRed, 0};
  const Images images = draw({draw_call(red, push, 3)});
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const double across = (x + 0.5) / kWidth + (y + 0.5) / kHeight;
      if (across == 1) continue;
      EXPECT_EQ(images.colours[y * kWidth + x], across < 1 ? kRed : kNothing) << x << ", " << y;
      EXPECT_EQ(images.depths[y * kWidth + x], across < 1 ? 0.5f : 0.0f) << x << ", " << y;
    }
  }
  ASSERT_EQ(images.passes.size(), 1u);
  EXPECT_EQ(images.passes[0].name, "corners");
  EXPECT_GE(images.passes[0].nanoseconds.value_or(1), 0);
}

// Two slopes that intersect: the larger depth is visible everywhere, in any drawing order.
TEST_F(Drawing, LargerDepthIsInFront) {
  const DeviceBuffer rising = buffer_of({{-1, -3, 0, 1}, {-1, 1, 0, 1}, {3, 1, 2, 1}}),
                     falling = buffer_of({{-1, -3, 1, 1}, {-1, 1, 1, 1}, {3, 1, -1, 1}});
  const RasterPipeline shown = pipeline();
  const glsl::CornersPush red{rising.address(), kRed, 0}, blue{falling.address(), kBlue, 0};
  for (const Images& images : {draw({draw_call(shown, red, 3), draw_call(shown, blue, 3)}),
                               draw({draw_call(shown, blue, 3), draw_call(shown, red, 3)})}) {
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
      const double east = (i % kWidth + 0.5) / kWidth;
      EXPECT_EQ(images.colours[i], east > 0.5 ? kRed : kBlue) << i;
      EXPECT_NEAR(images.depths[i], std::max(east, 1 - east), 1e-6) << i;
    }
  }
}

TEST_F(Drawing, LastDrawWinsWithoutDepthTest) {
  const DeviceBuffer near = buffer_of({{-1, -3, 0.9, 1}, {-1, 1, 0.9, 1}, {3, 1, 0.9, 1}}),
                     far = buffer_of({{-1, -3, 0.1, 1}, {-1, 1, 0.1, 1}, {3, 1, 0.1, 1}});
  const RasterPipeline tested = pipeline(),
                       last = pipeline({.push_bytes = sizeof(glsl::CornersPush), .depth_test = false});
  const glsl::CornersPush red{near.address(), kRed, 0}, blue{far.address(), kBlue, 0};
  const Images images = draw({draw_call(tested, red, 3), draw_call(last, blue, 3)});
  EXPECT_EQ(images.colours[5], kBlue);
  EXPECT_EQ(images.depths[5], 0.1f);
}

// A square of four corners and six indices, drawn twice side by side.
TEST_F(Drawing, DrawsIndexedInstances) {
  const DeviceBuffer corners = buffer_of({{-1, -1, 0.5, 1}, {-0.5, -1, 0.5, 1}, {-1, 1, 0.5, 1}, {-0.5, 1, 0.5, 1}});
  const std::vector<std::uint32_t> order = {0, 1, 2, 2, 1, 3};
  const DeviceBuffer indices(device(), 4 * order.size(), "indices");
  upload(indices, 0, order.data(), indices.bytes());
  const RasterPipeline red = pipeline();
  const glsl::CornersPush push{corners.address(), kRed, 1};
  const Images images = draw({draw_call(red, push, 6, 2, &indices)});
  for (std::uint32_t x = 0; x < kWidth; ++x) {
    EXPECT_EQ(images.colours[3 * kWidth + x], x / 16 % 2 == 0 ? kRed : kNothing) << x;
  }
}

TEST_F(Drawing, DrawsDepthOnly) {
  const RasterTarget target(device(), kWidth, kHeight, 0);
  const DeviceBuffer corners = buffer_of({{-1, -3, 0.25, 1}, {-1, 1, 0.25, 1}, {3, 1, 0.25, 1}}),
                     depths(device(), 4 * kWidth * kHeight, "depths");
  const RasterPipeline shadow(device(), kVertex, {}, "depths", {.push_bytes = sizeof(glsl::CornersPush), .colours = 0});
  const glsl::CornersPush push{corners.address(), kRed, 0};
  Commands commands(device());
  commands.draw(target, {draw_call(shadow, push, 3)});
  commands.copy(target, 0, depths);
  commands.run();
  std::vector<float> found(kWidth * kHeight);
  download(depths, 0, found.data(), depths.bytes());
  EXPECT_EQ(found, std::vector<float>(kWidth * kHeight, 0.25f));
}

TEST_F(Drawing, RejectsBadRequests) {
  const std::string name = device().description().name;
  const std::uint32_t most = raster_limits(device()).most_pixels;
  EXPECT_EQ(refusal([&] { RasterTarget(device(), most + 1, 1, 1); }),
            "device '" + name + "': render target of " + std::to_string(most + 1) + " x 1 pixels (1 to " +
                std::to_string(most) + " per side supported)");
  EXPECT_GE(raster_limits(device()).subpixel_bits, 4u);
  EXPECT_EQ(refusal([&] { pipeline({.push_bytes = 130}); }),
            "shader 'corners': 130 bytes of push constants (must be a multiple of 4, at most 128)");
  const RasterTarget target(device(), kWidth, kHeight, 0);
  const DeviceBuffer small(device(), 64, "small");
  const RasterPipeline red = pipeline();
  const glsl::CornersPush push{small.address(), kRed, 0};
  Commands commands(device());
  EXPECT_EQ(refusal([&] { commands.draw(target, {draw_call(red, push, 3)}); }),
            "shader 'corners': writes 1 colours, but its target has 0");
  const RasterTarget coloured(device(), kWidth, kHeight, 1);
  EXPECT_EQ(refusal([&] { commands.draw(coloured, {draw_call(red, 1.0f, 3)}); }),
            "shader 'corners': 4 bytes of push constants instead of 28");
  EXPECT_EQ(refusal([&] { commands.draw(coloured, {draw_call(red, push, 30, 1, &small)}); }),
            "shader 'corners': 30 indices, but the buffer 'small' holds 16");
  const RasterTarget words(device(), kWidth, kHeight, 1, RasterColours::words);
  EXPECT_EQ(refusal([&] { commands.draw(words, {draw_call(red, push, 3)}); }),
            "shader 'corners': writes floats, but its target has words");
  EXPECT_EQ(refusal([&] { commands.copy(target, 0, small); }),
            "device buffer 'small': image 0 of 1 (8192 bytes) does not fit into 64 bytes");
}

}  // namespace
}  // namespace scarp
