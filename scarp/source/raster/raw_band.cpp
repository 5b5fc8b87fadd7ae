// SPDX-License-Identifier: MIT
#include "scarp/source/raster/raw_band.h"

#include <fmt/format.h>

#include <filesystem>

#include "scarp/base/error.h"
#include "scarp/source/xml_text.h"

namespace scarp {

std::optional<RawSampleType> raw_sample_type(char kind, int bytes) {
  if (kind == 'i' && bytes == 1) {
    const GDALDataType type = GDALGetDataTypeByName("Int8");
    return type == GDT_Unknown ? RawSampleType{GDT_Byte, true} : RawSampleType{type, false};
  }
  const auto plain = [](GDALDataType type) { return RawSampleType{type, false}; };
  if (kind == 'i' && bytes == 2) return plain(GDT_Int16);
  if (kind == 'i' && bytes == 4) return plain(GDT_Int32);
  if (kind == 'u' && bytes == 1) return plain(GDT_Byte);
  if (kind == 'u' && bytes == 2) return plain(GDT_UInt16);
  if (kind == 'u' && bytes == 4) return plain(GDT_UInt32);
  if (kind == 'i' && bytes == 8) return plain(GDT_Int64);
  if (kind == 'u' && bytes == 8) return plain(GDT_UInt64);
  if (kind == 'f' && bytes == 4) return plain(GDT_Float32);
  if (kind == 'f' && bytes == 8) return plain(GDT_Float64);
  return {};
}

std::string full_path(const std::string& path) {
  return path.starts_with("/vsi") ? path : std::filesystem::absolute(path).string();
}

std::int64_t file_bytes(const std::string& path) {
  VSIStatBufL status;
  if (VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG | VSI_STAT_SIZE_FLAG) != 0) {
    throw Error("does not exist (name a raster file)");
  }
  if (VSI_ISDIR(status.st_mode)) throw Error("is a directory (name a raster file)");
  return static_cast<std::int64_t>(status.st_size);
}

GDALDatasetUniquePtr open_raw_band(const RawBand& band, const GdalSession& session) {
  // Newer versions of GDAL read raw bands of virtual datasets only if this option permits it.
  const GdalOption raw("GDAL_VRT_RAWRASTERBAND_ALLOWED_SOURCE", "ALL");
  const std::string xml = fmt::format(
      "<VRTDataset rasterXSize=\"{0}\" rasterYSize=\"{1}\"><VRTRasterBand dataType=\"{2}\" band=\"1\" "
      "subClass=\"VRTRawRasterBand\">{3}"
      "<SourceFilename "
      "relativeToVRT=\"0\">{4}</SourceFilename><ImageOffset>{5}</ImageOffset><PixelOffset>{6}</PixelOffset>"
      "<LineOffset>{7}</LineOffset><ByteOrder>{8}</ByteOrder></VRTRasterBand></VRTDataset>",
      band.cols, band.rows, GDALGetDataTypeName(band.type.type),
      band.type.signed_bytes ? "<Metadata domain=\"IMAGE_STRUCTURE\"><MDI key=\"PIXELTYPE\">SIGNEDBYTE</MDI></Metadata>"
                             : "",
      xml_text(band.file), band.offset, band.bytes, std::int64_t{band.bytes} * band.cols,
      band.big_endian ? "MSB" : "LSB");
  GDALDatasetUniquePtr dataset(
      GDALDataset::Open(xml.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset) throw Error(fmt::format("cannot be opened as a raw band: {}", session.reason("GDAL gives no reason")));
  return dataset;
}

}  // namespace scarp
