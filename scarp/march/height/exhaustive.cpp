// SPDX-License-Identifier: MIT
#include "scarp/march/height/exhaustive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Span {
  double begin = -kInfinity, end = kInfinity;
  bool empty() const { return !(begin <= end); }
};

Span common(Span a, Span b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

// When o + d t is in [low, low + size]. Adjacent strips compute their common border in the same way, so their spans
// meet exactly, and a ray along it belongs to both.
Span strip(double o, double d, double low, double size) {
  if (d == 0) return o >= low && o <= low + size ? Span{} : Span{kInfinity, -kInfinity};
  const double a = (low - o) / d, b = (low + size - o) / d;
  return {std::min(a, b), std::max(a, b)};
}

// The part of the ray over one cell or triangle, and ray height - surface height there: f = a s^2 + b s + c, s = t -
// span.begin.
struct Piece {
  Span span;
  Cell cell;
  double col, row;       // of the cell; in a wrapped field, of the copy below the ray
  double a, b, c, last;  // last: f at the span's end
  bool rim = false;      // beside the cell, over its edge

  double length() const { return span.end - span.begin; }
  // A part of a piece whose clearance is linear.
  Piece part(Span of) const {
    Piece p = *this;
    p.span = of;
    p.c = c + b * (of.begin - span.begin);
    if (of.end < span.end) p.last = c + b * (of.end - span.begin);
    return p;
  }
  // The two roots of f, the lower first; nullopt if there are none.
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
  // The vertex of the parabola, if inside the piece.
  std::optional<double> vertex() const {
    if (a == 0) return {};
    const double s = -b / (2 * a);
    if (!(s > 0 && s < length())) return {};
    return s;
  }
};

class Ground {
 public:
  Ground(const HeightTarget& target, const Ray& ray, Sides side)
      : field_(*target.field), up_(side == Sides::below ? -1 : 1), seam_(target.seam), seam_step_(target.seam_step) {
    const HeightField& field = field_;
    const HeightFieldSettings& to = field.settings();
    ox_ = ray.origin.x / to.cell_x;
    oy_ = field.rows() - 1 - ray.origin.y / to.cell_y;
    oz_ = up_ * (ray.origin.z / to.exaggeration - to.offset) / to.scale;
    // Times of lines are finite only along axes with movement.
    const auto movement = [](double d) { return std::isinf(1 / d) ? 0.0 : d; };
    dx_ = movement(ray.direction.x / to.cell_x);
    dy_ = movement(-ray.direction.y / to.cell_y);
    dz_ = up_ * ray.direction.z / (to.exaggeration * to.scale);
    // 8 roundings of a position and of a line's time, for each of two fields that meet.
    off_x_ = target.seam + 16 * 0x1p-53 * (std::abs(ox_) + field.cell_cols());
    off_y_ = target.seam + 16 * 0x1p-53 * (std::abs(oy_) + field.cell_rows());
  }

  void move_height(double by) { oz_ += by; }

  // Adds the pieces over the cell at (col, row), which in a wrapped field may be in any copy: one, one per triangle, or
  // none over a hole.
  void add_pieces(double col, double row, Span span, std::vector<Piece>& to) const {
    const Cell cell{within(col, field_.cell_cols()), within(row, field_.cell_rows())};
    const auto h = heights(cell);
    if (!h) return;
    if (field_.settings().surface == Surface::bilinear) {
      to.push_back(bilinear_piece(*h, cell, col, row, span));
      return;
    }
    // Where x + y equals that of the diagonal, the ray passes from one triangle to the other.
    const double across = dx_ + dy_, parting = (col + row + 1 - ox_ - oy_) / across;
    if (across != 0 && parting > span.begin && parting < span.end) {
      to.push_back(triangle_piece(*h, cell, col, row, {span.begin, parting}));
      to.push_back(triangle_piece(*h, cell, col, row, {parting, span.end}));
    } else {
      to.push_back(triangle_piece(*h, cell, col, row, span));
    }
  }

  Piece bilinear_piece(const CellHeights& h, Cell cell, double col, double row, Span span) const {
    Piece p{span, cell, col, row, 0, 0, 0, 0};
    const double u = inside(ox_ + dx_ * span.begin - col), v = inside(oy_ + dy_ * span.begin - row);
    const double gu = (h.h10 - h.h00) * (1 - v) + (h.h11 - h.h01) * v;
    const double gv = (h.h01 - h.h00) * (1 - u) + (h.h11 - h.h10) * u;
    p.a = -(h.h00 - h.h10 - h.h01 + h.h11) * dx_ * dy_;
    p.b = dz_ - gu * dx_ - gv * dy_;
    p.c = oz_ + dz_ * span.begin - bilinear(h, u, v);
    // A vertical ray may be infinite: the sign of its movement then determines the side on which it ends.
    p.last = std::isinf(span.end)
                 ? std::copysign(kInfinity, dz_)
                 : oz_ + dz_ * span.end -
                       bilinear(h, inside(ox_ + dx_ * span.end - col), inside(oy_ + dy_ * span.end - row));
    return p;
  }

  Piece triangle_piece(const CellHeights& h, Cell cell, double col, double row, Span span) const {
    Piece p{span, cell, col, row, 0, 0, 0, 0};
    const double middle = std::isinf(span.end) ? span.begin : 0.5 * (span.begin + span.end);
    const bool upper = (ox_ + dx_ * middle - col) + (oy_ + dy_ * middle - row) <= 1;
    const double gu = upper ? h.h10 - h.h00 : h.h11 - h.h01, gv = upper ? h.h01 - h.h00 : h.h11 - h.h10;
    const auto clearance = [&](double t) {
      const double u = inside(ox_ + dx_ * t - col), v = inside(oy_ + dy_ * t - row);
      const double ground = upper ? h.h00 + (h.h10 - h.h00) * u + (h.h01 - h.h00) * v
                                  : h.h11 + (h.h01 - h.h11) * (1 - u) + (h.h10 - h.h11) * (1 - v);
      return oz_ + dz_ * t - ground;
    };
    p.b = dz_ - gu * dx_ - gv * dy_;
    p.c = clearance(span.begin);
    p.last = std::isinf(span.end) ? std::copysign(kInfinity, dz_) : clearance(span.end);
    return p;
  }

  // The clearance above a point of the cell; nullopt over a hole.
  std::optional<double> clearance_at(Cell cell, double t) const {
    const auto h = heights(cell);
    if (!h) return {};
    const auto copy = [&](double position, int c, int cells) {
      return field_.wraps() ? c + std::round((position - c - 0.5) / cells) * cells : c;
    };
    const double col = copy(ox_ + dx_ * t, cell.col, field_.cell_cols());
    const double row = copy(oy_ + dy_ * t, cell.row, field_.cell_rows());
    const Span here{t, t};
    return field_.settings().surface == Surface::bilinear ? bilinear_piece(*h, cell, col, row, here).c
                                                          : triangle_piece(*h, cell, col, row, here).c;
  }

  // Maximum rounding error of f around t: 16 units in the last place of all operands.
  double rounding(double t) const {
    const HeightFieldSettings& to = field_.settings();
    const double heights = std::max(std::abs(field_.min_sample()), std::abs(field_.max_sample())) + std::abs(oz_) +
                           std::abs(dz_ * t) + std::abs(to.offset) / to.scale;
    const double places = std::abs(ox_) + std::abs(oy_) + std::abs(dx_ * t) + std::abs(dy_ * t) + field_.rows();
    const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
    return std::min(most, 16 * 0x1p-53 * (heights + places * (field_.max_sample() - field_.min_sample())) + 8 * least);
  }

  // The same for the times of lines: a quotient for the origin, a difference and a quotient.
  double rounding_of_time(double t) const {
    const double speed = std::max(std::abs(dx_), std::abs(dy_));
    const double places = std::abs(ox_) + std::abs(oy_) + std::abs(dx_ * t) + std::abs(dy_ * t);
    return speed > 0 ? std::min(std::numeric_limits<double>::max(), 4 * 0x1p-53 * places / speed) : 0;
  }

  // How far below a rim a ray may reach it and still touch it: the rounding of its clearance, plus the change of the
  // edge's height between two positions that count as one.
  double rounding_at_rim(double t) const {
    return seam_step_ + rounding(t) + std::max(off_x_, off_y_) * (field_.max_sample() - field_.min_sample());
  }
  // Whether fields that are separated only by rounding meet here: rays this close touch both.
  bool meets() const { return seam_ > 0 || seam_step_ > 0; }

  // The pieces over the rims around a cell without ground: the ground continues level beside them, as far as rounding
  // may move the ray. The clearance has a kink where the ray passes the end of an edge.
  void add_rims(double col, double row, Span span, std::vector<Piece>& to) const {
    for (double y = row - 1; y <= row + 1; ++y) {
      for (double x = col - 1; x <= col + 1; ++x) {
        const Span near =
            common(strip(ox_, dx_, x - off_x_, 1 + 2 * off_x_), strip(oy_, dy_, y - off_y_, 1 + 2 * off_y_));
        const Span over = common(span, near);
        if (over.empty() || !is_ground(x, y)) continue;
        const Span over_col = strip(ox_, dx_, x, 1), over_row = strip(oy_, dy_, y, 1);
        double corners[] = {over_col.begin, over_col.end, over_row.begin, over_row.end};
        std::sort(std::begin(corners), std::end(corners));
        double begin = over.begin;
        for (const double t : corners) {
          if (t > begin && t < over.end) add_rim(x, y, {std::exchange(begin, t), t}, to);
        }
        add_rim(x, y, {begin, over.end}, to);
      }
    }
  }

  void add_rim(double col, double row, Span span, std::vector<Piece>& to) const {
    const Cell cell{within(col, field_.cell_cols()), within(row, field_.cell_rows())};
    const CellHeights h = *heights(cell);
    Piece p = field_.settings().surface == Surface::bilinear ? bilinear_piece(h, cell, col, row, span)
                                                             : triangle_piece(h, cell, col, row, span);
    p.rim = true;
    p.a = 0;
    p.b = std::isinf(p.last) || p.length() == 0 ? dz_ : (p.last - p.c) / p.length();
    to.push_back(p);
  }

  // Where the ray is over ground, it is not beside it. Pieces are sorted by their start.
  static void take_ground_from_rims(std::vector<Piece>& pieces) {
    std::vector<Piece> rims;
    for (const Piece& p : pieces) {
      if (p.rim) rims.push_back(p);
    }
    if (rims.empty()) return;
    std::erase_if(pieces, [](const Piece& p) { return p.rim; });
    const std::size_t grounds = pieces.size();
    for (const Piece& rim : rims) {
      double reached = rim.span.begin;
      bool touched = false;
      for (std::size_t i = 0; i < grounds && pieces[i].span.begin <= rim.span.end; ++i) {
        const Span over = pieces[i].span;
        if (over.end < rim.span.begin) continue;
        if (over.begin > reached) pieces.push_back(rim.part({reached, over.begin}));
        reached = std::max(reached, over.end), touched = true;
      }
      if (reached < rim.span.end || !touched) pieces.push_back(rim.part({reached, rim.span.end}));
    }
  }

  bool is_ground(double col, double row) const {
    const int cols = field_.cell_cols(), rows = field_.cell_rows();
    if (!field_.wraps() && !(col >= 0 && col < cols && row >= 0 && row < rows)) return false;
    return field_.cell_heights({within(col, cols), within(row, rows)}).has_value();
  }

  // All pieces of the ray, in order of t. The range must be finite in a wrapped field. A ray along a line belongs to
  // the cells after it, to those before it where the others have no ground, or to those on the side of `start`, if
  // given.
  std::vector<Piece> pieces(Span range, const Cell* start) const {
    std::vector<Piece> found;
    const int cols = field_.cell_cols(), rows = field_.cell_rows();
    const bool wraps = field_.wraps();
    // Without holes there is ground on every side of a node.
    const bool has_holes = field_.nodata_count() > 0;
    const auto touched = [&](double o, double d, Span over, int cells) {
      const double from = d == 0 ? o : o + d * over.begin, to = d == 0 ? o : o + d * over.end;
      const double first = std::floor(std::min(from, to)) - 1, last = std::floor(std::max(from, to)) + 1;
      // One more beside the field, for its border.
      const double most = cells;
      return wraps ? Span{first, last} : Span{std::clamp(first, -1.0, most), std::clamp(last, -1.0, most)};
    };
    const Span over_rows = touched(oy_, dy_, range, rows);
    // A cell beside a node may begin before its row does, by rounding.
    const double last = std::isinf(range.end) ? range.end : range.end + rounding_of_time(range.end);
    for (double row = over_rows.begin; row <= over_rows.end; ++row) {
      if (start && dy_ == 0 && within(row, rows) != start->row) continue;
      // Pieces are whole up to the lines that end them, wherever the range ends: a hit does not depend on that.
      const Span over_row = common({range.begin, kInfinity}, strip(oy_, dy_, row, 1));
      if (over_row.empty() || over_row.begin > last || std::isinf(over_row.begin)) continue;
      // Columns that the ray can touch in this row, one more on either side for rounding.
      const Span over_cols = touched(ox_, dx_, common(range, over_row), cols);
      for (double col = over_cols.begin; col <= over_cols.end; ++col) {
        if (start && dx_ == 0 && within(col, cols) != start->col) continue;
        if (!start && dx_ == 0 && col + 1 == ox_ && is_ground(col + 1, row)) continue;
        if (!start && dy_ == 0 && row + 1 == oy_ && is_ground(col, row + 1)) continue;
        Span over_cell = common(over_row, strip(ox_, dx_, col, 1));
        // Through a node, the ray also touches the two cells beside its path: one may be the only ground there.
        const double missing = over_cell.begin - over_cell.end;
        if (has_holes && missing > 0 && missing <= rounding_of_time(over_cell.begin)) {
          std::swap(over_cell.begin, over_cell.end);
          over_cell.begin = std::max(over_cell.begin, range.begin);
        }
        if (over_cell.empty() || over_cell.begin > range.end) continue;
        if (is_ground(col, row)) {
          add_pieces(col, row, over_cell, found);
        } else if (!start) {
          add_rims(col, row, over_cell, found);
        }
      }
    }
    const auto earlier = [](const Piece& p, const Piece& q) {
      return p.span.begin != q.span.begin ? p.span.begin < q.span.begin : p.span.end < q.span.end;
    };
    std::stable_sort(found.begin(), found.end(), earlier);
    take_ground_from_rims(found);
    std::stable_sort(found.begin(), found.end(), earlier);
    return found;
  }

  // A time after the ray has left the rims on which it is at t: over a field without wrap, the end of its path.
  double beyond(double t) const {
    const double speed = std::max(std::abs(dx_), std::abs(dy_));
    if (!field_.wraps() || speed == 0) return field_.wraps() ? t : kInfinity;
    return std::min(std::numeric_limits<double>::max(), t + (field_.cell_cols() + field_.cell_rows()) / speed);
  }

  // Times at which the ray's line is over the field: always, if the field has no border.
  Span inside_border() const {
    if (field_.wraps()) return {};
    return common(strip(ox_, dx_, 0, field_.cell_cols()), strip(oy_, dy_, 0, field_.cell_rows()));
  }

  Hit hit(const Piece& piece, double s) const {
    Hit hit;
    hit.status = HitStatus::hit;
    hit.t = piece.span.begin + std::clamp(s, 0.0, piece.length());
    hit.cell = piece.cell;
    hit.u = inside(ox_ + dx_ * hit.t - piece.col);
    hit.v = inside(oy_ + dy_ * hit.t - piece.row);
    hit.height = field_.height_from_sample(up_ * (oz_ + dz_ * hit.t));
    return hit;
  }

 private:
  // Hits from below are hits from above on heights multiplied by -1.
  std::optional<CellHeights> heights(Cell cell) const {
    const auto h = field_.cell_heights(cell);
    if (!h) return {};
    return CellHeights{up_ * h->h00, up_ * h->h10, up_ * h->h01, up_ * h->h11};
  }
  static double inside(double x) { return std::clamp(x, 0.0, 1.0); }
  static int within(double cell, int cells) { return static_cast<int>(cell - std::floor(cell / cells) * cells); }
  // Exact on level ground, on which rays may start.
  static double bilinear(const CellHeights& h, double u, double v) {
    const double west = h.h00 + (h.h01 - h.h00) * v, east = h.h10 + (h.h11 - h.h10) * v;
    return west + (east - west) * u;
  }

  const HeightField& field_;
  double up_;
  double seam_, seam_step_;
  double ox_, oy_, oz_, dx_, dy_, dz_;  // the ray in cells and sample units
  double off_x_, off_y_;                // cells by which rounding may move it from a line
};

// First s in the piece at which a ray from above is on or below the surface. A ray that started on the surface must be
// below by more than `depth`, the rounding error; a touch is not a hit for it.
std::optional<double> descent(const Piece& p, std::optional<double> depth) {
  const auto below = [&](double f) { return depth ? f < -*depth : f <= 0; };
  const bool ends_below = below(p.last);
  const auto vertex = p.vertex();
  const double lowest = vertex ? (p.a * *vertex + p.b) * *vertex + p.c : kInfinity;
  if (!ends_below && !(p.a > 0 && below(lowest))) return {};
  const auto roots = p.roots();
  if (!roots) return ends_below ? p.length() : *vertex;
  // f falls through zero at the lower root if it opens upwards, at the upper root otherwise.
  return p.a < 0 ? roots->end : roots->begin;
}

// Whether a ray that is below at the start of the piece emerges in between, by more than rounding.
bool rises_inside(const Piece& p, double rounding) {
  const auto vertex = p.vertex();
  return vertex && p.a < 0 && (p.a * *vertex + p.b) * *vertex + p.c > rounding;
}

// The first s at which such a ray is on or below the surface again, as descent().
std::optional<double> descent_after_rise(const Piece& p, std::optional<double> depth) {
  if (!(depth ? p.last < -*depth : p.last <= 0)) return {};
  return p.roots() ? p.roots()->end : p.length();
}

// Follows the ray; found_in_range(hit) returns whether to continue. Returns below if the ray started below the ground,
// otherwise miss.
template <class Found>
HitStatus follow(const HeightTarget& target, const Ray& ray, Sides from, MarchStats* stats,
                 const Found& found_in_range) {
  const HeightField& field = *target.field;
  // From the surface, the ray is below it only after t.
  const bool on_surface = ray.start == RayStart::on_surface;
  const auto found = [&](const Hit& hit) {
    return (on_surface ? hit.t < ray.t_max : hit.t <= ray.t_max) && found_in_range(hit);
  };
  HitStatus without = HitStatus::miss;
  if (!field.has_cells()) return without;
  Ground ground(target, ray, from);
  enum class Side { unknown, above, below } side = Side::unknown;
  if (on_surface) {
    const auto start = ground.clearance_at(ray.start_cell, ray.t_min);
    if (!start) return without;
    ground.move_height(-*start);
    side = Side::above;
  }
  auto pieces = ground.pieces({ray.t_min, ray.t_max}, on_surface ? &ray.start_cell : nullptr);
  // Whether the ray reaches the ground from a rim does not depend on where the range ends.
  const auto cut = [&](const Piece& p) { return p.rim && p.span.end >= ray.t_max; };
  if (std::any_of(pieces.begin(), pieces.end(), cut))
    pieces = ground.pieces({ray.t_min, ground.beyond(ray.t_max)}, nullptr);
  // Whether rims, one after the other, lead from a piece to the ground.
  const auto leads_to_ground = [&](std::size_t piece) {
    double end = pieces[piece].span.end;
    for (std::size_t i = piece + 1; i < pieces.size() && pieces[i].span.begin <= end; ++i) {
      if (!pieces[i].rim) return true;
      end = std::max(end, pieces[i].span.end);
    }
    return false;
  };
  if (stats) stats->steps = stats->cell_tests = static_cast<std::uint32_t>(pieces.size());
  const Span inside = ground.inside_border();
  const double entry = std::max(ray.t_min, inside.begin);
  // A ray from the surface may enter its cell a rounding later.
  const double start = on_surface ? ray.t_min + ground.rounding_of_time(ray.t_min) : -kInfinity;
  double reached = start;
  bool first = on_surface, below_rim = false;
  const bool has_walls = field.settings().solid && from == Sides::above;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Piece p = pieces[i];
    if (p.span.begin > ray.t_max) break;
    // Rims of neighbours overlap: the ray has been followed up to here.
    if (p.rim && p.span.begin < reached && p.span.end > reached) p = p.part({reached, p.span.end});
    if (first && p.cell == ray.start_cell && p.span.begin <= start) {
      // f = s (a s + b): the root at the start is not a hit.
      reached = std::max(reached, p.span.end);
      if (p.length() == 0) continue;
      first = false;
      const double last = std::isinf(p.length()) ? p.last : (p.a * p.length() + p.b) * p.length();
      const double lowest = p.a > 0 && p.vertex() ? (p.a * *p.vertex() + p.b) * *p.vertex() : last;
      if (!(lowest < -ground.rounding(ray.t_min))) continue;
      if (!found(ground.hit(p, p.b < 0 || p.a == 0 ? 0 : -p.b / p.a))) return without;
      if (last <= 0) side = Side::below;
      continue;
    }
    // A vertical ray through a node: one of the cells there is sufficient.
    if (p.length() > 0 && p.span.end <= reached) continue;
    if (p.span.begin > reached) side = Side::unknown;  // a hole in between, or the first piece
    reached = std::max(reached, p.span.end);
    const double rounding = ground.rounding(p.span.begin);
    // Where the height overflows, the ray is far from all ground.
    if (!std::isfinite(p.c)) continue;
    const auto meet_wall = [&] {
      Hit hit = ground.hit(p, 0);
      hit.wall = true;
      return std::isfinite(hit.height) && found(hit);
    };
    // A ray that reached the wall behind a rim from below the rim, and stayed there, hits the wall.
    const bool came_below = std::exchange(below_rim, false) && side == Side::below;
    if (came_below && !p.rim && p.c <= rounding && has_walls && !meet_wall()) return without;
    bool outside = p.rim && (came_below || side == Side::unknown), rises_to_rim = false;
    if (side == Side::unknown) {
      // Through the border or out of a hole, unless it started in this cell.
      const bool came_in = p.span.begin > ray.t_min || inside.begin >= ray.t_min;
      // A ray that starts this close and has risen to the rim by the time it reaches the ground touches the rim there.
      const double bound = p.rim ? ground.rounding_at_rim(p.span.begin) : 0.0;
      rises_to_rim = p.c < 0 && p.c >= -bound && p.last >= 0;
      const double touched = ground.meets() ? -bound : 0.0;
      side = p.c < touched && !rises_to_rim ? Side::below : Side::above;
      if (side == Side::below && has_walls && came_in && !p.rim && !meet_wall()) return without;
    }
    // If it only passes a corner of the ground, into a hole, it does not start there.
    const bool begins = !p.rim && p.span.begin <= entry && (p.length() > 0 || inside.end <= entry);
    if (side == Side::below && !on_surface && begins) without = HitStatus::below;
    // A ray from below has emerged only if it is above by more than rounding: otherwise it could be above at one line
    // and, by rounding, not above at the next.
    if (side == Side::below && p.c > rounding) side = Side::above;
    const auto depth = on_surface ? std::optional(rounding) : std::nullopt;
    // A ray that reaches the surface has hit it, and may rise and hit it again in the same piece. A ray that does not
    // sink beside the rim reaches the surface behind the rim, if it gets there.
    const bool waits = p.rim && p.last >= 0;
    if (side == Side::above && !depth && p.c <= 0 && !(waits && leads_to_ground(i)) && !rises_to_rim) {
      if (!found(ground.hit(p, 0))) return without;
      side = Side::below;
      outside = false;
    }
    const bool rises = side == Side::below && rises_inside(p, rounding);
    const auto s = side == Side::above && !waits ? descent(p, depth)
                   : rises                       ? descent_after_rise(p, depth)
                                                 : std::nullopt;
    if (rises) side = Side::above;
    if (s) {
      if (!found(ground.hit(p, *s))) return without;
      side = Side::below;
    }
    if (side == Side::below && (p.last > rounding || (rises && !s))) side = Side::above;
    below_rim = outside && side == Side::below && !s;
  }
  return without;
}

// Products of the components of a very long or very short direction do not fit a double: such a ray is scaled to a
// length near 1, and t is scaled back. Powers of two avoid rounding.
class OfUsualLength {
 public:
  explicit OfUsualLength(const Ray& ray) : ray_(ray) {
    const dvec3& d = ray.direction;
    std::frexp(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}), &exponent_);
    if (std::abs(exponent_) < 128) exponent_ = 0;
    for (int axis = 0; axis < 3; ++axis) ray_.direction[axis] = std::ldexp(d[axis], -exponent_);
    ray_.t_min = std::max(std::ldexp(ray.t_min, exponent_), std::numeric_limits<double>::lowest());
    // The range ends where the ray's t is no longer finite.
    ray_.t_max =
        exponent_ == 0 ? ray.t_max : std::ldexp(std::min(ray.t_max, std::numeric_limits<double>::max()), exponent_);
  }
  const Ray& ray() const { return ray_; }
  Hit in_own_length(Hit hit) const {
    hit.t = std::ldexp(hit.t, -exponent_);
    return hit;
  }

 private:
  Ray ray_;
  int exponent_ = 0;
};

HitStatus all_hits(const HeightTarget& target, const Ray& ray, Sides side, std::vector<Hit>& hits) {
  require(target, HeightPart::none);
  hits.clear();
  const OfUsualLength usual(ray);
  const HitStatus without = follow(target, usual.ray(), side, nullptr, [&](const Hit& hit) {
    hits.push_back(usual.in_own_length(hit));
    return true;
  });
  return hits.empty() ? without : HitStatus::hit;
}

}  // namespace

Hit march_exhaustive(const HeightTarget& target, const Ray& ray, const MarchSettings&, MarchStats* stats) {
  require(target, HeightPart::none);
  if (stats) *stats = {};
  Hit answer;
  const OfUsualLength usual(ray);
  const HitStatus without = follow(target, usual.ray(), Sides::above, stats, [&](const Hit& hit) {
    answer = usual.in_own_length(hit);
    return false;
  });
  if (!answer) answer.status = without;
  return answer;
}

Hit march_exhaustive_by_rules(const HeightTarget& target, const Ray& ray, const HitRules& rules, MarchStats* stats) {
  require(target, HeightPart::none);
  if (stats) *stats = {};
  Hit answer;
  const OfUsualLength usual(ray);
  // A ray that may be on either side of the surface that it starts on does not hit it there.
  const bool leaves = rules.sides == Sides::both && ray.start == RayStart::on_surface;
  const double started =
      leaves ? usual.ray().t_min + 2 * Ground(target, usual.ray(), Sides::above).rounding_of_time(usual.ray().t_min)
             : -kInfinity;
  for (const Sides side : {Sides::above, Sides::below}) {
    if (rules.sides != Sides::both && rules.sides != side) continue;
    const HitStatus without = follow(target, usual.ray(), side, stats, [&](const Hit& found) {
      const Hit hit = usual.in_own_length(found);
      if (found.t <= started || (rules.accept && !(*rules.accept)(hit))) return true;
      if (!answer || hit.t < answer.t) answer = hit;
      return false;
    });
    if (!answer && side == Sides::above) answer.status = without;
  }
  return answer;
}

HitStatus all_hits_exhaustive(const HeightTarget& target, const Ray& ray, std::vector<Hit>& hits) {
  return all_hits(target, ray, Sides::above, hits);
}

HitStatus all_hits_from_below_exhaustive(const HeightTarget& target, const Ray& ray, std::vector<Hit>& hits) {
  return all_hits(target, ray, Sides::below, hits);
}

}  // namespace scarp
