// SPDX-License-Identifier: MIT
// Runs `scarp` on a spiteful file and judges mechanically what any user may expect:
//
//   always    ends by itself, soon, with memory in proportion to its file
//   refused   one line on stderr that names the file, says what is wrong and what to do; no file written
//   shown     the requested output; a picture with voxels on 0.5 % of its pixels, or a warning that says why not
//   nothing   no voxel to see: `info` may describe the file, `render` and `voxelise` refuse it, others may do either
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/program.h"
#include "cli/spiteful_files.h"
#include "output/read_png.h"

namespace scarp::test::spite {

// A call takes some hundredths of a second. No case may take much time or memory.
constexpr Limits kLimits{10, std::uint64_t{3} << 29};

/// Memory: 4 times the file's bytes or voxels, the larger of the two, plus an allowance for threads and their heaps.
/// Canvases beyond 2^26 voxels count as that many: content that is not in the file must not be in memory.
constexpr std::uint64_t kAllowance = std::uint64_t{48} << 20, kLargestCanvas = std::uint64_t{1} << 26;

constexpr double kLeastShare = 0.005;

/// Expectations of a MagicaVoxel artist for a file.
struct Wanted {
  enum class How { shown, refused, either, nothing };

  How how = How::shown;
  std::string word{};                   ///< in the refusal
  std::int64_t voxels = -1;             ///< solid voxels of all models, by `info`; -1: not checked
  std::optional<Size> size{};           ///< of the box around the shown voxels
  std::string note{};                   ///< in the other output of `info` and stderr
  bool tiny = false;                    ///< too small for the picture: a warning is due instead
  std::int64_t canvas = 0;              ///< voxels in the boxes of its models, where the file has fewer bytes
  std::vector<std::string> options{};   ///< for all commands
  std::optional<std::int64_t> solid{};  ///< voxels in the world, by `voxelise`
  std::vector<std::string> also{};      ///< other commands to try: `section`, `cast`, `voxelise`
  bool of_option = false;               ///< the error is in an option, which is named instead of the file
  bool whole = false;  ///< of another kind and not damaged: an error lists the supported formats, and does not advise
                       ///< fetching it again

  Wanted noting(std::string text) && { return note = std::move(text), std::move(*this); }
  Wanted too_small() && { return tiny = true, std::move(*this); }
  Wanted in(std::int64_t voxels_of_boxes) && { return canvas = voxels_of_boxes, std::move(*this); }
  Wanted with(std::vector<std::string> given) && { return options = std::move(given), std::move(*this); }
  Wanted worth(std::int64_t voxels_of_world) && { return solid = voxels_of_world, std::move(*this); }
  Wanted intact() && { return whole = true, std::move(*this); }
  Wanted by_option() && { return of_option = true, std::move(*this); }
  Wanted trying(std::vector<std::string> commands) && { return also = std::move(commands), std::move(*this); }
};

inline Wanted shown(std::int64_t voxels, std::optional<Size> size = {}) { return {.voxels = voxels, .size = size}; }
inline Wanted refused(std::string word) { return {.how = Wanted::How::refused, .word = std::move(word)}; }
/// Nothing to see: errors contain this word.
inline Wanted nothing(std::string word) { return {.how = Wanted::How::nothing, .word = std::move(word)}; }
/// Shown as these voxels, or rejected with this word.
inline Wanted either(std::string word, std::int64_t voxels = -1, std::optional<Size> size = {}) {
  return {.how = Wanted::How::either, .word = std::move(word), .voxels = voxels, .size = size};
}

struct Case {
  std::string name;
  std::string bytes;
  Wanted wanted;
};

inline bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> found;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) found.push_back(line);
  return found;
}

/// The fraction of pixels that are not sky. From above the horizon or below, the sky has one colour in each row, and
/// pictures leave a margin to the left or right of all objects: a pixel that differs from both ends of its row is an
/// object. 12 of 255 levels are more than the sky's own gradient.
inline double share_of_objects(const Rgb& picture) {
  constexpr int kLevels = 12;
  const auto differ = [](const std::uint8_t* a, const std::uint8_t* b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])}) > kLevels;
  };
  int found = 0;
  for (int y = 0; y < picture.height; ++y) {
    const std::uint8_t *left = picture.pixel(0, y), *right = picture.pixel(picture.width - 1, y);
    for (int x = 0; x < picture.width; ++x)
      found += differ(picture.pixel(x, y), left) && differ(picture.pixel(x, y), right);
  }
  return static_cast<double>(found) / (picture.width * picture.height);
}

/// One call on one file.
class Look {
 public:
  /// `out`: the written file, if any.
  Look(const Scratch& folder, const std::string& file, std::vector<std::string> words, const std::string& out = {})
      : folder_(folder), file_(folder.path(file)), command_(words[0]), out_(out.empty() ? "" : folder.path(out)) {
    before_ = folder.files();
    words.insert(words.begin() + 1, file_);
    if (!out.empty()) words.insert(words.end(), {"-o", out_});
    result = run(words, "/dev/null", Leaks::found, kLimits);
  }

  Result result;

  const std::string& command() const { return command_; }
  const std::string& out() const { return out_; }
  std::string said() const {
    return "scarp " + command_ + ": status " + std::to_string(result.status) + ", stderr: " + result.err.substr(0, 600);
  }

  /// Exits normally, and prints nothing that only programmers understand.
  bool expect_sane() const {
    EXPECT_LT(result.status, 1000) << "crash, hang or limit: " << said();
    for (const char* word : {"std::", "bad_alloc", "what()", "json.exception", "terminate", "basic_string", "inf to"})
      EXPECT_FALSE(has(result.err, word)) << said();
    for (const std::string* text : {&result.out, &result.err})
      EXPECT_FALSE(has(*text, "\x1b")) << "control codes of the file reach the terminal: " << said();
    return result.status < 1000;
  }

  void expect_refused(const Wanted& wanted) const {
    const std::string& word = wanted.word;
    if (result.status == 0) {
      ADD_FAILURE() << "expected a refusal with '" << word << "': " << said();
      return;
    }
    const std::string line = result.err.substr(0, result.err.find_last_not_of('\n') + 1);
    EXPECT_EQ(lines(result.err), 1) << "one line expected: " << said();
    EXPECT_TRUE(line.starts_with("scarp: error: ")) << said();
    EXPECT_TRUE(wanted.of_option || has(line, std::filesystem::path(file_).filename().string()))
        << "the file is not named: " << said();
    EXPECT_TRUE(has(line, word)) << "expected '" << word << "': " << said();
    EXPECT_TRUE(advises(line)) << "expected what to do, in parentheses, or what is right: " << said();
    EXPECT_FALSE(has(line, "GDAL")) << "no raster: " << said();
    if (wanted.whole) {
      EXPECT_FALSE(has(line, "copy it again")) << said();
      EXPECT_TRUE(has(line, ".vox") || has(line, "MagicaVoxel") || has(line, "reads .vxl"))
          << "expected what is read: " << said();
    }
    EXPECT_EQ(folder_.files(), before_) << "files are left: " << said();
  }

  void expect_notes_only() const {
    for (const std::string& line : lines_of(result.err)) {
      EXPECT_TRUE(line.starts_with("note: ") || line.starts_with("scarp: note: ") || line.starts_with("warning: ") ||
                  line.starts_with("scarp: warning: "))
          << said();
    }
  }

  void expect_memory(std::uint64_t samples, std::uint64_t least) const {
    if (result.peak == 0) return;
    constexpr std::uint64_t kMiB = 1 << 20;
    EXPECT_LE(result.peak, least + kAllowance + 4 * samples)
        << "memory: " << result.peak / kMiB << " MiB, " << least / kMiB << " of them for a single voxel, for "
        << samples << " samples: " << said();
  }

 private:
  // Words in parentheses, or the expected content. Missing and empty files need no explanation.
  static bool advises(const std::string& line) {
    for (const char* enough : {"expected", "instead of", " need", "cannot be opened", "(0 bytes)"}) {
      if (has(line, enough)) return true;
    }
    const std::size_t open = line.rfind('(');
    return open != std::string::npos && line.ends_with(')') && has(line.substr(open), " ");
  }

  const Scratch& folder_;
  std::string file_, command_, out_;
  std::vector<std::string> before_;
};

/// The memory of a command with a single voxel.
inline std::uint64_t least_memory(const std::string& command, const std::string& out) {
  const Scratch folder;
  folder.write("one.vox", vox(block({1, 1, 1})));
  std::vector<std::string> words{command};
  if (command == "render") words.insert(words.end(), {"--size", "96x54"});
  const Look look(folder, "one.vox", words, out);
  EXPECT_EQ(look.result.status, 0) << look.said();
  return look.result.peak;
}

/// Voxels of a .vox file that `scarp` wrote: the counts of its XYZI chunks.
inline std::int64_t voxels_of_vox(const std::string& bytes) {
  const auto at = [&](std::size_t i) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes.at(i + k));
    return value;
  };
  std::int64_t found = 0;
  for (std::size_t i = 20; i + 12 <= bytes.size(); i += 12 + at(i + 4) + at(i + 8)) {
    if (bytes.substr(i, 4) == "XYZI") found += at(i + 12);
  }
  return found;
}

/// Runs `info`, `render` and the other commands of the case on a file in a folder.
inline void check_file(const Scratch& folder, const std::string& file, const Case& c) {
  const Wanted& wanted = c.wanted;
  SCOPED_TRACE("case '" + c.name + "'");
  static const std::uint64_t least_of_info = least_memory("info", ""),
                             least_of_render = least_memory("render", "p.png");
  const auto samples = std::max<std::uint64_t>(
      c.bytes.size(), std::min<std::uint64_t>(kLargestCanvas, static_cast<std::uint64_t>(wanted.canvas)));
  const auto words = [&](std::vector<std::string> first) {
    first.insert(first.end(), wanted.options.begin(), wanted.options.end());
    return first;
  };
  // Whether to judge it as shown.
  const auto judged = [&](const Look& look) {
    if (!look.expect_sane()) return false;
    const bool hollow =
        wanted.how == Wanted::How::nothing && (look.command() == "render" || look.command() == "voxelise");
    const bool refusal =
        wanted.how == Wanted::How::refused || hollow || (wanted.how != Wanted::How::shown && look.result.status != 0);
    if (refusal) look.expect_refused(wanted);
    if (!refusal) {
      EXPECT_EQ(look.result.status, 0) << "expected to be shown: " << look.said();
      look.expect_notes_only();
    }
    return !refusal && look.result.status == 0;
  };

  const Look info(folder, file, words({"info", "--json"}));
  info.expect_memory(samples, least_of_info);
  if (judged(info)) {
    const auto json = nlohmann::json::parse(info.result.out, nullptr, false);
    if (json.is_discarded()) {
      ADD_FAILURE() << "info --json is not JSON: " << info.result.out.substr(0, 300);
    } else {
      std::int64_t voxels = 0;
      for (const auto& model : json["models"]) voxels += model["voxels"].get<std::int64_t>();
      if (wanted.voxels >= 0) {
        EXPECT_EQ(voxels, wanted.voxels) << "voxels of all models";
      }
      if (wanted.size && json["low"].is_array()) {
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_EQ(json["high"][i].get<int>() - json["low"][i].get<int>(), (*wanted.size)[i]) << "side " << i;
      }
      EXPECT_TRUE(wanted.note.empty() || has(info.result.out + info.result.err, wanted.note))
          << "expected a note of '" << wanted.note << "'";
    }
  }
  const Look render(folder, file, words({"render", "--size", "96x54"}), "p.png");
  render.expect_memory(samples, least_of_render);
  if (judged(render)) {
    const double share = share_of_objects(read_png(render.out()));
    if (share < kLeastShare) {
      EXPECT_TRUE(has(render.result.err, "warning"))
          << "a picture with " << 100 * share << " % of voxels and no warning: " << render.said();
    }
    if (!wanted.tiny) {
      EXPECT_GE(share, kLeastShare) << "expected to be seen: " << render.said();
    }
  }
  std::filesystem::remove(folder.path("p.png"));
  for (const std::string& command : wanted.also) {
    const std::string out = command == "cast" ? "h.csv" : command == "section" ? "s.svg" : "o.vox";
    std::vector<std::string> given{command};
    if (command == "cast")
      given.insert(given.end(), {"--rays", folder.write("rays.csv", "x,y,z,dx,dy,dz\n0.5,0.5,4000,0,0,-1\n")});
    const Look look(folder, file, words(given), out);
    look.expect_memory(samples, least_of_render);
    if (judged(look) && command == "voxelise" && wanted.solid) {
      EXPECT_EQ(voxels_of_vox(text_of(look.out())), *wanted.solid) << "voxels in the world";
    }
    std::filesystem::remove(folder.path(out));
  }
}

inline void check(const Case& c, const std::string& file = "m.vox") {
  const Scratch folder;
  folder.write(file, c.bytes);
  check_file(folder, file, c);
}

inline void check_all(const std::vector<Case>& cases, const std::string& file = "m.vox") {
  for (const Case& c : cases) check(c, file);
}

}  // namespace scarp::test::spite
