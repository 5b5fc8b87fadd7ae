// SPDX-License-Identifier: MIT
// `scarp devices`, with the drivers of this machine and without any.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "test/cli/program.h"

namespace scarp::test {
namespace {

TEST(Devices, AreListedAsTextAndJson) {
  const auto text = run_on_device({"devices"}), json_text = run_on_device({"devices", "--json"});
  ASSERT_EQ(text.status, 0) << text.err;
  ASSERT_EQ(json_text.status, 0) << json_text.err;
  const auto json = nlohmann::json::parse(json_text.out);
  if (json["devices"].empty()) {
    const std::string why_none = json["why_none"];
    EXPECT_EQ(text.out, "no device: " + why_none + "\n");
    GTEST_SKIP() << why_none;
  }
  EXPECT_EQ(json["why_none"], "");
  std::size_t at = 0;
  for (const auto& device : json["devices"]) {
    at = text.out.find(std::string(device["name"]) + "\n", at);
    ASSERT_NE(at, std::string::npos) << text.out;
    EXPECT_EQ(device["usable"], std::string(device["missing"]).empty());
    EXPECT_GT(device["memory_bytes"], 0);
    EXPECT_NE(text.out.find("type       " + std::string(device["type"]) + "\n", at), std::string::npos);
  }
}

// An empty list is a valid answer.
TEST(Devices, ExplainWhyNoneIsListed) {
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
