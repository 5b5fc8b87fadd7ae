// SPDX-License-Identifier: MIT
// The device on which tests run, with validation: any validation message fails the program's tests.
// SCARP_TEST_VALIDATION=off runs them without the validation layer, where it is not installed.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/vk/device.h"

namespace scarp::test {

/// False if SCARP_TEST_VALIDATION is "off".
inline bool tests_validate() {
  const char* choice = std::getenv("SCARP_TEST_VALIDATION");
  return !choice || choice != std::string_view("off");
}

/// Why there is no device, or empty. Without a device tests are skipped; without the validation layer they fail.
struct DeviceUnderTest {
  std::optional<Device> device;
  std::string why_none;
};

inline const DeviceUnderTest& device_under_test() {
  static const DeviceUnderTest under_test = [] {
    // The leak sanitizer can attribute memory only while the driver is loaded (see libraries.lsan).
    for (const char* module : {"libvulkan.so.1", "libvulkan_lvp.so", "libVkLayer_khronos_validation.so"}) {
      ::dlopen(module, RTLD_NOW | RTLD_NODELETE);
    }
    DeviceUnderTest found;
    const DeviceList list = list_devices();
    bool usable = false;
    for (const DeviceDescription& device : list.devices) usable |= device.usable();
    if (usable) {
      found.device.emplace(DeviceSettings{.validation = tests_validate(), .keep_pipelines = false});
    } else {
      found.why_none = list.devices.empty() ? list.why_none : "no usable Vulkan device";
    }
    return found;
  }();
  return under_test;
}

/// Base of tests that need a device.
class OnDevice : public testing::Test {
 protected:
  void SetUp() override {
    if (!device_under_test().device) GTEST_SKIP() << device_under_test().why_none;
    said_before_ = device().validation_messages().size();
  }
  void TearDown() override {
    if (!device_under_test().device) return;
    const auto messages = device().validation_messages();
    for (std::size_t i = said_before_; i < messages.size(); ++i) ADD_FAILURE() << messages[i];
  }
  const Device& device() const { return *device_under_test().device; }

 private:
  std::size_t said_before_ = 0;
};

}  // namespace scarp::test
