// SPDX-License-Identifier: MIT
#include "scarp/output/raster_map.h"

#include <cpl_string.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/nested_limit.h"
#include "scarp/output/gdal_writing.h"
#include "scarp/output/map_dataset.h"
#include "scarp/output/map_files.h"
#include "scarp/output/map_writing.h"

namespace scarp {
namespace {

// Formats that can never hold a map, with the remedy.
constexpr std::array<std::pair<const char*, const char*>, 3> kRefused = {
    {{"VRT", "refers to samples in other files (write *.tif, then run gdalbuildvrt)"},
     {"MEM", "writes no file (name the output *.tif)"},
     {"JPEG", "its compression changes samples (name the output *.tif or *.png)"}}};

// Options for formats that change samples by default.
constexpr std::array<std::pair<const char*, const char*>, 6> kLossless = {{{"MRF", "COMPRESS=DEFLATE"},
                                                                           {"JP2OpenJPEG", "QUALITY=100"},
                                                                           {"JP2OpenJPEG", "REVERSIBLE=YES"},
                                                                           {"JPEGXL", "LOSSLESS=YES"},
                                                                           {"KMLSUPEROVERLAY", "FORMAT=PNG"},
                                                                           {"WEBP", "LOSSLESS=YES"}}};

double bytes_of(const RasterMap& map) {
  double bytes = 0;
  for (const MapBand& band : map.bands)
    bytes += static_cast<double>(map.cols) * map.rows * std::array{1, 2, 4}[band.samples.index()];
  return bytes;
}

std::string name_of_option(const std::string& option) {
  const auto equals = option.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Error(fmt::format("creation option '{}': expected NAME=VALUE", option));
  return option.substr(0, equals);
}

// GeoTIFF keeps the bands of a tile together by default. A tile of hundreds of bands is too large for the cache, and is
// compressed and written again whenever a few of its rows are added.
bool has_large_tiles(GDALDataset& source) {
  constexpr double kTileSide = 256, kLargeTile = 4 << 20;
  const double bytes = GDALGetDataTypeSizeBytes(source.GetRasterBand(1)->GetRasterDataType());
  return kTileSide * kTileSide * bytes * source.GetRasterCount() > kLargeTile;
}

CPLStringList options_of(const MapFormat& format, GDALDataset& source) {
  CPLStringList options;
  if (format.driver == "GTiff") {
    for (const char* option : {"TILED=YES", "COMPRESS=DEFLATE", "BIGTIFF=IF_SAFER", "NUM_THREADS=ALL_CPUS"})
      options.AddString(option);
    options.SetNameValue("PREDICTOR", format.floats ? "3" : "2");
    if (format.sparse) options.SetNameValue("SPARSE_OK", "TRUE");
    if (has_large_tiles(source)) options.SetNameValue("INTERLEAVE", "BAND");
  } else if (format.driver == "COG") {
    for (const char* option : {"COMPRESS=DEFLATE", "PREDICTOR=YES", "BIGTIFF=IF_SAFER", "NUM_THREADS=ALL_CPUS"})
      options.AddString(option);
    // Averages of class codes are not class codes.
    options.SetNameValue("RESAMPLING", format.classes ? "NEAREST" : "AVERAGE");
  }
  if (format.driver == "GPKG") options.SetNameValue("TILE_FORMAT", format.floats ? "TIFF" : "PNG");
  for (const auto& [driver, option] : kLossless)
    if (format.driver == driver) options.AddString(option);
  for (const std::string& option : format.creation_options) {
    const std::string name = name_of_option(option);
    // Few of the other compressions support a predictor.
    if (EQUAL(name.c_str(), "COMPRESS")) {
      options.SetNameValue("PREDICTOR", nullptr);
      // These may fail on their threads, whose messages would go to stderr.
      const std::string method = lower_case(option.substr(name.size() + 1));
      for (const char* choosy : {"jpeg", "webp", "lerc", "jxl"})
        if (method.starts_with(choosy)) options.SetNameValue("NUM_THREADS", nullptr);
    }
    options.SetNameValue(name.c_str(), option.c_str() + name.size() + 1);
  }
  return options;
}

// Whether a creation option of GeoTIFF changes no sample.
bool keeps_samples(const std::string& option) {
  const std::string name = lower_case(name_of_option(option)), value = lower_case(option.substr(name.size() + 1));
  const auto is_one_of = [](const std::string& word, std::initializer_list<const char*> all) {
    return std::find(all.begin(), all.end(), word) != all.end();
  };
  if (name == "compress") return is_one_of(value, {"none", "deflate", "lzw", "zstd", "lzma", "packbits"});
  return is_one_of(name, {"tiled", "blockxsize", "blockysize", "blocksize", "bigtiff", "num_threads", "zlevel",
                          "zstd_level", "level", "predictor", "sparse_ok"});
}

// GeoTIFF is exact by default. Lossy compression is a choice for measures, but codes would change their meaning.
// Reading a map again takes longer than writing it, so that it is spared where samples cannot change.
bool may_change_samples(const MapFormat& format) {
  const bool tiff = format.driver == "GTiff" || format.driver == "COG";
  const auto& options = format.creation_options;
  if (tiff && std::all_of(options.begin(), options.end(), keeps_samples)) return false;
  return options.empty() || !format.floats;
}

int CPL_STDCALL report(double done, const char*, void* progress) {
  const auto& call = *static_cast<const Progress*>(progress);
  return !call || call(done) ? TRUE : FALSE;
}

// Writes the map with or without its colour table.
void write_once(const std::string& path, const RasterMap& map, bool coloured, const Progress& progress) {
  // Some other programs do not read files that omit tiles, so maps are complete up to this size, for which empty tiles
  // take 1 MB and a second of processor time.
  constexpr double kLargestComplete = 1 << 26;
  const GdalWriting writing(AuxiliaryFiles::written);
  const GDALDatasetUniquePtr source = dataset_of(map, path, coloured);
  write_dataset(path, *source,
                {.driver = map.driver,
                 .creation_options = map.creation_options,
                 .floats = std::holds_alternative<std::span<const float>>(map.bands[0].samples),
                 .classes = !map.bands[0].classes.empty(),
                 .sparse = map.part && static_cast<double>(map.cols) * map.rows > kLargestComplete,
                 .bytes = bytes_of(map)},
                progress);
}

}  // namespace

void write_dataset(const std::string& path, GDALDataset& source, const MapFormat& format, const Progress& progress) {
  MapFiles files(path);
  GdalWriting writing(AuxiliaryFiles::written);
  writing.hide(files.folder());
  const CPLStringList options = options_of(format, source);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(format.driver.c_str());
  if (!driver) throw Error(fmt::format("{}: GDAL has no driver '{}'", path, format.driver));
  // GDAL copies bands of rows of this many bytes. Its default takes as much memory again as the rest of the program.
  const CPLConfigOptionSetter swath("GDAL_SWATH_SIZE", "2000000", true);
  const NestedLimit<GDALGetCacheMax64, GDALSetCacheMax64, kGdalCacheBytes> limit;
  bool stopped = false;
  const Progress watched = [&](double done) {
    stopped = progress && !progress(done);
    return !stopped;
  };
  GDALDatasetUniquePtr copy(driver->CreateCopy(files.path().c_str(), &source, FALSE, options.List(), report,
                                               const_cast<Progress*>(&watched)));
  const bool good = copy != nullptr;
  copy.reset();
  if (stopped) throw Interrupted();
  writing.require_good(path, format.bytes);
  if (!good) throw Error(fmt::format("{}: {} cannot hold this map (name the output *.tif)", path, format.driver));
  if (may_change_samples(format)) require_same_map(files.path(), source, path, format.driver);
  files.commit();
}

void require_raster_driver(const std::string& driver, const std::vector<std::string>& creation_options,
                           std::string_view sample_type) {
  const GdalWriting writing;
  GDALDriver* found = GetGDALDriverManager()->GetDriverByName(driver.c_str());
  if (!found) throw Error(fmt::format("format '{}': unknown (see gdalinfo --formats)", driver));
  const bool raster = CPLFetchBool(found->GetMetadata(), GDAL_DCAP_RASTER, false);
  const bool writes = CPLFetchBool(found->GetMetadata(), GDAL_DCAP_CREATECOPY, false) ||
                      CPLFetchBool(found->GetMetadata(), GDAL_DCAP_CREATE, false);
  if (!raster || !writes) throw Error(fmt::format("format '{}': GDAL cannot write it as a raster", driver));
  for (const auto& [name, why] : kRefused)
    if (driver == name) throw Error(fmt::format("format '{}': {}", driver, why));
  // Others would be rounded to those it has, without an error.
  const char* types = found->GetMetadataItem(GDAL_DMD_CREATIONDATATYPES);
  const CPLStringList known(CSLTokenizeString(types ? types : ""));
  if (types && known.FindString(std::string(sample_type).c_str()) < 0)
    throw Error(fmt::format("format '{}': cannot store {} samples (name the output *.tif)", driver, sample_type));
  CPLStringList options;
  for (const std::string& option : creation_options)
    options.SetNameValue(name_of_option(option).c_str(), option.c_str() + option.find('=') + 1);
  std::string reason;
  CPLPushErrorHandlerEx(
      [](CPLErr, CPLErrorNum, const char* text) {
        auto& first = *static_cast<std::string*>(CPLGetErrorHandlerUserData());
        if (first.empty()) first = text;
      },
      &reason);
  const bool valid = GDALValidateCreationOptions(found, options.List()) != 0;
  CPLPopErrorHandler();
  if (!valid) throw Error(fmt::format("creation option: {} (see gdalinfo --format {})", reason, driver));
}

std::string raster_driver_of(const std::string& path) {
  const GdalWriting writing;
  std::string extension = extension_of(path);
  if (extension == ".tif" || extension == ".tiff") return "GTiff";
  if (!extension.empty()) extension.erase(0, 1);
  for (int i = 0; !extension.empty() && i < GetGDALDriverManager()->GetDriverCount(); ++i) {
    GDALDriver* driver = GetGDALDriverManager()->GetDriver(i);
    const char* all = driver->GetMetadataItem(GDAL_DMD_EXTENSIONS);
    if (!all || !CPLFetchBool(driver->GetMetadata(), GDAL_DCAP_RASTER, false) ||
        !(CPLFetchBool(driver->GetMetadata(), GDAL_DCAP_CREATECOPY, false) ||
          CPLFetchBool(driver->GetMetadata(), GDAL_DCAP_CREATE, false)))
      continue;
    const CPLStringList words(CSLTokenizeString(all));
    for (int k = 0; k < words.size(); ++k)
      if (lower_case(words[k]) == extension) return driver->GetDescription();
  }
  throw Error(fmt::format("output '{}': no raster format has this extension (name it *.tif, or give --of)", path));
}

void write_raster_map(const std::string& path, const RasterMap& map, const Progress& progress) {
  // This driver would write a file beside the folder.
  if (map.driver == "PAux" && extension_of(path).empty())
    throw Error(fmt::format("{}: PAux needs a name with an extension (name it *.raw)", path));
  try {
    write_once(path, map, true, progress);
  } catch (const Error&) {
    // Some formats refuse colour tables, or renumber the classes of maps that have one.
    const MapBand& band = map.bands[0];
    if (map.bands.size() > 1 || band.classes.empty() || map.driver == "GTiff" || map.driver == "COG") throw;
    const std::exception_ptr first = std::current_exception();
    try {
      write_once(path, map, false, progress);
    } catch (const Error&) {
      std::rethrow_exception(first);
    }
  }
}

}  // namespace scarp
