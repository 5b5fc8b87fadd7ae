// SPDX-License-Identifier: MIT
// Lockstep, the table of blocks, and the traces of the shader source.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "bench/fields.h"
#include "bench/rays.h"
#ifdef SCARP_BENCH_VULKAN
#include "bench/shader_compilation.h"
#include "bench/simt_recount.h"
#endif
#include "bench/simt_trace.h"
#include "bench/simt_voxel_trace.h"
#include "bench/voxel_sets.h"
#include "scarp/base/error.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/voxel/voxel_table.h"
#include "scarp/scene/scene.h"

namespace scarp::bench {
namespace {

const std::string kTable = SCARP_SOURCE_DIR "/bench/simt_blocks.csv";

using Block = SimtBlock;

// A frame with this many iterations of the walk, each of which reads 8 bytes at the address.
void add_frame(SimtTrace& trace, int turns, std::uint64_t address) {
  trace.enter(Block::frame);
  for (int turn = 0; turn < turns; ++turn) {
    trace.enter(Block::walk);
    trace.fetch(address, 8);
  }
}

TEST(SimtBundle, LoopsRunUntilTheSlowestRayIsDone) {
  std::vector<SimtTrace> lanes(2);
  add_frame(lanes[0], 1, 0);
  add_frame(lanes[0], 3, 0);
  add_frame(lanes[1], 2, 0);
  const SimtBundle bundle = replay(lanes);
  EXPECT_EQ(bundle.of(Block::begin), 1u);
  EXPECT_EQ(bundle.of(Block::frame), 2u);
  // Both first frames take the two iterations of the longer one.
  EXPECT_EQ(bundle.of(Block::walk), 2u + 3u);
  EXPECT_EQ(bundle.lanes[static_cast<std::size_t>(Block::walk)], 1u + 3u + 2u);
  EXPECT_EQ(bundle.of(Block::end), 1u);
}

TEST(SimtBundle, CountsBranchesTakenByAnyRay) {
  std::vector<SimtTrace> lanes(2);
  for (SimtTrace& lane : lanes) add_frame(lane, 1, 0);
  lanes[0].enter(Block::cell);
  lanes[0].enter(Block::walk);
  lanes[1].enter(Block::walk);
  lanes[1].enter(Block::cell);
  lanes[1].enter(Block::hit);
  const SimtBundle bundle = replay(lanes);
  EXPECT_EQ(bundle.of(Block::walk), 2u);
  EXPECT_EQ(bundle.of(Block::cell), 2u);
  EXPECT_EQ(bundle.of(Block::hit), 1u);
}

TEST(SimtBundle, CountsCacheLinesPerFetch) {
  std::vector<SimtTrace> lanes(3);
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
    lanes[lane].enter(Block::frame);
    lanes[lane].enter(Block::probe);
    lanes[lane].fetch(64 * lane, 4);           // lines 0, 0, 1 of 128 bytes; 0, 1, 2 of 64
    lanes[lane].fetch(1000 + 4 * lane, 4);     // one line of 64 bytes: 960 to 1023
    if (lane == 2) lanes[lane].fetch(124, 8);  // by one lane only, across a border
  }
  const SimtBundle bundle = replay(lanes);
  EXPECT_EQ(bundle.fetches, 3u);
  EXPECT_EQ(bundle.lines[0], 2u + 1u + 2u);
  EXPECT_EQ(bundle.lines[1], 3u + 1u + 2u);
}

TEST(SimtBundle, AddsUpCosts) {
  std::vector<SimtTrace> lanes(1);
  add_frame(lanes[0], 4, 0);
  SimtShader shader{"toy", 0, {}, {}};
  shader.costs[static_cast<std::size_t>(Block::begin)] = {5, 1, 0};
  shader.costs[static_cast<std::size_t>(Block::walk)] = {100, 60, 2};
  shader.costs[static_cast<std::size_t>(Block::unused)] = {1000, 1000, 1000};
  const SimtSum sum = cost_of(replay(lanes), shader);
  EXPECT_EQ(sum.instructions, 405u);
  EXPECT_EQ(sum.vector, 241u);
  EXPECT_EQ(sum.memory, 8u);
}

TEST(SimtBundle, RejectsInvalidTraces) {
  std::vector<SimtTrace> lanes(1);
  lanes[0].enter(Block::cell);
  EXPECT_THROW(replay(lanes), Error);
}

constexpr const char* kDisassembly =
    "BB0\n\tv_nonsense of another listing\n=== Assembly\n"
    "BB0:\n\ts_load_dword s0, s[2:3], null   ; f400\n\tv_add_f32_e32 v0, v0, v1   ; 0600\n"
    "BB2:\n\tglobal_load_dword v1, v[2:3], off   ; dc30\n\ts_waitcnt vmcnt(0)   ; bf8c\n\tv_mul_f32_e32 v0, v0, v1\n"
    "\ts_branch BB2\n"
    "BB5:\n\ts_endpgm\n";

SimtShader toy_shader(const char* walk) {
  SimtShader shader{"toy", 0, {}, {}};
  shader.basic_blocks[static_cast<std::size_t>(Block::begin)] = "0";
  shader.basic_blocks[static_cast<std::size_t>(Block::walk)] = walk;
  shader.basic_blocks[static_cast<std::size_t>(Block::end)] = "5";
  return shader;
}

TEST(SimtBlocks, CountsBasicBlocks) {
  const SimtShader counted = count_blocks(toy_shader("1-3"), kDisassembly);
  EXPECT_EQ(counted.instructions, 7);
  EXPECT_EQ(counted[Block::begin].instructions, 2);
  EXPECT_EQ(counted[Block::begin].vector, 1);
  EXPECT_EQ(counted[Block::begin].memory, 0);
  EXPECT_EQ(counted[Block::walk].instructions, 4);
  EXPECT_EQ(counted[Block::walk].memory, 1);
  // An inner loop with three iterations.
  EXPECT_EQ(count_blocks(toy_shader("1-3*3"), kDisassembly)[Block::walk].instructions, 12);
  EXPECT_EQ(counted[Block::end].instructions, 1);
}

TEST(SimtBlocks, NamesUnknownBasicBlocks) {
  const auto why = [](const char* walk) {
    try {
      count_blocks(toy_shader(walk), kDisassembly);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(why("3"), "shader 'toy': BB2 (4 instructions) is in no block");
  EXPECT_EQ(why("2-5"), "shader 'toy': BB5 is in several blocks");
  EXPECT_EQ(why("2 9"), "shader 'toy': the disassembly is shorter than the table's");
}

TEST(SimtBlocks, RoundTrip) {
  SimtShaders all{"compilers", {count_blocks(toy_shader("1-3"), kDisassembly)}};
  const std::string file =
      std::filesystem::temp_directory_path() / ("scarp-simt-" + std::to_string(::getpid()) + ".csv");
  write_simt_shaders(file, all);
  const SimtShaders read = read_simt_shaders(file);
  EXPECT_EQ(read.compilers, "compilers");
  EXPECT_EQ(read.shaders.at(0).instructions, 7);
  EXPECT_EQ(read.shaders.at(0)[Block::walk].vector, 1);
  EXPECT_EQ(read.shaders.at(0).basic_blocks, all.shaders[0].basic_blocks);
  // The blocks must add up.
  ++all.shaders[0].costs[0].instructions;
  write_simt_shaders(file, all);
  EXPECT_THROW(read_simt_shaders(file), Error);
  std::filesystem::remove(file);
}

#ifdef SCARP_BENCH_VULKAN
TEST(SimtBlocks, MatchTheShaders) {
  const SimtShaders kept = read_simt_shaders(kTable);
  std::string compilers;
  try {
    compilers = shader_compilers("navi21");
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  if (compilers != kept.compilers) GTEST_SKIP() << "the table is of other compilers: " << kept.compilers;
  constexpr const char* kRewrite = "scarp-bench simt --recount --update bench/simt_blocks.csv";
  const SimtShaders found = recount(kept);
  for (std::size_t i = 0; i < kept.shaders.size(); ++i) {
    for (std::size_t block = 0; block < kSimtBlocks; ++block)
      EXPECT_EQ(found.shaders[i].costs[block], kept.shaders[i].costs[block])
          << kept.shaders[i].name << ", " << kSimtBlockNames[block] << " (rewrite the table: " << kRewrite << ")";
  }
}
#endif

struct SimtTraces : testing::Test {
  static BenchField small_field() {
    FieldOptions options;
    options.size = 129;
    return load_field(options);
  }
  const BenchField field = small_field();
  const MaxPyramid pyramid{field.field};
  const SimtGround ground{field.field, pyramid};
  const RayCounts counts{160, 88, 4096, 4096, 64};
  SimtShaders shaders = read_simt_shaders(kTable);

  // Each block that a ray enters has a cost.
  void expect_priced(const SimtTrace& trace, const std::string& shader) {
    const SimtBundle bundle = replay(std::span(&trace, 1));
    for (std::size_t block = 0; block < kSimtBlocks; ++block) {
      EXPECT_TRUE(bundle.runs[block] == 0 || shaders.find(shader).costs[block].instructions > 0)
          << shader << ", " << kSimtBlockNames[block];
    }
  }
};

TEST_F(SimtTraces, MatchMaxMipAndRecordReads) {
  std::size_t hits = 0;
  for (const RaySet& set : make_rays(field, {RayClass::primary, RayClass::shadow}, counts, 1)) {
    for (std::size_t i = 0; i < set.library_rays.size(); i += 7) {
      const Ray& ray = set.library_rays[i];
      SimtTrace trace;
      const SimtAnswer answer = trace_max_mip(ground, ray, set.any_hit, &trace);
      const Hit exact = march_max_mip({&field.field, &pyramid}, ray);
      ASSERT_EQ(answer.answer.hit, static_cast<bool>(exact)) << i;
      EXPECT_FALSE(answer.second_pass) << i;
      if (exact && !set.any_hit) {
        EXPECT_NEAR(answer.answer.t, exact.t, 0.01);
      }
      hits += answer.answer.hit;
      const SimtBundle bundle = replay(std::span(&trace, 1));
      EXPECT_EQ(bundle.of(Block::walk), answer.answer.stats.steps);
      EXPECT_EQ(bundle.of(Block::answer), 1u);
      EXPECT_EQ(bundle.fetches, bundle.of(Block::walk) + 2 * bundle.of(Block::cell));
      EXPECT_GE(bundle.lines[0], bundle.fetches);
      expect_priced(trace, set.any_hit ? "max-mip any" : "max-mip");
    }
  }
  EXPECT_GT(hits, 100u);
}

TEST_F(SimtTraces, NaiveTakesFewerStepsWhenClipped) {
  const RaySet set = make_rays(field, {RayClass::shadow}, counts, 1).front();
  std::uint64_t steps[2]{}, others = 0;
  for (std::size_t i = 0; i < set.library_rays.size(); i += 7) {
    bool hit[2];
    for (const bool clipped : {false, true}) {
      // The minimum step is a fraction of the distance: so small that it has no effect.
      const SimtNaive naive{{.min_step = 1e-6, .max_steps = 1 << 20}, clipped};
      SimtTrace trace;
      const SimtAnswer answer = trace_naive(ground, set.library_rays[i], true, naive, &trace);
      const SimtBundle bundle = replay(std::span(&trace, 1));
      EXPECT_EQ(bundle.of(Block::probe), answer.answer.stats.steps);
      EXPECT_EQ(bundle.fetches, 2 * bundle.of(Block::probe));
      expect_priced(trace, "naive any");
      steps[clipped] += answer.answer.stats.steps;
      hit[clipped] = answer.answer.hit;
    }
    others += hit[0] != hit[1];
  }
  EXPECT_LT(steps[1], steps[0]);
  EXPECT_LT(others, set.library_rays.size() / 7 / 50);
}

TEST(SimtVoxelTraces, MatchTheCpu) {
  SimtShaders shaders = read_simt_shaders(kTable);
  for (const VoxelMarchEntry& march : voxel_marches()) {
    if (!march.gpu) continue;
    const auto model = std::make_shared<const VoxelModel>(voxel_object("standard"), march);
    const PlacedVoxels placed{{model}, object_places(1)};
    const SimtVoxels voxels(placed);
    const Scene scene(scene_voxels(placed));
    int hits = 0;
    for (const Ray& ray : camera_rays(24)) {
      SimtTrace trace;
      const Hit hit = voxels.trace(ray, &trace);
      MarchStats stats;
      const Hit expected = scene.closest_hit(ray, nullptr, &stats);
      ASSERT_EQ(static_cast<bool>(hit), static_cast<bool>(expected)) << march.name;
      hits += static_cast<bool>(hit);
      if (hit) {
        EXPECT_TRUE(hit.t == expected.t && hit.voxel == expected.voxel && hit.face == expected.face &&
                    hit.part == expected.part);
      }
      const SimtBundle bundle = replay(std::span(&trace, 1));
      EXPECT_GE(bundle.of(SimtBlock::walk), bundle.of(SimtBlock::cross));
      EXPECT_EQ(bundle.of(SimtBlock::object) > 0, bundle.of(SimtBlock::turned) == 1);
      // An iteration either takes a step or finds the voxel.
      if (march.name == "voxel-planes") {
        EXPECT_EQ(bundle.of(SimtBlock::walk), stats.steps + bundle.of(SimtBlock::hit));
      }
      for (std::size_t block = 0; block < kSimtBlocks; ++block)
        EXPECT_TRUE(bundle.runs[block] == 0 || shaders.find(march.name).costs[block].instructions > 0)
            << march.name << ", " << kSimtBlockNames[block];
    }
    EXPECT_GT(hits, 100);
  }
}

TEST_F(SimtTraces, SkipTheTraceWhenNull) {
  const Ray ray = make_rays(field, {RayClass::chunk}, counts, 1).front().library_rays.front();
  SimtTrace trace;
  const bool traced = trace_max_mip(ground, ray, true, &trace).answer.hit;
  const std::size_t events = trace.events().size();
  EXPECT_EQ(trace_max_mip(ground, ray, true, nullptr).answer.hit, traced);
  EXPECT_GT(events, 2u);
  EXPECT_EQ(trace.events().size(), events);
}

}  // namespace
}  // namespace scarp::bench
