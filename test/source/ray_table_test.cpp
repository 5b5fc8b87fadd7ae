// SPDX-License-Identifier: MIT
#include "scarp/source/table/ray_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/refusal.h"
#include "scarp/base/error.h"
#include "source/npy_bytes.h"

namespace scarp {
namespace {

using test::npy_bytes;
using test::npy_dictionary;
using test::sample_bytes;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Parse>
void expect_refused(const Parse& parse, const std::string& bytes, const std::string& fragment) {
  try {
    parse(bytes);
    ADD_FAILURE() << "no error: " << bytes;
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(fragment), std::string::npos) << "'" << fragment << "' is not in: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

void expect_csv_refused(const std::string& bytes, const std::string& fragment) {
  expect_refused([](const std::string& b) { return parse_ray_csv(b); }, bytes, fragment);
}
void expect_npy_refused(const std::string& bytes, const std::string& fragment) {
  expect_refused([](const std::string& b) { return parse_ray_npy(b); }, bytes, fragment);
}

const std::string kHeader = "x,y,z,dx,dy,dz\n";

TEST(RayCsv, AcceptsColumnsInAnyOrder) {
  const RayTable table = parse_ray_csv("dz,x,id,y,t_max,z,dx,dy,t_min\n-1,10,a,20,500,30,0.5,-.25,-2e1\n");
  ASSERT_EQ(table.rows.size(), 1u);
  const RayRow& row = table.rows[0];
  EXPECT_EQ(table.aim, RayAim::direction);
  EXPECT_EQ(row.origin, dvec3(10, 20, 30));
  EXPECT_EQ(row.aim, dvec3(0.5, -0.25, -1));
  EXPECT_EQ(row.t_min, -20);
  EXPECT_EQ(row.t_max, 500);
  EXPECT_EQ(row.start, RayStart::free);
  EXPECT_EQ(table.carried.names, std::vector<std::string>{"id"});
  EXPECT_EQ(table.carried.at(0, 0), "a");
}

TEST(RayCsv, AppliesDefaultsToMissingColumns) {
  const RayTable directions = parse_ray_csv("x,y,z,dx,dy,dz,t_min,t_max,start_col,start_row\n1,2,3,0,0,-1,,,,\n");
  EXPECT_EQ(directions.rows.at(0).t_min, 0);
  EXPECT_EQ(directions.rows[0].t_max, kInfinity);
  EXPECT_EQ(directions.rows[0].start, RayStart::free);
  const RayTable targets = parse_ray_csv("x,y,z,tx,ty,tz,t_max\n1,2,3,4,5,6,\n1,2,3,4,5,6,inf\n");
  EXPECT_EQ(targets.aim, RayAim::target);
  EXPECT_EQ(targets.rows.at(0).aim, dvec3(4, 5, 6));
  EXPECT_EQ(targets.rows[0].t_max, 1) << "a target is where the ray ends";
  EXPECT_EQ(targets.rows.at(1).t_max, kInfinity);
}

TEST(RayCsv, StartCellPutsTheRayOnTheSurface) {
  const RayTable table = parse_ray_csv("x,y,z,dx,dy,dz,start_col,start_row\n1,2,3,0,0,-1,7,0\n");
  EXPECT_EQ(table.rows.at(0).start, RayStart::on_surface);
  EXPECT_EQ(table.rows[0].start_cell, (Cell{7, 0}));
}

TEST(RayCsv, AcceptsSeparatorsLineEndsMarksAndBlankLines) {
  for (const std::string separator : {",", ";", "\t"}) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
      std::string bytes = "\xEF\xBB\xBFx,y,z,dx,dy,dz\n\n 1 ,+2,3e0,0,0,-1\n  \n4,5,6,0,0,-1";
      std::string text;
      for (const char c : bytes) text += c == ',' ? separator : c == '\n' ? end : std::string(1, c);
      const RayTable table = parse_ray_csv(text);
      ASSERT_EQ(table.rows.size(), 2u) << text;
      EXPECT_EQ(table.rows[0].origin, dvec3(1, 2, 3));
      EXPECT_EQ(table.rows[0].line, 3);
      EXPECT_EQ(table.rows[1].line, 5);
    }
  }
}

TEST(RayCsv, QuotesMayContainSeparatorsQuotesAndLineEnds) {
  const RayTable table = parse_ray_csv(
      "\"x\",y,z,dx,dy,dz,\"a, b\",c\n\"1\",2,3,0,0,-1,\"say \"\"hi\"\", "
      "you\",\"two\r\nlines\"\n4,5,6,0,0,-1,,plain\n");
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.carried.names, (std::vector<std::string>{"a, b", "c"}));
  EXPECT_EQ(table.carried.at(0, 0), "say \"hi\", you");
  EXPECT_EQ(table.carried.at(0, 1), "two\r\nlines");
  EXPECT_EQ(table.carried.at(1, 0), "");
  EXPECT_EQ(table.carried.at(1, 1), "plain");
  EXPECT_EQ(table.rows[1].line, 4) << "the first ray takes two lines";
}

TEST(RayCsv, HeightsAreOptional) {
  const RayTable targets = parse_ray_csv("x,y,tx,ty\n1,2,3,4\n", RayRows::cameras);
  EXPECT_FALSE(targets.has_z || targets.has_target_z);
  EXPECT_EQ(targets.rows.at(0).origin, dvec3(1, 2, 0));
  EXPECT_EQ(targets.rows.at(0).aim, dvec3(3, 4, 0));
  const RayTable with_z = parse_ray_csv("x,y,z,dx,dy,dz\n1,2,3,0,0,-1\n", RayRows::cameras);
  EXPECT_TRUE(with_z.has_z);
  const auto refusal = [](const char* text, RayRows heights) {
    return test::refusal([&] { static_cast<void>(parse_ray_csv(text, heights)); });
  };
  EXPECT_NE(refusal("x,y,tx,ty\n1,2,3,4\n", RayRows::rays).find("no column 'z'"), std::string::npos);
  EXPECT_NE(refusal("x,y,z,tx,ty\n1,2,3,4,5\n", RayRows::rays).find("no column 'tz'"), std::string::npos);
  EXPECT_NE(refusal("x,tx,ty\n1,3,4\n", RayRows::cameras).find("no column 'y' (required: x,y[,z]"), std::string::npos);
}

TEST(RayCsv, BadRaysAreLeftOutOnRequest) {
  RayTable table =
      parse_ray_csv("id,x,y,z,dx,dy,dz\na,1,2,3,0,0,x\nb,1,2,3,0,0,-1\nc,1\nd,4,5,6,0,0,-1\ne,7,8,9,0,0,-1\n",
                    RayRows::rays, BadRays::left_out);
  ASSERT_EQ(table.rows.size(), 3u);
  ASSERT_EQ(table.bad.size(), 2u);
  EXPECT_EQ(table.bad[0].ray, 0);
  EXPECT_EQ(table.bad[0].why, "line 2 (ray 0): 'x' in column 'dz' is not a number");
  EXPECT_EQ(table.bad[1].ray, 2);
  EXPECT_EQ(table.indices, (std::vector<std::int64_t>{1, 3, 4}));
  EXPECT_EQ(table.rows[1].origin, dvec3(4, 5, 6));
  // Other columns have a row for each ray.
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(table.carried.at(i, 0), std::string(1, "abcde"[i]));
  EXPECT_EQ(table.where(1), ": line 5 (ray 3)");

  table.leave_out(std::array{BadRay{1, "no"}, BadRay{4, "neither"}});
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.index(0), 3);
  EXPECT_EQ(table.rows[0].origin, dvec3(4, 5, 6));
  std::vector<std::int64_t> bad;
  for (const BadRay& ray : table.bad) bad.push_back(ray.ray);
  EXPECT_EQ(bad, (std::vector<std::int64_t>{0, 1, 2, 4}));
}

TEST(RayCsv, HeaderAloneGivesNoRays) { EXPECT_TRUE(parse_ray_csv(kHeader).rows.empty()); }

TEST(RayCsv, ErrorsNameLineAndRay) {
  std::string six_rays = kHeader;
  for (int i = 0; i < 6; ++i) six_rays += "1,2,3,0,0,-1\n";
  expect_csv_refused(six_rays + "1,2,3,0,-1\n", "line 8 (ray 6): 5 fields instead of 6");
  expect_csv_refused(six_rays + "1,2,3,0,0,-1,9\n", "line 8 (ray 6): 7 fields instead of 6");
  RayTable table = parse_ray_csv(six_rays);
  table.path = "a.csv";
  EXPECT_EQ(table.where(5), "a.csv: line 7 (ray 5)");
}

TEST(RayCsv, RejectsBadRows) {
  const auto row = [](const std::string& fields) { return kHeader + fields + "\n"; };
  expect_csv_refused(row("1,2,three,0,0,-1"), "line 2 (ray 0): 'three' in column 'z' is not a number");
  expect_csv_refused(row("1,2,3m,0,0,-1"), "'3m' in column 'z'");
  expect_csv_refused(row("1,2,0x10,0,0,-1"), "'0x10' in column 'z'");
  expect_csv_refused(row("1,2,1e999,0,0,-1"), "'1e999' in column 'z'");
  expect_csv_refused(row("1,2,+-3,0,0,-1"), "'+-3' in column 'z'");
  expect_csv_refused(row("1,,3,0,0,-1"), "column 'y' is empty");
  expect_csv_refused(row("nan,2,3,0,0,-1"), "origin is not finite");
  expect_csv_refused(row("1,2,-inf,0,0,-1"), "origin is not finite");
  expect_csv_refused(row("1,2,3,0,nan,-1"), "direction is not finite");
  expect_csv_refused(row("1,2,3,0,0,0"), "direction is zero");
  expect_csv_refused(row("1,2,3,0,-0,0"), "direction is zero");
  expect_csv_refused("x,y,z,tx,ty,tz\n1,2,3,1,2,3\n", "target equals the origin");
  expect_csv_refused("x,y,z,tx,ty,tz\n1,2,3,1,2,inf\n", "target is not finite");
  expect_csv_refused("x,y,z,dx,dy,dz,t_min,t_max\n1,2,3,0,0,1,5,4\n", "range is 5 to 4");
  expect_csv_refused("x,y,z,dx,dy,dz,t_min\n1,2,3,0,0,1,inf\n", "t_min must be finite");
  expect_csv_refused("x,y,z,dx,dy,dz,t_max\n1,2,3,0,0,1,nan\n", "range is 0 to nan");
  expect_csv_refused("x,y,z,dx,dy,dz,start_col,start_row\n1,2,3,0,0,1,1.5,2\n", "'1.5' in column 'start_col'");
  expect_csv_refused("x,y,z,dx,dy,dz,start_col,start_row\n1,2,3,0,0,1,1,\n", "in column 'start_row'");
  expect_csv_refused(row("1,2," + std::string(500, 'q') + ",0,0,-1"), "q...'");
  expect_csv_refused(row("1,2,\"3\n4\",0,0,-1"), "'3?4' in column 'z'");
}

TEST(RayCsv, RejectsBadHeaders) {
  expect_csv_refused("", "empty file");
  expect_csv_refused("\xEF\xBB\xBF", "empty file");
  expect_csv_refused("\n \r\n", "empty file");
  expect_csv_refused("1,2,3,0,0,-1\n", "numbers instead of a header");
  expect_csv_refused("x,y,dx,dy,dz\n", "no column 'z'");
  expect_csv_refused("x,y,z\n", "no column 'dx'");
  expect_csv_refused("x,y,z,tx,tz\n", "no column 'ty'");
  expect_csv_refused("lon,y,z,dx,dy,dz\n", "no column 'lat'");
  expect_csv_refused("x,y,z,x,dx,dy,dz\n", "duplicate column 'x'");
  expect_csv_refused("x,y,z,dx,dy,dz,tx,ty,tz\n", "directions and targets");
  expect_csv_refused("x,y,z,dx,dy,dz,start_row\n", "no column 'start_col', required with 'start_row'");
  expect_csv_refused(std::string("\xFF\xFEx\0,\0", 6), "UTF-16");
}

TEST(RayCsv, RejectsBadQuotes) {
  expect_csv_refused(kHeader + "1,2,3,0,0,\"-1\n", "line 2: unclosed quote");
  expect_csv_refused(kHeader + "1,2,3,0,0,\"-1\"0\n", "line 2: text after a closing quote");
}

TEST(RayNpy, ReadsPlainArrays) {
  const std::vector<double> two_rays = {1, 2, 3, 0, 0, -1, 4, 5, 6, 1, 0.5, 0};
  const std::vector<double> by_columns = {1, 4, 2, 5, 3, 6, 0, 1, 0, 0.5, -1, 0};
  const auto expect_both = [](const RayTable& table) {
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.aim, RayAim::direction);
    EXPECT_EQ(table.rows[0].origin, dvec3(1, 2, 3));
    EXPECT_EQ(table.rows[0].aim, dvec3(0, 0, -1));
    EXPECT_EQ(table.rows[1].origin, dvec3(4, 5, 6));
    EXPECT_EQ(table.rows[1].aim, dvec3(1, 0.5, 0));
    EXPECT_EQ(table.rows[1].t_max, kInfinity);
  };
  expect_both(parse_ray_npy(npy_bytes(npy_dictionary("<f8", "(2, 6)"), sample_bytes<double>(two_rays))));
  expect_both(parse_ray_npy(npy_bytes(npy_dictionary(">f8", "(2, 6)"), sample_bytes<double>(two_rays, true))));
  expect_both(parse_ray_npy(npy_bytes(npy_dictionary("<f4", "(2, 6)"), sample_bytes<float>(two_rays), 2)));
  expect_both(parse_ray_npy(npy_bytes(npy_dictionary("<f8", "(2, 6)", true), sample_bytes<double>(by_columns))));
}

TEST(RayNpy, EightColumnsIncludeTheRange) {
  const std::string samples = sample_bytes<double>({1, 2, 3, 0, 0, -1, -5, 50});
  const RayTable table = parse_ray_npy(npy_bytes(npy_dictionary("<f8", "(1, 8)"), samples));
  EXPECT_EQ(table.rows.at(0).t_min, -5);
  EXPECT_EQ(table.rows[0].t_max, 50);
}

std::string structures(const std::string& descr, const std::string& bytes) {
  return npy_bytes("{'descr': " + descr + ", 'fortran_order': False, 'shape': (1,), }", bytes);
}

TEST(RayNpy, ReadsStructuredArrays) {
  const std::string descr =
      "[('name', '<U1'), ('tx', '<f8'), ('ty', '>f4'), ('tz', '<f8'), ('x', '<i2'), ('y', '|u1'), ('z', '<f8'), "
      "('start_col', '<i8'), ('start_row', '<i4')]";
  const std::string bytes = std::string("A\0\0\0", 4) + sample_bytes<double>({40}) + sample_bytes<float>({50}, true) +
                            sample_bytes<double>({60}) + sample_bytes<std::int16_t>({-4}) +
                            sample_bytes<std::uint8_t>({200}) + sample_bytes<double>({6}) +
                            sample_bytes<std::int64_t>({3}) + sample_bytes<std::int32_t>({2});
  const RayTable table = parse_ray_npy(structures(descr, bytes));
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.aim, RayAim::target);
  EXPECT_EQ(table.rows[0].origin, dvec3(-4, 200, 6));
  EXPECT_EQ(table.rows[0].aim, dvec3(40, 50, 60));
  EXPECT_EQ(table.rows[0].t_max, 1);
  EXPECT_EQ(table.rows[0].start_cell, (Cell{3, 2}));
}

TEST(RayNpy, RejectsBadArrays) {
  const std::string ray = sample_bytes<double>({1, 2, 3, 0, 0, -1});
  const auto plain = [](const std::string& shape, const std::string& bytes, const std::string& descr = "<f8") {
    return npy_bytes(npy_dictionary(descr, shape), bytes);
  };
  expect_npy_refused("", "not a .npy");
  expect_npy_refused(plain("(2, 6)", ray), "truncated");
  expect_npy_refused(plain("(4611686018427387904, 6)", ray), "truncated");
  expect_npy_refused(plain("(6,)", ray), "shape (6)");
  expect_npy_refused(plain("(2, 3)", ray), "shape (2, 3)");
  expect_npy_refused(plain("(1, 6)", ray, "<i8"), "'<i8'");
  expect_npy_refused(plain("(1, 6)", ray, "<f2"), "'<f2'");
  expect_npy_refused(plain("(1, 6)", sample_bytes<double>({1, std::nan(""), 3, 0, 0, -1})), "ray 0: origin");
  expect_npy_refused(plain("(1, 6)", sample_bytes<double>({1, 2, 3, 0, 0, 0})), "ray 0: direction is zero");
  const std::string xyz = "[('x', '<f8'), ('y', '<f8'), ('z', '<f8'), ";
  expect_npy_refused(structures(xyz + "]", ray), "no column 'dx'");
  expect_npy_refused(structures(xyz + "('dx', '<f8'), ('dy', '<f8'), ('dz', '<c16')]", ray + ray), "'dz'");
  expect_npy_refused(structures(xyz + "('d', '<f8', (3,))]", ray), "an array or a structure");
  expect_npy_refused(structures(xyz + "('d', [('x', '<f8')])]", ray), "an array or a structure");
  expect_npy_refused(structures("[]", ray), "without fields");
  const std::string all = xyz + "('dx', '<f8'), ('dy', '<f8'), ('dz', '<f8')";
  expect_npy_refused(structures(all + "]", ray.substr(1)), "truncated");
  expect_npy_refused(structures(all + ", ('start_col', '<f8'), ('start_row', '<f8')]",
                                ray + ray.substr(32, 8) + sample_bytes<double>({0.5})),
                     "0.5 in field 'start_row'");
}

TEST(ReadRays, ErrorsNameTheFile) {
  expect_refused([](const std::string& path) { return read_rays(path); }, "/no/such/rays.csv",
                 "/no/such/rays.csv: cannot be opened");
  expect_refused([](const std::string& path) { return read_rays(path); }, "/", "/: is a directory");
}

TEST(ReadRays, RecognisesGitLfsPointers) {
  for (const char* ending : {".csv", ".npy"}) {
    const std::string path = fmt::format("{}scarp-rays-{}{}", testing::TempDir(), ::getpid(), ending);
    std::ofstream(path) << "version https://git-lfs.github.com/spec/v1\n";
    expect_refused([](const std::string& of) { return read_rays(of); }, path, ": Git LFS pointer instead of the file");
    std::filesystem::remove(path);
  }
}

}  // namespace
}  // namespace scarp
