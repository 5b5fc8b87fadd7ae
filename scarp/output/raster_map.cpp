// SPDX-License-Identifier: MIT
#include "scarp/output/raster_map.h"

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_vrt.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/replace_file.h"
#include "scarp/output/gdal_writing.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

GDALDataType type_of(const MapBand& band) {
  constexpr GDALDataType kTypes[] = {GDT_Byte, GDT_UInt16, GDT_Float32};
  return kTypes[band.samples.index()];
}

// Wraps the samples, without a copy, as an in-memory dataset.
GDALDatasetUniquePtr samples_of(const RasterMap& map, int cols, int rows) {
  auto* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDatasetUniquePtr dataset(driver->Create("", cols, rows, 0, GDT_Byte, nullptr));
  for (const MapBand& band : map.bands) {
    const auto add = [&](const auto& samples) {
      char address[64] = {};
      address[CPLPrintPointer(address, const_cast<void*>(static_cast<const void*>(samples.data())),
                              sizeof address - 1)] = 0;
      CPLStringList options;
      options.SetNameValue("DATAPOINTER", address);
      dataset->AddBand(type_of(band), options.List());
    };
    std::visit(add, band.samples);
  }
  return dataset;
}

// Surrounds the samples of a part by nodata, which takes no memory.
GDALDatasetUniquePtr surrounded(const RasterMap& map) {
  const MapPart& part = *map.part;
  auto* driver = GetGDALDriverManager()->GetDriverByName("VRT");
  GDALDatasetUniquePtr dataset(driver->Create("", map.cols, map.rows, 0, GDT_Byte, nullptr));
  for (const MapBand& band : map.bands) dataset->AddBand(type_of(band), nullptr);
  if (part.rows == 0) return dataset;
  GDALDatasetUniquePtr samples = samples_of(map, part.cols, part.rows);
  for (int b = 1; b <= dataset->GetRasterCount(); ++b)
    VRTAddSimpleSource(static_cast<VRTSourcedRasterBandH>(GDALRasterBand::ToHandle(dataset->GetRasterBand(b))),
                       GDALRasterBand::ToHandle(samples->GetRasterBand(b)), 0, 0, part.cols, part.rows, part.col,
                       part.row, part.cols, part.rows, nullptr, VRT_NODATA_UNSET);
  samples.release()->ReleaseRef();  // the sources hold references
  return dataset;
}

GDALDatasetUniquePtr dataset_of(const RasterMap& map, const std::string& path) {
  GDALDatasetUniquePtr dataset = map.part ? surrounded(map) : samples_of(map, map.cols, map.rows);
  for (int b = 1; b <= dataset->GetRasterCount(); ++b) {
    const MapBand& band = map.bands[static_cast<std::size_t>(b - 1)];
    GDALRasterBand& to = *dataset->GetRasterBand(b);
    to.SetDescription(band.name.c_str());
    if (!band.unit.empty()) to.SetUnitType(band.unit.c_str());
    if (band.nodata) to.SetNoDataValue(*band.nodata);
    if (band.classes.empty()) continue;
    std::string legend;
    GDALColorTable colours;
    for (const MapClass& one : band.classes) {
      const GDALColorEntry entry{one.colour[0], one.colour[1], one.colour[2], one.colour[3]};
      if (one.code < 256) colours.SetColorEntry(one.code, &entry);
      legend += fmt::format("{}{} {}", legend.empty() ? "" : ", ", one.code, one.name);
    }
    if (type_of(band) == GDT_Byte && map.bands.size() == 1) to.SetColorTable(&colours);
    to.SetMetadataItem("LEGEND", legend.c_str());
  }
  if (map.place) {
    auto transform = map.place->map_from_pixel;
    dataset->SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    if (!map.place->crs_wkt.empty() && crs.importFromWkt(map.place->crs_wkt.c_str()) != OGRERR_NONE)
      throw Error(fmt::format("{}: unusable coordinate reference system", path));
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (!crs.IsEmpty()) dataset->SetSpatialRef(&crs);
  }
  for (const auto& [name, value] : map.metadata) dataset->SetMetadataItem(name.c_str(), value.c_str());
  return dataset;
}

std::string name_of_option(const std::string& option) {
  const auto equals = option.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Error(fmt::format("creation option '{}': expected NAME=VALUE", option));
  return option.substr(0, equals);
}

CPLStringList options_of(const RasterMap& map) {
  CPLStringList options;
  const bool floats = std::holds_alternative<std::span<const float>>(map.bands[0].samples);
  if (map.driver == "GTiff") {
    for (const char* option : {"TILED=YES", "COMPRESS=DEFLATE", "BIGTIFF=IF_SAFER", "NUM_THREADS=ALL_CPUS"})
      options.AddString(option);
    options.SetNameValue("PREDICTOR", floats ? "3" : "2");
    // Some other programs do not read files that omit tiles, so maps are complete up to this size, for which empty
    // tiles take 1 MB and a second of processor time.
    constexpr double kLargestComplete = 1 << 26;
    if (map.part && static_cast<double>(map.cols) * map.rows > kLargestComplete)
      options.SetNameValue("SPARSE_OK", "TRUE");
  } else if (map.driver == "COG") {
    for (const char* option : {"COMPRESS=DEFLATE", "PREDICTOR=YES", "BIGTIFF=IF_SAFER", "NUM_THREADS=ALL_CPUS"})
      options.AddString(option);
    // Averages of class codes are not class codes.
    options.SetNameValue("RESAMPLING", map.bands[0].classes.empty() ? "AVERAGE" : "NEAREST");
  }
  for (const std::string& option : map.creation_options) {
    const std::string name = name_of_option(option);
    // Few of the other compressions support a predictor.
    if (EQUAL(name.c_str(), "COMPRESS")) options.SetNameValue("PREDICTOR", nullptr);
    options.SetNameValue(name.c_str(), option.c_str() + name.size() + 1);
  }
  return options;
}

int CPL_STDCALL report(double done, const char*, void* progress) {
  const auto& call = *static_cast<const Progress*>(progress);
  return !call || call(done) ? TRUE : FALSE;
}

// Moves or removes the files beside the main one, which have its temporary name and other extensions. Files that
// existed before belong to other programs, such as a picture with the same name that is being written.
class SideFiles {
 public:
  SideFiles(const std::string& temporary, const std::string& path)
      : temporary_(temporary), path_(path), before_(beside()) {}
  ~SideFiles() {
    std::error_code ignored;
    for (const auto& [from, to] : files_) fs::remove(from, ignored);
  }
  void find() {
    const std::string stem = fs::path(temporary_).stem().string();
    for (const fs::path& file : beside()) {
      if (before_.contains(file)) continue;
      // NAME.hdr beside NAME.img, or NAME.img.aux.xml.
      files_[file.string()] = (fs::path(path_).parent_path() /
                               (fs::path(path_).stem().string() + file.filename().string().substr(stem.size())))
                                  .string();
    }
  }
  void commit() {
    for (const auto& [from, to] : files_) {
      std::error_code failed;
      fs::rename(from, to, failed);
      if (failed) throw Error(fmt::format("{}: cannot be written: {}", to, failed.message()));
    }
    files_.clear();
  }

 private:
  std::set<fs::path> beside() const {
    const fs::path main(temporary_);
    std::set<fs::path> found;
    std::error_code ignored;
    const fs::path folder = main.has_parent_path() ? main.parent_path() : fs::path(".");
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(main.stem().string()) && name != main.filename().string()) found.insert(entry.path());
    }
    return found;
  }

  std::string temporary_, path_;
  std::set<fs::path> before_;
  std::map<std::string, std::string> files_;
};

}  // namespace

void require_raster_driver(const std::string& driver, const std::vector<std::string>& creation_options,
                           std::string_view sample_type) {
  const GdalWriting writing;
  GDALDriver* found = GetGDALDriverManager()->GetDriverByName(driver.c_str());
  if (!found) throw Error(fmt::format("format '{}': unknown (see gdalinfo --formats)", driver));
  const bool raster = CPLFetchBool(found->GetMetadata(), GDAL_DCAP_RASTER, false);
  const bool writes = CPLFetchBool(found->GetMetadata(), GDAL_DCAP_CREATECOPY, false) ||
                      CPLFetchBool(found->GetMetadata(), GDAL_DCAP_CREATE, false);
  if (!raster || !writes) throw Error(fmt::format("format '{}': GDAL cannot write it as a raster", driver));
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
  ReplaceFile file(path);
  const GdalWriting writing;
  const CPLStringList options = options_of(map);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(map.driver.c_str());
  if (!driver) throw Error(fmt::format("{}: GDAL has no driver '{}'", path, map.driver));
  const GDALDatasetUniquePtr source = dataset_of(map, path);
  SideFiles beside(file.temporary_path(), path);
  // GDAL copies bands of rows of this many bytes. Its default takes as much memory again as the rest of the program.
  std::optional<CPLConfigOptionSetter> swath;
  if (map.part) swath.emplace("GDAL_SWATH_SIZE", "2000000", true);
  bool stopped = false;
  const Progress watched = [&](double done) {
    stopped = progress && !progress(done);
    return !stopped;
  };
  GDALDatasetUniquePtr copy(driver->CreateCopy(file.temporary_path().c_str(), source.get(), FALSE, options.List(),
                                               report, const_cast<Progress*>(&watched)));
  const bool good = copy != nullptr;
  copy.reset();
  beside.find();
  if (stopped) throw Interrupted();
  writing.require_good(path);
  if (!good) throw Error(fmt::format("{}: {} cannot hold this map", path, map.driver));
  file.commit();
  beside.commit();
}

}  // namespace scarp
