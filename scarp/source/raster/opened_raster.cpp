// SPDX-License-Identifier: MIT
#include "scarp/source/raster/opened_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/exr_raster.h"
#include "scarp/source/raster/gdal_dataset.h"
#include "scarp/source/raster/gdal_raster.h"
#include "scarp/source/raster/npy.h"
#include "scarp/source/raster/opened_dataset.h"
#include "scarp/source/raster/raster_name.h"
#include "scarp/source/raster/raw_raster.h"
#include "scarp/source/raster/tile_set.h"

namespace scarp {
namespace {

constexpr std::size_t kFilesNamed = 3;
constexpr std::size_t kWarningsWorthANote = 3;

// Rejects options that apply only to other file types.
void refuse_foreign_options(const std::string& path, const RasterOptions& options) {
  const bool raw = options.raw.has_value(), exr = !raw && extension_of(path) == ".exr",
             archive = !raw && extension_of(path) == ".npz", array = !raw && is_npy_path(path);
  const auto refuse = [&](std::string_view text) { throw Error(fmt::format("{}: {} (omit it)", path, text)); };
  if (!options.key.empty() && !archive) refuse("--key applies to .npz archives only");
  if (!options.channel.empty() && !exr) refuse("--channel applies to .exr files only");
  if (options.encoding != HeightEncoding::none && (raw || exr || array))
    refuse("--encoding applies to colour images only");
}

OpenedDataset open_file(const std::string& path, const RasterOptions& options, GdalSession& session) {
  if (options.raw) return open_raw(path, options, session);
  if (is_npy_path(path)) return open_npy(path, options, session);
  if (extension_of(path) == ".exr") return open_exr_raster(path, options);
  OpenedDataset opened;
  opened.dataset = open_gdal_raster(path, session);
  return opened;
}

std::string names_of(const std::vector<std::string>& inputs) {
  std::string names;
  for (std::size_t i = 0; i < std::min(inputs.size(), kFilesNamed); ++i) names += (i == 0 ? "" : ", ") + inputs[i];
  return inputs.size() > kFilesNamed ? fmt::format("{} and {} more", names, inputs.size() - kFilesNamed) : names;
}

// Copies a part of a raster that is in memory.
Raster part_of(const Raster& whole, const RasterWindow& part) {
  Raster raster = whole;
  raster.cols = part.cols;
  raster.rows = part.rows;
  std::visit(
      [&](auto& samples) {
        const auto& all = std::get<std::decay_t<decltype(samples)>>(whole.samples);
        samples.clear();
        for (int row = part.row; row < part.row + part.rows; ++row) {
          const auto begin = all.begin() + static_cast<std::ptrdiff_t>(row) * whole.cols + part.col;
          samples.insert(samples.end(), begin, begin + part.cols);
        }
      },
      raster.samples);
  auto& map = raster.georeference.map_from_node;
  map[0] += part.col * map[1];
  map[3] += part.row * map[5];
  return raster;
}

}  // namespace

struct OpenedRaster::State {
  std::string name;  // of all inputs, for messages
  RasterOptions options;
  OpenedDataset opened;
  std::optional<DatasetReader> reader;    // of `opened`
  std::vector<std::string> files, notes;  // notes about folders and tiles come first
  std::vector<std::string> warnings;      // of GDAL, when the file was opened
  DatasetHeader header;
  std::optional<Raster> whole;  // if the scale depends on all samples

  void open(const std::vector<std::string>& inputs);
  void open_tiles(GdalSession& session);
  Raster read(const std::optional<RasterWindow>& part, const Progress& progress);
  void complete(Raster& raster, const std::vector<std::string>& more_warnings) const;
};

void OpenedRaster::State::open(const std::vector<std::string>& inputs) {
  if (inputs.empty()) throw Error("no raster given (name a file or a folder)");
  GdalSession session;
  const StrictReading strict;
  for (const std::string& input : inputs) {
    if (!options.raw && !is_npy_path(input) && is_tile_folder(input)) {
      const std::vector<std::string> found = rasters_in(input, options, notes);
      files.insert(files.end(), found.begin(), found.end());
    } else {
      files.push_back(input);
    }
  }
  if (files.size() == 1) {
    name = files.front();
    refuse_foreign_options(name, options);
    read_named(name, [&] {
      GdalSession of_file;  // warnings about skipped files do not concern the raster
      opened = open_file(name, options, of_file);
      reader.emplace(*opened.dataset, options);
      header = reader->header();
      warnings = of_file.warnings();
    });
  } else {
    name = names_of(inputs);
    open_tiles(session);
  }
  complete(header.raster, {});
}

void OpenedRaster::State::open_tiles(GdalSession& session) {
  for (const std::string& file : files) {
    refuse_foreign_options(file, options);
    if (options.raw || is_npy_path(file) || extension_of(file) == ".exr")
      throw Error(fmt::format(
          "{}: no georeference, which tiles require (read it alone, or convert it to GeoTIFF first)", file));
  }
  TileSet tiles = open_tile_set(files, options, session, notes);
  read_named(name, [&] {
    options.band = 0;
    settle_height_range(options, tiles.type, false);
    opened.dataset = std::move(tiles.dataset);
    if (options.encoding == HeightEncoding::none) opened.file_type = GDALGetDataTypeName(tiles.type);
    reader.emplace(*opened.dataset, options);
    header = reader->header();
    warnings = session.warnings();
  });
}

Raster OpenedRaster::State::read(const std::optional<RasterWindow>& part, const Progress& progress) {
  GdalSession session;
  const StrictReading strict;
  return read_named(name, [&] {
    Raster raster = reader->read(part, session, progress);
    complete(raster, session.warnings());
    return raster;
  });
}

// Adds what is known only once the files are opened: name, type, files, warnings and notes.
void OpenedRaster::State::complete(Raster& raster, const std::vector<std::string>& more_warnings) const {
  raster.path = name;
  if (!opened.file_type.empty()) raster.file_type = opened.file_type;
  raster.files.insert(raster.files.end(), files.begin(), files.end());
  std::vector<std::string> all = warnings;
  for (const std::string& warning : more_warnings)
    if (std::find(all.begin(), all.end(), warning) == all.end()) all.push_back(warning);
  for (std::size_t i = 0; i < std::min(all.size(), kWarningsWorthANote); ++i) raster.notes.push_back("GDAL: " + all[i]);
  raster.notes.insert(raster.notes.end(), opened.notes.begin(), opened.notes.end());
  raster.notes.insert(raster.notes.begin(), notes.begin(), notes.end());
}

OpenedRaster::OpenedRaster(const std::vector<std::string>& inputs, const RasterOptions& options,
                           const Progress& progress)
    : state_(std::make_unique<State>()) {
  state_->options = options;
  state_->open(inputs);
  if (!state_->header.scale_varies) return;
  state_->whole = state_->read({}, progress);
  state_->header.raster.scale = state_->whole->scale;
  state_->header.raster.notes = state_->whole->notes;
}

OpenedRaster::~OpenedRaster() = default;
OpenedRaster::OpenedRaster(OpenedRaster&&) noexcept = default;

const Raster& OpenedRaster::header() const { return state_->header.raster; }
const SampleEnds& OpenedRaster::stated() const { return state_->header.stated; }

Raster OpenedRaster::read(const Progress& progress) {
  return state_->whole ? std::move(*std::exchange(state_->whole, {})) : state_->read({}, progress);
}

Raster OpenedRaster::read(const RasterWindow& part, const Progress& progress) {
  if (!state_->header.scale_varies) return state_->read(part, progress);
  if (!state_->whole) state_->whole = state_->read({}, progress);
  return part_of(*state_->whole, part);
}

}  // namespace scarp
