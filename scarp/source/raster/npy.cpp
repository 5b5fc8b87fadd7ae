// SPDX-License-Identifier: MIT
#include "scarp/source/raster/npy.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/npy_header.h"
#include "scarp/source/raster/band_pieces.h"
#include "scarp/source/raster/band_samples.h"
#include "scarp/source/raster/file_check.h"
#include "scarp/source/raster/raw_band.h"
#include "scarp/source/raster/vsi_file.h"
#include "scarp/source/raster/zip_archive.h"

namespace scarp {
namespace {

NpyHeader read_header(const std::string& path, const GdalSession& session) {
  const VsiFile file(VSIFOpenL(path.c_str(), "rb"));
  if (!file) throw Error(fmt::format("cannot be opened: {}", session.reason("permission denied, or no such file")));
  std::string bytes(kNpyPreambleBytes, '\0');
  bytes.resize(VSIFReadL(bytes.data(), 1, bytes.size(), file.get()));
  const auto header_bytes = static_cast<std::size_t>(npy_data_begin(bytes));
  bytes.resize(header_bytes);
  VSIFSeekL(file.get(), 0, SEEK_SET);
  bytes.resize(VSIFReadL(bytes.data(), 1, bytes.size(), file.get()));
  return parse_npy_header(bytes);
}

std::string shape_text(const NpyHeader& header) {
  std::string text;
  for (const std::int64_t extent : header.shape) text += fmt::format("{}{}", text.empty() ? "" : " x ", extent);
  return text.empty() ? "a single number" : text;
}

// Extents (rows, columns) of an array that is a raster, otherwise nullopt.
std::optional<std::pair<std::int64_t, std::int64_t>> raster_shape(const NpyHeader& header) {
  std::vector<std::int64_t> shape = header.shape;
  if (shape.size() == 3 && shape.front() == 1) {
    shape.erase(shape.begin());
  } else if (shape.size() == 3 && shape.back() == 1) {
    shape.pop_back();
  }
  if (shape.size() != 2) return {};
  return std::pair(shape[0], shape[1]);
}

bool is_half(const NpyHeader& header) { return header.kind == 'f' && header.bytes == 2; }

bool is_readable(const NpyHeader& header) {
  return is_half(header) || raw_sample_type(header.kind, header.bytes).has_value();
}

// Returns a word for arrays that contain something else; empty if there is none.
std::string_view word_of(const NpyHeader& header) {
  switch (header.kind) {
    case 'b':
      return "true and false";
    case 'c':
      return "complex numbers";
    case 'O':
      return "Python objects";
    case 'V':
      return "structures";
    default:
      return "";
  }
}

// Halves are read as 16-bit integers and converted to float32 afterwards.
RawSampleType sample_type(const NpyHeader& header) {
  if (is_half(header)) return {GDT_UInt16, false};
  if (const auto type = raw_sample_type(header.kind, header.bytes)) return *type;
  const std::string_view word = word_of(header);
  throw Error(fmt::format(
      "unsupported sample type '{}'{} (supported: i1 u1 i2 u2 i4 u4 i8 u8 f2 f4 f8; convert with .astype('f4'))",
      header.descr, word.empty() ? "" : fmt::format(" ({})", word)));
}

// The value of an IEEE 754 half: a sign, 5 bits of exponent, 10 of fraction.
float half_value(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  float value = 0;
  if (exponent == 31) {
    value = fraction ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
  } else {
    value = exponent ? std::ldexp(1024.0f + static_cast<float>(fraction), exponent - 25)
                     : std::ldexp(static_cast<float>(fraction), -24);
  }
  return bits >> 15 ? -value : value;
}

// Returns the archive member to read: the only raster. Ignores other members, such as a mask.
std::string choose_member(const std::string& path, const std::string& key, const GdalSession& session) {
  if (is_zip(path)) check_end(path);
  const std::string folder = zip_folder(path);
  std::vector<std::string> rasters, unreadable;
  std::string all;
  for (const std::string& member : zip_members(path)) {
    if (!lower_case(member).ends_with(".npy")) continue;
    const std::string name = member.substr(0, member.size() - 4);
    if (!key.empty() && (name == key || member == key)) return folder + "/" + member;
    all += fmt::format("{}{}", all.empty() ? "" : ", ", name);
    try {
      const NpyHeader header = read_header(folder + "/" + member, session);
      const bool readable = is_readable(header);
      all += fmt::format(" ({}{})", shape_text(header), readable ? "" : fmt::format(" of '{}'", header.descr));
      if (raster_shape(header)) (readable ? rasters : unreadable).push_back(member);
    } catch (const Error&) {
      all += " (not read)";
      unreadable.push_back(member);
    }
  }
  if (all.empty())
    throw Error(fmt::format("not a .npz archive with arrays: {}", session.reason("no member ends in .npy")));
  if (!key.empty()) throw Error(fmt::format("no array '{}' (choose one with --key: {})", key, all));
  // Reading that member reports the problem.
  if (rasters.empty() && unreadable.size() == 1) rasters.swap(unreadable);
  if (rasters.size() != 1) {
    throw Error(fmt::format("{} two-dimensional arrays of heights (choose one with --key: {})", rasters.size(), all));
  }
  return folder + "/" + rasters.front();
}

// Arrays that GDAL cannot read in place are read whole and opened from memory: those in Fortran order, column by column
// through strides (a compressed file can only be read forwards), and halves. `bytes` must outlive the dataset.
GDALDatasetUniquePtr open_in_memory(GDALDataset& stored, const NpyHeader& header, std::vector<std::uint8_t>& bytes,
                                    GdalSession& session) {
  GDALRasterBand& band = *stored.GetRasterBand(1);
  const int width = stored.GetRasterXSize(), height = stored.GetRasterYSize();
  const int cols = header.fortran_order ? height : width, rows = header.fortran_order ? width : height;
  const RasterWindow all{0, 0, width, height};
  const GDALDataType type = is_half(header) ? GDT_Float32 : band.GetRasterDataType();
  const int sample_bytes = GDALGetDataTypeSizeBytes(type);
  refuse_beyond_memory(all, sample_bytes);
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  bytes.resize(count * static_cast<std::size_t>(sample_bytes));
  read_piece(band, all, band.GetRasterDataType(), bytes.data(), width, session);
  // Converts in place, starting with the last: a float takes the space of two halves.
  for (std::size_t i = is_half(header) ? count : 0; i-- > 0;) {
    std::uint16_t half = 0;
    std::memcpy(&half, bytes.data() + i * sizeof(half), sizeof(half));
    const float value = half_value(half);
    std::memcpy(bytes.data() + i * sizeof(value), &value, sizeof(value));
  }
  GDALDriver* const memory = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDatasetUniquePtr dataset(memory ? memory->Create("", cols, rows, 0, GDT_Byte, nullptr) : nullptr);
  char pointer[64] = {};
  CPLPrintPointer(pointer, bytes.data(), sizeof(pointer) - 1);
  CPLStringList strides;
  strides.SetNameValue("DATAPOINTER", pointer);
  const std::int64_t along = sample_bytes, across = std::int64_t{sample_bytes} * width;
  strides.SetNameValue("PIXELOFFSET", fmt::format("{}", header.fortran_order ? across : along).c_str());
  strides.SetNameValue("LINEOFFSET", fmt::format("{}", header.fortran_order ? along : across).c_str());
  if (!dataset || dataset->AddBand(type, strides.List()) != CE_None) {
    throw Error(fmt::format("cannot be opened from memory: {}", session.reason("GDAL gives no reason")));
  }
  if (const char* sign = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE")) {
    dataset->GetRasterBand(1)->SetMetadataItem("PIXELTYPE", sign, "IMAGE_STRUCTURE");
  }
  return dataset;
}

OpenedDataset open_array(const std::string& file, GdalSession& session) {
  const std::int64_t bytes = file_bytes(file);
  const NpyHeader header = read_header(file, session);
  const auto shape = raster_shape(header);
  if (!shape)
    throw Error(fmt::format("array of shape {} (two dimensions required: rows, columns)", shape_text(header)));
  const auto [rows, cols] = *shape;
  const RawSampleType type = sample_type(header);
  if (rows < 1 || cols < 1)
    throw Error(fmt::format("array of shape {} has no samples (save an array that is not empty)", shape_text(header)));
  // GDAL counts the bytes of a line in 32 bits.
  const std::int64_t most = std::numeric_limits<int>::max() / header.bytes;
  if (rows > most || cols > most)
    throw Error(fmt::format("array of shape {} (extents are limited to {})", shape_text(header), most));
  // In double: neither the product nor the sum can overflow.
  const double needed =
      static_cast<double>(header.data_begin) + static_cast<double>(rows) * static_cast<double>(cols) * header.bytes;
  if (static_cast<double>(bytes) < needed) {
    throw Error(fmt::format("truncated: {} samples of {} bytes need {:.0f} bytes, but the file has {} ({})",
                            shape_text(header), header.bytes, needed, bytes, kFetchAgain));
  }

  OpenedDataset opened;
  const int file_cols = static_cast<int>(header.fortran_order ? rows : cols),
            file_rows = static_cast<int>(header.fortran_order ? cols : rows);
  // In memory, an array in Fortran order equals its transpose in C order.
  opened.dataset =
      open_raw_band({file, file_cols, file_rows, type, header.bytes, header.big_endian, header.data_begin}, session);
  if (header.fortran_order || is_half(header))
    opened.dataset = open_in_memory(*opened.dataset, header, opened.memory, session);
  if (is_half(header)) {
    opened.file_type = "Float16";
    opened.notes.push_back("Float16 samples converted to float32 without rounding");
  }
  if (header.shape.size() == 3)
    opened.notes.push_back(fmt::format("array of shape {} read as {} x {}", shape_text(header), rows, cols));
  return opened;
}

}  // namespace

bool is_npy_path(const std::string& path) { return extension_of(path) == ".npy" || extension_of(path) == ".npz"; }

OpenedDataset open_npy(const std::string& path, const RasterOptions& options, GdalSession& session) {
  file_bytes(path);
  check_file(path);
  const bool archive = extension_of(path) == ".npz";
  if (!archive && !options.key.empty()) throw Error("--key applies to .npz archives only (omit it)");
  return open_array(archive ? choose_member(path, options.key, session) : full_path(path), session);
}

}  // namespace scarp
