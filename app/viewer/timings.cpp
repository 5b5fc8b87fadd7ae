// SPDX-License-Identifier: MIT
#include "app/viewer/timings.h"

#include <fmt/format.h>

#include <array>
#include <chrono>

#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

constexpr std::array<const char*, 5> kPassNames = {"moving", "coarse", "full", "refining", "converged"};

// A clock shared with other programs.
double unix_seconds() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

Timings::Timings(const std::string& file) {
  if (file.empty()) return;
  file_ = std::fopen(file.c_str(), "w");
  if (!file_) throw Error(fmt::format("'{}' cannot be written", file));
  // Line-buffered: readers follow the file while the window is open.
  std::setvbuf(file_, nullptr, _IOLBF, BUFSIZ);
  std::fputs("what,unix_s,generation,pass,columns,rows,render_s\n", file_);
}

Timings::~Timings() {
  if (file_) std::fclose(file_);
}

void Timings::event(std::uint64_t generation) {
  if (file_) fmt::print(file_, "event,{:.6f},{},,,,\n", unix_seconds(), generation);
}

void Timings::present(const WorkedPicture& shown) {
  if (!file_) return;
  const Image& image = shown.sides.front().image;
  fmt::print(file_, "present,{:.6f},{},{},{},{},{:.6f}\n", unix_seconds(), shown.generation,
             kPassNames[static_cast<std::size_t>(shown.pass)], image.width, image.height, shown.seconds);
}

}  // namespace scarp::viewer
