// SPDX-License-Identifier: MIT
// The module that contains OpenVDB and NanoVDB. NanoVDB grids are first converted to OpenVDB grids, so that the same
// code reads both.
#include "scarp/source/voxel/vdb_module.h"

#include <fmt/format.h>

// Needed by NanoVDB's headers, which do not include it.
#include <iostream>
#define NANOVDB_USE_OPENVDB
#define NANOVDB_USE_ZIP
#define NANOVDB_USE_BLOSC
#include <nanovdb/util/GridValidator.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/NanoToOpenVDB.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <utility>

#include "scarp/base/file_name.h"

namespace scarp {
namespace {

using Grid = openvdb::GridBase::ConstPtr;

constexpr int kLeaf = 8, kLeafVoxels = kLeaf * kLeaf * kLeaf;

// Error message about a file, for users.
struct Refused : std::runtime_error {
  using runtime_error::runtime_error;
};

// The position of a leaf's voxel in the leaf's bricks: in OpenVDB, z varies fastest.
struct Place {
  std::size_t brick;
  int bit;
};
Place place_of(int n) {
  const int x = n >> 6, y = n >> 3 & 7, z = n & 7;
  return {static_cast<std::size_t>((x >> 2) | (y >> 2) << 1 | (z >> 2) << 2), (x & 3) | (y & 3) << 2 | (z & 3) << 4};
}
int offset_of(std::size_t brick, int bit) {
  const int b = static_cast<int>(brick);
  const int x = (b & 1) << 2 | (bit & 3), y = (b >> 1 & 1) << 2 | (bit >> 2 & 3), z = (b >> 2) << 2 | bit >> 4;
  return x << 6 | y << 3 | z;
}

ivec3 vector_of(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

// The bounding box so far.
class Box {
 public:
  void add(const ivec3& low, int side) {
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = std::min<std::int64_t>(low_[axis], low[axis]);
      high_[axis] = std::max<std::int64_t>(high_[axis], std::int64_t{low[axis]} + side);
      // Leaves extend beyond their solid voxels, by less than two leaves.
      const std::int64_t voxels = high_[axis] - low_[axis];
      if (voxels >= kMaxVdbSide + 2 * kLeaf)
        throw Refused(fmt::format("its grid has {} voxels along {} (limited to {})", voxels, "xyz"[axis], kMaxVdbSide));
    }
  }

 private:
  std::int64_t low_[3] = {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max(),
                          std::numeric_limits<std::int64_t>::max()};
  std::int64_t high_[3] = {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::min(),
                           std::numeric_limits<std::int64_t>::min()};
};

// solid(number, active) is called for a voxel, or for all voxels of a tile at once.
template <class TypedGrid, class Solid>
void read_solid(const TypedGrid& grid, const Solid& solid, VdbVoxels& voxels) {
  Box box;
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    VdbLeaf found{vector_of(leaf->origin()), {}};
    std::uint64_t any = 0;
    for (int n = 0; n < kLeafVoxels; ++n) {
      const auto offset = static_cast<openvdb::Index>(n);
      if (!solid(leaf->getValue(offset), leaf->isValueOn(offset))) continue;
      const Place place = place_of(n);
      any |= found.solid[place.brick] |= std::uint64_t{1} << place.bit;
    }
    if (any == 0) continue;
    box.add(found.low, kLeaf);
    voxels.leaves.push_back(found);
  }
  auto tile = grid.tree().cbeginValueAll();
  tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    if (!solid(tile.getValue(), tile.isValueOn())) continue;
    openvdb::CoordBBox where;
    tile.getBoundingBox(where);
    const VdbTile found{vector_of(where.min()), where.dim().x()};
    box.add(found.low, found.side);
    voxels.tiles.push_back(found);
  }
}

template <class TypedGrid>
bool read_level_set(const Grid& grid, VdbVoxels& voxels) {
  const auto typed = openvdb::gridConstPtrCast<TypedGrid>(grid);
  if (!typed || grid->getGridClass() != openvdb::GRID_LEVEL_SET) return false;
  voxels.kind = "level set";
  read_solid(
      *typed, [](auto number, bool) { return number < 0; }, voxels);
  return true;
}

template <class TypedGrid>
bool read_active(const Grid& grid, const char* kind, VdbVoxels& voxels) {
  const auto typed = openvdb::gridConstPtrCast<TypedGrid>(grid);
  if (!typed) return false;
  voxels.kind = kind;
  read_solid(
      *typed, [](const auto&, bool active) { return active; }, voxels);
  return true;
}

bool read_shape(const Grid& grid, VdbVoxels& voxels) {
  return read_level_set<openvdb::FloatGrid>(grid, voxels) || read_level_set<openvdb::DoubleGrid>(grid, voxels) ||
         read_active<openvdb::BoolGrid>(grid, "bool grid", voxels) ||
         read_active<openvdb::MaskGrid>(grid, "mask grid", voxels);
}

std::uint8_t srgb_byte(float linear) {
  const double c = std::clamp(std::isnan(linear) ? 0.0 : double{linear}, 0.0, 1.0);
  return static_cast<std::uint8_t>(
      std::lround(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055)));
}

void read_colours(const openvdb::Vec3SGrid& grid, VdbVoxels& voxels) {
  const auto accessor = grid.getConstAccessor();
  for (const VdbLeaf& leaf : voxels.leaves) {
    for (std::size_t brick = 0; brick < leaf.solid.size(); ++brick) {
      for (std::uint64_t rest = leaf.solid[brick]; rest != 0; rest &= rest - 1) {
        const int n = offset_of(brick, __builtin_ctzll(rest));
        const openvdb::Vec3s c =
            accessor.getValue(openvdb::Coord(leaf.low.x + (n >> 6), leaf.low.y + (n >> 3 & 7), leaf.low.z + (n & 7)));
        voxels.colours.push_back({srgb_byte(c[0]), srgb_byte(c[1]), srgb_byte(c[2])});
      }
    }
  }
}

// Voxels must be cubes, possibly rotated.
void read_place(const Grid& grid, VdbVoxels& voxels) {
  const openvdb::math::Transform& transform = grid->transform();
  constexpr double kCube = 1e-5;  // relative; files hold floats
  openvdb::math::Mat4d affine = openvdb::math::Mat4d::zero();
  if (transform.isLinear()) affine = transform.baseMap()->getAffineMap()->getMat4();
  // OpenVDB multiplies row vectors: the rows are the images of the axes.
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 3; ++i) voxels.world_from_index[axis][i] = affine[axis][i];
    voxels.origin[axis] = affine[3][axis];
  }
  const auto& m = voxels.world_from_index;
  const double square = dot(m[0], m[0]);
  bool cubes = std::isfinite(square) && square > 0;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) cubes = cubes && std::abs(dot(m[a], m[b]) - (a == b ? square : 0)) <= kCube * square;
  }
  if (!cubes) throw Refused(fmt::format("grid '{}': its voxels are not cubes (resample it)", grid->getName()));
}

std::string text_of(const Grid& grid) {
  const std::string type = grid->valueType();
  return grid->getGridClass() == openvdb::GRID_FOG_VOLUME ? fmt::format("a fog volume of type {}", type)
                                                          : fmt::format("of type {}, not a level set", type);
}

void take(const std::vector<Grid>& grids, VdbVoxels& voxels) {
  if (grids.empty()) throw Refused("contains no grid");
  Grid shape, colours;
  for (const Grid& grid : grids) {
    if (!colours && openvdb::gridConstPtrCast<openvdb::Vec3SGrid>(grid)) colours = grid;
    if (!shape && read_shape(grid, voxels)) shape = grid;
  }
  if (!shape && colours && read_active<openvdb::Vec3SGrid>(colours, "Vec3 grid", voxels)) shape = colours;
  if (!shape) {
    throw Refused(fmt::format("grid '{}' is {} (level sets, bool, mask and Vec3 grids have voxels)",
                              grids.front()->getName(), text_of(grids.front())));
  }
  voxels.grid = shape->getName();
  read_place(shape, voxels);
  if (colours && colours->transform() == shape->transform())
    read_colours(*openvdb::gridConstPtrCast<openvdb::Vec3SGrid>(colours), voxels);
  for (const Grid& grid : grids) {
    if (grid == shape || (grid == colours && !voxels.colours.empty())) continue;
    voxels.notes.push_back(fmt::format("grid '{}' is not used", grid->getName()));
  }
}

template <class Number>
Grid converted(const nanovdb::GridHandle<nanovdb::HostBuffer>& handle) {
  const auto* grid = handle.grid<Number>();
  if (!grid || !nanovdb::isValid(*grid, true)) throw Refused("damaged NanoVDB grid");
  return nanovdb::nanoToOpenVDB(*grid);
}

Grid grid_of(const nanovdb::GridHandle<nanovdb::HostBuffer>& handle) {
  switch (handle.gridMetaData()->gridType()) {
    case nanovdb::GridType::Float:
      return converted<float>(handle);
    case nanovdb::GridType::Double:
      return converted<double>(handle);
    case nanovdb::GridType::Boolean:
      return converted<bool>(handle);
    case nanovdb::GridType::Mask:
      return converted<nanovdb::ValueMask>(handle);
    case nanovdb::GridType::Vec3f:
      return converted<nanovdb::Vec3f>(handle);
    default:
      throw Refused(fmt::format("grid '{}' is of type {} (level sets, bool, mask and Vec3 grids have voxels)",
                                handle.gridMetaData()->shortGridName(),
                                nanovdb::toStr(handle.gridMetaData()->gridType())));
  }
}

std::vector<Grid> grids_of(const std::string& path, VdbVoxels& voxels) {
  std::vector<Grid> grids;
  if (extension_of(path) == ".nvdb") {
    voxels.format = "NanoVDB";
    for (const auto& handle : nanovdb::io::readGrids(path)) grids.push_back(grid_of(handle));
    return grids;
  }
  voxels.format = "OpenVDB";
  openvdb::io::File file(path);
  // `false` prevents memory mapping, with which a truncated file would end the program.
  file.open(false);
  for (auto name = file.beginName(); name != file.endName(); ++name) grids.push_back(file.readGrid(name.gridName()));
  file.close();
  return grids;
}

// openvdb::io::File does not report bytes that could not be written.
struct CheckedArchive : openvdb::io::Archive {
  void save(std::ostream& out, const openvdb::GridCPtrVec& grids) const {
    constexpr bool kWithOffsets = true;
    write(out, grids, kWithOffsets);
  }
};

template <class Work>
bool without_throwing(std::string& error, const Work& work) {
  try {
    static const bool initialised = (openvdb::initialize(), true);
    static_cast<void>(initialised);
    work();
    return true;
  } catch (const Refused& refused) {
    error = refused.what();
  } catch (const std::bad_alloc&) {
    error = "not enough memory";
  } catch (const std::exception& other) {
    error = fmt::format("not readable: {}", other.what());
  }
  return false;
}

bool read(const std::string& path, VdbVoxels& voxels, std::string& error) {
  return without_throwing(error, [&] { take(grids_of(path, voxels), voxels); });
}

bool write(const std::string& path, const VdbVoxels& voxels, std::string& error) {
  return without_throwing(error, [&] {
    const auto grid = openvdb::BoolGrid::create(false);
    grid->setName("solid");
    const auto& m = voxels.world_from_index;
    const dvec3& o = voxels.origin;
    grid->setTransform(openvdb::math::Transform::createLinearTransform(
        openvdb::math::Mat4d(m[0][0], m[0][1], m[0][2], 0.0, m[1][0], m[1][1], m[1][2], 0.0, m[2][0], m[2][1], m[2][2],
                             0.0, o.x, o.y, o.z, 1.0)));
    openvdb::BoolTree& tree = grid->tree();
    for (const VdbTile& tile : voxels.tiles)
      tree.addTile(tile.side == kLeaf ? 1 : 2, openvdb::Coord(tile.low.x, tile.low.y, tile.low.z), true, true);
    for (const VdbLeaf& from : voxels.leaves) {
      auto* leaf = tree.touchLeaf(openvdb::Coord(from.low.x, from.low.y, from.low.z));
      for (int n = 0; n < kLeafVoxels; ++n) {
        const Place place = place_of(n);
        if (from.solid[place.brick] >> place.bit & 1) leaf->setValueOn(static_cast<openvdb::Index>(n), true);
      }
    }
    std::ofstream file(path, std::ios::binary);
    CheckedArchive().save(file, {grid});
    file.close();
    if (!file) throw Refused("cannot be written; is the disk full?");
  });
}

}  // namespace
}  // namespace scarp

extern "C" __attribute__((visibility("default"))) const scarp::VdbModule scarp_vdb_module{scarp::read, scarp::write};
