// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/realtime_choices.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/trade/rows/cpu_cost.hpp"
#include "playback/choose/budget_words.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::analysis {
namespace {

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

}  // namespace tacto::analysis
