// SPDX-License-Identifier: MIT
#include "scarp/output/figure.h"

#include <algorithm>
#include <cmath>

#include "scarp/output/figure_page.h"

namespace scarp {
namespace {

constexpr double kTextShare = 1.0 / 40, kLeastText = 10;  // fraction of the shorter side; pixels
constexpr double kLabelShare = 0.65;                      // fraction of the text height

}  // namespace

std::vector<double> round_numbers(double low, double high, int most, double least_step) {
  const double range = high - low;
  double power = std::pow(10.0, std::floor(std::log10(range)) - 1);
  for (;; power *= 10) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double step = digit * power, first = std::ceil(low / step), last = std::floor(high / step);
      if (step < least_step || last - first + 1 > most) continue;
      std::vector<double> numbers;
      for (double k = first; k <= last; ++k) numbers.push_back(k * step + 0.0);  // not -0
      return numbers;
    }
  }
}

double figure_text_height(int width, int height) { return std::max(kLeastText, kTextShare * std::min(width, height)); }

double figure_label_height(int width, int height) {
  return std::max(kLeastText, kLabelShare * figure_text_height(width, height));
}

bool is_figure_text(const std::string& text) {
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1));
  const CairoContext context(cairo_create(surface.get()));
  cairo_text_extents_t extents;
  cairo_text_extents(context.get(), text.c_str(), &extents);
  return cairo_status(context.get()) != CAIRO_STATUS_INVALID_STRING;
}

void require_room(const Figure& figure, int width, int height) { FigurePage(figure, width, height); }

FigureImage draw_figure(const RgbView& picture, const Figure& figure) {
  const FigurePage page(figure, picture.width, picture.height);
  const CairoSurface pixels = image_surface(picture);
  const CairoSurface drawn(cairo_image_surface_create(CAIRO_FORMAT_RGB24, page.width(), page.height()));
  const CairoContext context(cairo_create(drawn.get()));
  require_good(drawn.get(), context.get());
  page.draw(context.get(), pixels.get());
  require_good(drawn.get(), context.get());
  cairo_surface_flush(drawn.get());
  FigureImage image{page.width(), page.height(), {}};
  image.rgb.reserve(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const auto* bytes = cairo_image_surface_get_data(drawn.get());
  const std::ptrdiff_t stride = cairo_image_surface_get_stride(drawn.get());
  for (int y = 0; y < image.height; ++y) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(bytes + y * stride);
    for (int x = 0; x < image.width; ++x) {
      for (const int shift : {16, 8, 0}) image.rgb.push_back(static_cast<std::uint8_t>(row[x] >> shift));
    }
  }
  return image;
}

}  // namespace scarp
