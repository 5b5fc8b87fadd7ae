// SPDX-License-Identifier: MIT
#include "scarp/source/raster/band_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/raster/block_cache.h"
#include "scarp/source/raster/vrt_sources.h"

namespace scarp {
namespace {

constexpr std::int64_t kBytesPerPiece = 8 << 20;        // approximate size of a piece
constexpr std::int64_t kLargestPieceBytes = 256 << 20;  // maximum size, if one block of the file needs more
// The blocks that a virtual raster reports are small and its own; the blocks of its sources are rarely larger than
// this.
constexpr int kVirtualBlockSide = 1024;

struct PieceSize {
  int cols, rows;
};

// Pieces consist of whole blocks, in rows as long as possible.
PieceSize piece_size(GDALRasterBand& band, const RasterWindow& window, int bytes_per_sample) {
  int block_cols = 1, block_rows = 1;
  band.GetBlockSize(&block_cols, &block_rows);
  const GDALDataset* const dataset = band.GetDataset();
  const GDALDriver* const driver = dataset ? const_cast<GDALDataset*>(dataset)->GetDriver() : nullptr;
  if (driver && std::string_view(driver->GetDescription()) == "VRT")
    block_cols = std::max(block_cols, kVirtualBlockSide), block_rows = std::max(block_rows, kVirtualBlockSide);
  const std::int64_t across = std::min(block_cols, window.cols), down = std::min(block_rows, window.rows);
  const std::int64_t row_bytes = std::int64_t{window.cols} * bytes_per_sample, band_bytes = row_bytes * down;
  const auto blocks = [](std::int64_t samples, std::int64_t block) {
    return std::max<std::int64_t>(1, samples / block) * block;
  };
  std::int64_t cols = window.cols, rows = down;
  if (band_bytes <= kBytesPerPiece) {
    rows = blocks(kBytesPerPiece / row_bytes, down);
  } else if (across * down * bytes_per_sample <= kLargestPieceBytes) {
    cols = blocks(kBytesPerPiece / (down * bytes_per_sample), across);
  } else {
    // GDAL holds such a block in memory anyway, so it is read in parts.
    cols = across;
    rows = std::max<std::int64_t>(1, kBytesPerPiece / (across * bytes_per_sample));
  }
  constexpr std::int64_t kMost = 1 << 30;
  return {static_cast<int>(std::min(cols, kMost)), static_cast<int>(std::min(rows, kMost))};
}

// The first multiple of `step` after `at`, at most `end`.
int next_boundary(int at, int step, int end) {
  return static_cast<int>(std::min<std::int64_t>((std::int64_t{at} / step + 1) * step, end));
}

}  // namespace

void for_pieces(GDALRasterBand& band, const RasterWindow& window, int bytes_per_sample, const Progress& progress,
                const PieceCalls& calls) {
  const PieceSize size = piece_size(band, window, bytes_per_sample);
  const int col_end = window.col + window.cols, row_end = window.row + window.rows;
  for (int row = window.row; row < row_end;) {
    const int below = next_boundary(row, size.rows, row_end);
    for (int col = window.col; col < col_end;) {
      const int beyond = size.cols >= window.cols ? col_end : next_boundary(col, size.cols, col_end);
      calls.piece({col, row, beyond - col, below - row});
      col = beyond;
      const double band_share = static_cast<double>(col - window.col) / window.cols;
      if (progress && !progress((row - window.row + band_share * (below - row)) / window.rows)) throw Interrupted();
    }
    row = below;
    if (calls.rows_done) calls.rows_done(row);
  }
}

void read_piece(GDALRasterBand& band, const RasterWindow& piece, GDALDataType type, void* out, int row_samples,
                GdalSession& session) {
  session.clear();
  const GSpacing sample_bytes = GDALGetDataTypeSizeBytes(type);
  const CPLErr result = band.RasterIO(GF_Read, piece.col, piece.row, piece.cols, piece.rows, out, piece.cols,
                                      piece.rows, type, sample_bytes, sample_bytes * row_samples, nullptr);
  // Some drivers report an error, fill the samples with zeros, and return success.
  if (result != CE_None || session.failed()) {
    check_vrt_sources(band);
    const std::string reason = session.reason("");
    throw Error(fmt::format("cannot read rows {} to {}: truncated or damaged file{} ({})", piece.row,
                            piece.row + piece.rows - 1, reason.empty() ? "" : ", " + reason, kFetchAgain));
  }
}

bool is_empty_piece(GDALRasterBand& band, const RasterWindow& piece) {
  return band.GetDataCoverageStatus(piece.col, piece.row, piece.cols, piece.rows, 0, nullptr) ==
         GDAL_DATA_COVERAGE_STATUS_EMPTY;
}

BlockCacheLimit::BlockCacheLimit(std::int64_t bytes) : before_(GDALGetCacheMax64()) {
  if (before_ > bytes) GDALSetCacheMax64(bytes);
}

BlockCacheLimit::~BlockCacheLimit() { GDALSetCacheMax64(before_); }

}  // namespace scarp
