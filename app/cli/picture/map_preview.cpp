// SPDX-License-Identifier: MIT
#include "app/cli/picture/map_preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/picture/figure.h"
#include "app/cli/picture/picture_output.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/render/frame/picture_request.h"
#include "scarp/render/surface/ramp.h"

namespace scarp::cli {
namespace {

std::string kept(std::string path, const MapInput& input) {
  keep_inputs(path, input.files());
  return path;
}

// The ground below a map is shaded, but without cast shadows, which could be mistaken for those of the map.
PictureSettings settings_of(const MapInput& input, const Scene& scene) {
  constexpr int kLongerSide = 1000;
  PictureRequest request;
  request.shadows = false;
  return resolve(request, {.grid_north_azimuth = input.georeference().grid_north_azimuth,
                           .map = picture_box(scene),
                           .size = {kLongerSide, kLongerSide}});
}

Scene scene_of(const MapInput& input) {
  if (!input.field().has_ground())
    throw Error(fmt::format("--preview: {}: there is no ground to show, only holes or a single row", input.path()));
  return Scene(scene_heights(input.field()));
}

#ifdef SCARP_CAIRO

using Colour = std::array<std::uint8_t, 4>;

// The colour of each pixel of a band, and their legend.
struct Paint {
  std::function<Colour(std::size_t)> colour;
  std::optional<FigureKey> key{};
  std::optional<FigureLegend> legend{};
};

Paint paint_of_classes(const MapBand& band, std::span<const std::uint8_t> codes) {
  std::array<Colour, 256> colours{};
  std::array<bool, 256> present{};
  for (const MapClass& one : band.classes) colours[static_cast<std::size_t>(one.code)] = one.colour;
  for (const std::uint8_t code : codes) present[code] = true;
  // A band that is named after one of its classes needs no title.
  const auto named = [&](const MapClass& one) { return one.name == band.name; };
  FigureKey key{std::any_of(band.classes.begin(), band.classes.end(), named) ? "" : band.name, {}};
  for (const MapClass& one : band.classes)
    if (present[static_cast<std::size_t>(one.code)] && one.colour[3] > 0)
      key.entries.push_back({{one.colour[0], one.colour[1], one.colour[2]}, one.name});
  return {[=](std::size_t i) { return colours[codes[i]]; }, std::move(key)};
}

// The range of the colours: complete for whole numbers; for other values without 1 % at either end, which excludes
// lines of sight straight down.
template <class Sample>
std::pair<double, double> range_of(std::vector<Sample> numbers, bool whole_numbers) {
  if (numbers.empty()) return {0, 0};
  const std::size_t last = numbers.size() - 1, cut = whole_numbers ? 0 : numbers.size() / 100;
  const auto at = [&](std::size_t i) {
    std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(i), numbers.end());
    return static_cast<double>(numbers[i]);
  };
  const double low = at(cut);
  return {low, at(last - cut)};
}

template <class Sample>
Paint paint_of_numbers(const MapBand& band, std::span<const Sample> samples, const std::string& ramp) {
  // Counts of 0 are transparent.
  const bool whole_numbers = std::is_integral_v<Sample> && band.scale == 1, counts = whole_numbers && band.unit.empty();
  const auto is_hole = [nodata = band.nodata, counts = counts](Sample sample) {
    return (nodata && static_cast<double>(sample) == *nodata) || (counts && sample == Sample{});
  };
  std::vector<Sample> numbers;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(numbers), [&](Sample s) { return !is_hole(s); });
  const auto [low, high] = range_of(std::move(numbers), whole_numbers);
  const double first = low * band.scale + band.offset, last = high * band.scale + band.offset;
  FigureLegend legend = legend_of(band.unit.empty() ? band.name : fmt::format("{}, {}", band.name, band.unit), first,
                                  last, Ramp(ramp, first, last), 1, whole_numbers ? 1 : 0);
  const double per_unit = high > low ? static_cast<double>(legend.colours.size()) / (high - low) : 0;
  const auto colour = [=, low = low, colours = legend.colours](std::size_t i) {
    if (is_hole(samples[i])) return Colour{};
    const auto at = static_cast<std::size_t>(std::max(0.0, (static_cast<double>(samples[i]) - low) * per_unit));
    const auto& rgb = colours[std::min(at, colours.size() - 1)];
    return Colour{rgb[0], rgb[1], rgb[2], 255};
  };
  return {colour, {}, std::move(legend)};
}

Paint paint_of(const MapBand& band, const std::string& ramp) {
  const auto paint = [&](const auto& samples) {
    using Span = std::decay_t<decltype(samples)>;
    if constexpr (std::is_same_v<typename Span::value_type, std::uint8_t>) {
      if (!band.classes.empty()) return paint_of_classes(band, samples);
    }
    return paint_of_numbers(band, samples, ramp);
  };
  return std::visit(paint, band.samples);
}

// Pixels over the nodes of some rows; averages of blocks if the picture has fewer pixels than nodes.
Drape drape_of(const Paint& paint, const MapInput& input, const RowBand& rows, int picture_width) {
  const int cols = input.field().cols(), block = std::max(1, cols / (2 * picture_width));
  Drape drape{(cols + block - 1) / block, (rows.rows() + block - 1) / block, {}};
  drape.rgba.reserve(4 * static_cast<std::size_t>(drape.width) * static_cast<std::size_t>(drape.height));
  for (int north = 0; north < rows.rows(); north += block)
    for (int west = 0; west < cols; west += block) {
      std::array<int, 4> sum{};
      int pixels = 0;
      for (int row = north; row < std::min(north + block, rows.rows()); ++row)
        for (int col = west; col < std::min(west + block, cols); ++col) {
          const Colour one = paint.colour(static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) +
                                          static_cast<std::size_t>(col));
          for (std::size_t k = 0; k < 3; ++k) sum[k] += one[k] * (one[3] > 0);
          sum[3] += one[3] > 0;
          ++pixels;
        }
      for (std::size_t k = 0; k < 3; ++k)
        drape.rgba.push_back(static_cast<std::uint8_t>(sum[3] > 0 ? sum[k] / sum[3] : 0));
      drape.rgba.push_back(static_cast<std::uint8_t>(255 * sum[3] / pixels));
    }
  const double last_col = cols - 1, last_row = input.field().rows() - 1, north = rows.first - 0.5;
  drape.first = {-0.5 / last_col, north / last_row};
  drape.last = {(drape.width * block - 0.5) / last_col, (north + drape.height * block) / last_row};
  return drape;
}

FigureOptions figure_options(const DrawOptions& draw) {
  FigureOptions options;
  options.draw = draw;
  options.scale_bar = options.north_arrow = true;
  options.layout = "beside";
  return options;
}

#endif

}  // namespace

const PictureFormat& preview_format_of(const std::string& path) {
  const PictureFormat& format = picture_format_of(path, true);
  if (!format.margins)
    throw Error(
        fmt::format("--preview '{}': {} has no margins for a legend (name it *.png or *.pdf)", path, format.name));
#ifndef SCARP_CAIRO
  throw Error("--preview: this scarp was built without Cairo (SCARP_CAIRO=OFF)");
#endif
  return format;
}

MapPreview::MapPreview(std::string path, const DrawOptions& draw, const MapInput& input)
    : path_(kept(std::move(path), input)),
      draw_(draw),
      input_(input),
      file_(path_),
      scene_(scene_of(input)),
      picture_(settings_of(input, scene_))
#ifdef SCARP_CAIRO
      ,
      camera_(Camera::top(picture_box(scene_), picture_.width, picture_.height)),
      place_(input.georeference_of(input.part()))
#endif
{
#ifdef SCARP_CAIRO
  const std::optional<SolidRange> no_numbers;
  figure_ = figure_of(figure_options(draw_), picture_,
                      {scene_, camera_, true, no_numbers, place_, input.field().cols(), input.field().rows()});
#endif
}

#ifdef SCARP_CAIRO

void MapPreview::write(const RasterMap& map, const RowBand& rows, const std::string& ramp,
                       std::vector<DrawnMark> marks) {
  Paint paint = paint_of(map.bands.front(), ramp);
  picture_.ground.drape = std::make_shared<Drape>(drape_of(paint, input_, rows, picture_.width));
  figure_->key = std::move(paint.key);
  figure_->legend = std::move(paint.legend);
  for (DrawnMark& mark : marks) mark.at -= dvec2(input_.part().col, input_.part().row);
  for (FigureShape& shape : drawn_marks(marks, {place_, input_.field().cols(), input_.field().rows(), camera_,
                                                static_cast<double>(pixel_side(picture_))}))
    figure_->shapes.push_back(std::move(shape));
  const Picture picture = render_picture(scene_, camera_, picture_, terminal_progress("preview"));
  write_picture(file_, path_, picture_format_of(path_), picture.image, figure_, {},
                figure_options(draw_).dots_per_inch);
}

#else

void MapPreview::write(const RasterMap&, const RowBand&, const std::string&, std::vector<DrawnMark>) {}

#endif

}  // namespace scarp::cli
