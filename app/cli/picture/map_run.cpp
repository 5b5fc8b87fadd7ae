// SPDX-License-Identifier: MIT
#include "app/cli/picture/map_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "app/cli/memory/file_memory.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_part.h"
#include "app/cli/picture/check_sum.h"
#include "app/cli/picture/map_identity.h"
#include "app/cli/picture/map_journal.h"
#include "app/cli/picture/map_preview.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/base/progress_part.h"

namespace scarp::cli {
namespace {

// Checks the output before the raster is opened.
MapCommand& settled(MapCommand& options, std::string_view sample_type) {
  settle_output(options.raster_output, options, sample_type);
  return options;
}

MapCommand& limited(MapCommand& options, const MemoryLimit& limit) {
  options.raster.memory = limit.bytes();
  return options;
}

MapBand view_of(const ComputedBand& band) {
  return {band.name,
          band.unit,
          std::visit([](const auto& pixels) -> decltype(MapBand::samples) { return std::span(pixels); }, band.pixels),
          band.nodata,
          band.classes,
          band.scale,
          band.offset};
}

std::span<const std::byte> pixels_of(const ComputedBand& band) {
  return std::visit([](const auto& pixels) { return std::as_bytes(std::span(pixels)); }, band.pixels);
}

// Throws Error unless the strips have the bands of this map.
void require_like(const std::vector<ComputedBand>& like, int cols, const std::vector<JournalStrip>& done,
                  const std::string& output) {
  const auto fits = [&](const JournalStrip& strip) {
    if (strip.bands.size() != like.size()) return false;
    const auto pixels = static_cast<std::size_t>(strip.last - strip.first) * static_cast<std::size_t>(cols);
    for (std::size_t b = 0; b < like.size(); ++b) {
      const auto bytes = [&]<class Pixels>(const Pixels&) { return pixels * sizeof(typename Pixels::value_type); };
      const JournalBand& band = strip.bands[b];
      if (band.type != like[b].pixels.index() || band.pixels.size() != std::visit(bytes, like[b].pixels)) return false;
    }
    return true;
  };
  if (!std::all_of(done.begin(), done.end(), fits))
    throw Error(fmt::format("{}.resume: has other bands than this map (delete it to begin anew)", output));
}

// The bands of all rows, like those of some rows, with the pixels of finished strips.
std::vector<ComputedBand> whole_bands(const std::vector<ComputedBand>& like, const RowBand& rows, int cols,
                                      const std::vector<JournalStrip>& done) {
  std::vector<ComputedBand> bands;
  for (std::size_t b = 0; b < like.size(); ++b) {
    ComputedBand band = like[b];
    const auto put = [&]<class Pixels>(Pixels& pixels) {
      pixels = Pixels(static_cast<std::size_t>(rows.rows()) * static_cast<std::size_t>(cols));
      std::byte* at = reinterpret_cast<std::byte*>(pixels.data());
      for (const JournalStrip& strip : done)
        at = std::copy(strip.bands[b].pixels.begin(), strip.bands[b].pixels.end(), at);
    };
    std::visit(put, band.pixels);
    bands.push_back(std::move(band));
  }
  return bands;
}

void put_rows(std::vector<ComputedBand>& bands, const std::vector<ComputedBand>& rows, std::size_t first_pixel) {
  for (std::size_t b = 0; b < bands.size(); ++b)
    std::visit(
        [&]<class Pixels>(Pixels& pixels) {
          const auto& from = std::get<Pixels>(rows[b].pixels);
          std::copy(from.begin(), from.end(), pixels.begin() + static_cast<std::ptrdiff_t>(first_pixel));
        },
        bands[b].pixels);
}

}  // namespace

void add_map_command(Command& command, MapCommand& options, std::function<void()> run,
                     const std::vector<std::string>& excludes) {
  add_raster_output_options(command, options.raster_output, excludes);
  add_map_options(command, options);
  add_memory_options(command, options.memory, excludes);
  command.runs([&options, &command, run = std::move(run)] {
    options.typed = command.typed_values();
    command.require_effect({});
    run();
  });
}

ComputedBand number_band(std::string name, std::string unit, std::vector<float> pixels, double nodata) {
  std::replace_if(
      pixels.begin(), pixels.end(), [](float pixel) { return std::isnan(pixel); }, static_cast<float>(nodata));
  return {std::move(name), std::move(unit), std::move(pixels), nodata};
}

MapRun::MapRun(MapCommand& options, const Command& command, std::string_view sample_type)
    : options_(settled(options, sample_type)),
      command_(command),
      threads_(options.threads),
      memory_(limit_memory(options.memory, options.output)),
      silence_(options.raster_output.quiet ? std::make_optional<SilentProgress>() : std::nullopt),
      start_(std::chrono::steady_clock::now()),
      input_(limited(options, *memory_)) {
  keep_inputs(options.output, input_.files());
  set_area(input_.whole(), input_.whole());
}

void MapRun::set_area(const RasterWindow& whole, const RasterWindow& read) {
  area_ = map_area(input_, options_.raster_output, whole, read);
}

void MapRun::set_rows(const std::function<RowBand(const RowBand& output)>& rows) {
  // A preview shows the whole raster.
  if (options_.raster_output.part.empty() || !options_.raster_output.preview.empty()) return;
  const RowBand wanted = rows({area_.output.row, area_.output.row + area_.output.rows});
  RasterWindow read = area_.read;
  const int first = std::max(read.row, wanted.first), last = std::min(read.row + read.rows, wanted.last);
  read.row = first, read.rows = last - first;
  set_area(area_.whole, read);
}

void MapRun::set_reach(double metres) {
  // A preview shows the whole raster.
  if (options_.raster_output.preview.empty()) set_area(input_.whole(), rows_around(input_, area_.output, metres));
}

bool MapRun::begin(double bytes_per_pixel, double seconds_per_pixel, double more_bytes) {
  needed_ = memory_of(area_, bytes_of(input_.sample_type()) + more_bytes, bytes_per_pixel);
  if (options_.raster_output.dry_run) {
    const double pixels = static_cast<double>(area_.computed.cols) * area_.computed.rows;
    print_dry_run(options_.output, fmt::format("{} x {} pixels", area_.output.cols, area_.output.rows), needed_,
                  memory_->bytes(), pixels * seconds_per_pixel);
    return false;
  }
  if (needed_ > memory_->bytes() && is_in_memory(memory_->folder()))
    input_.notes.push_back(fmt::format("'{}' is in memory, too: arrays beyond --memory should be on a disk (--scratch)",
                                       memory_->folder()));
  input_.read(area_.read, terminal_progress("read"));
  input_.close();
  return true;
}

double MapRun::working_memory() const {
  const double arrays = memory_->bytes_of_arrays();
  return needed_ <= arrays ? arrays : arrays / 2;
}

int MapRun::strips_of(const MapRecipe& recipe) const {
  // A run that is killed loses at most one strip. Thin strips take longer: most maps depend on ground beside them.
  constexpr int kOfResume = 16, kLeastRows = 256;
  const int rows = area_.rows().rows();
  const double share = memory_->bytes() / 4, most = 1000;
  int strips = options_.raster_output.resume ? std::min(kOfResume, rows / kLeastRows) : 1;
  if (recipe.has_cheap_strips && needed_ > memory_->bytes())
    strips = std::max(strips, static_cast<int>(std::min({needed_ / share, most, rows / (1.0 * recipe.rows_of_strip)})));
  return std::clamp(strips, 1, std::max(1, rows));
}

// Strips in the journal are rows of the raster, which do not depend on the samples that are read.
std::vector<JournalStrip> MapRun::finished_strips(const MapRecipe& recipe, MapJournal& journal) {
  const RasterWindow& computed = area_.computed;
  std::vector<JournalStrip> done;
  int next = computed.row;
  for (JournalStrip strip; journal.next(strip);) {
    if (strip.first != next || strip.last <= strip.first || strip.last > computed.row + computed.rows ||
        strip.totals.size() != recipe.totals.size())
      throw Error(
          fmt::format("{}.resume: does not hold the rows of this map (delete it to begin anew)", options_.output));
    next = strip.last;
    done.push_back(std::move(strip));
  }
  if (done.empty()) return done;
  for (std::size_t i = 0; i < recipe.totals.size(); ++i) *recipe.totals[i] = done.back().totals[i];
  input_.notes.push_back(fmt::format("--resume: {} of {} rows were done", next - computed.row, computed.rows));
  return done;
}

std::vector<ComputedBand> MapRun::compute(const MapRecipe& recipe, std::optional<MapJournal>& journal) {
  const RowBand rows = area_.rows();
  const Progress progress = terminal_progress(command_.name());
  const int strips_of_all = strips_of(recipe);
  if (rows.rows() == 0 || (strips_of_all == 1 && !options_.raster_output.resume)) return recipe.compute(rows, progress);
  std::vector<JournalStrip> done;
  if (options_.raster_output.resume) {
    const RasterWindow& computed = area_.computed;
    journal.emplace(options_.output, fmt::format("{}rows {} to {}, columns {} to {}, {} totals\n", identity(recipe),
                                                 computed.row, computed.row + computed.rows, computed.col,
                                                 computed.col + computed.cols, recipe.totals.size()));
    done = finished_strips(recipe, *journal);
  }
  const int cols = input_.part().cols, to_raster = area_.read.row,
            begun = done.empty() ? rows.first : done.back().last - to_raster, left = rows.last - begun;
  if (left == 0) return finished_bands(recipe, done);
  // Strips of an earlier run may be of another height, which depends on --memory.
  const int strips = std::max(1, static_cast<int>(std::int64_t{strips_of_all} * left / rows.rows()));
  std::vector<ComputedBand> bands;
  for (int i = 0; i < strips; ++i) {
    const RowBand of_left = row_band(left, i + 1, strips);
    const RowBand strip{begun + of_left.first, begun + of_left.last};
    const std::vector<ComputedBand> computed = recipe.compute(strip, progress_part(progress, i, strips));
    if (bands.empty()) {
      require_like(computed, cols, done, options_.output);
      bands = whole_bands(computed, rows, cols, done);
    }
    if (journal) {
      std::vector<double> totals;
      for (const double* total : recipe.totals) totals.push_back(*total);
      std::vector<BandPixels> pixels;
      for (const ComputedBand& band : computed) pixels.push_back({band.pixels.index(), pixels_of(band)});
      journal->append(strip.first + to_raster, strip.last + to_raster, totals, pixels);
    }
    put_rows(bands, computed, static_cast<std::size_t>(strip.first - rows.first) * static_cast<std::size_t>(cols));
  }
  return bands;
}

// A row is computed again for the names of the bands; it counts no second time.
std::vector<ComputedBand> MapRun::finished_bands(const MapRecipe& recipe, const std::vector<JournalStrip>& done) {
  const RowBand rows = area_.rows();
  const std::vector<ComputedBand> like =
      recipe.compute({rows.first, rows.first + 1}, terminal_progress(command_.name()));
  for (std::size_t i = 0; i < recipe.totals.size(); ++i) *recipe.totals[i] = done.back().totals[i];
  require_like(like, input_.part().cols, done, options_.output);
  return whole_bands(like, rows, input_.part().cols, done);
}

std::string MapRun::identity(const MapRecipe& recipe) const { return map_identity(command_, input_, recipe.inputs); }

void MapRun::write(const MapRecipe& recipe) {
  const RowBand rows = area_.rows();
  std::optional<MapPreview> preview;
  if (!options_.raster_output.preview.empty())
    preview.emplace(options_.raster_output.preview, options_.raster_output.draw, input_);
  RasterMap map = map_of(input_, options_.raster_output, area_, recipe.method, recipe.metadata);
  if (!options_.raster_output.part.empty())
    map.metadata.emplace_back("RUN", fmt::format("{:016x}", check_sum_of(identity(recipe))));
  std::optional<MapJournal> journal;
  const std::vector<ComputedBand> bands = compute(recipe, journal);
  for (const ComputedBand& band : bands) map.bands.push_back(view_of(band));
  if (recipe.files.empty()) write_map(options_.raster_output, options_.output, map);
  for (std::size_t k = 0; k < recipe.files.size(); ++k) {
    RasterMap one = map;
    one.bands = {map.bands[k]};
    write_map(options_.raster_output, recipe.files[k], one);
  }
  if (preview) preview->write(map, rows, recipe.ramp, recipe.marks);
  if (recipe.write_more) recipe.write_more();
  if (journal) journal->remove();
  const std::string written = recipe.files.empty() ? options_.output
                                                   : fmt::format("{} files, {} to {}", recipe.files.size(),
                                                                 recipe.files.front(), recipe.files.back());
  print_map_summary(input_, options_.raster_output, area_, written, recipe.summary, start_);
}

}  // namespace scarp::cli
