// SPDX-License-Identifier: GPL-3.0-or-later
// STUDY-P07.trials.jsonl: what happened in one participant's run, line by line. Each line is on the disk
// before the next step, and has its number and its check.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/files/event_file.hpp"

namespace tacto::schema {

/// The first line: who takes part in what, on which device.
struct RunPlanned {
  std::string study, participant;
  std::string protocol_sha256, key_sha256;
  std::string device;
  std::string observer;  ///< simulated; empty: a person
  std::string created, creator;
  int order = 1;              ///< row of the square of block orders, from 1
  std::string language = {};  ///< of the texts that the person read; empty: no screen
  std::string masking_level =
      {};  ///< "64.5 dB", as the operator measured it, or "not measured"; empty: no noise
};

/// An attempt at a trial begins: the first line of it.
struct AttemptBegun {
  int attempt = 0;                    ///< 1, 2 ... of the run
  std::string trial;                  ///< CODE.REPETITION
  std::vector<std::string> stimuli;   ///< codes, in the order of the intervals
  std::vector<std::string> sessions;  ///< from the journal's folder; none of a real sample
  int block = 1;                      ///< of the trials; 0: practice
  double block_s = 0;                 ///< time of the block so far, without interruptions
};

/// In place of a delivery: a real sample is on the bench. No session records it.
struct SamplePlaced {
  int attempt = 0;
  std::string label;  ///< as the operator typed it: the code of the trial
};

/// Of ordering: the participant feels a stimulus of the attempt, the next interval of it.
struct StimulusExplored {
  int attempt = 0;
  std::string stimulus;  ///< code
  std::string session;   ///< from the journal's folder
};

/// What a session says of one interval.
struct IntervalFacts {
  std::uint64_t ticks = 0, lost_ticks = 0, fault_ticks = 0, late_ticks = 0, blind_ticks = 0;
  bool closed = false;                         ///< the session is whole
  std::string stimulus_sha256;                 ///< of the texture that was played
  std::string simulated;                       ///< by which device; empty: a real one
  std::uint64_t strokes = 0;                   ///< of at least 5 mm
  double slowest_mps = 0, fastest_mps = 0;     ///< mean speeds of strokes
  std::optional<double> removed_by_limits_db;  ///< -300: nothing; none: unknown
  std::optional<double> predicted_error_db;    ///< of the worst stroke; none: the target is unknown
  std::optional<double> measured_error_db;     ///< the same, if the tray has a sensor
  std::optional<double> predicted_period_m;    ///< of the predicted displacement along position
  std::optional<double> measured_period_m;     ///< the same of the measured one
  /// RMS of the predicted displacement of all strokes, re that of the texture's force in the band; if the
  /// gain was changed, of the last stroke, at the last gain.
  std::optional<double> predicted_gain_m_per_n, measured_gain_m_per_n;
  std::optional<double> last_gain;  ///< at the end of playback, as a factor of the texture's gain
  bool operator==(const IntervalFacts&) const = default;
};

/// Decided before the answer is read.
struct DeliveryJudged {
  int attempt = 0;
  bool delivered = false;
  std::vector<std::string> why;          ///< not delivered: each reason
  std::vector<IntervalFacts> intervals;  ///< those that were played
  /// If the protocol has a range of normal force: the share of each interval's time in which the device
  /// reported one within it. None: unknown. No session has it.
  std::vector<std::optional<double>> force_within = {};
};

struct AttemptAnswered {
  int attempt = 0;
  /// Of the protocol's choices, from 1. 0: an order, or no setting was accepted.
  int choice = 0;
  std::string word;     ///< as the protocol names it; of an order the codes from least to most, "K3 K1"
  double answer_s = 0;  ///< from the question to the key; 0 of an observer and of a file
};

/// The block's time is over: no further trial of it begins.
struct BlockOver {
  int block = 0;
};

/// A break before the next trial.
struct BreakTaken {
  double break_s = 0;
};

/// The run continues after an interruption: an attempt without an answer is over.
struct RunResumed {
  std::string created;
  std::string masking_level = {};  ///< as in RunPlanned
};

struct RunEnded {
  std::string created;
};

using JournalEntry = std::variant<RunPlanned, AttemptBegun, DeliveryJudged, SamplePlaced, StimulusExplored,
                                  AttemptAnswered, BlockOver, BreakTaken, RunResumed, RunEnded>;

/// The line of an entry, with its end: a JSON object whose last member `check` has the first 16 hexadecimal
/// digits of the SHA-256 of the line without that member (and with the closing brace).
std::string journal_line(const JournalEntry& entry, std::size_t number);

struct Journal {
  RunPlanned plan;
  std::vector<JournalEntry> entries;  ///< with the plan
  std::size_t sound_bytes = 0;        ///< of the whole lines; what follows was not written completely
};

/// Reads the whole lines. A last line that is incomplete or wrong is left out. Errors: malformed, with the
/// line: a wrong check or number before other lines, or an entry that is none; unsuitable: no whole line.
Result<Journal> parse_journal(std::string_view text, const std::string& where);

/// STUDY-P07.trials.jsonl of a run's name (STUDY-P07, with or without that ending).
std::string journal_path(const std::string& run);
/// The run's name: the path without the ending.
std::string run_stem(const std::string& run);

/// Errors: not_found; as parse_journal.
Result<Journal> read_journal(const std::string& path);

/// The open file, locked for this process.
class JournalFile {
 public:
  /// Errors: usage, if the file exists; cannot_write.
  static Result<JournalFile> create(const std::string& path);
  /// Reads an existing journal into `journal`, and removes its incomplete end. Errors: as read_journal;
  /// unsuitable, while another process writes it; cannot_write.
  static Result<JournalFile> resume(const std::string& path, Journal& journal);

  /// Returns when the line is on the disk. Errors: cannot_write.
  Result<void> append(const JournalEntry& entry);

 private:
  JournalFile(EventFile file, std::string path, std::size_t lines)
      : file_(std::move(file)), path_(std::move(path)), lines_(lines) {}
  EventFile file_;
  std::string path_;
  std::size_t lines_;
};

}  // namespace tacto::schema
