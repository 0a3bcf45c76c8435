// SPDX-License-Identifier: GPL-3.0-or-later
// One fit: the model, its data, and which of its parameters are free.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/identify/fit/least_squares.hpp"
#include "analysis/identify/fit/response_model.hpp"
#include "analysis/identify/fit/shared_errors.hpp"
#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// Data and model outlive it. Precondition: check_bode(data), as many values as parameters.
class ResponseFitter {
 public:
  ResponseFitter(const BodeData& data, const ResponseModel& model, std::vector<double> start);

  /// Fits, and again with the vaguest parameter held at the base's value for as long as there is one.
  void run();

  /// From now on errors are told by the residuals where they are: the noise is not of the size that was
  /// taken.
  void take_uneven_noise();

  std::size_t free_count() const;
  double freedom() const;                      ///< 2 n - p
  double standard_error(std::size_t i) const;  ///< of a coordinate
  double spread(double hz) const;              ///< relative standard error of |model| at a frequency
  double times_95() const;                     ///< standard errors that make half an interval
  bool held(std::size_t i) const { return held_[i]; }
  std::string ended() const;  ///< in words
  const std::vector<double>& values() const { return values_; }
  const Solution& solution() const { return solution_; }

 private:
  double variance() const;
  std::size_t place(std::size_t parameter) const;
  std::vector<double> values_at(std::span<const double> coordinates) const;
  void residuals(std::span<const double> coordinates, std::span<double> out) const;
  void solve();
  std::size_t vaguest() const;
  bool pole_is_nowhere() const;
  std::vector<double> log_gradient(double hz) const;

  const BodeData& data_;
  const ResponseModel& model_;
  SharedErrors shared_;
  std::vector<double> values_;
  std::vector<bool> held_;
  Solution solution_;
  double uneven_freedom_ = 0;  // 0: the noise is of the size that was taken
};

}  // namespace tacto::analysis
