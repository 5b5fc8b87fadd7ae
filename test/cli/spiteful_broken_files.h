// SPDX-License-Identifier: MIT
// Adversarial rasters: damaged files, paths that are not files, and arrays that are not heights.
#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "cli/spiteful_raster.h"
#include "source/npy_bytes.h"

namespace scarp::test {

// A TIFF of little-endian float samples whose single strip of `strip_bytes` claims to hold all rows.
inline std::string tiff_header(std::uint32_t cols, std::uint32_t rows, std::uint32_t strip_bytes) {
  std::string bytes("II*\0\x08\0\0\0\x09\0", 10);
  const auto entry = [&](std::uint16_t tag, std::uint32_t value) {
    const std::uint16_t words[] = {tag, 4, 1, 0};
    bytes.append(reinterpret_cast<const char*>(words), sizeof words);
    bytes.append(reinterpret_cast<const char*>(&value), 4);
  };
  entry(256, cols), entry(257, rows), entry(258, 32), entry(259, 1), entry(262, 1);
  entry(273, 122), entry(278, rows), entry(279, strip_bytes), entry(339, 3);
  return bytes + std::string(4 + strip_bytes, '\0');
}

inline std::string vrt(const std::string& source, bool relative, int cols = kCols, int rows = kRows) {
  return fmt::format(
      "<VRTDataset rasterXSize=\"{0}\" rasterYSize=\"{1}\"><GeoTransform>500000,10,0,5000160,0,-10</GeoTransform>"
      "<VRTRasterBand dataType=\"Int16\" band=\"1\"><SimpleSource><SourceFilename relativeToVRT=\"{2:d}\">{3}"
      "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>",
      cols, rows, relative, source);
}

inline SpitefulRasters broken_files(const SpitefulFiles& f) {
  using enum Expected;
  SpitefulRasters all;
  const auto refuse = [&](const std::string& kind, const std::string& input, const std::string& words,
                          bool may_hang = false) {
    all.push_back({.kind = kind, .inputs = {input}, .expected = refused, .words = words, .may_hang = may_hang});
  };
  const std::string whole = text_of(f.tiff("whole.tif", GDT_Int16, hills(), {}, {"BLOCKYSIZE=1"}));
  refuse("a TIFF whose second half is missing", f.bytes("half.tif", whole.substr(0, whole.size() / 2)), "truncated");
  refuse("an empty file", f.bytes("empty.tif", ""), "0 bytes|empty");
  refuse("a compressed TIFF, .tif.gz", f.bytes("a.tif.gz", "\x1f\x8b\x08" + whole), "");
  refuse("a web page", f.bytes("page.tif", "<!DOCTYPE html><html><body>404 Not Found</body></html>"), "not a raster");
  refuse("a file that is not there", f.path("none.tif"), "does not exist");
  ::mkdir(f.path("folder.tif").c_str(), 0700);
  refuse("a folder", f.path("folder.tif"), "folder|directory");
  std::filesystem::create_symlink(f.path("loop.tif"), f.path("loop.tif"));
  refuse("a link to itself", f.path("loop.tif"), "");
  for (const char* name : {"pipe.tif", "pipe.npy", "pipe.exr", "pipe.asc", "pipe.vox", "pipe.json"}) {
    ::mkfifo(f.path(name).c_str(), 0600);
    refuse(fmt::format("a pipe that nobody writes to, {}", name), f.path(name), "pipe", true);
  }
  refuse("/dev/null", "/dev/null", "device");
  refuse("an empty file with a line break in its name", f.bytes("two\nlines.tif", ""), "");
  if (::geteuid() != 0) {
    const std::string secret = f.bytes("secret.tif", whole);
    ::chmod(secret.c_str(), 0);
    refuse("a file that may not be read", secret, "permission");
  }
  for (const std::string name : {"with space.tif", "H\xc3\xb6hen.tif", "100%s%n.tif", "{}{0}.tif", "-x,y;z'.tif"}) {
    all.push_back({.kind = "the name " + name, .inputs = {f.bytes(name, whole)}, .heights = kHills});
  }
  const std::uint32_t most = 0x7fffffff;
  refuse("2,147,483,647 samples squared, of which 64 bytes are there", f.bytes("vast.tif", tiff_header(most, most, 64)),
         "", true);
  refuse("100,000 samples squared, of which 64 bytes are there", f.bytes("big.tif", tiff_header(100000, 100000, 64)),
         "", true);
  refuse("a virtual raster of itself", f.bytes("self.vrt", vrt("self.vrt", true)), "", true);
  refuse("a virtual raster of a missing file", f.bytes("missing.vrt", vrt("none.tif", true)), "none.tif");
  refuse("a virtual raster of 2,000,000 samples squared", f.bytes("vast.vrt", vrt("whole.tif", true, 2000000, 2000000)),
         "", true);
  all.push_back({.kind = "a TIFF of big-endian 32-bit floats",
                 .inputs = {f.tiff("big-endian.tif", GDT_Float32, hills(), {}, {"ENDIANNESS=BIG"})},
                 .heights = kHills,
                 .width_m = kHillsWidth_m,
                 .peaks_in_north_east = true});
  const std::string pages = f.tiff("pages.tif", GDT_Int16, hills());
  f.copy(f.tiff("page2.tif", GDT_Int16, {1, 2, 3, 4}, {}, {}, 1, 2, 2), "GTiff", "pages.tif",
         {"APPEND_SUBDATASET=YES"});
  all.push_back({.kind = "a TIFF of two pages", .inputs = {pages}, .expected = right_or_refused, .heights = kHills});
  all.push_back({.kind = "a virtual raster with an absolute path",
                 .inputs = {f.bytes("absolute.vrt", vrt(f.path("whole.tif"), false))},
                 .heights = kHills});
  refuse("a .hgt of a wrong size", f.bytes("N47E008.hgt", std::string(5000, '\1')), ".hgt");
  refuse("raw samples that are too few", f.bytes("few.raw", std::string(100, '\1')), "bytes|raw");
  all.back().options = {"--raw", "24x16:i16le"};
  // The archive must stay open between its members, otherwise it contains only the last one.
  const std::string archive = "/vsizip/" + f.path("two.zip");
  VSILFILE* zip = VSIFOpenL(archive.c_str(), "wb");
  for (const char* name : {"/a.tif", "/b.tif"}) {
    VSILFILE* member = VSIFOpenL((archive + name).c_str(), "wb");
    VSIFWriteL(whole.data(), 1, whole.size(), member);
    VSIFCloseL(member);
  }
  VSIFCloseL(zip);
  refuse("an archive of two rasters", f.path("two.zip"), "a.tif");

  const std::string little = sample_bytes<double>(hills());
  const auto npy = [&](const char* name, const std::string& type, const std::string& shape,
                       const std::string& samples) {
    return f.bytes(name, npy_bytes(npy_dictionary(type, shape), samples));
  };
  std::vector<double> columns;
  for (int col = 0; col < kCols; ++col) {
    for (int row = 0; row < kRows; ++row) columns.push_back(hill(col, row));
  }
  all.push_back({.kind = "an array by columns",
                 .inputs = {f.bytes("fortran.npy",
                                    npy_bytes(npy_dictionary("<f4", "(16, 24)", true), sample_bytes<float>(columns)))},
                 .expected = right_or_refused,
                 .heights = kHills,
                 .peaks_in_north_east = true});
  all.push_back({.kind = "an array of big-endian doubles",
                 .inputs = {npy("big.npy", ">f8", "(16, 24)", sample_bytes<double>(hills(), true))},
                 .heights = kHills,
                 .width_m = 23,
                 .peaks_in_north_east = true});
  refuse("an array of records",
         f.bytes("records.npy", npy_bytes("{'descr': [('x', '<f8')], 'fortran_order': False, "
                                          "'shape': (16, 24), }",
                                          little)),
         "");
  refuse("an array of objects", npy("objects.npy", "|O", "(16, 24)", little), "");
  refuse("an array of texts", npy("texts.npy", "<U2", "(16, 24)", little), "");
  refuse("an array without dimensions", npy("scalar.npy", "<f8", "()", little.substr(0, 8)), "dimension|shape|()");
  refuse("an array of three dimensions", npy("cube.npy", "<f8", "(2, 8, 24)", little), "");
  refuse("an array of negative size", npy("minus.npy", "<f8", "(-16, 24)", little), "");
  refuse("an array without samples", npy("zero.npy", "<f8", "(0, 24)", ""), "");
  refuse("an array whose size overflows", npy("overflow.npy", "<f8", "(4294967296, 4294967296)", little), "", true);
  refuse("an array cut off", npy("cut.npy", "<f8", "(16, 24)", little.substr(0, 1000)), "truncated|bytes");
  return all;
}

}  // namespace scarp::test
