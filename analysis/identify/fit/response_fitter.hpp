// SPDX-License-Identifier: GPL-3.0-or-later
// One fit: the model, its data, and its free parameters.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/identify/fit/least_squares.hpp"
#include "analysis/identify/fit/response_model.hpp"
#include "analysis/identify/fit/shared_errors.hpp"
#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// The model at the data's frequencies, for the pole that the data were computed with (BodeData::by_pole).
std::vector<std::complex<double>> modelled_by(const ResponseModel& model, const BodeData& data,
                                              std::span<const double> values);

/// Data and model must outlive it. Precondition: check_bode(data), as many values as parameters.
class ResponseFitter {
 public:
  ResponseFitter(const BodeData& data, const ResponseModel& model, std::vector<double> start);

  /// Fits; then holds the least determined parameter at the base's value and fits again, as long as there is
  /// one.
  void run();

  /// After this call errors are estimated from the residuals at each frequency, because the size of the noise
  /// is not the assumed one.
  void take_uneven_noise();

  std::size_t free_count() const;
  double freedom() const;                      ///< 2 n - p
  double standard_error(std::size_t i) const;  ///< of parameter i's coordinate
  double spread(double hz) const;              ///< relative standard error of |model| at a frequency
  double times_95() const;                     ///< standard errors in half an interval
  bool held(std::size_t i) const { return held_[i]; }
  std::string ended() const;  ///< in words
  std::vector<std::complex<double>> modelled() const { return modelled_by(model_, data_, values_); }
  const std::vector<double>& values() const { return values_; }
  const Solution& solution() const { return solution_; }

 private:
  double variance() const;
  std::size_t place(std::size_t parameter) const;
  std::vector<double> values_at(std::span<const double> coordinates) const;
  void residuals(std::span<const double> coordinates, std::span<double> out) const;
  void solve();
  std::size_t least_determined() const;
  bool pole_out_of_band() const;
  std::vector<double> log_gradient(double hz) const;

  const BodeData& data_;
  const ResponseModel& model_;
  SharedErrors shared_;
  std::vector<double> values_;
  std::vector<bool> held_;
  Solution solution_;
  double uneven_freedom_ = 0;  // 0: the noise has the assumed size
};

}  // namespace tacto::analysis
