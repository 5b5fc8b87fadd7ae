// SPDX-License-Identifier: MIT
// Adversarial rasters, from outside: no crash, no blank picture without a warning, one line for each error, no silent
// mistakes, and memory in proportion to the file.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/program.h"
#include "cli/spiteful_broken_files.h"
#include "cli/spiteful_places.h"
#include "cli/spiteful_samples.h"
#include "output/read_png.h"

namespace scarp {
namespace {

using test::Expected;
using test::Names;
using test::Result;
using test::SpitefulRaster;
using Problems = std::vector<std::string>;

// A picture with a smaller fraction of terrain counts as blank.
constexpr double kBlank = 0.005;
constexpr auto kPatience = std::chrono::seconds(20);  // sanitizers are slow
constexpr double kMiB = 1 << 20;

// In a separate process, stopped if it takes too long.
Result run_alone(const Names& arguments) { return test::Program(arguments).result(kPatience); }
bool hung(const Result& result) { return result.status == 1000 + SIGSEGV; }
double peak_bytes(const Result& result) { return static_cast<double>(result.peak); }

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool has_one_of(const std::string& text, const std::string& words) {
  std::istringstream in(lower(words));
  for (std::string word; std::getline(in, word, '|');) {
    if (lower(text).find(word) != std::string::npos) return true;
  }
  return words.empty();
}

// A picture of heights is black where there is no terrain (including the walls of a plinth), and grey 1 to 255
// elsewhere. It is a separate picture, from the same camera as the one that people see.
double share_of_ground(const test::Rgb& heights) {
  std::size_t ground = 0;
  for (std::size_t i = 0; i < heights.bytes.size(); i += 3) ground += heights.bytes[i] > 0;
  return 3.0 * static_cast<double>(ground) / static_cast<double>(heights.bytes.size());
}

// Where there is ground in the picture of heights, the visible picture must differ from the sky colour in its upper
// left corner. Half of the pixels suffice, because haze and white summits resemble the sky.
bool shows_ground(const test::Rgb& picture, const test::Rgb& heights) {
  int ground = 0, different = 0;
  for (int y = 0; y < heights.height; ++y) {
    for (int x = 0; x < heights.width; ++x) {
      if (heights.pixel(x, y)[0] == 0) continue;
      ++ground;
      int difference = 0;
      for (int c = 0; c < 3; ++c) difference += std::abs(picture.pixel(x, y)[c] - picture.pixel(0, 0)[c]);
      different += difference > 24;
    }
  }
  return 2 * different > ground || heights.pixel(0, 0)[0] > 0;
}

// On a map of heights.
bool peaks_in_north_east(const test::Rgb& map) {
  double n = 0, x_sum = 0, y_sum = 0;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (map.pixel(x, y)[0] < 250) continue;
      n += 1, x_sum += x, y_sum += y;
    }
  }
  return n > 0 && x_sum / n > 0.6 * map.width && y_sum / n < 0.4 * map.height;
}

bool close(double value, double expected, double share) {
  return std::isnan(expected) || std::abs(value - expected) <= share * std::abs(expected);
}

// Finds errors in the program's treatment of a raster.
class Judge {
 public:
  explicit Judge(const SpitefulRaster& raster) : raster_(raster) {}

  Problems problems() {
    const bool described = describe();
    if (hung_) return problems_;
    const bool drawn = draw(described);
    if (drawn && raster_.peaks_in_north_east) map_and_rays();
    return problems_;
  }

 private:
  Result call(const std::string& subcommand, const Names& more) {
    Names words{subcommand};
    words.insert(words.end(), raster_.inputs.begin(), raster_.inputs.end());
    words.insert(words.end(), raster_.options.begin(), raster_.options.end());
    words.insert(words.end(), more.begin(), more.end());
    what_ = subcommand;
    for (const std::string& word : more) what_ += " " + word;
    const Result result = raster_.may_hang ? run_alone(words) : test::run(words);
    if (raster_.may_hang) {
      if (hung(result)) {
        wrong("it does not end");
        hung_ = true;
        return result;
      }
      // These files are not worth keeping.
      if (peak_bytes(result) > kMostForNothing) wrong(fmt::format("{:.0f} MiB", peak_bytes(result) / kMiB));
    }
    if (result.status > 2) wrong(fmt::format("status {}: {}", result.status, result.err));
    for (const char* riddle : {"std::", "terminate", "what()", " 0x", "Success"}) {
      if ((result.out + result.err).find(riddle) != std::string::npos)
        wrong(fmt::format("'{}' in: {}", riddle, result.err));
    }
    if (result.status != 0) judge_error(result);
    return result;
  }

  void judge_error(const Result& result) {
    const std::string name = raster_.inputs.front().substr(raster_.inputs.front().find_last_of('/') + 1);
    const std::string& text = result.err;
    if (!result.out.empty()) wrong("output beside the error: " + result.out);
    if (test::lines(text) != 1 || text.back() != '\n') wrong("not one line: '" + text + "'");
    if (!text.starts_with("scarp: error: ")) wrong("no 'scarp: error: ' in front: " + text);
    if (text.find(name.substr(0, name.find('\n'))) == std::string::npos) wrong("the file is not named: " + text);
    if (!text.ends_with(")\n") || text.find('(') == std::string::npos) wrong("no remedy in parentheses: " + text);
    if (!out_.files().empty()) wrong("left behind: " + out_.files().front());
    if (!has_one_of(text, raster_.words)) wrong(fmt::format("none of '{}' in: {}", raster_.words, text));
  }

  // Whether `info` succeeds.
  bool describe() {
    Names words{"--json"};
    // Voxels and scenes, which some broken files are by name, are always read.
    const std::string& file = raster_.inputs.front();
    if (!file.ends_with(".vox") && !file.ends_with(".json")) words.emplace_back("--statistics");
    const Result info = call("info", words);
    const bool good = info.status == 0;
    if (good && raster_.expected == Expected::refused) wrong("described instead of refused");
    if (!good && raster_.expected != Expected::refused && raster_.expected != Expected::right_or_refused)
      wrong("refused: " + info.err);
    if (!good) return false;
    const auto json = nlohmann::json::parse(info.out, nullptr, false);
    if (json.is_discarded()) {
      wrong("no JSON: " + info.out);
      return true;
    }
    const std::string size = fmt::format("{}x{}", json["cols"].get<int>(), json["rows"].get<int>());
    if (!raster_.size.empty() && size != raster_.size) wrong(fmt::format("{} samples, not {}", size, raster_.size));
    const auto number = [&](const char* key) { return json[key].is_number() ? json[key].get<double>() : NAN; };
    // Heights as `info` prints them, with six digits; widths by other formulas of the ellipsoid.
    constexpr double kPrinted = 5e-6, kProjected = 0.01;
    if (!close(number("min_m"), raster_.heights.low, kPrinted) ||
        !close(number("max_m"), raster_.heights.high, kPrinted)) {
      wrong(fmt::format("heights from {} to {} m, not {} to {}", number("min_m"), number("max_m"), raster_.heights.low,
                        raster_.heights.high));
    }
    if (!close(number("width_m"), raster_.width_m, kProjected))
      wrong(fmt::format("{} m wide, not {}", number("width_m"), raster_.width_m));
    return true;
  }

  // Whether there is a picture.
  bool draw(bool described) {
    const std::string file = out_.path("p.png");
    const Result result = call("render", {"-o", file, "--size", "96x54"});
    const bool good = result.status == 0;
    switch (raster_.expected) {
      case Expected::drawn:
      case Expected::drawn_or_warned:
        if (!good) wrong("refused: " + result.err);
        break;
      case Expected::right_or_refused:
        if (good && !described) wrong("drawn, but not described");
        break;
      case Expected::described:
      case Expected::refused:
        if (good) wrong("drawn instead of refused");
    }
    if (!good) return false;
    if (!std::filesystem::exists(file)) {
      wrong("no picture");
      return false;
    }
    judge_notes(result);
    const test::Rgb picture = test::read_png(file), heights = heights_from({"--size", "96x54"});
    const double share = share_of_ground(heights);
    const bool warned = has_one_of(result.err, "warning: |blank|% of the pixels|% of its pixels");
    if (share < kBlank) {
      if (!warned) wrong(fmt::format("blank ({:.2g} % ground) without a warning: {}", 100 * share, result.err));
      if (raster_.expected == Expected::drawn) wrong(fmt::format("blank ({:.2g} % ground)", 100 * share));
    } else if (!shows_ground(picture, heights)) {
      wrong("the ground has the colour of the sky");
    }
    return share >= kBlank;
  }

  void judge_notes(const Result& result) {
    if (!has_one_of(result.err, raster_.words))
      wrong(fmt::format("none of '{}' in the notes: {}", raster_.words, result.err));
    std::istringstream in(result.err);
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("scarp: ")) line.erase(0, 7);
      if (!line.starts_with("note: ") && !line.starts_with("warning: ")) wrong("neither note nor warning: " + line);
    }
  }

  test::Rgb heights_from(const Names& more) {
    const std::string file = out_.path("h.png");
    Names words{"-o", file, "--look", "height", "--threads", "1"};
    words.insert(words.end(), more.begin(), more.end());
    return call("render", words).status == 0 ? test::read_png(file) : test::Rgb{1, 1, {0, 0, 0}};
  }

  void map_and_rays() {
    if (!peaks_in_north_east(heights_from({"--top", "--size", "96x54"}))) wrong("the peak is not in the north-east");
    // Rays straight down next to the north-eastern and the south-western sample, in metres of the raster.
    const double width = std::isnan(raster_.width_m) ? 23 : raster_.width_m, depth = width * 15 / 23;
    const std::string rays =
        out_.write("rays.csv", fmt::format("x,y,z,dx,dy,dz\n{},{},1000,0,0,-1\n{},{},1000,0,0,-1\n", 0.95 * width,
                                           0.95 * depth, 0.05 * width, 0.05 * depth));
    const Result hits = call("cast", {"--rays", rays, "--coords", "local", "-o", "-"});
    // Heights of the hills: 60 + 60 x 0.95^2 and 60 + 60 x 0.05^2, rounded by half a metre at the samples. In a raster
    // that is 1 % wider than stated the eastern position is 0.6 m lower.
    constexpr double kTolerance = 0.5 + 0.6;
    const std::vector<double> expected{114.15, 60.15};
    std::istringstream in(hits.out);
    std::string line;
    std::getline(in, line);
    for (const double height : expected) {
      std::getline(in, line);
      std::istringstream fields(line);
      bool found = false;
      for (std::string field; std::getline(fields, field, ',');)
        found = found || std::abs(std::strtod(field.c_str(), nullptr) - height) <= kTolerance;
      if (!found) wrong(fmt::format("no hit at {} m: {}", height, line + hits.err));
    }
  }

  void wrong(const std::string& text) {
    const std::string line = what_ + ": " + text;
    if (std::find(problems_.begin(), problems_.end(), line) == problems_.end()) problems_.push_back(line);
  }

  static constexpr double kMostForNothing = 512 * kMiB;

  const SpitefulRaster& raster_;
  test::Scratch out_;
  std::string what_;  // the call
  bool hung_ = false;
  Problems problems_;
};

const char* name_of(Expected expected) {
  switch (expected) {
    case Expected::drawn:
      return "a picture with ground";
    case Expected::drawn_or_warned:
      return "a picture with ground, or a warning";
    case Expected::right_or_refused:
      return "a right picture, or an error";
    case Expected::described:
      return "a description, and an error instead of a picture";
    case Expected::refused:
      break;
  }
  return "an error";
}

void judge(const test::SpitefulRasters& rasters) {
  for (const SpitefulRaster& raster : rasters) {
    std::string text;
    for (const std::string& problem : Judge(raster).problems()) text += "\n  " + problem;
    EXPECT_TRUE(text.empty()) << raster.kind << " (" << raster.inputs.front() << "): expected "
                              << name_of(raster.expected) << text;
  }
}

TEST(SpitefulRasters, TextGrids) {
  const test::SpitefulFiles files;
  judge(test::text_grids(files));
}

TEST(SpitefulRasters, SampleValues) {
  const test::SpitefulFiles files;
  judge(test::sample_values(files));
}

TEST(SpitefulRasters, Places) {
  const test::SpitefulFiles files;
  judge(test::places(files));
}

TEST(SpitefulRasters, PicturesAndBands) {
  const test::SpitefulFiles files;
  judge(test::pictures_and_bands(files));
}

TEST(SpitefulRasters, BrokenFiles) {
  const test::SpitefulFiles files;
  judge(test::broken_files(files));
}

// Not only inputs: also files that options name.
TEST(SpitefulRasters, RejectsPipesAsOptionValues) {
  const test::SpitefulFiles files;
  const std::string terrain = files.tiff("hills.tif", GDT_Int16, test::hills());
  const struct {
    const char* name;
    Names words;
  } cases[] = {{"pipe.csv", {"cast", terrain, "--coords", "local", "--rays"}},
               {"pipe.cpt", {"render", terrain, "-o", files.path("p.png"), "--ramp"}},
               {"pipe.txt", {"render", terrain, "-o", files.path("p.png"), "--ramp"}},
               {"pipe.fn", {"render", "-o", files.path("p.png"), "--function"}}};
  for (const auto& c : cases) {
    const std::string pipe = files.path(c.name);
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    Names words = c.words;
    words.push_back(pipe);
    const Result result = run_alone(words);
    EXPECT_FALSE(hung(result)) << c.name;
    EXPECT_NE(result.err.find(std::string(c.name)), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("is a pipe"), std::string::npos) << result.err;
  }
}

// In addition to the memory that the program needs for four samples: the field, its index, and one copy of the file's
// samples, because a file can be one compressed strip.
TEST(SpitefulRasters, KeepsNoMoreThanFieldIndexAndOneStrip) {
  const test::SpitefulFiles files;
  const auto peak = [&](const std::string& file) {
    const Result result = run_alone({"render", file, "-o", files.path("p.png"), "--size", "96x54"});
    EXPECT_EQ(result.status, 0) << result.err;
    return peak_bytes(result);
  };
  const double least = peak(files.tiff("least.tif", GDT_Int16, {1, 2, 3, 4}, {}, {}, 1, 2, 2));
  constexpr int kSide = 3072;  // so large that code and buffers, which any picture needs, hardly count
  // Bytes for each sample: pyramid (a third of an entry of maximum, plane and minimum) and steepest edges.
  constexpr double kIndex = 6 / 3.0 + 1 / 16.0, kBuffers = 4.0 * (1 << 20) / (double{kSide} * kSide);
  const struct {
    const char* kind;
    GDALDataType type;
    std::vector<const char*> options;
  } cases[] = {{"Byte", GDT_Byte, {}},
               {"Int16 in tiles", GDT_Int16, {"TILED=YES", "COMPRESS=DEFLATE"}},
               {"Int16 in one compressed strip", GDT_Int16, {"BLOCKYSIZE=3072", "COMPRESS=DEFLATE"}},
               {"Float32", GDT_Float32, {}},
               {"Float64", GDT_Float64, {}}};
  for (const auto& c : cases) {
    const auto hilly = [](GDALDataset& d) {
      std::vector<double> row(kSide);
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) row[static_cast<std::size_t>(x)] = (x * y) % 127;
        if (d.GetRasterBand(1)->RasterIO(GF_Write, 0, y, kSide, 1, row.data(), kSide, 1, GDT_Float64, 0, 0, nullptr))
          throw std::runtime_error("cannot write a row");
      }
    };
    const std::string file = files.tiff(fmt::format("{}.tif", c.kind), c.type, {}, hilly, c.options, 1, kSide, kSide);
    const double samples = double{kSide} * kSide, in_file = GDALGetDataTypeSizeBytes(c.type);
    const double kept = in_file <= 2 ? sizeof(std::uint16_t) : sizeof(float), more = (peak(file) - least) / samples;
    EXPECT_LT(more, kept + kIndex + in_file + kBuffers) << c.kind << ": bytes for each sample";
  }
}

}  // namespace
}  // namespace scarp
