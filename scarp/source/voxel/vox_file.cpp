// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/vox_file.h"

#include <fmt/format.h>

#include "scarp/base/error.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/voxel/vox_bytes.h"
#include "scarp/source/voxel/vox_scene.h"
#include "scarp/source/whole_file.h"

namespace scarp {
namespace {

constexpr std::string_view kVoxMagic = "VOX ";
constexpr std::size_t kHeaderBytes = 20;  // up to the children of MAIN
constexpr int kMaxSide = 256;
constexpr std::string_view kSaveAgain = "save it again in MagicaVoxel";

VoxModel parse_size(VoxBytes& bytes) {
  VoxModel model;
  for (int axis = 0; axis < 3; ++axis) model.size[axis] = bytes.number();
  for (int axis = 0; axis < 3; ++axis) {
    if (model.size[axis] < 1 || model.size[axis] > kMaxSide) {
      throw Error(fmt::format("model of {} x {} x {} voxels (each side must be 1 to {})", model.size.x, model.size.y,
                              model.size.z, kMaxSide));
    }
  }
  return model;
}

void parse_voxels(VoxBytes& bytes, VoxModel& model) {
  const auto count = static_cast<std::uint32_t>(bytes.number());
  if (bytes.left() != std::uint64_t{4} * count)
    throw Error(fmt::format("{} voxels need {} bytes instead of {}", count, std::uint64_t{4} * count, bytes.left()));
  model.voxels.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string_view raw = bytes.take(4);
    const VoxVoxel voxel{static_cast<std::uint8_t>(raw[0]), static_cast<std::uint8_t>(raw[1]),
                         static_cast<std::uint8_t>(raw[2]), static_cast<std::uint8_t>(raw[3])};
    if (voxel.x >= model.size.x || voxel.y >= model.size.y || voxel.z >= model.size.z) {
      throw Error(fmt::format("voxel ({}, {}, {}) is outside the model of {} x {} x {}", voxel.x, voxel.y, voxel.z,
                              model.size.x, model.size.y, model.size.z));
    }
    model.voxels.push_back(voxel);
  }
}

VoxTransform parse_transform(VoxBytes& bytes) {
  VoxTransform node;
  node.child = bytes.number();
  node.reserved = bytes.number();
  node.layer = bytes.number();
  const std::size_t count = bytes.count(4);
  if (count == 0) throw Error("transform without frames (at least one required)");
  node.frames.clear();
  for (std::size_t i = 0; i < count; ++i) node.frames.push_back(bytes.attributes());
  return node;
}

VoxGroup parse_group(VoxBytes& bytes) {
  VoxGroup node;
  const std::size_t count = bytes.count(4);
  for (std::size_t i = 0; i < count; ++i) node.children.push_back(bytes.number());
  return node;
}

VoxShape parse_shape(VoxBytes& bytes) {
  VoxShape node;
  const std::size_t count = bytes.count(8);
  if (count == 0) throw Error("shape without models (at least one required)");
  node.models.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const int model = bytes.number();
    node.models.push_back({model, bytes.attributes()});
  }
  return node;
}

// Parses the children of MAIN in order.
class Parser {
 public:
  VoxFile file;

  void chunk(std::string_view name, VoxBytes& bytes) {
    if (model_ && name != "XYZI") throw Error("SIZE without a following XYZI");
    if (name == "PACK") {
      file.pack = true;
      packed_ = bytes.number();
    } else if (name == "SIZE") {
      model_ = parse_size(bytes);
    } else if (name == "XYZI") {
      if (!model_) throw Error("XYZI without a preceding SIZE");
      parse_voxels(bytes, *model_);
      file.models.push_back(std::move(*model_));
      model_.reset();
    } else if (name == "nTRN" || name == "nGRP" || name == "nSHP") {
      VoxNode node;
      node.id = bytes.number();
      node.attributes = bytes.attributes();
      if (name == "nTRN") node.content = parse_transform(bytes);
      if (name == "nGRP") node.content = parse_group(bytes);
      if (name == "nSHP") node.content = parse_shape(bytes);
      file.nodes.push_back(std::move(node));
    } else if (name == "LAYR") {
      VoxLayer layer;
      layer.id = bytes.number();
      layer.attributes = bytes.attributes();
      layer.reserved = bytes.number();
      file.layers.push_back(std::move(layer));
    } else if (name == "RGBA") {
      file.palette.emplace();
      for (VoxColour& colour : *file.palette) {
        for (std::uint8_t& channel : colour) channel = static_cast<std::uint8_t>(bytes.take(1)[0]);
      }
    } else if (name == "IMAP") {
      file.index_map.emplace();
      for (std::uint8_t& index : *file.index_map) index = static_cast<std::uint8_t>(bytes.take(1)[0]);
    } else if (name == "MATL") {
      VoxMaterial material;
      material.id = bytes.number();
      material.attributes = bytes.attributes();
      file.materials.push_back(std::move(material));
    } else {
      return;
    }
    known_ = true;
  }

  // Whether the last chunk was of one of the kinds above.
  bool known() { return std::exchange(known_, false); }

  void finish() const {
    if (model_) throw Error("the last SIZE has no following XYZI");
    if (file.pack && packed_ != static_cast<std::int64_t>(file.models.size()))
      throw Error(fmt::format("PACK states {} models instead of {}", packed_, file.models.size()));
    check_vox_scene(file);
  }

 private:
  std::optional<VoxModel> model_;  // waiting for its XYZI
  int packed_ = 0;
  bool known_ = false;
};

// Returns the version; checks the bytes up to the children of MAIN.
int parse_header(std::string_view bytes, std::uint64_t file_bytes) {
  if (bytes.empty()) throw Error("empty file (0 bytes)");
  refuse_lfs_pointer(bytes);
  if (bytes.substr(0, kVoxMagic.size()) != kVoxMagic) {
    std::string begin;
    for (const char byte : bytes.substr(0, kVoxMagic.size()))
      begin += fmt::format("{}{:02x}", begin.empty() ? "" : " ", static_cast<unsigned char>(byte));
    throw Error(fmt::format("not a MagicaVoxel file: begins with the bytes {} instead of 'VOX '", begin));
  }
  if (bytes.size() < kHeaderBytes)
    throw Error(fmt::format("truncated: {} bytes, but the header alone needs {} ({})", bytes.size(), kHeaderBytes,
                            kFetchAgain));
  VoxBytes header(bytes.substr(kVoxMagic.size()));
  const int version = header.number();
  if (version != 150 && version != 200)
    throw Error(fmt::format("unsupported version {} (supported: 150, 200)", version));
  if (header.take(4) != "MAIN") throw Error(fmt::format("does not begin with the chunk MAIN ({})", kSaveAgain));
  const auto content = static_cast<std::uint32_t>(header.number()),
             children = static_cast<std::uint32_t>(header.number());
  if (std::uint64_t{content} + children > file_bytes - kHeaderBytes) {
    throw Error(fmt::format("truncated: the header states {} bytes, but the file has {} ({})",
                            kHeaderBytes + std::uint64_t{content} + children, file_bytes, kFetchAgain));
  }
  return version;
}

}  // namespace

const VoxPalette& VoxFile::colours() const { return palette ? *palette : vox_default_palette(); }

const VoxPalette& vox_default_palette() {
  static const VoxPalette palette = [] {
    VoxPalette colours{};
    std::size_t count = 0;
    // 255, 204, ..., 0 in red, green, blue; black, which would be last, is not included.
    for (int i = 0; i < 215; ++i, ++count) {
      const auto level = [](int step) { return static_cast<std::uint8_t>(255 - 51 * step); };
      colours[count] = {level(i / 36), level(i / 6 % 6), level(i % 6), 255};
    }
    // Fifteenths of full light that are not fifths: ee dd bb aa 88 77 55 44 22 11.
    for (int channels = 0; channels < 4; ++channels) {
      for (int level = 14; level > 0; --level) {
        if (level % 3 == 0) continue;
        VoxColour& colour = colours[count++];
        colour[3] = 255;
        for (int i = 0; i < 3; ++i) {
          if (channels == 3 || channels == i) colour[i] = static_cast<std::uint8_t>(17 * level);
        }
      }
    }
    return colours;
  }();
  return palette;
}

std::optional<std::string_view> find_attribute(const VoxAttributes& attributes, std::string_view name) {
  std::optional<std::string_view> found;
  for (const auto& [key, value] : attributes) {
    if (key == name) found = value;
  }
  return found;
}

VoxFile parse_vox(std::string_view bytes) {
  Parser parser;
  parser.file.version = parse_header(bytes, bytes.size());
  VoxBytes header(bytes.substr(12));
  const auto content = static_cast<std::uint32_t>(header.number()),
             children = static_cast<std::uint32_t>(header.number());
  VoxBytes rest(bytes.substr(kHeaderBytes + content, children));
  advising(kSaveAgain, [&] {
    while (rest.left() > 0) {
      const std::uint64_t at = kHeaderBytes + std::uint64_t{content} + children - rest.left();
      std::string where = fmt::format("at byte {}", at);
      try {
        const std::string_view name = rest.take(4);
        where = fmt::format("chunk {} {}", printable(name), where);
        const auto own = static_cast<std::uint32_t>(rest.number()), inner = static_cast<std::uint32_t>(rest.number());
        VoxBytes chunk(rest.take(own));
        const std::string_view before = chunk.rest(), below = rest.take(inner);
        parser.chunk(name, chunk);
        if (!parser.known()) {
          parser.file.others.push_back({std::string(name), std::string(before), std::string(below)});
        } else if (chunk.left() > 0 || !below.empty()) {
          throw Error(fmt::format("{} bytes too many", chunk.left() + below.size()));
        }
      } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", where, error.what()));
      }
    }
    parser.finish();
  });
  return std::move(parser.file);
}

VoxFile read_vox(const std::string& path) {
  try {
    return parse_vox(whole_file(path, [](std::string_view first, std::uint64_t size) {
      parse_header(first, size);
      return true;
    }));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

void write_vox(const std::string& path, const VoxFile& file) { write_whole_file(path, vox_bytes(file)); }

}  // namespace scarp
