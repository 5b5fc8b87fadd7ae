// SPDX-License-Identifier: MIT
// `scarp-bench pyramid`: samples per second to build the pyramid of maxima of a field, including its memory allocation.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <thread>
#include <utility>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/protocol.h"
#include "bench/random.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/base/parallel.h"

namespace scarp::bench {
namespace {

// `pyramid`: build speed of the pyramid of maxima.
struct PyramidOptions {
  std::vector<int> sizes{2049, 8193};
  int repeats = 5;
};

using Json = nlohmann::ordered_json;

// The build computes maxima without branches, so the samples do not matter and may be noise.
template <class T>
HeightField noise_field(int size) {
  std::vector<T> samples(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  Random random(1, 0);
  for (T& sample : samples) sample = static_cast<T>(random.below(1000));
  return HeightField::own(std::move(samples), size, size);
}

Json measure_build(const HeightField& field, int threads, int repeats) {
  const ThreadLimit limit(threads);
  std::vector<double> seconds;
  double cpu = 0, wall = 0;
  std::size_t bytes = MaxPyramid(field).bytes();  // the warm-up
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const Stopwatch watch;
    bytes = MaxPyramid(field).bytes();
    seconds.push_back(watch.wall_s());
    wall += seconds.back();
    cpu += watch.cpu_s();
  }
  const double samples = static_cast<double>(field.cols()) * field.rows(), build_s = median(seconds);
  Json row;
  row["size"] = field.cols();
  row["sample_type"] = name_of(field.sample_type());
  row["threads"] = threads;
  row["build_s"] = build_s;
  row["gsamples_per_s"] = samples / build_s * 1e-9;
  row["bytes_per_sample"] = static_cast<double>(bytes) / samples;
  row["busy"] = cpu / (wall * threads);
  return row;
}

void run_pyramid(const PyramidOptions& options, const ReportOptions& report) {
  const int all = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<int> threads{1};
  if (all > 1) threads.push_back(all);
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{
      {"samples", "type", "threads", "build s", "Gsamples/s", "B/sample", "busy"}};
  for (const int size : options.sizes) {
    for (const HeightField& field : {noise_field<float>(size), noise_field<std::int16_t>(size)}) {
      for (const int count : threads) {
        const Json row = measure_build(field, count, options.repeats);
        lines.push_back({fmt::format("{0} x {0}", size), row["sample_type"], short_number(row["threads"]),
                         short_number(row["build_s"]), short_number(row["gsamples_per_s"]),
                         short_number(row["bytes_per_sample"]), fmt::format("{:.2f}", row["busy"].get<double>())});
        rows.push_back(row);
      }
    }
  }
  print_table(lines, 2);
  write_json(report, rows);
}

}  // namespace

void add_pyramid(cli::Program& program) {
  auto [command, o] =
      add_command<PyramidOptions>(program, "pyramid", "How fast the pyramid of maxima is built", run_pyramid);
  command.add(cli::List<int>{&o.sizes}, {.names = "--sizes", .help = "samples per side", .range = {2, 65536}});
  add_repeats_option(command, o.repeats, "counted builds");
}

}  // namespace scarp::bench
