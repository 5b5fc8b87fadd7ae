// SPDX-License-Identifier: MIT
// Figures as PDF.
#include <cairo-pdf.h>
#include <fmt/format.h>

#include <fstream>

#include "scarp/base/error.h"
#include "scarp/output/figure_page.h"

namespace scarp {
namespace {

constexpr double kPointsPerInch = 72;

}  // namespace

void write_pdf(ReplaceFile& file, const std::string& path, const RgbView& picture, const Figure& figure,
               double dots_per_inch) {
  const FigurePage page(figure, picture.width, picture.height);
  const CairoSurface pixels = image_surface(picture);
  const double points = kPointsPerInch / dots_per_inch;
  std::ofstream stream(file.temporary_path(), std::ios::binary);
  const CairoSurface surface(
      cairo_pdf_surface_create_for_stream(write_bytes, &stream, points * page.width(), points * page.height()));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "Scarp");
  // No creation time: equal pictures give equal files.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  if (!figure.title.empty())
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, figure.title.c_str());
  const CairoContext context(cairo_create(surface.get()));
  cairo_scale(context.get(), points, points);
  page.draw(context.get(), pixels.get());
  const cairo_status_t drawn = cairo_status(context.get());
  cairo_surface_finish(surface.get());
  stream.close();
  for (const cairo_status_t status : {drawn, cairo_surface_status(surface.get())}) {
    if (status != CAIRO_STATUS_SUCCESS) {
      throw Error(fmt::format("{}: cannot be written: {} (is the disk full?)", path, cairo_status_to_string(status)));
    }
  }
  if (!stream) throw Error(fmt::format("{}: cannot be written: the last bytes are missing (is the disk full?)", path));
  file.commit();
}

}  // namespace scarp
