// SPDX-License-Identifier: MIT
// Several ways to do the same task, measured in turns on one thread.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/protocol.h"

namespace scarp::bench {

/// One way to do a task, for all of its items.
struct CallWay {
  std::string name;
  std::function<void()> run;
};

/// Median nanoseconds of processor time per item of each way; the ways take turns.
inline std::vector<double> measure_ways(const std::vector<CallWay>& ways, std::size_t items, int repeats) {
  std::vector<std::vector<double>> passes(ways.size());
  for (int pass = 0; pass <= repeats; ++pass) {
    for (std::size_t w = 0; w < ways.size(); ++w) {
      const Stopwatch watch;
      ways[w].run();
      if (pass > 0) passes[w].push_back(watch.cpu_s() * 1e9 / static_cast<double>(items));
    }
  }
  std::vector<double> ns;
  for (std::vector<double>& of_way : passes) ns.push_back(median(of_way));
  return ns;
}

}  // namespace scarp::bench
