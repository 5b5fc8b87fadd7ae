// SPDX-License-Identifier: MIT
// Runs the tests of the files that SCARP_TEST_FILES names, separated by commas. Where several test programs are built
// as one (TOGETHER in test/CMakeLists.txt), each ctest test still runs the files of one of them, in a separate process.
// Without the variable, or with --gtest_filter, the files are not restricted.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>

namespace {

// A value for --gtest_filter: all tests of these files by name. Empty if one of the files has none.
std::string tests_of(const std::string& files) {
  std::set<std::string> wanted, found;
  std::istringstream names(files);
  for (std::string name; std::getline(names, name, ',');) wanted.insert(name);
  std::string filter;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int k = 0; k < suite.total_test_count(); ++k) {
      const testing::TestInfo& test = *suite.GetTestInfo(k);
      const std::string file = std::filesystem::path(test.file()).filename();
      if (!wanted.contains(file)) continue;
      found.insert(file);
      filter.append(suite.name()).append(".").append(test.name()).append(":");
    }
  }
  return found == wanted ? filter : "";
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const char* files = std::getenv("SCARP_TEST_FILES");
  if (files && testing::GTEST_FLAG(filter) == "*") {
    const std::string filter = tests_of(files);
    if (filter.empty()) {
      std::fprintf(stderr, "a file of '%s' has no tests in %s\n", files, argv[0]);
      return 1;
    }
    testing::GTEST_FLAG(filter) = filter;
  }
  return RUN_ALL_TESTS();
}
