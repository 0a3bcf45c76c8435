// SPDX-License-Identifier: GPL-3.0-or-later
// Fits the model to a measured response and judges the fit.
#pragma once

#include <complex>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "analysis/identify/fit/misfit.hpp"
#include "analysis/identify/fit/response_model.hpp"
#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

struct FittedParameter {
  std::string name;  ///< ends in its unit
  double value = 0;
  double low = 0, high = 0;  ///< 95 %; the value itself without an interval
  bool held = false;         ///< not determined by the data: it keeps the base's value
};

/// A model among which one is chosen.
struct TriedModel {
  std::string name;
  std::size_t parameters = 0;
  /// Of the frequencies left out of the fit: RMS of the error over that of the response, and RMS of the error
  /// over the noise, if that was measured. NaN if the fit did not converge.
  double left_out = 0, left_out_over_noise = 0;
  bool converged = false, misfit = false;
};

struct NoiseEvenness {
  bool uneven = false;
  double low_hz = 0, high_hz = 0;  ///< the part of the band that differs most from the rest
  double times = 1;                ///< RMS of its residuals over that of the rest
};

/// "the noise is 3.2 times as large from 290 to 650 Hz as elsewhere ...", and what to do.
std::string evenness_words(const NoiseEvenness& evenness);

struct ResponseFit {
  std::vector<FittedParameter> parameters;
  bool converged = false;
  std::string ended;  ///< how, in words
  int iterations = 0;
  double r_squared = 0;  ///< of complex values, unweighted
  double condition = 0;  ///< of the Jacobian with columns of length 1
  Misfit misfit;
  NoiseEvenness evenness;         ///< of the residuals, if the noise was not measured
  double noise_overstated = 0;    ///< times: the given noise was too large and was ignored; 0: it was not
  std::string suggestion;         ///< what to do about a misfit
  ModelChoice choice;             ///< the model
  std::string choice_words;       ///< why this model
  std::vector<TriedModel> tried;  ///< the models among which it was chosen, the fewest parameters first
  std::vector<std::string> notes;
  schema::Transducer transducer;  ///< the base with the values in it
  BodeData data;                  ///< without the effect of the hold
  std::vector<std::complex<double>> modelled;
  /// The model from the lowest to the highest frequency, evenly spaced on a logarithmic axis, and its 95 %
  /// band: relative, of the amplitude; empty without intervals.
  std::vector<double> curve_hz, band;
  std::vector<std::complex<double>> curve;

  bool claims_intervals() const { return converged && !misfit.found; }
  const FittedParameter* find(std::string_view name) const;
};

/// Weighted non-linear least squares of complex values (Levenberg-Marquardt), weights 1 / noise^2. Without
/// measured noise, with_noise_of_residuals() of a first, relative fit estimates it. The result is the fit
/// with the smallest residual from one_mode_starts() or extended_starts() and, if its mode is overdamped,
/// from other_splits(); misfits and outliers are judged for that one. Of equal fits, the one with the pole
/// nearest the base's. The hold is removed with the model itself. A parameter with a standard error of more
/// than a factor e keeps the base's value, and a note says so. Intervals: from the Jacobian, normal if the
/// noise is known, otherwise with Student's t: by the noise's degrees of freedom, or by the residuals' 2 n -
/// p and their own variance (robust_errors() if evenness_of() says that it differs over the band). Noise that
/// misfit_of() calls overstated is treated as not measured. No intervals if the fit did not converge or
/// misfit_of() says that the model is wrong. If choice.open, the model is chosen by best_model().
/// Precondition: check_bode(data).
ResponseFit fit_response(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base);

/// Values of fitted models: starting points of others.
using KnownValues = std::map<std::string, std::vector<double>>;

/// The same for this choice alone, without a search for outliers. `data` has noise, measured or from
/// with_noise_known(). Adds its values, and those of the models that it needs, to `known`.
ResponseFit fit_once(const BodeData& data, const ModelChoice& choice, const schema::Transducer& base,
                     KnownValues& known);

/// Estimates unknown noise from the residuals, because wrong weights (constant or proportional noise) bias a
/// fit.
BodeData with_noise_known(BodeData data, const ModelChoice& choice, const schema::Transducer& base,
                          KnownValues& known);

std::vector<double> values_of(const ResponseFit& fit);

/// Sum of the squares of the whitened residuals.
double left_by(const ResponseFit& fit);

/// The combinations that no frequency response can separate, and the values that are held: one line each.
std::vector<std::string> held_words(const ModelChoice& choice, const schema::Transducer& base);

}  // namespace tacto::analysis
