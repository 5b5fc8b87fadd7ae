// SPDX-License-Identifier: MIT
// Behaviour without a device, or with a device that lacks a feature, is out of memory, or is lost.
#include "scarp/vk/device.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <vector>

#include "base/refusal.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/raii.h"
#include "test/vk/device_under_test.h"
#include "test/vk/twice.glsl.h"

namespace scarp {
namespace {

constexpr std::uint32_t kTwice[] = {
#include "test/vk/twice.comp.inc"
};

DeviceDescription described(const std::string& name, DeviceKind kind, const std::string& missing = "") {
  DeviceDescription device;
  device.name = name;
  device.kind = kind;
  device.missing = missing;
  return device;
}

using test::refusal;

TEST(DeviceChoice, PicksTheBestMatch) {
  const std::vector<DeviceDescription> devices = {
      described("llvmpipe (LLVM 15)", DeviceKind::cpu), described("Old card", DeviceKind::discrete_gpu, "Vulkan 1.2"),
      described("Intel UHD", DeviceKind::integrated_gpu), described("NVIDIA H200", DeviceKind::discrete_gpu),
      described("NVIDIA H200 second", DeviceKind::discrete_gpu)};
  EXPECT_EQ(choose_device(devices, "auto"), 3u);
  EXPECT_EQ(choose_device(devices, "gpu"), 3u);
  EXPECT_EQ(choose_device(devices, "cpu"), 0u);
  EXPECT_EQ(choose_device(devices, "CPU"), 0u);
  EXPECT_EQ(choose_device(devices, "Gpu"), 3u);
  EXPECT_EQ(choose_device(devices, "AUTO"), 3u);
  EXPECT_EQ(choose_device(devices, "uhd"), 2u);
  EXPECT_EQ(choose_device(devices, "h200 SEC"), 4u);
  EXPECT_EQ(refusal([&] { choose_device(devices, "old"); }), "device 'old': 'Old card' lacks Vulkan 1.2");
  EXPECT_EQ(
      refusal([&] {
        choose_device({devices.begin(), devices.begin() + 2}, "radeon");
      }),
      "device 'radeon': no Vulkan device matches (available: 'llvmpipe (LLVM 15)' (CPU), 'Old card' (discrete GPU))");
  EXPECT_EQ(choose_device({devices.begin(), devices.begin() + 1}, "auto"), 0u);
  EXPECT_EQ(refusal([&] {
              choose_device({devices.begin(), devices.begin() + 1}, "gpu");
            }),
            "device 'gpu': no Vulkan device matches (available: 'llvmpipe (LLVM 15)' (CPU))");
}

TEST(DeviceAbility, NamesTheFirstMissingAbility) {
  DeviceAbilities all{.api_major = 1,
                      .api_minor = 2,
                      .compute_queue = true,
                      .scalar_block_layout = true,
                      .buffer_device_address = true};
  EXPECT_EQ(missing_ability(all), "");
  EXPECT_EQ(missing_ability({.api_major = 1, .api_minor = 1}), "Vulkan 1.2 (it has 1.1)");
  const auto without = [&](bool DeviceAbilities::*ability) {
    DeviceAbilities abilities = all;
    abilities.*ability = false;
    return missing_ability(abilities);
  };
  EXPECT_EQ(without(&DeviceAbilities::compute_queue), "a compute queue");
  EXPECT_EQ(without(&DeviceAbilities::scalar_block_layout), "the feature scalarBlockLayout");
  EXPECT_EQ(without(&DeviceAbilities::buffer_device_address), "the feature bufferDeviceAddress");
}

// Timestamps and graphics are reported for the queue that is opened.
TEST(DeviceQueues, PrefersGraphicsThenTimestamps) {
  using Bits = vk::QueueFlagBits;
  const vk::QueueFamilyProperties transfers(Bits::eTransfer, 1, 64), computes(Bits::eCompute, 1, 0),
      computes_timed(Bits::eCompute, 1, 64), draws(Bits::eGraphics | Bits::eCompute, 1, 0),
      draws_timed(Bits::eGraphics | Bits::eCompute, 1, 36), only_draws(Bits::eGraphics, 1, 64);
  const auto chosen = [](std::vector<vk::QueueFamilyProperties> families) { return compute_family(families); };
  EXPECT_EQ(chosen({}), std::nullopt);
  EXPECT_EQ(chosen({transfers, only_draws}), std::nullopt);
  EXPECT_EQ(chosen({transfers, computes, computes_timed}), 2u);
  EXPECT_EQ(chosen({computes_timed, draws}), 1u);
  EXPECT_EQ(chosen({draws, computes_timed, draws_timed, draws_timed}), 2u);
}

// Vulkan exceptions become one line; the test throws them in place of the driver.
TEST(DeviceFailure, BecomesOneLine) {
  const auto failing = [](const auto& failure) {
    return refusal([&] { guarded("Card", "computing", [&] { throw failure; }); });
  };
  EXPECT_EQ(failing(vk::DeviceLostError("x")),
            "device 'Card': lost while computing: the driver has reset it, as after a pass that ran too long (run "
            "again, or choose another device, see 'scarp devices')");
  EXPECT_EQ(failing(vk::OutOfDeviceMemoryError("x")), "device 'Card': out of device memory while computing");
  EXPECT_EQ(failing(vk::OutOfHostMemoryError("x")), "device 'Card': out of memory while computing");
  EXPECT_EQ(failing(vk::TooManyObjectsError("x")), "device 'Card': ErrorTooManyObjects while computing");
}

// In a child process: the loader reads its environment once.
std::string in_child(const char* drivers, const std::function<std::string()>& f) {
  int ends[2];
  if (::pipe(ends) != 0) return "no pipe";
  const ::pid_t child = ::fork();
  if (child == 0) {
    // Older loaders know only the second name.
    ::setenv("VK_DRIVER_FILES", drivers, 1);
    ::setenv("VK_ICD_FILENAMES", drivers, 1);
    const std::string text = f();
    const bool written = ::write(ends[1], text.data(), text.size()) == static_cast<::ssize_t>(text.size());
    ::_exit(written ? 0 : 1);
  }
  ::close(ends[1]);
  std::string text;
  char buffer[512];
  for (::ssize_t n; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;) text.append(buffer, static_cast<std::size_t>(n));
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return text;
}

TEST(DeviceList, IsEmptyWithoutADriverAndExplainsWhy) {
  const auto list = [] {
    const DeviceList devices = list_devices();
    return std::to_string(devices.devices.size()) + ": " + devices.why_none;
  };
  const std::string none = "Vulkan: no driver found (search path: VK_DRIVER_FILES=/nonexistent)";
  const std::string no_loader = "Vulkan: no loader, cannot open libvulkan.so.1 (on Debian, install libvulkan1)";
  const std::string listed = in_child("/nonexistent", list);
  EXPECT_TRUE(listed == "0: " + none || listed == "0: " + no_loader) << listed;
  const std::string opened = in_child("/nonexistent", [] { return refusal([] { Device device; }); });
  EXPECT_TRUE(opened == none || opened == no_loader) << opened;
  const std::string manifest = testing::TempDir() + "scarp-damaged-driver-" + std::to_string(::getpid()) + ".json";
  std::ofstream(manifest) << "x";
  const std::string damaged = in_child(manifest.c_str(), list);
  // Other loaders may ignore it.
  EXPECT_TRUE(damaged ==
                  "0: Vulkan: the loader is out of memory, or a driver manifest (.json) is damaged (search path: "
                  "VK_DRIVER_FILES=" +
                      manifest + ")" ||
              damaged == "0: Vulkan: no driver found (search path: VK_DRIVER_FILES=" + manifest + ")" ||
              damaged == "0: " + no_loader)
      << damaged;
  std::filesystem::remove(manifest);
}

TEST(DeviceSettingsTest, RejectsInvalidTimeouts) {
  for (const double seconds : {0.0, -1.0, std::nan(""), 1e10}) {
    EXPECT_NE(refusal([&] { Device device({.timeout_s = seconds}); }).find("timeout"), std::string::npos);
  }
}

class OpenDevice : public test::OnDevice {};

TEST_F(OpenDevice, MatchesTheList) {
  const DeviceDescription& open = device().description();
  EXPECT_TRUE(open.usable());
  EXPECT_GT(open.memory_bytes, 0u);
  EXPECT_GE(open.max_allocation_bytes, 1u << 30);  // guaranteed by Vulkan 1.1
  bool listed = false;
  for (const DeviceDescription& other : list_devices().devices) listed |= other.name == open.name;
  EXPECT_TRUE(listed);
  EXPECT_EQ(Device({.choice = open.name}).description().name, open.name);
  EXPECT_EQ(refusal([] {
              Device device({.choice = "no such device"});
            }).find("device 'no such device': no Vulkan device matches (available: '"),
            0u);
}

TEST_F(OpenDevice, ReportsMissingMemory) {
  const std::string error = refusal([&] { DeviceBuffer(device(), 1ull << 50, "a continent"); });
  EXPECT_NE(error.find("no memory for a continent (1073741824.0 MiB): "), std::string::npos) << error;
  EXPECT_NE(refusal([&] { DeviceBuffer(device(), 0, "nothing"); }), "");
  EXPECT_NE(refusal([&] { DeviceBuffer(device(), 6, "a word and a half"); }), "");
}

// The sanitizer's own memory is beyond any limit.
#ifdef __has_feature
#define SCARP_WATCHES_MEMORY __has_feature(address_sanitizer)
#endif
#if !defined(__SANITIZE_ADDRESS__) && !SCARP_WATCHES_MEMORY
// In a separate process, on a CPU device, whose memory is that of the process.
TEST_F(OpenDevice, ReportsExhaustedMemoryAndContinues) {
  if (device().description().kind != DeviceKind::cpu) GTEST_SKIP() << "this device has memory of its own";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto use_up = [] {
    const Device limited({.choice = "cpu"});
    // The memory of the first upload stays allocated.
    const std::uint32_t word = 7;
    upload(DeviceBuffer(limited, 4096, "the first"), 0, &word, 4);
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    constexpr std::uint64_t kBytes = 1 << 28, kMore = 5 * kBytes / 2;
    const ::rlim_t limit = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + kMore;
    const ::rlimit both{limit, limit};
    if (::setrlimit(RLIMIT_AS, &both) != 0) ::_exit(2);
    std::vector<DeviceBuffer> all;
    std::string said;
    while (said.empty() && all.size() < 10) said = refusal([&] { all.emplace_back(limited, kBytes, "a lake"); });
    const std::size_t made = all.size();
    all.clear();
    const std::string after = refusal([&] { upload(DeviceBuffer(limited, kBytes, "another"), 0, &word, 4); });
    std::fprintf(stderr, "%zu made; %s; then: %s.\n", made, said.c_str(), after.c_str());
    ::_exit(0);
  };
  EXPECT_EXIT(use_up(), testing::ExitedWithCode(0),
              "[12] made; device '.*': no memory for a lake .256.0 MiB.: it uses system memory, and none is left; "
              "then: \\.");
}
#endif

TEST_F(OpenDevice, RejectsDrawingWithoutGraphics) {
  const Device other;
  other.impl()->description.abilities.draws = false;
  const std::string expected = "device '" + other.description().name +
                               "': no queue draws triangles (choose another device, see 'scarp devices')";
  EXPECT_EQ(refusal([&] { RasterTarget(other, 16, 16, 1); }), expected);
  EXPECT_EQ(refusal([&] { RasterPipeline(other, kTwice, {}, "triangles", {}); }), expected);
}

// Without validation, the absence of messages would prove nothing. This test makes two copies to one position without a
// barrier between them, and a copy beyond the end of a buffer.
TEST_F(OpenDevice, ReportsValidationMessages) {
  if (!test::tests_validate()) GTEST_SKIP() << "SCARP_TEST_VALIDATION=off";
  const Device watched({.validation = true});
  const DeviceBuffer from(watched, 64, "from"), to(watched, 64, "to");
  const Device::Impl& open = *watched.impl();
  const vk::raii::CommandBuffers commands(open.device, {*open.pool, vk::CommandBufferLevel::ePrimary, 1});
  const auto copy = [&](std::uint64_t bytes) {
    commands[0].copyBuffer(*from.impl().buffer, *to.impl().buffer, vk::BufferCopy(0, 0, bytes));
  };
  commands[0].begin(vk::CommandBufferBeginInfo());
  copy(64);
  EXPECT_EQ(watched.validation_messages().size(), 0u);
  copy(64);
  ASSERT_EQ(watched.validation_messages().size(), 1u);
  EXPECT_NE(watched.validation_messages()[0].find("SYNC-HAZARD-WRITE"), std::string::npos);
  copy(128);
  EXPECT_GT(watched.validation_messages().size(), 1u);
}

TEST_F(OpenDevice, GivesUpAfterTheTimeout) {
  const Device hurried({.timeout_s = 1e-6});
  DeviceBuffer words(hurried, 4 << 20, "words");
  const std::uint32_t constants[] = {64, 1};
  const ComputePipeline pipeline(hurried, kTwice, "slow", sizeof(glsl::TwicePush), constants);
  Commands commands(hurried);
  commands.dispatch(pipeline, glsl::TwicePush{words.address(), words.address(), 1 << 20, 200}, {1 << 14, 1, 1});
  EXPECT_NE(refusal([&] { commands.run(); }).find("'slow' did not finish within 1e-06 s"), std::string::npos);
  // Nothing waits for the device again, except its release, for a few seconds.
  const std::string said = refusal([&] { commands.fill(words, 0, 4, 0); });
  EXPECT_NE(said.find("'slow' did not finish"), std::string::npos) << said;
  EXPECT_NE(said.find("given up"), std::string::npos) << said;
  const std::uint32_t word = 1;
  EXPECT_EQ(refusal([&] { upload(words, 0, &word, 4); }), said);
  EXPECT_EQ(refusal([&] {
              Commands others(hurried);
              others.fill(words, 0, 4, 0);
              others.run();
            }),
            said);
}

}  // namespace
}  // namespace scarp
