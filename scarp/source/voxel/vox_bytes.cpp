// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/vox_bytes.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <type_traits>

#include "scarp/base/error.h"
#include "scarp/source/incomplete_file.h"

namespace scarp {

std::string_view VoxBytes::take(std::size_t count) {
  if (count > rest_.size())
    throw Error(fmt::format("truncated: {} bytes required, {} left ({})", count, rest_.size(), kFetchAgain));
  const std::string_view taken = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return taken;
}

std::int32_t VoxBytes::number() {
  const std::string_view raw = take(4);
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(raw[i]);
  return static_cast<std::int32_t>(value);
}

std::size_t VoxBytes::count(std::size_t least_bytes) {
  const auto count = static_cast<std::uint32_t>(number());
  if (count > rest_.size() / least_bytes)
    throw Error(fmt::format("truncated: {} entries need at least {} bytes, {} left ({})", count,
                            std::uint64_t{count} * least_bytes, rest_.size(), kFetchAgain));
  return count;
}

std::string VoxBytes::text() { return std::string(take(count(1))); }

VoxAttributes VoxBytes::attributes() {
  VoxAttributes attributes;
  const std::size_t pairs = count(8);
  for (std::size_t i = 0; i < pairs; ++i) {
    std::string name = text();
    attributes.emplace_back(std::move(name), text());
  }
  return attributes;
}

std::string printable(std::string_view bytes) {
  constexpr std::size_t kMost = 24;
  std::string text = "'";
  for (const char byte : bytes.substr(0, kMost)) text += byte >= ' ' && byte <= '~' ? byte : '.';
  return text + (bytes.size() > kMost ? "...'" : "'");
}

int whole_number(std::string_view text, std::string_view what) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(fmt::format("{} is {} (expected an integer)", what, printable(text)));
  return value;
}

namespace {

void put(std::string& out, std::int32_t number) {
  for (int i = 0; i < 4; ++i) out += static_cast<char>(static_cast<std::uint32_t>(number) >> (8 * i) & 255);
}

void put_count(std::string& out, std::size_t count) {
  if (count > std::numeric_limits<std::uint32_t>::max()) throw Error("vox: cannot write more than 2^32 entries");
  put(out, static_cast<std::int32_t>(static_cast<std::uint32_t>(count)));
}

void put(std::string& out, const std::string& text) {
  put_count(out, text.size());
  out += text;
}

void put(std::string& out, const VoxAttributes& attributes) {
  put_count(out, attributes.size());
  for (const auto& [name, value] : attributes) {
    put(out, name);
    put(out, value);
  }
}

void put_chunk(std::string& out, std::string_view name, std::string_view content, std::string_view children = {}) {
  out += name;
  put_count(out, content.size());
  put_count(out, children.size());
  out += content;
  out += children;
}

void put_node(std::string& out, const VoxNode& node) {
  std::string content;
  put(content, node.id);
  put(content, node.attributes);
  if (const auto* transform = std::get_if<VoxTransform>(&node.content)) {
    put(content, transform->child);
    put(content, transform->reserved);
    put(content, transform->layer);
    put_count(content, transform->frames.size());
    for (const VoxAttributes& frame : transform->frames) put(content, frame);
    put_chunk(out, "nTRN", content);
  } else if (const auto* group = std::get_if<VoxGroup>(&node.content)) {
    put_count(content, group->children.size());
    for (const int child : group->children) put(content, child);
    put_chunk(out, "nGRP", content);
  } else if (const auto* shape = std::get_if<VoxShape>(&node.content)) {
    put_count(content, shape->models.size());
    for (const VoxModelUse& use : shape->models) {
      put(content, use.model);
      put(content, use.attributes);
    }
    put_chunk(out, "nSHP", content);
  }
}

void put_model(std::string& out, const VoxModel& model) {
  std::string content;
  for (int axis = 0; axis < 3; ++axis) put(content, model.size[axis]);
  put_chunk(out, "SIZE", content);
  content.clear();
  put_count(content, model.voxels.size());
  for (const VoxVoxel& voxel : model.voxels) {
    for (const std::uint8_t byte : {voxel.x, voxel.y, voxel.z, voxel.index}) content += static_cast<char>(byte);
  }
  put_chunk(out, "XYZI", content);
}

}  // namespace

std::string vox_bytes(const VoxFile& file) {
  std::string chunks, content;
  if (file.pack) {
    put_count(content, file.models.size());
    put_chunk(chunks, "PACK", content);
  }
  for (const VoxModel& model : file.models) put_model(chunks, model);
  for (const VoxNode& node : file.nodes) put_node(chunks, node);
  for (const VoxLayer& layer : file.layers) {
    content.clear();
    put(content, layer.id);
    put(content, layer.attributes);
    put(content, layer.reserved);
    put_chunk(chunks, "LAYR", content);
  }
  if (file.palette) {
    content.clear();
    for (const VoxColour& colour : *file.palette) {
      for (const std::uint8_t channel : colour) content += static_cast<char>(channel);
    }
    put_chunk(chunks, "RGBA", content);
  }
  if (file.index_map) put_chunk(chunks, "IMAP", {reinterpret_cast<const char*>(file.index_map->data()), 256});
  for (const VoxMaterial& material : file.materials) {
    content.clear();
    put(content, material.id);
    put(content, material.attributes);
    put_chunk(chunks, "MATL", content);
  }
  for (const VoxChunk& chunk : file.others) {
    if (chunk.name.size() != 4) throw Error("vox: chunk names must have 4 bytes");
    put_chunk(chunks, chunk.name, chunk.content, chunk.children);
  }
  std::string out = "VOX ";
  put(out, file.version);
  put_chunk(out, "MAIN", {}, chunks);
  // Rejects documents that cannot be read back.
  if (!(parse_vox(out) == file))
    throw Error("vox: the document contains data that the file cannot store (remove unused entries)");
  return out;
}

}  // namespace scarp
