// SPDX-License-Identifier: MIT
// Adds the path to errors of raster readers.
#pragma once

#include <fmt/format.h>

#include <new>
#include <string>
#include <string_view>

#include "scarp/base/error.h"

namespace scarp {

/// Returns the result of read(). Rethrows its Errors prefixed with the path, and Interrupted unchanged.
template <class Read>
auto read_named(const std::string& path, Read&& read) {
  try {
    return read();
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  } catch (const std::bad_alloc& error) {
    // An operator new of the program may say more.
    if (error.what() != std::string_view("std::bad_alloc")) throw;
    throw Error(fmt::format("{}: samples do not fit in memory (read a part with --window COL,ROW,COLS,ROWS)", path));
  }
}

}  // namespace scarp
