// SPDX-License-Identifier: MIT
// The finished rows of a map in a file beside the output, so that a run that was killed goes on with --resume.
//
//   OUTPUT.resume    identity of the run | strip: rows, totals, type and pixels of every band, check sum | strip ...
//
// A strip counts once its check sum is complete. The file is deleted when all outputs have been written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scarp::cli {

/// The pixels of a band in a strip, from north to south.
struct JournalBand {
  std::uint64_t type = 0;  ///< of a pixel: the index in ComputedBand::pixels
  std::vector<std::byte> pixels{};
};
struct BandPixels {
  std::uint64_t type = 0;
  std::span<const std::byte> pixels;
};

/// A strip of rows.
struct JournalStrip {
  int first = 0, last = 0;     ///< rows [first, last)
  std::vector<double> totals;  ///< of all strips up to this one
  std::vector<JournalBand> bands;
};

/// Closes the file at the end of its lifetime.
class FileDescriptor {
 public:
  /// `number`: of the open file; negative: none.
  explicit FileDescriptor(int number) : number_(number) {}
  ~FileDescriptor();
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  operator int() const { return number_; }

 private:
  int number_;
};

class MapJournal {
 public:
  /// Opens the journal of `output`, or begins one. `identity`: text that is equal for runs with the same result. Throws
  /// Error for a journal of another run, one in use, and a file that cannot be locked or written.
  MapJournal(const std::string& output, const std::string& identity);

  /// Returns the next strip of an earlier run; false after the last. An incomplete strip and all after it are cut off.
  bool next(JournalStrip& strip);
  /// Appends a strip, after all were read. It is on the disk on return. Throws Error (disk full).
  void append(int first, int last, std::span<const double> totals, std::span<const BandPixels> bands);
  /// Deletes the file.
  void remove();

 private:
  [[noreturn]] void fail(const std::string& what) const;
  void write(std::span<const std::byte> bytes);
  bool read(std::span<std::byte> bytes);

  std::string path_;
  FileDescriptor file_;
};

}  // namespace scarp::cli
