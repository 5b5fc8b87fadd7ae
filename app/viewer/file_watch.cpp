// SPDX-License-Identifier: MIT
#include "app/viewer/file_watch.h"

#include <algorithm>

namespace scarp::viewer {
namespace {

constexpr std::uintmax_t kMissing = static_cast<std::uintmax_t>(-1);  // as std::filesystem::file_size() has it

}  // namespace

std::vector<FileWatch::State> FileWatch::states() const {
  std::vector<State> found;
  for (const std::string& file : files_) {
    std::error_code none;
    found.emplace_back(std::filesystem::last_write_time(file, none), std::filesystem::file_size(file, none));
  }
  return found;
}

bool FileWatch::changed() {
  std::vector<State> now = states();
  const bool rests = now == last_;
  last_ = std::move(now);
  const auto missing = [](const State& state) { return state.second == kMissing; };
  if (!rests || last_ == seen_ || std::any_of(last_.begin(), last_.end(), missing)) return false;
  seen_ = last_;
  return true;
}

}  // namespace scarp::viewer
