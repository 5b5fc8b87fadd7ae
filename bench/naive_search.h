// SPDX-License-Identifier: MIT
// Finds settings at which naive is fine enough. Two settings can make it step over ground: the minimum step, and the
// fraction of the vertical distance that it assumes to be free. On steep ground the fraction alone causes lost hits at
// any minimum step, so both are searched.
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

/// Returns the settings at which naive is good with the fewest steps. For each factor (0.7, halved repeatedly), tries
/// minimum steps (1/64, halved repeatedly) until naive is good. Stops a factor at the first setting that takes more
/// than `most_steps` per ray. Returns nullopt if no settings are good.
std::optional<NaiveSettings> cheapest_naive(const std::function<NaiveTrial(const NaiveSettings&)>& attempt,
                                            double most_steps = std::numeric_limits<double>::infinity());

/// Whether good settings have few hits in the air. If not, any tolerance is good: at a large one, every ray hits at
/// once.
enum class EarlyHits : bool { limited, ignored };

/// Coarsens good settings from `cheapest_naive`: first the tolerance, if early hits are limited, then the minimum step,
/// then the factor (at most 1), each as long as naive stays good and takes fewer steps.
NaiveSettings coarsened_naive(NaiveSettings settings, const std::function<NaiveTrial(const NaiveSettings&)>& attempt,
                              EarlyHits early = EarlyHits::limited);

}  // namespace scarp::bench
