// SPDX-License-Identifier: MIT
// The part of bench/python.py in C++: the same rays against the same heights by the library's front door.
//   python_rays FOLDER SIDE CELL REPEATS
// reads heights.raw (SIDE x SIDE float32), origins.raw and directions.raw (float64, three each), and prints the least
// processor time in seconds of a batch and of a call with one ray, on one thread.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/scarp.h"

namespace {

template <class T>
std::vector<T> read(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<T> values(file ? static_cast<std::size_t>(file.tellg()) / sizeof(T) : 0);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
  if (!file) throw scarp::Error(path + ": cannot be read");
  return values;
}

template <class Work>
double least_seconds(int repeats, const Work& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const std::clock_t begin = std::clock();
    work();
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

void run(const std::string& folder, int side, double cell, int repeats) {
  const scarp::ThreadLimit one(1);
  const auto heights = read<float>(folder + "/heights.raw");
  const auto origins = read<scarp::dvec3>(folder + "/origins.raw");
  const auto directions = read<scarp::dvec3>(folder + "/directions.raw");
  const auto terrain = scarp::Terrain::view(heights.data(), side, side, {.cell_x = cell, .cell_y = cell});
  std::vector<scarp::Ray> rays(origins.size());
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = {.origin = origins[i], .direction = directions[i]};
  std::vector<scarp::Hit> hits(rays.size());
  const double batch = least_seconds(repeats, [&] { scarp::cast(terrain, rays, hits); });
  constexpr int kCalls = 20'000;
  const double call = least_seconds(repeats, [&] {
    for (int i = 0; i < kCalls; ++i) hits[0] = scarp::cast(terrain, rays[0]);
  });
  std::printf("%.9g %.9g\n", batch, call / kCalls);
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int kArguments = 5;
  if (argc != kArguments) return std::fputs("usage: python_rays FOLDER SIDE CELL REPEATS\n", stderr), 2;
  try {
    run(argv[1], std::atoi(argv[2]), std::atof(argv[3]), std::atoi(argv[4]));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "python_rays: error: %s\n", error.what());
    return 1;
  }
}
