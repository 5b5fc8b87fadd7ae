// SPDX-License-Identifier: MIT
// Writes answers of many rays, heights and sweeps as hexadecimal bits: answers FILE. Its inputs need no function of the
// C library that rounds, so that files of two systems differ only if Scarp does.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "scarp/scarp.h"
#include "scarp/scene/scene_query.h"
#include "scarp/scene/tiled_terrain.h"

namespace {

constexpr int kSide = 257, kRays = 20'000;

class Random {
 public:
  double in(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_{7};
};

// Sums of parabolas, some holes.
template <class T>
std::vector<T> hills(bool holes) {
  Random random;
  std::vector<T> samples(kSide * kSide);
  for (int hill = 0; hill < 60; ++hill) {
    const double x = random.in(0, kSide), y = random.in(0, kSide), width = random.in(4, 50), height = random.in(2, 40);
    for (int i = 0; i < kSide * kSide; ++i) {
      const double dx = (i % kSide - x) / width, dy = (i / kSide - y) / width, square = dx * dx + dy * dy;
      if (square < 1) samples[static_cast<std::size_t>(i)] += static_cast<T>(height * (1 - square) * (1 - square));
    }
  }
  for (int i = 0; holes && i < kSide; ++i)
    samples[static_cast<std::size_t>(random.in(0, kSide * kSide))] = static_cast<T>(-9999);
  return samples;
}

std::FILE* out = nullptr;

void put(double value) {
  std::fprintf(out, "%016llx ", static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(value)));
}
void end_line() { std::fputc('\n', out); }

void put_scene(const char* name, const scarp::Scene& scene) {
  std::fprintf(out, "%s\n", name);
  Random random;
  std::vector<scarp::Ray> rays;
  for (int i = 0; i < kRays; ++i) {
    scarp::Ray ray{.origin = {random.in(-20, kSide + 20), random.in(-20, kSide + 20), random.in(-5, 90)},
                   .direction = {random.in(-1, 1), random.in(-1, 1), random.in(-1, 0.2)},
                   .t_max = random.in(5, 900)};
    rays.push_back(ray);
  }
  std::vector<scarp::Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  scarp::cast(scene, rays, hits);
  scarp::occluded(scene, rays, blocked);
  const scarp::SceneQuery query = scene.query({});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const scarp::Hit one = scarp::cast(scene, rays[i]);
    std::fprintf(out, "%d %d %u ", static_cast<int>(hits[i].status), blocked[i], hits[i] ? hits[i].object : 0);
    if (hits[i]) {
      put(hits[i].t);
      const scarp::SceneSurface surface = scene.surface(rays[i], hits[i]);
      for (int axis = 0; axis < 3; ++axis) put(surface.normal[axis]);
    }
    if (one.status != hits[i].status || (one && one.t != hits[i].t)) std::fputs("batch differs ", out);
    const auto height = scene.height(rays[i].origin.x, rays[i].origin.y);
    put(height.value_or(-1));
    if (i % 8 == 0) {
      const auto contact = query.sweep({rays[i].origin, rays[i].origin + scarp::dvec3(0, 0, i % 16 ? 1 : 0), 0.7},
                                       100.0 * rays[i].direction);
      put(contact ? contact->t : -1);
      const auto closest = query.closest_point(rays[i].origin, 50);
      put(closest ? closest->distance : -1);
      std::fprintf(out, "%d ", query.overlaps({rays[i].origin, {1, 2, 3}}));
    }
    end_line();
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: answers FILE\n", stderr);
    return 2;
  }
  out = std::fopen(argv[1], "wb");
  if (!out) {
    std::fprintf(stderr, "answers: %s: cannot be written\n", argv[1]);
    return 1;
  }
  using scarp::Terrain;
  const auto floats = Terrain::own(hills<float>(false), kSide, kSide);
  put_scene("float", floats);
  put_scene("int16 with holes", Terrain::own(hills<std::int16_t>(true), kSide, kSide, {.nodata = -9999.0}));
  put_scene("triangles",
            Terrain::own(hills<float>(true), kSide, kSide, {.nodata = -9999.0, .surface = scarp::Surface::triangles}));
  Random random;
  std::vector<std::uint8_t> indices(64 * 64 * 32);
  for (std::uint8_t& index : indices) index = random.in(0, 1) < 0.05;
  const auto voxels = scarp::Voxels::copy(indices.data(), {64, 64, 32}, {.side = 2});
  put_scene("voxels", voxels);
  put_scene("scene", scarp::combine({{floats}, {voxels, {.scale = 0.5, .origin = {40, 60, 20}}}}));
  return std::fclose(out) == 0 ? 0 : 1;
}
