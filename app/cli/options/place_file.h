// SPDX-License-Identifier: MIT
// Files of places as inputs of subcommands: their options, and rows that cannot be used.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/options/command.h"
#include "scarp/base/error.h"
#include "scarp/source/table/place_table.h"

namespace scarp::cli {

struct PlaceFile {
  std::string path;   ///< empty: none
  std::string layer;  ///< empty: chosen
  bool skip_bad = false;

  /// Throws Error naming the file.
  PlaceTable read(PlaceKind kind) const { return read_places(path, kind, {layer, false, skip_bad}); }
};

/// Declares the option `file` for the path, --layer and --skip-bad.
void add_place_file(Command& command, PlaceFile& options, Option file);

/// The same for --points: places of a table, for subcommands that have --at.
void add_points_option(Command& command, PlaceFile& options);

/// Removes Z of a vector file's points, which is a height above the sea, and adds a note if there was any: for
/// subcommands whose heights count from the ground.
void ignore_vector_z(PlaceTable& table);

/// Whether rows of a table can be used. The first error ends the run, unless bad rows are skipped.
class RowStatus {
 public:
  RowStatus(const PlaceTable& table, bool skip);

  bool good(std::size_t row) const { return status_[row] == kOk; }
  /// Calls `work` for a good row, and returns whether the row is still good. If `work` throws Error and bad rows are
  /// skipped, the row gets this status. Thread-safe for different rows.
  template <class Work>
  bool attempt(std::size_t row, std::string_view status, const Work& work) {
    if (!good(row)) return false;
    try {
      work();
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& error) {
      if (!skip_) throw;
      status_[row] = status;
      why_[row] = error.what();
    }
    return good(row);
  }

  /// "ok", "invalid" (no places in the row), "outside" (of the raster), "nodata" (no ground there).
  std::string_view of(std::size_t row) const { return status_[row]; }
  /// Throws Error with the reason of the first row if no row is good.
  void require_good() const;
  /// Returns a note about the skipped rows; empty if there are none. Throws Error as require_good().
  std::string note() const;

  static constexpr std::string_view kOk = "ok", kInvalid = "invalid", kOutside = "outside", kNodata = "nodata";

 private:
  const std::string& first_reason() const;

  bool skip_;
  std::vector<std::string_view> status_;
  std::vector<std::string> why_;
};

}  // namespace scarp::cli
