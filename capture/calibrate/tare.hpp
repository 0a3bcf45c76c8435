// SPDX-License-Identifier: GPL-3.0-or-later
// What the channels show while nothing touches the device: offset, noise floor, mains.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/take.hpp"
#include "data-schema/calibration/calibration.hpp"

namespace tacto::capture {

/// A line of the mains' own frequency or a harmonic of it that stands out of the noise.
struct MainsLine {
  double frequency_hz = 0;
  double amplitude = 0;  ///< peak, in the channel's unit
  double above_floor_db = 0;
};

struct ChannelTare {
  std::size_t channel = 0;
  Uncertain zero;                ///< in stored numbers
  double mean = 0;               ///< the same by the device's own scale, in the channel's unit
  double noise_rms = 0;          ///< in the channel's unit
  double noise_density = 0;      ///< in unit per root hertz: the median of 100 lines, 20 to 480 Hz
  std::vector<MainsLine> mains;  ///< of 50 or of 60 Hz, whichever is the stronger
};

struct Tare {
  std::vector<ChannelTare> channels;  ///< those of force only: an encoder has no zero
  std::vector<std::string> unstill;   ///< what says that something moved or touched; empty where all is well
  std::vector<std::string> warnings;
};

/// Channels of force: mean by mean_of(), RMS about the mean, Hann-windowed lines over the whole. A mains line
/// (first six harmonics of 50 and 60 Hz, within 2 / T of each) must have 18 times the mean power of its 20
/// neighbours: noise alone does so once in some 1e4 channels. Still means: the means of 20 blocks scatter by
/// less than half of what the samples do; and the transducer's noise, without its mains, is below 20 times
/// the floor that its parameters state. A load at rest cannot be told from an offset: above 0.1 N it is
/// warned of, and so is a position that moves by more than 0.1 mm, which a finger in the air may do. At least
/// 1 s. Errors: unsuitable: too short, no channel of force, or one that is clipped.
schema::Result<Tare> tare_of(const Take& take);

/// As entries of the device's calibration, without date.
std::vector<schema::CalibrationEntry> entries_of(const Tare& tare, const Take& take);

}  // namespace tacto::capture
