// SPDX-License-Identifier: MIT
// The rules of `max-mip` over blocks: which blocks a ray passes, where it may touch ground on the way, and when an
// any-hit query is certain of a hit without finding it.
//
//   above the maximum: pass         below the minimum: pass, or any hit         otherwise: descend
//
// Maxima and minima are codes, rounded outwards; the ray's height becomes a code minus its rounding error.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scarp/march/height/block_walk.h"
#include "scarp/march/height/rim_rules.h"

namespace scarp::max_mip {
namespace {

template <class T, bool Holes, bool Wraps, Ask ask>
class BlockRules : public RimRules<T, Holes, Wraps, ask> {
 public:
  using Base = RimRules<T, Holes, Wraps, ask>;

  BlockRules(const HeightTarget& target, const SampleGrid<T>& grid, const Ray& ray, const GridRay& local,
             const Wanted& wanted, Hit& answer)
      : Base(target, grid, ray, local, wanted, answer),
        levels_(target.pyramid->levels().data()),
        top_(target.pyramid->top_level()) {}

  const Wanted& wanted() const { return this->wanted_; }
  std::uint32_t cell_tests() const { return this->stats.cell_tests; }
  /// Maximum of a block of level 1 or more, in metres.
  double maximum_of(const Block& block) const {
    const MaxPyramid::Level& at = levels_[block.level - 1];
    return ground_.metres(
        ground_.height(ground_.maximum(at.begin + static_cast<std::ptrdiff_t>(block.row) * at.cols + block.col)));
  }

 protected:
  using Base::ray_height, Base::rim, Base::lost, Base::rounding_of_clearance, Base::grid_ray, Base::test_cell;
  using Base::row_, Base::side_, Base::through_, Base::begun_, Base::slow_, Base::below_rim_;
  using Base::touches, Base::sinks_over_rim, Base::follow_rim, Base::field_, Base::seam_, Base::ground_, Base::x_;
  using Base::y_, Base::z_, Base::dz_, Base::t_in_, Base::t_end_, Base::rounding_, Base::answer_, Base::col_;

  // The visitor of walk_blocks(): the rules over blocks and cells.
  class Visitor {
   public:
    explicit Visitor(BlockRules& rules) : rules_(rules), falling_(rules.dz_ < 0), highest_(rules.ground_.highest()) {
      // The ray's height as a code, minus the maximum rounding error: compared with the pyramid without decoding it.
      // (z - base) / step + (dz / step) t: difference, quotient, product, sum, and the two of z + dz t itself are 6
      // roundings of u times `upright`, the sum of all magnitudes; rounding_of_code() is the next power of two.
      const double base = rules_.ground_.base(), per_step = rules_.ground_.per_step();
      const double farthest = std::max(std::abs(rules_.t_in_), std::abs(rules_.t_end_));
      const double upright =
          std::abs(rules_.z_) + std::abs(rules_.dz_) * farthest + std::abs(base) + std::abs(highest_);
      const double rounding = rules_.ground_.rounding_of_code() * upright + rules_.rounding_;
      code_z_ = (rules_.z_ - base - rounding) * per_step, code_dz_ = rules_.dz_ * per_step;
      highest_code_ = (highest_ - base) * per_step;
      if constexpr (Holes) {
        beside_node_ = widest_rounding_of_line(rules_.field_, rules_.grid_ray(), rules_.seam_);
        for (const int axis : {0, 1}) at_node_[axis] = rules_.rim(rules_.grid_ray()).beside_node(axis);
      }
    }

    [[gnu::always_inline]] Verdict block(const Block& block, const BlockWay& way) const {
      const MaxPyramid::Level& at = rules_.levels_[block.level - 1];
      const std::ptrdiff_t entry = at.begin + static_cast<std::ptrdiff_t>(block.row) * at.cols + block.col;
      const std::uint16_t maximum = rules_.ground_.maximum(entry);
      if (lowest_code(way) > maximum && (rules_.side_ != Side::below || rules_.risen_above(maximum, t_lowest(way)))) {
        // There may be ground behind the line that the ray crossed, with a node that it passes.
        if (Holes && rules_.begun_ && rules_.side_ != Side::below && !rules_.below_rim_ &&
            passes_node(way.after_x ? rules_.y_.at(way.t_in) : rules_.x_.at(way.t_in), at_node_[!way.after_x]) &&
            rules_.touches(rules_.rim(rules_.grid_ray()).node_time(way.t_in, !way.after_x, way.t_leave)))
          return Verdict::stop;
        // With holes, the last cell may be a hole: the side at the next cell is then unknown.
        if (!Holes) {
          rules_.side_ = Side::above;
        } else if (!cuts_corner(way.through_x, way.t_in, way.t_leave)) {
          rules_.side_ = Side::unknown;
        }
        return Verdict::pass;
      }
      const std::uint16_t minimum = rules_.ground_.minimum(entry);
      if (rules_.side_ == Side::below && rules_.under(rules_.ray_height(falling_ ? way.t_in : way.t_out), minimum))
        return rules_.lost(way.t_out) ? Verdict::stop : Verdict::pass;
      if (ask == Ask::any && falling_ && rules_.side_ == Side::above && rules_.falls_under(minimum, way.t_out)) {
        rules_.answer_.status = HitStatus::hit;
        return Verdict::stop;
      }
      return Verdict::descend;
    }

    [[gnu::always_inline]] bool cell(int col, int row, const BlockWay& way) const {
      if (Holes && rules_.ground_.is_hole(col, row)) return hole(col, row, way);
      const CellHeights h = rules_.ground_.cell(col, row);
      const double maximum = std::max(std::max(h.h00, h.h10), std::max(h.h01, h.h11));
      // A hit does not depend on where the ray ends: its whole cell is tested.
      const double t_low = falling_ ? way.t_leave : way.t_in, lowest = rules_.ray_height(t_low);
      if (lowest > maximum && (rules_.side_ != Side::below || lowest - maximum > rules_.rounding_of_clearance(t_low))) {
        rules_.side_ = Side::above;
        return false;
      }
      rules_.col_ = col, rules_.row_ = row, rules_.t_in_ = way.t_in;
      return rules_.test_cell(h, way.through_x, way.t_line, way.t_leave);
    }

    [[gnu::always_inline]] bool leaves(const BlockWay& way) const {
      if (Holes) {
        if (rules_.side_ != Side::below && !rules_.below_rim_ && way.t_line <= way.t_out &&
            passes_node(way.through_x ? rules_.y_.at(way.t_line) : rules_.x_.at(way.t_line), beside_node_) &&
            rules_.touches(way.t_line))
          return true;
        rules_.begun_ = true;
      }
      return !falling_ && lowest_code(way) > highest_code_;
    }

    [[gnu::always_inline]] bool crosses(const BlockWay& way, std::uint32_t steps) const {
      if (Holes) rules_.through_ = way.through_x ? Through::x_line : Through::y_line;
      return ask == Ask::any && !Holes && steps == kPatience && rules_.side_ == Side::above &&
             rules_.goes_under(way.t_line);
    }

   private:
    // The ray's height is linear: lowest at one end of the block. Over a block with holes the whole path through it
    // counts, so that the end of the range does not decide whether the rim behind its first line is followed.
    double t_lowest(const BlockWay& way) const { return falling_ ? Holes ? way.t_leave : way.t_out : way.t_in; }
    double lowest_code(const BlockWay& way) const { return code_z_ + code_dz_ * t_lowest(way); }

    // Passing the corner of a hole or block, in over one line and out over the other, does not leave the ground.
    bool cuts_corner(bool out_over_x, double begin, double end) const {
      if (rules_.through_ != (out_over_x ? Through::y_line : Through::x_line)) return end <= begin;
      return (end - begin) * std::abs(out_over_x ? rules_.y_.direction : rules_.x_.direction) <= beside_node_;
    }

    bool hole(int col, int row, const BlockWay& way) const {
      const bool corner = cuts_corner(way.through_x, way.t_in, way.t_line);
      // A ray that is not beside ground keeps its side only if it stays above all ground.
      const bool stays = corner && std::min(rules_.ray_height(way.t_in), rules_.ray_height(way.t_line)) > highest_;
      const auto follow = [&] {
        return rules_.follow_rim(way.t_in, way.t_line, {col - 1, col + 1, row - 1, row + 1}, stays);
      };
      if (rules_.slow_ ? follow()
                       : rules_.begun_ && rules_.side_ != Side::below &&
                             (rules_.touches(way.t_in) || (rules_.sinks_over_rim(way.t_in) && follow()))) {
        return true;
      }
      if (!rules_.slow_ && !corner) rules_.side_ = Side::unknown, rules_.below_rim_ = false;
      return rules_.lost(way.t_in);
    }

    BlockRules& rules_;
    bool falling_;
    double highest_, highest_code_, code_z_, code_dz_;
    double beside_node_ = 0, at_node_[2] = {0, 0};
  };

  // Whether a ray that was below is above a whole block by more than rounding: see test_cell().
  bool risen_above(std::uint16_t maximum, double t_lowest) const {
    return ray_height(t_lowest) - ground_.height(maximum) > rounding_of_clearance(t_lowest);
  }

  // Whether a ray that is below stays below over a whole block, which then has no holes.
  bool under(double highest, std::uint16_t minimum) const {
    return minimum != MaxPyramid::kNoMinimum && highest < ground_.height(minimum);
  }

  // Whether a ray that was above is at t, over a block without holes, below it: it has crossed the surface. By more
  // than rounding, so that closest() finds the hit, too.
  bool falls_under(std::uint16_t minimum, double t) const {
    const double height = ray_height(t);
    return under(height, minimum) && ground_.height(minimum) - height > 2 * rounding_of_clearance(t);
  }

  // Returns whether a ray that is above at t is, at some later point, below a whole block: without holes it has crossed
  // the surface before. Samples the minima of one level, which fits in a cache, at growing steps; rays along the ground
  // are mostly stopped by hills that are wider than a block.
  bool goes_under(double t) {
    if (Wraps || top_ < kProbeLevel) return false;
    const MaxPyramid::Level& at = levels_[kProbeLevel - 1];
    const double t_last = dz_ > 0 ? std::min(t_end_, (ground_.highest() - z_) / dz_) : t_end_;
    const double t_per_cell = 1 / std::max(std::abs(x_.direction), std::abs(y_.direction));
    if (!(t_last - t > kShortWay * t_per_cell)) return false;
    const double code_z = (z_ - ground_.base()) * ground_.per_step(), code_dz = dz_ * ground_.per_step();
    double step = kFirstProbe * t_per_cell;
    for (int i = 0; i < kProbes; ++i) {
      t += step;
      step *= kProbeGrowth;
      if (!(t < t_last)) return false;
      const std::ptrdiff_t row = y_.near(y_.at(t)) >> kProbeLevel, col = x_.near(x_.at(t)) >> kProbeLevel;
      const std::uint16_t minimum = ground_.minimum(at.begin + row * at.cols + col);
      // The position is rounded, too, so the next block is equally valid: the bound covers it.
      if (code_z + code_dz * t < minimum && falls_under(minimum, t)) {
        answer_.status = HitStatus::hit;
        return true;
      }
    }
    return false;
  }

  const MaxPyramid::Level* levels_;
  int top_;
};

}  // namespace
}  // namespace scarp::max_mip
