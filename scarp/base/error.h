// SPDX-License-Identifier: MIT
// The exceptions that the library throws.
#pragma once

#include <stdexcept>
#include <string>

namespace scarp {

/// Base of all exceptions thrown by the library. The text is one line, `SUBJECT: what is wrong (what to do)`. The
/// subject is a file, an object or a setting.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown when a progress callback stops a long task, as Ctrl-C does in the command line.
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted") {}
};

}  // namespace scarp
