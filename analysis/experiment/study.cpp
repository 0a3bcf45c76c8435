// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include "analysis/experiment/study_answers.hpp"
#include "analysis/experiment/trial_order.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/texture/texture_wav.hpp"
#include "data-schema/version.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/render/at_speed.hpp"
#include "spatial/features/band_kept.hpp"
#include "spatial/transform/stretch.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kStimulusPitchM = 5e-6;  // 100 samples in the shortest period of `stretch`
constexpr double kStimulusGain = 1e-3;    // m/N: 12.8 um are 12.8 mN
constexpr std::string_view kAnswerKeys = "123456789";
constexpr double kTextureEndM = 2e-3;  // left out of an identification's path, at both ends
// Of the 100 um to each side of Wiertlewski 2011: the response of the actuator falls below 500 Hz.
constexpr double kLargestDisplacementM = 50e-6;

schema::Texture standard_texture(const schema::Protocol& protocol) {
  const schema::StandardStimulus& standard = protocol.standard;
  schema::Texture texture;
  texture.signal.pitch_m = kStimulusPitchM;
  texture.signal.values.resize(static_cast<std::size_t>(std::lround(standard.length_m / kStimulusPitchM)) +
                               1);
  for (std::size_t i = 0; i < texture.signal.values.size(); ++i)
    texture.signal.values[i] =
        standard.amplitude_m / protocol.gain_m_per_n *
        std::sin(2 * std::numbers::pi * texture.signal.position_m(i) / standard.period_m);
  texture.surface = "computed sinusoid";
  texture.created = schema::creation_time();
  texture.creator = kCreator;
  return texture;
}

// What is played, without what names the surface: people look into files. Of the words about the emulated
// device only its name and seed are kept; the surface is named behind them.
schema::Texture coded(const schema::Texture& texture) {
  schema::Texture stimulus;
  stimulus.signal = texture.signal;
  stimulus.valid_band = texture.valid_band;
  stimulus.simulated = texture.simulated.substr(0, texture.simulated.find(": "));
  stimulus.created = schema::creation_time();
  stimulus.creator = kCreator;
  return stimulus;
}

// Path, speeds and gain for textures that are played up to `ratio` times as strong. Their names are the
// standards.
Result<void> fit_to_textures(schema::Protocol& protocol, const NamedTextures& textures, double ratio) {
  double shortest_m = INFINITY, largest_n = 0;
  for (const auto& [name, texture] : textures) {
    if (texture.unit != "N")
      return fail(ErrorKind::unsuitable,
                  fmt::format("is in {}, and the gain of a protocol is for forces", texture.unit), name,
                  "name textures of tangential force");
    protocol.standards.push_back(name);
    shortest_m = std::min(shortest_m, texture.signal.length_m());
    for (const double force_n : texture.signal.values) largest_n = std::max(largest_n, std::abs(force_n));
  }
  const double inner_m = std::floor((shortest_m - 2 * kTextureEndM) * 1e3) / 1e3;
  protocol.pace = {kTextureEndM, kTextureEndM + inner_m, 0.05, 2};
  protocol.delivered.slowest_mps = 0.035, protocol.delivered.fastest_mps = 0.065;  // 50 +- 15 mm/s
  if (ratio * largest_n * protocol.gain_m_per_n > kLargestDisplacementM)
    protocol.gain_m_per_n = std::floor(1e6 * kLargestDisplacementM / (ratio * largest_n)) / 1e6;
  protocol.standard = {}, protocol.keep_slope = false, protocol.levels.clear(), protocol.choices.clear();
  return {};
}

Result<void> check_several(const NamedTextures& textures) {
  if (textures.size() >= 2 && textures.size() <= kAnswerKeys.size()) return {};
  return fail(ErrorKind::usage, fmt::format("there are {} textures", textures.size()), "--textures",
              fmt::format("name 2 to {}", kAnswerKeys.size()));
}

Result<schema::Texture> stimulus_texture(const schema::Protocol& protocol, const NamedTextures& textures,
                                         const schema::CodedStimulus& stimulus) {
  if (!stimulus.name.empty()) return coded(textures.at(stimulus.name));
  const schema::Texture standard = standard_texture(protocol);
  if (stimulus.stretch == 0) return standard;
  spatial::Stretch by;
  by.factor = 1 + stimulus.stretch;
  by.keep_slope = protocol.keep_slope;
  by.period_m = protocol.standard.period_m;
  return spatial::stretch(standard, by);
}

Result<void> write_stimuli(const Study& study, const NamedTextures& textures, schema::Existing existing) {
  schema::PendingFiles pending;
  for (const schema::CodedStimulus& stimulus : study.key.stimuli) {
    const auto texture = stimulus_texture(study.protocol, textures, stimulus);
    TACTO_TRY(texture);
    TACTO_TRY(schema::add_texture(pending, study.stimulus(stimulus.code), *texture));
  }
  return pending.commit(existing);
}

Result<void> check_free(const Study& study, schema::Existing existing) {
  TACTO_TRY(schema::check_output_free(schema::protocol_path(study.stem), existing));
  TACTO_TRY(schema::check_output_free(schema::key_path(study.stem), existing));
  for (const schema::CodedStimulus& stimulus : study.key.stimuli)
    TACTO_TRY(schema::check_texture_free(study.stimulus(stimulus.code), existing));
  return {};
}

// What the schema's pattern of seeds and names says.
Result<void> check_plain(const std::string& text, const char* option) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
  if (!text.empty() && text.size() <= 64 && text.find_first_not_of(kPlain) == std::string::npos) return {};
  return fail(ErrorKind::usage, fmt::format("'{}' has other characters than a protocol may contain", text),
              option, "use 1 to 64 of A to Z, a to z, 0 to 9, _ . -; a texture's name is that of its file");
}

// A study is written over one of the same stem only: not over another folder, nor under runs, which could
// not be analysed without its key.
Result<void> check_stem_of(const Study& study) {
  if (!schema::is_file(schema::protocol_path(study.stem))) {
    if (std::error_code none; std::filesystem::is_directory(study.stem, none))
      return fail(ErrorKind::usage, "is a folder that belongs to no study", study.stem,
                  "choose another stem with -o, or remove the folder");
    return schema::check_stem(study.stem);
  }
  const auto runs = runs_of(study);
  if (runs.empty()) return {};
  return fail(ErrorKind::cannot_write, "is a study with runs, which belong to its key",
              schema::protocol_path(study.stem), "choose another stem with -o");
}

Result<void> check_key(const Study& study, const std::string& path) {
  const auto meanings = [](const std::vector<schema::CodedStimulus>& stimuli) {
    std::set<std::pair<double, std::string>> all;
    for (const schema::CodedStimulus& each : stimuli) all.emplace(each.stretch, each.name);
    return all;
  };
  if (meanings(study.key.stimuli) == meanings(stimuli_by_code(study.protocol))) return {};
  return fail(ErrorKind::malformed, "has other stimuli than the protocol", path + "#/stimuli",
              "it belongs to another protocol: make the study again");
}

Result<void> check_stimulus(const Study& study, const schema::CodedStimulus& stimulus) {
  const std::string stem = study.stimulus(stimulus.code);
  const auto wav = schema::texture_wav(stem);
  TACTO_TRY(wav);
  const auto sum = schema::sha256_of_file(wav->path);
  TACTO_TRY(sum);
  if (*sum != stimulus.sha256 || wav->sha256 != stimulus.sha256)
    return fail(ErrorKind::unsuitable, "is not the texture that the key names", stem,
                "it was changed or swapped: take it from a copy, or make the study again");
  const auto texture = schema::read_texture(stem);
  TACTO_TRY(texture);
  if (texture->signal.length_m() >= study.protocol.pace.to_m) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("ends at {:g} m, before the path's end at {:g} m", texture->signal.length_m(),
                          study.protocol.pace.to_m),
              wav->path, "use a longer texture, or end the path earlier");
}

}  // namespace

std::string Study::name() const {
  return std::filesystem::path(stem).filename().string();
}

std::string Study::stimulus(const std::string& code) const {
  return stem + "/" + code;
}

std::string Study::run(const std::string& participant) const {
  return stem + "-" + participant;
}

schema::Protocol stretch_protocol(const std::string& seed, schema::LevelMethod method) {
  schema::Protocol protocol;
  protocol.standard = {1.76e-3, 12.8e-6, 0.06};
  protocol.keep_slope = true;
  protocol.levels = {-0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.7};
  protocol.repetitions = 10;
  protocol.method = method;
  if (method != schema::LevelMethod::constant) {
    protocol.levels.clear();
    for (int percent = -70; percent <= 70; percent += 5)
      if (percent > 0 || (percent < 0 && method == schema::LevelMethod::quest_plus))
        protocol.levels.push_back(percent / 100.0);
    protocol.repetitions = 60;
  }
  protocol.seed = seed;
  protocol.gain_m_per_n = kStimulusGain;
  protocol.pace = {0.01, 0.05, 0.06, 2};
  protocol.lead_s = 0.5;
  protocol.choices = {{"f", "first"}, {"j", "second"}};
  protocol.begin_key = " ";
  protocol.most_attempts = 3;
  protocol.participants = 8;
  protocol.analysis =
      "Of each participant PSE and JND, which is the Weber fraction, by a cumulative normal function with "
      "lapses; over participants the geometric mean of the JNDs.";
  // At 45 mm/s the longest period, 2.99 mm, is at 15.04 Hz: still in the band from 15 Hz.
  protocol.delivered = {0, 0, 10, 0, -40, -20, 0.045, 0.085};
  schema::ProtocolTexts& texts = protocol.texts[schema::kUsualLanguage];
  texts.welcome = "You feel two textures, one after the other. Say which of them has the smaller period.";
  texts.begin = "Put the finger at the left end and press the space bar.";
  texts.interval = "Move the finger to the right end and back.";
  texts.question = "Which one had the smaller period? f: the first, j: the second.";
  texts.rest = "Take a break. Press any key when you want to go on.";
  texts.end = "That was all. Thank you.";
  return protocol;
}

Result<schema::Protocol> identification_protocol(const std::string& seed, const NamedTextures& textures,
                                                 const std::vector<std::string>& comparisons) {
  TACTO_TRY(check_several(textures));
  for (const std::string& name : comparisons)
    if (!textures.contains(name))
      return fail(ErrorKind::usage, fmt::format("'{}' is none of the textures", name), "--comparisons",
                  "name those of --textures that are to be presented");
  schema::Protocol protocol = stretch_protocol(seed);
  schema::ProtocolTexts& texts = protocol.texts[schema::kUsualLanguage];
  protocol.task = schema::Task::identification;
  protocol.analysis =
      "Of each participant and condition success and transmitted information; over participants their means.";
  TACTO_TRY(fit_to_textures(protocol, textures, 1));
  protocol.comparisons = comparisons;
  protocol.conditions = {schema::kRealCondition, schema::kVirtualCondition};
  protocol.most_trials = 100;
  protocol.longest_s = 900;
  protocol.repetitions = static_cast<int>(std::ceil(100.0 / static_cast<double>(comparisons.size())));
  protocol.participants = 10;
  for (const std::string& name : protocol.standards)
    protocol.choices.push_back({std::string(1, kAnswerKeys[protocol.choices.size()]), name});
  texts.welcome = "You feel one texture at a time. Say which of the textures before you it is.";
  texts.question = fmt::format("Which one was it? Press its button, {} to {}.", kAnswerKeys.front(),
                               protocol.choices.back().key);
  texts.place = "For the operator: put this sample on the bench, type its label and press Enter.";
  return protocol;
}

Result<schema::Protocol> amplitude_protocol(const std::string& seed, const NamedTextures& textures) {
  if (textures.size() != 1)
    return fail(ErrorKind::usage, fmt::format("takes one texture, but {} are named", textures.size()),
                "--textures", "name one texture; make a study for each of the others");
  schema::Protocol protocol = stretch_protocol(seed);
  schema::ProtocolTexts& texts = protocol.texts[schema::kUsualLanguage];
  protocol.task = schema::Task::amplitude;
  protocol.analysis = "Of each participant the fitted match; over participants its geometric mean.";
  protocol.largest_ratio = 2;
  TACTO_TRY(fit_to_textures(protocol, textures, protocol.largest_ratio));
  protocol.repetitions = 60;
  protocol.choices = {{"a", "-3"}, {"s", "-2"}, {"d", "-1"}, {"f", "0"}, {"j", "1"}, {"k", "2"}, {"l", "3"}};
  texts.welcome =
      "You feel one texture at a time. Say how strong it is, compared with the real sample before you.";
  texts.question =
      "Compared with the real sample, the texture was: a: much weaker (-3), s: weaker (-2), d: a little "
      "weaker "
      "(-1), f: equal (0), j: a little stronger (1), k: stronger (2), l: much stronger (3).";
  return protocol;
}

Result<schema::Protocol> ordering_protocol(const std::string& seed, const NamedTextures& textures,
                                           const std::map<std::string, double>& intended) {
  TACTO_TRY(check_several(textures));
  schema::Protocol protocol = stretch_protocol(seed);
  schema::ProtocolTexts& texts = protocol.texts[schema::kUsualLanguage];
  protocol.task = schema::Task::ordering;
  protocol.analysis =
      "Mean ranks over participants, their Kendall's W, and their correlation with the intended parameter.";
  TACTO_TRY(fit_to_textures(protocol, textures, 1));
  protocol.repetitions = 3;
  for (const std::string& name : protocol.standards) {
    const std::string number(1, kAnswerKeys[protocol.choices.size()]);
    protocol.choices.push_back({number, number});
    if (intended.empty()) continue;
    if (!intended.contains(name))
      return fail(ErrorKind::usage, fmt::format("has no number for {}", name), "--intended",
                  "give one for each texture, in their order");
    protocol.intended.push_back(intended.at(name));
  }
  texts.welcome =
      fmt::format("You feel {} textures, as often as you like, and put them in order of roughness.",
                  protocol.standards.size());
  texts.begin = fmt::format(
      "Put the finger at the left end and press a number, {} to {}, to feel that texture. Press the space "
      "bar "
      "to give the order.",
      kAnswerKeys.front(), protocol.choices.back().key);
  texts.left = "Not explored yet, or not at the right speed";
  texts.question =
      "Press the numbers from the smoothest texture to the roughest one, then the space bar. Backspace takes "
      "one back.";
  return protocol;
}

Result<schema::Protocol> adjustment_protocol(const std::string& seed, const NamedTextures& textures,
                                             const std::string& adjusted, schema::Goal goal) {
  if (textures.size() > (goal == schema::Goal::match ? 2 : 1))
    return fail(ErrorKind::usage, fmt::format("there are {} textures", textures.size()), "--textures",
                "name one to be adjusted; --reference is for the goal match");
  schema::Protocol protocol = stretch_protocol(seed);
  schema::ProtocolTexts& texts = protocol.texts[schema::kUsualLanguage];
  protocol.task = schema::Task::adjustment;
  protocol.analysis =
      "Of each participant the geometric mean of the accepted ratios, of ascending and of descending series; "
      "over participants the mean of both, and their difference.";
  protocol.goal = goal;
  protocol.smallest_ratio = 0.05, protocol.largest_ratio = 4, protocol.step_db = 1;
  TACTO_TRY(fit_to_textures(protocol, textures, protocol.largest_ratio));
  std::ranges::stable_partition(protocol.standards, [&](const auto& name) { return name == adjusted; });
  protocol.repetitions = 10;
  // The finger moves freely, and weak settings are played with the steps of the drive.
  protocol.delivered.slowest_mps = 0.02, protocol.delivered.fastest_mps = 0.12;
  protocol.delivered.error_db = -10;
  protocol.choices = {{"f", "weaker"}, {"j", "stronger"}, {"a", "accepted"}};
  constexpr const char* kWhat[] = {"the weakest setting that still feels like a texture",
                                   "the strongest setting that still feels like a texture",
                                   "the setting that is as strong as the first texture"};
  const char* const what = kWhat[static_cast<int>(goal)];
  texts.welcome = fmt::format("You change how strong a texture is. Find {}.", what);
  if (goal == schema::Goal::match)
    texts.welcome += " You feel the first texture, and then the one that you change.";
  texts.interval = "Move the finger to the right end and back.";
  texts.question = fmt::format(
      "Find {}: f or the arrow down: weaker, j or the arrow up: stronger, a: this is it. Keep moving.", what);
  texts.too_early =
      "Too early: move the finger to the right end and back before you press a. This trial comes again.";
  return protocol;
}

Result<schema::Protocol> fidelity_protocol(const std::string& seed, const NamedTextures& textures) {
  TACTO_TRY(check_several(textures));
  schema::Protocol protocol = stretch_protocol(seed);
  schema::ProtocolTexts& texts = protocol.texts[schema::kUsualLanguage];
  protocol.task = schema::Task::fidelity;
  protocol.analysis =
      "Of each participant d' of 'the same' beside the own and beside another sample; over participants its "
      "mean.";
  TACTO_TRY(fit_to_textures(protocol, textures, 1));
  const double others = static_cast<double>(textures.size()) - 1;
  protocol.repetitions = static_cast<int>(std::max(1.0, std::round(10 / others)));
  protocol.participants = 10;
  protocol.choices = {{"f", "same"}, {"j", "different"}};
  texts.welcome =
      "You feel a texture that is played, and a real sample beside it. Say whether they are the same "
      "texture.";
  texts.question = "Feel the sample beside it. Is it the same texture? f: the same, j: a different one.";
  texts.place = "For the operator: put this sample beside the device, type its label and press Enter.";
  return protocol;
}

void add_pacing_cue(schema::Protocol& protocol) {
  constexpr const char* kFollowMark = " Move as the mark O moves.";
  schema::ProtocolTexts& texts = protocol.texts[schema::kUsualLanguage];
  protocol.pace.cue = true;
  texts.interval += kFollowMark;
  if (protocol.task == schema::Task::adjustment) texts.question += kFollowMark;
}

void add_normal_force(schema::Protocol& protocol, const schema::ForceRange& range) {
  schema::ProtocolTexts& texts = protocol.texts[schema::kUsualLanguage];
  protocol.normal_force = range;
  texts.force_below = "Press harder.";
  texts.force_within = "The force is right.";
  texts.force_above = "Press less hard.";
}

Result<Study> write_study(const std::string& stem, const schema::Protocol& protocol,
                          const NamedTextures& textures, schema::Existing existing) {
  TACTO_TRY(check_plain(protocol.seed, "--seed"));
  for (const std::string& name : protocol.standards) TACTO_TRY(check_plain(name, "--textures"));
  const auto protocol_text = schema::protocol_text(protocol);
  TACTO_TRY(protocol_text);
  Study study{stem, protocol, {stimuli_by_code(protocol), {}}};
  TACTO_TRY(check_stem_of(study));
  TACTO_TRY(check_free(study, existing));
  TACTO_TRY(write_stimuli(study, textures, existing));
  for (schema::CodedStimulus& stimulus : study.key.stimuli) {
    const auto wav = schema::texture_wav(study.stimulus(stimulus.code));
    TACTO_TRY(wav);
    stimulus.sha256 = wav->sha256;
  }
  const auto key_text = schema::protocol_key_text(study.key);
  TACTO_TRY(key_text);
  schema::PendingFiles pending;
  TACTO_TRY(pending.write(schema::key_path(stem), *key_text));
  TACTO_TRY(pending.write(schema::protocol_path(stem), *protocol_text));
  TACTO_TRY(pending.commit(existing));
  return study;
}

Result<Study> read_study(const std::string& name) {
  Study study;
  study.stem = schema::stem_of(name, ".protocol");
  auto protocol = schema::read_protocol(name);
  TACTO_TRY(protocol);
  study.protocol = std::move(*protocol);
  auto key = schema::read_protocol_key(schema::key_path(name));
  TACTO_TRY(key);
  study.key = std::move(*key);
  TACTO_TRY(check_key(study, schema::key_path(name)));
  for (const schema::CodedStimulus& stimulus : study.key.stimuli) TACTO_TRY(check_stimulus(study, stimulus));
  return study;
}

const schema::CodedStimulus& standard_of(const schema::ProtocolKey& key) {
  return *std::ranges::find(key.stimuli, 0.0, &schema::CodedStimulus::stretch);
}

const schema::CodedStimulus& reference_of(const Study& study) {
  return *std::ranges::find(study.key.stimuli, study.protocol.standards.back(), &schema::CodedStimulus::name);
}

const schema::CodedStimulus& stimulus_of(const schema::ProtocolKey& key, const std::string& code) {
  return *std::ranges::find(key.stimuli, code, &schema::CodedStimulus::code);
}

Result<std::vector<std::string>> lost_band(const Study& study) {
  const spatial::Band band = playback::PrepareOptions{}.band;
  std::vector<std::string> notes;
  for (const double speed_mps :
       {study.protocol.delivered.slowest_mps, study.protocol.delivered.fastest_mps}) {
    double least = 100;
    for (const schema::CodedStimulus& stimulus : study.key.stimuli) {
      const auto texture = schema::read_texture(study.stimulus(stimulus.code));
      TACTO_TRY(texture);
      least = std::min(least, spatial::band_kept_percent(*texture, speed_mps, band));
    }
    if (least < playback::kLeastPowerPercent)
      notes.push_back(
          fmt::format("at {} the band of {} to {} keeps only {:.3g} % ({:.1f} dB) of a stimulus' power",
                      schema::for_people(speed_mps, schema::Dimension::speed),
                      schema::for_people(band.low_hz, schema::Dimension::frequency),
                      schema::for_people(band.high_hz, schema::Dimension::frequency), least,
                      10 * std::log10(std::max(least, 1e-28) / 100)));
  }
  return notes;
}

}  // namespace tacto::analysis
