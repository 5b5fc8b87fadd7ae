// SPDX-License-Identifier: MIT
// Whatever goes wrong while a raster is read, one line says which raster it was.
#pragma once

#include <fmt/format.h>

#include <new>
#include <string>

#include "scarp/base/error.h"
#include "scarp/source/raster.h"

namespace scarp {

/// What read() returns, with `path` in it. Its Errors are thrown on with the path before their text, Interrupted as it
/// is.
template <class Read>
Raster read_named(const std::string& path, Read&& read) {
  try {
    Raster raster = read();
    raster.path = path;
    return raster;
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    throw Error(fmt::format("raster '{}': {}", path, error.what()));
  } catch (const std::bad_alloc&) {
    throw Error(fmt::format(
        "raster '{}': its samples do not fit into memory; read a part with --window COL,ROW,COLS,ROWS", path));
  }
}

}  // namespace scarp
