// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/realtime_half.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "analysis/trade/rows/cpu_cost.hpp"
#include "analysis/trade/rows/played_speeds.hpp"
#include "analysis/trade/rows/trade_row.hpp"
#include "firmware-host/sim/device/sim_device.hpp"
#include "playback/choose/budget_words.hpp"
#include "playback/host-loop/host_loop.hpp"
#include "playback/model/spatial_content.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/prepare/upload.hpp"

namespace tacto::analysis {
namespace {

using firmware_host::Client;
using playback::Inverse;
using playback::PrepareOptions;
using schema::Result;

constexpr double kTickPoints[] = {2.2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 32, 40, 48, 64};
constexpr double kMostTickPoints = 200, kFinerStep = 0.96;
constexpr wire::Interpolation kReadings[] = {wire::Interpolation::nearest, wire::Interpolation::linear,
                                             wire::Interpolation::hermite, wire::Interpolation::sinc};
constexpr int kPlacesBetween = 509;  // prime, so that the places are also between the phases of sinc's table
constexpr int kTicksPerBatch = 4000, kBatches = 41;
constexpr std::uint16_t kFewTaps = 16, kManyTaps = 128;

// For a sine and a cosine; the sum of their squares is twice the mean over all phases.
double error_at_place(wire::Interpolation kind, double radians, double u) {
  double sum = 0;
  for (const double phase : {0.0, 0.5 * std::numbers::pi}) {
    float y[core::kReach];
    for (int i = 0; i < core::kReach; ++i)
      y[i] = static_cast<float>(std::sin(radians * (i - core::kBefore) + phase));
    const double miss = core::interpolated(kind, y, static_cast<float>(u)) - std::sin(radians * u + phase);
    sum += miss * miss;
  }
  return std::sqrt(sum);
}

double worst_error(wire::Interpolation kind, double points_per_period) {
  double worst = 0;
  for (int i = 0; i < kPlacesBetween; ++i)
    worst = std::max(worst, error_at_place(kind, 2 * std::numbers::pi / points_per_period,
                                           static_cast<double>(i) / kPlacesBetween));
  return worst;
}

// The largest error at so many points per period or more: sinc's error is largest at ten, and lower
// frequencies have more points per period.
std::vector<schema::ErrorPoint> errors_of(wire::Interpolation kind) {
  std::vector<schema::ErrorPoint> errors;
  double worst = 0, points = kMostTickPoints;
  for (auto point = std::rbegin(kTickPoints); point != std::rend(kTickPoints); ++point) {
    for (; points > *point; points *= kFinerStep) worst = std::max(worst, worst_error(kind, points));
    worst = std::max(worst, worst_error(kind, *point));
    errors.push_back({*point, worst});
  }
  std::ranges::reverse(errors);
  return errors;
}

// A loop of 40 mm with content up to 31 /mm, of which a finger at 0.1 m/s uses two levels.
playback::Prepared measured_texture(wire::Interpolation kind) {
  schema::Texture texture;
  texture.signal.pitch_m = 1e-6;
  for (int i = 0; i < 40000; ++i) {
    double force_n = 0;
    for (const double per_m : {325.0, 2675.0, 11e3, 31e3})
      force_n += 0.01 * std::sin(2 * std::numbers::pi * per_m * i * 1e-6);
    texture.signal.values.push_back(force_n);
  }
  playback::PrepareOptions options;
  options.rate_hz = 10e3;
  options.ends = playback::Ends::loop;
  options.seam_m = 0;
  options.interpolation = kind;
  options.inverse = playback::Inverse::gain;
  return *playback::prepare(texture, *schema::read_transducer("wiertlewski2011"), options);
}

/// A kernel under a finger whose motion continues from batch to batch.
struct MovingFinger {
  core::TickKernel kernel;
  std::int32_t count = 0;
  float kept = 0;  // keeps the result, so that the compiler does not remove the computation
  void run() {
    float sum = 0;
    for (int i = 0; i < kTicksPerBatch; ++i)
      sum += kernel.tick({count += 10, 1e-3F, true, core::kNoForce}).drive_v;
    kept = sum;
  }
};

wire::Hysteresis sixteen_plays() {
  wire::Hysteresis play_operators;
  play_operators.count = wire::kMaxPlays;
  for (std::size_t i = 0; i < wire::kMaxPlays; ++i)
    play_operators.play_operators[i] = {0.05F * static_cast<float>(i + 1), -0.01F};
  return play_operators;
}

/// All timed objects, which must not move in memory.
struct TimedKernels {
  TimedKernels() {
    for (const auto kind : kReadings) textures.push_back(measured_texture(kind));
    for (const playback::Prepared& texture : textures) add(texture, 0, false);
    add(textures[2], kFewTaps, false);
    add(textures[2], kManyTaps, false);
    add(textures[2], 0, true);
  }
  void add(const playback::Prepared& texture, std::uint16_t tap_count, bool undoes_hysteresis) {
    core::KernelSetup setup = texture.setup();
    setup.taps = taps.data();
    setup.tap_count = tap_count;
    setup.hysteresis = undoes_hysteresis ? &play_operators : nullptr;
    setup.sections = &section;
    setup.section_count = undoes_hysteresis ? 1 : 0;
    kernels.emplace_back().kernel.set(setup);
  }
  std::vector<std::vector<double>> costs_ns() {
    std::vector<std::function<void()>> works;
    for (MovingFinger& each : kernels) works.emplace_back([&each] { each.run(); });
    return costs_in_turns_ns(works, kTicksPerBatch, kBatches);
  }

  std::vector<playback::Prepared> textures;
  std::vector<float> taps = std::vector<float>(kManyTaps, 0.01F);
  wire::Hysteresis play_operators = sixteen_plays();
  wire::Section section{2, -1, 0, 0, 0};
  std::vector<MovingFinger> kernels;
};

// The knob "loop": only latency and memory are reported. Error and cost of a loop are not measured here, so
// neither loop is judged.

constexpr double kMeasuredS = 0.5, kListenS = 0.02;
constexpr double kQueueS = 4e-3;  // HostLoop keeps this much drive in the device's queue
constexpr const char* kLoopKnob = "loop";

Result<void> play_on(Client& client, const playback::Prepared& prepared) {
  if (auto sent = playback::upload(client, prepared); !sent) return sent;
  if (auto armed = client.command(wire::Arm{wire::DriveSource::profile, prepared.rate_millihertz()}); !armed)
    return armed;
  if (auto playing = client.command(wire::Play{}); !playing) return playing;
  for (const double end_s = client.transport().now_s() + kMeasuredS; client.transport().now_s() < end_s;) {
    TACTO_TRY(client.heartbeat());
    TACTO_TRY(client.receive(kListenS));
    (void)client.take_ticks();
  }
  return client.command(wire::Disarm{});
}

Result<playback::EdgeToDrive> measured_latency(const playback::Prepared& prepared) {
  auto device = firmware_host::make_sim_device("sim:paced=1", "paced=1,speed=40mm/s");
  TACTO_TRY(device);
  auto loop = playback::HostLoop::begin((*device)->client(), {prepared.rate_hz, 50, 1000});
  TACTO_TRY(loop);
  auto client = Client::connect((*loop)->transport(), "sim:");
  TACTO_TRY(client);
  TACTO_TRY(play_on(**client, prepared));
  return (*loop)->latency();
}

// The device's loop reads and drives in one tick: half a tick of waiting on average, and the tick.
TradeRow device_loop_row(const playback::Prepared& prepared, double tick_ns) {
  TradeRow row{kLoopKnob, "device", kNotMeasured, 0, "tick", static_cast<double>(prepared.built.sample_bytes),
               0,         {}};
  row.latency_s = 0.5 / prepared.rate_hz + 1e-9 * tick_ns;
  row.note =
      "reads and drives in one tick: half a tick of waiting, and the tick's time on this computer; only the "
      "latency is given";
  return row;
}

// The loop of this computer with an emulated device that runs in real time, for half a second: measured,
// with the wire's round trip; with the real-time scheduler only if the user has the right. If it cannot be
// measured, the note gives the reason, and the latency is that of the loop's queue alone.
TradeRow host_loop_row(const playback::Prepared& prepared) {
  TradeRow row{kLoopKnob, "host", kNotMeasured, 0, "tick", static_cast<double>(prepared.built.sample_bytes),
               kQueueS,   {}};
  const auto latency = measured_latency(prepared);
  if (!latency || !(latency->p50_s > 0)) {
    row.note = "not measured: " + (latency ? "no drive was sent" : schema::message(latency.error()));
    return row;
  }
  row.latency_s = latency->p50_s;
  row.note = fmt::format("on an emulated device: p50; p99 is {:.2g} ms; only the latency was measured",
                         1e3 * latency->p99_s);
  return row;
}

constexpr double kDensities[] = {6, 8, 12, 16, 24, 48};
constexpr double kSlow_mps[] = {0.01}, kFast_mps[] = {0.5};
constexpr double kRates[] = {1e3, 2e3, 5e3, 10e3, 20e3};
constexpr std::pair<const char*, Inverse> kInverses[] = {{"none", Inverse::none},
                                                         {"gain", Inverse::gain},
                                                         {"magnitude", Inverse::magnitude},
                                                         {"full", Inverse::full}};

PlayedCase reading_case(PlayedCase played, wire::Interpolation kind, double density) {
  played.part = PlayedPart::reading;
  played.options.inverse = Inverse::gain;
  played.options.interpolation = kind;
  played.options.samples_per_period = density;
  return played;
}

// Sixteen play operators of equal weight, which open the loop by a sixth between the limits.
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

// Plays cases of one texture and makes rows from them.
class RealtimeTrade {
 public:
  RealtimeTrade(const schema::Texture& texture, const schema::Transducer& transducer,
                const std::function<void(double)>& progress)
      : texture_(texture), transducer_(transducer), progress_(progress) {}

  Result<std::vector<TradeRow>> rows() {
    TACTO_TRY(check_content());
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
      if (!line.row.by_speed.empty() && !line.row.is_judged())
        line.row.note = "nothing of the texture is in the band at " + speed_words(line.row.by_speed);
      rows.push_back(std::move(line.row));
    }
    return rows;
  }

 private:
  using Part = void (RealtimeTrade::*)();

  static PlayedCase usual() {
    PlayedCase played;
    played.options.metres_per_count = kTrueEncoderM;
    return played;
  }
  // A row and the index of its timed ticks; rows of several knobs may share one timing.
  struct Line {
    TradeRow row;
    std::optional<std::size_t> work;
    double times = 1;  // factor on the time of a tick
    std::string refusal = {};
  };
  TradeRow& put(const std::string& knob, const std::string& choice, const PlayedSpeeds& played) {
    const PlayedOutcome& outcome = played.middle();
    TradeRow row{knob, choice, 0, 0, "tick", outcome.memory_bytes, outcome.delay_left_s, {}, played.errors()};
    row.error = worst_of(row.by_speed);
    lines_.push_back({std::move(row), works_.size()});
    works_.push_back(outcome.ticking);
    ticks_.push_back(outcome.ticks);
    return lines_.back().row;
  }
  // A refused choice has an error of 1.
  TradeRow& take(const std::string& knob, const std::string& choice, const Result<PlayedSpeeds>& played) {
    if (played) return put(knob, choice, *played);
    lines_.push_back(
        {{knob, choice, 1, 0, "tick", 0, 0, {}}, std::nullopt, 1, "refused: " + played.error().what});
    return lines_.back().row;
  }
  Result<PlayedSpeeds> play(const PlayedCase& played) const {
    return PlayedSpeeds::of(texture_, transducer_, played);
  }
  TradeRow& add(const std::string& knob, const std::string& choice, const PlayedCase& played) {
    return take(knob, choice, play(played));
  }
  // A row of another knob for the ticks of the last line.
  TradeRow& again(const std::string& knob, const std::string& choice) {
    lines_.push_back(lines_.back());
    lines_.back().row.knob = knob, lines_.back().row.choice = choice;
    return lines_.back().row;
  }

  void add_readings() {
    for (const auto kind : kReadings)
      add("interpolation", std::string(playback::to_string(kind)), reading_case(usual(), kind, 16)).note =
          "16 samples per period; only the error of the interpolated force";
    for (const double density : kDensities)
      add("samples per period", fmt::format("{:g}", density),
          reading_case(usual(), wire::Interpolation::hermite, density))
          .note = "hermite; only the error of the interpolated force";
  }

  void add_densities() {
    for (const auto kind : kReadings)
      for (const double density : kDensities)
        add("interpolation x samples per period", fmt::format("{}, {:g}", playback::to_string(kind), density),
            reading_case(usual(), kind, density))
            .note = "only the error of the interpolated force";
  }

  void add_inverses() {
    for (const auto& [word, inverse] : kInverses) {
      PlayedCase played = usual();
      played.options.inverse = inverse;
      const auto outcomes = play(played);
      take("inverse", word, outcomes);
      if (!outcomes) continue;
      TradeRow& row = again("inverse, amplitudes only", word);
      row.by_speed = outcomes->errors(&PlayedOutcome::amplitude_error);
      row.error = worst_of(row.by_speed);
      row.note = "whatever the phases";
    }
    for (const double delay_s : {0.5e-3, 1e-3, 2e-3, 3e-3, 4e-3}) {
      PlayedCase played = usual();
      played.options.delay_s = delay_s;
      add("inverse delay", fmt::format("{:g} ms", 1e3 * delay_s), played).note =
          "compensated by looking ahead";
    }
  }

  void add_looking_ahead() {
    for (const bool ahead : {true, false}) {
      PlayedCase played = usual();
      played.way.wanders = true;
      played.options.look_ahead = ahead;
      const auto outcomes = play(played);
      TradeRow& row = take("look ahead", ahead ? "on" : "off", outcomes);
      row.note = "speed wanders by 10 %";
      if (outcomes && !ahead)
        row.note += fmt::format("; re the target {:g} ms earlier its error is {}",
                                1e3 * outcomes->middle().delay_left_s,
                                playback::percent(worst_of(outcomes->errors(&PlayedOutcome::later_error))));
    }
  }

  void add_counts() {
    for (const double step_m : {1e-6, 10e-6})
      for (const bool between : {true, false}) {
        PlayedCase played = usual();
        played.options.metres_per_count = step_m;
        played.options.between_counts = between;
        take("between counts", fmt::format("{}, {:g} um encoder", between ? "on" : "off", 1e6 * step_m),
             PlayedSpeeds::of(texture_, transducer_, played, kSlow_mps))
            .note = "a finger at 10 mm/s";
      }
  }

  // Tick rates are compared by the cost per millisecond of playback.
  void add_rates() {
    for (const double rate_hz : kRates) {
      const std::size_t first = lines_.size();
      add_rate(rate_hz);
      for (std::size_t i = first; i < lines_.size(); ++i) {
        lines_[i].times = 1e-3 * rate_hz;
        lines_[i].row.per = "ms";
      }
    }
  }

  void add_rate(double rate_hz) {
    const std::string rate = fmt::format("{:g} kHz", 1e-3 * rate_hz);
    PlayedCase played = usual();
    played.options.rate_hz = rate_hz;
    add("tick rate", rate, played);
    again("tick rate x inverse", rate + ", full");
    again("tick rate x delay compensation", rate + ", on");
    played.options.look_ahead = false;
    add("tick rate x delay compensation", rate + ", off", played);
    played.options.look_ahead = true;
    for (const auto& [word, inverse] : {kInverses[1], kInverses[2]}) {
      played.options.inverse = inverse;
      add("tick rate x inverse", rate + ", " + word, played);
    }
  }

  // With one level, the texture's detail that is too fine for the speed aliases.
  void add_pyramids() {
    const double finest_per_m = playback::highest_spatial_frequency(texture_.signal);
    for (const bool all : {true, false}) {
      PlayedCase played = usual();
      if (!all)
        played.options.max_speed_mps = std::clamp(played.options.band.high_hz / finest_per_m, 1e-4, 10.0);
      take("pyramid", all ? "all levels" : "one level",
           PlayedSpeeds::of(texture_, transducer_, played, kFast_mps))
          .note = "a finger at 500 mm/s";
    }
  }

  void add_precisions() {
    PlayedCase played = usual();
    const auto single = play(played);
    played.in_double = true;
    const auto exact = play(played);
    if (!single || !exact) return;
    const std::vector<float>&quick = single->middle().drive_v, &slow = exact->middle().drive_v;
    double off = 0, size = 0;
    for (std::size_t i = 0; i < slow.size(); ++i) {
      off += std::pow(double{quick[i]} - slow[i], 2);
      size += std::pow(slow[i], 2);
    }
    put("precision", "single", *single).note =
        fmt::format("drive differs from double's by {:.1g} of its RMS", std::sqrt(off / size));
    put("precision", "double", *exact).note = "the reference, not optimised for speed";
  }

  void add_hysteresis() {
    schema::Transducer bender = transducer_;
    if (!bender.hysteresis) bender.hysteresis = usual_hysteresis(bender.drive_limit_v);
    for (const bool undone : {true, false}) {
      PlayedCase played = usual();
      played.options.undo_hysteresis = undone;
      take("hysteresis", undone ? "undone" : "kept", PlayedSpeeds::of(texture_, bender, played)).note =
          transducer_.hysteresis ? "as the transducer's file has it"
                                 : "assumed: a bender of 16 play operators";
    }
  }

  // In turns, so that other load on the machine affects all cases equally.
  void clock_all() {
    constexpr int kTurns = 41;
    const auto costs = median_costs_ns(works_, 1, kTurns);
    for (Line& line : lines_)
      if (line.work) line.row.cost_ns = line.times * costs[*line.work] / ticks_[*line.work];
  }

  Result<void> check_content() const {
    const auto played = play(reading_case(usual(), wire::Interpolation::hermite, 16));
    TACTO_TRY(played);
    if (!std::isnan(worst_of(played->errors()))) return {};
    return schema::fail(schema::ErrorKind::unsuitable,
                        "has nothing within 15 to 500 Hz at " + speed_words(played->errors()), "the texture",
                        "use a texture with content in that band");
  }

  void add_loops() {
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

  const schema::Texture& texture_;
  const schema::Transducer& transducer_;
  const std::function<void(double)>& progress_;
  std::vector<Line> lines_;
  std::vector<std::function<void()>> works_;
  std::vector<double> ticks_;  // number of ticks of each work
};

}  // namespace

std::vector<schema::MeasuredChoice> measure_reading_choices() {
  TimedKernels timed;
  const auto costs_ns = timed.costs_ns();
  std::vector<schema::MeasuredChoice> choices;
  for (std::size_t i = 0; i < std::size(kReadings); ++i)
    choices.push_back({"reading", std::string(playback::to_string(kReadings[i])), "tick",
                       median_cost(costs_ns[i]), 0, errors_of(kReadings[i])});
  const auto &hermite_ns = costs_ns[2], &few_ns = costs_ns[4], &many_ns = costs_ns[5],
             &undone_ns = costs_ns[6];
  choices.push_back({"inverse",
                     "tap",
                     "tap",
                     std::max(0.0, median_difference(many_ns, few_ns) / (kManyTaps - kFewTaps)),
                     0,
                     {}});
  choices.push_back(
      {"hysteresis", "undone", "tick", std::max(0.0, median_difference(undone_ns, hermite_ns)), 0, {}});
  return choices;
}

Result<std::vector<TradeRow>> measure_realtime(const schema::Texture& texture,
                                               const schema::Transducer& transducer,
                                               const std::function<void(double)>& progress) {
  return RealtimeTrade(texture, transducer, progress).rows();
}

}  // namespace tacto::analysis
