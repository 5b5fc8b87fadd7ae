// SPDX-License-Identifier: MIT
// `scarp devices`, with the drivers of this machine and without any.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "scarp/vk/device.h"
#include "test/cli/program.h"

namespace scarp::test {
namespace {

TEST(Devices, AreThoseOfTheLibrary) {
  const auto text = run_on_device({"devices"}), json_text = run_on_device({"devices", "--json"});
  ASSERT_EQ(text.status, 0) << text.err;
  ASSERT_EQ(json_text.status, 0) << json_text.err;
  const auto json = nlohmann::json::parse(json_text.out);
  const DeviceList list = list_devices();
  ASSERT_EQ(json["devices"].size(), list.devices.size());
  EXPECT_EQ(json["why_none"], list.why_none);
  if (list.devices.empty()) {
    EXPECT_EQ(text.out, "no device: " + list.why_none + "\n");
    GTEST_SKIP() << list.why_none;
  }
  for (std::size_t i = 0; i < list.devices.size(); ++i) {
    const DeviceDescription& device = list.devices[i];
    EXPECT_NE(text.out.find(device.name + "\n"), std::string::npos);
    EXPECT_EQ(json["devices"][i]["name"], device.name);
    EXPECT_EQ(json["devices"][i]["usable"], device.usable());
    EXPECT_EQ(json["devices"][i]["memory_bytes"], device.memory_bytes);
  }
}

// An empty list is a list.
TEST(Devices, WithoutAnyItSaysWhy) {
  ::setenv("VK_DRIVER_FILES", "/nonexistent", 1);
  ::setenv("VK_ICD_FILENAMES", "/nonexistent", 1);
  const auto text = run_on_device({"devices"}), json_text = run_on_device({"devices", "--json"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(text.out.find("no device: Vulkan: no "), 0u) << text.out;
  EXPECT_EQ(lines(text.out), 1);
  EXPECT_EQ(json_text.status, 0);
  EXPECT_EQ(nlohmann::json::parse(json_text.out)["devices"].size(), 0u);
}

}  // namespace
}  // namespace scarp::test
