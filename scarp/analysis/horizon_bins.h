// SPDX-License-Identifier: MIT
// Lower bounds of an envelope over small steps of u. Horizons only rise: bounds taken earlier still hold.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "scarp/analysis/horizon_envelope.h"

namespace scarp {

class HorizonBins {
 public:
  HorizonBins(double low, double high)
      : low_(low), step_((high - low) / kBins), minima_(kBins, -std::numeric_limits<double>::infinity()) {}

  /// Takes the bounds of an envelope.
  void update(const HorizonEnvelope& horizon) {
    const auto& pieces = horizon.pieces();
    std::size_t i = horizon.find(low_);
    for (int bin = 0; bin < kBins; ++bin) {
      const double begin = low_ + bin * step_, end = begin + step_;
      double minimum = std::numeric_limits<double>::infinity();
      // Over all pieces that the closed bin touches.
      for (double from = begin;; ++i) {
        const auto& piece = pieces[i];
        const double to = std::min(end, pieces[i + 1].begin);
        minimum = std::min(minimum, std::min(piece.line.at(from), piece.line.at(to)) - piece.error);
        if (pieces[i + 1].begin > end) break;
        from = to;
      }
      minima_[static_cast<std::size_t>(bin)] = minimum;
    }
  }

  /// Returns a lower bound over [begin, end] within the range of the bins; infinity if that is empty.
  double minimum(double begin, double end) const {
    // One extra bin on each side covers the rounding.
    const int first = static_cast<int>(std::clamp((begin - low_) / step_ - 1, 0.0, kBins + 0.0));
    const int last = static_cast<int>(std::clamp((end - low_) / step_ + 1, -1.0, kBins - 1.0));
    double minimum = std::numeric_limits<double>::infinity();
    for (int bin = first; bin <= last; ++bin) minimum = std::min(minimum, minima_[static_cast<std::size_t>(bin)]);
    return minimum;
  }

 private:
  static constexpr int kBins = 512;
  double low_, step_;
  std::vector<double> minima_;
};

}  // namespace scarp
