// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/over_people.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>
#include <vector>

namespace tacto::analysis {
namespace {

struct Mean {
  double value = 0, error = 0, freedom = 0;  // with the standard error
};

Mean mean_and_error(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  Mean mean{0, INFINITY, count - 1};
  for (const double value : values) mean.value += value / count;
  if (values.size() < 2) return mean;
  double squares = 0;
  for (const double value : values) squares += (value - mean.value) * (value - mean.value);
  mean.error = std::sqrt(squares / (count - 1) / count);
  return mean;
}

}  // namespace

double student_reach(double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), 0.975);
}

Estimate geometric_mean(std::span<const double> figures) {
  std::vector<double> logs;
  for (const double figure : figures) logs.push_back(std::log(figure));
  const Mean mean = mean_and_error(logs);
  if (mean.freedom < 1) return {std::exp(mean.value), 0, INFINITY};
  const double reach = student_reach(mean.freedom) * mean.error;
  return {std::exp(mean.value), std::exp(mean.value - reach), std::exp(mean.value + reach)};
}

PairedTest paired_log_test(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size() && a.size() > 1);
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(std::log(a[i] / b[i]));
  const Mean mean = mean_and_error(differences);
  if (mean.error == 0) return {0, mean.value == 0 ? 1.0 : 0.0, mean.freedom};
  const double t = mean.value / mean.error;
  const boost::math::students_t student(mean.freedom);
  return {t, 2 * boost::math::cdf(boost::math::complement(student, std::abs(t))), mean.freedom};
}

}  // namespace tacto::analysis
