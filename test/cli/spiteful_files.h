// SPDX-License-Identifier: MIT
// Voxel files byte by byte, valid and invalid, made only from the published layouts and not with the readers' own
// writers, which reject invalid data.
//
// Sources: ephtracy/voxel-model (.vox); P. Min, "binvox"; Minddesk, "Qubicle Binary" (.qb); K. Silverman, Voxlap's
// notes on .vox, .kv6 and .vxl.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace scarp::test::spite {

/// The lowest bytes of a number, little-endian.
inline std::string number(std::int64_t value, int bytes = 4) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 255);
  return out;
}

/// Numbers of 4 bytes each.
inline std::string numbers(std::initializer_list<std::int64_t> values) {
  std::string out;
  for (const std::int64_t value : values) out += number(value);
  return out;
}

/// Bytes, each 0 to 255.
inline std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (const int value : values) out += static_cast<char>(value);
  return out;
}

/// Voxels along x, y and z.
using Size = std::array<int, 3>;

// MagicaVoxel

inline std::string chunk(const std::string& name, const std::string& content, const std::string& children = {}) {
  return name + number(static_cast<std::int64_t>(content.size())) + number(static_cast<std::int64_t>(children.size())) +
         content + children;
}

inline std::string vox(const std::string& chunks, int version = 150) {
  return "VOX " + number(version) + chunk("MAIN", {}, chunks);
}

struct Dot {
  int x, y, z, index;
};

/// The red of the default palette.
constexpr int kRed = 216;

inline std::string size_chunk(std::int64_t x, std::int64_t y, std::int64_t z) {
  return chunk("SIZE", numbers({x, y, z}));
}

/// An XYZI chunk that declares `count` voxels, or the true number if `count` is negative.
inline std::string dots_chunk(const std::vector<Dot>& dots, std::int64_t count = -1) {
  std::string content = number(count < 0 ? static_cast<std::int64_t>(dots.size()) : count);
  for (const Dot& dot : dots) content += bytes({dot.x, dot.y, dot.z, dot.index});
  return chunk("XYZI", content);
}

inline std::string model(const Size& size, const std::vector<Dot>& dots) {
  return size_chunk(size[0], size[1], size[2]) + dots_chunk(dots);
}

inline std::vector<Dot> dots_of(const Size& size, int index = kRed) {
  std::vector<Dot> dots;
  for (int z = 0; z < size[2]; ++z) {
    for (int y = 0; y < size[1]; ++y) {
      for (int x = 0; x < size[0]; ++x) dots.push_back({x, y, z, index});
    }
  }
  return dots;
}

/// A solid model.
inline std::string block(const Size& size, int index = kRed) { return model(size, dots_of(size, index)); }

/// A palette chunk: this colour for all indices, as 0xRRGGBB.
inline std::string palette(int rgb, int entries = 256, int alpha = 255) {
  std::string content;
  for (int i = 0; i < entries; ++i) content += bytes({rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255, alpha});
  return chunk("RGBA", content);
}

inline std::string text(std::string_view text) {
  return number(static_cast<std::int64_t>(text.size())) + std::string(text);
}

using Attributes = std::vector<std::pair<std::string, std::string>>;

inline std::string attributes(const Attributes& pairs) {
  std::string out = number(static_cast<std::int64_t>(pairs.size()));
  for (const auto& [name, value] : pairs) out += text(name) + text(value);
  return out;
}

/// A transform with its frames, and its attributes.
inline std::string moved(int id, int child, const std::vector<Attributes>& frames = {{}}, int layer = -1,
                         const Attributes& own = {}) {
  std::string content =
      number(id) + attributes(own) + numbers({child, -1, layer}) + number(static_cast<std::int64_t>(frames.size()));
  for (const Attributes& frame : frames) content += attributes(frame);
  return chunk("nTRN", content);
}

inline std::string group(int id, const std::vector<int>& children) {
  std::string content = number(id) + attributes({}) + number(static_cast<std::int64_t>(children.size()));
  for (const int child : children) content += number(child);
  return chunk("nGRP", content);
}

/// A shape with one model per frame.
inline std::string shape(int id, const std::vector<std::pair<int, Attributes>>& models = {{0, {}}}) {
  std::string content = number(id) + attributes({}) + number(static_cast<std::int64_t>(models.size()));
  for (const auto& [model, frame] : models) content += number(model) + attributes(frame);
  return chunk("nSHP", content);
}

inline std::string layer(int id, const Attributes& own) {
  return chunk("LAYR", number(id) + attributes(own) + number(-1));
}

/// The usual scene: a root, a group, and a transform and a shape of model 0 for each of these frames.
inline std::string placed(const std::vector<Attributes>& places) {
  std::vector<int> children;
  std::string nodes;
  for (const Attributes& place : places) {
    const int id = 2 + 2 * static_cast<int>(children.size());
    children.push_back(id);
    nodes += moved(id, id + 1, {place}) + shape(id + 1);
  }
  return moved(0, 1) + group(1, children) + nodes;
}

// Others

/// A binvox file of these header lines and runs (value, count).
inline std::string binvox(const std::string& header, const std::vector<std::pair<int, int>>& runs) {
  std::string out = "#binvox 1\n" + header + "data\n";
  for (const auto& [value, count] : runs) out += bytes({value, count});
  return out;
}

/// A Qubicle Binary file. `size` may be invalid.
inline std::string qubicle(bool compressed, const std::array<std::int64_t, 3>& size, const std::string& voxels,
                           std::int64_t matrices = 1) {
  return bytes({1, 1, 0, 0}) + numbers({0, 1, compressed ? 1 : 0, 0, matrices}) + bytes({5}) + "stone" +
         numbers({size[0], size[1], size[2], 0, 0, 0}) + voxels;
}

/// This many red voxels of a .qb.
inline std::string qubicle_reds(std::int64_t count) {
  std::string out;
  for (std::int64_t i = 0; i < count; ++i) out += bytes({255, 0, 0, 255});
  return out;
}

/// A .kv6 of a solid block of up to 2 voxels per side, so that all are on its surface; declares `count` of them.
inline std::string kv6(const Size& size, std::int64_t count, int z_step = 1) {
  std::string out = "Kvxl" + numbers({size[0], size[1], size[2], 0, 0, 0, count});
  for (int column = 0; column < size[0] * size[1]; ++column) {
    for (int z = 0; z < size[2]; ++z) out += bytes({0, 0, 255, 128}) + number(z * z_step, 2) + bytes({63, 0});
  }
  for (int x = 0; x < size[0]; ++x) out += number(size[1] * size[2]);
  for (int column = 0; column < size[0] * size[1]; ++column) out += number(size[2], 2);
  return out;
}

/// Columns of a .vxl with one span each: the colours of the voxels from `top` down to `bottom`; everything below is
/// solid.
inline std::string vxl_columns(int columns, int top, int bottom) {
  std::string column = bytes({0, top, bottom, 0});
  for (int z = top; z <= bottom; ++z) column += bytes({0, 0, 255, 128});
  std::string out;
  for (int i = 0; i < columns; ++i) out += column;
  return out;
}

/// The head of Voxlap's own .vxl: a map of side x side columns, and a camera.
inline std::string vxl_head(std::int64_t side) { return numbers({0x09072000, side, side}) + std::string(12 * 8, '\0'); }

}  // namespace scarp::test::spite
