// SPDX-License-Identifier: MIT
#include "scarp/output/plot.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"

namespace scarp {
namespace {

constexpr double kKilometres = 5000;  // metres from which distances are in kilometres

// Returns 1, 2 or 5 times a power of ten, for about `count` steps over the range.
double step_for(double range, double count) {
  const double raw = range / count, power = std::pow(10, std::floor(std::log10(raw))), share = raw / power;
  return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

// `unit`: metres per unit of the numbers; about `count` ticks.
std::vector<PlotTick> round_distances(double begin, double end, double unit, double count) {
  const double along = step_for((end - begin) / unit, count);
  // Rounding may move the last tick beyond the end.
  constexpr double kTickSlack = 1.0 / 1024;  // of a step: less than a pixel
  const double first = std::ceil(begin / unit / along - kTickSlack), last = std::floor(end / unit / along + kTickSlack);
  std::vector<PlotTick> ticks;
  for (double i = first; i <= last; ++i) {
    const double d = i == 0 ? 0.0 : i * along;  // not -0
    ticks.push_back({d * unit, fmt::format("{:.6g}", d), {}});
  }
  return ticks;
}

CairoSurface surface_for(const std::string& extension, std::ofstream& stream, int width, int height) {
  if (extension == ".svg")
    return CairoSurface(cairo_svg_surface_create_for_stream(write_bytes, &stream, width, height));
  if (extension == ".png") return CairoSurface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  CairoSurface surface(cairo_pdf_surface_create_for_stream(write_bytes, &stream, width, height));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "Scarp");
  // No time: the same picture gives the same file.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  return surface;
}

}  // namespace

void set_colour(cairo_t* cr, const PlotColour& c) { cairo_set_source_rgba(cr, c.r, c.g, c.b, c.a); }

void Plot::axes(const FigurePen& pen, bool names_distance) const {
  cairo_t* cr = pen.cr();
  const double text = pen.text(), below = box.y + box.height;
  const double up = step_for(high - low, box.height / (4 * text));
  const bool kilometres = end - begin >= kKilometres;
  const std::vector<PlotTick> lines =
      ticks.empty() ? round_distances(begin, end, kilometres ? 1000 : 1, box.width / (8 * text)) : ticks;
  for (double z = std::ceil(low / up) * up; z <= high; z += up) {
    cairo_move_to(cr, box.x, y(z));
    cairo_rel_line_to(cr, box.width, 0);
  }
  for (const PlotTick& line : lines) {
    cairo_move_to(cr, x(line.at), box.y);
    cairo_rel_line_to(cr, 0, box.height);
  }
  set_colour(cr, kPlotGrid);
  cairo_set_line_width(cr, 1);
  cairo_stroke(cr);
  for (double z = std::ceil(low / up) * up; z <= high; z += up) {
    const std::string number = fmt::format("{:.10g}", std::abs(z) < up / 2 ? 0.0 : z);
    pen.write(box.x - pen.width_of(number) - text / 2, y(z) + pen.ascent() / 2.5, number);
  }
  double lowest = 1.3;  // lines of text below the box
  for (const PlotTick& line : lines) {
    pen.write(x(line.at) - pen.width_of(line.number) / 2, below + 1.3 * pen.line_height(), line.number);
    if (line.name.empty()) continue;
    pen.write(x(line.at) - pen.width_of(line.name) / 2, below + 2.3 * pen.line_height(), line.name);
    lowest = 2.3;
  }
  if (names_distance) {
    const std::string name = !ticks.empty() ? along : kilometres ? "distance (km)" : "distance (m)";
    pen.write(box.x + (box.width - pen.width_of(name)) / 2, below + (lowest + 1.2) * pen.line_height(), name);
  }
  cairo_save(cr);
  cairo_translate(cr, 1.1 * text, box.y + box.height / 2);
  cairo_rotate(cr, -std::acos(0.0));
  pen.write(-pen.width_of(upward) / 2, 0, upward);
  cairo_restore(cr);
}

void write_plot(ReplaceFile& file, const std::string& path, int width, int height,
                const std::function<void(cairo_t*)>& draw) {
  const std::string extension = extension_of(path);
  if (extension != ".svg" && extension != ".png" && extension != ".pdf")
    throw Error(fmt::format("output '{}': expected .svg, .pdf or .png", path));
  std::ofstream stream(file.temporary_path(), std::ios::binary);
  const CairoSurface surface = surface_for(extension, stream, width, height);
  const CairoContext context(cairo_create(surface.get()));
  require_good(surface.get(), context.get());
  cairo_set_source_rgb(context.get(), 1, 1, 1);
  cairo_paint(context.get());
  draw(context.get());
  cairo_status_t status = cairo_status(context.get());
  if (extension == ".png" && status == CAIRO_STATUS_SUCCESS)
    status = cairo_surface_write_to_png_stream(surface.get(), write_bytes, &stream);
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  stream.close();
  if (status != CAIRO_STATUS_SUCCESS || !stream)
    throw Error(fmt::format("{}: cannot be written: {} (is the disk full?)", path, cairo_status_to_string(status)));
  file.commit();
}

}  // namespace scarp
