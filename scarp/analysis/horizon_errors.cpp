// SPDX-License-Identifier: MIT
#include "scarp/analysis/horizon_errors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <vector>

#include "scarp/base/parallel.h"
#include "scarp/base/progress_part.h"

namespace scarp {

HorizonErrors sampled_horizon_errors(const HeightField& field, const HorizonSettings& settings,
                                     std::span<const double> azimuths, const RowBand& band, int angles,
                                     const Progress& progress) {
  if (azimuths.empty() || band.rows() <= 0) return {};
  constexpr std::size_t kMostAzimuths = 8;
  const std::size_t chosen = std::min(azimuths.size(), kMostAzimuths);
  const Horizons horizons(field, settings);
  std::mt19937 random(1);
  std::vector<double> errors;
  for (std::size_t a = 0; a < chosen; ++a) {
    // Azimuths of the grid, in which a sweep is exact, are often every eighth.
    const double azimuth = azimuths[(a * azimuths.size() / chosen + a) % azimuths.size()];
    const HorizonRows found =
        horizons.rows(azimuth, band.first, band.last, false,
                      progress_part(progress, static_cast<double>(a), static_cast<double>(chosen)));
    std::vector<std::size_t> nodes(static_cast<std::size_t>(angles) / chosen);
    for (std::size_t& node : nodes) node = random() % found.angle.size();
    std::vector<double> differences(nodes.size(), std::numeric_limits<double>::quiet_NaN());
    parallel_for(static_cast<std::int64_t>(nodes.size()), 16, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        const auto cols = static_cast<std::size_t>(field.cols());
        const auto truth = horizon_from(field, static_cast<double>(nodes[i] % cols),
                                        static_cast<double>(nodes[i] / cols) + band.first, azimuth, settings);
        if (truth) differences[i] = std::abs(truth->angle - static_cast<double>(found.angle[nodes[i]]));
      }
    });
    std::copy_if(differences.begin(), differences.end(), std::back_inserter(errors),
                 [](double difference) { return !std::isnan(difference); });
  }
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  const auto at = [&](double share) {
    return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
  };
  return {at(0.5), at(0.99), errors.back(), static_cast<int>(errors.size())};
}

}  // namespace scarp
