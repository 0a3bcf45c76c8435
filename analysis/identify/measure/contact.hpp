// SPDX-License-Identifier: GPL-3.0-or-later
// Contact transients of taps on a rigid surface: peak force against velocity, acceleration and grip, and the
// pulses of taps of which only the force is known.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/identify/measure/number_table.hpp"
#include "analysis/identify/measure/taps.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// A coefficient of a linear fit with its 95 % interval.
struct ContactTerm {
  std::string name;  ///< with its unit: "effective mass, kg"
  double value = 0, low = 0, high = 0;
};

/// One of the nested fits. `left_out_n` is the RMS error of each tap's peak when that tap is left out of the
/// fit (r / (1 - h), with the diagonal h of the projection on the columns).
struct ContactFit {
  std::string inputs;  ///< "velocity, acceleration"
  std::vector<ContactTerm> terms;
  double rms_n = 0, left_out_n = 0;
};

/// A column that no fit has.
struct UnusedColumn {
  std::string name;
  std::string why;  ///< "is constant": it is so to 1e-4, or is a linear function of those before it
};

struct ContactFits {
  std::vector<ContactFit> fits;
  std::vector<UnusedColumn> unused_columns;
};

/// The peak force of taps by ordinary least squares on the velocity, then also on the acceleration, then also
/// on the grip force (Fiene and Kuchenbecker 2007, section 4: (4), (6) and the fit of Fig. 7), each with a
/// constant:
///
///     peak = constant - impact_coefficient v_in - effective_mass a_in + grip_coefficient grip
///
/// Columns: `velocity_mps` (before contact, positive away from the surface, so that it is negative),
/// `peak_n`, and if known `acceleration_mps2` and `grip_n`; other columns are ignored. Errors: malformed: a
/// column is missing, a velocity is not negative; unsuitable: fewer than 10 taps, or a constant velocity.
schema::Result<ContactFits> fit_contact(const NumberTable& table, const std::string& source);

/// Whether a table has one row for each tap (`peak_n`), not one for each sample.
bool has_peaks(const std::vector<std::string>& names);

/// The pulse of a tap: from where the force leaves 2 % of its peak to where it returns there, interpolated
/// between samples.
struct ContactPulse {
  std::string name;
  double peak = 0;     ///< in the file's unit, without the baseline
  double impulse = 0;  ///< unit x s
  double duration_s = 0;
  /// w and a of the damped sinusoid beta sin(w t) e^(-a t) that has this duration and this time of its peak:
  /// w = pi / duration, a = w / tan(w t_peak). A pulse that rises more slowly than it falls has a < 0.
  double frequency_hz = 0, decay_per_s = 0;
  bool is_double = false;  ///< longer than 1.6 times the median: the tap bounced
};

struct ContactPulses {
  std::vector<ContactPulse> pulses;
  /// Peak over impulse / duration, by least squares over the first single pulses (half a sine: pi / 2).
  double shape_factor = 0;
  std::size_t fitted = 0, predicted = 0;     ///< single pulses
  double median_error = 0, worst_error = 0;  ///< of the other peaks, predicted from impulse and duration
};

/// Errors: unsuitable: fewer than 10 taps; a tap without silence before it, or whose force does not return
/// to 2 % of its peak; fewer than two single pulses among the fitted or the others.
schema::Result<ContactPulses> contact_pulses(const Taps& taps, std::size_t fitted);

}  // namespace tacto::analysis
