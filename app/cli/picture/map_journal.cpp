// SPDX-License-Identifier: MIT
#include "app/cli/picture/map_journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "app/cli/picture/check_sum.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

constexpr std::string_view kKind = "scarp resume ", kVersion = "2\n";

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

struct StripHead {
  std::int32_t first, last;
  std::uint64_t totals, bands;
};

struct BandHead {
  std::uint64_t type, bytes;
};

// Some network file systems have no locks.
void require_lock(int file, const std::string& path) {
  if (::flock(file, LOCK_EX | LOCK_NB) == 0) return;
  const int number = errno;
  if (number == EWOULDBLOCK)
    throw Error(fmt::format("{}: is in use by another run (wait for it, or name another output)", path));
  throw Error(fmt::format("{}: cannot be locked: {} (name an output on another file system, or leave out --resume)",
                          path, std::strerror(number)));
}

}  // namespace

FileDescriptor::~FileDescriptor() {
  if (number_ >= 0) ::close(number_);
}

MapJournal::MapJournal(const std::string& output, const std::string& identity)
    : path_(output + ".resume"), file_(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (file_ < 0) fail("cannot be written");
  require_lock(file_, path_);
  const std::string begin = fmt::format("{}{}{}\n{}", kKind, kVersion, identity.size(), identity);
  std::string found(begin.size(), 0);
  const off_t size = ::lseek(file_, 0, SEEK_END);
  ::lseek(file_, 0, SEEK_SET);
  // A run that was killed at once may have written only a part of the beginning.
  const auto length = std::min<std::size_t>(static_cast<std::size_t>(std::max<off_t>(size, 0)), found.size());
  found.resize(length);
  if (!read(std::as_writable_bytes(std::span(found)))) fail("cannot be read");
  if (!begin.starts_with(found)) {
    const bool ours = std::string_view(found).starts_with(kKind);
    throw Error(fmt::format(
        "{}: {} (delete it to begin anew, or name another output)", path_,
        ours ? "was begun by another command, another version or with other inputs" : "is not a file of --resume"));
  }
  if (found.size() == begin.size()) return;
  ::lseek(file_, 0, SEEK_SET);
  write(std::as_bytes(std::span(begin)));
}

void MapJournal::fail(const std::string& what) const {
  const int number = errno;
  throw Error(fmt::format("{}: {}: {}", path_, what, std::strerror(number)));
}

void MapJournal::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("cannot be written");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

// False at the end of the file.
bool MapJournal::read(std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::read(file_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("cannot be read");
    if (count == 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

bool MapJournal::next(JournalStrip& strip) {
  const off_t begin = ::lseek(file_, 0, SEEK_CUR), end = ::lseek(file_, 0, SEEK_END);
  ::lseek(file_, begin, SEEK_SET);
  const auto strip_is_complete = [&] {
    StripHead head{};
    CheckSum sum;
    // The rest of the file bounds all numbers, so that a damaged one allocates no more.
    const auto fits = [rest = static_cast<std::uint64_t>(end - begin)](std::uint64_t count, std::size_t bytes) {
      return count <= rest / bytes;
    };
    const auto take = [&](std::span<std::byte> bytes) {
      if (!read(bytes)) return false;
      sum.add(bytes);
      return true;
    };
    if (!take(std::as_writable_bytes(std::span(&head, 1)))) return false;
    if (!fits(head.totals, sizeof(double)) || !fits(head.bands, sizeof(BandHead))) return false;
    strip.first = head.first, strip.last = head.last;
    strip.totals.resize(head.totals);
    strip.bands.resize(head.bands);
    if (!take(std::as_writable_bytes(std::span(strip.totals)))) return false;
    for (JournalBand& band : strip.bands) {
      BandHead of_band{};
      if (!take(std::as_writable_bytes(std::span(&of_band, 1))) || !fits(of_band.bytes, 1)) return false;
      band.type = of_band.type;
      band.pixels.resize(of_band.bytes);
      if (!take(band.pixels)) return false;
    }
    std::uint64_t stored = 0;
    return read(std::as_writable_bytes(std::span(&stored, 1))) && stored == sum.value();
  };
  if (strip_is_complete()) return true;
  if (::ftruncate(file_, begin) != 0) fail("cannot be written");
  ::lseek(file_, begin, SEEK_SET);
  return false;
}

void MapJournal::append(int first, int last, std::span<const double> totals, std::span<const BandPixels> bands) {
  CheckSum sum;
  const auto put = [&](std::span<const std::byte> bytes) {
    sum.add(bytes);
    write(bytes);
  };
  put(bytes_of(StripHead{first, last, totals.size(), bands.size()}));
  put(std::as_bytes(totals));
  for (const BandPixels& band : bands) {
    put(bytes_of(BandHead{band.type, band.pixels.size()}));
    put(band.pixels);
  }
  write(bytes_of(sum.value()));
  if (::fdatasync(file_) != 0) fail("cannot be written");
}

void MapJournal::remove() { ::unlink(path_.c_str()); }

}  // namespace scarp::cli
