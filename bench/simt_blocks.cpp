// SPDX-License-Identifier: MIT
#include "bench/simt_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <sstream>

#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"

namespace scarp::bench {
namespace {

constexpr std::string_view kHead = "shader,block,basic_blocks,instructions,vector,memory";
// The row with the instructions of the whole shader.
constexpr std::string_view kWhole = "whole";

int number(std::string_view text, std::string_view where) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0)
    throw Error(fmt::format("{}: '{}': expected a whole number", where, text));
  return value;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

// "5 24-35*3": numbers of basic blocks and how often each runs; calls `f` for each of them.
template <class Call>
void each_of(const std::string& ranges, const Call& call) {
  for (const std::string& written : split(ranges, ' ')) {
    const std::string range = written.substr(0, written.find('*'));
    const int turns =
        range.size() == written.size() ? 1 : number(std::string_view(written).substr(range.size() + 1), "turns");
    const std::size_t dash = range.find('-');
    const int first = number(std::string_view(range).substr(0, dash), "basic blocks");
    const int last =
        dash == std::string::npos ? first : number(std::string_view(range).substr(dash + 1), "basic blocks");
    for (int at = first; at <= last; ++at) call(at, turns);
  }
}

void require_sum(const SimtShader& shader, const std::string& where) {
  int sum = 0;
  for (const SimtCost& cost : shader.costs) sum += cost.instructions;
  if (sum == shader.instructions) return;
  throw Error(fmt::format("{}: the blocks of '{}' have {} instructions, the whole shader {}", where, shader.name, sum,
                          shader.instructions));
}

// Instructions by basic block. RADV prints "BB5:", then its instructions, one per line, after a tab.
std::map<int, SimtCost> basic_blocks_of(std::string_view disassembly) {
  std::map<int, SimtCost> all;
  SimtCost* at = nullptr;
  std::istringstream stream{std::string(disassembly)};
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("BB") && line.ends_with(':')) {
      const int index = number(std::string_view(line).substr(2, line.size() - 3), "disassembly");
      // The output before it is the same shader in the compiler's own representation.
      if (index == 0) all.clear();
      at = &all[index];
    } else if (at && line.starts_with('\t')) {
      const std::string_view code = std::string_view(line).substr(1);
      const auto is = [&](std::string_view kind) { return code.starts_with(kind); };
      ++at->instructions;
      at->vector += is("v_");
      at->memory += is("global_") || is("buffer_") || is("flat_") || is("scratch_") || is("image_");
    }
  }
  return all;
}

}  // namespace

SimtShader& SimtShaders::find(std::string_view name) {
  for (SimtShader& shader : shaders) {
    if (shader.name == name) return shader;
  }
  throw Error(fmt::format("shader '{}': not in the table of blocks", name));
}

SimtShaders read_simt_shaders(const std::string& file) {
  std::ifstream in(file);
  SimtShaders all;
  std::string line;
  if (!std::getline(in, line) || !line.starts_with("# ")) throw Error(fmt::format("'{}': cannot be read", file));
  all.compilers = line.substr(2);
  if (!std::getline(in, line) || line != kHead) throw Error(fmt::format("'{}': expected the columns {}", file, kHead));
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = split(line, ',');
    if (cells.size() != 6) throw Error(fmt::format("'{}': '{}': expected 6 columns", file, line));
    const SimtCost cost{number(cells[3], file), number(cells[4], file), number(cells[5], file)};
    if (cells[1] == kWhole) {
      all.shaders.push_back({cells[0], cost.instructions, {}, {}});
      continue;
    }
    const auto name = std::find(kSimtBlockNames.begin(), kSimtBlockNames.end(), cells[1]);
    if (name == kSimtBlockNames.end()) throw Error(fmt::format("'{}': '{}': is not a block", file, cells[1]));
    SimtShader& shader = all.find(cells[0]);
    const auto block = static_cast<std::size_t>(name - kSimtBlockNames.begin());
    shader.costs[block] = cost;
    shader.basic_blocks[block] = cells[2];
  }
  for (const SimtShader& shader : all.shaders) require_sum(shader, file);
  return all;
}

void write_simt_shaders(const std::string& file, const SimtShaders& shaders) {
  ReplaceFile replace(file);
  std::ofstream out(replace.temporary_path());
  out << "# " << shaders.compilers << '\n' << kHead << '\n';
  for (const SimtShader& shader : shaders.shaders) {
    SimtCost whole;
    for (const SimtCost& cost : shader.costs) {
      whole.vector += cost.vector;
      whole.memory += cost.memory;
    }
    out << fmt::format("{},{},,{},{},{}\n", shader.name, kWhole, shader.instructions, whole.vector, whole.memory);
    for (std::size_t block = 0; block < kSimtBlocks; ++block) {
      if (shader.basic_blocks[block].empty()) continue;
      const SimtCost& cost = shader.costs[block];
      out << fmt::format("{},{},{},{},{},{}\n", shader.name, kSimtBlockNames[block], shader.basic_blocks[block],
                         cost.instructions, cost.vector, cost.memory);
    }
  }
  out.close();
  if (!out) throw Error(fmt::format("'{}': cannot be written; is the disk full?", file));
  replace.commit();
}

SimtShader count_blocks(const SimtShader& shader, std::string_view disassembly) {
  const std::map<int, SimtCost> found = basic_blocks_of(disassembly);
  SimtShader counted{shader.name, 0, {}, shader.basic_blocks};
  std::map<int, int> used;
  std::string wrong;
  const auto is_wrong = [&](int at, std::string_view what) {
    wrong += fmt::format("{}BB{} {}", wrong.empty() ? "" : ", ", at, what);
  };
  for (std::size_t block = 0; block < kSimtBlocks; ++block) {
    each_of(shader.basic_blocks[block], [&](int at, int turns) {
      if (++used[at] == 2) is_wrong(at, "is in several blocks");
      // The compiler skips numbers.
      const auto basic = found.find(at);
      if (basic == found.end()) return;
      counted.instructions += turns * basic->second.instructions;
      counted.costs[block].instructions += turns * basic->second.instructions;
      counted.costs[block].vector += turns * basic->second.vector;
      counted.costs[block].memory += turns * basic->second.memory;
    });
  }
  for (const auto& [at, cost] : found) {
    if (!used.contains(at)) is_wrong(at, fmt::format("({} instructions) is in no block", cost.instructions));
  }
  if (used.empty() || found.empty() || used.rbegin()->first > found.rbegin()->first)
    wrong += fmt::format("{}the disassembly is shorter than the table's", wrong.empty() ? "" : ", ");
  if (!wrong.empty()) throw Error(fmt::format("shader '{}': {}", shader.name, wrong));
  return counted;
}

}  // namespace scarp::bench
