// SPDX-License-Identifier: MIT
// MagicaVoxel's .vox files, versions 150 and 200, as a plain document.
//
//   'VOX ' version
//   MAIN                         all other chunks are its children; a chunk: name, bytes, bytes of children
//     PACK                       number of models (old files with several)
//     SIZE XYZI  ...             a model each: its size, z up, and its voxels (x, y, z, palette index 1..255; 0: empty)
//     nTRN nGRP nSHP  ...        the scene: transforms, groups, shapes (uses of models); see vox_scene.h
//     LAYR  ...                  layers, which may be hidden
//     RGBA                       the palette: entry i is the colour of index i + 1; without it, vox_default_palette()
//     IMAP                       display order of the palette in the editor; does not affect colours
//     MATL  ...                  materials
//     others                     kept unchanged
//
// Numbers are little-endian, 4 bytes. Strings and dictionaries are preceded by their lengths.
//
// Source: ephtracy/voxel-model, "MagicaVoxel .vox file format" and its extension. Malformed files are rejected before
// any allocation: every count is checked against the available bytes.
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

/// A voxel of a model.
struct VoxVoxel {
  std::uint8_t x = 0, y = 0, z = 0;
  std::uint8_t index = 1;  ///< palette index, 1..255; 0: empty
  friend bool operator==(const VoxVoxel&, const VoxVoxel&) = default;
};

/// A model.
struct VoxModel {
  ivec3 size{1};                 ///< each 1..256
  std::vector<VoxVoxel> voxels;  ///< inside `size`; if several have one position, the last one counts
  friend bool operator==(const VoxModel&, const VoxModel&) = default;
};

/// Names and values in file order; see vox_scene.h for the meaning of some.
using VoxAttributes = std::vector<std::pair<std::string, std::string>>;

/// A node that places its child.
struct VoxTransform {
  int child = 0;      ///< node
  int reserved = -1;  ///< always -1
  int layer = -1;     ///< -1: none
  std::vector<VoxAttributes> frames{1};
  friend bool operator==(const VoxTransform&, const VoxTransform&) = default;
};

/// A node with children.
struct VoxGroup {
  std::vector<int> children;  ///< nodes
  friend bool operator==(const VoxGroup&, const VoxGroup&) = default;
};

/// Use of a model in a shape, with attributes.
struct VoxModelUse {
  int model = 0;
  VoxAttributes attributes;
  friend bool operator==(const VoxModelUse&, const VoxModelUse&) = default;
};

/// A node that shows models.
struct VoxShape {
  std::vector<VoxModelUse> models{1};  ///< one per keyframe
  friend bool operator==(const VoxShape&, const VoxShape&) = default;
};

/// A node of the scene.
struct VoxNode {
  int id = 0;
  VoxAttributes attributes;
  std::variant<VoxTransform, VoxGroup, VoxShape> content;
  friend bool operator==(const VoxNode&, const VoxNode&) = default;
};

/// A layer.
struct VoxLayer {
  int id = 0;
  VoxAttributes attributes;
  int reserved = -1;  ///< always -1
  friend bool operator==(const VoxLayer&, const VoxLayer&) = default;
};

/// A material.
struct VoxMaterial {
  int id = 1;                ///< palette index
  VoxAttributes attributes;  ///< _type: _diffuse, _metal, _glass, _emit, ...; _rough, _ior, _emit, ...
  friend bool operator==(const VoxMaterial&, const VoxMaterial&) = default;
};

/// An uninterpreted chunk: rOBJ, rCAM, NOTE, ...
struct VoxChunk {
  std::string name;  ///< 4 bytes
  std::string content;
  std::string children;
  friend bool operator==(const VoxChunk&, const VoxChunk&) = default;
};

/// Red, green, blue, alpha.
using VoxColour = std::array<std::uint8_t, 4>;
/// In file order: entry i is the colour of palette index i + 1; the last entry is unused.
using VoxPalette = std::array<VoxColour, 256>;

/// The document of a .vox file.
struct VoxFile {
  int version = 150;
  bool pack = false;  ///< whether there is a PACK chunk
  std::vector<VoxModel> models;
  std::vector<VoxNode> nodes;  ///< the root is node 0; empty: no scene
  std::vector<VoxLayer> layers;
  std::optional<VoxPalette> palette;
  std::optional<std::array<std::uint8_t, 256>> index_map;
  std::vector<VoxMaterial> materials;
  std::vector<VoxChunk> others;
  friend bool operator==(const VoxFile&, const VoxFile&) = default;

  /// Returns the effective palette.
  const VoxPalette& colours() const;
};

/// Returns the palette of files without RGBA: the levels ff cc 99 66 33 00 of red, green and blue in all combinations,
/// blue fastest, without black, then ten more shades each of red, green, blue and grey.
const VoxPalette& vox_default_palette();

/// Returns the value of the last attribute with this name.
std::optional<std::string_view> find_attribute(const VoxAttributes& attributes, std::string_view name);

/// Throws Error, in one line: not .vox, another version, truncated, inconsistent sizes, voxels outside the model, nodes
/// that are missing, duplicate or contain themselves, missing models, invalid rotations.
VoxFile parse_vox(std::string_view bytes);
/// Parses a file; errors name it.
VoxFile read_vox(const std::string& path);

/// Returns the bytes of a file that parse_vox() maps to the same document. Throws Error for a document that parse_vox()
/// would reject.
std::string vox_bytes(const VoxFile& file);
/// Throws Error if writing fails; then no file is created or changed.
void write_vox(const std::string& path, const VoxFile& file);

}  // namespace scarp
