// SPDX-License-Identifier: MIT
// Maps beyond memory, in parts, and after a kill: the same files, byte by byte, as of one run in memory.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "app/cli/memory/file_memory.h"
#include "app/cli/memory/memory_limit.h"
#include "app/cli/options/part_number.h"
#include "app/cli/picture/map_journal.h"
#include "cli/program.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

namespace fs = std::filesystem;
using cli::JournalStrip, cli::MapJournal;

class MapLimits : public testing::Test {
 protected:
  MapLimits() { GDALAllRegister(); }

  /// Hills with holes in zone 33, cells of 10 x 12.5 m.
  std::string model(const std::string& name, int cols, int rows, GDALDataType type) {
    std::uniform_int_distribution<int> rough(0, 30), hole(0, 60);
    std::vector<float> samples;
    for (int row = 0; row < rows; ++row)
      for (int col = 0; col < cols; ++col)
        samples.push_back(hole(random_) == 0
                              ? 0
                              : static_cast<float>(400 + rough(random_) +
                                                   std::lround(150 * std::sin(col / 13.0) * std::cos(row / 29.0))));
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const std::string path = scratch_.path(name);
    GDALDatasetUniquePtr file(driver->Create(path.c_str(), cols, rows, 1, type, nullptr));
    OGRSpatialReference crs;
    crs.importFromEPSG(32633);
    file->SetSpatialRef(&crs);
    std::vector<double> map{500000, 10, 0, 5000000, 0, -12.5};
    file->SetGeoTransform(map.data());
    GDALRasterBand& band = *file->GetRasterBand(1);
    band.SetNoDataValue(0);
    EXPECT_EQ(band.RasterIO(GF_Write, 0, 0, cols, rows, samples.data(), cols, rows, GDT_Float32, 0, 0, nullptr),
              CE_None);
    return path;
  }

  std::string path(const std::string& name) const { return scratch_.path(name); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  /// Runs a command that must succeed, and returns its file.
  std::string written(const Names& words, const std::string& name) const {
    const Result result = run(words + Names{"-o", path(name)});
    EXPECT_EQ(result.status, 0) << result.err;
    return text_of(path(name));
  }
  void expect_refused(const Names& words, const std::string& what) const {
    const auto before = scratch_.files();
    const Result result = run(words);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), before);
  }

  Scratch scratch_;
  std::mt19937 random_{31};
};

// All that a raster says; GDAL may compress tiles of nodata in two ways.
struct Content {
  std::vector<std::string> texts;
  std::vector<double> numbers;
  bool operator==(const Content&) const = default;
};
Content content_of(const std::string& path) {
  const GDALDatasetUniquePtr file(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
  Content content;
  const auto add_metadata = [&](GDALMajorObject& object) {
    for (char** pair = object.GetMetadata(); pair && *pair; ++pair) content.texts.emplace_back(*pair);
  };
  const int cols = file->GetRasterXSize(), rows = file->GetRasterYSize();
  add_metadata(*file);
  content.texts.emplace_back(file->GetProjectionRef());
  content.numbers.resize(6);
  file->GetGeoTransform(content.numbers.data());
  for (int b = 1; b <= file->GetRasterCount(); ++b) {
    GDALRasterBand& band = *file->GetRasterBand(b);
    add_metadata(band);
    content.texts.insert(content.texts.end(),
                         {band.GetDescription(), band.GetUnitType(), GDALGetDataTypeName(band.GetRasterDataType())});
    std::vector<double> samples(static_cast<std::size_t>(cols) * rows);
    EXPECT_EQ(band.RasterIO(GF_Read, 0, 0, cols, rows, samples.data(), cols, rows, GDT_Float64, 0, 0, nullptr),
              CE_None);
    samples.insert(samples.end(), {band.GetNoDataValue(), band.GetScale(), band.GetOffset()});
    if (const GDALColorTable* const colours = band.GetColorTable())
      for (int i = 0; i < colours->GetColorEntryCount(); ++i) samples.push_back(colours->GetColorEntry(i)->c1);
    content.numbers.insert(content.numbers.end(), samples.begin(), samples.end());
  }
  return content;
}

// Horizons, sky views and hours of sun, by both engines.
std::vector<Names> sky_maps() {
  std::vector<Names> kinds;
  for (const char* engine : {"exact", "sweep"}) {
    kinds.push_back({"horizon", "--azimuths", "3", "--distance", "--farthest", "--engine", engine});
    kinds.push_back({"skyview", "--azimuths", "6", "--measure", "sky-view-factor", "--engine", engine});
#ifdef SCARP_ERFA
    kinds.push_back({"sunhours", "--date", "2026-06-21", "--step", "240", "--first-last", "--engine", engine});
#endif
  }
  return kinds;
}

// Every kind of map, of an observer or a sun near the model's middle.
std::vector<Names> kinds_of_maps() {
  const Names seen{"viewshed", "--observer", "500200,4996000,9"};
  std::vector<Names> kinds{seen,
                           seen + Names{"--mode", "count", "--observer", "500100,4993000,4"},
                           seen + Names{"--mode", "angle", "--max-distance", "2000"},
                           seen + Names{"--mode", "ground", "--max-distance", "900", "--crop"},
                           seen + Names{"--max-distance", "1500", "--out-of-range-value", "9"},
                           {"shadow", "--sun", "135,20", "--sun", "10,6"},
                           {"shadow", "--sun", "271,30", "--fraction", "--surface", "bilinear"},
                           {"horizon", "--azimuths", "3", "--max-distance", "700", "--pack"}};
  for (Names& sky : sky_maps()) kinds.push_back(std::move(sky));
#ifdef SCARP_ERFA
  kinds.push_back({"shadow", "--time", "2026-06-21T09:00+02:00"});
  kinds.push_back({"shadow", "--time", "2026-12-21T10:00+02:00", "--sun-per-cell"});
  kinds.push_back({"sunhours", "--date", "2026-06-21", "--step", "240", "--masks", "--sun-per-cell"});
#endif
  return kinds;
}

TEST_F(MapLimits, IsTheSameInPartsAndStrips) {
  constexpr GDALDataType kTypes[] = {GDT_Int16, GDT_UInt16, GDT_Float32};
  int number = 0;
  for (Names words : kinds_of_maps()) {
    // Two strips of --resume and more.
    const int rows = whole(520, 700);
    const std::string dem = model(fmt::format("dem{}.tif", number), 40, rows, kTypes[number % 3]);
    ++number;
    words.insert(words.begin() + 1, dem);
    SCOPED_TRACE(fmt::format("{}", fmt::join(words, " ")));
    const std::string all = written(words, "all.tif");
    EXPECT_TRUE(written(words + Names{"--resume"}, "strips.tif") == all);
    EXPECT_FALSE(fs::exists(path("strips.tif.resume")));
    EXPECT_TRUE(written(words + Names{"--memory", "256M"}, "files.tif") == all);
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

// Heights, their maxima and the result take 60 MB, of which --memory 256M keeps 40 MB.
TEST_F(MapLimits, PutsArraysBeyondTheLimitIntoFiles) {
  const std::string dem = model("dem.tif", 2000, 1900, GDT_Int16);
  const Names words{"horizon", dem, "--azimuths", "1", "--max-distance", "50"}, little{"--memory", "256M"};
  const std::string all = written(words, "all.tif");
  EXPECT_TRUE(written(words + little, "files.tif") == all);
  // Files that may not be larger are the proof that there are some.
  ::rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const ::rlimit limit{1 << 20, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  const auto files = scratch_.files();
  Program program(words + little + Names{"-o", path("none.tif"), "--scratch", path(".")});
  const Result result = program.result();
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("arrays of"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("do not fit into files in '" + path(".") + "'"), std::string::npos) << result.err;
  EXPECT_EQ(scratch_.files(), files);
}

TEST_F(MapLimits, GoesOnAfterAKill) {
  using namespace std::chrono_literals;
  const std::string dem = model("dem.tif", 300, 2600, GDT_Float32);
  const std::string output = path("killed.tif"), journal = output + ".resume";
  Names resumed;
  for (Names words : sky_maps()) {
    // One thread has more time to be killed in.
    words.insert(words.begin() + 1, {dem, "--threads", "1"});
    SCOPED_TRACE(fmt::format("{}", fmt::join(words, " ")));
    const std::string all = written(words, "all.tif");
    resumed = words + Names{"--resume", "-o", output};
    const auto map = GDALDatasetUniquePtr(GDALDataset::Open(path("all.tif").c_str(), GDAL_OF_RASTER));
    const auto a_strip = static_cast<std::uintmax_t>(map->GetRasterCount()) * 300 * 261 * sizeof(float);
    {
      Program program(resumed);
      // Ends with the first strip on the disk, or in the middle of writing another one.
      for (std::error_code none; !fs::exists(output) && !(fs::file_size(journal, none) > a_strip && !none);)
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_FALSE(fs::exists(output));
    expect_refused({"skyview", dem, "--azimuths", "25", "--resume", "-o", output}, "was begun by another command");
    const Result result = run(resumed);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("of 2600 rows were done"), std::string::npos) << result.err;
    EXPECT_TRUE(text_of(output) == all);
    EXPECT_FALSE(fs::exists(journal));
    fs::remove(output);
  }
  // Another input under the same name.
  { MapJournal(output, "of another run"); }
  expect_refused(resumed, "was begun by another command");
}

TEST_F(MapLimits, JournalEndsWithItsLastWholeStrip) {
  const std::string output = path("map.tif"), file = output + ".resume";
  const std::vector<double> totals{1.5, 2};
  const std::vector<std::byte> bytes(37, std::byte{7}), none;
  const auto append = [&](MapJournal& journal, int strip) {
    const std::vector<std::span<const std::byte>> bands{bytes, none};
    journal.append(10 * strip, 10 * strip + 10, totals, bands);
  };
  std::vector<std::uintmax_t> ends;
  {
    MapJournal journal(output, "me");
    EXPECT_THROW(MapJournal(output, "me"), Error) << "in use";
    JournalStrip strip;
    EXPECT_FALSE(journal.next(strip));
    for (int i = 0; i < 3; ++i) ends.push_back(fs::file_size(file)), append(journal, i);
    ends.push_back(fs::file_size(file));
  }
  const std::string complete = text_of(file);
  const auto strips_of = [&](const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    MapJournal journal(output, "me");
    JournalStrip strip;
    int count = 0;
    for (; journal.next(strip); ++count) {
      EXPECT_EQ(strip.first, 10 * count);
      EXPECT_EQ(strip.totals, totals);
      EXPECT_TRUE(strip.bands.at(0) == bytes && strip.bands.at(1).empty());
    }
    append(journal, count);
    return count;
  };
  for (std::size_t size = 0; size <= complete.size(); ++size) {
    const auto whole = static_cast<int>(std::count_if(ends.begin(), ends.end(), [&](auto end) { return end <= size; }));
    EXPECT_EQ(strips_of(complete.substr(0, size)), std::max(0, whole - 1)) << size;
  }
  // A changed byte is noticed, too.
  std::string changed = complete;
  changed[ends[1] + 30] ^= 1;  // of the totals
  EXPECT_EQ(strips_of(changed), 1);
  std::ofstream(file) << "text";
  EXPECT_THROW(MapJournal(output, "me"), Error);
}

TEST_F(MapLimits, MergeRefusesPartsThatDoNotFit) {
  const std::string dem = model("dem.tif", 30, 40, GDT_Int16);
  const auto part = [&](const std::string& which, const std::string& name, const std::string& sun = "135,20") {
    written({"shadow", dem, "--sun", sun, "--part", which}, name);
    return path(name);
  };
  const std::string a = part("1/3", "a.tif"), b = part("2/3", "b.tif"), c = part("3/3", "c.tif");
  const std::string other = part("2/3", "other.tif", "136,20"), of_four = part("2/4", "four.tif");
  written({"shadow", dem, "--sun", "135,20"}, "whole.tif");
  const Names out{"-o", path("out.tif")};
  expect_refused(Names{"merge", a, c} + out, "1 of 3 parts is missing: 2");
  expect_refused(Names{"merge", b} + out, "2 of 3 parts are missing: 1, 3");
  expect_refused(Names{"merge", a, b, c, b} + out, "part 2 is given twice");
  expect_refused(Names{"merge", a, other, c} + out, "other.tif: is not of the same map as");
  expect_refused(Names{"merge", a, of_four, c} + out, "is one of 4 parts");
  expect_refused(Names{"merge", a, path("whole.tif")} + out, "whole.tif: is not a part of a map");
  expect_refused(Names{"merge", a, path("nothing.tif")} + out, "nothing.tif: missing, or not a raster");
  expect_refused({"merge", a, b, c, "-o", b}, "is the input");
  const std::string text = text_of(c);
  std::ofstream(c, std::ios::binary) << text.substr(0, text.size() / 2);
  expect_refused(Names{"merge", a, b, c} + out, "c.tif: ");
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

TEST_F(MapLimits, AutomaticPartsAreThoseOfJobArrays) {
  using cli::part_of_job_array;
  EXPECT_THROW(part_of_job_array(), Error);
  const auto slurm = [](const char* id, const char* least, const char* most, const char* step, const char* count) {
    const Variables set({{"SLURM_ARRAY_TASK_ID", id},
                         {"SLURM_ARRAY_TASK_MIN", least},
                         {"SLURM_ARRAY_TASK_MAX", most},
                         {"SLURM_ARRAY_TASK_STEP", step},
                         {"SLURM_ARRAY_TASK_COUNT", count}});
    return part_of_job_array();
  };
  EXPECT_EQ(slurm("1", "1", "16", "1", "16"), "1/16");
  EXPECT_EQ(slurm("15", "0", "15", "1", "16"), "16/16");
  EXPECT_EQ(slurm("7", "1", "9", "2", "5"), "4/5");
  EXPECT_THROW(slurm("8", "1", "9", "2", "5"), Error);
  EXPECT_THROW(slurm("x", "1", "9", "2", "5"), Error);
  const auto batch = [](const char* index) {
    const Variables set({{"AWS_BATCH_JOB_ARRAY_INDEX", index}, {"AWS_BATCH_JOB_ARRAY_SIZE", "8"}});
    return part_of_job_array();
  };
  EXPECT_EQ(batch("0"), "1/8");
  EXPECT_EQ(batch("7"), "8/8");
  EXPECT_THROW(batch("8"), Error);
  const Variables grid(
      {{"SGE_TASK_ID", "5"}, {"SGE_TASK_FIRST", "3"}, {"SGE_TASK_LAST", "9"}, {"SGE_TASK_STEPSIZE", "2"}});
  EXPECT_EQ(part_of_job_array(), "2/4");
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
