// SPDX-License-Identifier: GPL-3.0-or-later
// A texture: a quantity against position on an even grid, as NAME.texture.wav + NAME.texture.json.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/signal.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/texture/certificate.hpp"
#include "data-schema/texture/transform.hpp"

namespace tacto::schema {

/// The valid band of the texture at a position: the recording's band in Hz divided by the finger's speed
/// there.
struct BandPoint {
  double position_m = 0;
  double low_per_m = 0;
  double high_per_m = 0;
};

/// How a texture was made from a recording; enough to make it again.
struct TextureSource {
  std::string recording;         ///< file name of the recording's sidecar
  std::string recording_sha256;  ///< of its WAV
  double from_s = 0, to_s = 0;   ///< the section of the recording
  int stroke = 0;                ///< 1-based; 0 if a section was selected by time
  std::string method;            ///< "hermite"
  std::string filter;            ///< "fourier", "butterworth", "none"
  std::string edges;             ///< "treated", "none"
  int order = 0;                 ///< of the Butterworth filter; 0 of others
  double low_hz = 0, high_hz = 0;
  bool equalised = false;  ///< divided by the sensor's response
  double mean_speed_mps = 0, min_speed_mps = 0, max_speed_mps = 0;
  double position_moved_m = 0;    ///< largest change of a position to make them monotone
  double position_quantum_m = 0;  ///< the step of their grid; 0 if there is no visible grid
  double position_noise_m = 0;    ///< standard deviation of their noise, where it is over a quantum
  int counter_bits = 0;           ///< of an encoder's counter that wrapped in the recording; else 0
  int counter_wraps = 0;          ///< number of wraps in the section
  std::optional<double> normal_force_n = std::nullopt;  ///< its mean in the section, where it was recorded
  bool finger_up = false;                               ///< by that force
  /// Of a band-pass along position, if that is the filter; then the band in Hz is all that was recorded.
  std::optional<double> low_per_m = std::nullopt, high_per_m = std::nullopt;
  int interpolated_frames = 0;  ///< missing frames of the section that were filled
  /// Of several channels that became one signal: their names and the method, "dft321" (Landin 2010), which
  /// keeps the magnitude of the spectrum and not the waveform. The correlation is that of the axes with the
  /// texture along its best direction: 1 where the direction of the acceleration stays.
  std::vector<std::string> axes = {};
  std::string reduction = {};
  std::optional<double> waveform_correlation = std::nullopt;
};

/// One of the strokes that were averaged.
struct AveragedStroke {
  int stroke = 0;  ///< 1-based, in its recording
  double from_s = 0, to_s = 0;
  int direction = 1;
  double shift_m = 0;                                 ///< added to its positions on the bench
  std::optional<double> correlation = std::nullopt;   ///< with the strokes before it, where it was aligned so
  std::string recording = {}, recording_sha256 = {};  ///< where strokes of several recordings were averaged
};

/// The number of averaged strokes from a position on, up to the next such point.
struct StrokeCount {
  double position_m = 0;
  int strokes = 0;
};

/// Additional data of a texture that is the mean of several strokes.
struct TextureAverage {
  std::string align;  ///< "position", "correlation"
  std::vector<double>
      spread;  ///< standard deviation over the strokes, sample by sample, in the texture's unit
  std::vector<AveragedStroke> strokes;
  std::vector<StrokeCount> counts;  ///< by growing position, from 0 on
};

/// G_psi as a user saved it.
struct PlaybackGain {
  double gain_m_per_n = 0;  ///< displacement for force; negative inverts the texture
  std::string who, when;    ///< when: ISO 8601, UTC
};

struct Texture {
  /// Values in `unit`; origin_m is 0 and the first sample lies at position 0.
  SpaceSignal signal;
  std::string quantity = "tangential_force";
  std::string unit = "N";
  int direction = 1;           ///< -1: the stroke was backwards; it is stored by growing position, too
  double source_origin_m = 0;  ///< position 0 on the bench
  std::vector<BandPoint> valid_band;
  TextureSource source;                       ///< of an average: from its first stroke to its last
  std::optional<TextureAverage> average;      ///< of several strokes; the WAV has the spread as 2nd channel
  std::optional<Certificate> certificate;     ///< which of its peaks come from the surface
  std::optional<PlaybackGain> playback_gain;  ///< default gain of playback
  std::optional<TextureTransform> transform;  ///< of which textures it was made, where it was; then no source
  std::string simulated;                      ///< by what, where it is simulated
  std::string surface, subject, finger, notes;
  std::string created, creator;
  std::string extra_json;
  std::string newer_version;
  std::vector<std::string> unknown_members = {};
};

/// Opens by stem, NAME.texture.json or NAME.texture.wav; checks schema, length and grid, and that every
/// sample is a number; not the checksum (check_file does). Errors: not_found; unsuitable, for another kind of
/// file; malformed, with the sample where one is NaN or infinite; unsupported_version.
Result<Texture> read_texture(const std::string& name);

/// Writes STEM.texture.wav (32-bit float, header rate = samples per metre, rounded; one channel, of an
/// average two) and STEM.texture.json, together. Replaces what is there. Errors: cannot_write; unsuitable,
/// where there are no samples, one is no number, the spread is of another length, or the schema doesn't allow
/// it.
Result<void> write_texture(const std::string& stem, const Texture& texture);

/// The same with other files, at the commit() of `pending`.
Result<void> add_texture(PendingFiles& pending, const std::string& stem, const Texture& texture);

/// The gain in the sidecar; none if none was saved. Errors: as read_texture, of the sidecar.
Result<std::optional<PlaybackGain>> read_playback_gain(const std::string& name);

/// Writes it into the sidecar, in place of an earlier one. All other members stay, known or not, and the WAV
/// is not changed. The file appears whole or not at all. Errors: as read_playback_gain; cannot_write, also
/// for a read-only file; unsuitable, for a gain that is not finite.
Result<void> write_playback_gain(const std::string& name, const PlaybackGain& gain);

/// The samples to which an RMS applies: "all samples, filtered to 15-500 Hz", for reports.
std::string whole_rms_band(const Texture& texture);

/// "dft321 of ax, ay, az: keeps the magnitude of the spectrum, not the waveform"; empty for one channel.
std::string reduction_in_words(const TextureSource& source);

/// Checks that there is no texture of this name, or that it may be replaced. Errors: usage, naming the file.
Result<void> check_texture_free(const std::string& stem, Existing existing = Existing::keep);

}  // namespace tacto::schema
