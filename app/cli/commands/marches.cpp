// SPDX-License-Identifier: MIT
// `scarp marches`: the tables of marching techniques, as text or as Markdown for the documentation.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/commands.h"
#include "scarp/march/function/function_table.h"
#include "scarp/march/function/presets.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/shape/shape_table.h"
#include "scarp/march/voxel/voxel_table.h"

namespace scarp::cli {
namespace {

using Row = std::array<std::string, 6>;
const Row kHeads = {"name", "guarantee", "fields", "runs on", "parameters", "description"};
const Row kPresetHeads = {"preset", "march", "numbers", "left out", "source", ""};

// The rows of all tables. A march of several kinds of field has one row, which names them all.
class Rows {
 public:
  template <class Table>
  void add(std::string_view field, const Table& table) {
    for (const MarchEntry& march : table) add(field, march);
  }
  std::vector<Row> rows() const { return rows_; }

 private:
  void add(std::string_view field, const MarchEntry& march) {
    for (Row& row : rows_) {
      if (row[0] != march.name) continue;
      row[2] += fmt::format(", {}", field);
      return;
    }
    rows_.push_back({std::string(march.name), std::string(name_of(march.guarantee)), std::string(field),
                     fmt::format("cpu{}{}", march.simd ? ", simd" : "", march.gpu ? ", gpu" : ""),
                     march.parameters.empty() ? "-" : std::string(march.parameters), std::string(march.description)});
  }

  std::vector<Row> rows_;
};

std::vector<Row> march_rows() {
  Rows all;
  all.add("height field", height_marches());
  all.add("function", function_marches());
  all.add("voxel grid", voxel_marches());
  all.add("shape", shape_marches());
  return all.rows();
}

Row row_of(const MarchPreset& preset) {
  return {std::string(preset.name),    fmt::format("{}", preset.march),
          std::string(preset.numbers), preset.left_out.empty() ? "-" : std::string(preset.left_out),
          std::string(preset.source),  ""};
}

// Columns with an empty heading are omitted.
void print_markdown(const Row& heads, const std::vector<Row>& rows) {
  const auto columns = std::find(heads.begin(), heads.end(), "") - heads.begin();
  fmt::print("| {} |\n|", fmt::join(heads.begin(), heads.begin() + columns, " | "));
  for (std::ptrdiff_t i = 0; i < columns; ++i) fmt::print("---|");
  fmt::print("\n");
  for (const Row& row : rows) {
    fmt::print("| `{}` | {} |\n", row[0], fmt::join(row.begin() + 1, row.begin() + columns, " | "));
  }
}

void print_presets(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    fmt::print("{}: {}; {}\n    {}\n", row[0], row[1], row[2], row[4]);
    if (row[3] != "-") fmt::print("    left out: {}\n", row[3]);
  }
}

// Name, guarantee and so on in columns; parameters and description, which are long, on separate lines.
void print_plain(const std::vector<Row>& rows) {
  constexpr std::size_t kColumns = 4;
  std::array<std::size_t, kColumns> widths{};
  for (std::size_t i = 0; i < kColumns; ++i) {
    widths[i] = kHeads[i].size();
    for (const Row& row : rows) widths[i] = std::max(widths[i], row[i].size());
  }
  const auto columns = [&](const auto& row) {
    std::string line;
    for (std::size_t i = 0; i < kColumns; ++i) line += fmt::format("{:{}}  ", row[i], widths[i]);
    return line.substr(0, line.find_last_not_of(' ') + 1);
  };
  fmt::print("{}\n", columns(kHeads));
  for (const Row& row : rows) {
    fmt::print("{}\n    {}\n", columns(row), row[5]);
    if (row[4] != "-") fmt::print("    {}\n", row[4]);
  }
}

}  // namespace

void add_marches(Program& program) {
  Command& command = program.add("marches", "List the marching techniques and what each guarantees");
  const auto markdown = std::make_shared<bool>(false), presets = std::make_shared<bool>(false);
  command.add(markdown.get(), {.names = "--markdown", .help = "table in Markdown"});
  command.add(presets.get(),
              {.names = "--presets", .help = "settings of known shaders, for 'render --function --preset', instead"});
  command.runs([markdown, presets] {
    std::vector<Row> rows;
    if (*presets) {
      for (const MarchPreset& preset : march_presets()) rows.push_back(row_of(preset));
    } else {
      rows = march_rows();
    }
    if (*markdown) return print_markdown(*presets ? kPresetHeads : kHeads, rows);
    if (*presets) return print_presets(rows);
    print_plain(rows);
  });
}

}  // namespace scarp::cli
