// SPDX-License-Identifier: MIT
// `scarp-bench voxel-leaks`: a large number of rays at voxel grids. All marches must return the same voxel, face and t,
// ray by ray and in vectors, and a fraction of the rays is also traced by the judge. Then traces rays at scenes of
// rotated objects, and judges each in one grid into which all objects are written.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/random.h"
#include "bench/report.h"
#include "bench/voxel_scene_judge.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/voxel/voxel_packet.h"
#include "scarp/scene/voxel/voxel_model.h"
#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp::bench {
namespace {

// `voxel-leaks`: all voxel marches on a large number of rays, at grids and then at scenes.
struct VoxelLeaksOptions {
  std::int64_t rays = 10'000'000;
  std::uint64_t seed = 1;
  int judge_every = 64;    // one in this many is also traced by voxel-exhaustive
  std::string of = "all";  // "grids": single grids; "scenes": rotated objects
};

using Json = nlohmann::ordered_json;

constexpr std::int64_t kRaysPerGrid = 4096;
constexpr int kRayKinds = 6;
constexpr std::array<const char*, kRayKinds> kRayNames = {
    "anyhow",         "through corners",      "lattice directions",
    "along the axes", "nearly along a plane", "from 10^7 voxels away"};

VoxelGrid random_grid(Random& random) {
  constexpr std::array<double, 4> kShares = {0.005, 0.05, 0.4, 0.9};
  const double share = kShares[static_cast<std::size_t>(random.below(4))];
  VoxelGrid grid(ivec3(1 + random.below(32), 1 + random.below(32), 1 + random.below(32)), 8);
  grid.edit(grid.box(), [&](const ivec3&, const VoxelGrid::Voxel&) {
    return random.uniform() < share ? VoxelGrid::Voxel(1 + static_cast<std::uint32_t>(random.below(255)))
                                    : VoxelGrid::Voxel();
  });
  return grid;
}

VoxelRay random_ray(const VoxelGrid& grid, int kind, Random& random) {
  dvec3 place, direction;
  for (int axis = 0; axis < 3; ++axis) {
    place[axis] = random.uniform() * grid.size()[axis];
    direction[axis] = random.uniform(-1, 1);
  }
  double before = random.uniform(0, 60);
  const int axis = random.below(3);
  switch (kind) {
    case 1:
      place = dvec3(std::round(place.x), std::round(place.y), std::round(place.z));
      break;
    case 2:
      place = dvec3(std::round(place.x), std::round(place.y), std::round(place.z));
      for (int i = 0; i < 3; ++i) direction[i] = random.below(5) - 2;
      before = random.below(60);
      break;
    case 3:
      direction = dvec3(0.0);
      direction[axis] = random.below(2) ? 1 : -1;
      if (random.below(2)) place[random.below(3)] = random.below(33);
      break;
    case 4:
      direction[axis] = std::ldexp(random.uniform(-1, 1), -20 - random.below(20));
      place[axis] = std::round(place[axis]) + std::ldexp(random.uniform(-1, 1), -15 - random.below(30));
      break;
    case 5:
      before = 1e7;
      break;
    default:
      break;
  }
  if (dot(direction, direction) == 0) direction = {1, 1, 1};
  VoxelRay ray;
  ray.origin = place - before * direction;
  ray.direction = direction;
  return ray;
}

struct Counts {
  std::int64_t rays = 0, hits = 0, judged = 0, wrong = 0;
};

// Sums of all threads, one per kind of rays.
template <std::size_t kKinds>
class Total {
 public:
  void add(const std::array<Counts, kKinds>& part) {
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < kKinds; ++i) {
      counts_[i].rays += part[i].rays;
      counts_[i].hits += part[i].hits;
      counts_[i].judged += part[i].judged;
      counts_[i].wrong += part[i].wrong;
    }
  }
  const std::array<Counts, kKinds>& counts() const { return counts_; }

 private:
  std::mutex mutex_;
  std::array<Counts, kKinds> counts_;
};

// Rays that have been traced one by one, to be traced together.
struct Together {
  VoxelPacket packet;
  std::array<VoxelHit, VoxelPacket::kRays> expected;
  std::array<std::int64_t, VoxelPacket::kRays> index;

  void add(const VoxelRay& ray, const VoxelHit& hit, std::int64_t i) {
    const std::size_t lane = packet.count++;
    for (int axis = 0; axis < 3; ++axis)
      packet.origin[axis][lane] = ray.origin[axis], packet.direction[axis][lane] = ray.direction[axis];
    packet.t_min[lane] = ray.t_min, packet.t_max[lane] = ray.t_max;
    expected[lane] = hit, index[lane] = i;
  }
  // Runs one march, and calls wrong(i) for each ray with a different answer; entries are not compared.
  template <class Wrong>
  void ask(const VoxelModel& model, const Wrong& wrong) {
    aim_voxel_packet(packet, glm::dmat3(1.0));
    model.march().packet(model.target(), {}, packet, ~std::uint64_t{0} >> (VoxelPacket::kRays - packet.count));
    std::array<VoxelHit, VoxelPacket::kRays> hits{};
    for (std::size_t k = 0; k < packet.hits; ++k) {
      VoxelHit& hit = hits[static_cast<std::size_t>(packet.ray[k])];
      hit.status = HitStatus::hit, hit.t = packet.t[k], hit.face = static_cast<VoxelFace>(packet.face[k]);
      for (int axis = 0; axis < 3; ++axis) hit.voxel[axis] = static_cast<int>(packet.voxel[axis][k]);
    }
    for (std::size_t lane = 0; lane < packet.count; ++lane) {
      hits[lane].entry = expected[lane].entry;
      if (!(hits[lane] == expected[lane])) wrong(index[lane]);
    }
  }
};

// The first wrong ray.
struct FirstWrong {
  std::mutex mutex;
  std::string text;

  void tell(std::string_view what) {
    const std::lock_guard lock(mutex);
    if (text.empty()) text = what;
  }
};

std::array<Counts, kRayKinds> leaks_of_grids(const VoxelLeaksOptions& options, FirstWrong& first_wrong) {
  const auto exact = voxel_marches().subspan(1);
  Total<kRayKinds> total;
  const std::int64_t grids = (options.rays + kRaysPerGrid - 1) / kRaysPerGrid;
  parallel_for(grids, 4, [&](std::int64_t begin, std::int64_t end) {
    std::array<Counts, kRayKinds> counts;
    for (std::int64_t index = begin; index < end; ++index) {
      Random random(options.seed, static_cast<std::uint64_t>(index));
      const VoxelGrid grid = random_grid(random);
      std::vector<VoxelModel> models;
      for (const VoxelMarchEntry& march : exact) models.emplace_back(grid, march);
      const auto tell = [&](std::int64_t i) {
        const auto kind = static_cast<std::size_t>(i % kRayKinds);
        ++counts[kind].wrong;
        first_wrong.tell(fmt::format("grid {}, ray {} ({})", index, i, kRayNames[kind]));
      };
      Together together;
      const auto ask_together = [&] {
        if (together.packet.count == 0) return;
        for (const VoxelModel& model : models) {
          if (model.march().simd) together.ask(model, tell);
        }
        together.packet.count = 0;
      };
      for (std::int64_t i = 0; i < kRaysPerGrid; ++i) {
        const int kind = static_cast<int>(i % kRayKinds);
        Counts& count = counts[static_cast<std::size_t>(kind)];
        const VoxelRay ray = random_ray(grid, kind, random);
        ++count.rays;
        if (grid.bounds().empty()) continue;
        const auto quantised = quantise(ray, grid.bounds());
        if (!quantised) continue;
        const VoxelHit hit = exact[0].cpu(models[0].target(), *quantised, nullptr);
        count.hits += hit ? 1 : 0;
        bool right = true;
        for (std::size_t m = 1; m < exact.size(); ++m)
          right = right && exact[m].cpu(models[m].target(), *quantised, nullptr) == hit;
        if (random.below(options.judge_every) == 0) {
          ++count.judged;
          right = right && voxel_marches()[0].cpu(models[0].target(), *quantised, nullptr) == hit;
        }
        if (!right) tell(i);
        together.add(ray, hit, i);
        if (together.packet.count == VoxelPacket::kRays) ask_together();
      }
      ask_together();
    }
    total.add(counts);
  });
  return total.counts();
}

constexpr std::int64_t kRaysPerScene = 512;
constexpr std::size_t kSceneKinds = 4;
constexpr std::array<const char*, kSceneKinds> kSceneNames = {
    "turned objects: exact rays", "turned objects: rounded rays", "placed fields: exact rays",
    "placed fields: rounded rays"};

// Half of the rays of a scene see its objects in one field; the rest see each object in its own field. Judges all rays
// except those that may either pass or hit a solid voxel because of rounding at its edge.
std::array<Counts, kSceneKinds> leaks_of_scenes(const VoxelLeaksOptions& options, FirstWrong& first_wrong) {
  Total<kSceneKinds> total;
  const std::int64_t scenes = (options.rays + kRaysPerScene - 1) / kRaysPerScene;
  parallel_for(scenes, 4, [&](std::int64_t begin, std::int64_t end) {
    std::array<Counts, kSceneKinds> counts;
    std::vector<LatticeRay> lattice(kRaysPerScene / 2);
    std::vector<Ray> rays(lattice.size());
    std::vector<Hit> hits(lattice.size());
    std::vector<std::uint8_t> blocked(lattice.size());
    for (std::int64_t index = begin; index < end; ++index) {
      Random random(options.seed, ~static_cast<std::uint64_t>(index));
      const VoxelSceneJudge judge(random, {});
      const VoxelObjects objects(judge.placed());
      const Scene fields = judge.as_fields();
      for (const bool placed : {false, true}) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
          lattice[i] = VoxelSceneJudge::random_ray(random);
          rays[i] = judge.world_ray(lattice[i]);
        }
        if (placed) {
          fields.closest_hits(rays, hits);
          fields.occluded(rays, blocked);
        } else {
          objects.closest_hits(rays, hits);
          objects.occluded(rays, blocked);
        }
        for (std::size_t i = 0; i < rays.size(); ++i) {
          Counts& count = counts[(placed ? 2u : 0u) + (judge.exact(lattice[i]) ? 0u : 1u)];
          const LatticeAnswer expected = judge.answer(lattice[i]);
          Hit hit = placed ? fields.closest_hit(rays[i]) : objects.closest_hit(rays[i]);
          const bool any = placed ? fields.occluded(rays[i]) : objects.occluded(rays[i]);
          const bool same = hit == hits[i] && any == (blocked[i] != 0) && any == static_cast<bool>(hit);
          if (placed) hit.part = hit.object;
          ++count.rays;
          count.hits += hit ? 1 : 0;
          count.judged += expected.decided() ? 1 : 0;
          if (same && judge.agrees(lattice[i], expected, hit)) continue;
          ++count.wrong;
          first_wrong.tell(fmt::format("scene {}, ray {}{}", index, i, placed ? " at placed fields" : ""));
        }
      }
    }
    total.add(counts);
  });
  return total.counts();
}

void run_voxel_leaks(const VoxelLeaksOptions& options, const ReportOptions& report) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"rays", "count", "hits", "judged", "wrong"}};
  std::int64_t wrong = 0;
  FirstWrong first_wrong;
  const auto add = [&](const char* name, const Counts& c) {
    wrong += c.wrong;
    rows.push_back({{"kind", name}, {"rays", c.rays}, {"hits", c.hits}, {"judged", c.judged}, {"wrong", c.wrong}});
    lines.push_back({name, short_number(c.rays), short_number(c.hits), short_number(c.judged), short_number(c.wrong)});
  };
  if (options.of != "scenes") {
    const auto of_grids = leaks_of_grids(options, first_wrong);
    for (std::size_t i = 0; i < of_grids.size(); ++i) add(kRayNames[i], of_grids[i]);
  }
  if (options.of != "grids") {
    const auto of_scenes = leaks_of_scenes(options, first_wrong);
    for (std::size_t i = 0; i < of_scenes.size(); ++i) add(kSceneNames[i], of_scenes[i]);
  }
  print_table(lines, 1);
  write_json(report, rows);
  if (wrong > 0)
    throw Error(fmt::format("voxel-leaks: {} rays were answered differently; the first: {}", wrong, first_wrong.text));
}

}  // namespace

void add_voxel_leaks(cli::Program& program) {
  auto [command, o] = add_command<VoxelLeaksOptions>(
      program, "voxel-leaks", "Very many rays at voxel grids; fails if marches differ", run_voxel_leaks);
  command.add(&o.rays, {.names = "--rays", .help = "rays in all", .range = {1, 1e15}});
  command.add(&o.seed, {.names = "--seed", .help = "seed of grids and rays"});
  command.add(
      &o.judge_every,
      {.names = "--judge-every", .help = "one in so many is also traced by voxel-exhaustive", .range = {1, 1 << 30}});
  command.add(&o.of, {.names = "--of",
                      .value = "WHAT",
                      .help = "single grids, or scenes of rotated objects",
                      .choices = {"grids", "scenes", "all"},
                      .closed = true});
}

}  // namespace scarp::bench
