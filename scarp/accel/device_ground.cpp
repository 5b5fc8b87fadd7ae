// SPDX-License-Identifier: MIT
#include "scarp/accel/device_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

#include "scarp/accel/code_tables.h"
#include "scarp/accel/max_pyramid.glsl.h"
#include "scarp/accel/max_pyramid_vk.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/base/two_floats.h"

namespace scarp {
namespace {

// The only NaN in device memory.
constexpr std::uint32_t kHole = 0x7fc00000;
constexpr std::int64_t kMaxWords = 0x7fffffff;  // shaders index with 32 bits, of which SPIR-V reserves one for the sign
constexpr std::int64_t kWordsPerPiece = 1 << 18;

bool is_float(const HeightField& field) { return field.sample_type() == SampleType::float32; }

std::int64_t words_per_row(const HeightField& field) {
  return is_float(field) ? field.cols() : (std::int64_t{field.cols()} + 1) / 2;
}

std::uint64_t sample_bytes(const HeightField& field) {
  const std::int64_t words = words_per_row(field) * field.rows();
  if (words > kMaxWords) {
    throw Error(fmt::format("height field: {} x {} samples are more than a shader can index (use a window of them)",
                            field.cols(), field.rows()));
  }
  return 4 * static_cast<std::uint64_t>(words);
}

std::uint64_t entry_bytes(const std::vector<PyramidLevel>& levels) {
  // A field without cells has one unused entry: buffers must not be empty.
  if (levels.empty()) return 4;
  return 4 * static_cast<std::uint64_t>(levels.back().begin + 1);
}

std::uint32_t quad_stride(const std::vector<PyramidLevel>& levels) {
  return glsl::ground_quad_stride(static_cast<std::uint32_t>(levels.front().cols),
                                  static_cast<std::uint32_t>(levels.size()));
}

std::uint64_t quad_bytes(const std::vector<PyramidLevel>& levels) {
  if (levels.empty()) return 8;
  const std::uint64_t rows = static_cast<std::uint64_t>(levels.front().rows) +
                             (levels.size() > 1 ? static_cast<std::uint64_t>(levels[1].rows) : 0);
  return 8 * rows * quad_stride(levels);
}

std::uint32_t bits_of(const SampleGrid<float>& grid, int col, int row) {
  const float sample = grid.at(col, row);
  return grid.is_nodata(sample) ? kHole : std::bit_cast<std::uint32_t>(sample);
}

// Returns word `word` of a row of samples.
std::uint32_t word_of(const SampleGrid<float>& grid, int word, int row) { return bits_of(grid, word, row); }
template <class T>
std::uint32_t word_of(const SampleGrid<T>& grid, int word, int row) {
  const int col = 2 * word;
  const std::uint32_t first = static_cast<std::uint16_t>(grid.at(col, row));
  const std::uint32_t second = col + 1 < grid.cols ? static_cast<std::uint16_t>(grid.at(col + 1, row)) : 0;
  return first | second << 16;
}

}  // namespace

DeviceGround::DeviceGround(const Device& device, const HeightField& field, const std::optional<SampleRange>& reserve)
    : levels_(pyramid_levels(field)),
      samples_(device, sample_bytes(field), "samples"),
      pyramid_(device, entry_bytes(levels_), "the pyramid"),
      quads_(device, quad_bytes(levels_), "the quads"),
      header_(device, sizeof(glsl::GroundBuffers), "the ground's layout"),
      passes_(std::make_unique<PyramidPasses>(device)),
      commands_(device) {
  if (is_float(field)) codes_.emplace(device, 2 * 4 * std::uint64_t{glsl::kPyramidCodes}, "codes");
  set_range(code_range(field, reserve), field.sample_type());
  copy_samples(field, {0, 0, field.cols(), field.rows()});
  build(field, {0, 0, field.cell_cols(), field.cell_rows()});
}

DeviceGround::DeviceGround(DeviceGround&&) noexcept = default;
DeviceGround& DeviceGround::operator=(DeviceGround&&) noexcept = default;
DeviceGround::~DeviceGround() = default;

void DeviceGround::set_range(const SampleRange& range, SampleType type) {
  range_ = range;
  code_ = height_code(type, range);
  if (!codes_) return;
  const std::vector<std::uint32_t> tables = code_tables(code_);
  upload(*codes_, 0, tables.data(), codes_->bytes());
}

void DeviceGround::copy_samples(const HeightField& field, const SampleRect& rect) {
  field.visit([&](const auto& grid) {
    const int per_word = is_float(field) ? 1 : 2;
    const int first = rect.col / per_word, words = (rect.col + rect.cols - 1) / per_word + 1 - first;
    const auto row_bytes = 4 * static_cast<std::uint64_t>(words);
    const auto stride = 4 * static_cast<std::uint64_t>(words_per_row(field));
    upload_rows(samples_,
                {.offset = static_cast<std::uint64_t>(rect.row) * stride + 4 * static_cast<std::uint64_t>(first),
                 .row_bytes = row_bytes,
                 .rows = static_cast<std::uint64_t>(rect.rows),
                 .stride = stride},
                [&](std::span<std::byte> piece, std::uint64_t begin) {
                  parallel_for(static_cast<std::int64_t>(piece.size() / 4), kWordsPerPiece,
                               [&](std::int64_t from, std::int64_t to) {
                                 std::int64_t at = static_cast<std::int64_t>(begin / 4) + from;
                                 int row = static_cast<int>(at / words), word = static_cast<int>(at % words);
                                 for (std::int64_t i = from; i < to; ++i) {
                                   const std::uint32_t bits = word_of(grid, first + word, rect.row + row);
                                   std::memcpy(piece.data() + 4 * i, &bits, 4);
                                   if (++word == words) word = 0, ++row;
                                 }
                               });
                });
  });
}

void DeviceGround::build(const HeightField& field, const CellBox& changed) {
  const HeightFieldSettings& settings = field.settings();
  glsl::GroundBuffers& ground = layout_;
  ground.samples = samples_.address();
  ground.pyramid = pyramid_.address();
  ground.quads = quads_.address();
  if (!levels_.empty()) {
    ground.quad_cols = static_cast<std::uint32_t>(levels_.front().cols);
    ground.quad_rows = static_cast<std::uint32_t>(levels_.front().rows);
    ground.quad_stride = quad_stride(levels_);
  }
  ground.cols = static_cast<std::uint32_t>(field.cols());
  ground.rows = static_cast<std::uint32_t>(field.rows());
  ground.cell_cols = static_cast<std::uint32_t>(field.cell_cols());
  ground.cell_rows = static_cast<std::uint32_t>(field.cell_rows());
  ground.sample_words = static_cast<std::uint32_t>(words_per_row(field));
  ground.sample_type = static_cast<std::uint32_t>(field.sample_type());
  ground.has_holes = field.nodata_count() > 0;
  ground.hole = field.visit([](const auto& grid) -> std::uint32_t {
    if constexpr (std::is_same_v<decltype(grid.nodata), float>) return kHole;
    return static_cast<std::uint16_t>(grid.nodata);
  });
  ground.triangles = settings.surface == Surface::triangles;
  ground.wrap = static_cast<std::uint32_t>(settings.wrap);
  ground.solid = settings.solid;
  ground.top_level = static_cast<std::uint32_t>(levels_.size());
  split(code_.base, ground.code_base, ground.code_base_low);
  split(code_.step, ground.code_step, ground.code_step_low);
  ground.code_per_step = static_cast<float>(code_.per_step);
  ground.code_over = code_.code_over(field.max_sample());
  ground.min_sample = static_cast<float>(field.min_sample());
  ground.max_sample = static_cast<float>(field.max_sample());
  ground.cell_x = static_cast<float>(settings.cell_x);
  ground.cell_y = static_cast<float>(settings.cell_y);
  ground.metres_per_sample = static_cast<float>(settings.scale * settings.exaggeration);
  ground.metres_at_zero = static_cast<float>(field.height_from_sample(0));
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    ground.levels[l] = {static_cast<std::uint32_t>(levels_[l].begin), static_cast<std::uint32_t>(levels_[l].cols),
                        static_cast<std::uint32_t>(levels_[l].rows)};
  }
  upload(header_, 0, &ground, sizeof ground);
  if (levels_.empty()) return;
  passes_->record(commands_, address(), codes_ ? codes_->address() : 0, field, changed);
  commands_.run();
  download(header_, offsetof(glsl::GroundBuffers, spread), &ground.spread, sizeof ground.spread);
}

void DeviceGround::update(const HeightField& field, const CellBox& changed) {
  // The changed samples are corners of these cells.
  const SampleRect rect{std::max(changed.col_begin, 0), std::max(changed.row_begin, 0),
                        std::min(changed.col_end, field.cols() - 1) - std::max(changed.col_begin, 0) + 1,
                        std::min(changed.row_end, field.rows() - 1) - std::max(changed.row_begin, 0) + 1};
  copy_samples(field, rect);
  if (is_in_range(field, range_)) return build(field, changed);
  set_range(code_range(field, range_), field.sample_type());
  layout_.spread = 0;
  build(field, {0, 0, field.cell_cols(), field.cell_rows()});
}

std::uint64_t DeviceGround::bytes() const {
  return samples_.bytes() + pyramid_.bytes() + quads_.bytes() + header_.bytes() + (codes_ ? codes_->bytes() : 0);
}

std::vector<std::uint32_t> DeviceGround::read_pyramid() const {
  std::vector<std::uint32_t> entries(levels_.empty() ? 0 : pyramid_.bytes() / 4);
  download(pyramid_, 0, entries.data(), 4 * entries.size());
  return entries;
}

}  // namespace scarp
