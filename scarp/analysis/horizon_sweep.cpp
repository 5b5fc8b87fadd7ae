// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scarp {

SweepTable::SweepTable(const HorizonLayout& heights, const HorizonCrossings& crossings) : tilt_(crossings.tilt()) {
  const bool transposed = crossings.along_columns();
  row_sign_ = transposed ? crossings.col_sign() : crossings.row_sign();
  col_sign_ = transposed ? crossings.row_sign() : crossings.col_sign();
  per_step_ = static_cast<float>(1 / crossings.step());
  bend_ = static_cast<float>(heights.sign * crossings.curvature() * crossings.step() * crossings.step());
  const auto offset = [&](std::ptrdiff_t col, std::ptrdiff_t row, std::ptrdiff_t pitch) {
    return transposed ? col * pitch + row : row * pitch + col;
  };
  const auto entry_of = [&](const HorizonCrossing& c) {
    const std::ptrdiff_t pitch = heights.pitch;
    return Entry{static_cast<std::int32_t>(offset(c.col, c.row, pitch)),
                 static_cast<std::int32_t>(offset(c.second_col, c.second_row, pitch)), c.w, c.per_distance,
                 static_cast<float>(heights.sign) * c.drop};
  };
  const auto distance_of = [&](double steps) { return static_cast<float>(steps * crossings.step()); };
  for (std::size_t i = 0; i < crossings.count_to_major(kNearSteps); ++i) {
    near_.push_back(entry_of(crossings.all()[i]));
    distances_.push_back(distance_of(crossings.all()[i].steps));
  }
  for (int step = 0; step < heights.rows; ++step) {
    Entry e{0, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0};
    if (crossings.has_major(step)) {
      const HorizonCrossing& c = crossings.all()[crossings.count_to_major(step) - 1];
      if (std::abs(offset(c.col, c.row, heights.whole_pitch)) <= std::numeric_limits<std::int32_t>::max())
        e = entry_of(c);
    }
    majors_.first.push_back(e.first), majors_.w.push_back(e.w);
    majors_.per_distance.push_back(e.per_distance), majors_.drop.push_back(e.drop);
    distances_.push_back(distance_of(step));
  }
}

SweptPlace swept_place(const SweepTable& table, int visit) {
  const double drift = table.drift(visit), before = std::floor(drift);
  return {static_cast<int>(before), static_cast<int>(std::floor(drift + 0.5)),
          std::min(static_cast<float>(drift - before), 0x1.fffffep-1f)};
}

namespace {

// The hull of a line, from far to near, and the horizons of the nodes beside it.
class SweptLine {
 public:
  SweptLine(const HorizonHeights& heights, const SweepTable& table, float eye)
      : heights_(heights), table_(table), eye_(eye) {}

  void push(int visit, int line) {
    const SweptPlace at = swept_place(table_, visit);
    const int col = line + at.before;
    if (col < -1 || col >= heights_.cols()) return;
    const float* first = heights_.height(col, row_of(visit));
    const float ground = at.w > 0 ? std::fma(at.w, first[1] - first[0], first[0]) : first[0];
    if (std::isnan(ground)) return;
    const auto now = static_cast<float>(visit);
    const float height = ground - bend_at(now);
    const auto covered = [&](const Point& far, const Point& near) {
      return (far.height - height) * (now - near.visit) >= (near.height - height) * (now - far.visit);
    };
    while (hull_.size() > 1 && covered(hull_[hull_.size() - 2], hull_.back())) hull_.pop_back();
    hull_.push_back({height, now});
  }

  void look(int visit, int col, float& slope, std::int32_t& entry) const {
    const float* node = heights_.height(col, row_of(visit));
    const float z = *node + eye_;
    slope = -std::numeric_limits<float>::infinity(), entry = -1;
    const auto value = [&](const SweepTable::Entry& e) {
      const float first = node[e.first], second = node[e.first + e.second];
      return std::fma(std::fma(e.w, second - first, first - z), e.per_distance, -e.drop);
    };
    for (std::size_t i = 0; i < table_.near().size(); ++i) {
      const float to = value(table_.near()[i]);
      if (to > slope) slope = to, entry = static_cast<std::int32_t>(i);
    }
    if (!hull_.empty()) {
      const auto now = static_cast<float>(visit);
      const float eye = z - bend_at(now);
      std::size_t i = hull_.size() - 1;
      const auto lower = [&](const Point& near, const Point& far) {
        return (far.height - eye) * (now - near.visit) > (near.height - eye) * (now - far.visit);
      };
      while (i > 0 && lower(hull_[i], hull_[i - 1])) --i;
      const float steps = now - hull_[i].visit;
      const auto step = static_cast<std::size_t>(steps);
      const SweepTable::Majors& m = table_.majors();
      const std::int32_t beside = m.w[step] > 0 ? table_.beside() : 0;
      float to = value({m.first[step], beside, m.w[step], m.per_distance[step], m.drop[step]});
      if (std::isnan(to))
        to = (hull_[i].height - eye) / steps * table_.per_step() - 2 * table_.bend() * now * table_.per_step();
      if (to > slope) slope = to, entry = table_.first_major() + static_cast<std::int32_t>(step);
    }
    if (std::isnan(z)) slope = z;
  }

 private:
  struct Point {
    float height, visit;
  };
  int row_of(int visit) const { return table_.row_sign() > 0 ? heights_.rows() - 1 - visit : visit; }
  float bend_at(float visit) const { return table_.bend() * visit * visit; }

  const HorizonHeights& heights_;
  const SweepTable& table_;
  const float eye_;
  std::vector<Point> hull_;
};

}  // namespace

void sweep_horizons_by_one(const HorizonHeights& heights, const SweepTable& table, float eye, int line, int visits,
                           const SweepSink& sink) {
  std::vector<SweptLine> lines(kSweptLines, SweptLine(heights, table, eye));
  for (int visit = 0; visit < visits; ++visit) {
    const int row = table.row_sign() > 0 ? heights.rows() - 1 - visit : visit;
    for (int i = 0; i < kSweptLines; ++i) {
      SweptLine& one = lines[static_cast<std::size_t>(i)];
      if (visit >= SweepTable::kNearSteps) one.push(visit - SweepTable::kNearSteps, line + i);
      const int col = line + i + swept_place(table, visit).nearest;
      if (col < 0 || col >= heights.cols()) continue;
      float slope;
      std::int32_t entry;
      one.look(visit, col, slope, entry);
      sink(col, row, 1, &slope, &entry);
    }
  }
}

}  // namespace scarp
