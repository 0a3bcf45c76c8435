// SPDX-License-Identifier: GPL-3.0-or-later
// Reads tables of other programs: responses, and drive against displacement.
#pragma once

#include <optional>
#include <string>

#include "analysis/identify/measure/bode_data.hpp"
#include "analysis/identify/measure/device_drive.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// Units if the header does not have them: "um/V", "V/N", "dB m/V"; "deg" or "rad".
struct TableUnits {
  std::string amplitude, phase;
};

/// Finds columns by the beginnings of their names: frequency, amplitude (or gain, magnitude), phase and,
/// optionally, noise (noise_um_per_v: the standard deviation of each part, in the amplitude's unit). Units
/// follow the name: frequency_hz, amplitude_um_per_v, "Gain (dB m/V)", phase_deg; a number without a unit is
/// refused. Frequencies are in Hz, kHz or rad/s. m/V makes it an actuator's response, V/N a sensor's. Errors:
/// those of reading a file; malformed, with line and column (NaN, text, a ragged row); usage: a missing or
/// unknown unit; unsuitable: phases above 100 in radians, which probably are degrees; a negative amplitude
/// that is not in decibels, with its line.
schema::Result<BodeData> read_bode_table(const std::string& path, const TableUnits& units);

/// Columns drive_v (V, mV) and displacement_m (m, mm, um, nm); the rate comes from time_s, without it it is
/// 0. Errors: the same; unsuitable: times that are not even to 1 %.
schema::Result<DrivenTray> read_driven_table(const std::string& path);

/// Whether the table's header names frequencies; otherwise it is a table of drive and displacement. Errors:
/// those of reading a file.
schema::Result<bool> is_bode_table(const std::string& path);

/// Two channels of a recording, in SI units; a transducer's tangential_force is converted back to volts at
/// its output. Errors: those of reading a recording; unsuitable: no such channel, gaps, a sample at the end
/// of its converter's range.
struct RecordedPair {
  std::vector<double> input, output;
  double rate_hz = 0;
  Direction direction = Direction::actuator;
  std::string simulated;
};
schema::Result<RecordedPair> read_recorded_pair(const std::string& stem, const std::string& input,
                                                const std::string& output);

}  // namespace tacto::analysis
