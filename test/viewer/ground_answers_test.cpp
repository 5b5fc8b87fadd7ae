// SPDX-License-Identifier: MIT
// The answers of the window from an observer on the ground are those of `scarp viewshed` and `scarp los`.
#include "app/viewer/ground_answers.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "app/viewer/subject.h"
#include "app/viewer/sun_clock.h"
#include "scarp/base/error.h"
#include "scarp/source/raster/read_raster.h"
#include "scratch.h"

namespace scarp::viewer {
namespace {

struct GroundAnswersTest : testing::Test {
  test::Scratch scratch;
  std::string dem = scratch.path("dem.tif"), map = scratch.path("viewshed.tif");

  GroundAnswersTest() { run("scarp generate --size 97 --cell 30 -o '" + dem + "'"); }

  // Runs a command of the window with the program of this build.
  std::string run(const std::string& command) const {
    const std::string out = scratch.path("out.txt");
    const std::string whole = "'" SCARP_PROGRAM "'" + command.substr(command.find(' ')) + " >'" + out + "' 2>&1";
    const int status = std::system(whole.c_str());
    std::ifstream in(out);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(status, 0) << command << text;
    return text;
  }

  std::vector<std::uint8_t> written() const {
    RasterOptions codes;
    codes.band = 1;
    const Raster raster = read_raster(map, codes);
    return std::visit([](const auto& samples) { return std::vector<std::uint8_t>(samples.begin(), samples.end()); },
                      raster.samples);
  }

  // The codes of the window, as the values that `scarp viewshed` writes.
  static std::vector<std::uint8_t> values_of(const SeenGround& seen, int cols, int rows) {
    constexpr std::uint8_t kNone = 255;
    std::vector<std::uint8_t> values(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows), kNone);
    for (int row = 0; row < seen.part.rows; ++row) {
      for (int col = 0; col < seen.part.cols; ++col) {
        const Seen code = seen.codes[static_cast<std::size_t>(row * seen.part.cols + col)];
        if (code == Seen::hidden || code == Seen::visible)
          values[static_cast<std::size_t>((row + seen.part.row) * cols + col + seen.part.col)] = code == Seen::visible;
      }
    }
    return values;
  }

  Opening opening(const std::vector<OptionChange>& changes) const {
    Opening opening = opening_of({dem});
    for (const OptionChange& change : changes) opening = changed(opening, change);
    return opening;
  }

  void expect_same(const std::vector<OptionChange>& changes, Observer observer) {
    const Subject subject(opening(changes), 64, 48);
    GroundAnswers answers(subject.opening(), subject.shared());
    const ViewshedTask task = answers.viewshed(observer);
    observer.reach = task.reach;
    const SeenGround seen = task.compute(0, {});
    const std::string command = answers.command(observer, map);
    SCOPED_TRACE(command);
    run(command);
    const std::vector<std::uint8_t> values = values_of(seen, answers.cols(), answers.rows());
    EXPECT_EQ(values, written());
    EXPECT_GT(std::count(values.begin(), values.end(), 1), 50);
    EXPECT_GT(std::count(values.begin(), values.end(), 0), 50);
  }
};

TEST_F(GroundAnswersTest, ViewshedsAreThoseOfTheirCommand) {
  const Observer observer{.node = {40, 30}};
  expect_same({}, observer);
  // Neither exaggeration nor the look changes what one sees.
  expect_same({{"--exaggeration", "3"}, {"--look", "slope"}}, observer);
  expect_same({}, {.node = {40, 30}, .height = 12.5, .target_height = 3, .reach = 900});
  expect_same({}, {.node = {0, 96}, .height = 30});
  // Options of the raster are those of the command; degrees have a plane near the observer alone.
  expect_same({{"--window", "10,20,60,50"}, {"--scale", "2"}}, {.node = {33, 20}});
  expect_same({{"--crs", "EPSG:4326"}, {"--bounds", "10,46,10.04,46.03"}}, observer);
}

TEST_F(GroundAnswersTest, TheQuickAnswerIsThePartNearby) {
  run("scarp generate --size 700 --cell 10 -o '" + dem + "'");
  const Subject subject(opening({}), 64, 48);
  GroundAnswers answers(subject.opening(), subject.shared());
  const ViewshedTask task = answers.viewshed({.node = {350, 300}});
  ASSERT_GT(task.quick_reach, 0);
  const SeenGround quick = task.compute(task.quick_reach, {}), all = task.compute(0, {});
  EXPECT_FALSE(quick.complete);
  EXPECT_TRUE(all.complete);
  EXPECT_LT(quick.codes.size(), all.codes.size());
  int compared = 0;
  for (int row = 0; row < quick.part.rows; ++row) {
    for (int col = 0; col < quick.part.cols; ++col) {
      const Seen code = quick.codes[static_cast<std::size_t>(row * quick.part.cols + col)];
      if (code == Seen::out_of_range) continue;
      ++compared;
      EXPECT_EQ(code, all.codes[static_cast<std::size_t>((row + quick.part.row) * 700 + col + quick.part.col)]);
    }
  }
  EXPECT_GT(compared, 10000);
  EXPECT_THROW(task.compute(0, [](double) { return false; }), Interrupted);
}

TEST_F(GroundAnswersTest, LinesOfSightAreThoseOfLos) {
  const Subject subject(opening({{"--exaggeration", "2"}}), 64, 48);
  GroundAnswers answers(subject.opening(), subject.shared());
  const Observer observer{.node = {40, 30}};
  int visible = 0;
  for (const Node to : {Node{90, 10}, {3, 80}, {60, 60}, {42, 33}, {40, 95}}) {
    const SightAnswer answer = answers.sight(observer, answers.point_at(to));
    // The typed coordinates are those of the map's command.
    const auto typed = [&](Node node) {
      const std::string command = answers.command({.node = node}, map);
      const std::size_t at = command.find("--observer=") + 11;
      return command.substr(at, command.find(' ', at) - at);
    };
    const std::string table = run("scarp los '" + dem + "' --from=" + typed(observer.node) + " --to=" + typed(to));
    const std::size_t row = table.find("\n1,");
    ASSERT_NE(row, std::string::npos) << table;
    EXPECT_EQ(table[row + 3] == '1', answer.line.visible) << table;
    EXPECT_NE(table.find(fmt::format(",{:.10g},", answer.line.distance)), std::string::npos) << table;
    visible += answer.line.visible;
    // The last piece over the ground ends at the target.
    ASSERT_GE(answer.ground.size(), 2u);
    EXPECT_EQ(answer.ground.back().visible, answer.line.visible);
    // At a node, both are the sample in metres, exaggerated: fewer than 16 roundings each.
    const double z = answers.point_at(to).z;
    EXPECT_NEAR(answer.ground.back().at.z, z, 32 * 0x1p-53 * std::abs(z));
  }
  EXPECT_GT(visible, 0);
  EXPECT_LT(visible, 5);
}

TEST_F(GroundAnswersTest, HorizonsAreThoseOfTheirCommand) {
  map = scratch.path("horizon.csv");
  for (const std::vector<OptionChange>& changes :
       {std::vector<OptionChange>{{"--exaggeration", "2"}},
        std::vector<OptionChange>{{"--crs", "EPSG:4326"}, {"--bounds", "10,46,10.04,46.03"}}}) {
    const Subject subject(opening(changes), 64, 48);
    GroundAnswers answers(subject.opening(), subject.shared());
    const HorizonPlot plot = answers.horizon({40, 30})({});
    const std::string command = answers.horizon_command(plot, map);
    SCOPED_TRACE(command);
    run(command);
    std::ifstream in(map);
    std::string line;
    std::getline(in, line);
    ASSERT_EQ(line, "point,horizon_azimuth,horizon_elevation,distance");
    double highest = -90;
    for (std::size_t i = 0; i < plot.views.size(); ++i) {
      ASSERT_TRUE(std::getline(in, line));
      double azimuth = 0, elevation = 0;
      ASSERT_EQ(std::sscanf(line.c_str(), "1,%lf,%lf", &azimuth, &elevation), 2) << line;
      EXPECT_EQ(azimuth, static_cast<double>(i));
      // The table has six decimals, and the typed place twelve digits.
      EXPECT_NEAR(elevation, plot.views[i].angle * cli::kDegreesPerRadian, 2e-6) << line;
      highest = std::max(highest, elevation);
    }
    EXPECT_NEAR(highest, plot.highest() * cli::kDegreesPerRadian, 2e-6);
  }
}

TEST_F(GroundAnswersTest, TheSunOfATimeIsThatOfShadow) {
  map = scratch.path("shadow.tif");
  using namespace std::chrono_literals;
  const std::chrono::sys_days day = SunClock::day_of("2026-06-21");
  EXPECT_EQ(SunClock::day_text(day), "2026-06-21");
  EXPECT_THROW(SunClock::day_of("2026-02-30"), Error);
  const SunClock clock(opening({{"--look", "slope"}}));
  for (const int minutes : {9 * 60, 16 * 60 + 30}) {
    const SunPosition sun = clock.at(day, minutes);
    const std::string printed = run(clock.command(day, minutes, map));
    EXPECT_NE(printed.find(fmt::format("azimuth {:.4f}, altitude {:.4f} degrees", sun.azimuth * cli::kDegreesPerRadian,
                                       sun.altitude * cli::kDegreesPerRadian)),
              std::string::npos)
        << printed;
  }
  EXPECT_LT(clock.at(day, 0).altitude, 0);
  EXPECT_EQ(clock.time_text(day, 24 * 60), clock.time_text(day, 24 * 60 - 1));
  SunTime time{day, 23 * 60 + 30, false};
  time.advance(1);
  EXPECT_EQ(time.minutes, 23 * 60 + 30);
  time.plays = true;
  time.advance(1);
  EXPECT_EQ(time.minutes, 30);
}

TEST_F(GroundAnswersTest, RefusesOtherGround) {
  const Subject endless(opening({{"--wrap", "mirror"}}), 64, 48);
  EXPECT_THROW(GroundAnswers(endless.opening(), endless.shared()), Error);
  const Subject subject(opening({}), 64, 48);
  GroundAnswers answers(subject.opening(), subject.shared());
  EXPECT_EQ(answers.node_at({1e9, -1e9, 0}), (Node{96, 96}));
  EXPECT_EQ(answers.node_at(answers.point_at({17, 5})), (Node{17, 5}));
}

}  // namespace
}  // namespace scarp::viewer
