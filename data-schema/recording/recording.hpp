// SPDX-License-Identifier: GPL-3.0-or-later
// A recording: data of a device or of another program's file against time, unfiltered, as NAME.wav +
// NAME.json.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/physical_value.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/base/signal.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "data-schema/wav/wav.hpp"

namespace tacto::schema {

/// The calibration of a channel: its scale and offset are the calibrated ones, these are the device's own.
/// Uncertainties are standard ones (k = 1); empty dates and absent uncertainties for a part that was not
/// calibrated.
struct AppliedCalibration {
  double nominal_scale = 1, nominal_offset = 0;
  std::string scale_date, scale_method;     ///< ISO 8601, UTC; "weights", "travel" ...
  std::optional<double> scale_uncertainty;  ///< in unit per stored number
  std::string zero_date;
  std::optional<double> zero_uncertainty;  ///< in the channel's unit
};

/// One channel. `unit` is always the SI unit.
struct Channel {
  std::string name;      ///< unique in the recording; the quantity where there is one channel of it
  std::string quantity;  ///< one of quantity_names(): tangential_force, position, speed, ...
  std::string unit;      ///< SI symbol: N, m, m/s, m/s^2, V, 1
  double scale = 1;
  double offset = 0;
  std::optional<double> native_rate_hz;  ///< of a slower channel, whose values are held
  std::optional<double> range_min;       ///< smallest and largest physical value that the converter can give
  std::optional<double> range_max;
  std::string source;      ///< its origin: a column's name, a converter's input
  std::string derivation;  ///< empty if measured; else how it was made ("nominal, 40 mm/s")
  std::string calibrated;  ///< ISO date of the calibration, or empty
  std::optional<AppliedCalibration> calibration;  ///< if one of the device's calibration file was applied

  double physical(double stored) const { return physical_value(stored, scale, offset); }
};

/// Missing frames: `count` of them are absent before stored frame `frame`.
struct Gap {
  std::uint64_t frame = 0;
  std::uint64_t device_sequence = 0;  ///< that frame's number, lost ones counted: frame + all gaps up to here
  std::uint64_t count = 0;
};

struct Mark {
  std::uint64_t frame = 0;
  std::string label;
};

/// The time of a frame by the device's clock, and its arrival by the host's clock.
struct ClockPair {
  std::uint64_t device_sequence = 0;  ///< the frame's number, lost ones counted
  double device_s = 0, host_s = 0;
};

/// A fault that was known when `frame` frames had arrived.
struct FaultNote {
  std::uint64_t frame = 0;
  std::string what;
};

/// A stroke (stroke_rule.hpp), found when the recording was complete. Frames are stored ones.
struct StrokeFigures {
  std::uint64_t first_frame = 0, frames = 0;
  double length_m = 0;
  int direction = 1;  ///< -1: backwards
  double mean_speed_mps = 0;
  std::optional<double> mean_normal_n;  ///< none where no normal force is recorded
  std::uint64_t clipped_samples = 0;    ///< over all channels
  std::uint64_t lost_frames = 0;        ///< missing directly before or after it
};

/// The range that the finger should keep (Wiertlewski 2011, section IV-A5: 50 mm/s, 0.5 N).
struct TargetBand {
  double middle = 0, width = 0;  ///< middle +- width

  bool holds(double value) const { return value >= middle - width && value <= middle + width; }
};
inline constexpr TargetBand kTargetSpeed_mps = {50e-3, 15e-3};
inline constexpr TargetBand kTargetLoad_n = {0.5, 0.25};

/// The sidecar: everything about a recording but its samples.
struct RecordingHeader {
  std::string wav_file;  ///< beside the sidecar, no folder
  std::string sha256;    ///< of the WAV
  SampleFormat format = SampleFormat::float64;
  std::uint64_t frames = 0;
  double sample_rate_hz = 0;
  std::vector<Channel> channels;
  std::string clock;                       ///< source of the time: "device", "nominal rate given at import"
  std::string device;                      ///< device URI or maker's name; empty for an import
  std::string serial, firmware;            ///< of the device
  std::string simulated;                   ///< by what, where it is simulated; empty for real data
  std::string source_file, source_sha256;  ///< of an import
  std::optional<Transducer> transducer;
  std::string recorded;  ///< ISO date of the measurement, where someone gave it
  std::string created;   ///< ISO 8601, UTC
  std::string creator;   ///< program and version
  std::string subject, finger, surface, notes;
  std::optional<double> humidity_percent;
  std::vector<Gap> gaps;
  std::vector<Mark> marks;
  std::vector<ClockPair> clock_pairs;
  std::vector<StrokeFigures> strokes;                 ///< those that `spatial` finds in it
  std::optional<double> clock_drift_ppm;              ///< device's clock against the host's; above 0: fast
  std::optional<double> clock_drift_uncertainty_ppm;  ///< standard
  std::optional<double> clock_offset_s;               ///< device's minus host's clock at the first pair
  std::optional<double> clock_scatter_s;              ///< RMS of the pairs about that line
  std::vector<FaultNote> faults;
  std::string ended;                  ///< why it ended early: "disk full", "unplugged"
  std::vector<std::string> warnings;  ///< of its making, kept for readers
  std::string extra_json;             ///< members that the schema does not name, kept as they were
  std::string newer_version;          ///< set by the reader if the file's minor version is newer than ours
  std::vector<std::string> unknown_members = {};  ///< places of those that are not free (x_...)
};

/// A recording on disk, opened. Samples are read channel by channel.
struct Recording {
  RecordingHeader header;
  std::string stem;  ///< path without extension
};

/// The quantities and their SI units.
struct QuantityName {
  std::string_view name;
  Dimension dimension;
  bool of_texture = false;  ///< a texture can be made of it
};
std::span<const QuantityName> quantity_names();
/// The indices of the channels of which a texture can be made.
std::vector<std::size_t> texture_channels(const RecordingHeader& header);
/// Errors: usage, with the known names.
Result<QuantityName> quantity_named(std::string_view name);

/// Opens by stem, by NAME.json or by NAME.wav. Checks the schema, that the WAV is there and has the rate,
/// channels and frames that the sidecar says; not its checksum, which takes as long as reading it. Errors:
/// not_found; unsuitable, for samples without a sidecar; malformed (by JSON pointer; truncated);
/// unsupported_version.
Result<Recording> open_recording(const std::string& name);

/// Checks that its samples are those of the sidecar. Errors: malformed, if their SHA-256 differs; not_found.
Result<void> check_samples_sum(const Recording& recording);

/// Writes the sidecar of a recording again, with the header that it has now; the samples stay. Errors:
/// cannot_write; unsuitable, as RecordingWriter::create().
Result<void> write_sidecar(const Recording& recording);

/// The path of the samples.
std::string wav_path(const Recording& recording);

/// The channel's index. Errors: unsuitable, naming the channels.
Result<std::size_t> find_channel(const RecordingHeader& header, std::string_view name);

/// One channel in SI units. Frames are as stored: gaps are not filled, so sample i's time is
/// frame_time_s(header, i). Errors: as of reading a file; malformed, with the sample, where a value is NaN or
/// infinite. Precondition: there is such a channel (find_channel).
Result<TimeSignal> read_channel(const Recording& recording, std::size_t channel);

/// The stored numbers of one channel, no scale and no offset.
Result<std::vector<double>> read_stored(const Recording& recording, std::size_t channel);

/// Time of a stored frame, gaps counted.
double frame_time_s(const RecordingHeader& header, std::uint64_t frame);

/// The first stored frame at or after a time; header.frames behind the last.
std::uint64_t frame_at(const RecordingHeader& header, double time_s);

/// From the first frame to a period after the last, gaps counted; 0 without frames.
double duration_s(const RecordingHeader& header);

/// Streams a recording to disk: frames as they come, the sidecar at close. Both appear together at close(); a
/// writer that is dropped before leaves nothing.
class RecordingWriter {
 public:
  /// `name` is a stem, or NAME.json or NAME.wav. The file's name, frames, checksum, date and creator need not
  /// be set. Errors: cannot_write; usage, where the recording is there already and not `replace`; unsuitable,
  /// by JSON pointer, where the header can't be stored (a channel twice, a unit that is not its quantity's,
  /// no channel ...).
  static Result<RecordingWriter> create(const std::string& name, RecordingHeader header,
                                        bool replace = false);
  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;
  ~RecordingWriter();

  /// Whole interleaved frames in the header's format: doubles for float64, codes for pcm32. Errors:
  /// cannot_write.
  Result<void> write(std::span<const double> interleaved);
  Result<void> write(std::span<const std::int32_t> interleaved);
  /// For data that become known while writing: gaps, marks, warnings, the rate.
  RecordingHeader& header();
  /// Completes frames, checksum, date and creator, and gives both files their names. Once only.
  /// Errors: cannot_write; unsuitable, as of create().
  Result<Recording> close();

 private:
  struct State;
  explicit RecordingWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tacto::schema
