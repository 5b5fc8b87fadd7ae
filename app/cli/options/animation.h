// SPDX-License-Identifier: MIT
// --animate NAME=VALUE: an option of each frame, whose value has ranges FROM..TO. Any option that takes numbers can be
// animated, because the parser sets it, as if it had been typed for the frame.
//
//   shrink=1..0.2     sun=90..270,30     view=190..250,35..20     look=level:0..6
#pragma once

#include <string>
#include <vector>

#include "app/options/command.h"

namespace scarp::cli {

class Animation {
 public:
  /// `text` is the value of --animate. Throws WrongUsage if it has no range, or names no option of the command that
  /// takes numbers for a picture.
  Animation(const Command& command, const std::string& text);

  /// Sets the option for a frame; `share` is 0 for the first frame and 1 for the last. Numbers are rounded to whole
  /// ones if the option takes no others. Throws what the option throws.
  void set(Command& command, double share) const;

 private:
  // A number that changes, and the text after it.
  struct Range {
    double from, to;
    std::string after;
  };

  std::string text_at(double share, bool whole) const;

  const Declared* option_;
  std::string before_;  // text before the first range
  std::vector<Range> ranges_;
};

}  // namespace scarp::cli
