// SPDX-License-Identifier: MIT
#include "app/cli/picture/map_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>

#include "app/cli/memory/file_memory.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_part.h"
#include "app/cli/picture/map_journal.h"
#include "app/cli/picture/map_preview.h"
#include "app/cli/progress.h"
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

// The bands of all rows, like those of some rows, with the pixels of finished strips.
std::vector<ComputedBand> whole_bands(const std::vector<ComputedBand>& like, const RowBand& rows, int cols,
                                      const std::vector<JournalStrip>& done) {
  std::vector<ComputedBand> bands;
  for (std::size_t b = 0; b < like.size(); ++b) {
    ComputedBand band = like[b];
    const auto put = [&]<class Pixels>(Pixels& pixels) {
      pixels = Pixels(static_cast<std::size_t>(rows.rows()) * static_cast<std::size_t>(cols));
      std::byte* at = reinterpret_cast<std::byte*>(pixels.data());
      for (const JournalStrip& strip : done) at = std::copy(strip.bands.at(b).begin(), strip.bands.at(b).end(), at);
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

bool MapRun::begin(double bytes_per_pixel, double seconds_per_pixel) {
  needed_ = memory_of(input_, area_, bytes_per_pixel);
  if (options_.raster_output.dry_run) {
    const double pixels = static_cast<double>(area_.computed.cols) * area_.computed.rows;
    print_dry_run(area_, options_.output, needed_, memory_->bytes(), pixels * seconds_per_pixel);
    return false;
  }
  if (needed_ > memory_->bytes() && is_in_memory(memory_->folder()))
    input_.notes.push_back(fmt::format("'{}' is in memory, too: arrays beyond --memory should be on a disk (--scratch)",
                                       memory_->folder()));
  input_.read(area_.read, terminal_progress("read"));
  input_.close();
  return true;
}

int MapRun::strips_of(const MapRecipe& recipe) const {
  // A run that is killed loses at most one strip. Thin strips take longer: most maps depend on ground beside them.
  constexpr int kOfResume = 16, kLeastRows = 256;
  const int rows = area_.rows().rows();
  const double share = memory_->bytes() / 4, most = 1000;
  int strips = options_.raster_output.resume ? std::min(kOfResume, rows / kLeastRows) : 1;
  if (recipe.has_cheap_strips && needed_ > memory_->bytes())
    strips = std::max(strips, static_cast<int>(std::min(needed_ / share, most)));
  return std::clamp(strips, 1, std::max(1, rows));
}

// All that the rows depend on; not the machine, and not how much of it is used.
std::string MapRun::identity(int strips) const {
  std::string text =
      fmt::format("scarp {} {}\n", SCARP_VERSION,
                  command_.typed_words({"--threads", "--memory", "--scratch", "--resume", "--quiet", "--preview"}));
  std::vector<std::string> files = input_.files();
  files.insert(files.end(), options_.typed.begin(), options_.typed.end());  // tables, models of the ground
  for (const std::string& file : files) {
    std::error_code failed;
    const auto size = std::filesystem::file_size(file, failed);
    const auto time = std::filesystem::last_write_time(file, failed).time_since_epoch().count();
    text += fmt::format("{} {} {}\n", file, failed ? 0 : size, failed ? 0 : time);
  }
  const RowBand rows = area_.rows();
  return text + fmt::format("part '{}' rows {} to {} in {} strips\n", options_.raster_output.part, rows.first,
                            rows.last, strips);
}

std::vector<ComputedBand> MapRun::compute(const MapRecipe& recipe, std::optional<MapJournal>& journal) {
  const RowBand rows = area_.rows();
  const int strips = strips_of(recipe);
  const Progress progress = terminal_progress(command_.name());
  std::vector<JournalStrip> done;
  if (options_.raster_output.resume) {
    journal.emplace(options_.output, identity(strips));
    for (JournalStrip strip; journal->next(strip);) done.push_back(std::move(strip));
    // The last strip is computed again for the names of the bands.
    if (static_cast<int>(done.size()) == strips) done.pop_back();
    if (!done.empty()) {
      for (std::size_t i = 0; i < recipe.totals.size(); ++i) *recipe.totals[i] = done.back().totals.at(i);
      input_.notes.push_back(
          fmt::format("--resume: {} of {} rows were done", done.back().last - rows.first, rows.rows()));
    }
  }
  if (strips == 1 && !journal) return recipe.compute(rows, progress);
  std::vector<ComputedBand> bands;
  const auto begun = static_cast<int>(done.size());
  for (int i = begun; i < strips; ++i) {
    const RowBand of_strips = row_band(rows.rows(), i + 1, strips);
    const RowBand strip{rows.first + of_strips.first, rows.first + of_strips.last};
    const std::vector<ComputedBand> computed =
        recipe.compute(strip, progress_part(progress, i - begun, strips - begun));
    if (journal) {
      std::vector<double> totals;
      for (const double* total : recipe.totals) totals.push_back(*total);
      std::vector<std::span<const std::byte>> pixels;
      for (const ComputedBand& band : computed) pixels.push_back(pixels_of(band));
      journal->append(strip.first, strip.last, totals, pixels);
    }
    if (bands.empty()) bands = whole_bands(computed, rows, input_.part().cols, done);
    put_rows(bands, computed, static_cast<std::size_t>(of_strips.first) * input_.part().cols);
  }
  return bands;
}

void MapRun::write(const MapRecipe& recipe) {
  const RowBand rows = area_.rows();
  std::optional<MapPreview> preview;
  if (!options_.raster_output.preview.empty())
    preview.emplace(options_.raster_output.preview, options_.raster_output.draw, input_);
  RasterMap map = map_of(input_, options_.raster_output, area_, recipe.method, recipe.metadata);
  std::optional<MapJournal> journal;
  const std::vector<ComputedBand> bands = compute(recipe, journal);
  for (const ComputedBand& band : bands) map.bands.push_back(view_of(band));
  if (recipe.files.empty()) write_map(options_.raster_output, options_.output, map);
  for (std::size_t k = 0; k < recipe.files.size(); ++k) {
    keep_inputs(recipe.files[k], input_.files());
    RasterMap one = map;
    one.bands = {map.bands[k]};
    write_map(options_.raster_output, recipe.files[k], one);
  }
  if (journal) journal->remove();
  if (preview) preview->write(map, rows, recipe.ramp, recipe.marks);
  const std::string written = recipe.files.empty() ? options_.output
                                                   : fmt::format("{} files, {} to {}", recipe.files.size(),
                                                                 recipe.files.front(), recipe.files.back());
  print_map_summary(input_, options_.raster_output, area_, written, recipe.summary(), start_);
}

}  // namespace scarp::cli
