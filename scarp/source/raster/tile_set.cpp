// SPDX-License-Identifier: MIT
#include "scarp/source/raster/tile_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/source/raster/band_samples.h"
#include "scarp/source/raster/decoded_dataset.h"
#include "scarp/source/raster/gdal_dataset.h"
#include "scarp/source/raster/gdal_raster.h"
#include "scarp/source/raster/raster_place.h"
#include "scarp/source/raster/raw_band.h"
#include "scarp/source/raster/tile_layout.h"
#include "scarp/source/raster/warp_words.h"
#include "scarp/source/xml_text.h"

namespace scarp {
namespace {

// Properties of one file.
struct Tile {
  std::string path;
  int band = 1;   // the first band to read
  int bands = 1;  // one; with an encoding, three or four
  GDALDataType type = GDT_Unknown;
  std::optional<double> nodata;
  bool masked = false;
  bool ascii_grid = false;
  double scale = 1, offset = 0;
  std::string unit;
  OGRSpatialReference crs;
  bool has_crs = false;
  GeoTransform map{};
  int cols = 0, rows = 0;
};

Tile look_at(const std::string& path, const RasterOptions& options, const GdalSession& session) {
  const GDALDatasetUniquePtr dataset = open_gdal_raster(path, session);
  Tile tile;
  tile.path = path;
  tile.cols = dataset->GetRasterXSize();
  tile.rows = dataset->GetRasterYSize();
  if (options.encoding == HeightEncoding::none) {
    tile.band = height_band(*dataset, options.band);
  } else {
    const DecodedDataset colours(*dataset, options.encoding);  // throws for files that are not encoded
    tile.bands = dataset->GetRasterCount();
  }
  GDALRasterBand& band = *dataset->GetRasterBand(tile.band);
  tile.type = band.GetRasterDataType();
  if (is_signed_byte(band))
    throw Error("tiles of signed bytes require GDAL 3.7 (convert it first: gdal_translate -ot Int16 IN OUT.tif)");
  // For colours, a nodata value marks a byte, not a height.
  if (tile.bands == 1) tile.nodata = nodata_of(band);
  tile.ascii_grid = is_ascii_grid(*dataset);
  tile.masked = tile.bands == 1 && has_own_mask(band);
  tile.scale = band.GetScale();
  tile.offset = band.GetOffset();
  tile.unit = band.GetUnitType();
  if (const OGRSpatialReference* crs = dataset->GetSpatialRef()) {
    tile.crs = *crs;
    tile.has_crs = true;
  }
  if (dataset->GetGeoTransform(tile.map.data()) != CE_None)
    throw Error(
        "no georeference, which tiles require (add one first: gdal_translate -a_ullr W N E S -a_srs CRS IN OUT.tif)");
  check_geotransform(tile.map, tile.cols, tile.rows,
                     warp_nodata_words(GDALGetDataTypeName(tile.type), tile.nodata.has_value()));
  if (tile.map[1] < 0 || tile.map[5] > 0)
    throw Error("rows or columns run against the map (tiles must be north-up, convert it first: gdalwarp IN OUT.tif)");
  return tile;
}

bool same_value(std::optional<double> a, std::optional<double> b) {
  return a == b || (a && b && std::isnan(*a) && std::isnan(*b));
}

std::string text_of(std::optional<double> nodata) { return nodata ? fmt::format("{}", *nodata) : "none"; }

std::string text_of(const Tile& tile) {
  const char* name = tile.has_crs ? tile.crs.GetName() : nullptr;
  return name ? name : "none";
}

// Throws Error if the tile does not match the first one.
void compare(const Tile& first, const Tile& tile, const RasterOptions& options) {
  const auto differ = [&](std::string_view what, const std::string& its, const std::string& others,
                          std::string_view remedy) {
    throw Error(
        fmt::format("{} is {}, but that of '{}' is {} (tiles must agree: {})", what, its, first.path, others, remedy));
  };
  const std::string nodata = warp_nodata_words(GDALGetDataTypeName(tile.type), tile.nodata.has_value());
  const char* const ignore_axes[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", nullptr};
  if (tile.has_crs != first.has_crs || (tile.has_crs && !tile.crs.IsSame(&first.crs, ignore_axes)))
    differ("CRS", text_of(tile), text_of(first), fmt::format("gdalwarp -t_srs CRS{} IN OUT.tif", nodata));
  if (tile.type != first.type)
    differ("sample type", GDALGetDataTypeName(tile.type), GDALGetDataTypeName(first.type),
           "gdal_translate -ot TYPE IN OUT.tif");
  if (tile.bands != first.bands)
    differ("number of bands", fmt::format("{}", tile.bands), fmt::format("{}", first.bands),
           "gdal_translate -b 1 -b 2 -b 3 IN OUT.tif");
  if (!options.nodata && !same_value(tile.nodata, first.nodata))
    differ("nodata value", text_of(tile.nodata), text_of(first.nodata), "use --nodata, or gdal_translate -a_nodata");
  if (tile.scale != first.scale || tile.offset != first.offset)
    differ("scale", fmt::format("x {} + {}", tile.scale, tile.offset),
           fmt::format("x {} + {}", first.scale, first.offset), "gdal_translate -unscale -ot Float32 IN OUT.tif");
  if (tile.unit != first.unit)
    differ("vertical unit", fmt::format("'{}'", tile.unit), fmt::format("'{}'", first.unit), "convert one of them");
  // Across the tile's width and height, its cells must not drift from those of the first tile.
  if (std::abs(tile.map[1] - first.map[1]) * tile.cols > kLargestDriftInCells * first.map[1] ||
      std::abs(tile.map[5] - first.map[5]) * tile.rows > kLargestDriftInCells * -first.map[5]) {
    differ("cell size", fmt::format("{} x {}", tile.map[1], -tile.map[5]),
           fmt::format("{} x {}", first.map[1], -first.map[5]),
           fmt::format("gdalwarp -tr X Y -tap{} IN OUT.tif", nodata));
  }
}

// Returns the position of the tile, in whole samples from the first tile's north-west sample.
TileRect rect_of(const Tile& first, const Tile& tile) {
  const double col = (tile.map[0] - first.map[0]) / first.map[1], row = (tile.map[3] - first.map[3]) / first.map[5];
  // Rasters have int extents, so farther offsets are impossible.
  constexpr double kMost = std::numeric_limits<int>::max();
  if (!(std::abs(col) < kMost && std::abs(row) < kMost))
    throw Error(fmt::format("too far from '{}' for one raster: {:.3g} x {:.3g} samples", first.path, col, row));
  const double drift = std::max(std::abs(col - std::round(col)), std::abs(row - std::round(row)));
  if (drift > kLargestDriftInCells)
    throw Error(fmt::format(
        "offset by {:.3g} of a cell from the samples of '{}', but tiles are not resampled (align the grids: "
        "gdalwarp -tr X Y -tap{} IN OUT.tif)",
        drift, first.path, warp_nodata_words(GDALGetDataTypeName(tile.type), tile.nodata.has_value())));
  return {std::llround(col), std::llround(row), tile.cols, tile.rows};
}

// Moves tiles on both sides of 180 degrees side by side, by full circles.
void join_across_180(std::vector<Tile>& tiles, const RasterOptions& options, std::vector<std::string>& notes) {
  const Tile& first = tiles.front();
  const double step_x = first.map[1], step_y = -first.map[5];
  std::vector<TileSpan> spans;
  double west = first.map[0], east = west, north = first.map[3], south = north;
  for (const Tile& tile : tiles) {
    const TileSpan& span = spans.emplace_back(TileSpan{tile.map[0], tile.map[0] + tile.cols * tile.map[1]});
    west = std::min(west, span.west), east = std::max(east, span.east);
    north = std::max(north, tile.map[3]), south = std::min(south, tile.map[3] + tile.rows * tile.map[5]);
  }
  const double circle = turn_of(first.has_crs ? &first.crs : nullptr, {west, step_x, 0, north, 0, -step_y},
                                (east - west) / step_x, (north - south) / step_y, options);
  if (circle == 0) return;
  const std::vector<int> turns = turns_side_by_side(spans, circle, step_x / 2);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    tiles[i].map[0] += turns[i] * circle;
    moved += turns[i] != 0 ? 1 : 0;
  }
  if (moved > 0) {
    notes.push_back(
        fmt::format("moved {} of {} tiles by a full circle of longitude, next to the others", moved, tiles.size()));
  }
}

// Whether samples of the tiles' type can have this value.
bool can_mark(const Tile& tile, double value) {
  if (GDALDataTypeIsFloating(tile.type)) return true;
  if (std::isnan(value)) return false;
  int clamped = FALSE, rounded = FALSE;
  GDALAdjustValueToDataType(tile.type, value, &clamped, &rounded);
  return !clamped && !rounded;
}

// Returns the sample value that marks holes in the tiles, and can mark gaps between them.
std::optional<double> mark_of_holes(const Tile& tile, const RasterOptions& options) {
  const std::optional<double> value = options.nodata ? options.nodata : tile.nodata;
  return value && !std::isnan(*value) && can_mark(tile, *value) ? value : std::nullopt;
}

// Returns a type that represents all samples of `type`, and NaN.
GDALDataType type_with_nan(GDALDataType type) {
  return GDALDataTypeIsFloating(type) ? type : GDALGetDataTypeSizeBits(type) <= 16 ? GDT_Float32 : GDT_Float64;
}

// XML elements that map part of a file to part of the dataset.
std::string source_xml(const Tile& tile, const TileRect& at, int band, std::string_view kind, const std::string& more) {
  // GDAL opens the file again when it reads it.
  const std::string open_as = tile.ascii_grid ? fmt::format("<OpenOptions><OOI key=\"DATATYPE\">{}</OOI></OpenOptions>",
                                                            GDALGetDataTypeName(tile.type))
                                              : "";
  return fmt::format(
      "<{0}><SourceFilename relativeToVRT=\"0\">{1}</SourceFilename>{9}<SourceBand>{2}</SourceBand><SourceProperties "
      "RasterXSize=\"{3}\" RasterYSize=\"{4}\" DataType=\"{5}\"/><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"{3}\" "
      "ySize=\"{4}\"/><DstRect xOff=\"{6}\" yOff=\"{7}\" xSize=\"{3}\" ySize=\"{4}\"/>{8}</{0}>",
      kind, xml_text(full_path(tile.path)), band, tile.cols, tile.rows, GDALGetDataTypeName(tile.type), at.col, at.row,
      more, open_as);
}

GDALRasterBand& add_band(GDALDataset& dataset, GDALDataType type, const GdalSession& session) {
  if (dataset.AddBand(type, nullptr) != CE_None)
    throw Error(fmt::format("cannot be combined: {}", session.reason("GDAL gives no reason")));
  return *dataset.GetRasterBand(dataset.GetRasterCount());
}

void add_source(GDALRasterBand& band, const std::string& xml, const GdalSession& session) {
  if (band.SetMetadataItem("source_0", xml.c_str(), "new_vrt_sources") != CE_None)
    throw Error(fmt::format("cannot be combined: {}", session.reason("GDAL gives no reason")));
}

// The band of heights. Holes of a later tile reveal an earlier one.
void add_heights(GDALDataset& dataset, const std::vector<Tile>& tiles, const std::vector<TileRect>& places, bool gaps,
                 const RasterOptions& options, const GdalSession& session) {
  const Tile& first = tiles.front();
  const std::optional<double> mark = mark_of_holes(first, options);
  const bool masked = std::any_of(tiles.begin(), tiles.end(), [](const Tile& tile) { return tile.masked; });
  const bool nan = masked || (gaps && !mark);
  GDALRasterBand& band = add_band(dataset, nan ? type_with_nan(first.type) : first.type, session);
  if (nan) {
    band.SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  } else if (mark) {
    band.SetNoDataValue(*mark);
  }
  band.SetScale(first.scale);
  band.SetOffset(first.offset);
  band.SetUnitType(first.unit.c_str());
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    std::string holes;
    if (mark) holes += fmt::format("<NODATA>{}</NODATA>", *mark);
    if (tiles[i].masked) holes += "<UseMaskBand>true</UseMaskBand>";
    add_source(band,
               source_xml(tiles[i], places[i], tiles[i].band, holes.empty() ? "SimpleSource" : "ComplexSource", holes),
               session);
  }
}

// Three bands of colours, and alpha if the tiles have it or gaps need it.
void add_colours(GDALDataset& dataset, const std::vector<Tile>& tiles, const std::vector<TileRect>& places, bool gaps,
                 const GdalSession& session) {
  const bool alpha = tiles.front().bands == 4;
  for (int b = 1; b <= 3; ++b) {
    GDALRasterBand& band = add_band(dataset, GDT_Byte, session);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      add_source(band,
                 source_xml(tiles[i], places[i], b, alpha ? "ComplexSource" : "SimpleSource",
                            alpha ? "<UseMaskBand>true</UseMaskBand>" : ""),
                 session);
    }
  }
  if (!alpha && !gaps) return;
  GDALRasterBand& band = add_band(dataset, GDT_Byte, session);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    // A tile without alpha is opaque: its alpha is any of its bands, times 0 plus 255.
    add_source(band,
               source_xml(tiles[i], places[i], alpha ? 4 : 1, "ComplexSource",
                          alpha ? "<NODATA>0</NODATA>" : "<ScaleOffset>255</ScaleOffset><ScaleRatio>0</ScaleRatio>"),
               session);
  }
}

}  // namespace

bool is_tile_folder(const std::string& path) {
  VSIStatBufL status;
  if (VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) != 0) return false;
  return VSI_ISDIR(status.st_mode) && !GDALIdentifyDriverEx(path.c_str(), GDAL_OF_RASTER, nullptr, nullptr);
}

std::vector<std::string> rasters_in(const std::string& folder, const RasterOptions& options,
                                    std::vector<std::string>& notes) {
  const bool colours_are_heights = options.band != 0 || options.encoding != HeightEncoding::none;
  const CPLStringList entries(VSIReadDir(folder.c_str()));
  std::vector<std::string> found, others, pictures;
  // Files that belong to a raster: overviews, masks, sources of a virtual raster.
  std::set<std::string> parts;
  for (int i = 0; i < entries.size(); ++i) {
    const std::string name = entries[i];
    const std::string path = CPLFormFilename(folder.c_str(), name.c_str(), nullptr);
    VSIStatBufL status;
    if (name.starts_with('.') || VSIStatL(path.c_str(), &status) != 0 || !VSI_ISREG(status.st_mode)) continue;
    if (!GDALIdentifyDriverEx(path.c_str(), GDAL_OF_RASTER, nullptr, nullptr)) {
      others.push_back(path);
      continue;
    }
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    const bool left_out = dataset && !colours_are_heights && is_picture(*dataset) && !has_place(*dataset);
    (left_out ? pictures : found).push_back(path);
    const CPLStringList files(dataset ? dataset->GetFileList() : nullptr);
    for (int f = 1; f < files.size(); ++f) parts.insert(files[f]);
  }
  std::erase_if(found, [&](const std::string& path) { return parts.contains(path); });
  std::sort(found.begin(), found.end());
  const auto leave_out = [&](std::vector<std::string>& files, std::string_view why) {
    std::erase_if(files, [&](const std::string& path) { return parts.contains(path); });
    if (files.empty()) return;
    std::sort(files.begin(), files.end());
    notes.push_back(fmt::format("skipped {}: {}{}", why, files.front(),
                                files.size() == 1 ? "" : fmt::format(" and {} more", files.size() - 1)));
  };
  leave_out(others, "files that are not rasters");
  leave_out(pictures, "pictures without a georeference");
  if (found.empty() && !pictures.empty()) {
    throw Error(fmt::format(
        "{}: folder of pictures without a georeference, such as '{}' (if their colours encode heights, use --encoding "
        "terrain-rgb or terrarium)",
        folder, pictures.front()));
  }
  if (found.empty()) {
    throw Error(fmt::format("{}: folder without a raster that GDAL {} can read (subfolders are not searched)", folder,
                            GDALVersionInfo("RELEASE_NAME")));
  }
  return found;
}

TileSet open_tile_set(const std::vector<std::string>& files, const RasterOptions& options, const GdalSession& session,
                      std::vector<std::string>& notes) {
  std::vector<Tile> tiles;
  std::vector<TileRect> places;
  for (const std::string& file : files) {
    try {
      tiles.push_back(look_at(file, options, session));
      compare(tiles.front(), tiles.back(), options);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", file, error.what()));
    }
  }
  join_across_180(tiles, options, notes);
  for (const Tile& tile : tiles) {
    try {
      places.push_back(rect_of(tiles.front(), tile));
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", tile.path, error.what()));
    }
  }
  const TileRect all = bounding_rect(places);
  for (TileRect& place : places) {
    place.col -= all.col;
    place.row -= all.row;
  }
  if (all.cols > std::numeric_limits<int>::max() || all.rows > std::numeric_limits<int>::max())
    throw Error(fmt::format("{}: with the other tiles the raster has {} x {} samples, more than supported",
                            files.front(), all.cols, all.rows));
  const double samples = static_cast<double>(all.cols) * static_cast<double>(all.rows);
  const double gaps = samples - covered_samples(places);

  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("VRT");
  GDALDatasetUniquePtr dataset(
      driver ? driver->Create("", static_cast<int>(all.cols), static_cast<int>(all.rows), 0, GDT_Byte, nullptr)
             : nullptr);
  if (!dataset) throw Error(fmt::format("tiles cannot be combined: {}", session.reason("GDAL has no VRT driver")));
  const Tile& first = tiles.front();
  GeoTransform map = first.map;
  map[0] += static_cast<double>(all.col) * map[1];
  map[3] += static_cast<double>(all.row) * map[5];
  dataset->SetGeoTransform(map.data());
  if (first.has_crs) dataset->SetSpatialRef(&first.crs);
  if (first.bands == 1) {
    add_heights(*dataset, tiles, places, gaps > 0, options, session);
  } else {
    add_colours(*dataset, tiles, places, gaps > 0, session);
  }
  notes.push_back(fmt::format("combined {} tiles into a raster of {} x {} samples", tiles.size(), all.cols, all.rows));
  if (gaps > 0)
    notes.push_back(fmt::format("gaps between tiles: {:.0f} samples ({:.3g} %) are holes", gaps, 100 * gaps / samples));
  return {std::move(dataset), first.type};
}

}  // namespace scarp
