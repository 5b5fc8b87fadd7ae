// SPDX-License-Identifier: MIT
// `scarp-bench edits`: the time from the call of LiveField::edit to its return, when queries see the new samples;
// compared with rebuilding the pyramid.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/protocol.h"
#include "bench/random.h"
#include "bench/report.h"
#include "scarp/accel/live_field.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

// `edits`: time until an edit of a rectangle is visible to queries.
struct EditsOptions {
  int size = 16385;  // samples per side
  int rect = 256;    // samples per side of the rectangle
  int edits = 200;
};

using Json = nlohmann::ordered_json;

template <class T>
Json measure(const EditsOptions& options) {
  Random random(1, 0);
  const auto noise = [&](int side) {
    std::vector<T> samples(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (T& sample : samples) sample = static_cast<T>(random.below(1000));
    return samples;
  };
  const HeightField field = HeightField::own(noise(options.size), options.size, options.size);
  // Edits stay within the field's range of heights, as digging would.
  LiveField live(field);
  const std::vector<T> edit = noise(options.rect);
  std::vector<double> seconds;
  for (int i = 0; i < options.edits; ++i) {
    const int room = options.size - options.rect + 1;
    const SampleRect rect{random.below(room), random.below(room), options.rect, options.rect};
    const Stopwatch watch;
    live.edit(rect, edit.data(), options.rect);
    seconds.push_back(watch.wall_s());
  }
  const Stopwatch watch;
  const MaxPyramid anew(field);
  const double rebuild_s = watch.wall_s();
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double share) {
    return 1e6 * seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))];
  };
  Json row;
  row["size"] = options.size;
  row["rect"] = options.rect;
  row["sample_type"] = name_of(field.sample_type());
  row["edits"] = options.edits;
  row["median_us"] = at(0.5);
  row["p99_us"] = at(0.99);
  row["rebuild_us"] = 1e6 * rebuild_s;
  return row;
}

void run_edits(const EditsOptions& options, const ReportOptions& report) {
  if (options.rect > options.size) {
    throw Error(
        fmt::format("edits: a rectangle of {0} x {0} does not fit into {1} x {1} samples", options.rect, options.size));
  }
  Json rows = Json::array();
  rows.push_back(measure<float>(options));
  rows.push_back(measure<std::int16_t>(options));
  std::vector<std::vector<std::string>> lines{{"samples", "rectangle", "type", "median us", "p99 us", "rebuild us"}};
  for (const Json& row : rows) {
    lines.push_back({fmt::format("{0} x {0}", row["size"].get<int>()), fmt::format("{0} x {0}", row["rect"].get<int>()),
                     row["sample_type"], short_number(row["median_us"]), short_number(row["p99_us"]),
                     fmt::format("{:.0f}", row["rebuild_us"].get<double>())});
  }
  print_table(lines, 3);
  write_json(report, rows);
}

}  // namespace

void add_edits(cli::Program& program) {
  auto [command, o] = add_command<EditsOptions>(program, "edits", "How soon an edit is visible to queries", run_edits);
  command.add(&o.size, {.names = "--size", .help = "samples per side", .range = {2, 65536}});
  command.add(&o.rect,
              {.names = "--rect", .help = "samples per side of the rectangle that is edited", .range = {1, 65536}});
  command.add(&o.edits, {.names = "--edits", .help = "counted edits", .range = {1, 100000}});
}

}  // namespace scarp::bench
