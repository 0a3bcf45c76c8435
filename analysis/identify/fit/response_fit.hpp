// SPDX-License-Identifier: GPL-3.0-or-later
// The model fitted to a measured response, and what the fit says about itself.
#pragma once

#include <string>
#include <vector>

#include "analysis/identify/fit/misfit.hpp"
#include "analysis/identify/fit/response_model.hpp"
#include "analysis/identify/measure/bode_data.hpp"
#include "analysis/identify/measure/noise_evenness.hpp"

namespace tacto::analysis {

struct FittedParameter {
  std::string name;  ///< ends in its unit
  double value = 0;
  double low = 0, high = 0;  ///< 95 %; the value itself where no interval is claimed
  bool held = false;         ///< the data say too little of it: it stays what the base says
};

struct ResponseFit {
  std::vector<FittedParameter> parameters;
  bool converged = false;
  std::string ended;  ///< how, in words
  int iterations = 0;
  double r_squared = 0;  ///< of complex values, unweighted
  double condition = 0;  ///< of the Jacobian with columns of length 1
  Misfit misfit;
  NoiseEvenness evenness;       ///< of the residuals, where nobody measured the noise
  double noise_overstated = 0;  ///< times: the noise that came with the data was left out; 0: it was not
  bool one_mode_short =
      false;               ///< a second mode takes at least half of what a misfit leaves, and more than a lag
  std::string suggestion;  ///< what the model lacks, where there is a misfit
  std::vector<std::string> notes;
  schema::Transducer transducer;  ///< the base with the values in it
  BodeData data;                  ///< without the hold
  std::vector<std::complex<double>> modelled;
  /// The model from the lowest to the highest frequency, evenly by octaves, and its 95 % band: relative, of
  /// the amplitude; empty where none is claimed.
  std::vector<double> curve_hz, band;
  std::vector<std::complex<double>> curve;

  bool claims_intervals() const { return converged && !misfit.found; }
  const FittedParameter* find(std::string_view name) const;
};

/// Weighted non-linear least squares of complex values (Levenberg-Marquardt), weights 1 / noise^2; where
/// nobody measured the noise, that of with_noise_of_residuals() of a first, relative fit. Of the fits
/// from one_mode_starts() or second_mode_starts() the one that leaves least, and where its mode is overdamped
/// of those from other_splits(): what is said of misfits and of values that are off is said of that one. Of
/// equal ones the pole nearest the base's. The hold is taken out with the model itself. A parameter whose
/// standard error is more than a factor e is held at the base's value, and said. Intervals: from the
/// Jacobian, normal where the noise is known, else with Student's t: by the noise's own degrees of freedom,
/// or by the residuals' 2 n - p and their own variance (robust_errors() where evenness_of() says that it
/// differs over the band). Noise that misfit_of() calls overstated is left out, as if nobody had measured it.
/// No interval where the fit did not converge or misfit_of()
/// says that the model is wrong. Precondition: check_bode(data).
ResponseFit fit_response(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base);

/// The same values without what is said of them: no outlier is looked for, no reason of a misfit.
ResponseFit fit_values(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base);

/// What no frequency response can tell apart, and what was done about it: one line each.
std::vector<std::string> held_words(const ModelChoice& choice, const schema::Transducer& base);

}  // namespace tacto::analysis
