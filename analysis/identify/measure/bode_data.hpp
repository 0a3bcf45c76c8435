// SPDX-License-Identifier: GPL-3.0-or-later
// A measured frequency response with its measured uncertainty.
#pragma once

#include <complex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// One direction of the transducer: m/V as an actuator, V/N as a sensor.
enum class Direction { actuator, sensor };

/// Derivative of a response that was computed with a value of the electrical pole, by that value.
struct PoleDependence {
  double pole_hz = 0;                           ///< the value that was used
  std::vector<std::complex<double>> log_slope;  ///< d log(response) / d log(pole), one for each frequency

  /// The response at another pole over the response, to first order of the logarithms.
  std::complex<double> factor(std::size_t i, double at_pole_hz) const;
};

/// All vectors have equal length; frequencies increase. Phase convention: exp(+2 pi i f t), so a lag is
/// negative.
struct BodeData {
  Direction direction = Direction::actuator;
  std::vector<double> frequency_hz;
  std::vector<std::complex<double>> response;  ///< m/V or V/N
  /// Standard deviation of the real part, and of the imaginary part, from scatter; empty: not measured.
  std::vector<double> noise;
  double noise_freedom = 0;           ///< degrees of freedom of the noise, the fewest; 0: exactly known
  bool noise_from_residuals = false;  ///< the noise was not measured but estimated from a fit
  /// The drive was held between samples at this rate and the answer sampled with it; 0: continuous.
  double held_rate_hz = 0;
  std::size_t limited = 0;  ///< number of ticks in which a limit of the device was active
  /// Relative errors that the values share, for example those of a removed hysteresis: each list has one
  /// value for each frequency, and all of them are multiplied by the same standard normal variable.
  std::vector<std::vector<std::complex<double>>> shared_errors;
  std::optional<PoleDependence> by_pole;  ///< none: the response is measured, no pole was used
  std::string source, conditions, simulated;
  /// The largest ratio of the third harmonic to the fundamental, which only a nonlinear device causes;
  /// without harmonics that noise explains. Empty if it was not measured; measuring it requires one sine at a
  /// time.
  std::optional<double> third_harmonic;
  bool loops_measured = false;    ///< the hysteresis is known from slow loops
  bool noise_is_a_bound = false;  ///< an upper bound: residuals may be smaller than this noise
  bool of_device = false;         ///< measured on a device in this run, not read from a file
  double table_unit_si = 0;  ///< factor to SI of a table's amplitudes; 0: levels in decibels, or no table
  bool table_in_degrees = false;  ///< the table's header gives degrees, although the phases may be in radians

  std::size_t size() const { return frequency_hz.size(); }
  bool has_noise() const { return !noise.empty(); }
  bool noise_is_measured() const { return has_noise() && !noise_from_residuals; }
};

/// Standard deviation of the real and of the imaginary part at a frequency: the noise or, if it is unknown,
/// the amplitude itself.
double sigma_at(const BodeData& data, std::size_t i);

/// The data at some of the frequencies, in this order.
BodeData part_of(const BodeData& data, std::span<const std::size_t> which);

inline constexpr std::size_t kLeastFrequencies = 8;  // twice the parameters of the model

/// Whether a model can be fitted at all. Errors: unsuitable: fewer than kLeastFrequencies, a value that is
/// not finite (with its line), frequencies that do not increase, an amplitude of 0, only noise: the median of
/// amplitude over noise is below 2, or (without measured noise) neighbours are not correlated.
schema::Result<void> check_bode(const BodeData& data);

}  // namespace tacto::analysis
