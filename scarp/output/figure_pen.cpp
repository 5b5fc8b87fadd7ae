// SPDX-License-Identifier: MIT
#include "scarp/output/figure_pen.h"

#include <fmt/format.h>

#include <fstream>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr double kPaper = 0.82;                  // opacity of the background behind text
constexpr double kHalo = 0.8, kHaloWidth = 0.3;  // opacity, and width in text heights

}  // namespace

cairo_status_t write_bytes(void* stream, const unsigned char* bytes, unsigned int count) {
  auto& out = *static_cast<std::ofstream*>(stream);
  out.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(count));
  return out ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

void require_good(cairo_surface_t* surface, cairo_t* context) {
  for (const cairo_status_t status : {cairo_surface_status(surface), cairo_status(context)}) {
    if (status != CAIRO_STATUS_SUCCESS) throw Error(fmt::format("figure: {}", cairo_status_to_string(status)));
  }
}

CairoSurface image_surface(const RgbView& picture) {
  CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height));
  if (const cairo_status_t status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS)
    throw Error(fmt::format("figure: {}", cairo_status_to_string(status)));
  auto* pixels = cairo_image_surface_get_data(surface.get());
  const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface.get());
  const std::uint8_t* from = picture.data;
  for (int y = 0; y < picture.height; ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(pixels + y * stride);
    for (int x = 0; x < picture.width; ++x, from += 3) {
      row[x] = static_cast<std::uint32_t>(from[0]) << 16 | static_cast<std::uint32_t>(from[1]) << 8 | from[2];
    }
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

FigurePen::FigurePen(cairo_t* context, double text) : cr_(context), text_(text) {
  cairo_select_font_face(cr_, "sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr_, text_);
  cairo_font_extents(cr_, &font_);
}

double FigurePen::width_of(const std::string& text) const {
  cairo_text_extents_t extents;
  cairo_text_extents(cr_, text.c_str(), &extents);
  return extents.x_advance;
}

void FigurePen::write(double x, double baseline, const std::string& text) const {
  cairo_set_source_rgb(cr_, 0, 0, 0);
  cairo_move_to(cr_, x, baseline);
  cairo_show_text(cr_, text.c_str());
}

void FigurePen::write_on_picture(const FigurePoint& centre, double angle, const std::string& text) const {
  cairo_save(cr_);
  cairo_translate(cr_, centre.x, centre.y);
  cairo_rotate(cr_, angle);
  const double x = -width_of(text) / 2, baseline = (font_.ascent - font_.descent) / 2;
  cairo_move_to(cr_, x, baseline);
  cairo_text_path(cr_, text.c_str());
  cairo_set_source_rgba(cr_, 1, 1, 1, kHalo);
  cairo_set_line_width(cr_, kHaloWidth * text_);
  cairo_set_line_join(cr_, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(cr_);
  write(x, baseline, text);
  cairo_restore(cr_);
}

void FigurePen::paper(const FigureRect& rect) const {
  cairo_set_source_rgba(cr_, 1, 1, 1, kPaper);
  cairo_rectangle(cr_, rect.x, rect.y, rect.width, rect.height);
  cairo_fill(cr_);
}

void FigurePen::fill(const FigureRect& rect, const std::array<std::uint8_t, 3>& colour) const {
  cairo_set_source_rgb(cr_, colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
  cairo_rectangle(cr_, rect.x, rect.y, rect.width, rect.height);
  cairo_fill(cr_);
}

void FigurePen::frame(const FigureRect& rect, double line_width) const {
  cairo_set_source_rgb(cr_, 0, 0, 0);
  cairo_set_line_width(cr_, line_width);
  cairo_rectangle(cr_, rect.x, rect.y, rect.width, rect.height);
  cairo_stroke(cr_);
}

}  // namespace scarp
