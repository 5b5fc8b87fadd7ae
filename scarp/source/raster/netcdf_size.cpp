// SPDX-License-Identifier: MIT
#include "scarp/source/raster/netcdf_size.h"

#include <algorithm>
#include <vector>

namespace scarp {
namespace {

constexpr std::uint64_t kStreaming = 0xffffffff;  // unknown number of records
constexpr int kTypeBytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};

// Reads big-endian numbers from the header; `good` becomes false, and stays so, when the bytes run out.
struct NetcdfHeader {
  std::string_view bytes;
  std::size_t at = 0;
  bool good = true;
  bool wide = false;  // version 5: counts have 64 bits

  std::uint64_t number(std::size_t width) {
    if (!good || bytes.size() - at < width) {
      good = false;
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < width; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at++]);
    return value;
  }
  std::uint64_t count() { return number(wide ? 8 : 4); }
  std::uint64_t type_bytes() {
    const std::uint64_t type = number(4);
    good = good && type >= 1 && type < std::size(kTypeBytes);
    return good ? static_cast<std::uint64_t>(kTypeBytes[type]) : 0;
  }
  // Padding to words of 4 bytes.
  void skip(std::uint64_t length) {
    if (!good || length > bytes.size() - at) {
      good = false;
      return;
    }
    at = std::min(bytes.size(), at + static_cast<std::size_t>((length + 3) / 4 * 4));
  }
  void skip_name() { skip(count()); }
  void skip_attributes() {
    number(4);
    for (std::uint64_t n = count(); good && n > 0; --n) {
      skip_name();
      const std::uint64_t width = type_bytes(), values = count();
      skip(values > bytes.size() ? values : values * width);
    }
  }
};

}  // namespace

std::optional<double> netcdf_classic_bytes(std::string_view start) {
  if (start.size() < 4 || start.substr(0, 3) != "CDF" || (start[3] != 1 && start[3] != 2 && start[3] != 5)) return {};
  NetcdfHeader header{start};
  header.at = 4;
  header.wide = start[3] == 5;
  const std::size_t offset_width = start[3] == 1 ? 4 : 8;
  const std::uint64_t records = header.count();

  std::vector<double> extents;
  header.number(4);
  for (std::uint64_t n = header.count(); header.good && n > 0; --n) {
    header.skip_name();
    extents.push_back(static_cast<double>(header.count()));
  }
  header.skip_attributes();

  // In double, which no header, valid or not, can overflow.
  double least = 0, record_bytes = 0, last_record_end = 0;
  header.number(4);
  for (std::uint64_t n = header.count(); header.good && n > 0; --n) {
    header.skip_name();
    double samples = 1;
    bool is_record = false;
    std::uint64_t dimensions = header.count();
    for (std::uint64_t d = 0; header.good && d < dimensions; ++d) {
      const std::uint64_t id = header.count();
      if (id >= extents.size()) return {};
      // The record dimension has no fixed extent and comes first.
      if (d == 0 && extents[id] == 0) {
        is_record = true;
      } else {
        samples *= extents[id];
      }
    }
    header.skip_attributes();
    const double bytes = samples * static_cast<double>(header.type_bytes());
    const auto padded = static_cast<double>(header.count());
    const double end = static_cast<double>(header.number(offset_width)) + bytes;
    if (!header.good) return {};
    if (is_record) {
      record_bytes += padded;
      last_record_end = std::max(last_record_end, end);
    } else if (samples > 0) {
      least = std::max(least, end);
    }
  }
  if (!header.good) return {};
  // A single record variable is not padded: its records may be closer by up to 3 bytes each, which is tolerated.
  if (records != kStreaming && records > 0 && last_record_end > 0) {
    const double between = std::max(0.0, record_bytes - 3) * (static_cast<double>(records) - 1);
    least = std::max(least, last_record_end + between);
  }
  return least;
}

std::optional<double> hdf5_bytes(std::string_view start) {
  // After the signature and the superblock's version: every version contains the size of addresses and the address of
  // the end, both little-endian.
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  constexpr struct { std::size_t address_bytes, end; } kSuperblocks[] = {{13, 40}, {13, 44}, {9, 28}, {9, 28}};
  if (start.substr(0, kSignature.size()) != kSignature || start.size() <= kSignature.size()) return {};
  const auto version = static_cast<unsigned char>(start[kSignature.size()]);
  if (version >= std::size(kSuperblocks)) return {};
  const auto [address_bytes, end] = kSuperblocks[version];
  constexpr std::size_t kAddressBytes = 8;  // as in every file written on current machines
  if (start.size() < end + kAddressBytes || start[address_bytes] != kAddressBytes) return {};
  double bytes = 0;
  for (std::size_t i = kAddressBytes; i-- > 0;) bytes = bytes * 256 + static_cast<unsigned char>(start[end + i]);
  return bytes;
}

}  // namespace scarp
