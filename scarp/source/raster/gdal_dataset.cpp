// SPDX-License-Identifier: MIT
#include "scarp/source/raster/gdal_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/base/vertical_unit.h"
#include "scarp/source/raster/band_samples.h"
#include "scarp/source/raster/decoded_dataset.h"
#include "scarp/source/raster/default_scale.h"
#include "scarp/source/raster/raster_place.h"
#include "scarp/source/raster/suspected_nodata.h"

namespace scarp {
namespace {

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

// Replaces a negative scale by 1, because Raster::scale is positive, and applies it to the samples.
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

// A band whose position and heights are known: everything but its samples.
struct DatasetReader::Band {
  RasterOptions options;
  std::unique_ptr<DecodedDataset> decoded;
  GDALDataset* dataset = nullptr;
  GDALRasterBand* band = nullptr;
  RasterWindow window;
  RasterPlace place;
  Raster raster;                   // without samples
  std::optional<double> greatest;  // largest value of an integer type
  HeightsStated heights;

  // The window of the band that holds a part of the raster: before the flips.
  RasterWindow stored(const RasterWindow& part) const {
    return {window.col + (place.flip_cols ? window.cols - part.col - part.cols : part.col),
            window.row + (place.flip_rows ? window.rows - part.row - part.rows : part.row), part.cols, part.rows};
  }
};

DatasetReader::DatasetReader(GDALDataset& stored, const RasterOptions& given) : band_(std::make_unique<Band>()) {
  Band& in = *band_;
  in.options = given;
  if (given.encoding != HeightEncoding::none) {
    if (given.band != 0) throw Error("--encoding reads three bands at once (omit --band)");
    in.decoded = std::make_unique<DecodedDataset>(stored, given.encoding);
  }
  in.dataset = in.decoded ? in.decoded.get() : &stored;
  GDALRasterBand& band = *in.dataset->GetRasterBand(height_band(*in.dataset, given.band));
  in.band = &band;
  const GDALDataType type = band.GetRasterDataType();
  const bool with_sign = has_sign(type, is_signed_byte(band));
  settle_height_range(in.options, type, is_signed_byte(band));
  in.window = choose_window(*in.dataset, given.window);
  Raster& raster = in.raster;
  raster.cols = in.window.cols;
  raster.rows = in.window.rows;
  raster.files = files_of(stored);
  raster.file_type = in.decoded ? std::string(name_of(given.encoding)) : GDALGetDataTypeName(type);
  in.place = find_place(*in.dataset, in.window, in.options);
  raster.georeference = in.place.georeference;
  find_heights(band, in.place, in.options, raster);
  if (!GDALDataTypeIsFloating(type)) in.greatest = greatest_integer(type, with_sign);
  in.heights.picture = is_picture_format(stored);
  in.heights.scaled = in.options.scale || in.options.offset || !in.options.unit.empty() || raster.scale != 1 ||
                      raster.offset != 0 || !raster.vertical_unit.empty();
  if (!with_sign) in.heights.greatest = in.greatest;
  in.heights.longer_side_m = std::max((in.dataset->GetRasterXSize() - 1) * raster.georeference.cell_x_m,
                                      (in.dataset->GetRasterYSize() - 1) * raster.georeference.cell_y_m);
}

DatasetReader::~DatasetReader() = default;
DatasetReader::DatasetReader(DatasetReader&&) noexcept = default;
DatasetReader& DatasetReader::operator=(DatasetReader&&) noexcept = default;

DatasetHeader DatasetReader::header() const {
  const Band& in = *band_;
  const RasterOptions& options = in.options;
  DatasetHeader header{in.raster};
  Raster& raster = header.raster;
  raster.samples = empty_samples(*in.band);
  raster.nodata = nodata_in_memory(options.nodata ? options.nodata : nodata_of(*in.band), raster.samples);
  header.scale_varies = !raster.georeference.present && depends_on_samples(in.heights);
  if (!options.nodata && in.window.cols == in.dataset->GetRasterXSize() &&
      in.window.rows == in.dataset->GetRasterYSize() && raster.scale > 0)
    header.stated = stated_ends(*in.band);
  if (raster.scale < 0) apply_negative_scale(raster);
  raster.notes.insert(raster.notes.end(), in.place.notes.begin(), in.place.notes.end());
  return header;
}

Raster DatasetReader::read(const std::optional<RasterWindow>& part, GdalSession& session,
                           const Progress& progress) const {
  const Band& in = *band_;
  Raster raster = in.raster;
  const RasterPlace& place = in.place;
  const RasterWindow window = part ? in.stored(*part) : in.window;
  BandSamples read = read_band(*in.band, window, in.options.nodata, part ? std::nullopt : in.options.decimation,
                               in.options.memory, session, progress);
  raster.samples = std::move(read.samples);
  raster.cols = read.cols;
  raster.rows = read.rows;
  raster.nodata = read.nodata;
  if (part) {
    read.across.first = part->col;
    read.down.first = part->row;
  } else {
    if (place.flip_cols) read.across.first = window.cols - 1 - last_of(read.across, read.cols);
    if (place.flip_rows) read.down.first = window.rows - 1 - last_of(read.down, read.rows);
  }
  respace(raster.georeference, read.across, read.down);
  std::string proportion;
  if (!part) {
    refuse_all_nodata(raster, window);
    proportion = settle_default_scale(raster, in.heights);
  }
  const std::vector<std::string> suspected = suspected_nodata(raster, in.greatest);
  if (raster.scale < 0) apply_negative_scale(raster);
  flip(raster, place.flip_rows, place.flip_cols);

  raster.notes.insert(raster.notes.end(), read.notes.begin(), read.notes.end());
  raster.notes.insert(raster.notes.end(), suspected.begin(), suspected.end());
  raster.notes.insert(raster.notes.end(), place.notes.begin(), place.notes.end());
  if (!proportion.empty()) raster.notes.push_back(proportion);
  return raster;
}

}  // namespace scarp
