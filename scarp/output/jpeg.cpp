// SPDX-License-Identifier: MIT
#include "scarp/output/jpeg.h"

#include <cpl_string.h>

#include "scarp/base/error.h"
#include "scarp/output/gdal_writing.h"

namespace scarp {
namespace {

constexpr int kMostSide = 65500;                // JPEG_MAX_DIMENSION of libjpeg
constexpr const char* kQuality = "QUALITY=90";  // artefacts at edges are barely visible; a third of a PNG's size

}  // namespace

void write_jpeg(ReplaceFile& file, const std::string& path, const RgbView& picture) {
  require_size(picture, kMostSide, path, "JPEG");
  const GdalWriting writing;
  const double bytes = 3.0 * picture.width * picture.height;
  GDALDriverManager* drivers = GetGDALDriverManager();
  GDALDriver* jpeg = drivers->GetDriverByName("JPEG");
  if (jpeg == nullptr) throw Error(path + ": this build of GDAL writes no JPEG (name it *.png)");
  // The driver can only copy datasets.
  const GDALDatasetUniquePtr pixels(
      drivers->GetDriverByName("MEM")->Create("", picture.width, picture.height, 3, GDT_Byte, nullptr));
  writing.require_good(path, bytes);
  // GDAL takes void* even for memory that it only reads.
  if (pixels->RasterIO(GF_Write, 0, 0, picture.width, picture.height, const_cast<std::uint8_t*>(picture.data),
                       picture.width, picture.height, GDT_Byte, 3, nullptr, 3, std::int64_t{3} * picture.width, 1,
                       nullptr) == CE_None) {
    CPLStringList options;
    options.AddString(kQuality);
    const GDALDatasetUniquePtr written(
        jpeg->CreateCopy(file.temporary_path().c_str(), pixels.get(), false, options.List(), nullptr, nullptr));
  }
  writing.require_good(path, bytes);
  file.commit();
}

}  // namespace scarp
