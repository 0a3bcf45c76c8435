// SPDX-License-Identifier: GPL-3.0-or-later
// The channels with nothing in contact with the device: offset, noise floor, mains.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/take.hpp"
#include "data-schema/calibration/calibration.hpp"

namespace tacto::capture {

/// A line at the mains frequency or a harmonic of it, above the noise.
struct MainsLine {
  double frequency_hz = 0;
  double amplitude = 0;  ///< peak, in the channel's unit
  double above_floor_db = 0;
};

struct ChannelTare {
  std::size_t channel = 0;
  Uncertain zero;                ///< in stored numbers
  double mean = 0;               ///< the same by the nominal scale of the device, in the channel's unit
  double noise_rms = 0;          ///< in the channel's unit
  double noise_density = 0;      ///< in unit per root hertz: the median of 100 lines, 20 to 480 Hz
  std::vector<MainsLine> mains;  ///< of 50 or of 60 Hz, whichever is stronger
};

struct Tare {
  std::vector<ChannelTare> channels;      ///< force channels only: an encoder has no zero
  std::vector<std::string> motion_signs;  ///< signs of motion or contact; empty if there are none
  std::vector<std::string> warnings;
};

/// For channels of force: the mean by mean_of(), the RMS about the mean, Hann-windowed lines over all
/// samples. A mains line (the first six harmonics of 50 and 60 Hz, within 2 / T of each) must have 18 times
/// the mean power of its 20 neighbours; noise alone has this in about one of 1e4 channels. A channel is at
/// rest if the means of 20 blocks scatter by less than half of the scatter of the samples, and if the noise
/// of the transducer, without mains, is below 20 times the floor that its parameters give. A resting load
/// cannot be distinguished from an offset: above 0.1 N there is a warning, and also for a position that moves
/// by more than 0.1 mm, as a finger in the air may cause. At least 1 s. Errors: unsuitable: too short, no
/// channel of force, or a channel that is clipped.
schema::Result<Tare> tare_of(const Take& take);

/// The tare as entries of the device's calibration, without date.
std::vector<schema::CalibrationEntry> entries_of(const Tare& tare, const Take& take);

}  // namespace tacto::capture
