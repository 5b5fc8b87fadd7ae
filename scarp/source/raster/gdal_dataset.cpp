// SPDX-License-Identifier: MIT
#include "scarp/source/raster/gdal_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/source/raster/band_samples.h"
#include "scarp/source/raster/decoded_dataset.h"
#include "scarp/source/raster/default_scale.h"
#include "scarp/source/raster/raster_place.h"
#include "scarp/source/raster/suspected_nodata.h"
#include "scarp/source/raster/vertical_unit.h"

namespace scarp {
namespace {

constexpr std::size_t kWarningsWorthANote = 3;
constexpr int kSubdatasetsListed = 6;

// Rejects a container without bands of its own (netCDF, HDF5), listing its contents.
[[noreturn]] void refuse_container(GDALDataset& dataset) {
  char** names = dataset.GetMetadata("SUBDATASETS");
  std::string list;
  int count = 0;
  for (int i = 1;; ++i) {
    const char* name = CSLFetchNameValue(names, fmt::format("SUBDATASET_{}_NAME", i).c_str());
    if (!name) break;
    if (++count <= kSubdatasetsListed) list += fmt::format("{}{}", list.empty() ? "" : ", ", name);
  }
  if (count == 0) throw Error("no raster band");
  if (count > kSubdatasetsListed) list += fmt::format(" and {} more", count - kSubdatasetsListed);
  throw Error(fmt::format("container of {} rasters (open one of them: {})", count, list));
}

RasterWindow choose_window(GDALDataset& dataset, const std::optional<RasterWindow>& wanted) {
  const int cols = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
  if (!wanted) return {0, 0, cols, rows};
  const RasterWindow& w = *wanted;
  if (w.col < 0 || w.row < 0 || w.cols < 1 || w.rows < 1 || w.cols > cols - w.col || w.rows > rows - w.row) {
    throw Error(fmt::format("window {},{},{},{} is not inside the {} x {} samples (use --window COL,ROW,COLS,ROWS)",
                            w.col, w.row, w.cols, w.rows, cols, rows));
  }
  return w;
}

// Metres per vertical unit; precedence: the caller, the band, the vertical CRS.
double choose_vertical_unit(GDALRasterBand& band, const RasterPlace& place, const std::string& wanted, Raster& raster) {
  if (!wanted.empty()) {
    const auto metres = metres_per_vertical_unit(wanted);
    if (!metres)
      throw Error(fmt::format("unknown vertical unit '{}' (known: m, ft, us-ft, km, dm, cm, mm, yd, fathom)", wanted));
    raster.vertical_unit = wanted;
    return *metres;
  }
  const std::string own = band.GetUnitType();
  if (!own.empty()) {
    raster.vertical_unit = own;
    if (const auto metres = metres_per_vertical_unit(own)) return *metres;
    raster.notes.push_back(fmt::format("unknown vertical unit '{}', assuming metres (override with --unit)", own));
    return 1;
  }
  if (place.vertical_unit > 0) {
    raster.vertical_unit = place.vertical_unit_name;
    return place.vertical_unit;
  }
  // Maps in feet usually have heights in feet.
  if (const std::string_view foot = foot_of(place.map_unit); !foot.empty()) {
    raster.notes.push_back(
        fmt::format("map units are feet, but heights are assumed to be metres (override with --unit {})", foot));
  }
  return 1;
}

void find_heights(GDALRasterBand& band, const RasterPlace& place, const RasterOptions& options, Raster& raster) {
  raster.scale = options.scale ? *options.scale : band.GetScale();
  raster.offset = options.offset ? *options.offset : band.GetOffset();
  if (!std::isfinite(raster.scale) || raster.scale == 0 || !std::isfinite(raster.offset)) {
    throw Error(
        fmt::format("invalid scale or offset: heights are sample * {} + {} (override with a finite, non-zero --scale "
                    "and a finite --offset)",
                    raster.scale, raster.offset));
  }
  const double unit = choose_vertical_unit(band, place, options.unit, raster);
  if (unit != 1) {
    raster.scale *= unit;
    raster.offset *= unit;
    raster.notes.push_back(fmt::format("heights converted from '{}' to metres: x {:.10g}", raster.vertical_unit, unit));
  }
}

// Raster::scale is positive, so a negative scale is applied to the samples here.
void apply_negative_scale(Raster& raster) {
  std::visit(
      [&](const auto& samples) {
        std::vector<float> heights(samples.size());
        std::transform(samples.begin(), samples.end(), heights.begin(), [&](auto sample) {
          if (raster.nodata && sample == *raster.nodata) return std::numeric_limits<float>::quiet_NaN();
          return static_cast<float>(static_cast<double>(sample) * raster.scale + raster.offset);
        });
        raster.samples = std::move(heights);
      },
      decltype(raster.samples)(std::move(raster.samples)));
  raster.notes.push_back(fmt::format("negative scale ({:g}): heights converted to float32 metres", raster.scale));
  raster.scale = 1;
  raster.offset = 0;
  raster.nodata.reset();
}

double last_of(const SampleSpacing& side, int samples) { return side.first + (samples - 1) * side.step; }

// Moves the georeference from the window's samples to those of the reduced raster.
void respace(Georeference& geo, const SampleSpacing& across, const SampleSpacing& down) {
  geo.cell_x_m *= across.step;
  geo.cell_y_m *= down.step;
  if (!geo.present) return;
  auto& map = geo.map_from_node;
  map[0] += across.first * map[1];
  map[3] += down.first * map[5];
  map[1] *= across.step;
  map[5] *= down.step;
}

void flip(Raster& raster, bool rows, bool cols) {
  std::visit(
      [&](auto& samples) {
        const auto begin = samples.begin();
        for (std::ptrdiff_t north = 0, south = raster.rows - 1; rows && north < south; ++north, --south) {
          std::swap_ranges(begin + north * raster.cols, begin + (north + 1) * raster.cols, begin + south * raster.cols);
        }
        for (std::ptrdiff_t row = 0; cols && row < raster.rows; ++row) {
          std::reverse(begin + row * raster.cols, begin + (row + 1) * raster.cols);
        }
      },
      raster.samples);
}

// Whether a band is the first band of a colour image, in any colour model.
bool is_of_photographs(GDALColorInterp meaning) {
  return meaning == GCI_RedBand || meaning == GCI_CyanBand || meaning == GCI_YCbCr_YBand;
}

bool has_sign(GDALDataType type, bool signed_byte) { return signed_byte || GDALDataTypeIsSigned(type); }

// The largest value of an integer type.
double greatest_integer(GDALDataType type, bool with_sign) {
  return std::exp2(GDALGetDataTypeSizeBits(type) - (with_sign ? 1 : 0)) - 1;
}

// Whether the format is an image format, which has no height scale.
bool is_picture_format(GDALDataset& dataset) {
  constexpr std::string_view kDrivers[] = {"PNG", "PNM", "BMP", "GIF", "JPEG", "WEBP", "SGI", "JPEGXL", "PCX"};
  GDALDriver* driver = dataset.GetDriver();
  return driver && std::find(std::begin(kDrivers), std::end(kDrivers), driver->GetDescription()) != std::end(kDrivers);
}

}  // namespace

std::vector<std::string> files_of(GDALDataset& dataset) {
  const CPLStringList list(dataset.GetFileList());
  std::vector<std::string> files;
  for (int i = 0; i < list.size(); ++i) files.emplace_back(list[i]);
  return files;
}

int height_band(GDALDataset& dataset, int wanted) {
  const int count = dataset.GetRasterCount();
  if (count == 0) refuse_container(dataset);
  if (wanted != 0) {
    if (wanted < 1 || wanted > count)
      throw Error(fmt::format("no band {}: the file has {} band{} (choose one with --band 1..{})", wanted, count,
                              count == 1 ? "" : "s", count));
    return wanted;
  }
  int heights = 0, chosen = 0;
  bool colours = false;
  for (int b = 1; b <= count; ++b) {
    const GDALColorInterp meaning = dataset.GetRasterBand(b)->GetColorInterpretation();
    if (meaning == GCI_AlphaBand) continue;
    ++heights;
    if (chosen == 0) chosen = b;
    colours = colours || is_of_photographs(meaning);
  }
  if (heights != 1) {
    throw Error(fmt::format(
        "{} with {} bands (choose the band of heights with --band 1..{}{})", colours ? "colour photograph" : "raster",
        count, count,
        colours ? ", or declare colours that encode heights with --encoding terrain-rgb or terrarium" : ""));
  }
  if (dataset.GetRasterBand(chosen)->GetColorTable()) {
    throw Error("samples are palette indices, not heights (use --band 1 if they are heights)");
  }
  return chosen;
}

bool is_picture(GDALDataset& dataset) {
  for (int b = 1; b <= dataset.GetRasterCount(); ++b) {
    GDALRasterBand& band = *dataset.GetRasterBand(b);
    if (is_of_photographs(band.GetColorInterpretation()) || band.GetColorTable()) return true;
  }
  return false;
}

bool has_place(GDALDataset& dataset) {
  GeoTransform map{};
  return dataset.GetGeoTransform(map.data()) == CE_None;
}

void settle_height_range(RasterOptions& options, GDALDataType type, bool signed_byte) {
  if (!options.height_range) return;
  const HeightRange range = *options.height_range;
  if (options.scale || options.offset)
    throw Error("--height-range cannot be combined with --scale or --offset (omit one of them)");
  if (options.encoding != HeightEncoding::none)
    throw Error("--height-range cannot be combined with --encoding, which defines its own scale (omit one of them)");
  if (!(std::isfinite(range.low) && std::isfinite(range.high) && range.low < range.high))
    throw Error(fmt::format("height range {},{} is empty (use --height-range LOW,HIGH with LOW < HIGH)", range.low,
                            range.high));
  const bool floating = GDALDataTypeIsFloating(type);
  if (!floating && has_sign(type, signed_byte))
    throw Error(
        fmt::format("samples are signed ({}), but --height-range applies to unsigned samples (use --scale and "
                    "--offset)",
                    GDALGetDataTypeName(type)));
  const double greatest = floating ? 1 : greatest_integer(type, false);
  options.scale = (range.high - range.low) / greatest;
  options.offset = range.low;
  options.height_range.reset();
}

Raster read_dataset(GDALDataset& stored, const RasterOptions& given, GdalSession& session, const Progress& progress) {
  RasterOptions options = given;
  std::unique_ptr<DecodedDataset> decoded;
  if (options.encoding != HeightEncoding::none) {
    if (options.band != 0) throw Error("--encoding reads three bands at once (omit --band)");
    decoded = std::make_unique<DecodedDataset>(stored, options.encoding);
  }
  GDALDataset& dataset = decoded ? *decoded : stored;
  GDALRasterBand& band = *dataset.GetRasterBand(height_band(dataset, options.band));
  settle_height_range(options, band.GetRasterDataType(), is_signed_byte(band));
  const RasterWindow window = choose_window(dataset, options.window);
  Raster raster;
  raster.files = files_of(stored);
  raster.file_type = decoded ? std::string(name_of(options.encoding)) : GDALGetDataTypeName(band.GetRasterDataType());

  // Errors that do not require reading samples come first.
  RasterPlace place = find_place(dataset, window, options);
  raster.georeference = place.georeference;
  find_heights(band, place, options, raster);
  BandSamples read = read_band(band, window, options.nodata, options.decimation, session, progress);
  raster.samples = std::move(read.samples);
  raster.cols = read.cols;
  raster.rows = read.rows;
  if (place.flip_cols) read.across.first = window.cols - 1 - last_of(read.across, read.cols);
  if (place.flip_rows) read.down.first = window.rows - 1 - last_of(read.down, read.rows);
  respace(raster.georeference, read.across, read.down);
  raster.nodata = read.nodata;
  const GDALDataType type = band.GetRasterDataType();
  std::optional<double> greatest;
  if (!GDALDataTypeIsFloating(type)) greatest = greatest_integer(type, has_sign(type, is_signed_byte(band)));
  const bool scaled = options.scale || options.offset || !options.unit.empty() || raster.scale != 1 ||
                      raster.offset != 0 || !raster.vertical_unit.empty();
  const double longer_side = std::max((dataset.GetRasterXSize() - 1) * place.georeference.cell_x_m,
                                      (dataset.GetRasterYSize() - 1) * place.georeference.cell_y_m);
  const std::string proportion = settle_default_scale(
      raster,
      {is_picture_format(stored), scaled, has_sign(type, is_signed_byte(band)) ? std::nullopt : greatest, longer_side});
  const std::vector<std::string> suspected = suspected_nodata(raster, greatest);
  if (raster.scale < 0) apply_negative_scale(raster);
  flip(raster, place.flip_rows, place.flip_cols);

  raster.notes.insert(raster.notes.end(), read.notes.begin(), read.notes.end());
  raster.notes.insert(raster.notes.end(), suspected.begin(), suspected.end());
  raster.notes.insert(raster.notes.end(), place.notes.begin(), place.notes.end());
  if (!proportion.empty()) raster.notes.push_back(proportion);
  const auto& warnings = session.warnings();
  for (std::size_t i = 0; i < std::min(warnings.size(), kWarningsWorthANote); ++i)
    raster.notes.push_back("GDAL: " + warnings[i]);
  return raster;
}

}  // namespace scarp
