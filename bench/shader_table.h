// SPDX-License-Identifier: MIT
// The table of shader statistics in bench/shader_statistics.csv: a test fails if a shader grows beyond it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scarp::bench {

struct ShaderFigure {
  std::string_view name;         ///< column of the table, field of the JSON
  std::string_view driver_name;  ///< RADV's name of the statistic
  bool judged;                   ///< whether growth fails the test
};
inline constexpr std::array<ShaderFigure, 10> kShaderFigures = {{
    {"instructions", "Instructions", true},
    {"vgprs", "VGPRs", true},
    {"sgprs", "SGPRs", false},
    {"spilled_vgprs", "Spilled VGPRs", true},
    {"spilled_sgprs", "Spilled SGPRs", true},
    {"code_bytes", "Code size", false},
    {"subgroups_per_simd", "Subgroups per SIMD", false},
    {"latency", "Latency", false},
    {"inverse_throughput", "Inverse Throughput", false},
    {"branches", "Branches", false},
}};

/// One shader in one specialisation, compiled for one family of cards.
struct ShaderRow {
  std::string shader, specialisation, family;
  std::array<std::optional<std::int64_t>, kShaderFigures.size()> figures{};  ///< empty if the driver does not report it

  bool operator==(const ShaderRow&) const = default;
};

struct ShaderTable {
  std::string compilers;  ///< compilers of SPIR-V and of the driver, with versions; other versions give other figures
  std::vector<ShaderRow> rows;
};

/// Reads a CSV file that starts with one line of comment. Throws Error if it cannot be read or has other columns.
ShaderTable read_shader_table(const std::string& file);
/// Throws Error if the file cannot be written.
void write_shader_table(const std::string& file, const ShaderTable& table);

/// Returns one line for each judged figure in `found` that exceeds that in `kept`, and for each row missing in either.
std::vector<std::string> shader_breaches(const ShaderTable& kept, const ShaderTable& found);

}  // namespace scarp::bench
