// SPDX-License-Identifier: MIT
// Reads OpenEXR pictures back, for tests.
#pragma once

#include <ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMatrixAttribute.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace scarp::test {

struct Exr {
  struct Channel {
    Imf::PixelType type;         ///< as stored
    std::vector<double> values;  ///< rows from the top
  };
  int width = 0;
  int height = 0;
  Imf::Compression compression = Imf::NO_COMPRESSION;
  std::map<std::string, Channel> channels;
  std::map<std::string, Imath::M44f> matrices;
};

/// Throws the exceptions of the library.
inline Exr read_exr(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow();
  Exr exr;
  exr.width = window.max.x - window.min.x + 1;
  exr.height = window.max.y - window.min.y + 1;
  exr.compression = header.compression();
  const std::size_t pixels = static_cast<std::size_t>(exr.width) * static_cast<std::size_t>(exr.height);
  const auto width = static_cast<std::size_t>(exr.width);
  // Halves are read as floats; floats and uints have 4 bytes.
  std::map<std::string, std::vector<std::uint32_t>> bits;
  Imf::FrameBuffer buffer;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    std::vector<std::uint32_t>& words = bits[channel.name()];
    words.resize(pixels);
    const Imf::PixelType read_as = channel.channel().type == Imf::UINT ? Imf::UINT : Imf::FLOAT;
    buffer.insert(channel.name(), Imf::Slice(read_as, reinterpret_cast<char*>(words.data()), 4, 4 * width));
    exr.channels[channel.name()].type = channel.channel().type;
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  for (auto& [name, channel] : exr.channels) {
    for (const std::uint32_t word : bits[name]) {
      float number = 0;
      std::memcpy(&number, &word, sizeof number);
      channel.values.push_back(channel.type == Imf::UINT ? double{1} * word : double{number});
    }
  }
  for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
    if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute.attribute())) {
      exr.matrices[attribute.name()] = matrix->value();
    }
  }
  return exr;
}

}  // namespace scarp::test
