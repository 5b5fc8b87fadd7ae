// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/dense_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>
#include <type_traits>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/source/mapped_file.h"
#include "scarp/source/npy_header.h"
#include "scarp/source/raster/raw_format.h"

namespace scarp {
namespace {

constexpr std::string_view kNpy = "npy";

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

template <class Number, bool swapped>
double number(const char* at) {
  using Bits =
      std::conditional_t<sizeof(Number) == 8, std::uint64_t,
                         std::conditional_t<sizeof(Number) == 4, std::uint32_t,
                                            std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint8_t>>>;
  Bits bits;
  std::memcpy(&bits, at, sizeof(bits));
  if constexpr (swapped) {
    Bits turned = 0;
    for (std::size_t i = 0; i < sizeof(bits); ++i)
      turned = static_cast<Bits>(turned | ((bits >> (8 * i) & 255) << (8 * (sizeof(bits) - 1 - i))));
    bits = turned;
  }
  return static_cast<double>(std::bit_cast<Number>(bits));
}

// Samples in memory: the first one, and the distance in bytes from one to the next along each axis of a brick.
struct Samples {
  const char* first;
  std::array<std::ptrdiff_t, 3> apart;
  ivec3 count;
  bool swapped;
};

template <class Number>
void convert(const Samples& samples, std::span<double, 64> numbers) {
  const auto all = [&]<bool swapped>(auto count, auto apart) {
    for (int z = 0; z < samples.count.z; ++z) {
      for (int y = 0; y < samples.count.y; ++y) {
        const char* at = samples.first + y * samples.apart[1] + z * samples.apart[2];
        double* to = numbers.data() + 4 * y + 16 * z;
        for (int x = 0; x < count; ++x) to[x] = number<Number, swapped>(at + x * apart);
      }
    }
  };
  const auto rows = [&]<bool swapped>() {
    constexpr std::ptrdiff_t kAdjacent = sizeof(Number);
    // Applies to nearly all rows; constants let the compiler use vectors.
    if (samples.count.x == 4 && samples.apart[0] == kAdjacent) {
      all.template operator()<swapped>(std::integral_constant<int, 4>(),
                                       std::integral_constant<std::ptrdiff_t, kAdjacent>());
    } else {
      all.template operator()<swapped>(samples.count.x, samples.apart[0]);
    }
  };
  samples.swapped ? rows.template operator()<true>() : rows.template operator()<false>();
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

DenseVolume::DenseVolume(const VolumeFormat& format, std::shared_ptr<const void> owner, std::string_view bytes)
    : format_(format), owner_(std::move(owner)), bytes_(bytes) {
  require_length(format, bytes_.size());
  const auto x = static_cast<std::size_t>(format.size.x), y = static_cast<std::size_t>(format.size.y),
             z = static_cast<std::size_t>(format.size.z), one = static_cast<std::size_t>(format.bytes);
  stride_ = format.z_fastest ? std::array{one * z * y, one * z, one} : std::array{one, one * x, one * x * y};
}

DenseVolume::DenseVolume(const VolumeFormat& format, std::string bytes)
    : DenseVolume(format, std::make_shared<const std::string>(std::move(bytes))) {}

DenseVolume::DenseVolume(const VolumeFormat& format, const std::shared_ptr<const std::string>& bytes)
    : DenseVolume(format, bytes, *bytes) {}

DenseVolume DenseVolume::in_file(const VolumeFormat& format, const std::string& path) {
  const auto file = std::make_shared<const MappedFile>(path);
  return {format, file, file->bytes()};
}

double DenseVolume::operator[](const ivec3& voxel) const {
  std::array<double, 64> numbers;
  brick(voxel, {}, ivec3(1), numbers);
  return numbers[0];
}

void DenseVolume::brick(const ivec3& from, const std::array<ivec3, 3>& step, const ivec3& count,
                        std::span<double, 64> numbers) const {
  const auto bytes_to = [&](const ivec3& v) {
    std::ptrdiff_t bytes = 0;
    for (int axis = 0; axis < 3; ++axis)
      bytes += v[axis] * static_cast<std::ptrdiff_t>(stride_[static_cast<std::size_t>(axis)]);
    return bytes;
  };
  const Samples samples{bytes_.data() + format_.offset + bytes_to(from),
                        {bytes_to(step[0]), bytes_to(step[1]), bytes_to(step[2])},
                        count,
                        format_.bytes > 1 && format_.big_endian != (std::endian::native == std::endian::big)};
  switch (format_.kind == 'f' ? 16 + format_.bytes : format_.kind == 'i' ? 8 + format_.bytes : format_.bytes) {
    case 1:
      return convert<std::uint8_t>(samples, numbers);
    case 2:
      return convert<std::uint16_t>(samples, numbers);
    case 4:
      return convert<std::uint32_t>(samples, numbers);
    case 8:
      return convert<std::uint64_t>(samples, numbers);
    case 9:
      return convert<std::int8_t>(samples, numbers);
    case 10:
      return convert<std::int16_t>(samples, numbers);
    case 12:
      return convert<std::int32_t>(samples, numbers);
    case 16:
      return convert<std::int64_t>(samples, numbers);
    case 20:
      return convert<float>(samples, numbers);
    default:
      return convert<double>(samples, numbers);
  }
}

VolumeFormat volume_format_of(const std::string& path, const std::string& text) {
  const std::optional<VolumeFormat> said = text == kNpy ? std::nullopt : std::optional(parse_volume_format(text));
  try {
    std::ifstream in(path, std::ios::binary | std::ios::ate);
    if (!in) throw Error("cannot be opened");
    const std::streamoff length = in.tellg();
    if (length < 0) throw Error("cannot be read (is it a file?)");
    if (said) {
      require_length(*said, static_cast<std::uint64_t>(length));
      return *said;
    }
    std::string start;
    const auto read_first = [&](std::uint64_t count) {
      start.resize(std::min(count, static_cast<std::uint64_t>(length)));
      in.seekg(0);
      in.read(start.data(), static_cast<std::streamsize>(start.size()));
      if (!in) throw Error("cannot be read (is it a file?)");
    };
    read_first(kNpyPreambleBytes);
    read_first(static_cast<std::uint64_t>(npy_data_begin(start)));
    const VolumeFormat format = npy_volume_format(start);
    require_length(format, static_cast<std::uint64_t>(length));
    return format;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

DenseVolume read_volume(const std::string& path, const std::string& text) {
  const VolumeFormat format = volume_format_of(path, text);
  try {
    return DenseVolume::in_file(format, path);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace scarp
