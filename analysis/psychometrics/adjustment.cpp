// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/adjustment.hpp"

#include <cmath>

#include "analysis/psychometrics/over_people.hpp"
#include "data-schema/base/decibels.hpp"

namespace tacto::analysis {
namespace {

using schema::amplitude_db;
using schema::amplitude_of_db;

std::optional<SeriesMean> series_mean(std::span<const double> ratios) {
  if (ratios.empty()) return std::nullopt;
  SeriesMean mean{ratios.size(), geometric_mean(ratios), {}};
  if (ratios.size() < 2) return mean;
  double squares = 0;
  for (const double ratio : ratios) squares += std::pow(amplitude_db(ratio / mean.ratio.value), 2);
  mean.deviation_db = std::sqrt(squares / static_cast<double>(ratios.size() - 1));
  return mean;
}

// Of the difference of the means; twice that of their middle.
double reach_db(const SeriesMean& a, const SeriesMean& b) {
  if (!a.deviation_db || !b.deviation_db) return INFINITY;
  const auto na = static_cast<double>(a.settings), nb = static_cast<double>(b.settings);
  const double va = *a.deviation_db * *a.deviation_db / na, vb = *b.deviation_db * *b.deviation_db / nb;
  if (va + vb == 0) return 0;
  const double freedom = (va + vb) * (va + vb) / (va * va / (na - 1) + vb * vb / (nb - 1));
  return student_reach(freedom) * std::sqrt(va + vb);
}

}  // namespace

AdjustmentMeans adjustment_means(std::span<const double> ascending, std::span<const double> descending) {
  AdjustmentMeans means{series_mean(ascending), series_mean(descending), {}, {}};
  if (!means.ascending || !means.descending) return means;
  const double up_db = amplitude_db(means.ascending->ratio.value);
  const double down_db = amplitude_db(means.descending->ratio.value);
  const double reach = reach_db(*means.ascending, *means.descending), middle_db = (up_db + down_db) / 2;
  means.middle = Estimate{amplitude_of_db(middle_db), amplitude_of_db(middle_db - reach / 2),
                          amplitude_of_db(middle_db + reach / 2)};
  means.hysteresis_db = Estimate{down_db - up_db, down_db - up_db - reach, down_db - up_db + reach};
  return means;
}

}  // namespace tacto::analysis
