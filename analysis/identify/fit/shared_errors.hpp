// SPDX-License-Identifier: GPL-3.0-or-later
// Errors that many values of a response share.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// Makes the residuals of data with BodeData::shared_errors independent and of variance 1. Whitened by the
/// noise alone their covariance is I + B B^T, where the columns of B are the shared errors over the noise,
/// real and imaginary part by turns; with B = Q S V^T its inverse root is I - Q (1 - 1 / sqrt(1 + S^2)) Q^T
/// (generalised least squares, Aitken 1936).
class SharedErrors {
 public:
  explicit SharedErrors(const BodeData& data);
  /// Of residuals over the noise, real and imaginary part by turns. Data without shared errors change
  /// nothing.
  void take_from(std::span<double> residuals) const;

 private:
  std::vector<std::vector<double>> directions_;  // columns of Q
  std::vector<double> taken_;                    // 1 - 1 / sqrt(1 + S^2)
};

/// (response - modelled) / noise, less what the shared errors explain, turned by the model's phase: real
/// along the model, imaginary across.
std::vector<std::complex<double>> turned_residuals(const BodeData& data,
                                                   std::span<const std::complex<double>> modelled);

}  // namespace tacto::analysis
