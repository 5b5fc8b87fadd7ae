// SPDX-License-Identifier: MIT
// Output of scarp-bench, for tests that run it from end to end.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace scarp::bench {

/// The JSON output of a command.
inline nlohmann::json output_of(const std::string& arguments) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("scarp-bench-test-{}.json", getpid());
  const std::string command =
      fmt::format("'{}' {} --json '{}' > /dev/null", SCARP_BENCH_PROGRAM, arguments, file.string());
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::ifstream stream(file);
  nlohmann::json all = nlohmann::json::parse(stream, nullptr, false);
  std::filesystem::remove(file);
  EXPECT_FALSE(all.is_discarded()) << "no JSON from: " << command;
  return all;
}

inline void expect_fields(const nlohmann::json& object, const std::set<std::string>& fields) {
  for (const std::string& field : fields) EXPECT_TRUE(object.contains(field)) << field;
}

inline void expect_head(const nlohmann::json& all) {
  expect_fields(all, {"machine", "command", "date", "rows"});
  EXPECT_TRUE(all["machine"].is_string());
  EXPECT_EQ(all["command"].get<std::string>().substr(0, 12), "scarp-bench ");
  EXPECT_FALSE(all["rows"].empty());
}

}  // namespace scarp::bench
