// SPDX-License-Identifier: MIT
#include "scarp/field/voxel_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

constexpr int kVoxelsPerBrick = 64;

// Bits of a mask below `bit`.
constexpr std::uint64_t below(int bit) { return (std::uint64_t{1} << bit) - 1; }

// std::popcount() is a call if the compiler cannot assume the instruction.
int bits_set(std::uint64_t mask) {
  mask -= mask >> 1 & 0x5555555555555555u;
  mask = (mask & 0x3333333333333333u) + (mask >> 2 & 0x3333333333333333u);
  return static_cast<int>(((mask + (mask >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u >> 56);
}

std::uint32_t packed(const std::vector<std::uint64_t>& words, std::size_t place, int bits) {
  const std::size_t first = place * static_cast<std::size_t>(bits), word = first / 64, shift = first % 64;
  std::uint64_t value = words[word] >> shift;
  if (shift + static_cast<std::size_t>(bits) > 64) value |= words[word + 1] << (64 - shift);
  return static_cast<std::uint32_t>(value & below(bits));
}

bool valid_side(int side) { return side >= 1 && side <= VoxelGrid::kMaxSide; }

// Mask of the voxels of a brick that are inside the grid; `left` voxels of the grid remain along each axis.
std::uint64_t mask_inside(const ivec3& left) {
  if (left.x >= 4 && left.y >= 4 && left.z >= 4) return ~std::uint64_t{0};
  std::uint64_t mask = 0;
  for_each_voxel({ivec3(0), glm::min(left, 4)},
                 [&](const ivec3& v) { mask |= std::uint64_t{1} << VoxelGrid::bit_of(v); });
  return mask;
}

// The first layer of voxels of a brick along each axis.
constexpr std::uint64_t kLowX = 0x1111111111111111u, kLowY = 0x000f000f000f000fu, kLowZ = 0x000000000000ffffu;

}  // namespace

// Entries, indexed by brick within the page and by bit; undefined for empty voxels and dropped entries.
struct VoxelGrid::PageVoxels {
  std::array<std::uint64_t, kPageBricks> solid{}, coloured{};
  std::vector<std::uint32_t> entries = std::vector<std::uint32_t>(kPageBricks * kVoxelsPerBrick);
};

void VoxelGrid::require_size(const ivec3& size, int entry_bits) {
  if (!valid_side(size.x) || !valid_side(size.y) || !valid_side(size.z)) {
    throw Error(
        fmt::format("voxel grid: {} x {} x {} voxels (each side must be 1 to {})", size.x, size.y, size.z, kMaxSide));
  }
  if (entry_bits < 1 || entry_bits > kMaxEntryBits) {
    throw Error(fmt::format("voxel grid: {} bits per entry (must be 1 to {})", entry_bits, kMaxEntryBits));
  }
}

VoxelGrid::VoxelGrid(const ivec3& size, int entry_bits)
    : size_(size), bricks_((size + 3) / 4), entry_bits_(entry_bits) {
  require_size(size, entry_bits);
  first_mask_ = SparseTable<std::uint32_t>(static_cast<std::size_t>(pages_of(size)));
  empty_pages_ = page_count();
  masks_.resize(kPageBricks);
  pages_.resize(1);
}

std::int64_t VoxelGrid::pages_of(const ivec3& size) {
  const ivec3 bricks = (size + 3) / 4;
  return (std::int64_t{bricks.x} * bricks.y * bricks.z + kPageBricks - 1) / kPageBricks;
}

std::int64_t VoxelGrid::bytes_of(const ivec3& size, std::int64_t pages, std::int64_t solid, int entry_bits) {
  constexpr std::int64_t kPageBytes = kPageBricks * sizeof(std::uint64_t) + sizeof(Page) + sizeof(std::uint64_t);
  return static_cast<std::int64_t>(sizeof(VoxelGrid) + sizeof(std::uint32_t)) +
         pages_of(size) * static_cast<std::int64_t>(sizeof(std::uint32_t)) + (pages + 1) * kPageBytes +
         solid * entry_bits / 8;
}

std::size_t VoxelGrid::bytes() const {
  std::size_t sum = sizeof(*this) + first_mask_.bytes() + (masks_.size() + coloured_.size()) * sizeof(std::uint64_t);
  for (const Page& page : pages_) sum += sizeof(page) + page.words.size() * sizeof(std::uint64_t);
  return sum;
}

std::uint32_t VoxelGrid::entry(const ivec3& voxel) const {
  const std::span<const std::uint64_t> masks = entry_masks();
  const std::size_t index = brick_index(voxel >> 2), brick = first_mask_[index / kPageBricks] + index % kPageBricks;
  const int bit = bit_of(voxel);
  if (!(masks[brick] >> bit & 1)) return 0;
  const Page& page = pages_[brick / kPageBricks];
  std::size_t rank = page.rank_from[brick % kPageBricks / kRankBricks];
  for (std::size_t i = brick - brick % kRankBricks; i < brick; ++i) rank += bits_set(masks[i]);
  rank += bits_set(masks[brick] & below(bit));
  return packed(page.words, rank, entry_bits_);
}

VoxelGrid::PageVoxels VoxelGrid::unpack(std::size_t page) const {
  PageVoxels voxels;
  const std::size_t first = first_mask_[page];
  std::size_t rank = 0;
  for (std::size_t brick = 0; brick < kPageBricks; ++brick) {
    voxels.solid[brick] = masks_[first + brick];
    voxels.coloured[brick] = entry_masks()[first + brick];
    for (std::uint64_t rest = voxels.coloured[brick]; rest != 0; rest &= rest - 1)
      voxels.entries[brick * kVoxelsPerBrick + std::countr_zero(rest)] =
          packed(pages_[first / kPageBricks].words, rank++, entry_bits_);
  }
  return voxels;
}

VoxelGrid::Page VoxelGrid::packed_page(std::span<const std::uint64_t> coloured,
                                       std::span<const std::uint32_t> entries) const {
  Page page;
  std::size_t count = 0;
  for (std::size_t brick = 0; brick < kPageBricks; ++brick) {
    if (brick % kRankBricks == 0) page.rank_from[brick / kRankBricks] = static_cast<std::uint16_t>(count);
    count += static_cast<std::size_t>(bits_set(coloured[brick]));
  }
  page.words.reserve((count * static_cast<std::size_t>(entry_bits_) + 63) / 64);
  std::uint64_t word = 0;
  int used = 0;  // bits of it
  for (std::size_t brick = 0; brick < kPageBricks; ++brick) {
    for (std::uint64_t rest = coloured[brick]; rest != 0; rest &= rest - 1) {
      const std::uint64_t entry = entries[brick * kVoxelsPerBrick + static_cast<std::size_t>(std::countr_zero(rest))];
      word |= entry << used;
      used += entry_bits_;
      if (used < 64) continue;
      page.words.push_back(word);
      used -= 64;
      word = used > 0 ? entry >> (entry_bits_ - used) : 0;
    }
  }
  if (used > 0) page.words.push_back(word);
  return page;
}

// Returns the index of the new page's first mask.
std::uint32_t VoxelGrid::add_page() {
  const std::size_t first = masks_.size();
  // If one of these throws, the others have more pages than are used.
  pages_.resize(first / kPageBricks + 1);
  if (!coloured_.empty()) coloured_.resize(first + kPageBricks);
  masks_.resize(first + kPageBricks);
  return static_cast<std::uint32_t>(first);
}

// Returns the index of a page's first mask; a page that was empty or full gets its own.
std::size_t VoxelGrid::stored(std::size_t page) {
  const bool empty = is_empty(page), full = is_full(page);
  if (!empty && !full) return first_mask_[page];
  if (empty && empty_pages_ == 1) {
    empty_pages_ = 0;
    return 0;
  }
  std::uint32_t& of_page = first_mask_.at(page);
  const std::uint32_t first = add_page();
  if (full) std::fill_n(masks_.begin() + first, kPageBricks, ~std::uint64_t{0});
  of_page = first;
  if (empty) --empty_pages_;
  return first;
}

void VoxelGrid::pack(std::size_t page, const PageVoxels& voxels) {
  const auto any = [](std::uint64_t mask) { return mask != 0; };
  if (is_empty(page) && std::none_of(voxels.solid.begin(), voxels.solid.end(), any)) return;
  // Computed before anything is stored, because these calls may throw.
  Page entries = packed_page(voxels.coloured, voxels.entries);
  const std::size_t first = stored(page);
  for (std::size_t brick = 0; brick < kPageBricks; ++brick) {
    solid_count_ += std::popcount(voxels.solid[brick]) - std::popcount(masks_[first + brick]);
    masks_[first + brick] = voxels.solid[brick];
    if (!coloured_.empty()) coloured_[first + brick] = voxels.coloured[brick];
  }
  pages_[first / kPageBricks] = std::move(entries);
}

void VoxelGrid::require_entry(std::uint32_t entry) const {
  if (entry > below(entry_bits_))
    throw Error(fmt::format("voxel grid: entry {} does not fit in {} bits", entry, entry_bits_));
}

// An edit in progress: unpacks the current page and packs it again on leaving it. If an exception ends the edit, the
// changes to the current page are lost and the rest of the grid stays consistent.
class VoxelGrid::Editing {
 public:
  explicit Editing(VoxelGrid& grid) : grid_(grid), page_(grid.page_count()) {}
  Editing(const Editing&) = delete;
  Editing& operator=(const Editing&) = delete;
  ~Editing() {
    if (!finished_) grid_.bounds_ = grid_.scan_bounds();
  }

  void go_to(const ivec3& brick) {
    const std::size_t index = grid_.brick_index(brick);
    if (index / kPageBricks != page_) {
      pack();
      page_ = index / kPageBricks;
      voxels_ = grid_.unpack(page_);
    }
    in_page_ = index % kPageBricks;
  }
  // Edits a voxel of the brick.
  template <class ChangeOne>
  void change(const ivec3& voxel, const ChangeOne& change_one) {
    const int bit = bit_of(voxel);
    const std::uint64_t flag = std::uint64_t{1} << bit;
    std::uint64_t &solid = voxels_.solid[in_page_], &coloured = voxels_.coloured[in_page_];
    std::uint32_t& entry = voxels_.entries[in_page_ * kVoxelsPerBrick + static_cast<std::size_t>(bit)];
    Voxel before;
    if (solid & flag) before = coloured & flag ? entry : 0;
    const Voxel after = change_one(voxel, before);
    if (after == before) return;
    if (after) grid_.require_entry(*after);
    solid = after ? solid | flag : solid & ~flag;
    coloured = after ? coloured | flag : coloured & ~flag;
    entry = after.value_or(0);
    const VoxelBox here{voxel, voxel + 1};
    changed_ = around(changed_, here);
    if (!before) added_ = around(added_, here);
    if (!after) removed_ = around(removed_, here);
  }
  // Returns the voxels that may have changed.
  VoxelBox finish() {
    pack();
    grid_.bounds_ = around(grid_.bounds_, added_);
    // Cleared voxels matter only where they touch the bounds.
    const VoxelBox& bounds = grid_.bounds_;
    const bool inner =
        glm::all(glm::lessThan(bounds.low, removed_.low)) && glm::all(glm::greaterThan(bounds.high, removed_.high));
    if (!removed_.empty() && !inner) grid_.bounds_ = grid_.scan_bounds();
    finished_ = true;
    return changed_;
  }

 private:
  void pack() {
    if (page_ < grid_.page_count()) grid_.pack(page_, voxels_);
  }

  VoxelGrid& grid_;
  std::size_t page_, in_page_ = 0;
  PageVoxels voxels_;
  VoxelBox changed_, added_, removed_;
  bool finished_ = false;
};

VoxelBox VoxelGrid::edit(const VoxelBox& box, const Change& change) {
  const VoxelBox inside = intersection(box, this->box());
  if (inside.empty()) return {};
  // Bricks are visited in the order of their indices, so each page is unpacked once.
  Editing editing(*this);
  for_each_voxel({inside.low >> 2, ((inside.high - 1) >> 2) + 1}, [&](const ivec3& brick) {
    editing.go_to(brick);
    for_each_voxel(intersection({4 * brick, 4 * brick + 4}, inside),
                   [&](const ivec3& voxel) { editing.change(voxel, change); });
  });
  return editing.finish();
}

VoxelBox VoxelGrid::set(std::span<const Placed> voxels) {
  for (const Placed& placed : voxels) {
    if (placed.value) require_entry(*placed.value);
  }
  const auto page_of = [&](const Placed& placed) { return brick_index(placed.voxel >> 2) / kPageBricks; };
  std::size_t low = page_count(), high = 0;
  std::vector<const Placed*> order;
  for (const Placed& placed : voxels) {
    if (!box().contains(placed.voxel)) continue;
    low = std::min(low, page_of(placed));
    high = std::max(high, page_of(placed));
    order.push_back(&placed);
  }
  if (order.empty()) return {};
  // Sorted by page, so that each page is unpacked once: few voxels in many pages by comparison, otherwise by counting.
  if ((high - low) / 64 > order.size()) {
    std::stable_sort(order.begin(), order.end(),
                     [&](const Placed* a, const Placed* b) { return page_of(*a) < page_of(*b); });
  } else {
    // Counts before each page, then the next index of each.
    std::vector<std::size_t> begin(high - low + 2);
    for (const Placed* placed : order) ++begin[page_of(*placed) - low + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<const Placed*> sorted(order.size());
    for (const Placed* placed : order) sorted[begin[page_of(*placed) - low]++] = placed;
    order = std::move(sorted);
  }
  Editing editing(*this);
  for (const Placed* placed : order) {
    editing.go_to(placed->voxel >> 2);
    editing.change(placed->voxel, [&](const ivec3&, const Voxel&) { return placed->value; });
  }
  return editing.finish();
}

VoxelBox VoxelGrid::set(const ivec3& voxel, std::uint32_t entry) { return fill({voxel, voxel + 1}, entry); }
VoxelBox VoxelGrid::clear(const ivec3& voxel) { return clear(VoxelBox{voxel, voxel + 1}); }

VoxelBox VoxelGrid::fill(const VoxelBox& box, std::uint32_t entry) {
  require_entry(entry);
  return edit(box, [&](const ivec3&, const Voxel&) { return Voxel(entry); });
}

VoxelBox VoxelGrid::clear(const VoxelBox& box) {
  return edit(box, [](const ivec3&, const Voxel&) { return Voxel(); });
}

VoxelBox VoxelGrid::paint(const VoxelBox& box, std::uint32_t entry) {
  require_entry(entry);
  return edit(box, [&](const ivec3&, const Voxel& before) { return before ? Voxel(entry) : before; });
}

VoxelBox VoxelGrid::scan_bounds() const {
  VoxelBox bounds;
  for_each_solid_brick([&](const ivec3& brick, std::uint64_t mask) {
    // Positions along an axis at which the brick has solid voxels: four bits.
    const auto occupied = [&](std::uint64_t layer, int shift) {
      unsigned bits = 0;
      for (int i = 0; i < 4; ++i) bits |= (mask >> (shift * i) & layer ? 1u : 0u) << i;
      return bits;
    };
    const std::array<unsigned, 3> along = {occupied(kLowX, 1), occupied(kLowY, 4), occupied(kLowZ, 16)};
    VoxelBox box;
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = 4 * brick[axis] + std::countr_zero(along[axis]);
      box.high[axis] = 4 * brick[axis] + std::bit_width(along[axis]);
    }
    bounds = around(bounds, box);
  });
  return bounds;
}

VoxelBox VoxelGrid::combine(const VoxelGrid& other, MaskOp op) {
  if (other.size_ != size_ || other.entry_bits_ != entry_bits_) {
    throw Error(fmt::format(
        "voxel grid: cannot combine {} x {} x {} voxels of {} bits with {} x {} x {} of {} bits (sizes "
        "and bits must be equal)",
        size_.x, size_.y, size_.z, entry_bits_, other.size_.x, other.size_.y, other.size_.z, other.entry_bits_));
  }
  VoxelBox changed;
  for (std::size_t page = 0; page < page_count(); ++page) {
    if (is_empty(page) && other.is_empty(page)) continue;
    PageVoxels mine = unpack(page);
    const PageVoxels theirs = other.unpack(page);
    bool touched = false;
    for (std::size_t brick = 0; brick < kPageBricks; ++brick) {
      const std::uint64_t before = mine.solid[brick], after = op(before, theirs.solid[brick]);
      if (after == before) continue;
      touched = true;
      for (std::uint64_t rest = after & ~before; rest != 0; rest &= rest - 1) {
        const std::size_t place = brick * kVoxelsPerBrick + std::countr_zero(rest);
        mine.entries[place] = theirs.entries[place];
      }
      mine.solid[brick] = after;
      mine.coloured[brick] = (mine.coloured[brick] & after) | (theirs.coloured[brick] & after & ~before);
      const ivec3 at = brick_at(page * kPageBricks + brick);
      changed = around(changed, intersection({4 * at, 4 * at + 4}, box()));
    }
    if (touched) {
      if (!other.coloured_.empty() && coloured_.empty()) coloured_ = masks_;
      pack(page, mine);
    }
  }
  if (!changed.empty()) bounds_ = scan_bounds();
  return changed;
}

VoxelBox VoxelGrid::unite(const VoxelGrid& other) {
  return combine(other, [](std::uint64_t a, std::uint64_t b) { return a | b; });
}

VoxelBox VoxelGrid::intersect(const VoxelGrid& other) {
  return combine(other, [](std::uint64_t a, std::uint64_t b) { return a & b; });
}

VoxelBox VoxelGrid::subtract(const VoxelGrid& other) {
  return combine(other, [](std::uint64_t a, std::uint64_t b) { return a & ~b; });
}

VoxelBox VoxelGrid::page_box(std::size_t page) const {
  const ivec3 first = brick_at(page * kPageBricks), last = brick_at(page * kPageBricks + kPageBricks - 1);
  VoxelBox bricks{first, last + 1};
  // If a page continues in the next row or slab, its whole rows or slabs count.
  if (first.y != last.y || first.z != last.z) bricks.low.x = 0, bricks.high.x = bricks_.x;
  if (first.z != last.z) bricks.low.y = 0, bricks.high.y = bricks_.y;
  return {4 * bricks.low, 4 * bricks.high};
}

VoxelGrid VoxelGrid::built(const ivec3& size, int entry_bits, const FillBrick& fill) {
  return built(size, entry_bits, Source{{}, [&](const ivec3& brick, std::span<std::uint32_t, kVoxelsPerBrick> entries) {
                                          const std::uint64_t mask = fill(brick, entries);
                                          return Brick{mask, mask};
                                        }});
}

VoxelGrid VoxelGrid::built(const ivec3& size, int entry_bits, const Source& source) {
  VoxelGrid grid(size, entry_bits);
  struct Stored {
    std::array<std::uint64_t, kPageBricks> solid{}, coloured{};
    Page page;
    bool full = false;
  };
  const std::size_t bricks = grid.brick_index(grid.bricks_ - 1) + 1;
  // Returns null for an empty page.
  const auto build = [&](std::size_t page, std::vector<std::uint32_t>& entries) -> std::unique_ptr<Stored> {
    const Contents contents = source.contents ? source.contents(grid.page_box(page)) : Contents::mixed;
    if (contents == Contents::empty) return {};
    Stored stored;
    std::uint64_t any = 0, all = ~std::uint64_t{0}, coloured = 0;
    for (std::size_t i = 0; i < kPageBricks; ++i) {
      Brick brick;
      if (page * kPageBricks + i < bricks) {
        const ivec3 at = grid.brick_at(page * kPageBricks + i);
        const std::span<std::uint32_t, kVoxelsPerBrick> own(&entries[i * kVoxelsPerBrick], kVoxelsPerBrick);
        brick = contents == Contents::full ? Brick{~std::uint64_t{0}, 0} : source.fill(at, own);
        brick.solid &= mask_inside(size - 4 * at);
        brick.coloured &= brick.solid;
        for (std::uint64_t rest = brick.coloured; rest != 0; rest &= rest - 1)
          grid.require_entry(own[static_cast<std::size_t>(std::countr_zero(rest))]);
      }
      stored.solid[i] = brick.solid, stored.coloured[i] = brick.coloured;
      any |= brick.solid, all &= brick.solid, coloured |= brick.coloured;
    }
    if (any == 0) return {};
    stored.full = ~all == 0 && coloured == 0;
    if (!stored.full) stored.page = grid.packed_page(stored.coloured, entries);
    return std::make_unique<Stored>(std::move(stored));
  };

  constexpr std::size_t kAtOnce = std::size_t{1} << 18;  // pages, so that not all are in memory twice
  constexpr int kGrain = 64;                             // pages: some milliseconds
  for (std::size_t begin = 0; begin < grid.page_count(); begin += kAtOnce) {
    std::vector<std::unique_ptr<Stored>> pages(std::min(kAtOnce, grid.page_count() - begin));
    parallel_for(static_cast<std::int64_t>(pages.size()), kGrain, [&](std::int64_t first, std::int64_t last) {
      std::vector<std::uint32_t> entries(kPageBricks * kVoxelsPerBrick);
      for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i)
        pages[i] = build(begin + i, entries);
    });
    for (std::size_t i = 0; i < pages.size(); ++i) {
      if (!pages[i]) continue;
      Stored& stored = *pages[i];
      if (stored.solid != stored.coloured && grid.coloured_.empty()) grid.coloured_ = grid.masks_;
      if (stored.full) {
        if (grid.full_ == 0) {
          grid.full_ = grid.add_page();
          std::fill_n(grid.masks_.begin() + grid.full_, kPageBricks, ~std::uint64_t{0});
        }
        grid.first_mask_.at(begin + i) = grid.full_;
        --grid.empty_pages_;
        grid.solid_count_ += kPageBricks * kVoxelsPerBrick;
        continue;
      }
      const std::size_t at = grid.stored(begin + i);
      std::copy(stored.solid.begin(), stored.solid.end(), &grid.masks_[at]);
      if (!grid.coloured_.empty()) std::copy(stored.coloured.begin(), stored.coloured.end(), &grid.coloured_[at]);
      for (const std::uint64_t mask : stored.solid) grid.solid_count_ += bits_set(mask);
      grid.pages_[at / kPageBricks] = std::move(stored.page);
      pages[i].reset();
    }
  }
  grid.bounds_ = grid.scan_bounds();
  return grid;
}

void VoxelGrid::drop_hidden_entries() {
  const auto neighbour = [&](const ivec3& brick, const ivec3& by) {
    const ivec3 at = brick + by;
    return VoxelBox{ivec3(0), bricks_}.contains(at) ? mask(at) : 0;
  };
  std::vector<std::uint64_t> seen(masks_.size());
  for_each_solid_brick([&](const ivec3& brick, std::uint64_t m) {
    const std::size_t index = brick_index(brick);
    // Bit v: whether the neighbour of v on that side is solid.
    const std::uint64_t to_x = ((m >> 1) & ~(kLowX << 3)) | (neighbour(brick, {1, 0, 0}) & kLowX) << 3,
                        from_x = ((m << 1) & ~kLowX) | (neighbour(brick, {-1, 0, 0}) >> 3 & kLowX),
                        to_y = ((m >> 4) & ~(kLowY << 12)) | (neighbour(brick, {0, 1, 0}) & kLowY) << 12,
                        from_y = ((m << 4) & ~kLowY) | (neighbour(brick, {0, -1, 0}) >> 12 & kLowY),
                        to_z = m >> 16 | (neighbour(brick, {0, 0, 1}) & kLowZ) << 48,
                        from_z = m << 16 | neighbour(brick, {0, 0, -1}) >> 48;
    seen[first_mask_[index / kPageBricks] + index % kPageBricks] = m & ~(to_x & from_x & to_y & from_y & to_z & from_z);
  });
  // If nothing is hidden, there is no need to store which voxels have an entry.
  if (seen == masks_) return;
  for (std::size_t page = first_mask_.next(0); page < page_count(); page = first_mask_.next(page + 1)) {
    if (is_empty(page) || is_full(page)) continue;
    const std::size_t first = first_mask_[page];
    PageVoxels voxels = unpack(page);
    for (std::size_t brick = 0; brick < kPageBricks; ++brick) voxels.coloured[brick] &= seen[first + brick];
    pack(page, voxels);
  }
  if (coloured_.empty()) coloured_ = std::move(seen);
}

}  // namespace scarp
