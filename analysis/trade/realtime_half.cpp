// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/realtime_half.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/trade/cpu_cost.hpp"
#include "analysis/trade/loop_latency.hpp"
#include "analysis/trade/played_case.hpp"
#include "playback/budget_words.hpp"
#include "playback/reference/spatial_content.hpp"

namespace tacto::analysis {
namespace {

using playback::Inverse;
using playback::PrepareOptions;
using schema::Result;

constexpr wire::Interpolation kKinds[] = {wire::Interpolation::nearest, wire::Interpolation::linear,
                                          wire::Interpolation::hermite, wire::Interpolation::sinc};
constexpr double kDensities[] = {6, 8, 12, 16, 24, 48};
constexpr double kRates[] = {1e3, 2e3, 5e3, 10e3, 20e3};
constexpr std::pair<const char*, Inverse> kInverses[] = {{"none", Inverse::none},
                                                         {"gain", Inverse::gain},
                                                         {"magnitude", Inverse::magnitude},
                                                         {"full", Inverse::full}};

/// Plays cases of one texture and makes rows of them.
class RealtimeTrade {
 public:
  RealtimeTrade(const schema::Texture& texture, const schema::Transducer& transducer,
                const std::function<void(double)>& progress)
      : texture_(texture), transducer_(transducer), progress_(progress) {}

  Result<std::vector<TradeRow>> rows();

 private:
  using Part = void (RealtimeTrade::*)();

  static PlayedCase usual() {
    PlayedCase played;
    played.options.metres_per_count = kTrueEncoderM;
    return played;
  }
  // A row, and whose ticks it costs: rows of other knobs can be of the same ticks.
  struct Line {
    TradeRow row;
    std::optional<std::size_t> work;
    double times = 1;  // what they take
    std::string refusal = {};
  };
  TradeRow& put(const std::string& knob, const std::string& choice, const PlayedOutcome& outcome) {
    lines_.push_back(
        {{knob, choice, outcome.error, 0, "tick", outcome.memory_bytes, outcome.delay_left_s, {}},
         works_.size()});
    works_.push_back(outcome.ticking);
    ticks_.push_back(outcome.ticks);
    return lines_.back().row;
  }
  // What is refused has nothing right.
  TradeRow& take(const std::string& knob, const std::string& choice, const Result<PlayedOutcome>& outcome) {
    if (outcome) return put(knob, choice, *outcome);
    lines_.push_back(
        {{knob, choice, 1, 0, "tick", 0, 0, {}}, std::nullopt, 1, "refused: " + outcome.error().what});
    return lines_.back().row;
  }
  TradeRow& add(const std::string& knob, const std::string& choice, const PlayedCase& played) {
    return take(knob, choice, play_case(texture_, transducer_, played));
  }

  void add_readings();
  void add_densities();
  void add_inverses();
  void add_looking_ahead();
  void add_counts();
  void add_rates();
  void add_pyramids();
  void add_precisions();
  void add_hysteresis();
  void clock_all();
  void add_loops();

  const schema::Texture& texture_;
  const schema::Transducer& transducer_;
  const std::function<void(double)>& progress_;
  std::vector<Line> lines_;
  std::vector<std::function<void()>> works_;
  std::vector<double> ticks_;  // of each
};

PlayedCase reading_case(PlayedCase played, wire::Interpolation kind, double density) {
  played.part = PlayedPart::reading;
  played.options.inverse = Inverse::gain;
  played.options.interpolation = kind;
  played.options.samples_per_period = density;
  return played;
}

void RealtimeTrade::add_readings() {
  for (const auto kind : kKinds)
    add("interpolation", std::string(playback::word_of(kind)), reading_case(usual(), kind, 16)).note =
        "16 samples a period; the read force alone";
  for (const double density : kDensities)
    add("samples per period", fmt::format("{:g}", density),
        reading_case(usual(), wire::Interpolation::hermite, density))
        .note = "hermite; the read force alone";
}

void RealtimeTrade::add_densities() {
  for (const auto kind : kKinds)
    for (const double density : kDensities)
      add("interpolation x samples per period", fmt::format("{}, {:g}", playback::word_of(kind), density),
          reading_case(usual(), kind, density))
          .note = "the read force alone";
}

void RealtimeTrade::add_inverses() {
  for (const auto& [word, inverse] : kInverses) {
    PlayedCase played = usual();
    played.options.inverse = inverse;
    const auto outcome = play_case(texture_, transducer_, played);
    take("inverse", word, outcome);
    if (!outcome) continue;
    lines_.push_back(lines_.back());
    TradeRow& row = lines_.back().row;
    row.knob = "inverse, amplitudes alone";
    row.error = outcome->amplitude_error;
    row.note = "whatever the phases";
  }
  for (const double delay_s : {0.5e-3, 1e-3, 2e-3, 3e-3, 4e-3}) {
    PlayedCase played = usual();
    played.options.delay_s = delay_s;
    add("inverse delay", fmt::format("{:g} ms", 1e3 * delay_s), played).note = "taken back by looking ahead";
  }
}

void RealtimeTrade::add_looking_ahead() {
  for (const bool ahead : {true, false}) {
    PlayedCase played = usual();
    played.way = FingerWay::wandering;
    played.options.look_ahead = ahead;
    const auto outcome = play_case(texture_, transducer_, played);
    TradeRow& row = take("look ahead", ahead ? "on" : "off", outcome);
    row.note = "speed wanders by 10 %";
    if (outcome && !ahead)
      row.note += fmt::format("; re what was wanted {:g} ms before it errs by {}",
                              1e3 * outcome->delay_left_s, playback::percent(outcome->later_error));
  }
}

void RealtimeTrade::add_counts() {
  for (const double step_m : {1e-6, 10e-6})
    for (const bool between : {true, false}) {
      PlayedCase played = usual();
      played.way = FingerWay::slow;
      played.options.metres_per_count = step_m;
      played.options.between_counts = between;
      add("between counts", fmt::format("{}, {:g} um encoder", between ? "on" : "off", 1e6 * step_m), played)
          .note = "a finger at 10 mm/s";
    }
}

// Ticks of other rates are compared by what a millisecond of playing costs.
void RealtimeTrade::add_rates() {
  const std::size_t first = lines_.size();
  for (const double rate_hz : kRates) {
    const std::string rate = fmt::format("{:g} kHz", 1e-3 * rate_hz);
    PlayedCase played = usual();
    played.options.rate_hz = rate_hz;
    add("tick rate", rate, played);
    Line alone = lines_.back();
    for (const auto& [word, inverse] : {kInverses[1], kInverses[2]}) {
      played.options.inverse = inverse;
      add("tick rate x inverse", rate + ", " + word, played);
    }
    alone.row.knob = "tick rate x inverse", alone.row.choice += ", full";
    lines_.push_back(alone);
  }
  for (std::size_t i = first; i < lines_.size(); ++i) {
    const double rate_hz = kRates[(i - first) * std::size(kRates) / (lines_.size() - first)];
    lines_[i].times = 1e-3 * rate_hz;
    lines_[i].row.per = "ms";
  }
}

// One level holds all of the texture: what is too fine for the speed folds.
void RealtimeTrade::add_pyramids() {
  const double finest_per_m = playback::highest_spatial_frequency(texture_.signal);
  for (const bool all : {true, false}) {
    PlayedCase played = usual();
    played.way = FingerWay::fast;
    if (!all)
      played.options.max_speed_mps = std::clamp(played.options.band.high_hz / finest_per_m, 1e-4, 10.0);
    add("pyramid", all ? "all levels" : "one level", played).note = "a finger at 500 mm/s";
  }
}

void RealtimeTrade::add_precisions() {
  PlayedCase played = usual();
  const auto single = play_case(texture_, transducer_, played);
  played.in_double = true;
  const auto exact = play_case(texture_, transducer_, played);
  if (!single || !exact) return;
  double off = 0, size = 0;
  for (std::size_t i = 0; i < exact->drive_v.size(); ++i) {
    off += std::pow(double{single->drive_v[i]} - exact->drive_v[i], 2);
    size += std::pow(exact->drive_v[i], 2);
  }
  put("precision", "single", *single).note =
      fmt::format("drive differs from double's by {:.1g} of its RMS", std::sqrt(off / size));
  put("precision", "double", *exact).note = "the reference, which is not written for speed";
}

// Sixteen plays of equal weight, that open the loop by a sixth between the limits.
schema::Hysteresis usual_hysteresis(double limit_v) {
  constexpr int kPlays = 16;
  constexpr double kWeight = 0.04, kStraight = 0.68;
  schema::Hysteresis law{{0}, {kStraight}};
  for (int i = 0; i < kPlays; ++i) {
    law.thresholds_v.push_back(limit_v * (i + 0.5) / kPlays);
    law.weights.push_back(kWeight);
  }
  return law;
}

void RealtimeTrade::add_hysteresis() {
  schema::Transducer bender = transducer_;
  if (!bender.hysteresis) bender.hysteresis = usual_hysteresis(bender.drive_limit_v);
  for (const bool undone : {true, false}) {
    PlayedCase played = usual();
    played.options.undo_hysteresis = undone;
    take("hysteresis", undone ? "undone" : "kept", play_case(texture_, bender, played)).note =
        transducer_.hysteresis ? "as the transducer's file has it" : "a bender of 16 plays, assumed";
  }
}

// In turns, so that a machine that is busy meanwhile is so for all: what is compared was measured together.
void RealtimeTrade::clock_all() {
  constexpr int kTurns = 41;
  const auto costs = median_costs_ns(works_, 1, kTurns);
  for (Line& line : lines_)
    if (line.work) line.row.cost_ns = line.times * costs[*line.work] / ticks_[*line.work];
}

void RealtimeTrade::add_loops() {
  PrepareOptions options;
  options.ends = playback::Ends::loop;
  const auto prepared = playback::prepare(texture_, transducer_, options);
  if (!prepared) return;
  const auto usual_tick = std::ranges::find_if(
      lines_, [](const Line& line) { return line.row.knob == "inverse" && line.row.choice == "full"; });
  const double tick_ns = usual_tick == lines_.end() ? 0 : usual_tick->row.cost_ns;
  lines_.push_back({device_loop_row(*prepared, tick_ns), std::nullopt});
  lines_.push_back({host_loop_row(*prepared), std::nullopt});
}

Result<std::vector<TradeRow>> RealtimeTrade::rows() {
  if (const auto playable =
          play_case(texture_, transducer_, reading_case(usual(), wire::Interpolation::hermite, 16));
      !playable)
    return schema::forward_error(playable);
  constexpr Part kParts[] = {
      &RealtimeTrade::add_readings,      &RealtimeTrade::add_densities,  &RealtimeTrade::add_inverses,
      &RealtimeTrade::add_looking_ahead, &RealtimeTrade::add_counts,     &RealtimeTrade::add_rates,
      &RealtimeTrade::add_pyramids,      &RealtimeTrade::add_precisions, &RealtimeTrade::add_hysteresis,
      &RealtimeTrade::clock_all,         &RealtimeTrade::add_loops};
  for (std::size_t i = 0; i < std::size(kParts); ++i) {
    (this->*kParts[i])();
    if (progress_) progress_(static_cast<double>(i + 1) / static_cast<double>(std::size(kParts)));
  }
  std::vector<TradeRow> rows;
  for (Line& line : lines_) {
    if (!line.refusal.empty()) line.row.note = line.refusal;
    rows.push_back(std::move(line.row));
  }
  return rows;
}

}  // namespace

Result<std::vector<TradeRow>> measure_realtime(const schema::Texture& texture,
                                               const schema::Transducer& transducer,
                                               const std::function<void(double)>& progress) {
  return RealtimeTrade(texture, transducer, progress).rows();
}

}  // namespace tacto::analysis
