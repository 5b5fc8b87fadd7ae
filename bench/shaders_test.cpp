// SPDX-License-Identifier: MIT
// Checks that no shader exceeds its entry in bench/shader_statistics.csv and that every shader has one.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/shader_compilation.h"
#include "bench/shader_table.h"
#include "bench/shaders.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

const std::string kTable = SCARP_SOURCE_DIR "/bench/shader_statistics.csv";
constexpr const char* kRewrite = "scarp-bench shaders --families navi21 --update bench/shader_statistics.csv";

TEST(Shaders, AreAllListed) {
  const std::filesystem::path root = SCARP_SOURCE_DIR;
  std::set<std::string> files, listed;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "scarp")) {
    const std::filesystem::path kind = entry.path().extension();
    if (kind == ".comp" || kind == ".frag") files.insert(entry.path().lexically_relative(root).string());
  }
  for (const ShaderProgram& program : library_shaders()) listed.emplace(program.file);
  EXPECT_EQ(listed, files) << "a shader's owner lists it for library_shaders() of bench/shader_compilation.cpp";
}

TEST(Shaders, AreListedOnceAndFitTheTable) {
  std::set<std::pair<std::string, std::string>> names;
  for (const ShaderProgram& program : library_shaders()) {
    EXPECT_TRUE(names.emplace(program.file, program.variant).second) << program.file << ", " << program.variant;
    EXPECT_EQ(program.variant.find_first_of(",\n"), std::string::npos) << program.variant;
    EXPECT_FALSE(program.spirv.empty());
  }
}

ShaderTable table_of_two() {
  return {"a driver",
          {{"a.comp", "any", "navi21", {100, 24, 128, 0, 3, 900, 32, 7}}, {"b.comp", "", "navi21", {50, 16, 128}}}};
}

TEST(ShaderTable, ReportsRegressions) {
  const ShaderTable kept = table_of_two();
  EXPECT_TRUE(shader_breaches(kept, kept).empty());
  for (std::size_t k = 0; k < kShaderFigures.size(); ++k) {
    ShaderTable found = kept;
    found.rows[0].figures[k] = found.rows[0].figures[k].value_or(0) + 1;
    const auto breaches = shader_breaches(kept, found);
    EXPECT_EQ(breaches.size(), kShaderFigures[k].judged ? 1 : 0) << kShaderFigures[k].name;
    EXPECT_TRUE(shader_breaches(found, kept).empty()) << "fewer " << kShaderFigures[k].name;
  }
  ShaderTable more = kept;
  more.rows[1].figures[0] = 51;
  EXPECT_EQ(shader_breaches(kept, more), std::vector<std::string>{"b.comp, navi21: 51 instructions, in the table 50"});
}

TEST(ShaderTable, ReportsMissingRows) {
  const ShaderTable kept = table_of_two();
  ShaderTable found = kept;
  found.rows[0].specialisation = "closest";
  EXPECT_EQ(shader_breaches(kept, found),
            (std::vector<std::string>{"a.comp, closest, navi21: not in the table",
                                      "a.comp, any, navi21: in the table, but no such shader"}));
}

TEST(ShaderTable, RoundTrips) {
  const std::string file =
      std::filesystem::temp_directory_path() / ("scarp-shader-table-" + std::to_string(::getpid()) + ".csv");
  const ShaderTable table = table_of_two();
  write_shader_table(file, table);
  const ShaderTable read = read_shader_table(file);
  EXPECT_EQ(read.compilers, table.compilers);
  EXPECT_EQ(read.rows, table.rows);
  std::ofstream(file, std::ios::app) << "c.comp,any,navi21,1\n";
  EXPECT_THROW(read_shader_table(file), Error);
  std::filesystem::remove(file);
}

class WithRadv : public testing::Test {
 protected:
  void SetUp() override {
    try {
      compilers_ = shader_compilers("navi21");
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
  std::string compilers_;
};

TEST_F(WithRadv, CommandWritesTheDocumentedFields) {
  const auto folder = std::filesystem::temp_directory_path();
  const std::string json = folder / ("scarp-shaders-" + std::to_string(::getpid()) + ".json");
  run_shaders({.families = {"vega10", "navi21"}, .shader = "max_pyramid"}, {"scarp-bench shaders", json});
  std::ifstream in(json);
  const nlohmann::json all = nlohmann::json::parse(in);
  std::filesystem::remove(json);
  ASSERT_EQ(all["rows"].size(), 2u);
  for (const nlohmann::json& row : all["rows"]) {
    EXPECT_EQ(row["shader"], "scarp/accel/max_pyramid.comp");
    EXPECT_EQ(row["specialisation"], "");
    EXPECT_EQ(row["compilers"], compilers_);
    for (const ShaderFigure& figure : kShaderFigures) {
      EXPECT_TRUE(row.at(std::string(figure.name)).is_number()) << figure.name;
    }
    EXPECT_GT(row["instructions"], 100);
    EXPECT_GT(row["vgprs"], 8);
  }
  EXPECT_EQ(all["rows"][0]["family"], "vega10");
  EXPECT_EQ(all["rows"][1]["family"], "navi21");
  EXPECT_NE(all["rows"][0]["code_bytes"], all["rows"][1]["code_bytes"]);
}

TEST_F(WithRadv, ErrorNamesUnknownFamilyOrShader) {
  const auto why = [](const ShadersOptions& options) {
    try {
      run_shaders(options, {});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(why({.families = {"navi21", "no-card"}}).find("'no-card'"), std::string::npos);
  EXPECT_NE(why({.shader = "no_shader"}).find("'no_shader'"), std::string::npos);
}

TEST_F(WithRadv, NoShaderExceedsTheTable) {
  const ShaderTable kept = read_shader_table(kTable);
  std::set<std::string> families;
  for (const ShaderRow& row : kept.rows) families.insert(row.family);
  ASSERT_FALSE(families.empty());
  if (compilers_ != kept.compilers) {
    GTEST_SKIP() << "the table is of other compilers: " << kept.compilers << "; these are " << compilers_;
  }
  for (const std::string& breach :
       shader_breaches(kept, compile_shaders(library_shaders(), {families.begin(), families.end()}))) {
    ADD_FAILURE() << breach << " (if that is meant: " << kRewrite << ")";
  }
}

}  // namespace
}  // namespace scarp::bench
