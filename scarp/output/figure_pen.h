// SPDX-License-Identifier: MIT
// Draws text and shapes of figures. Units are pixels of the picture.
#pragma once

#include <cairo.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "scarp/output/figure.h"
#include "scarp/output/rgb_view.h"

namespace scarp {

struct CairoDeleter {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using CairoSurface = std::unique_ptr<cairo_surface_t, CairoDeleter>;
using CairoContext = std::unique_ptr<cairo_t, CairoDeleter>;

/// Throws Error "figure: ..." if the surface or the context has failed.
void require_good(cairo_surface_t* surface, cairo_t* context);

/// A callback for Cairo that writes to a std::ofstream.
cairo_status_t write_bytes(void* stream, const unsigned char* bytes, unsigned int count);

/// Returns an image surface with these pixels, in Cairo's byte order.
CairoSurface image_surface(const RgbView& picture);

struct FigureRect {
  double x = 0, y = 0, width = 0, height = 0;

  bool touches(const FigureRect& other) const {
    return x < other.x + other.width && other.x < x + width && y < other.y + other.height && other.y < y + height;
  }
};

/// Draws on a context that it does not own.
class FigurePen {
 public:
  /// `text`: text height.
  FigurePen(cairo_t* context, double text);

  cairo_t* cr() const { return cr_; }
  double text() const { return text_; }
  double pad() const { return 0.8 * text_; }   ///< around panels, and inside them
  double gap() const { return 0.45 * text_; }  ///< between parts of a panel
  double bar() const { return 0.9 * text_; }   ///< thickness of bars
  double line_height() const { return font_.height; }
  double ascent() const { return font_.ascent; }
  double width_of(const std::string& text) const;

  void write(double x, double baseline, const std::string& text) const;
  /// Writes text with a white halo, for pictures; `centre` is the text's centre, `angle` its rotation as in
  /// FigureLabel.
  void write_on_picture(const FigurePoint& centre, double angle, const std::string& text) const;
  /// Draws a background for text.
  void paper(const FigureRect& rect) const;
  void fill(const FigureRect& rect, const std::array<std::uint8_t, 3>& colour) const;
  void frame(const FigureRect& rect, double line_width) const;

 private:
  cairo_t* cr_;
  double text_;
  cairo_font_extents_t font_{};
};

}  // namespace scarp
