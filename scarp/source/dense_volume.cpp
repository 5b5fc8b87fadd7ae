// SPDX-License-Identifier: MIT
#include "scarp/source/dense_volume.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/source/npy_header.h"
#include "scarp/source/raw_format.h"
#include "scarp/source/whole_file.h"

namespace scarp {
namespace {

constexpr std::string_view kNpy = "npy", kNpyMagic = "\x93NUMPY";

bool parse(std::string_view text, VolumeFormat& format) {
  int x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc() || end == text.data() + text.size() || *end != 'x') return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()) + 1);
  try {
    const RawFormat slice = parse_raw_format(text);
    format = {
        {x, slice.cols, slice.rows}, slice.kind, slice.bytes, slice.big_endian, false, slice.offset, slice.has_offset};
  } catch (const Error&) {
    return false;
  }
  return x >= 1 && x <= kMaxVolumeSide && format.size.y <= kMaxVolumeSide && format.size.z <= kMaxVolumeSide;
}

std::uint64_t needed_bytes(const VolumeFormat& format) {
  return static_cast<std::uint64_t>(format.size.x) * static_cast<std::uint64_t>(format.size.y) *
             static_cast<std::uint64_t>(format.size.z) * static_cast<std::uint64_t>(format.bytes) +
         static_cast<std::uint64_t>(format.offset);
}

void require_length(const VolumeFormat& format, std::uint64_t bytes) {
  const std::uint64_t needed = needed_bytes(format);
  if (bytes >= needed && (bytes == needed || format.may_go_on)) return;
  throw Error(fmt::format("{} bytes, but {} x {} x {} samples of {} bytes{} need {}", bytes, format.size.x,
                          format.size.y, format.size.z, format.bytes,
                          format.offset > 0 ? fmt::format(" at offset {}", format.offset) : "", needed));
}

template <class Number>
double number(std::uint64_t bits) {
  if constexpr (sizeof(Number) == 8)
    return static_cast<double>(std::bit_cast<Number>(bits));
  else if constexpr (sizeof(Number) == 4)
    return std::bit_cast<Number>(static_cast<std::uint32_t>(bits));
  else if constexpr (sizeof(Number) == 2)
    return std::bit_cast<Number>(static_cast<std::uint16_t>(bits));
  else
    return std::bit_cast<Number>(static_cast<std::uint8_t>(bits));
}

}  // namespace

VolumeFormat parse_volume_format(std::string_view text) {
  VolumeFormat format;
  if (!parse(text, format)) {
    throw Error(
        fmt::format("volume format '{}': expected npy, or NXxNYxNZ:TYPE[+OFFSET], sides 1 to {}, TYPE one of u8 i8 u16 "
                    "i16 u32 i32 f32 f64 followed by le or be, for example 256x256x128:u16le",
                    text, kMaxVolumeSide));
  }
  return format;
}

VolumeFormat npy_volume_format(std::string_view bytes) {
  const NpyHeader header = parse_npy_header(bytes);
  if (header.shape.size() != 3)
    throw Error(fmt::format("array of {} dimensions (a volume needs 3, [z][y][x])", header.shape.size()));
  const bool sized = header.bytes == 1 || header.bytes == 2 || header.bytes == 4 || header.bytes == 8;
  const bool is_float = header.kind == 'f' && header.bytes >= 4;
  const bool is_whole = header.kind == 'i' || header.kind == 'u' || header.kind == 'b';
  if (!sized || !(is_float || is_whole))
    throw Error(fmt::format("samples of type '{}' (a volume needs integers or floats)", header.descr));
  for (const std::int64_t side : header.shape) {
    if (side < 1 || side > kMaxVolumeSide)
      throw Error(fmt::format("volume of {} x {} x {} voxels (sides must be 1 to {})", header.shape[2], header.shape[1],
                              header.shape[0], kMaxVolumeSide));
  }
  return {{header.shape[2], header.shape[1], header.shape[0]},
          header.kind == 'b' ? 'u' : header.kind,
          header.bytes,
          header.big_endian,
          header.fortran_order,
          header.data_begin,
          true};
}

DenseVolume::DenseVolume(const VolumeFormat& format, std::string bytes) : format_(format), bytes_(std::move(bytes)) {
  require_length(format, bytes_.size());
  const auto x = static_cast<std::size_t>(format.size.x), y = static_cast<std::size_t>(format.size.y),
             z = static_cast<std::size_t>(format.size.z), one = static_cast<std::size_t>(format.bytes);
  stride_ = format.z_fastest ? std::array{one * z * y, one * z, one} : std::array{one, one * x, one * x * y};
}

double DenseVolume::operator[](const ivec3& voxel) const {
  const char* at = bytes_.data() + format_.offset + static_cast<std::size_t>(voxel.x) * stride_[0] +
                   static_cast<std::size_t>(voxel.y) * stride_[1] + static_cast<std::size_t>(voxel.z) * stride_[2];
  std::uint64_t bits = 0;
  for (int i = 0; i < format_.bytes; ++i) {
    const int place = format_.big_endian ? i : format_.bytes - 1 - i;
    bits = bits << 8 | static_cast<std::uint8_t>(at[place]);
  }
  switch (format_.kind == 'f' ? 16 + format_.bytes : format_.kind == 'i' ? 8 + format_.bytes : format_.bytes) {
    case 9:
      return number<std::int8_t>(bits);
    case 10:
      return number<std::int16_t>(bits);
    case 12:
      return number<std::int32_t>(bits);
    case 16:
      return number<std::int64_t>(bits);
    case 20:
      return number<float>(bits);
    case 24:
      return number<double>(bits);
    default:
      return static_cast<double>(bits);
  }
}

DenseVolume read_volume(const std::string& path, const std::string& text) {
  const std::optional<VolumeFormat> said = text == kNpy ? std::nullopt : std::optional(parse_volume_format(text));
  try {
    if (!said) {
      std::string bytes = whole_file(path, kNpyMagic);
      const VolumeFormat format = npy_volume_format(bytes);
      return {format, std::move(bytes)};
    }
    const VolumeFormat& format = *said;
    std::error_code error;
    const std::uintmax_t length = std::filesystem::file_size(path, error);
    if (!error) require_length(format, length);
    return {format, whole_file(path, std::string_view())};
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace scarp
