// SPDX-License-Identifier: MIT
#include "scarp/source/band_samples.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/suspected_nodata.h"
#include "scarp/source/vrt_sources.h"

namespace scarp {
namespace {

constexpr std::int64_t kBytesPerPiece = 8 << 20;        // approximate size of the pieces in which rows are read
constexpr std::int64_t kLargestPieceBytes = 256 << 20;  // maximum size, if whole blocks of the file need more

// Memory available without swapping; the machine's total if the system does not report it.
double free_memory_bytes() {
  std::ifstream meminfo("/proc/meminfo");
  std::string word;
  while (meminfo >> word) {
    double kib = 0;
    if (word == "MemAvailable:" && meminfo >> kib) return kib * 1024;
  }
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

// Calls piece(first, count) for pieces of the window's rows that end at block boundaries of the band, so that no block
// is decoded twice.
template <class F>
void for_row_pieces(GDALRasterBand& band, const RasterWindow& window, int bytes_per_sample, const Progress& progress,
                    F&& piece) {
  int block_cols = 1, block_rows = 1;
  band.GetBlockSize(&block_cols, &block_rows);
  const std::int64_t row_bytes = std::int64_t{window.cols} * bytes_per_sample;
  std::int64_t step = std::max<std::int64_t>(1, kBytesPerPiece / row_bytes);
  const std::int64_t whole_blocks = (step + block_rows - 1) / block_rows * block_rows;
  const bool align = whole_blocks * row_bytes <= kLargestPieceBytes || whole_blocks == 1;
  if (align) step = whole_blocks;
  std::int64_t row = window.row;
  const std::int64_t end = std::int64_t{window.row} + window.rows;
  while (row < end) {
    const std::int64_t next = std::min(align ? (row / step + 1) * step : row + step, end);
    piece(static_cast<int>(row), static_cast<int>(next - row));
    row = next;
    if (progress && !progress(static_cast<double>(row - window.row) / window.rows)) throw Interrupted();
  }
}

// Special samples found while reading.
struct Findings {
  std::int64_t nan = 0;
  double rounding = 0;  // largest change by the conversion to float32
  bool beyond_are_holes = true;
  std::int64_t beyond = 0;  // undeclared marks beyond all heights
  double least_beyond = 0, most_beyond = 0;
};

// Whether a float sample equals the nodata value within the precision of files: texts like -3.402823e+38 differ from
// the value by some units in the last place. The tolerance is that of GDAL's own test (4 epsilons, gdal_priv.h:
// ARE_REAL_EQUAL); for marks beyond all heights it is that of texts of six digits, the default of printf: half a unit
// of the sixth.
bool is_float_nodata(double sample, double nodata) {
  constexpr double kSixDigits = 0.5e-5;
  const double width = std::abs(nodata) > kBeyondHeights ? kSixDigits : 4 * double{FLT_EPSILON};
  return sample == nodata || (std::isfinite(nodata) && std::abs(sample - nodata) <= width * std::abs(nodata));
}

// Neither beyond the largest float nor so small that it would become height 0.
bool float_can_hold(double nodata) {
  return std::abs(nodata) <= FLT_MAX && (nodata == 0 || static_cast<float>(nodata) != 0);
}

[[noreturn]] void refuse_infinite(double value, int col, int row) {
  throw Error(
      fmt::format("the sample at column {}, row {} is {}, not a finite height (if it marks holes, add --nodata={})",
                  col, row, std::isinf(value) ? (value > 0 ? "infinite" : "minus infinity") : "beyond float32",
                  std::isinf(value) ? (value > 0 ? "inf" : "-inf") : fmt::format("{}", value)));
}

// Normalises a float sample: all holes get one mark, infinities are rejected. `source` is the value before conversion.
float clean(double source, std::optional<double> nodata, int col, int row, Findings& found) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  if (std::isnan(source)) {
    ++found.nan;
    return kNan;
  }
  if (nodata && is_float_nodata(source, *nodata)) return float_can_hold(*nodata) ? static_cast<float>(*nodata) : kNan;
  if (std::abs(source) > kBeyondHeights && found.beyond_are_holes && std::isfinite(source)) {
    found.least_beyond = found.beyond == 0 ? source : std::min(found.least_beyond, source);
    found.most_beyond = found.beyond == 0 ? source : std::max(found.most_beyond, source);
    ++found.beyond;
    return kNan;
  }
  if (!(std::abs(source) <= FLT_MAX)) refuse_infinite(source, col, row);
  const float sample = static_cast<float>(source);
  found.rounding = std::max(found.rounding, std::abs(source - sample));
  return sample;
}

// Samples whose type is kept, or widened by GDAL without loss.
template <class T>
std::vector<T> read_kept(GDALRasterBand& band, const RasterWindow& window, GDALDataType type,
                         std::optional<double> nodata, bool signed_bytes, Findings& found, GdalSession& session,
                         const Progress& progress) {
  refuse_beyond_memory(window, sizeof(T));
  std::vector<T> samples(static_cast<std::size_t>(window.cols) * static_cast<std::size_t>(window.rows));
  for_row_pieces(band, window, sizeof(T), progress, [&](int row, int rows) {
    T* const first = samples.data() + static_cast<std::ptrdiff_t>(row - window.row) * window.cols;
    read_rows(band, window, row, rows, type, first, session);
    const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(rows) * window.cols;
    if constexpr (std::is_floating_point_v<T>) {
      for (std::ptrdiff_t i = 0; i < count; ++i) {
        first[i] = clean(first[i], nodata, window.col + static_cast<int>(i % window.cols),
                         row + static_cast<int>(i / window.cols), found);
      }
    } else if (signed_bytes) {
      std::transform(first, first + count, first, [](T s) { return static_cast<T>(static_cast<std::int8_t>(s)); });
    }
  });
  return samples;
}

// Samples of wide types, through double.
std::vector<float> read_narrowed(GDALRasterBand& band, const RasterWindow& window, std::optional<double> nodata,
                                 Findings& found, GdalSession& session, const Progress& progress) {
  refuse_beyond_memory(window, sizeof(float));
  std::vector<float> samples(static_cast<std::size_t>(window.cols) * static_cast<std::size_t>(window.rows));
  std::vector<double> piece;
  for_row_pieces(band, window, sizeof(double), progress, [&](int row, int rows) {
    piece.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(window.cols));
    read_rows(band, window, row, rows, GDT_Float64, piece.data(), session);
    float* out = samples.data() + static_cast<std::ptrdiff_t>(row - window.row) * window.cols;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const auto cols = static_cast<std::size_t>(window.cols);
      out[i] =
          clean(piece[i], nodata, window.col + static_cast<int>(i % cols), row + static_cast<int>(i / cols), found);
    }
  });
  return samples;
}

// Converts the samples to float32 and masks hidden ones. Returns the number of hidden samples; if 0, changes nothing.
std::int64_t apply_mask(GDALRasterBand& mask, const RasterWindow& window, BandSamples& read, GdalSession& session) {
  std::vector<std::uint8_t> piece;
  std::int64_t hidden = 0;
  const auto hide = [&](auto&& each) {
    for_row_pieces(mask, window, 1, {}, [&](int row, int rows) {
      piece.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(window.cols));
      read_rows(mask, window, row, rows, GDT_Byte, piece.data(), session);
      const std::size_t first = static_cast<std::size_t>(row - window.row) * static_cast<std::size_t>(window.cols);
      for (std::size_t i = 0; i < piece.size(); ++i) {
        if (piece[i] == 0) each(first + i);
      }
    });
  };
  hide([&](std::size_t) { ++hidden; });
  if (hidden == 0) return 0;
  auto& samples = read.samples;
  if (!std::holds_alternative<std::vector<float>>(samples)) {
    refuse_beyond_memory(window, sizeof(float));
    samples = std::visit([](const auto& s) { return std::vector<float>(s.begin(), s.end()); }, samples);
  }
  auto& floats = std::get<std::vector<float>>(samples);
  hide([&](std::size_t i) { floats[i] = std::numeric_limits<float>::quiet_NaN(); });
  return hidden;
}

bool all_holes(const BandSamples& read) {
  return std::visit(
      [&](const auto& samples) {
        return std::all_of(samples.begin(), samples.end(),
                           [&](auto s) { return s != s || (read.nodata && s == *read.nodata); });
      },
      read.samples);
}

template <class T>
bool holds(double value) {
  return value >= std::numeric_limits<T>::lowest() && value <= std::numeric_limits<T>::max() &&
         value == std::floor(value);
}

}  // namespace

bool is_signed_byte(GDALRasterBand& band) {
  const char* pixel_type = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  return band.GetRasterDataType() == GDT_Byte && pixel_type && std::string_view(pixel_type) == "SIGNEDBYTE";
}

std::optional<double> nodata_of(GDALRasterBand& band) {
  int has = 0;
  double value = 0;
  switch (band.GetRasterDataType()) {
    case GDT_Int64:
      value = static_cast<double>(band.GetNoDataValueAsInt64(&has));
      break;
    case GDT_UInt64:
      value = static_cast<double>(band.GetNoDataValueAsUInt64(&has));
      break;
    default:
      value = band.GetNoDataValue(&has);
  }
  if (!has) return {};
  return is_signed_byte(band) && value > 127 ? value - 256 : value;
}

bool has_own_mask(GDALRasterBand& band) {
  const int flags = band.GetMaskFlags();
  return !(flags & GMF_ALL_VALID) && (!(flags & GMF_NODATA) || (flags & GMF_PER_DATASET));
}

void refuse_beyond_memory(const RasterWindow& window, int bytes_per_sample) {
  const double needed = static_cast<double>(window.cols) * window.rows * bytes_per_sample, have = free_memory_bytes();
  if (needed > have) {
    throw Error(
        fmt::format("{} x {} samples need {:.1f} GiB, but {:.1f} GiB of memory are free (read a part with --window "
                    "COL,ROW,COLS,ROWS)",
                    window.cols, window.rows, needed / (1 << 30), have / (1 << 30)));
  }
}

void read_rows(GDALRasterBand& band, const RasterWindow& window, int row, int rows, GDALDataType type, void* out,
               GdalSession& session) {
  session.clear();
  const CPLErr result =
      band.RasterIO(GF_Read, window.col, row, window.cols, rows, out, window.cols, rows, type, 0, 0, nullptr);
  // Some drivers report an error, fill with zeros, and return success.
  if (result != CE_None || session.failed()) {
    check_vrt_sources(band);
    const std::string reason = session.reason("");
    throw Error(fmt::format("cannot read rows {} to {}: truncated or damaged file{} ({})", row, row + rows - 1,
                            reason.empty() ? "" : ", " + reason, kFetchAgain));
  }
}

BandSamples read_band(GDALRasterBand& band, const RasterWindow& window, std::optional<double> nodata,
                      GdalSession& session, const Progress& progress) {
  const GDALDataType type = band.GetRasterDataType();
  const std::string_view type_name = GDALGetDataTypeName(type);
  if (GDALDataTypeIsComplex(type)) {
    throw Error(
        fmt::format("samples are complex numbers ({}) (convert them with gdal_translate -ot Float32)", type_name));
  }
  const bool signed_bytes = is_signed_byte(band);

  BandSamples read;
  read.nodata = nodata ? nodata : nodata_of(band);
  if (read.nodata && std::isnan(*read.nodata)) read.nodata.reset();
  Findings found;
  found.beyond_are_holes = !nodata;
  const auto integers = [&]<class T>(T, GDALDataType as, std::string_view becomes) {
    if (read.nodata && !holds<T>(*read.nodata)) {
      read.notes.push_back(
          fmt::format("nodata value {} cannot occur in {} samples, so there are no holes", *read.nodata, type_name));
      read.nodata.reset();
    }
    read.samples = read_kept<T>(band, window, as, read.nodata, signed_bytes, found, session, progress);
    if (!becomes.empty())
      read.notes.push_back(fmt::format("{} samples are kept as {}", signed_bytes ? "Int8" : type_name, becomes));
  };
  if (type == GDT_Int16) {
    integers(std::int16_t{}, GDT_Int16, "");
  } else if (type == GDT_UInt16) {
    integers(std::uint16_t{}, GDT_UInt16, "");
  } else if (signed_bytes || type_name == "Int8") {
    integers(std::int16_t{}, GDT_Int16, "int16");
  } else if (type == GDT_Byte) {
    integers(std::uint16_t{}, GDT_UInt16, "uint16");
  } else if (type == GDT_Float32) {
    read.samples = read_kept<float>(band, window, GDT_Float32, read.nodata, false, found, session, progress);
  } else {
    read.samples = read_narrowed(band, window, read.nodata, found, session, progress);
    read.notes.push_back(
        found.rounding == 0
            ? fmt::format("{} samples converted to float32 without rounding", type_name)
            : fmt::format("{} samples converted to float32, rounded by at most {:.3g}", type_name, found.rounding));
  }
  // Float holes whose mark does not fit in float32 are NaN by now.
  if (std::holds_alternative<std::vector<float>>(read.samples) && read.nodata) {
    if (float_can_hold(*read.nodata)) {
      read.nodata = static_cast<double>(static_cast<float>(*read.nodata));
    } else {
      read.nodata.reset();
    }
  }
  // A mask that only repeats the nodata value adds nothing, and the caller's nodata value overrides it.
  if (has_own_mask(band)) {
    const std::int64_t hidden = apply_mask(*band.GetMaskBand(), window, read, session);
    if (hidden > 0)
      read.notes.push_back(fmt::format("{} samples are holes by the file's {}", hidden,
                                       band.GetMaskFlags() & GMF_ALPHA ? "alpha band" : "mask"));
  }
  if (found.nan > 0) read.notes.push_back(fmt::format("{} samples are NaN: holes", found.nan));
  if (found.beyond > 0) {
    // The shortest digits of a float are not those of the same number as a double.
    const auto text = [](double x) {
      return std::abs(x) <= FLT_MAX && static_cast<float>(x) == x ? fmt::format("{}", static_cast<float>(x))
                                                                  : fmt::format("{}", x);
    };
    const std::string value = found.least_beyond == found.most_beyond
                                  ? "of " + text(found.least_beyond)
                                  : fmt::format("from {} to {}", text(found.least_beyond), text(found.most_beyond));
    read.notes.push_back(
        fmt::format("{} samples {} are taken as holes: no heights are beyond {:g} (--nodata=nan keeps "
                    "them)",
                    found.beyond, value, kBeyondHeights));
  }
  if (all_holes(read)) {
    throw Error(fmt::format("all {} x {} samples are nodata{} (choose another --window or --nodata)", window.cols,
                            window.rows, read.nodata ? fmt::format(" ({})", *read.nodata) : ""));
  }
  return read;
}

}  // namespace scarp
