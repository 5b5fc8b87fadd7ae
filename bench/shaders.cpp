// SPDX-License-Identifier: MIT
// `scarp-bench shaders`: a driver compiler's statistics of each shader, without a card.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/report.h"
#include "bench/shader_compilation.h"
#include "bench/shader_table.h"
#include "bench/shaders.h"
#include "scarp/base/error.h"

namespace scarp::bench {

void run_shaders(const ShadersOptions& options, const ReportOptions& report) {
  std::vector<ShaderProgram> programs = library_shaders();
  std::erase_if(programs, [&](const ShaderProgram& program) {
    return program.file.find(options.shader) == std::string_view::npos;
  });
  if (programs.empty()) throw Error(fmt::format("--shader '{}': no shader has this in its path", options.shader));
  const ShaderTable table = compile_shaders(programs, options.families);
  std::printf("%s\n", table.compilers.c_str());
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::vector<std::vector<std::string>> lines{{"shader", "specialisation", "family", "instr.", "VGPRs", "SGPRs",
                                               "spilled V", "spilled S", "code B", "subgroups", "latency", "inv. thr.",
                                               "branches"}};
  for (const ShaderRow& row : table.rows) {
    nlohmann::ordered_json fields{
        {"shader", row.shader}, {"specialisation", row.specialisation}, {"family", row.family}};
    // The file name implies the folder.
    std::vector<std::string> line{row.shader.substr(row.shader.rfind('/') + 1), row.specialisation, row.family};
    for (std::size_t k = 0; k < kShaderFigures.size(); ++k) {
      nlohmann::ordered_json& field = fields[std::string(kShaderFigures[k].name)];
      if (row.figures[k]) field = *row.figures[k];
      line.push_back(short_number(field));
    }
    fields["compilers"] = table.compilers;
    rows.push_back(std::move(fields));
    lines.push_back(std::move(line));
  }
  print_table(lines, 3);
  write_json(report, rows);
  if (!options.update.empty()) write_shader_table(options.update, table);
}

void add_shaders(cli::Program& program) {
  auto [command, o] = add_command<ShadersOptions>(
      program, "shaders", "Each shader compiled for AMD cards that need not be there: size, registers, spills",
      run_shaders);
  command.add(cli::List<std::string>{&o.families}, {.names = "--families", .help = "cards as RADV names them"});
  command.add(&o.shader, {.names = "--shader", .value = "TEXT", .help = "only shaders whose path contains this"});
  command.add(&o.update, {.names = "--update",
                          .value = "FILE",
                          .help = "table to rewrite with these figures",
                          .files = "csv",
                          .note = "bench/shader_statistics.csv, with navi21 alone",
                          .excludes = {"--shader"}});
}

}  // namespace scarp::bench
