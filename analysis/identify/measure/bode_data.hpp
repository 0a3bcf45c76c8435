// SPDX-License-Identifier: GPL-3.0-or-later
// A measured frequency response, with what it was measured to be uncertain by.
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// One direction of the transducer: m/V as an actuator, V/N as a sensor.
enum class Direction { actuator, sensor };

/// All vectors of equal length, frequencies growing. Phase convention: exp(+2 pi i f t), so a lag is
/// negative.
struct BodeData {
  Direction direction = Direction::actuator;
  std::vector<double> frequency_hz;
  std::vector<std::complex<double>> response;  ///< m/V or V/N
  /// Standard deviation of the real and of the imaginary part alone, from scatter; empty: nobody measured it.
  std::vector<double> noise;
  double noise_freedom = 0;           ///< real values that the least known noise was told by; 0: it is known
  bool noise_from_residuals = false;  ///< nobody measured it: it is what a fit left
  /// The drive was held from sample to sample at this rate, and the answer sampled with it; 0: continuous.
  double held_rate_hz = 0;
  std::size_t limited = 0;  ///< ticks that were held to a limit of the device
  /// Relative errors that the values share, as those of a hysteresis that was divided out: each list has one
  /// for each frequency, all of them times the same number of the standard normal distribution.
  std::vector<std::vector<std::complex<double>>> shared_errors;
  std::string source, conditions, simulated;
  /// The third harmonic of the answer over its fundamental, the largest; what only a nonlinear device makes.
  /// None where it was not looked at: it takes one sine at a time.
  std::optional<double> third_harmonic;
  bool noise_is_a_bound =
      false;               ///< errors that may be smaller are in it: less is left than it says, at times
  bool of_device = false;  ///< measured just now, not read from a file
  double table_unit_si =
      0;  ///< a table's amplitudes were multiplied by it; 0: levels in decibels, or no table
  bool table_in_degrees = false;  ///< its header says so of the phases, which may be radians all the same

  std::size_t size() const { return frequency_hz.size(); }
  bool has_noise() const { return !noise.empty(); }
  bool noise_is_measured() const { return has_noise() && !noise_from_residuals; }
};

/// Standard deviation of the real and of the imaginary part at a frequency: the noise, or where it is not
/// known the amplitude itself.
double sigma_at(const BodeData& data, std::size_t i);

inline constexpr std::size_t kLeastFrequencies = 8;  // twice the parameters of the model

/// Whether a model can be fitted at all. Errors: unsuitable: fewer than kLeastFrequencies, a value that is
/// not finite (with its line), frequencies that do not grow, an amplitude of nothing, noise only: the median
/// of amplitude over noise is below 2, or (where none was measured) neighbours have nothing to do with each
/// other.
schema::Result<void> check_bode(const BodeData& data);

}  // namespace tacto::analysis
