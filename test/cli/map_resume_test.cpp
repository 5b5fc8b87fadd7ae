// SPDX-License-Identifier: MIT
// --resume: after a kill or a failed output, the same files, byte by byte, as of one run. Other commands and inputs are
// refused.
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/cli/picture/map_journal.h"
#include "cli/map_limits.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

using cli::BandPixels, cli::JournalStrip, cli::MapJournal;

class MapResume : public MapLimits {
 protected:
  MapResume() : output_(path("map.tif")), journal_(output_ + ".resume") {}

  /// Computes a map whose file cannot be written, because GDAL cannot store its samples so.
  void leave_journal(const Names& words, const Names& more = {}) const {
    const Result result = run(words + more + Names{"--co", "COMPRESS=JPEG", "--resume", "-o", output_});
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(output_));
    EXPECT_TRUE(fs::exists(journal_));
  }
  /// Goes on, and expects this note and the file of a run without --resume.
  void expect_rest(const Names& words, const std::string& note) const {
    const std::string all = written(words, "all.tif");
    const Result result = run(words + Names{"--resume", "-o", output_});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find(note), std::string::npos) << result.err;
    EXPECT_TRUE(text_of(output_) == all);
    EXPECT_FALSE(fs::exists(journal_));
    fs::remove(output_);
  }
  void expect_other(const Names& words, const std::string& in_path = "/dev/null") const {
    const Result result = run(words + Names{"--resume", "-o", output_}, in_path);
    EXPECT_NE(result.status, 0);
    EXPECT_NE(result.err.find("was begun by another command"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(output_));
  }

  std::string output_, journal_;
};

// The strips of a journal, and the text that identifies its run.
struct Journal {
  std::string identity;
  std::vector<JournalStrip> strips;
};
Journal journal_in(const std::string& output) {
  const std::string text = text_of(output + ".resume");
  const auto line = text.find('\n') + 1, rest = text.find('\n', line) + 1;
  Journal journal{text.substr(rest, std::stoul(text.substr(line))), {}};
  MapJournal reader(output, journal.identity);
  for (JournalStrip strip; reader.next(strip);) journal.strips.push_back(std::move(strip));
  return journal;
}

TEST_F(MapResume, GoesOnAfterAKill) {
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
}

TEST_F(MapResume, JournalEndsWithItsLastWholeStrip) {
  const std::string output = path("map.tif"), file = output + ".resume";
  const std::vector<double> totals{1.5, 2};
  const std::vector<std::byte> bytes(37, std::byte{7}), none;
  const auto append = [&](MapJournal& journal, int strip) {
    const std::vector<BandPixels> bands{{2, bytes}, {0, none}};
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
      EXPECT_TRUE(strip.bands.at(0).pixels == bytes && strip.bands.at(1).pixels.empty());
      EXPECT_EQ(strip.bands.at(0).type, 2u);
    }
    append(journal, count);
    return count;
  };
  for (std::size_t size = 0; size <= complete.size(); ++size) {
    const auto whole = static_cast<int>(std::count_if(ends.begin(), ends.end(), [&](auto end) { return end <= size; }));
    EXPECT_EQ(strips_of(complete.substr(0, size)), std::max(0, whole - 1)) << size;
  }
  // A changed byte is noticed, too, and no number makes the program allocate more than the file holds.
  for (auto at = ends[1]; at < ends[2]; ++at) {
    std::string changed = complete;
    changed[at] ^= static_cast<char>(0x80);
    EXPECT_EQ(strips_of(changed), 1) << at - ends[1];
  }
  std::ofstream(file) << "text";
  EXPECT_THROW(MapJournal(output, "me"), Error);
}

TEST_F(MapResume, HoldsMoreTotalsThanAMillion) {
  const std::vector<double> totals((1 << 20) + 3, 0.5);
  { MapJournal(output_, "me").append(0, 1, totals, {}); }
  MapJournal journal(output_, "me");
  JournalStrip strip;
  ASSERT_TRUE(journal.next(strip));
  EXPECT_TRUE(strip.totals == totals);
}

TEST_F(MapResume, ClosesFilesThatItRefuses) {
  std::ofstream(journal_) << "text";
  const int before = ::dup(0);
  ::close(before);
  for (int i = 0; i < 3; ++i) EXPECT_THROW(MapJournal(output_, "me"), Error);
  const int after = ::dup(0);
  ::close(after);
  EXPECT_EQ(after, before);
}

TEST_F(MapResume, OnlyLocksOfOthersAreInUse) {
  const MapJournal mine(output_, "me");
  try {
    MapJournal(output_, "me");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("is in use by another run"), std::string::npos) << error.what();
  }
}

// All strips are done; only writing failed, again and again.
TEST_F(MapResume, WritesWhatFailedToBeWritten) {
  std::vector<Names> kinds = kinds_of_maps();
  // GoesOnAfterAKill has those of the sky.
  std::erase_if(kinds, [](const Names& words) { return words[0] == "skyview" || words[0] == "sunhours"; });
  int number = 0;
  for (const Names& kind : kinds) {
    const Names words = on_model(kind, model(fmt::format("dem{}.tif", ++number), 40, 600, GDT_Int16));
    SCOPED_TRACE(fmt::format("{}", fmt::join(words, " ")));
    leave_journal(words);
    const std::string before = text_of(journal_);
    leave_journal(words);
    EXPECT_TRUE(text_of(journal_) == before);
    if (number == 1) leave_journal(words);
    expect_rest(words, "rows were done");
  }
}

// Options that change no pixel may differ: the machine is another, or the format did not suit.
TEST_F(MapResume, GoesOnWithOtherOptionsOfTheMachine) {
  const std::string dem = model("dem.tif", 40, 700, GDT_Int16);
  const Names words{"skyview", dem, "--azimuths", "4", "--max-distance", "900"};
  leave_journal(words, {"--threads", "1", "--memory", "256M", "--quiet", "--scratch", path(".")});
  // The second strip is not complete.
  fs::resize_file(journal_, fs::file_size(journal_) - 7);
  expect_rest(words, "350 of 700 rows were done");
}

TEST_F(MapResume, GoesOnAfterStripsOfAnyHeight) {
  const std::string dem = model("dem.tif", 40, 700, GDT_Int16);
  const Names words{"horizon", dem, "--azimuths", "2", "--max-distance", "900"};
  leave_journal(words);
  const Journal whole = journal_in(output_);
  ASSERT_EQ(whole.strips.size(), 2u);
  for (const std::vector<int>& heights : {std::vector{1}, {100, 3, 240}, {349}}) {
    fs::remove(journal_);
    int first = 0;
    {
      MapJournal journal(output_, whole.identity);
      JournalStrip none;
      EXPECT_FALSE(journal.next(none));
      for (const int height : heights) {
        std::vector<BandPixels> bands;
        for (const auto& band : whole.strips[0].bands) {
          const std::size_t row = band.pixels.size() / 350;
          bands.push_back({band.type, std::span(band.pixels).subspan(row * first, row * height)});
        }
        journal.append(first, first + height, whole.strips[0].totals, bands);
        first += height;
      }
    }
    expect_rest(words, fmt::format("{} of 700 rows were done", first));
  }
  // Rows that are not those of the map, and bands that are not.
  JournalStrip strip = whole.strips[0];
  const auto expect_wrong = [&](int rows, std::uint64_t type, std::size_t bytes, const std::string& what) {
    fs::remove(journal_);
    {
      MapJournal journal(output_, whole.identity);
      std::vector<BandPixels> bands;
      for (const auto& band : strip.bands) bands.push_back({type, std::span(band.pixels).first(bytes)});
      journal.append(rows, rows + 350, strip.totals, bands);
    }
    expect_refused(words + Names{"--resume", "-o", output_}, what);
  };
  const std::size_t bytes = strip.bands[0].pixels.size();
  expect_wrong(1, 2, bytes, "does not hold the rows");
  expect_wrong(351, 2, bytes, "does not hold the rows");
  expect_wrong(0, 1, bytes, "has other bands");
  expect_wrong(0, 2, bytes - 4, "has other bands");
}

TEST_F(MapResume, RefusesOtherCommandsWithTheSameWords) {
  const std::string dem = model("dem.tif", 40, 300, GDT_Int16);
  const Names words{dem, "--azimuths", "1"};
  leave_journal(Names{"skyview"} + words);
  expect_other(Names{"horizon"} + words);
  expect_rest(Names{"skyview"} + words, "300 of 300 rows were done");
}

// With --preview, more columns are read, and those without would not fit.
TEST_F(MapResume, RefusesRowsOfAnotherWidth) {
  const std::string dem = model("dem.tif", 80, 520, GDT_Int16);
  const Names words{"viewshed", dem, "--observer", "500200,4996000,9", "--max-distance", "200"};
#ifdef SCARP_CAIRO
  leave_journal(words, {"--preview", path("seen.png")});
  expect_other(words);
  fs::remove(journal_);
#endif
  leave_journal(words);
  expect_rest(words, "rows were done");
}

TEST_F(MapResume, PartsWithoutPixelsNeedNoRows) {
  const std::string dem = model("dem.tif", 40, 600, GDT_Int16);
  const Names words{"viewshed", dem, "--observer", "500200,4999000,9", "--max-distance", "500", "--part", "4/4"};
  const std::string all = written(words, "all.tif");
  EXPECT_TRUE(written(words + Names{"--resume"}, "resumed.tif") == all);
}

TEST_F(MapResume, RefusesOtherObserversAndGround) {
  const std::string dem = model("dem.tif", 40, 300, GDT_Int16), ground = path("ground.tif");
  fs::copy_file(dem, ground);
  const std::string points = "x,y\n500200,4999000\n", others = "x,y\n500210,4999000\n";
  const Names words{"viewshed", dem, "--ground", ground, "--observer-height", "30", "--observers"};
  const Names piped = words + Names{"-"};
  // From standard input, the same points go on.
  const std::string in = scratch_.write("in.csv", points), other = scratch_.write("other.csv", others);
  for (const std::string& text : {in, other}) {
    const Result result = run(piped + Names{"--co", "COMPRESS=JPEG", "--resume", "-o", output_}, text);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(result.err.find("was begun by another command") != std::string::npos, text == other) << result.err;
  }
  const Result rest = run(piped + Names{"--resume", "-o", output_}, in);
  EXPECT_NE(rest.err.find("300 of 300 rows were done"), std::string::npos) << rest.err;
  fs::remove(output_);
  // Another file of the ground, or of the surface.
  const Names typed = words + Names{in};
  leave_journal(typed);
  fs::last_write_time(ground, fs::last_write_time(ground) + std::chrono::seconds(3));
  expect_other(typed);
  fs::remove(journal_);
  leave_journal(typed);
  fs::last_write_time(dem, fs::last_write_time(dem) + std::chrono::seconds(3));
  expect_other(typed);
}

TEST_F(MapResume, SummariesAreThoseOfOneRun) {
  const std::string dem = model("dem.tif", 40, 600, GDT_Int16);
  const Names words{"viewshed", dem, "--observer", "500200,4996000,9", "--summary", path("seen.csv")};
  written(words, "all.tif");
  const std::string all = text_of(path("seen.csv"));
  leave_journal(words);
  fs::resize_file(journal_, fs::file_size(journal_) - 7);
  expect_rest(words, "300 of 600 rows were done");
  leave_journal(words);
  EXPECT_EQ(run(words + Names{"--resume", "-o", output_}).status, 0);
  EXPECT_EQ(text_of(path("seen.csv")), all);
}

// The table of observers repeats a text that is too long for this file system.
TEST_F(MapResume, KeepsRowsUntilAllOutputsAreWritten) {
  const std::string dem = model("dem.tif", 40, 300, GDT_Int16);
  const std::string points =
      scratch_.write("points.csv", "x,y,text\n500200,4999000," + std::string(1 << 20, 'a') + "\n");
  const Names words{"viewshed", dem, "--observers", points};
  {
    const ResourceLimit files_of(RLIMIT_FSIZE, 1 << 19);
    const Result result = Program(words + Names{"--summary", path("seen.csv"), "--resume", "-o", output_}).result();
    EXPECT_NE(result.status, 0);
    EXPECT_NE(result.err.find("seen.csv"), std::string::npos) << result.err;
  }
  EXPECT_TRUE(fs::exists(journal_));
  const Result result = run(words + Names{"--summary", path("seen.csv"), "--resume", "-o", output_});
  EXPECT_NE(result.err.find("300 of 300 rows were done"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(journal_));
}

}  // namespace
}  // namespace scarp::test
