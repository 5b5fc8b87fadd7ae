// SPDX-License-Identifier: MIT
#include "bench/shader_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"

namespace scarp::bench {
namespace {

constexpr std::string_view kComment = "# ";

std::string head() {
  std::string line = "shader,specialisation,family";
  for (const ShaderFigure& figure : kShaderFigures) line += fmt::format(",{}", figure.name);
  return line;
}

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> all{""};
  for (const char c : line) {
    if (c == ',') {
      all.emplace_back();
    } else {
      all.back() += c;
    }
  }
  return all;
}

ShaderRow row_from(const std::string& line, const std::string& file) {
  const std::vector<std::string> texts = fields(line);
  const auto refuse = [&] { throw Error(fmt::format("'{}': not a row of a shader table: '{}'", file, line)); };
  if (texts.size() != 3 + kShaderFigures.size()) refuse();
  ShaderRow row{texts[0], texts[1], texts[2], {}};
  for (std::size_t k = 0; k < kShaderFigures.size(); ++k) {
    const std::string& text = texts[3 + k];
    if (text.empty()) continue;
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) refuse();
    row.figures[k] = value;
  }
  return row;
}

bool same(const ShaderRow& a, const ShaderRow& b) {
  return a.shader == b.shader && a.specialisation == b.specialisation && a.family == b.family;
}

const ShaderRow* find(const ShaderTable& table, const ShaderRow& wanted) {
  const auto found =
      std::find_if(table.rows.begin(), table.rows.end(), [&](const ShaderRow& row) { return same(row, wanted); });
  return found == table.rows.end() ? nullptr : &*found;
}

std::string name_of(const ShaderRow& row) {
  return fmt::format("{}{}{}, {}", row.shader, row.specialisation.empty() ? "" : ", ", row.specialisation, row.family);
}

}  // namespace

ShaderTable read_shader_table(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw Error(fmt::format("'{}': cannot be read", file));
  ShaderTable table;
  std::string line;
  if (!std::getline(in, line) || !line.starts_with(kComment)) {
    throw Error(fmt::format("'{}': not a shader table (its first line names the compilers)", file));
  }
  table.compilers = line.substr(kComment.size());
  if (!std::getline(in, line) || line != head()) {
    throw Error(fmt::format("'{}': not a shader table (its second line must be '{}')", file, head()));
  }
  while (std::getline(in, line)) table.rows.push_back(row_from(line, file));
  return table;
}

void write_shader_table(const std::string& file, const ShaderTable& table) {
  ReplaceFile replace(file);
  std::ofstream out(replace.temporary_path());
  out << kComment << table.compilers << '\n' << head() << '\n';
  for (const ShaderRow& row : table.rows) {
    out << fmt::format("{},{},{}", row.shader, row.specialisation, row.family);
    for (const auto& figure : row.figures) out << ',' << (figure ? fmt::format("{}", *figure) : "");
    out << '\n';
  }
  out.close();
  if (!out) throw Error(fmt::format("'{}': cannot be written; is the disk full?", file));
  replace.commit();
}

std::vector<std::string> shader_breaches(const ShaderTable& kept, const ShaderTable& found) {
  std::vector<std::string> breaches;
  for (const ShaderRow& row : found.rows) {
    const ShaderRow* before = find(kept, row);
    if (!before) {
      breaches.push_back(fmt::format("{}: not in the table", name_of(row)));
      continue;
    }
    for (std::size_t k = 0; k < kShaderFigures.size(); ++k) {
      const std::int64_t was = before->figures[k].value_or(0), is = row.figures[k].value_or(0);
      if (!kShaderFigures[k].judged || is <= was) continue;
      breaches.push_back(fmt::format("{}: {} {}, in the table {}", name_of(row), is, kShaderFigures[k].name, was));
    }
  }
  for (const ShaderRow& row : kept.rows) {
    if (!find(found, row)) breaches.push_back(fmt::format("{}: in the table, but no such shader", name_of(row)));
  }
  return breaches;
}

}  // namespace scarp::bench
