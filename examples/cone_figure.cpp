// SPDX-License-Identifier: MIT
// Draws a figure that shows why the height above a terrain function is not a distance, and which ball is guaranteed to
// be free of ground: an SVG on standard output. The library computes ground, slope and hits; only the page layout is
// defined here.
//
//   cone_figure > from-height-to-distance.svg
#include <cmath>
#include <cstdio>

#include "scarp/field/height_function.h"
#include "scarp/march/function/lipschitz_local.h"

namespace {

constexpr double kWidth = 230, kLow = -42, kHigh = 84;  // metres shown on the page
constexpr double kPixels = 4;                           // per metre

double page_x(double x) { return kPixels * x; }
double page_y(double z) { return kPixels * (kHigh - z); }

void line(double x0, double z0, double x1, double z1, const char* style) {
  std::printf("<path d=\"M%.1f %.1fL%.1f %.1f\" %s/>\n", page_x(x0), page_y(z0), page_x(x1), page_y(z1), style);
}
void circle(double x, double z, double radius, const char* style) {
  std::printf("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" %s/>\n", page_x(x), page_y(z), kPixels * radius, style);
}
void text(double x, double z, const char* colour, const char* words) {
  std::printf("<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\">%s</text>\n", page_x(x), page_y(z), colour, words);
}

}  // namespace

int main() {
  using namespace scarp;
  // A profile along x, and the point P above it.
  const HeightFunction ground(make_function(Sines{{{25, 170, 0, 2.5}, {13, 83, 0, 2.9}, {3, 31, 0, 0}}}));
  const dvec3 p(110, 0, 27);
  const double h = p.z - ground.value(p.x, p.y);
  // The bound of the slope on the page, and the ball that follows from it.
  const double c = ground.bound({0, kWidth, 0, 0}).slope, shrink = 1 / std::sqrt(1 + c * c);
  const Hit level = march_lipschitz_local(ground, {p, {1, 0, 0}});
  if (!level) return 1;

  std::printf(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" font-family=\"DejaVu Sans, sans-serif\" "
      "font-size=\"17\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n",
      kPixels * kWidth, kPixels * (kHigh - kLow));
  std::printf("<path fill=\"#d9cfbd\" stroke=\"#6b5b45\" stroke-width=\"2\" d=\"M%.1f %.1f", page_x(-1),
              page_y(kLow - 1));
  for (int x = -1; x <= static_cast<int>(kWidth) + 1; ++x) {
    std::printf("L%.1f %.1f", page_x(x), page_y(ground.value(x, 0)));
  }
  std::printf("L%.1f %.1fZ\"/>\n", page_x(kWidth + 1), page_y(kLow - 1));

  // The cone of the steepest slope under P, and its point that is nearest to P.
  const double o = p.z - h, up = (kHigh - o) / c;
  line(p.x, o, p.x + up, kHigh, "stroke=\"#2a6f97\" stroke-width=\"2\" stroke-dasharray=\"7 5\"");
  line(p.x, o, p.x - up, kHigh, "stroke=\"#2a6f97\" stroke-width=\"2\" stroke-dasharray=\"7 5\"");
  const double along = h * c / (1 + c * c);  // |ON| / sqrt(1 + c^2)
  line(p.x, p.z, p.x - along, o + c * along, "stroke=\"#2f8f4e\" stroke-width=\"2\"");
  circle(p.x, p.z, h * shrink, "fill=\"#2f8f4e\" fill-opacity=\"0.15\" stroke=\"#2f8f4e\" stroke-width=\"2\"");
  circle(p.x, p.z, h, "fill=\"none\" stroke=\"#b3392f\" stroke-width=\"1.5\" stroke-dasharray=\"3 5\"");

  // Straight down, and along the ray.
  line(p.x, p.z, p.x, o, "stroke=\"#222222\" stroke-width=\"2\"");
  line(p.x, p.z, p.x + h, p.z, "stroke=\"#b3392f\" stroke-width=\"2.5\"");
  circle(p.x + level.t, p.z, 1.2, "fill=\"#222222\"");
  circle(p.x + h, p.z, 1.2, "fill=\"#b3392f\"");
  circle(p.x, p.z, 1.2, "fill=\"#222222\"");
  circle(p.x, o, 1.2, "fill=\"#222222\"");

  text(p.x - 2, p.z + 2.5, "#222222", "P");
  text(p.x - 5.5, o - 4.5, "#222222", "O");
  text(p.x + 1.5, p.z - 0.62 * h, "#222222", "h");
  text(p.x - along - 6, o + c * along - 1, "#2f8f4e", "N");
  text(p.x + level.t + 1, p.z - 7, "#222222", "ground");
  text(p.x + h - 8, p.z + 14, "#b3392f", "a step of h ends here");
  line(p.x + h, p.z, p.x + h, p.z + 12, "stroke=\"#b3392f\" stroke-width=\"1\"");
  char words[96];
  std::snprintf(words, sizeof words, "slope c = %.2f, proven", c);
  text(p.x + up + 2, kHigh - 6, "#2a6f97", words);
  std::snprintf(words, sizeof words, "free ball: h / &#8730;(1 + c&#178;) = %.2f h", shrink);
  text(24, p.z + 0.6 * h, "#2f8f4e", words);
  std::printf("</svg>\n");
}
