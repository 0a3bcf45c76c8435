// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the sample rate and the gaps of a stream of the Lab Streaming Layer from the times of its samples.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capture/import/uniform_clock.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/exchange/xdf_file.hpp"

namespace tacto::capture {

/// Of a stream whose times scatter: a longer step is a gap, as in pyxdf (jitter_break_threshold_seconds and
/// _samples); a shorter one cannot be told from scatter.
inline constexpr double kLongestScatter_s = 1;
inline constexpr double kLongestScatter_samples = 500;

/// A jump of the stream's clock against the recorder's, or a step back, from which the clock was reset. LSL's
/// clocks do not jump, and pyxdf has the same threshold (clock_reset_threshold_offset_seconds).
inline constexpr double kClockReset_s = 1;

/// A moment by a stream's clock, and the same by the recorder's.
struct RecorderClock {
  double stream_s = 0, recorder_s = 0;
  double rate = 1;  ///< seconds of the recorder in a second of the stream; 1 where a drift is not certain

  double at(double time_s) const { return recorder_s + (time_s - stream_s) * rate; }
};

struct StreamClock {
  UniformClock clock;                 ///< by the recorder's clock, if offset_drift() is certain
  double begin_s = 0;                 ///< of the first sample, by the recorder's clock
  std::string words;                  ///< where the rate is from, for the recording
  std::vector<std::string> warnings;  ///< scatter; a large drift; a rate far from the nominal one
};

/// The times are even, with missing whole periods and a few pauses (ClockFinder); or, if they scatter and the
/// stream has a nominal rate, the rate is the slope of a least-squares line through times against sample
/// numbers, one line for each part between gaps, all with the same slope. Errors: unsuitable, for a clock
/// that was reset or jumped over more than kLongestGap_samples, with its time; malformed, for times that are
/// not even in a stream without a nominal rate; as read_xdf(). Reads the samples once, twice if they have
/// gaps or scatter.
schema::Result<StreamClock> find_stream_clock(const std::string& file, const schema::XdfStream& stream,
                                              const std::function<void(double)>& progress);

/// A marker of another stream of the file, `at_s` after the first sample of this one.
struct StreamMark {
  double at_s = 0;
  std::string label;  ///< UTF-8
};

struct StreamMarks {
  std::vector<StreamMark> marks;      ///< by time
  std::vector<std::string> warnings;  ///< without clock offsets; of a stream that gives no marks
};

/// The markers of all streams of text, each moved to the recorder's clock by its own clock offsets (the line
/// of the median slope where it is certain, else the median offset), as those of `samples` are, whose clock
/// is `clock`. With several streams of text, "NAME: " is put before a label. Errors: of read_xdf_markers(),
/// except unsuitable.
schema::Result<StreamMarks> find_stream_marks(const std::string& file, const schema::XdfContents& contents,
                                              const schema::XdfStream& samples, const StreamClock& clock);

}  // namespace tacto::capture
