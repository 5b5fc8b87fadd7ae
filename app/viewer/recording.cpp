// SPDX-License-Identifier: MIT
#include "app/viewer/recording.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"

namespace scarp::viewer {
namespace {

constexpr std::string_view kFirst = "scarp-view";
constexpr std::array<std::string_view, 7> kKinds = {"move", "button", "key", "wheel", "text", "option", "compare"};
constexpr int kLongestSide = 16384;
constexpr double kMostPlace = 1e6;  // pixels or steps: limit of the cursor position

// "march NAME", "look NAME", or nothing.
bool is_comparison(const std::string& text) {
  std::istringstream words(text);
  std::string what, name, more;
  words >> what >> name >> more;
  return what.empty() || ((what == "march" || what == "look") && !name.empty() && more.empty());
}

}  // namespace

Recording read_recording(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw Error(fmt::format("'{}': cannot be read", file));
  Recording recording;
  std::string line;
  int number = 0;
  double before = 0;
  const auto fail = [&](std::string_view expected) {
    throw Error(fmt::format("'{}', line {}: expected {}", file, number, expected));
  };
  while (std::getline(in, line)) {
    ++number;
    std::istringstream words(line);
    if (number == 1) {
      std::string first;
      char by = 0;
      if (!(words >> first >> recording.width >> by >> recording.height) || first != kFirst || by != 'x' ||
          recording.width < 1 || recording.height < 1 || recording.width > kLongestSide ||
          recording.height > kLongestSide)
        fail("'scarp-view WIDTHxHEIGHT'");
      continue;
    }
    if (line.empty()) continue;
    WindowEvent event;
    event.line = number;
    std::string kind;
    if (!(words >> event.seconds >> kind) || !(event.seconds >= before))
      fail("a time no earlier than the last, and an event");
    before = event.seconds;
    bool good = true;
    if (kind == "move" || kind == "wheel") {
      event.kind = kind == "move" ? WindowEvent::Kind::move : WindowEvent::Kind::wheel;
      good = static_cast<bool>(words >> event.x >> event.y) && std::abs(event.x) <= kMostPlace &&
             std::abs(event.y) <= kMostPlace;
    } else if (kind == "button" || kind == "key") {
      event.kind = kind == "button" ? WindowEvent::Kind::button : WindowEvent::Kind::key;
      good = static_cast<bool>(words >> event.code >> event.down >> event.modifiers);
      if (int letter = 0; good && kind == "key" && words >> letter) event.letter = letter;
    } else if (kind == "text") {
      event.kind = WindowEvent::Kind::text;
      words.get();  // the space
      std::getline(words, event.text);
      good = !event.text.empty();
    } else if (kind == "option" || kind == "compare") {
      event.kind = kind == "option" ? WindowEvent::Kind::option : WindowEvent::Kind::compare;
      std::getline(words >> std::ws, event.text);
      good = kind == "option" ? event.text.starts_with("--") : is_comparison(event.text);
    } else {
      good = false;
    }
    if (!good) {
      fail(
          "'move X Y', 'wheel X Y', 'button CODE DOWN MODIFIERS', 'key CODE DOWN MODIFIERS [LETTER]', 'text TYPED', "
          "'option --NAME [VALUE]' or 'compare [march NAME | look NAME]' after the time");
    }
    recording.events.push_back(event);
  }
  if (number == 0) throw Error(fmt::format("'{}': is empty", file));
  return recording;
}

void write_recording(const std::string& file, const Recording& recording) {
  ReplaceFile replace(file);
  std::ofstream out(replace.temporary_path());
  out << fmt::format("{} {}x{}\n", kFirst, recording.width, recording.height);
  for (const WindowEvent& event : recording.events) {
    out << fmt::format("{:.4f} {} ", event.seconds, kKinds[static_cast<std::size_t>(event.kind)]);
    switch (event.kind) {
      case WindowEvent::Kind::move:
      case WindowEvent::Kind::wheel:
        out << fmt::format("{} {}\n", event.x, event.y);
        break;
      case WindowEvent::Kind::button:
      case WindowEvent::Kind::key:
        out << fmt::format("{} {:d} {}", event.code, event.down, event.modifiers);
        if (event.letter != 0 && event.letter != event.code) out << ' ' << event.letter;
        out << '\n';
        break;
      case WindowEvent::Kind::text:
      case WindowEvent::Kind::option:
      case WindowEvent::Kind::compare:
        out << event.text << '\n';
    }
  }
  out.close();
  if (!out) throw Error(fmt::format("'{}': cannot be written; is the disk full?", file));
  replace.commit();
}

}  // namespace scarp::viewer
