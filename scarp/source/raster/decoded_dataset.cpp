// SPDX-License-Identifier: MIT
#include "scarp/source/raster/decoded_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "scarp/base/error.h"

namespace scarp {
namespace {

class DecodedBand final : public GDALRasterBand {
 public:
  DecodedBand(GDALDataset& owner, GDALDataset& colours, HeightEncoding encoding)
      : colours_(colours), scale_(scale_of(encoding)) {
    poDS = &owner;
    nBand = 1;
    eDataType = GDT_Float32;
    colours.GetRasterBand(1)->GetBlockSize(&nBlockXSize, &nBlockYSize);
  }

  double GetScale(int* success) override { return found(scale_.scale, success); }
  double GetOffset(int* success) override { return found(scale_.offset, success); }

 protected:
  CPLErr IReadBlock(int block_col, int block_row, void* data) override {
    const int col = block_col * nBlockXSize, row = block_row * nBlockYSize;
    const int cols = std::min(nBlockXSize, nRasterXSize - col), rows = std::min(nBlockYSize, nRasterYSize - row);
    const int bands = colours_.GetRasterCount();
    pixels_.resize(static_cast<std::size_t>(nBlockXSize) * static_cast<std::size_t>(nBlockYSize) *
                   static_cast<std::size_t>(bands));
    const GSpacing line = static_cast<GSpacing>(nBlockXSize) * bands;
    const CPLErr result = colours_.RasterIO(GF_Read, col, row, cols, rows, pixels_.data(), cols, rows, GDT_Byte, bands,
                                            nullptr, bands, line, 1, nullptr);
    if (result != CE_None) return result;
    decode_rgb(pixels_.data(), static_cast<std::size_t>(nBlockXSize) * static_cast<std::size_t>(rows), bands,
               static_cast<float*>(data));
    return CE_None;
  }

 private:
  static double found(double value, int* success) {
    if (success) *success = TRUE;
    return value;
  }
  GDALDataset& colours_;
  EncodingScale scale_;
  std::vector<std::uint8_t> pixels_;
};

void check_colours(GDALDataset& colours, HeightEncoding encoding) {
  const int bands = colours.GetRasterCount();
  std::string found = fmt::format("it has {} band{}", bands, bands == 1 ? "" : "s");
  bool good = bands == 3 || bands == 4;
  for (int b = 1; good && b <= bands; ++b) {
    const GDALDataType type = colours.GetRasterBand(b)->GetRasterDataType();
    if (type == GDT_Byte) continue;
    good = false;
    found += fmt::format(" of {}", GDALGetDataTypeName(type));
  }
  if (bands == 1 && colours.GetRasterBand(1)->GetColorTable()) found += " with a palette";
  if (!good) {
    throw Error(
        fmt::format("{} needs byte bands for red, green, blue and optionally alpha; {}", name_of(encoding), found));
  }
}

}  // namespace

DecodedDataset::DecodedDataset(GDALDataset& colours, HeightEncoding encoding) : colours_(colours) {
  check_colours(colours, encoding);
  nRasterXSize = colours.GetRasterXSize();
  nRasterYSize = colours.GetRasterYSize();
  SetBand(1, new DecodedBand(*this, colours, encoding));
}

}  // namespace scarp
