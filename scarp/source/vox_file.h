// SPDX-License-Identifier: MIT
// MagicaVoxel's .vox files, versions 150 and 200, as a plain document.
//
//   'VOX ' version
//   MAIN                         all other chunks are its children; a chunk: name, bytes, bytes of children
//     PACK                       number of models (old files with several)
//     SIZE XYZI  ...             a model each: its size, z up, and its solid voxels (x, y, z, palette index 1..255)
//     nTRN nGRP nSHP  ...        the scene: transforms, groups, shapes (uses of models); see vox_scene.h
//     LAYR  ...                  layers, which may be hidden
//     RGBA                       the palette: entry i is the colour of index i + 1; without it, vox_default_palette()
//     IMAP                       in which order the palette is shown by the editor; colours do not depend on it
//     MATL  ...                  materials
//     others                     kept as they are
//
// Numbers are little-endian, 4 bytes. Texts and dictionaries of texts have their lengths before them.
//
// Source: ephtracy/voxel-model, "MagicaVoxel .vox file format" and its extension. Hostile files are refused before
// anything is allocated that they ask for: every count is checked against the bytes that are there.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

struct VoxVoxel {
  std::uint8_t x = 0, y = 0, z = 0;
  std::uint8_t index = 1;  ///< of the palette, 1..255
  friend bool operator==(const VoxVoxel&, const VoxVoxel&) = default;
};

struct VoxModel {
  ivec3 size{1};                 ///< each 1..256
  std::vector<VoxVoxel> voxels;  ///< inside of the size; of several in one place the last counts
  friend bool operator==(const VoxModel&, const VoxModel&) = default;
};

/// Names and values in the file's order; see vox_scene.h for what some mean.
using VoxAttributes = std::vector<std::pair<std::string, std::string>>;

struct VoxTransform {
  int child = 0;      ///< node
  int reserved = -1;  ///< always -1
  int layer = -1;     ///< -1: none
  std::vector<VoxAttributes> frames{1};
  friend bool operator==(const VoxTransform&, const VoxTransform&) = default;
};

struct VoxGroup {
  std::vector<int> children;  ///< nodes
  friend bool operator==(const VoxGroup&, const VoxGroup&) = default;
};

struct VoxModelUse {
  int model = 0;
  VoxAttributes attributes;
  friend bool operator==(const VoxModelUse&, const VoxModelUse&) = default;
};

struct VoxShape {
  std::vector<VoxModelUse> models{1};  ///< one per frame
  friend bool operator==(const VoxShape&, const VoxShape&) = default;
};

struct VoxNode {
  int id = 0;
  VoxAttributes attributes;
  std::variant<VoxTransform, VoxGroup, VoxShape> content;
  friend bool operator==(const VoxNode&, const VoxNode&) = default;
};

struct VoxLayer {
  int id = 0;
  VoxAttributes attributes;
  int reserved = -1;  ///< always -1
  friend bool operator==(const VoxLayer&, const VoxLayer&) = default;
};

struct VoxMaterial {
  int id = 1;                ///< palette index
  VoxAttributes attributes;  ///< _type: _diffuse, _metal, _glass, _emit, ...; _rough, _ior, _emit, ...
  friend bool operator==(const VoxMaterial&, const VoxMaterial&) = default;
};

/// A chunk that is not looked into: rOBJ, rCAM, NOTE, ...
struct VoxChunk {
  std::string name;  ///< 4 bytes
  std::string content;
  std::string children;
  friend bool operator==(const VoxChunk&, const VoxChunk&) = default;
};

/// Red, green, blue, alpha.
using VoxColour = std::array<std::uint8_t, 4>;
/// As in the file: entry i is the colour of palette index i + 1; the last one belongs to none.
using VoxPalette = std::array<VoxColour, 256>;

struct VoxFile {
  int version = 150;
  bool pack = false;  ///< whether there is a chunk PACK
  std::vector<VoxModel> models;
  std::vector<VoxNode> nodes;  ///< the first one is the root; none: models stand by themselves
  std::vector<VoxLayer> layers;
  std::optional<VoxPalette> palette;
  std::optional<std::array<std::uint8_t, 256>> index_map;
  std::vector<VoxMaterial> materials;
  std::vector<VoxChunk> others;
  friend bool operator==(const VoxFile&, const VoxFile&) = default;

  /// The palette that applies.
  const VoxPalette& colours() const;
};

/// What files without RGBA mean: the levels ff cc 99 66 33 00 of red, green and blue in all combinations, blue fastest,
/// without black, then ten more shades of red, green, blue and grey each.
const VoxPalette& vox_default_palette();

/// The value of the last attribute with this name.
std::optional<std::string_view> find_attribute(const VoxAttributes& attributes, std::string_view name);

/// Throws Error, in one line: no .vox, another version, cut off, sizes that do not fit, voxels out of place or of index
/// 0, nodes that do not exist, are not unique or contain themselves, models that do not exist, rotations that are none.
VoxFile parse_vox(std::string_view bytes);
/// The same from a file; names it in messages.
VoxFile read_vox(const std::string& path);

/// The bytes of a file from which parse_vox() makes the same document. Throws Error where the document is none that
/// parse_vox() takes.
std::string vox_bytes(const VoxFile& file);
/// Throws Error when it cannot be written; then nothing is left or changed.
void write_vox(const std::string& path, const VoxFile& file);

}  // namespace scarp
