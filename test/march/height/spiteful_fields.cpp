// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "march/height/spiteful.h"

namespace scarp::test {
namespace {

template <class T>
using Samples = std::vector<T>;

struct Size {
  int cols, rows;
};

template <class T, class Height>
HeightField make(Size size, const HeightFieldSettings& settings, Height&& height) {
  Samples<T> samples;
  samples.reserve(static_cast<std::size_t>(size.cols) * size.rows);
  for (int row = 0; row < size.rows; ++row) {
    for (int col = 0; col < size.cols; ++col) samples.push_back(static_cast<T>(height(col, row)));
  }
  return HeightField::own(std::move(samples), size.cols, size.rows, settings);
}

HeightFieldSettings with(Surface surface, Wrap wrap = Wrap::none, bool solid = false) {
  HeightFieldSettings settings;
  settings.surface = surface;
  settings.wrap = wrap;
  settings.solid = solid;
  return settings;
}

template <std::size_t N>
Size one_of(const Size (&sizes)[N], Random& random) {
  return sizes[whole(random, 0, N - 1)];
}

HeightField rough(Size size, Random& random, const HeightFieldSettings& settings = {}, double relief = 6) {
  return make<float>(size, settings, [&](int, int) { return uniform(random, 0, relief); });
}

HeightField with_holes(Size size, Random& random, const HeightFieldSettings& settings) {
  return make<float>(size, settings, [&](int, int) {
    return uniform(random, 0, 1) < 0.15 ? std::numeric_limits<double>::quiet_NaN() : uniform(random, 0, 5);
  });
}

HeightField pits(Size size, const HeightFieldSettings& settings) {
  return make<float>(size, settings, [](int c, int q) { return (c + q) % 2 ? 4.0 : 0.0; });
}

}  // namespace

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
int whole(Random& random, int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }

const std::vector<FieldKind>& spiteful_fields() {
  static const std::vector<FieldKind> kinds = {
      {"flat",
       [](Random& r) {
         const double h = whole(r, -3, 3);
         return make<float>({9, 8}, {}, [h](int, int) { return h; });
       }},
      {"tilted plane",
       [](Random& r) {
         const double a = uniform(r, -2, 2), b = uniform(r, -2, 2);
         return make<float>({12, 10}, {}, [=](int c, int q) { return a * c + b * q; });
       }},
      {"rough, power of two plus one",
       [](Random& r) {
         return rough({17, 17}, r);
       }},
      {"rough, power of two",
       [](Random& r) {
         return rough({16, 32}, r);
       }},
      {"rough, prime sizes",
       [](Random& r) {
         return rough({13, 23}, r);
       }},
      {"rough, long strip",
       [](Random& r) {
         return rough({61, 3}, r);
       }},
      {"rough, oblong cells",
       [](Random& r) {
         HeightFieldSettings settings;
         settings.cell_x = 6.72, settings.cell_y = 0.61, settings.exaggeration = 2.5;
         return rough({11, 14}, r, settings);
       }},
      {"cliff",
       [](Random& r) {
         const int at = whole(r, 1, 9);
         return make<float>({11, 11}, {}, [=](int c, int) { return c < at ? 0.0 : 1000.0; });
       }},
      {"spike",
       [](Random& r) {
         const int c0 = whole(r, 0, 12), r0 = whole(r, 0, 10);
         return make<float>({13, 11}, {}, [=](int c, int q) { return c == c0 && q == r0 ? 500.0 : 0.0; });
       }},
      {"pits and saddles",
       [](Random&) {
         return pits({10, 10}, {});
       }},
      {"holes",
       [](Random& r) {
         return with_holes({15, 13}, r, {});
       },
       kHoles},
      {"int16 with nodata and scale",
       [](Random& r) {
         HeightFieldSettings settings;
         settings.cell_x = settings.cell_y = 30, settings.scale = 0.1, settings.offset = 100, settings.nodata = -32768;
         return make<std::int16_t>({14, 12}, settings,
                                   [&](int, int) { return uniform(r, 0, 1) < 0.1 ? -32768 : whole(r, -400, 400); });
       },
       kHoles},
      {"uint16 over its range",
       [](Random& r) {
         return make<std::uint16_t>({9, 9}, {.cell_x = 900, .cell_y = 1100},
                                    [&](int, int) { return whole(r, 0, 65535); });
       }},
      {"high above the datum",
       [](Random& r) {
         return make<float>({12, 12}, {.cell_x = 0.5, .cell_y = 0.5, .offset = 1e6},
                            [&](int, int) { return uniform(r, 0, 3); });
       }},
      {"one cell",
       [](Random& r) {
         return rough({2, 2}, r, {}, 2);
       }},
      {"one sample",
       [](Random& r) {
         return rough({1, 1}, r);
       }},
      {"one row",
       [](Random& r) {
         return rough({9, 1}, r);
       }},
      {"triangles",
       [](Random& r) {
         return rough(one_of({{13, 23}, {16, 16}, {17, 9}, {2, 2}}, r), r, with(Surface::triangles));
       },
       kTriangles},
      {"triangles, oblong cells",
       [](Random& r) {
         HeightFieldSettings settings = with(Surface::triangles);
         settings.cell_x = 0.37, settings.cell_y = 5.2, settings.exaggeration = 2.5, settings.offset = -40;
         return rough({11, 14}, r, settings);
       },
       kTriangles},
      {"triangles, pits and ridges",
       [](Random&) {
         return pits({10, 10}, with(Surface::triangles));
       },
       kTriangles},
      {"triangles with holes",
       [](Random& r) {
         return with_holes({13, 12}, r, with(Surface::triangles));
       },
       kTriangles | kHoles},
      {"periodic",
       [](Random& r) {
         return rough(one_of({{13, 7}, {5, 11}, {8, 8}, {3, 3}}, r), r, with(Surface::bilinear, Wrap::periodic));
       },
       kWraps},
      {"periodic, tiny",
       [](Random& r) {
         return rough(one_of({{1, 1}, {1, 2}, {2, 2}, {1, 7}, {5, 1}}, r), r, with(Surface::bilinear, Wrap::periodic));
       },
       kWraps},
      {"periodic with holes, oblong cells",
       [](Random& r) {
         HeightFieldSettings settings = with(Surface::bilinear, Wrap::periodic);
         settings.cell_x = 3.1, settings.cell_y = 0.7;
         return with_holes({9, 7}, r, settings);
       },
       kWraps | kHoles},
      {"shared border",
       [](Random& r) {
         const Size size = one_of({{12, 9}, {6, 4}, {2, 5}, {9, 9}}, r);
         Samples<float> samples;
         for (int i = 0; i < size.cols * size.rows; ++i) samples.push_back(static_cast<float>(uniform(r, 0, 6)));
         const auto at = [&](int col, int row) -> float& {
           return samples[static_cast<std::size_t>(row * size.cols + col)];
         };
         for (int row = 0; row < size.rows; ++row) at(size.cols - 1, row) = at(0, row);
         for (int col = 0; col < size.cols; ++col) at(col, size.rows - 1) = at(col, 0);
         return HeightField::own(std::move(samples), size.cols, size.rows,
                                 with(Surface::bilinear, Wrap::shared_border));
       },
       kWraps},
      {"periodic triangles",
       [](Random& r) {
         return rough(one_of({{7, 6}, {5, 5}, {1, 3}, {4, 8}}, r), r, with(Surface::triangles, Wrap::periodic));
       },
       kWraps | kTriangles},
      {"int16 periodic with nodata",
       [](Random& r) {
         HeightFieldSettings settings = with(Surface::bilinear, Wrap::periodic);
         settings.cell_x = settings.cell_y = 30, settings.scale = 0.1, settings.nodata = -9999;
         return make<std::int16_t>({7, 10}, settings,
                                   [&](int, int) { return uniform(r, 0, 1) < 0.05 ? -9999 : whole(r, -400, 400); });
       },
       kWraps | kHoles},
      {"solid with holes",
       [](Random& r) {
         return with_holes({14, 11}, r, with(Surface::bilinear, Wrap::none, true));
       },
       kHoles},
      {"solid triangles with holes",
       [](Random& r) {
         return with_holes({10, 13}, r, with(Surface::triangles, Wrap::none, true));
       },
       kTriangles | kHoles},
      {"solid periodic with holes",
       [](Random& r) {
         return with_holes({6, 9}, r, with(Surface::bilinear, Wrap::periodic, true));
       },
       kWraps | kHoles},
      {"solid cliff",
       [](Random& r) {
         const int at = whole(r, 1, 9);
         return make<float>({11, 11}, with(Surface::bilinear, Wrap::none, true),
                            [=](int c, int) { return c < at ? 0.0 : 1000.0; });
       }},
  };
  return kinds;
}

const std::vector<FieldKind>& wide_fields() {
  static const std::vector<FieldKind> kinds = {
      {"wide, rough",
       [](Random& r) {
         return rough({2600, 6}, r);
       }},
      {"tall, rough, high samples",
       [](Random& r) {
         return make<float>({5, 2060}, {}, [&](int, int) { return 1e4 + uniform(r, 0, 4); });
       }},
      {"wide with holes, solid",
       [](Random& r) {
         return with_holes({1100, 9}, r, with(Surface::bilinear, Wrap::none, true));
       },
       kHoles},
      {"wide triangles",
       [](Random& r) {
         return rough({2049, 5}, r, with(Surface::triangles));
       },
       kTriangles},
      {"wide, periodic",
       [](Random& r) {
         return rough({1030, 4}, r, with(Surface::bilinear, Wrap::periodic));
       },
       kWraps},
  };
  return kinds;
}

HeightField rugged(Random& random, int most_side, double most, double hole_share, HeightFieldSettings settings) {
  const int cols = whole(random, 2, most_side), rows = whole(random, 2, most_side);
  std::vector<float> samples;
  for (int i = 0; i < cols * rows; ++i)
    samples.push_back(uniform(random, 0, 1) < hole_share ? std::numeric_limits<float>::quiet_NaN()
                                                         : static_cast<float>(uniform(random, -most, most)));
  settings.cell_x = uniform(random, 0.3, 2);
  settings.cell_y = uniform(random, 0.3, 2);
  return HeightField::own(std::move(samples), cols, rows, settings);
}

HeightField hills(int cols, int rows, Surface surface) {
  std::vector<float> samples;
  samples.reserve(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const double x = col, y = row;
      samples.push_back(static_cast<float>(30 * std::sin(0.021 * x + 0.3) * std::cos(0.017 * y) +
                                           6 * std::sin(0.11 * x + 0.07 * y) + std::sin(0.9 * x) * std::cos(0.8 * y)));
    }
  }
  return HeightField::own(std::move(samples), cols, rows, {.surface = surface});
}

}  // namespace scarp::test
