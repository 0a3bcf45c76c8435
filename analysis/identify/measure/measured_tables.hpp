// SPDX-License-Identifier: GPL-3.0-or-later
// What other programs measured, as tables: responses, and drive against displacement.
#pragma once

#include <optional>
#include <string>

#include "analysis/identify/measure/bode_data.hpp"
#include "analysis/identify/measure/device_drive.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// Units where the header does not say them: "um/V", "V/N", "dB m/V"; "deg" or "rad".
struct TableUnits {
  std::string amplitude, phase;
};

/// Columns by the beginnings of their names: frequency, amplitude (or gain, magnitude), phase, and where
/// there is one noise (noise_um_per_v: in the amplitude's unit, the standard deviation of each part). Units
/// stand behind the name: frequency_hz, amplitude_um_per_v, "Gain (dB m/V)", phase_deg; a number without a
/// unit is refused. m/V makes it an actuator's, V/N a sensor's. Errors: as of reading a file; malformed, with
/// line and column (NaN, text, a ragged row); usage: a unit that is missing or unknown; unsuitable: phases of
/// more than 100 in radians, which will be degrees; an amplitude below 0 that is not in decibels, with its
/// line. Frequencies in Hz, kHz or rad/s.
schema::Result<BodeData> read_bode_table(const std::string& path, const TableUnits& units);

/// Columns drive_v (V, mV) and displacement_m (m, mm, um, nm); with time_s the rate, without it 0. Errors:
/// likewise; unsuitable: times that are not even to 1 %.
schema::Result<DrivenTray> read_driven_table(const std::string& path);

/// Whether the table's header names frequencies; else it will be one of drive and displacement. Errors: as of
/// reading a file.
schema::Result<bool> is_bode_table(const std::string& path);

/// Two channels of a recording, in SI units: a transducer's tangential_force in volts at its output again.
/// Errors: as of reading a recording; unsuitable: no such channel, gaps, a sample at an end of its
/// converter's range.
struct RecordedPair {
  std::vector<double> input, output;
  double rate_hz = 0;
  Direction direction = Direction::actuator;
  std::string simulated;
};
schema::Result<RecordedPair> read_recorded_pair(const std::string& stem, const std::string& input,
                                                const std::string& output);

}  // namespace tacto::analysis
