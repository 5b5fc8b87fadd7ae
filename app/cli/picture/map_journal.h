// SPDX-License-Identifier: MIT
// The finished rows of a map in a file beside the output, so that a run that was killed goes on with --resume.
//
//   OUTPUT.resume    identity of the run | strip: rows, totals, pixels of every band, check sum | strip ...
//
// A strip counts once its check sum is complete. The file is deleted when the output has been written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace scarp::cli {

/// The rows of a strip, and its pixels: bytes of each band, from north to south.
struct JournalStrip {
  int first = 0, last = 0;     ///< rows [first, last)
  std::vector<double> totals;  ///< of all strips up to this one
  std::vector<std::vector<std::byte>> bands;
};

class MapJournal {
 public:
  /// Opens the journal of `output`, or begins one. `identity`: text that is equal for runs with the same result. Throws
  /// Error for a journal of another run, one in use, and a file that cannot be written.
  MapJournal(const std::string& output, const std::string& identity);
  ~MapJournal();
  MapJournal(const MapJournal&) = delete;
  MapJournal& operator=(const MapJournal&) = delete;

  /// Returns the next strip of an earlier run; false after the last. An incomplete strip and all after it are cut off.
  bool next(JournalStrip& strip);
  /// Appends a strip, after all were read. It is on the disk on return. Throws Error (disk full).
  void append(int first, int last, std::span<const double> totals, std::span<const std::span<const std::byte>> bands);
  /// Deletes the file.
  void remove();

 private:
  [[noreturn]] void fail(const std::string& what) const;
  void write(std::span<const std::byte> bytes);
  bool read(std::span<std::byte> bytes);

  std::string path_;
  int file_ = -1;
};

}  // namespace scarp::cli
