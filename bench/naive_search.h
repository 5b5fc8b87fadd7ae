// SPDX-License-Identifier: MIT
// Finds settings at which naive is fine enough. Two settings let it step over ground: the minimum step, and the
// fraction of the vertical distance that it assumes to be free. On steep ground the second alone loses hits at any
// minimum step, so both are searched.
#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "scarp/march/march_settings.h"

namespace scarp::bench {

/// Time of the max-mip article without the pyramid over that with it.
constexpr double kArticleRatio = 55.066 / 9.074;

/// Results of naive at some settings.
struct NaiveTrial {
  bool good = false;
  double steps = 0;  ///< mean per ray
};

/// The settings at which naive is good and takes the fewest steps: for each factor, halved from 0.7 on, the coarsest
/// least step, halved from 1/64 on, at which it is good. Settings beyond the first of a factor that takes more than
/// `most_steps` per ray are not tried. Nullopt if there are none.
std::optional<NaiveSettings> cheapest_naive(const std::function<NaiveTrial(const NaiveSettings&)>& attempt,
                                            double most_steps = std::numeric_limits<double>::infinity());

/// Makes good settings of `cheapest_naive` coarser, first the tolerance, then the least step, then the factor (at most
/// 1), each as long as naive stays good and takes fewer steps.
NaiveSettings coarsened_naive(NaiveSettings settings, const std::function<NaiveTrial(const NaiveSettings&)>& attempt);

}  // namespace scarp::bench
