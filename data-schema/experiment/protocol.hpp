// SPDX-License-Identifier: GPL-3.0-or-later
// NAME.protocol.json: what an experiment asks of whom, and what counts as delivered; NAME.key.json: which
// stimulus plays under which code.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// The standard: a sinusoid of the tray's displacement along position.
struct StandardStimulus {
  double period_m = 0, amplitude_m = 0, length_m = 0;
};

/// What a trial asks. two_interval: the standard and a stretched version of it are played, one after the
/// other; which of them has the smaller period. identification: one of the comparisons is played, or lies on
/// the bench as a real sample; which of the standards it is. amplitude: the standard is played, at a gain of
/// each trial; how strong it is, re the real sample that is before the participant. ordering: all standards,
/// each explored as often as the participant likes; their order, from least to most. adjustment: the first
/// standard is played, and the participant changes its gain until the goal is reached. fidelity: a
/// standard is played beside the real sample of one of them; whether they are the same.
enum class Task { two_interval, identification, amplitude, ordering, adjustment, fidelity };

/// "two_interval", "identification", "amplitude", "ordering", "adjustment", "fidelity".
const char* word_of(Task task);

/// Which level a trial of two intervals has. constant: each level as often as the others, in the order of the
/// checksums. staircase: two right answers in a row lead to the next smaller stretch, a wrong one to the next
/// larger (Levitt 1971), from the largest on. quest_plus: the level that says most (Watson 2017).
enum class LevelMethod { constant, staircase, quest_plus };

/// "constant", "staircase", "quest_plus".
const char* word_of(LevelMethod method);

/// What an adjustment looks for: the least or the greatest gain at which the texture is one still; or the
/// gain at which it is as strong as the last standard, which is played before it at the ratio 1.
enum class Goal { least, greatest, match };

/// "least", "greatest", "match"; and back.
const char* word_of(Goal goal);
std::optional<Goal> goal_of(std::string_view word);

/// One condition of an identification: the comparisons are real samples, or played.
inline constexpr const char *kRealCondition = "real", *kVirtualCondition = "virtual";

/// The answers of the task amplitude, in order: the ratings -3 to 3.
inline constexpr int kLargestRating = 3;

/// The answers of the task adjustment, in order and from 1: a step down, a step up, and the end.
enum class Turn { weaker = 1, stronger, accept };

/// The answers of the task fidelity are "same" and "different", in this order, from 1.
inline constexpr int kSameChoice = 1;

/// How the finger is to move in each interval.
struct ProtocolPace {
  double from_m = 0, to_m = 0;  ///< on the texture
  double speed_mps = 0;
  int strokes = 0;   ///< alternately forth and back
  bool cue = false;  ///< the participant's screen shows the movement, as a mark along a bar
};

/// An interval with more of these, or beyond them, is not delivered. The levels in dB are those of the verb
/// `session`: the worst stroke counts.
struct DeliveryLimits {
  int lost_ticks = 0, fault_ticks = 0, late_ticks = 0, blind_ticks = 0;
  double removed_by_limits_db = 0;          ///< RMS of what the limits removed of the drive, re the drive
  double error_db = 0;                      ///< RMS of predicted displacement - target, re the target
  double slowest_mps = 0, fastest_mps = 0;  ///< mean speed of each stroke
};

struct AnswerWord {
  std::string key;   ///< one character
  std::string word;  ///< as it is shown and stored
};

/// What the participant reads, in one language. The names of the keys are inserted by the runner.
struct ProtocolTexts {
  std::string welcome, begin, interval, question, end;
  std::string rest;   ///< before a break; in a protocol with breaks only
  std::string place;  ///< to the operator, before a real sample's label
  std::string
      too_early;     ///< when a setting is accepted before the strokes of the pace; in an adjustment only
  std::string left;  ///< before the numbers of the textures that have yet to be explored; in an ordering only
  /// While an interval is awaited and played, if the protocol has a range of normal force.
  std::string force_below = {}, force_within = {}, force_above = {};
  std::string practice = {};  ///< before each practice trial
};

inline constexpr const char* kUsualLanguage = "en";

/// White noise in the participant's headphones, so that the playback is not heard.
struct MaskingNoise {
  double low_hz = 0, high_hz = 0;
  double level_db = 0, tolerance_db = 0;  ///< re 20 uPa at the ear, unweighted
};

/// With which the participant is to press. No session has the normal force, so it decides nothing: the screen
/// shows it, and the journal keeps how long it was within the range.
struct ForceRange {
  double low_n = 0, high_n = 0;
};

/// A break is due after so many trials or so much time since the last one, the beginning, or an interruption.
struct ProtocolBreaks {
  int after_trials = 0;  ///< 0: not by this
  double after_s = 0;    ///< the same

  bool any() const { return after_trials > 0 || after_s > 0; }
};

/// What the task does not have is empty.
struct Protocol {
  Task task = Task::two_interval;
  StandardStimulus standard;   ///< of two_interval, as the next two
  bool keep_slope = false;     ///< the amplitude is stretched alike
  std::vector<double> levels;  ///< stretch of the period: 0.3 is 30 % longer; ascending, never 0
  LevelMethod method = LevelMethod::constant;
  /// Names of textures: the comparisons are standards; of amplitude there is one standard, of adjustment one
  /// or, to match them, two.
  std::vector<std::string> standards, comparisons;
  /// Of ordering: the parameter by which the standards were made, one number for each; empty: unknown.
  std::vector<double> intended;
  Goal goal = Goal::least;  ///< of adjustment, as the next two
  double smallest_ratio = 0, step_db = 0;
  std::vector<std::string>
      conditions;        ///< of an identification, a block each; their order is a row of a Williams square
  int most_trials = 0;   ///< of one block
  double longest_s = 0;  ///< of one block: then no further trial of it begins
  /// Of amplitude: gains of trials are uniform from 0 to this times gain_m_per_n. Of adjustment: the limit of
  /// what can be set.
  double largest_ratio = 1;
  /// Of each level (constant) or comparison (in each condition); of fidelity of a texture beside another
  /// sample; else the number of trials.
  int repetitions = 0;
  std::string seed;         ///< of codes and order
  double gain_m_per_n = 0;  ///< of playback; of amplitude and adjustment that of the ratio 1
  ProtocolPace pace;
  double lead_s = 0;  ///< from the participant's go-ahead to the beginning of an interval: above any load
  std::vector<AnswerWord>
      choices;  ///< the answers: first and second interval; a standard each, in order; ratings; or Turn
  std::string begin_key;
  int most_attempts = 0;  ///< of one trial; then the run goes on without it
  int participants = 0;   ///< planned: before they are complete, the analysis needs --unblind
  DeliveryLimits delivered;
  ProtocolBreaks breaks;
  std::optional<MaskingNoise> masking_noise;
  std::map<std::string, ProtocolTexts> texts;  ///< by the code of the language; at least one
  std::string notes;
  std::string extra_json;  ///< members that the schema does not name
  std::string newer_version;
  std::vector<std::string> unknown_members = {};
  std::string sha256;  ///< of the file that was read
  std::optional<ForceRange> normal_force = std::nullopt;
  int practice = 0;      ///< trials before the first one, which are not counted
  std::string analysis;  ///< that is intended, in words; the analysis prints it
};

/// By stem, NAME.protocol.json or a JSON file with another name. Errors: not_found; malformed, with the
/// place: also an unknown member (with the nearest known one), one that the task lacks or does not have,
/// levels that do not rise or include 0, a comparison that is no standard, doubled keys or words, a word
/// that is another answer's key or could be a label, words that are not the standards in order, a path that
/// leaves the texture, limits of speed that exclude the pace, a band of the noise that is none, a text that
/// is shown and missing; unsupported_version.
Result<Protocol> read_protocol(const std::string& name);

/// The text of the file. Errors: unsuitable, by the schema.
Result<std::string> protocol_text(const Protocol& protocol);

/// The texts in a language. Errors: usage, with those that there are.
Result<ProtocolTexts> texts_in(const Protocol& protocol, const std::string& language);
/// The question in kUsualLanguage, or in the first language that there is.
std::string question_of(const Protocol& protocol);

/// Whether this is the code of a stimulus, on a real sample its label: K and digits.
bool is_label(std::string_view line);

/// The protocol and the key of a study of this stem.
std::string protocol_path(const std::string& study);
std::string key_path(const std::string& study);

/// One stimulus as it is played.
struct CodedStimulus {
  std::string code;    ///< "K3"
  double stretch = 0;  ///< of two_interval; 0: the standard
  std::string name;    ///< of the texture, in the other tasks
  std::string sha256;  ///< of its WAV
};

struct ProtocolKey {
  std::vector<CodedStimulus> stimuli;  ///< by code
  std::string sha256;                  ///< of the file that was read
};

/// Errors: as read_protocol; malformed: a code, stretch or name twice, or neither stretch nor name.
Result<ProtocolKey> read_protocol_key(const std::string& path);
Result<std::string> protocol_key_text(const ProtocolKey& key);

/// Errors: usage, if it is not a code, such as P07: letters and digits, at least one digit.
Result<void> check_participant(const std::string& participant);

}  // namespace tacto::schema
