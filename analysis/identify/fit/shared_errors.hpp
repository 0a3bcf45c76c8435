// SPDX-License-Identifier: GPL-3.0-or-later
// Errors that many values of a response share.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// Makes the residuals of data with BodeData::shared_errors independent and of variance 1. Divided by the
/// noise only, their covariance is I + B B^T, where the columns of B are the shared errors over the noise,
/// real and imaginary parts alternating. With B = Q S V^T its inverse root is I - Q (1 - 1 / sqrt(1 + S^2))
/// Q^T (generalised least squares, Aitken 1936).
class SharedErrors {
 public:
  explicit SharedErrors(const BodeData& data);
  /// Changes residuals over the noise, real and imaginary parts alternating. Without shared errors they do
  /// not change.
  void take_from(std::span<double> residuals) const;

 private:
  std::vector<std::vector<double>> directions_;  // columns of Q
  std::vector<double> taken_;                    // 1 - 1 / sqrt(1 + S^2)
};

/// (response - modelled) / noise without the part that the shared errors explain, rotated by the model's
/// phase: real along the model, imaginary across.
std::vector<std::complex<double>> turned_residuals(const BodeData& data,
                                                   std::span<const std::complex<double>> modelled);

}  // namespace tacto::analysis
