// SPDX-License-Identifier: MIT
#include "scarp/field/voxel_grid.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <optional>

#include "march/voxel/spiteful_voxels.h"
#include "scarp/base/error.h"
#include "scarp/field/ground_voxels.h"
#include "scarp/field/rotate_voxels.h"

namespace scarp::test {
namespace {

// Reference model of a grid: a table of optional entries.
struct Model {
  ivec3 size;
  std::vector<VoxelGrid::Voxel> voxels;

  explicit Model(const VoxelGrid& grid) : size(grid.size()) {
    for_each_voxel(grid.box(), [&](const ivec3& v) {
      voxels.push_back(grid.solid(v) ? VoxelGrid::Voxel(grid.entry(v)) : VoxelGrid::Voxel());
    });
  }
  VoxelGrid::Voxel& at(const ivec3& v) { return voxels[static_cast<std::size_t>(v.x + size.x * (v.y + size.y * v.z))]; }

  void expect(const VoxelGrid& grid) {
    std::int64_t solid = 0;
    VoxelBox bounds;
    for_each_voxel(grid.box(), [&](const ivec3& v) {
      ASSERT_EQ(grid.solid(v), at(v).has_value());
      if (!at(v)) return;
      ASSERT_EQ(grid.entry(v), *at(v)) << v.x << ' ' << v.y << ' ' << v.z;
      ++solid;
      bounds = around(bounds, {v, v + 1});
    });
    EXPECT_EQ(grid.solid_count(), solid);
    EXPECT_EQ(grid.bounds(), bounds);
  }
};

using Grids = testing::TestWithParam<VoxelGridKind>;

TEST_P(Grids, EditsChangeOnlyTheirVoxels) {
  Random random(3);
  for (int round = 0; round < 4; ++round) {
    VoxelGrid grid = GetParam().make(random);
    for (int i = 0; i < 12; ++i) {
      Model before(grid);
      const VoxelBox dirty = random_edit(grid, random);
      Model after(grid);
      after.expect(grid);
      VoxelBox changed;
      for_each_voxel(grid.box(), [&](const ivec3& v) {
        if (before.at(v) != after.at(v)) changed = around(changed, {v, v + 1});
      });
      EXPECT_EQ(dirty, changed);
    }
  }
}

// Setting many voxels at once, some outside the grid and some twice, equals setting them one after another.
TEST_P(Grids, SettingManyVoxelsMatchesSettingEach) {
  Random random(5);
  for (int round = 0; round < 4; ++round) {
    VoxelGrid grid = GetParam().make(random);
    Model expected(grid), before(grid);
    std::vector<VoxelGrid::Placed> placed(1 + random() % 500);
    for (VoxelGrid::Placed& one : placed) {
      for (int axis = 0; axis < 3; ++axis) one.voxel[axis] = static_cast<int>(random() % (grid.size()[axis] + 4u)) - 2;
      if (random() % 3) one.value = 1 + random() % 255;
      if (grid.box().contains(one.voxel)) expected.at(one.voxel) = one.value;
    }
    const VoxelBox dirty = grid.set(placed);
    expected.expect(grid);
    for_each_voxel(grid.box(), [&](const ivec3& v) {
      const bool changed = before.at(v) != expected.at(v);
      ASSERT_TRUE(dirty.contains(v) || !changed);
    });
  }
}

TEST_P(Grids, RotationsAreInvertible) {
  Random random(4);
  const VoxelGrid grid = GetParam().make(random);
  for (const LatticeRotation& turn : lattice_rotations()) {
    const VoxelGrid turned = rotated(grid, turn);
    Model(grid).expect(rotated(turned, turn.inverse()));
    for_each_voxel(grid.box(), [&](const ivec3& v) {
      const ivec3 at = rotated_voxel(v, grid.size(), turn);
      ASSERT_EQ(turned.solid(at), grid.solid(v));
      // The centre of a voxel is rotated with the centre of the grid.
      ASSERT_EQ(dvec3(at) + 0.5 - 0.5 * dvec3(turned.size()), turn(dvec3(v) + 0.5 - 0.5 * dvec3(grid.size())));
    });
  }
}

TEST_P(Grids, CombineVoxelByVoxel) {
  Random random(5);
  for (int i = 0; i < 5; ++i) {
    const VoxelGrid a = GetParam().make(random);
    VoxelGrid b(a.size(), 8);
    b.fill_sphere(0.5 * dvec3(a.size()), 4, 200);
    using Op = std::function<VoxelGrid::Voxel(VoxelGrid::Voxel, VoxelGrid::Voxel)>;
    const auto check = [&](VoxelBox (VoxelGrid::*combine)(const VoxelGrid&), const Op& op) {
      VoxelGrid result = a;
      (result.*combine)(b);
      Model expected(a), other(b);
      for_each_voxel(a.box(), [&](const ivec3& v) { expected.at(v) = op(expected.at(v), other.at(v)); });
      expected.expect(result);
    };
    check(&VoxelGrid::unite, [](auto x, auto y) { return x ? x : y; });
    check(&VoxelGrid::intersect, [](auto x, auto y) { return y ? x : VoxelGrid::Voxel(); });
    check(&VoxelGrid::subtract, [](auto x, auto y) { return y ? VoxelGrid::Voxel() : x; });
  }
}

TEST_P(Grids, KeepVisibleEntries) {
  Random random(6);
  VoxelGrid grid = GetParam().make(random);
  Model expected(grid);
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    bool hidden = grid.solid(v);
    for (int axis = 0; axis < 3; ++axis) {
      for (const int by : {-1, 1}) {
        ivec3 neighbour = v;
        neighbour[axis] += by;
        hidden = hidden && grid.box().contains(neighbour) && grid.solid(neighbour);
      }
    }
    if (hidden) expected.at(v) = 0;
  });
  const std::size_t bytes = grid.bytes(), masks = grid.masks().size_bytes();
  grid.drop_hidden_entries();
  expected.expect(grid);
  EXPECT_LE(grid.bytes(), bytes + masks);
  const VoxelGrid once = grid;
  grid.drop_hidden_entries();
  expected.expect(grid);
  random_edit(grid, random);
  Model(grid).expect(grid);
}

INSTANTIATE_TEST_SUITE_P(All, Grids, testing::ValuesIn(spiteful_voxel_grids()), [](const auto& kind) {
  std::string name(kind.param.name);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST(VoxelGrid, PacksEntriesOfEveryWidth) {
  for (int bits = 1; bits <= VoxelGrid::kMaxEntryBits; ++bits) {
    VoxelGrid grid({17, 33, 5}, bits);
    const std::uint32_t all = (1u << bits) - 1;
    const auto entry = [&](const ivec3& v) {
      return static_cast<std::uint32_t>(v.x * 7919 + v.y * 104729 + v.z * 31) & all;
    };
    grid.edit(grid.box(), [&](const ivec3& v, const VoxelGrid::Voxel&) { return VoxelGrid::Voxel(entry(v)); });
    for_each_voxel(grid.box(), [&](const ivec3& v) { ASSERT_EQ(grid.entry(v), entry(v)) << bits; });
    EXPECT_THROW(grid.set({0, 0, 0}, all + 1), Error);
  }
}

// More than one page, so that some are stored before the edit fails.
TEST(VoxelGrid, StaysConsistentAfterAThrowingEdit) {
  VoxelGrid grid({48, 32, 16}, 4);
  grid.set({20, 20, 8}, 5);
  std::vector<VoxelGrid::Placed> placed;
  for (int i = 0; i < 16; ++i) placed.push_back({{i, i, i}, 1u});
  placed.push_back({{47, 31, 15}, 16u});
  Model before(grid);
  EXPECT_THROW(grid.set(placed), Error);
  before.expect(grid);

  // An edit of all voxels that fails midway: once while filling, because an entry does not fit, and once while
  // clearing, because of an exception.
  const auto edit = [&](const VoxelGrid::Voxel& to, const std::function<VoxelGrid::Voxel()>& last) {
    int asked = 0;
    grid.edit(grid.box(), [&](const ivec3&, const VoxelGrid::Voxel&) { return ++asked == 20'000 ? last() : to; });
  };
  const auto thrown = []() -> VoxelGrid::Voxel { throw 1; };
  EXPECT_THROW(edit(3u, [] { return VoxelGrid::Voxel(16); }), Error);
  EXPECT_GT(grid.solid_count(), 10'000);
  Model(grid).expect(grid);
  EXPECT_THROW(edit({}, thrown), int);
  EXPECT_LT(grid.solid_count(), 10'000);
  Model(grid).expect(grid);
}

TEST(VoxelGrid, RejectsSizesOutOfRange) {
  EXPECT_THROW(VoxelGrid({0, 1, 1}), Error);
  EXPECT_THROW(VoxelGrid({1, 16385, 1}), Error);
  EXPECT_THROW(VoxelGrid({1, 1, 1}, 0), Error);
  EXPECT_THROW(VoxelGrid({1, 1, 1}, 25), Error);
  EXPECT_THROW(VoxelGrid({65536, 32768, 32768}), Error);  // 2^46 voxels
  EXPECT_NO_THROW(VoxelGrid({16384, 1, 1}));
  VoxelGrid grid({4, 4, 4});
  EXPECT_THROW(grid.unite(VoxelGrid({4, 4, 5})), Error);
}

// Pages that the source describes, and full pages that share their masks, have the same content as voxels set one by
// one, also after edits.
TEST(VoxelGrid, BuildsWorldsPageByPage) {
  for (const ivec3& size : {ivec3(300, 20, 24), ivec3(256, 16, 20), ivec3(70, 33, 50)}) {
    const auto height = [](int x, int y) { return 12 + (x / 40 + y / 5) % 4 - (y >= 4 && y < 8 ? 9 : 0); };
    const auto hidden = [&](const ivec3& v) { return v.z < height(v.x, v.y) - 3; };
    const VoxelGrid::Source source = {
        [&](const VoxelBox& page) {
          if (page.low.z >= 16) return VoxelGrid::Contents::empty;
          return (page.low.y >= 8 || page.high.y <= 4) && page.high.z <= 8 ? VoxelGrid::Contents::full
                                                                           : VoxelGrid::Contents::mixed;
        },
        [&](const ivec3& brick, std::span<std::uint32_t, 64> entries) {
          VoxelGrid::Brick filled;
          for_each_voxel({4 * brick, 4 * brick + 4}, [&](const ivec3& v) {
            if (v.z >= height(v.x, v.y)) return;
            const std::uint64_t bit = std::uint64_t{1} << VoxelGrid::bit_of(v);
            filled.solid |= bit;
            if (hidden(v)) return;
            filled.coloured |= bit;
            entries[static_cast<std::size_t>(VoxelGrid::bit_of(v))] = static_cast<std::uint32_t>(1 + v.x % 100);
          });
          return filled;
        }};
    VoxelGrid grid = VoxelGrid::built(size, 8, source);
    std::int64_t solid = 0;
    const auto expect = [&](const ivec3& v, bool filled) {
      const bool is = v.z < height(v.x, v.y) || filled;
      solid += is ? 1 : 0;
      ASSERT_EQ(grid.solid(v), is);
      if (is && !filled) {
        ASSERT_EQ(grid.entry(v), hidden(v) ? 0u : static_cast<std::uint32_t>(1 + v.x % 100));
      }
    };
    for_each_voxel(grid.box(), [&](const ivec3& v) { expect(v, false); });
    EXPECT_EQ(grid.solid_count(), solid);
    // In a page that is full, and in one that is empty.
    const VoxelBox cut{ivec3(size.x - 2, 9, 1), ivec3(size.x - 1, 11, 3)}, put{ivec3(1, 1, 18), ivec3(3, 2, 19)};
    EXPECT_EQ(grid.clear(cut), cut);
    EXPECT_EQ(grid.fill(put, 9), put);
    solid = 0;
    for_each_voxel(grid.box(), [&](const ivec3& v) {
      if (cut.contains(v)) {
        ASSERT_FALSE(grid.solid(v));
      } else {
        expect(v, put.contains(v));
      }
    });
    EXPECT_EQ(grid.solid_count(), solid);
    EXPECT_EQ(grid.entry({1, 1, 18}), 9u);
    VoxelGrid dropped = grid;
    dropped.drop_hidden_entries();
    EXPECT_EQ(dropped.solid_count(), grid.solid_count());
    EXPECT_EQ(dropped.entry({1, 1, 18}), 9u);
  }
}

TEST(VoxelGrid, FillsGroundBelowItsTops) {
  for (const ivec3& size : {ivec3(300, 21, 60), ivec3(256, 32, 64), ivec3(5, 7, 40)}) {
    std::vector<std::int32_t> tops;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) tops.push_back((x * x / 90 + 3 * y) % (size.z + 1));
    }
    const auto top = [&](int x, int y) {
      return x < 0 || y < 0 || x >= size.x || y >= size.y ? 0 : tops[static_cast<std::size_t>(x + size.x * y)];
    };
    const VoxelGrid grid = ground_voxels(size, tops, 8, [](const ivec3& v) { return 1 + (v.x + v.y + v.z) % 250; });
    for_each_voxel(grid.box(), [&](const ivec3& v) {
      ASSERT_EQ(grid.solid(v), v.z < top(v.x, v.y));
      if (!grid.solid(v)) return;
      const bool seen = v.z + 1 == top(v.x, v.y) || v.z >= top(v.x - 1, v.y) || v.z >= top(v.x + 1, v.y) ||
                        v.z >= top(v.x, v.y - 1) || v.z >= top(v.x, v.y + 1);
      ASSERT_EQ(grid.entry(v), seen ? static_cast<std::uint32_t>(1 + (v.x + v.y + v.z) % 250) : 0u);
    });
  }
  const std::vector<std::int32_t> tops = {1, 2, 3, 9};
  const auto none = [](const ivec3&) { return 0u; };
  EXPECT_THROW(ground_voxels({2, 2, 8}, tops, 8, none), Error);
  EXPECT_THROW(ground_voxels({2, 3, 9}, tops, 8, none), Error);
  EXPECT_THROW(ground_voxels({65536, 32768, 32768}, tops, 8, none), Error);
}

// Memory use depends on the solid voxels, not on the box.
TEST(VoxelGrid, StoresNoEmptyPages) {
  VoxelGrid grid({1024, 1024, 1024});
  EXPECT_LT(grid.bytes(), 2u << 20);
  grid.set({1023, 1023, 1023}, 7);
  grid.set({0, 0, 0}, 8);
  EXPECT_LT(grid.bytes(), 2u << 20);
  EXPECT_EQ(grid.entry({1023, 1023, 1023}), 7u);
  EXPECT_EQ(grid.entry({0, 0, 0}), 8u);
  EXPECT_EQ(grid.bounds(), grid.box());
  EXPECT_LE(static_cast<std::int64_t>(grid.bytes()), VoxelGrid::bytes_of(grid.size(), 2, 2, 8) + 64);
}

TEST(VoxelGrid, BuildFromBricksMatchesEdits) {
  const ivec3 size(70, 9, 33);
  const auto entry_at = [](const ivec3& v) { return (v.x * 7 + v.y * 31 + v.z * 3) % 5 == 0 ? v.x % 9 + 1 : 0; };
  VoxelGrid edited(size, 5);
  edited.edit(edited.box(), [&](const ivec3& v, const VoxelGrid::Voxel&) {
    const int entry = v.x < 40 ? entry_at(v) : 0;
    return entry > 0 ? VoxelGrid::Voxel(static_cast<std::uint32_t>(entry)) : VoxelGrid::Voxel();
  });
  const VoxelGrid built = VoxelGrid::built(size, 5, [&](const ivec3& brick, std::span<std::uint32_t, 64> entries) {
    std::uint64_t mask = 0;
    for_each_voxel({4 * brick, 4 * brick + 4}, [&](const ivec3& v) {
      const auto bit = static_cast<std::size_t>(VoxelGrid::bit_of(v));
      entries[bit] = static_cast<std::uint32_t>(entry_at(v));
      if (v.x < 40 && entries[bit] > 0) mask |= std::uint64_t{1} << bit;
    });
    return mask;
  });
  EXPECT_EQ(built.solid_count(), edited.solid_count());
  EXPECT_EQ(built.bounds(), edited.bounds());
  for_each_voxel(edited.box(), [&](const ivec3& v) {
    ASSERT_EQ(built.solid(v), edited.solid(v));
    ASSERT_EQ(built.entry(v), edited.entry(v));
  });
  const auto too_large = [](const ivec3&, std::span<std::uint32_t, 64> entries) {
    entries[0] = 32;
    return std::uint64_t{1};
  };
  EXPECT_THROW(VoxelGrid::built(size, 5, too_large), Error);
}

// The object of C. Leak's post (bench/voxel_sets.h): 32^3, each solid voxel with its own colour.
TEST(VoxelGrid, StoresTheStandardObjectCompactly) {
  VoxelGrid grid({32, 32, 32}, 24);
  grid.edit(grid.box(), [](const ivec3& v, const VoxelGrid::Voxel&) {
    const dvec3 from_middle = dvec3(v) + 0.5 - 16.0;
    return dot(from_middle, from_middle) - 0.1 <= 15.5 * 15.5
               ? VoxelGrid::Voxel(static_cast<std::uint32_t>(v.x | v.y << 8 | v.z << 16))
               : VoxelGrid::Voxel();
  });
  EXPECT_EQ(grid.solid_count(), 15'408);
  EXPECT_LT(grid.bytes() * 1024, 50u << 20);
  grid.drop_hidden_entries();
  EXPECT_LT(grid.bytes() * 1024, 16u << 20);
}

}  // namespace
}  // namespace scarp::test
