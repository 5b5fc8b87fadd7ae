// SPDX-License-Identifier: MIT
#include "scarp/output/hit_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "scarp/base/error.h"
#include "scratch.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

class HitTables : public testing::Test, protected test::Scratch {
 protected:
  static std::string bytes_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

HitRow a_hit() {
  HitRow row;
  row.ray = 1;
  row.hit.status = HitStatus::hit;
  row.hit.t = 0.1;
  row.hit.cell = {7, 8};
  row.hit.u = 1.0 / 3;
  row.hit.v = 1;
  row.hit.wall = true;
  row.position = {-1.5e-7, 4033000.0000000005, 1e300};
  row.normal = {0, 0.6, 0.8};
  return row;
}

std::vector<HitRow> all_kinds() {
  std::vector<HitRow> rows(4);
  rows[0].hit.status = HitStatus::miss;
  rows[1] = a_hit();
  rows[2].ray = 1;
  rows[2].hit.status = HitStatus::below;
  rows[3].ray = 2;
  rows[3].hit.status = HitStatus::exhausted;
  rows[3].hit.t = 12.5;
  return rows;
}

TEST_F(HitTables, WritesCsv) {
  const TextColumns carried{{"id", "a \"quoted\", remark"}, {"x1", "", "two\nlines", "1,5", "", ""}};
  {
    HitTable table(path("h.csv"), TableKind::hits, carried);
    table.add(all_kinds());
    EXPECT_FALSE(fs::exists(path("h.csv"))) << "whole or not there";
    table.commit();
  }
  EXPECT_EQ(bytes_of(path("h.csv")),
            "id,\"a \"\"quoted\"\", remark\",ray,status,t,x,y,z,col,row,u,v,nx,ny,nz,wall\n"
            "x1,,0,miss,,,,,,,,,,,,\n"
            "\"two\nlines\",\"1,5\",1,hit,0.1,-1.5e-07,4033000.0000000005,1e+300,7,8,0.3333333333333333,1,0,0.6,0.8,1\n"
            "\"two\nlines\",\"1,5\",1,below,,,,,,,,,,,,\n"
            ",,2,exhausted,12.5,,,,,,,,,,,\n");
}

// Columns that a kind of field does not have are empty.
TEST_F(HitTables, WritesSceneCsv) {
  std::vector<HitRow> rows(4, a_hit());
  for (HitRow& row : rows) row.position = {1, 2, 3}, row.hit.object = 5;
  rows[0].material = 2;
  rows[1].kind = HitKind::function;
  rows[2].kind = HitKind::voxels;
  rows[2].hit.part = 9, rows[2].hit.voxel = {10, 0, 12}, rows[2].hit.face = VoxelFace::low_y;
  rows[3].kind = HitKind::mesh;
  rows.emplace_back().ray = 2;
  const TextColumns carried;
  HitTable table(path("s.csv"), TableKind::scene_hits, carried);
  table.add(rows);
  table.commit();
  EXPECT_EQ(bytes_of(path("s.csv")),
            "ray,status,t,x,y,z,col,row,u,v,nx,ny,nz,wall,object,kind,material,triangle,part,voxel_x,voxel_y,voxel_z,"
            "face\n"
            "1,hit,0.1,1,2,3,7,8,0.3333333333333333,1,0,0.6,0.8,1,5,heights,2,,,,,,\n"
            "1,hit,0.1,1,2,3,,,,,0,0.6,0.8,,5,function,,,,,,,\n"
            "1,hit,0.1,1,2,3,,,,,0,0.6,0.8,,5,voxels,,,9,10,0,12,low_y\n"
            "1,hit,0.1,1,2,3,,,0.3333333333333333,1,0,0.6,0.8,,5,mesh,,7,,,,,\n"
            "2,miss,,,,,,,,,,,,,,,,,,,,,\n");
  EXPECT_EQ(find_hit_kind("shape"), HitKind::shape);
  EXPECT_EQ(find_hit_kind("plinth"), std::nullopt);
}

TEST_F(HitTables, WritesBlockedCsv) {
  const TextColumns carried;
  HitTable table(path("b.csv"), TableKind::blocked, carried);
  table.add(0, std::vector<std::uint8_t>{0, 1});
  table.add(2, std::vector<std::uint8_t>{1});
  table.commit();
  EXPECT_EQ(bytes_of(path("b.csv")), "ray,blocked\n0,0\n1,1\n2,1\n");
}

TEST_F(HitTables, WritesRaysThatWereNotTraced) {
  const TextColumns carried{{"id"}, {"a", "b", "c", "d"}};
  HitTable hits(path("h.csv"), TableKind::hits, carried), blocked(path("b.csv"), TableKind::blocked, carried);
  hits.add_invalid(3);
  blocked.add_invalid(3);
  hits.commit();
  blocked.commit();
  EXPECT_TRUE(bytes_of(path("h.csv")).ends_with("\nd,3,invalid,,,,,,,,,,,,\n")) << bytes_of(path("h.csv"));
  EXPECT_EQ(bytes_of(path("b.csv")), "id,ray,blocked\nd,3,\n");
}

TEST_F(HitTables, NpyIsAStructuredArrayOfDoubles) {
  const TextColumns carried{{"ray"}, {"a", "b", "c"}};
  HitTable table(path("h.npy"), TableKind::hits, carried);
  table.add(all_kinds());
  table.commit();
  const std::string bytes = bytes_of(path("h.npy"));
  ASSERT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\0", 8));
  const std::size_t header = 10u + static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ(header % 64, 0u);
  EXPECT_EQ(bytes[header - 1], '\n');
  const std::string dictionary = bytes.substr(10, header - 10);
  EXPECT_EQ(dictionary.find("{'descr': [('ray', '<f8'), ('status', '<f8'), ('t', '<f8'), ('x', '<f8'), "), 0u);
  EXPECT_NE(dictionary.find("('wall', '<f8')], 'fortran_order': False, 'shape': (4,), }"), std::string::npos);
  constexpr std::size_t kColumns = 14;
  ASSERT_EQ(bytes.size(), header + 4 * kColumns * sizeof(double));
  double numbers[4][kColumns];
  std::memcpy(numbers, bytes.data() + header, sizeof(numbers));
  EXPECT_EQ(numbers[0][0], 0);
  EXPECT_EQ(numbers[0][1], 0);
  for (std::size_t c = 2; c < kColumns; ++c) EXPECT_TRUE(std::isnan(numbers[0][c]));
  const double hit[kColumns] = {1, 1, 0.1, -1.5e-7, 4033000.0000000005, 1e300, 7, 8, 1.0 / 3, 1, 0, 0.6, 0.8, 1};
  for (std::size_t c = 0; c < kColumns; ++c) EXPECT_EQ(numbers[1][c], hit[c]) << c;
  EXPECT_EQ(numbers[2][1], 2);
  EXPECT_EQ(numbers[3][1], 3);
  EXPECT_EQ(numbers[3][2], 12.5);
}

TEST_F(HitTables, WritesManyRows) {
  const TextColumns carried;
  constexpr std::size_t kRows = 300000;
  for (const char* name : {"many.csv", "many.npy"}) {
    HitTable table(path(name), TableKind::blocked, carried);
    for (std::size_t first = 0; first < kRows; first += 1000) {
      table.add(static_cast<std::int64_t>(first), std::vector<std::uint8_t>(1000, 1));
    }
    table.commit();
  }
  EXPECT_NE(bytes_of(path("many.npy")).find("'shape': (300000,)"), std::string::npos);
  EXPECT_EQ(fs::file_size(path("many.npy")) % 64, 300000 * 16 % 64);
  const std::string csv = bytes_of(path("many.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 300001);
  EXPECT_TRUE(csv.ends_with("\n299999,1\n"));
}

TEST_F(HitTables, LeavesNoFileWithoutCommit) {
  const TextColumns carried;
  { HitTable(path("h.csv"), TableKind::hits, carried).add(all_kinds()); }
  EXPECT_TRUE(empty());
}

TEST_F(HitTables, RejectsInvalidTables) {
  const auto error_of = [](const std::string& file, const TextColumns& carried) -> std::string {
    try {
      HitTable(file, TableKind::hits, carried);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(error_of(path("h.txt"), {}).find(".csv or .npy"), std::string::npos);
  EXPECT_NE(error_of(path("h"), {}).find(".csv or .npy"), std::string::npos);
  EXPECT_NE(error_of(path("no/h.csv"), {}).find("does not exist"), std::string::npos);
  EXPECT_NE(error_of(path("h.csv"), {{"t"}, {}}).find("column 't'"), std::string::npos);
  EXPECT_TRUE(empty());
}

}  // namespace
}  // namespace scarp
