// SPDX-License-Identifier: MIT
// Output of scarp-bench, for tests that run it from end to end.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
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

/// The section of bench/README.md about the output of a command: "heights", "gpu --raster".
inline std::string documented_output(const std::string& command) {
  std::ifstream stream(SCARP_SOURCE_DIR "/bench/README.md");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t begin = text.find("\n### " + command + "\n");
  EXPECT_NE(begin, std::string::npos) << "bench/README.md does not describe the output of " << command;
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find("\n##", begin + 1) - begin);
}

/// The names in a text: words of small letters, digits and underscores.
inline std::set<std::string> names_in(const std::string& text) {
  const std::regex name("[a-z][a-z0-9_]*");
  return {std::sregex_token_iterator(text.begin(), text.end(), name), std::sregex_token_iterator()};
}

/// Expects that rows have exactly the fields that bench/README.md describes: each field is named in the section of the
/// command or in a section that it refers to, and each name in the first column of the table of fields is in some row.
/// "a_runs, b_size, ..." means all fields with these endings.
inline void expect_documented(const nlohmann::json& all, const std::string& command) {
  for (const char* field : {"machine", "command", "date", "rows"}) EXPECT_TRUE(all.contains(field)) << field;
  EXPECT_TRUE(all["machine"].is_string());
  EXPECT_EQ(all["command"].get<std::string>().substr(0, 12), "scarp-bench ");
  EXPECT_FALSE(all["rows"].empty());
  std::set<std::string> written;
  for (const nlohmann::json& row : all["rows"]) {
    for (const auto& [field, value] : row.items()) written.insert(field);
  }
  const std::string section = documented_output(command);
  std::set<std::string> described = names_in(section), endings;
  for (const char* other : {"heights", "gpu", "simt"}) {
    const bool refers = section.find("as above") != std::string::npos ||
                        section.find("s in `" + std::string(other) + "`") != std::string::npos;
    if (refers && other != command) described.merge(names_in(documented_output(other)));
  }
  std::istringstream lines(section);
  bool of_fields = false;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| ")) of_fields = false;
    if (of_fields) {
      const std::string first = line.substr(2, line.find(" |", 2) - 2);
      for (const std::string& name : names_in(first)) {
        if (first.ends_with("...")) endings.insert(name.substr(name.rfind('_')));
        EXPECT_TRUE(written.contains(name)) << name << ": described, but in no row of " << command;
      }
    }
    if (line.starts_with("| field |")) {
      of_fields = true;
      std::getline(lines, line);  // the rule below the head
    }
  }
  for (const std::string& field : written) {
    const bool ends_so = std::any_of(endings.begin(), endings.end(), [&](const auto& e) { return field.ends_with(e); });
    EXPECT_TRUE(described.contains(field) || ends_so) << field << ": not described in bench/README.md, " << command;
  }
}

}  // namespace scarp::bench
