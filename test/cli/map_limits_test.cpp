// SPDX-License-Identifier: MIT
// Maps beyond memory, in parts, and after a kill: the same files, byte by byte, as of one run in memory.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/cli/memory/file_memory.h"
#include "app/cli/memory/memory_limit.h"
#include "app/cli/options/part_number.h"
#include "cli/map_limits.h"
#include "scarp/base/array_files.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

TEST_F(MapLimits, IsTheSameInPartsAndStrips) {
  constexpr GDALDataType kTypes[] = {GDT_Int16, GDT_UInt16, GDT_Float32};
  int number = 0;
  for (const Names& kind : kinds_of_maps()) {
    // Two strips of --resume and more.
    const int rows = whole(520, 700);
    const std::string dem = model(fmt::format("dem{}.tif", number), 40, rows, kTypes[number % 3]);
    ++number;
    const Names words = on_model(kind, dem);
    SCOPED_TRACE(fmt::format("{}", fmt::join(words, " ")));
    const std::string all = written(words, "all.tif");
    EXPECT_TRUE(written(words + Names{"--resume"}, "strips.tif") == all);
    EXPECT_FALSE(fs::exists(path("strips.tif.resume")));
    EXPECT_TRUE(written(words + Names{"--threads", "1"}, "one.tif") == all);
    EXPECT_TRUE(written(words + Names{"--threads", "2"}, "two.tif") == all);
    const int parts = whole(2, 5);
    std::vector<std::string> names;
    for (int part = 1; part <= parts; ++part) {
      names.push_back(path(fmt::format("part{}.tif", part)));
      const Result result = run(words + Names{"--part", fmt::format("{}/{}", part, parts), "-o", names.back()});
      ASSERT_EQ(result.status, 0) << result.err;
    }
    std::shuffle(names.begin(), names.end(), random_);
    written(Names{"merge"} + names, "merged.tif");
    EXPECT_TRUE(content_of(path("merged.tif")) == content_of(path("all.tif")));
  }
}

// Heights, horizons and results take more than the 40 MB that this limit keeps in memory.
TEST_F(MapLimits, SkyMapsAreTheSameInFiles) {
  const std::string dem = model("dem.tif", 1500, 1600, GDT_Int16);
  for (Names words : sky_maps()) {
    words.insert(words.begin() + 1, dem);
    SCOPED_TRACE(fmt::format("{}", fmt::join(words, " ")));
    const std::string all = written(words, "all.tif");
    EXPECT_TRUE(written(words + Names{"--memory", "256M", "--threads", "1"}, "files.tif") == all);
  }
}

// Lines of sight across wide rows read a page of memory for each few samples.
TEST_F(MapLimits, HorizonsKeepTheLimit) {
  std::string hills = "ncols 300\nnrows 300\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
  for (int i = 0; i < 300 * 300; ++i) hills += std::to_string(300 + i * 7919 % 101) + ' ';
  scratch_.write("hills.asc", hills);
  const auto wide = [&](const char* name, int cols, int rows, int cell) {
    return scratch_.write(name, fmt::format(R"(<VRTDataset rasterXSize="{0}" rasterYSize="{1}">
<SRS>EPSG:32633</SRS><GeoTransform>400000, {2}, 0, 5000000, 0, -{2}</GeoTransform>
<VRTRasterBand dataType="Int16" band="1">
<SimpleSource><SourceFilename relativeToVRT="1">hills.asc</SourceFilename>
<SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="300" ySize="300"/>
<DstRect xOff="0" yOff="0" xSize="{0}" ySize="{1}"/></SimpleSource></VRTRasterBand></VRTDataset>)",
                                            cols, rows, cell));
  };
  const std::string dem = wide("wide.vrt", 16000, 1500, 10);
  for (const char* engine : {"exact", "sweep"}) {
    const Result result = run({"horizon", dem, "--azimuths", "1", "--engine", engine, "--memory", "256M", "--scratch",
                               path("."), "--plane-error", "100", "-o", path("horizon.tif")});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_GT(result.peak, 0u) << "unknown";
    EXPECT_LE(result.peak, std::uint64_t{256} << 20) << engine;
  }
  // A strip of the exact engine is as long as a row, and its blocks are 64 x 32 nodes.
  const std::string line = wide("line.vrt", 60000, 400, 1);
  expect_refused(
      {"skyview", line, "--azimuths", "4", "--memory", "256M", "--plane-error", "100", "-o", path("sky.tif")},
      "allow more memory");
}

TEST_F(MapLimits, ReadsOnlyRowsTowardsTheSunOfAPart) {
  // A truncated file: its southern tiles are gone, which a part in the north does not read.
  const std::string dem = model("dem.tif", 40, 3000, GDT_Int16);
  fs::resize_file(dem, fs::file_size(dem) * 3 / 4);
  const Names sun{"shadow", dem, "--sun", "0,85", "--part"};
  EXPECT_EQ(run(sun + Names{"1/4", "-o", path("north.tif")}).status, 0);
  EXPECT_NE(run(sun + Names{"4/4", "-o", path("south.tif")}).status, 0);
  const Names seen{"viewshed", dem, "--observer", "500200,4999000,9", "--part"};
  EXPECT_EQ(run(seen + Names{"1/4", "-o", path("north.tif")}).status, 0);
  EXPECT_NE(run(seen + Names{"4/4", "-o", path("south.tif")}).status, 0);
}

// Heights and results take more than 50 MB, of which --memory 256M keeps 40 MB.
TEST_F(MapLimits, PutsArraysBeyondTheLimitIntoFiles) {
  const std::string dem = model("dem.tif", 2000, 1900, GDT_Int16);
  const Names little{"--memory", "256M", "--scratch", path(".")};
  const Names words{"horizon", dem, "--azimuths", "1", "--max-distance", "50"};
  EXPECT_TRUE(written(words, "all.tif") == written(words + little, "files.tif"));
  // Files that may not be larger are the proof that there are some.
  const auto files = scratch_.files();
  const Result result = [&] {
    const ResourceLimit files_of(RLIMIT_FSIZE, 1 << 20);
    return Program(words + little + Names{"-o", path("none.tif")}).result();
  }();
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("arrays of"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("do not fit into files in '" + path(".") + "'"), std::string::npos) << result.err;
  EXPECT_EQ(scratch_.files(), files);
}

// 150 bands of 1.4 MB, each below the size of arrays that are always counted first.
TEST_F(MapLimits, CountsManyBandsThatAreSmall) {
  constexpr int kSide = 600, kObservers = 150;
  const std::string dem = model("dem.tif", kSide, kSide, GDT_Int16);
  std::string table = "x,y,z\n";  // above holes, too
  for (int i = 0; i < kObservers; ++i)
    table +=
        fmt::format("{},{},900\n", 500005 + 10 * (i * 599 / (kObservers - 1)), 4999993.75 - 12.5 * (i * 397 % kSide));
  const Names words{"viewshed",       dem,     "--observers",    scratch_.write("seen.csv", table),
                    "--per-observer", "bands", "--mode",         "ground",
                    "--heights",      "sea",   "--max-distance", "60"};
  const Result result = run(words + Names{"--memory", "256M", "-o", path("files.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_LT(result.peak, 256u << 20);
  const GDALDatasetUniquePtr file(GDALDataset::Open(path("files.tif").c_str(), GDAL_OF_RASTER));
  EXPECT_EQ(file->GetRasterCount(), kObservers);
  // Tiles of all bands would be larger than GDAL's cache.
  EXPECT_STREQ(file->GetMetadataItem("INTERLEAVE", "IMAGE_STRUCTURE"), "BAND");
}

TEST_F(MapLimits, ReadsDrawnFilesBeforeTheMap) {
#ifdef SCARP_CAIRO
  const std::string dem = model("dem.tif", 30, 40, GDT_Int16);
  expect_refused({"shadow", dem, "--sun", "135,20", "--preview", path("map.png"), "--draw", path("none.csv"), "-o",
                  path("map.tif")},
                 "none.csv");
#endif
}

TEST_F(MapLimits, ChecksAllFilesOfObserversFirst) {
  const std::string dem = model("seen_2.tif", 30, 40, GDT_Int16);
  const Names words{"viewshed",         dem,          "--per-observer",   "files", "--observer",
                    "500200,4999800,9", "--observer", "500100,4999700,9", "-o",    path("seen.tif")};
  expect_refused(words, "seen_2.tif': is the input");
  expect_refused(words + Names{"--dry-run"}, "seen_2.tif': is the input");
  fs::rename(dem, path("dem.tif"));
  fs::create_directory(dem);
  Names moved = words;
  moved[1] = path("dem.tif");
  expect_refused(moved, "seen_2.tif");
}

// The rows of the table are those of --mode visible.
TEST_F(MapLimits, SummariesOfAllModesAreEqual) {
  const std::string dem = model("dem.tif", 60, 70, GDT_Int16), ground = path("ground.tif");
  fs::copy_file(dem, ground);
  const Names words{"viewshed",
                    dem,
                    "--observer",
                    "500200,4999800,9",
                    "--observer",
                    "500400,4999500,30",
                    "--target-height",
                    "3",
                    "--azimuth",
                    "30,290",
                    "--pitch=-9,5",
                    "--max-distance",
                    "400",
                    "--summary",
                    path("seen.csv")};
  for (const Names& more : {Names{}, Names{"--ground", ground}}) {
    written(words + more, "seen.tif");
    const std::string table = text_of(path("seen.csv"));
    EXPECT_EQ(table.find(",0,0,0\n"), std::string::npos) << table;
    for (const Names& mode : {Names{"dem"}, Names{"ground"}, Names{"height"}, Names{"angle"}, Names{"count"},
                              Names{"fresnel", "--frequency", "900"}}) {
      fs::remove(path("seen.csv"));
      written(words + more + Names{"--mode"} + mode, "mode.tif");
      EXPECT_EQ(text_of(path("seen.csv")), table) << mode[0];
    }
  }
}

TEST_F(MapLimits, CountsMemoryOfTheGround) {
  const std::string dem = model("dem.tif", 1000, 1100, GDT_Float32), ground = path("ground.tif");
  fs::copy_file(dem, ground);
  const Names words{"viewshed", dem, "--observer", "500200,4999800,9", "--dry-run", "-o", path("map.tif")};
  const auto mebibytes = [&](const Names& more) {
    const std::string text = run(words + more).out;
    return std::stoi(text.substr(text.find("about ") + 6));
  };
  // 4 bytes per sample.
  EXPECT_NEAR(mebibytes({"--ground", ground}) - mebibytes({}), 4.4e6 / (1 << 20), 1);
}

TEST_F(MapLimits, RefusesLimitsThatAreNone) {
  const std::string dem = model("dem.tif", 30, 40, GDT_Int16);
  const Names words{"shadow", dem, "--sun", "135,20", "-o", path("out.tif")};
  for (const char* wrong : {"5", "M", "-1G", "nan", "12Q", "1e400G"})
    expect_refused(words + Names{std::string("--memory=") + wrong}, "expected a size, for example 512M or 8G");
  expect_refused(words + Names{"--memory", "100 MiB"}, "is too little");
  expect_refused(words + Names{"--scratch", dem}, "is not a folder");
  for (const char* enough : {"0.25G", "256MiB", "1t", "300000 KB"})
    EXPECT_EQ(run(words + Names{"--memory", enough}).status, 0) << enough;
}

// Variables of a scheduler, for the lifetime of the object.
class Variables {
 public:
  explicit Variables(std::vector<std::pair<std::string, std::string>> set) : set_(std::move(set)) {
    for (const auto& [name, value] : set_) ::setenv(name.c_str(), value.c_str(), 1);
  }
  ~Variables() {
    for (const auto& [name, value] : set_) ::unsetenv(name.c_str());
  }
  Variables(const Variables&) = delete;
  Variables& operator=(const Variables&) = delete;

 private:
  std::vector<std::pair<std::string, std::string>> set_;
};

std::string part_of_slurm(const char* id, const char* least, const char* most, const char* step, const char* count,
                          const char* typed = "auto") {
  const Variables set({{"SLURM_ARRAY_TASK_ID", id},
                       {"SLURM_ARRAY_TASK_MIN", least},
                       {"SLURM_ARRAY_TASK_MAX", most},
                       {"SLURM_ARRAY_TASK_STEP", step},
                       {"SLURM_ARRAY_TASK_COUNT", count}});
  return cli::part_of_job_array(typed);
}

std::string part_of_grid_engine(const char* first, const char* last, const char* step, const char* id) {
  const Variables set(
      {{"SGE_TASK_ID", id}, {"SGE_TASK_FIRST", first}, {"SGE_TASK_LAST", last}, {"SGE_TASK_STEPSIZE", step}});
  return cli::part_of_job_array();
}

TEST_F(MapLimits, AutomaticPartsAreThoseOfJobArrays) {
  using cli::part_of_job_array;
  EXPECT_THROW(part_of_job_array(), Error);
  EXPECT_EQ(part_of_slurm("1", "1", "16", "1", "16"), "1/16");
  EXPECT_EQ(part_of_slurm("15", "0", "15", "1", "16"), "16/16");
  EXPECT_EQ(part_of_slurm("7", "1", "9", "2", "5"), "4/5");
  EXPECT_THROW(part_of_slurm("8", "1", "9", "2", "5"), Error);
  EXPECT_THROW(part_of_slurm("x", "1", "9", "2", "5"), Error);
  const auto batch = [](const char* index) {
    const Variables set({{"AWS_BATCH_JOB_ARRAY_INDEX", index}, {"AWS_BATCH_JOB_ARRAY_SIZE", "8"}});
    return part_of_job_array();
  };
  EXPECT_EQ(batch("0"), "1/8");
  EXPECT_EQ(batch("7"), "8/8");
  EXPECT_THROW(batch("8"), Error);
  EXPECT_EQ(part_of_grid_engine("1", "9", "2", "5"), "3/5");
}

// A failed task that is submitted alone, some tasks and those with gaps are arrays of their own.
TEST_F(MapLimits, TasksThatRunAgainNeedTheNumberOfParts) {
  EXPECT_THROW(part_of_slurm("7", "7", "7", "1", "1"), Error);
  EXPECT_EQ(part_of_slurm("1", "1", "1", "1", "1"), "1/1");
  EXPECT_THROW(part_of_slurm("7", "7", "9", "1", "3"), Error);
  EXPECT_THROW(part_of_slurm("1", "1", "9", "1", "2"), Error) << "--array=1,9";
  EXPECT_THROW(part_of_grid_engine("3", "9", "2", "5"), Error);
  EXPECT_EQ(part_of_slurm("7", "7", "7", "1", "1", "auto/16"), "7/16");
  EXPECT_EQ(part_of_slurm("16", "9", "16", "7", "2", "auto/16"), "16/16");
  EXPECT_THROW(part_of_slurm("0", "0", "15", "1", "16", "auto/16"), Error);
  EXPECT_THROW(part_of_slurm("17", "17", "17", "1", "1", "auto/16"), Error);
  for (const char* wrong : {"auto/", "auto/0", "auto/x", "auto/1e3", "auto/-2"})
    EXPECT_THROW(part_of_slurm("1", "1", "1", "1", "1", wrong), Error) << wrong;
  const Variables batch({{"AWS_BATCH_JOB_ARRAY_INDEX", "0"}, {"AWS_BATCH_JOB_ARRAY_SIZE", "2"}});
  EXPECT_EQ(cli::part_of_job_array("auto/8"), "1/8");
  // The words of the program.
  const std::string dem = model("dem.tif", 30, 40, GDT_Int16);
  const Names words{"shadow", dem, "--sun", "135,20"};
  const std::string first = written(words + Names{"--part", "1/8"}, "a.tif");
  EXPECT_TRUE(Program(words + Names{"--part", "auto/8", "-o", path("b.tif")}).result().status == 0);
  EXPECT_TRUE(text_of(path("b.tif")) == first);
}

TEST(MemoryLimit, CountsArraysThatAreNotYetUsed) {
  const Scratch folder;
  const cli::MemoryLimit limit(cli::MemoryLimit::kLeast, folder.path("."));
  constexpr std::size_t kBytes = 30 << 20;  // of 40 MiB
  std::vector<void*> arrays(4);
  std::vector<std::thread> threads;
  for (void*& array : arrays) threads.emplace_back([&] { array = ::operator new(kBytes); });
  for (std::thread& one : threads) one.join();
  EXPECT_GE(cli::bytes_in_files(), 3 * kBytes);
  for (void* const array : arrays) ::operator delete(array);
  EXPECT_EQ(cli::bytes_in_files(), 0u);
  // Released arrays no longer count, in either form of delete.
  for (int i = 0; i < 9; ++i) ::operator delete(::operator new(kBytes), kBytes);
  void* const again = ::operator new(kBytes);
  EXPECT_EQ(cli::bytes_in_files(), 0u);
  ::operator delete(again);
}

// Schedulers and services limit groups without a file system of their own.
TEST(MemoryLimit, IsThatOfTheControlGroupsAbove) {
  const Scratch root;
  const auto put = [&](const std::string& name, const std::string& text) {
    fs::create_directories(fs::path(root.path(name)).parent_path());
    root.write(name, text);
  };
  const auto limit = [&](const std::string& groups) { return cli::memory_of_groups(groups, root.path("")); };
  EXPECT_TRUE(std::isinf(limit("0::/slurm/job_7/step_0\n")));
  put("slurm/job_7/step_0/memory.max", "max\n");
  EXPECT_TRUE(std::isinf(limit("0::/slurm/job_7/step_0\n")));
  put("slurm/job_7/memory.max", "4000000\n");
  put("slurm/memory.max", "9000000\n");
  EXPECT_EQ(limit("0::/slurm/job_7/step_0\n"), 4e6);
  EXPECT_EQ(limit("0::/slurm/job_8\n"), 9e6);
  EXPECT_TRUE(std::isinf(limit("0::/\n")));
  put("memory/slurm/uid_1/memory.limit_in_bytes", "5000000\n");
  EXPECT_EQ(limit("5:cpu:/slurm\n4:hugetlb,memory:/slurm/uid_1/job_2\n"), 5e6);
  EXPECT_TRUE(std::isinf(limit("5:cpu:/slurm\nnonsense\n:\n")));
}

TEST(MemoryLimit, KeepsTheContentsOfArraysInFiles) {
  const Scratch folder;
  const cli::MemoryLimit limit(cli::MemoryLimit::kLeast, folder.path("."));
  constexpr std::size_t kNumbers = 11 << 20;  // 44 MiB
  std::vector<std::vector<std::uint32_t>> arrays;
  for (std::uint32_t i = 0; i < 3; ++i) {
    arrays.emplace_back(kNumbers);
    std::iota(arrays.back().begin(), arrays.back().end(), i);
  }
  EXPECT_GE(cli::bytes_in_files(), 2 * kNumbers * sizeof(std::uint32_t));
  EXPECT_TRUE(fs::is_empty(folder.path("."))) << "files have names";
  cli::forget_pages_in_files();
  // Pieces of files are those of the memory.
  std::vector<std::uint32_t> piece(1000, 7);
  write_array(&arrays[2][5001], piece.data(), 1000 * sizeof(std::uint32_t));
  EXPECT_EQ(arrays[2][5001], 7u);
  EXPECT_EQ(arrays[2][6000], 7u);
  std::iota(&arrays[2][5001], &arrays[2][6001], 5003u);
  read_array(piece.data(), &arrays[2][5001], 1000 * sizeof(std::uint32_t));
  for (std::uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(piece[i], 5003 + i);
  for (std::uint32_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < kNumbers; k += 997) ASSERT_EQ(arrays[i][k], k + i);
  // Any alignment, and memory that is not in a file.
  void* const aligned = ::operator new(kNumbers, std::align_val_t(2 << 20));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(aligned) % (2 << 20), 0u);
  std::memset(aligned, 1, kNumbers);
  ::operator delete(aligned, std::align_val_t(2 << 20));
  arrays.clear();
  EXPECT_EQ(cli::bytes_in_files(), 0u);
}

}  // namespace
}  // namespace scarp::test
