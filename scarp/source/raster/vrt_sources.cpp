// SPDX-License-Identifier: MIT
#include "scarp/source/raster/vrt_sources.h"

#include <cpl_minixml.h>
#include <fmt/format.h>

#include <string>

#include "scarp/base/error.h"
#include "scarp/source/raster/file_check.h"

namespace scarp {
namespace {

// Returns the file of a source from the element that describes it; empty if there is none.
std::string file_of(const CPLXMLTreeCloser& source, const std::string& vrt) {
  if (!source.get()) return {};
  const char* const name = CPLGetXMLValue(source.get(), "SourceFilename", nullptr);
  if (!name) return {};
  const bool relative = std::string_view(CPLGetXMLValue(source.get(), "SourceFilename.relativeToVRT", "0")) == "1";
  return relative ? CPLProjectRelativeFilename(CPLGetPath(vrt.c_str()), name) : name;
}

}  // namespace

void check_vrt_sources(GDALRasterBand& band) {
  char** const sources = band.GetMetadata("vrt_sources");
  for (int i = 0; i < CSLCount(sources); ++i) {
    const char* const xml = CPLParseNameValue(sources[i], nullptr);
    if (!xml) continue;
    const std::string file =
        file_of(CPLXMLTreeCloser(CPLParseXMLString(xml)), band.GetDataset() ? band.GetDataset()->GetDescription() : "");
    VSIStatBufL status;
    const bool exists = VSIStatExL(file.c_str(), &status, VSI_STAT_EXISTS_FLAG) == 0;
    // Names such as NETCDF:"f.nc":var are not paths.
    if (!exists && !file.empty() && file.find_first_of(":<") == std::string::npos)
      throw Error(fmt::format("source '{}' does not exist (fetch it, or rebuild the .vrt)", file));
    try {
      if (exists) check_file(file);
    } catch (const Error& error) {
      throw Error(fmt::format("source '{}': {}", file, error.what()));
    }
  }
}

}  // namespace scarp
