// SPDX-License-Identifier: MIT
#include "scarp/source/raster/band_samples.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>
#include <type_traits>

#include "scarp/base/error.h"
#include "scarp/source/raster/band_pieces.h"
#include "scarp/source/raster/suspected_nodata.h"

namespace scarp {
namespace {

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

// Special samples found while reading.
struct Findings {
  std::int64_t nan = 0;
  std::int64_t hidden = 0;  // by a mask
  double rounding = 0;      // largest change by the conversion to float32
  bool beyond_are_holes = true;
  std::int64_t beyond = 0;  // undeclared marks beyond all heights
  double least_beyond = 0, most_beyond = 0;
};

// Whether a float sample equals the nodata value within the precision of files: decimal text such as -3.402823e+38
// differs from the value by a few units in the last place. The tolerance is that of GDAL's own test (4 epsilons,
// gdal_priv.h: ARE_REAL_EQUAL); for marks beyond all heights it is half a unit of the sixth digit: printf writes six
// digits by default.
bool is_float_nodata(double sample, double nodata) {
  constexpr double kSixDigits = 0.5e-5;
  const double width = std::abs(nodata) > kBeyondHeights ? kSixDigits : 4 * double{FLT_EPSILON};
  return sample == nodata || (std::isfinite(nodata) && std::abs(sample - nodata) <= width * std::abs(nodata));
}

// Whether a nodata value is neither beyond the largest float nor so small that it would become height 0.
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

// Whether clean() would neither change a line nor throw. There is no branch per sample, so that compilers vectorise it.
bool is_clean(const float* line, int samples, std::optional<double> nodata) {
  constexpr double kAround = 1e-5;  // more than the widest tolerance of is_float_nodata()
  const double mark = nodata.value_or(0), width = kAround * std::abs(mark);
  const auto low = static_cast<float>(mark - width), high = static_cast<float>(mark + width);
  constexpr auto kBeyond = static_cast<float>(kBeyondHeights);
  int plain = 0, marked = 0;
  for (int i = 0; i < samples; ++i) plain += std::abs(line[i]) < kBeyond;
  for (int i = 0; nodata && i < samples; ++i) marked += (line[i] >= low) & (line[i] <= high);
  return plain == samples && marked == 0;
}

// How samples are stored in the file.
struct Stored {
  GDALDataType type = GDT_Unknown;
  bool signed_bytes = false;
  std::optional<double> nodata;
  GDALRasterBand* mask = nullptr;  // hides samples where it is 0; they are then read as floats; null: none
};

// Whether float32 cannot represent all values of the type.
bool is_wide(GDALDataType type) {
  return GDALDataTypeIsFloating(type) ? type != GDT_Float32 : GDALGetDataTypeSizeBits(type) > 16;
}

// Reads pieces as samples of type T and applies clean().
template <class T>
class PieceReader {
 public:
  PieceReader(GDALRasterBand& band, const Stored& stored, Findings& found, GdalSession& session)
      : band_(band), stored_(stored), found_(found), session_(session) {}

  // Rows of `out` are `row_samples` samples apart.
  void read(const RasterWindow& piece, T* out, int row_samples) {
    if constexpr (std::is_floating_point_v<T>) {
      if (is_wide(stored_.type)) {
        wide_.resize(static_cast<std::size_t>(piece.rows) * static_cast<std::size_t>(piece.cols));
        read_piece(band_, piece, GDT_Float64, wide_.data(), piece.cols, session_);
        tidy(piece, wide_.data(), piece.cols, out, row_samples);
      } else {
        read_piece(band_, piece, GDT_Float32, out, row_samples, session_);
        tidy(piece, out, row_samples, out, row_samples);
      }
      if (stored_.mask) hide(piece, out, row_samples);
    } else {
      read_piece(band_, piece, std::is_signed_v<T> ? GDT_Int16 : GDT_UInt16, out, row_samples, session_);
      for (int row = 0; stored_.signed_bytes && row < piece.rows; ++row) {
        T* const line = out + static_cast<std::ptrdiff_t>(row) * row_samples;
        std::transform(line, line + piece.cols, line, [](T s) { return static_cast<T>(static_cast<std::int8_t>(s)); });
      }
    }
  }

 private:
  template <class Source>
  void tidy(const RasterWindow& piece, const Source* in, int in_row_samples, float* out, int row_samples) {
    for (int row = 0; row < piece.rows; ++row) {
      const Source* const source = in + static_cast<std::ptrdiff_t>(row) * in_row_samples;
      float* const line = out + static_cast<std::ptrdiff_t>(row) * row_samples;
      if constexpr (std::is_same_v<Source, float>) {
        if (!stored_.signed_bytes && is_clean(source, piece.cols, stored_.nodata)) continue;
      }
      for (int col = 0; col < piece.cols; ++col) {
        const double sample = stored_.signed_bytes && source[col] > 127 ? source[col] - 256 : source[col];
        line[col] = clean(sample, stored_.nodata, piece.col + col, piece.row + row, found_);
      }
    }
  }

  void hide(const RasterWindow& piece, float* out, int row_samples) {
    mask_.resize(static_cast<std::size_t>(piece.rows) * static_cast<std::size_t>(piece.cols));
    read_piece(*stored_.mask, piece, GDT_Byte, mask_.data(), piece.cols, session_);
    for (std::size_t i = 0; i < mask_.size(); ++i) {
      if (mask_[i] != 0) continue;
      const auto row = static_cast<std::ptrdiff_t>(i) / piece.cols, col = static_cast<std::ptrdiff_t>(i) % piece.cols;
      out[row * row_samples + col] = std::numeric_limits<float>::quiet_NaN();
      ++found_.hidden;
    }
  }

  GDALRasterBand& band_;
  const Stored& stored_;
  Findings& found_;
  GdalSession& session_;
  std::vector<double> wide_;
  std::vector<std::uint8_t> mask_;
};

// The only loop that reads samples: into the result, or block by block into averages.
template <class T>
std::vector<T> read_as(const ReadingPlan& plan, const Stored& stored, Findings& found, GdalSession& session,
                       const Progress& progress) {
  const RasterWindow& window = plan.window;
  PieceReader<T> reader(*plan.band, stored, found, session);
  if (!plan.decimates) {
    std::vector<T> samples(static_cast<std::size_t>(window.cols) * static_cast<std::size_t>(window.rows));
    for_pieces(*plan.band, window, sizeof(T), progress,
               {[&](const RasterWindow& piece) {
                  reader.read(piece,
                              samples.data() + static_cast<std::ptrdiff_t>(piece.row - window.row) * window.cols +
                                  (piece.col - window.col),
                              window.cols);
                },
                {}});
    return samples;
  }
  std::optional<T> hole;
  if (stored.nodata && (!std::is_floating_point_v<T> || float_can_hold(*stored.nodata)))
    hole = static_cast<T>(*stored.nodata);
  // Blocks that a file omits have the nodata value.
  const bool sparse = stored.nodata && stored.nodata == nodata_of(*plan.band);
  Decimator<T> decimator(window.cols, window.rows, plan.cols, plan.rows, hole);
  std::vector<T> samples;
  for_pieces(*plan.band, window, sizeof(T), progress,
             {[&](const RasterWindow& piece) {
                if (sparse && is_empty_piece(*plan.band, piece)) return;
                samples.resize(static_cast<std::size_t>(piece.cols) * static_cast<std::size_t>(piece.rows));
                reader.read(piece, samples.data(), piece.cols);
                decimator.add({piece.col - window.col, piece.row - window.row, piece.cols, piece.rows}, samples.data());
              },
              [&](int end) { decimator.close_rows(end - window.row); }});
  return decimator.finish(plan.known);
}

// Whether a mask hides any sample of the window.
bool hides_some(GDALRasterBand& mask, const RasterWindow& window, GdalSession& session) {
  std::vector<std::uint8_t> samples;
  bool hides = false;
  for_pieces(mask, window, 1, {},
             {[&](const RasterWindow& piece) {
                if (hides) return;
                samples.resize(static_cast<std::size_t>(piece.cols) * static_cast<std::size_t>(piece.rows));
                read_piece(mask, piece, GDT_Byte, samples.data(), piece.cols, session);
                hides = std::find(samples.begin(), samples.end(), 0) != samples.end();
              },
              {}});
  return hides;
}

// GDAL holds a whole block in memory.
void refuse_large_blocks(GDALRasterBand& band, double memory) {
  constexpr double kMostShare = 0.25, kMebi = 1 << 20;
  int cols = 0, rows = 0;
  band.GetBlockSize(&cols, &rows);
  const double bytes = static_cast<double>(cols) * rows * GDALGetDataTypeSizeBytes(band.GetRasterDataType());
  if (bytes > kMostShare * memory)
    throw Error(
        fmt::format("a block of {} x {} samples takes {:.0f} MiB, more than a quarter of --memory (raise it, or first: "
                    "gdal_translate -co TILED=YES)",
                    cols, rows, bytes / kMebi));
}

template <class T>
bool holds(double value) {
  return value >= std::numeric_limits<T>::lowest() && value <= std::numeric_limits<T>::max() &&
         value == std::floor(value);
}

}  // namespace

SampleVector empty_samples(GDALRasterBand& band) {
  const GDALDataType type = band.GetRasterDataType();
  const std::string_view name = GDALGetDataTypeName(type);
  if (GDALDataTypeIsComplex(type))
    throw Error(fmt::format("samples are complex numbers ({}) (convert them with gdal_translate -ot Float32)", name));
  if (has_own_mask(band)) return std::vector<float>();
  if (type == GDT_Int16 || is_signed_byte(band) || name == "Int8") return std::vector<std::int16_t>();
  if (type == GDT_UInt16 || type == GDT_Byte) return std::vector<std::uint16_t>();
  return std::vector<float>();
}

std::optional<double> nodata_in_memory(std::optional<double> nodata, const SampleVector& samples) {
  if (!nodata || std::isnan(*nodata)) return {};
  return std::visit(
      [&]<class T>(const std::vector<T>&) -> std::optional<double> {
        if constexpr (std::is_floating_point_v<T>) {
          if (!float_can_hold(*nodata)) return {};
          return static_cast<double>(static_cast<float>(*nodata));
        } else {
          return holds<T>(*nodata) ? nodata : std::nullopt;
        }
      },
      samples);
}

void refuse_all_nodata(const Raster& raster, const RasterWindow& window) {
  const bool holes_alone = std::visit(
      [&](const auto& samples) {
        return std::all_of(samples.begin(), samples.end(),
                           [&](auto s) { return s != s || (raster.nodata && s == *raster.nodata); });
      },
      raster.samples);
  if (holes_alone) {
    throw Error(fmt::format("all {} x {} samples are nodata{} (choose another --window or --nodata)", window.cols,
                            window.rows, raster.nodata ? fmt::format(" ({})", *raster.nodata) : ""));
  }
}

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

BandSamples read_band(GDALRasterBand& band, const RasterWindow& window, std::optional<double> nodata,
                      const std::optional<Decimation>& decimation, std::optional<double> memory, GdalSession& session,
                      const Progress& progress) {
  const GDALDataType type = band.GetRasterDataType();
  const std::string_view type_name = GDALGetDataTypeName(type);
  empty_samples(band);  // rejects complex ones
  if (memory) refuse_large_blocks(band, *memory);
  const GdalCacheLimit cache;
  const ReadingPlan plan = plan_reading(band, window, decimation, !nodata);
  BandSamples read;
  read.cols = plan.cols;
  read.rows = plan.rows;
  read.across = plan.across;
  read.down = plan.down;
  read.nodata = nodata ? nodata : nodata_of(band);
  if (read.nodata && std::isnan(*read.nodata)) read.nodata.reset();
  if (!plan.note.empty()) read.notes.push_back(plan.note);

  Stored stored{type, is_signed_byte(band), {}, nullptr};
  // A mask that only repeats the nodata value adds nothing, and the caller's nodata value overrides it.
  if (has_own_mask(*plan.band)) stored.mask = plan.band->GetMaskBand();
  // If the raster is reduced, this check is skipped: it would read the mask twice.
  if (stored.mask && !plan.decimates && !hides_some(*stored.mask, window, session)) stored.mask = nullptr;
  Findings found;
  found.beyond_are_holes = !nodata;
  const auto require_room = [&](std::size_t bytes) {
    if (!memory) refuse_beyond_memory({0, 0, plan.cols, plan.rows}, static_cast<int>(bytes));
  };
  const auto read_floats = [&] {
    require_room(sizeof(float));
    read.samples = read_as<float>(plan, stored, found, session, progress);
  };
  const auto integers = [&]<class T>(T, std::string_view becomes) {
    if (read.nodata && !holds<T>(*read.nodata)) {
      read.notes.push_back(
          fmt::format("nodata value {} cannot occur in {} samples, so there are no holes", *read.nodata, type_name));
      read.nodata.reset();
    }
    stored.nodata = read.nodata;
    if (stored.mask) return read_floats();
    require_room(sizeof(T));
    read.samples = read_as<T>(plan, stored, found, session, progress);
    if (!becomes.empty())
      read.notes.push_back(fmt::format("{} samples are kept as {}", stored.signed_bytes ? "Int8" : type_name, becomes));
  };
  if (type == GDT_Int16) {
    integers(std::int16_t{}, "");
  } else if (type == GDT_UInt16) {
    integers(std::uint16_t{}, "");
  } else if (stored.signed_bytes || type_name == "Int8") {
    integers(std::int16_t{}, "int16");
  } else if (type == GDT_Byte) {
    integers(std::uint16_t{}, "uint16");
  } else {
    stored.nodata = read.nodata;
    read_floats();
    if (type != GDT_Float32)
      read.notes.push_back(
          found.rounding == 0
              ? fmt::format("{} samples converted to float32 without rounding", type_name)
              : fmt::format("{} samples converted to float32, rounded by at most {:.3g}", type_name, found.rounding));
  }
  // Float holes whose mark does not fit in float32 have become NaN.
  read.nodata = nodata_in_memory(read.nodata, read.samples);
  if (found.hidden > 0)
    read.notes.push_back(fmt::format("{} samples are holes by the file's {}", found.hidden,
                                     band.GetMaskFlags() & GMF_ALPHA ? "alpha band" : "mask"));
  if (found.nan > 0) read.notes.push_back(fmt::format("{} samples are NaN: holes", found.nan));
  if (found.beyond > 0) {
    // The shortest digits of a float differ from those of the same number as a double.
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
  return read;
}

}  // namespace scarp
