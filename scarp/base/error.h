// SPDX-License-Identifier: MIT
// The one exception that leaves the library.
#pragma once

#include <stdexcept>
#include <string>

namespace scarp {

/// Thrown at the library's edge (files, arguments). The text is one line: what, where, what would be right.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown when a long task stops because its progress callback asked it to (Ctrl-C in the command line).
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted") {}
};

}  // namespace scarp
