// SPDX-License-Identifier: MIT
#include "scarp/output/exr.h"

#include <ImathMatrix.h>
#include <OpenEXR/IexBaseExc.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <set>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// Rows per write call; limits the memory for conversion to half. OpenEXR compresses 16 rows at a time.
constexpr int kRowsAtOnce = 256;

Error cannot_write(const std::string& path, std::string_view why) {
  return Error(fmt::format("{}: cannot be written: {} (is the disk full?)", path, why));
}

void require_good(const std::string& path, const ExrView& picture) {
  const auto require = [&](bool good, std::string_view what) {
    if (!good) throw Error(fmt::format("{}: {}", path, what));
  };
  require(picture.width >= 1 && picture.height >= 1,
          fmt::format("image of {} x {} pixels (at least 1 x 1 required)", picture.width, picture.height));
  require(!picture.channels.empty(), "image has no channels (at least one required)");
  std::set<std::string> names;
  for (const ExrChannel& channel : picture.channels) {
    require(!channel.name.empty() && names.insert(channel.name).second,
            fmt::format("channel name '{}' is empty or repeated (channels need unique names)", channel.name));
    require(
        std::visit([](const auto* data) { return data != nullptr; }, channel.data) && channel.stride >= 1,
        fmt::format("channel '{}' has no data or a stride of {} (at least 1 required)", channel.name, channel.stride));
  }
}

Imf::PixelType type_of(const ExrChannel& channel) {
  if (std::holds_alternative<const std::uint32_t*>(channel.data)) return Imf::UINT;
  return channel.storage == ExrStorage::half ? Imf::HALF : Imf::FLOAT;
}

Imf::Header header_of(const ExrView& picture) {
  Imf::Header header(picture.width, picture.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const ExrChannel& channel : picture.channels) {
    header.channels().insert(channel.name, Imf::Channel(type_of(channel)));
  }
  for (const ExrMatrix& matrix : picture.matrices) {
    Imath::M44f elements;
    std::copy(matrix.elements.begin(), matrix.elements.end(), &elements[0][0]);
    header.insert(matrix.name, Imf::M44fAttribute(elements));
  }
  return header;
}

// A slice that starts at `row`; OpenEXR counts rows of the whole image from the slice's base.
template <class T>
Imf::Slice slice(Imf::PixelType type, const T* first_of_row, int row, int width, int stride) {
  const std::size_t across = sizeof(T) * static_cast<std::size_t>(stride);
  const std::size_t down = across * static_cast<std::size_t>(width);
  // OpenEXR takes char* even for memory that it only reads.
  char* base = reinterpret_cast<char*>(const_cast<T*>(first_of_row));
  return Imf::Slice(type, base - static_cast<std::ptrdiff_t>(down) * row, across, down);
}

void write_rows(Imf::OutputFile& out, const ExrView& picture) {
  std::vector<std::vector<half>> halves(picture.channels.size());
  for (int row = 0; row < picture.height; row += kRowsAtOnce) {
    const int rows = std::min(kRowsAtOnce, picture.height - row);
    const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width);
    const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(picture.width);
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < picture.channels.size(); ++c) {
      const ExrChannel& channel = picture.channels[c];
      const auto stride = static_cast<std::size_t>(channel.stride);
      const Imf::PixelType type = type_of(channel);
      if (type == Imf::HALF) {
        const float* from = std::get<const float*>(channel.data) + first * stride;
        halves[c].resize(count);
        for (std::size_t i = 0; i < count; ++i) halves[c][i] = half(from[i * stride]);
        buffer.insert(channel.name, slice(type, halves[c].data(), row, picture.width, 1));
      } else {
        std::visit(
            [&](const auto* data) {
              buffer.insert(channel.name, slice(type, data + first * stride, row, picture.width, channel.stride));
            },
            channel.data);
      }
    }
    out.setFrameBuffer(buffer);
    out.writePixels(rows);
  }
}

}  // namespace

void write_exr(ReplaceFile& file, const std::string& path, const ExrView& picture) {
  require_good(path, picture);
  // Uses its own stream: OpenEXR writes the line table in a destructor, which swallows errors, and the last bytes reach
  // the disk only when the stream closes.
  std::ofstream stream(file.temporary_path(), std::ios::binary);
  try {
    Imf::StdOFStream whole(stream, file.temporary_path().c_str());
    Imf::OutputFile out(whole, header_of(picture));
    write_rows(out, picture);
  } catch (const Iex::BaseExc& error) {
    throw cannot_write(path, error.what());
  }
  stream.close();
  if (!stream) throw cannot_write(path, "the last bytes are missing");
  file.commit();
}

void write_exr(const std::string& path, const ExrView& picture) {
  ReplaceFile file(path);
  write_exr(file, path, picture);
}

}  // namespace scarp
