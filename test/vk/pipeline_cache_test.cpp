// SPDX-License-Identifier: MIT
// Compiled pipelines in the user's cache folder: damaged files and those of other devices are ignored, and so are
// folders that cannot be written.
#include "scarp/vk/pipeline_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "scarp/vk/commands.h"
#include "scarp/vk/memory.h"
#include "scarp/vk/raii.h"
#include "test/vk/device_under_test.h"
#include "test/vk/twice.glsl.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kTwiceOfAll[] = {
#include "test/vk/twice.comp.inc"
};

// A temporary folder for the user's caches until the end of a test.
class PipelineFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "scarp-pipelines-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    caches_ = name;
    if (const char* before = std::getenv("XDG_CACHE_HOME")) before_ = before;
    ::setenv("XDG_CACHE_HOME", name.c_str(), 1);
  }
  void TearDown() override {
    if (before_)
      ::setenv("XDG_CACHE_HOME", before_->c_str(), 1);
    else
      ::unsetenv("XDG_CACHE_HOME");
    fs::remove_all(caches_);
  }

  static std::string content(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void put(const std::string& path, const std::string& bytes) {
    fs::create_directories(fs::path(path).parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
  }

  fs::path caches_;

 private:
  std::optional<std::string> before_;
};

PipelineCacheKey some_key() {
  PipelineCacheKey key{0x10de, 0x2330, 0x12345678, {}};
  for (std::size_t i = 0; i < key.uuid.size(); ++i) key.uuid[i] = static_cast<std::uint8_t>(17 * i);
  return key;
}

// Like a driver's: with the header of Vulkan's first version.
std::vector<std::byte> some_data(const PipelineCacheKey& key, std::size_t more = 1000) {
  const std::uint32_t head[] = {32, 1, key.vendor, key.device};
  std::vector<std::byte> data(32 + more, std::byte{5});
  std::memcpy(data.data(), head, 16);
  std::memcpy(data.data() + 16, key.uuid.data(), 16);
  return data;
}

TEST_F(PipelineFiles, AreInTheUserCacheFolder) {
  EXPECT_EQ(user_cache_folder(), caches_.string() + "/scarp");
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  ::setenv("HOME", "/home/somebody", 1);
  for (const char* unusable : {"", "relative/folder"}) {
    ::setenv("XDG_CACHE_HOME", unusable, 1);
    EXPECT_EQ(user_cache_folder(), "/home/somebody/.cache/scarp");
  }
  ::unsetenv("HOME");
  EXPECT_EQ(user_cache_folder(), "");
  if (!home.empty()) ::setenv("HOME", home.c_str(), 1);
  EXPECT_EQ(pipeline_cache_name(some_key()), "pipelines-10de-2330-12345678-00112233445566778899aabbccddeeff.bin");
}

TEST_F(PipelineFiles, RoundTrip) {
  const PipelineCacheKey key = some_key();
  const std::string path = (caches_ / "scarp" / "a.bin").string();
  EXPECT_TRUE(read_pipeline_cache(path, key).empty());
  for (const std::size_t more : {1000, 10, 0}) {
    ASSERT_TRUE(write_pipeline_cache(path, some_data(key, more)));
    EXPECT_EQ(read_pipeline_cache(path, key), some_data(key, more));
  }
  EXPECT_EQ(fs::status(caches_ / "scarp").permissions(), fs::perms::owner_all);
  EXPECT_EQ(std::distance(fs::directory_iterator(caches_ / "scarp"), {}), 1) << "no temporary files";
}

TEST_F(PipelineFiles, FromOtherDevicesAreIgnored) {
  const PipelineCacheKey key = some_key();
  const std::string path = (caches_ / "scarp" / "a.bin").string();
  ASSERT_TRUE(write_pipeline_cache(path, some_data(key)));
  PipelineCacheKey other = key;
  other.vendor = 0x1002;
  EXPECT_TRUE(read_pipeline_cache(path, other).empty());
  other = key;
  other.device += 1;
  EXPECT_TRUE(read_pipeline_cache(path, other).empty());
  other = key;
  other.uuid[15] += 1;
  EXPECT_TRUE(read_pipeline_cache(path, other).empty());
  // The driver's version is only in the name: Vulkan's header does not have it.
  other = key;
  other.driver += 1;
  EXPECT_NE(pipeline_cache_name(other), pipeline_cache_name(key));
  std::vector<std::byte> of_later_vulkan = some_data(key);
  of_later_vulkan[4] = std::byte{2};
  ASSERT_TRUE(write_pipeline_cache(path, of_later_vulkan));
  EXPECT_TRUE(read_pipeline_cache(path, key).empty());
}

TEST_F(PipelineFiles, AreIgnoredWhenDamaged) {
  const PipelineCacheKey key = some_key();
  const std::string path = (caches_ / "scarp" / "a.bin").string();
  ASSERT_TRUE(write_pipeline_cache(path, some_data(key)));
  const std::string whole = content(path);
  for (std::size_t at = 0; at < whole.size(); at += at < 64 ? 1 : 97) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x20);
    put(path, damaged);
    EXPECT_TRUE(read_pipeline_cache(path, key).empty()) << at;
    put(path, whole.substr(0, at));
    EXPECT_TRUE(read_pipeline_cache(path, key).empty()) << at;
  }
  put(path, whole + "more");
  EXPECT_TRUE(read_pipeline_cache(path, key).empty());
  put(path, whole);
  fs::resize_file(path, kMostPipelineBytes + 4096);
  EXPECT_TRUE(read_pipeline_cache(path, key).empty()) << "too large";
  put(path, whole);
  EXPECT_FALSE(read_pipeline_cache(path, key).empty());
}

TEST_F(PipelineFiles, AreSkippedWhenUnwritable) {
  const std::vector<std::byte> data = some_data(some_key());
  put((caches_ / "file").string(), "no folder");
  EXPECT_FALSE(write_pipeline_cache((caches_ / "file" / "scarp" / "a.bin").string(), data));
  EXPECT_FALSE(write_pipeline_cache("/proc/scarp/a.bin", data));
  EXPECT_TRUE(read_pipeline_cache((caches_ / "file" / "a.bin").string(), some_key()).empty());
  EXPECT_TRUE(read_pipeline_cache(caches_.string(), some_key()).empty());
  if (::geteuid() == 0) return;  // root may write anywhere
  fs::create_directories(caches_ / "scarp");
  fs::permissions(caches_ / "scarp", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_FALSE(write_pipeline_cache((caches_ / "scarp" / "a.bin").string(), data));
  fs::permissions(caches_ / "scarp", fs::perms::owner_all);
}

class DevicePipelines : public PipelineFiles {
 protected:
  void SetUp() override {
    PipelineFiles::SetUp();
    if (!test::device_under_test().device) GTEST_SKIP() << test::device_under_test().why_none;
  }

  // Opens the device, computes on it and closes it. Returns the path of its file.
  static std::string compute(bool keep_pipelines = true) {
    const Device device({.validation = test::tests_validate(), .keep_pipelines = keep_pipelines});
    const std::uint32_t constants[] = {64, 0};
    const ComputePipeline twice(device, kTwiceOfAll, "twice", sizeof(glsl::TwicePush), constants);
    const std::uint32_t number = 21;
    DeviceBuffer from(device, 4, "from"), to(device, 4, "to");
    upload(from, 0, &number, 4);
    Commands commands(device);
    commands.dispatch(twice, glsl::TwicePush{from.address(), to.address(), 1, 1}, {1, 1, 1});
    std::uint32_t doubled = 0;
    commands.barrier();
    commands.read(to, 0, 4, &doubled);
    commands.run();
    EXPECT_EQ(doubled, glsl::twice(number));
    for (const std::string& message : device.validation_messages()) ADD_FAILURE() << message;
    return device.impl()->pipelines_path;
  }
};

TEST_F(DevicePipelines, AreCached) {
  const std::string path = compute();
  ASSERT_EQ(fs::path(path).parent_path(), caches_ / "scarp");
  const std::string first = content(path);
  EXPECT_GE(first.size(), 48u) << "the driver's header at least: lavapipe keeps no more";
  // Unchanged caches are not written again.
  fs::last_write_time(path, fs::last_write_time(path) - std::chrono::hours(1));
  const fs::file_time_type earlier = fs::last_write_time(path);
  EXPECT_EQ(compute(), path);
  EXPECT_EQ(fs::last_write_time(path), earlier);
  fs::remove(path);
  EXPECT_EQ(compute(), path);
  EXPECT_TRUE(fs::exists(path));
}

TEST_F(DevicePipelines, ReplaceUnusableFiles) {
  const std::string path = compute(), whole = content(path);
  ASSERT_GE(whole.size(), 48u);
  for (const std::string& useless : {std::string(), std::string("no pipelines"), whole.substr(0, 40)}) {
    put(path, useless);
    EXPECT_EQ(compute(), path);
    EXPECT_NE(content(path), useless);
    EXPECT_GE(content(path).size(), 48u);
  }
  ASSERT_TRUE(write_pipeline_cache(path, some_data(some_key())));
  const std::string of_another_device = content(path);
  compute();
  EXPECT_NE(content(path), of_another_device);
}

TEST_F(DevicePipelines, AreNotCachedWhenDisabledOrImpossible) {
  EXPECT_EQ(compute(false), "");
  EXPECT_FALSE(fs::exists(caches_ / "scarp"));
  // A file where the folder should be.
  put((caches_ / "scarp").string(), "no folder");
  compute();
  EXPECT_EQ(content((caches_ / "scarp").string()), "no folder");
}

}  // namespace
}  // namespace scarp
