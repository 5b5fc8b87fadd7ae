// SPDX-License-Identifier: MIT
#include "scarp/march/exhaustive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Span {
  double begin = -kInfinity, end = kInfinity;
  bool empty() const { return !(begin <= end); }
};

Span common(Span a, Span b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

// When o + d t lies in [low, low + size]. Neighbouring strips compute their common border alike, so their spans meet
// exactly. A ray that does not move along the axis belongs to [low, low + size), the last strip of all being closed.
Span strip(double o, double d, double low, double size, bool last) {
  if (d == 0) return o >= low && (o < low + size || (last && o == low + size)) ? Span{} : Span{1, 0};
  const double a = (low - o) / d, b = (low + size - o) / d;
  return {std::min(a, b), std::max(a, b)};
}

// The part of the ray over one cell, and ray height - surface height there: f = a s^2 + b s + c, s = t - span.begin.
struct Piece {
  Span span;
  Cell cell;
  double a, b, c, last;  // last: f at the span's end

  double length() const { return span.end - span.begin; }
  // The two places where f = 0, the lower first; nothing when there are none.
  std::optional<Span> roots() const {
    if (a == 0) {
      if (b == 0) return {};
      return b < 0 ? Span{-c / b, kInfinity} : Span{-kInfinity, -c / b};
    }
    const double d = b * b - 4 * a * c;
    if (d < 0) return {};
    const double q = -0.5 * (b + std::copysign(std::sqrt(d), b));
    if (q == 0) return Span{0, 0};
    return Span{std::min(q / a, c / q), std::max(q / a, c / q)};
  }
  // Where a parabola has its lowest or highest point, if inside the piece.
  std::optional<double> vertex() const {
    if (a == 0) return {};
    const double s = -b / (2 * a);
    if (!(s > 0 && s < length())) return {};
    return s;
  }
};

class Ground {
 public:
  Ground(const HeightField& field, const Ray& ray) : field_(field), ray_(ray) {
    const HeightFieldSettings& to = field.settings();
    ox_ = ray.origin.x / to.cell_x;
    oy_ = field.rows() - 1 - ray.origin.y / to.cell_y;
    oz_ = (ray.origin.z / to.exaggeration - to.offset) / to.scale;
    dx_ = ray.direction.x / to.cell_x;
    dy_ = -ray.direction.y / to.cell_y;
    dz_ = ray.direction.z / (to.exaggeration * to.scale);
  }

  void move_height(double by) { oz_ += by; }

  std::optional<Piece> piece(Cell cell, Span span) const {
    const auto h = field_.cell_heights(cell);
    if (!h) return {};
    Piece p{span, cell, 0, 0, 0, 0};
    const double u = inside(ox_ + dx_ * span.begin - cell.col), v = inside(oy_ + dy_ * span.begin - cell.row);
    const double gu = (h->h10 - h->h00) * (1 - v) + (h->h11 - h->h01) * v;
    const double gv = (h->h01 - h->h00) * (1 - u) + (h->h11 - h->h10) * u;
    p.a = -(h->h00 - h->h10 - h->h01 + h->h11) * dx_ * dy_;
    p.b = dz_ - gu * dx_ - gv * dy_;
    p.c = oz_ + dz_ * span.begin - surface(*h, u, v);
    // An upright ray may have no end: then the sign of its movement tells on which side it ends.
    p.last = std::isinf(span.end)
                 ? std::copysign(kInfinity, dz_)
                 : oz_ + dz_ * span.end -
                       surface(*h, inside(ox_ + dx_ * span.end - cell.col), inside(oy_ + dy_ * span.end - cell.row));
    return p;
  }

  // What rounding can add to f around t: 16 units in the last place of all that goes into it.
  double rounding(double t) const {
    const double heights =
        std::max(std::abs(field_.min_sample()), std::abs(field_.max_sample())) + std::abs(oz_) + std::abs(dz_ * t);
    const double places = std::abs(ox_) + std::abs(oy_) + std::abs(dx_ * t) + std::abs(dy_ * t);
    return 16 * 0x1p-53 * (heights + places * (field_.max_sample() - field_.min_sample()));
  }

  // All pieces of the ray, in the order of t.
  std::vector<Piece> pieces(Span range) const {
    std::vector<Piece> found;
    const int cols = field_.cell_cols(), rows = field_.cell_rows();
    for (int row = 0; row < rows; ++row) {
      const Span over_row = common(range, strip(oy_, dy_, row, 1, row == rows - 1));
      if (over_row.empty()) continue;
      // Columns that the ray can touch in this row, one more on either side for rounding.
      const auto column = [&](double t) { return std::clamp(dx_ == 0 ? ox_ : ox_ + dx_ * t, 0.0, cols - 1.0); };
      const double a = column(over_row.begin), b = column(over_row.end);
      const int first = std::max(0, static_cast<int>(std::min(a, b)) - 1);
      const int last = std::min(cols - 1, static_cast<int>(std::max(a, b)) + 1);
      for (int col = first; col <= last; ++col) {
        const Span over_cell = common(over_row, strip(ox_, dx_, col, 1, col == cols - 1));
        if (over_cell.empty()) continue;
        if (auto p = piece({col, row}, over_cell)) found.push_back(*p);
      }
    }
    std::sort(found.begin(), found.end(), [](const Piece& p, const Piece& q) {
      return p.span.begin != q.span.begin ? p.span.begin < q.span.begin : p.span.end < q.span.end;
    });
    return found;
  }

  // Where the ray comes over the field.
  double entry(double t_min) const {
    return std::max({t_min, strip(ox_, dx_, 0, field_.cell_cols(), true).begin,
                     strip(oy_, dy_, 0, field_.cell_rows(), true).begin});
  }

  Hit hit(const Piece& piece, double s) const {
    Hit hit;
    hit.status = HitStatus::hit;
    hit.t = piece.span.begin + std::clamp(s, 0.0, piece.length());
    hit.cell = piece.cell;
    hit.u = inside(ox_ + dx_ * hit.t - piece.cell.col);
    hit.v = inside(oy_ + dy_ * hit.t - piece.cell.row);
    hit.height = field_.height_from_sample(oz_ + dz_ * hit.t);
    return hit;
  }

 private:
  static double inside(double x) { return std::clamp(x, 0.0, 1.0); }
  static double surface(const CellHeights& h, double u, double v) {
    return (h.h00 * (1 - u) + h.h10 * u) * (1 - v) + (h.h01 * (1 - u) + h.h11 * u) * v;
  }

  const HeightField& field_;
  const Ray& ray_;
  double ox_, oy_, oz_, dx_, dy_, dz_;  // the ray in cells and sample units
};

// First s in the piece at which a ray that comes from above is on or below the surface. A ray that began on the surface
// has to be below by more than `depth`, what rounding can pretend; a touch is no hit for it.
std::optional<double> descent(const Piece& p, std::optional<double> depth) {
  const auto below = [&](double f) { return depth ? f < -*depth : f <= 0; };
  if (!depth && p.c <= 0) return 0;
  const bool ends_below = below(p.last);
  const auto vertex = p.vertex();
  const double lowest = vertex ? (p.a * *vertex + p.b) * *vertex + p.c : kInfinity;
  if (!ends_below && !(p.a > 0 && below(lowest))) return {};
  const auto roots = p.roots();
  if (!roots) return ends_below ? p.length() : *vertex;
  // f falls through zero at the lower root of a cup and at the upper root of a cap.
  return p.a < 0 ? roots->end : roots->begin;
}

// The same for a ray that is below at the piece's begin: it has to rise first.
std::optional<double> descent_after_rise(const Piece& p) {
  const auto vertex = p.vertex();
  if (p.last > 0 || !vertex || p.a > 0 || (p.a * *vertex + p.b) * *vertex + p.c <= 0) return {};
  return p.roots() ? p.roots()->end : p.length();
}

}  // namespace

Hit march_exhaustive(const HeightTarget& target, const Ray& ray, const MarchSettings&, MarchStats* stats) {
  const HeightField& field = *target.field;
  if (stats) *stats = {};
  Hit answer;
  if (!field.has_cells()) return answer;
  Ground ground(field, ray);
  const bool on_surface = ray.start == RayStart::on_surface;
  enum class Side { unknown, above, below } side = Side::unknown;
  if (on_surface) {
    const auto start = ground.piece(ray.start_cell, {ray.t_min, ray.t_min});
    if (!start) return answer;
    ground.move_height(-start->c);
    side = Side::above;
  }
  const auto pieces = ground.pieces({ray.t_min, ray.t_max});
  if (stats) stats->steps = stats->cell_tests = static_cast<std::uint32_t>(pieces.size());
  double reached = on_surface ? ray.t_min : -kInfinity;
  for (const Piece& p : pieces) {
    if (on_surface && p.cell == ray.start_cell && p.span.begin <= ray.t_min) {
      // f = s (a s + b): the root at the start is no hit.
      reached = p.span.end;
      if (p.length() == 0) continue;
      const double lowest =
          p.a > 0 && p.vertex() ? (p.a * *p.vertex() + p.b) * *p.vertex() : (p.a * p.length() + p.b) * p.length();
      if (!(lowest < -ground.rounding(ray.t_min))) continue;
      return ground.hit(p, p.b < 0 || p.a == 0 ? 0 : -p.b / p.a);
    }
    if (p.span.begin > reached) side = Side::unknown;  // a hole lies in between, or nothing at all yet
    reached = std::max(reached, p.span.end);
    if (side == Side::unknown) {
      if (p.c < 0 && &p == &pieces.front() && p.span.begin <= ground.entry(ray.t_min)) answer.status = HitStatus::below;
      side = p.c < 0 ? Side::below : Side::above;
    }
    if (side == Side::below && p.c > 0) side = Side::above;
    const auto depth = on_surface ? std::optional(ground.rounding(p.span.begin)) : std::nullopt;
    const auto s = side == Side::above ? descent(p, depth) : descent_after_rise(p);
    if (s) return ground.hit(p, *s);
    if (side == Side::below && p.last > 0) side = Side::above;
  }
  return answer;
}

}  // namespace scarp
