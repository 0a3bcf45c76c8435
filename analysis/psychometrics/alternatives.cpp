// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/alternatives.hpp"

#include <fmt/format.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>
#include <tuple>

#include "analysis/psychometrics/psychometric_function.hpp"

namespace tacto::analysis {

double proportion_correct(double d_prime, std::size_t alternatives) {
  constexpr double kReach = 9;  // beyond it phi is below 1e-18
  const auto density = [&](double from_signal) {
    const double phi =
        std::exp(-from_signal * from_signal / 2) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
    return phi * std::pow(standard_function(Shape::normal, from_signal + d_prime).first,
                          static_cast<double>(alternatives - 1));
  };
  return boost::math::quadrature::gauss_kronrod<double, 61>::integrate(density, -kReach, kReach, 8, 1e-12);
}

schema::Result<double> d_prime_of(double proportion, std::size_t alternatives) {
  constexpr double kMost = 10;
  const auto difference = [&](double d_prime) {
    return proportion_correct(d_prime, alternatives) - proportion;
  };
  if (!(difference(-kMost) < 0 && difference(kMost) > 0))
    return schema::fail(schema::ErrorKind::unsuitable,
                        fmt::format("a proportion of {:g} gives only a bound of d'", proportion), {},
                        "measure with a signal that is detected sometimes");
  std::uintmax_t steps = 100;
  const auto found = boost::math::tools::toms748_solve(difference, -kMost, kMost,
                                                       boost::math::tools::eps_tolerance<double>(40), steps);
  return (found.first + found.second) / 2;
}

std::optional<Estimate> d_prime_of_same(const SameAnswers& answers) {
  if (answers.own == 0 || answers.other == 0) return std::nullopt;
  double d_prime = 0, variance = 0;
  for (const auto& [same, trials, sign] :
       {std::tuple{answers.same_of_own, answers.own, 1.0}, {answers.same_of_other, answers.other, -1.0}}) {
    const double share = (same + 0.5) / (trials + 1), z = standard_quantile(Shape::normal, share);
    const double phi = std::exp(-z * z / 2) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
    d_prime += sign * z;
    variance += share * (1 - share) / (trials * phi * phi);
  }
  const double reach = standard_quantile(Shape::normal, 0.975) * std::sqrt(variance);
  return Estimate{d_prime, d_prime - reach, d_prime + reach};
}

}  // namespace tacto::analysis
