// SPDX-License-Identifier: MIT
// Statistics of a small shader, where a driver reports them; bench/shaders_test.cpp has those of the library.
#include "scarp/vk/shader_statistics.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "scarp/base/error.h"
#include "scarp/vk/device.h"
#include "test/vk/twice.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kSmallShader[] = {
#include "test/vk/twice.comp.inc"
};

TEST(ShaderStatistics, AreReportedOrErrorNamesTheDevice) {
  const DeviceList list = list_devices();
  try {
    const ShaderCompiler compiler;
    const ShaderProgram program{"test/vk/twice.comp", "", kSmallShader, sizeof(glsl::TwicePush), {64, 0}};
    EXPECT_FALSE(compiler.statistics(program).empty()) << compiler.device_name();
  } catch (const Error& error) {
    const std::string why = error.what();
    if (list.devices.empty()) {
      EXPECT_EQ(why, list.why_none);
    } else {
      EXPECT_EQ(why.find("Vulkan: no driver reports statistics of shaders (available: "), 0u) << why;
      for (const DeviceDescription& device : list.devices) EXPECT_NE(why.find(device.name), std::string::npos) << why;
    }
  }
}

}  // namespace
}  // namespace scarp
