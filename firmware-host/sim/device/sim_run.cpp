// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/device/sim_run.hpp"

#include <algorithm>
#include <cmath>

#include "firmware-host/sim/bench/force_bench.hpp"
#include "firmware-host/sim/bench/touch_bench.hpp"

namespace tacto::firmware_host {
namespace {

enum Stream : std::uint64_t {
  kSpeedStream = 100,
  kLoadStream,
  kSensorStream,
  kNormalStream,
  kNetStream,
  kPositionStream
};

// ATI Nano17 of Wiertlewski 2011, calibration SI-12-0.12.
constexpr double kNormalRangeN = 17;
constexpr double kTangentialRangeN = 12;

// A quartz cell as in the stinger of a shaker: its resonance is far above the band, its noise below a code.
// Our choice, as the reference for the slow load cell.
constexpr int kReferenceBits = 24;
constexpr double kReferenceRangeN = 10;

constexpr double kLoadKnotS = 0.25;  // ours: the load of a hand wanders below about 1 Hz
constexpr double kLeastLoad = 0.2;   // of the load: a finger in contact stays in contact

// Keeps the whole patch, including the jitter, on the surface.
constexpr double kMarginM = 0.3e-3;

StrokePlan plan_on(const HeightProfile& profile, const SimParameters& parameters) {
  StrokePlan plan = parameters.strokes;
  plan.from_m = parameters.finger.patch_m / 2 + kMarginM;
  plan.to_m = profile.length_m() - plan.from_m;
  return plan;
}

// A noise floor in newtons per root hertz, white up to half the rate, converted to volts at the output. The
// paper gives it as a force; in the flat middle of the band, output and force are proportional.
double noise_rms_v(const SimParameters& parameters, const schema::Transducer& transducer) {
  if (!parameters.noise) return 0;
  return transducer.noise_n_per_sqrt_hz * SensorMotion(transducer).middle_gain_v_per_n() *
         std::sqrt(parameters.sample_rate_hz / 2);
}

std::unique_ptr<Bench> bench_for(const SimParameters& p, const schema::Transducer& transducer,
                                 const HeightProfile& profile, double start_m) {
  const auto mode = p.tray().second_mode;
  if (p.known_force) return std::make_unique<ForceBench>(transducer, p.force, p.sample_rate_hz, mode);
  return std::make_unique<TouchBench>(transducer, p.finger, profile, p.sample_rate_hz, start_m, p.person,
                                      mode);
}

}  // namespace

SimRun::SimRun(const SimParameters& p, const schema::Transducer& transducer, const HeightProfile& profile)
    : parameters_(p),
      path_(plan_on(profile, p), 1 / p.sample_rate_hz, Random(p.seed, kSpeedStream)),
      load_wander_(Random(p.seed, kLoadStream), kLoadKnotS),
      bench_(bench_for(p, transducer, profile, path_.place().position_m)),
      noise_(p.seed, kSensorStream),
      noise_v_(noise_rms_v(p, transducer)),
      converter_(transducer.converter_bits, transducer.converter_range_v),
      normal_cell_(kNormalRangeN, p.sample_rate_hz, p.noise, Random(p.seed, kNormalStream)),
      net_cell_(kTangentialRangeN, p.sample_rate_hz, p.noise, Random(p.seed, kNetStream)),
      count_(count_at(path_.place().position_m)) {
  if (p.known_force) reference_cell_.emplace(kReferenceBits, kReferenceRangeN);
  if (p.has_lvdt)
    lvdt_.emplace(p.lvdt, profile.length_m() / 2, path_.place().position_m, p.sample_rate_hz, p.noise,
                  Random(p.seed, kPositionStream));
}

double SimRun::load_n(const FingerPlace& place) {
  const double time_s = static_cast<double>(frames_) / parameters_.sample_rate_hz;
  const double factor = std::max(kLeastLoad, 1 + parameters_.strokes.wander * load_wander_.at(time_s));
  return parameters_.finger_down ? parameters_.load_n * place.press * factor : 0;
}

std::int32_t SimRun::count_at(double position_m) const {
  return static_cast<std::int32_t>(
      std::floor(parameters_.errors.encoder_gain * position_m / parameters_.encoder_quantum_m));
}

bool SimRun::next(std::span<std::int32_t> frame) {
  const FingerPlace place = path_.step();
  if (!bench_->step(place, load_n(place))) return false;
  ++frames_;
  const BenchReading reading = bench_->reading();
  const BenchErrors& errors = parameters_.errors;
  const double mains_v = mains_at(errors.mains_v, static_cast<double>(frames_) / parameters_.sample_rate_hz);
  frame[0] = converter_.convert(errors.sensor_gain * reading.sensor_v + noise_v_ * noise_.normal() + mains_v);
  count_ = count_at(reading.position_m);
  frame[1] = lvdt_ ? lvdt_->step(reading.position_m) : count_;
  frame[2] = normal_cell_.step(errors.cell_gain * (reading.normal_n + errors.weight_n) + errors.cell_zero_n);
  frame[3] = net_cell_.step(errors.cell_gain * (reading.tangential_n + errors.pull_n) + errors.cell_zero_n);
  if (reference_cell_) frame[4] = reference_cell_->convert(reading.tangential_n);
  return true;
}

}  // namespace tacto::firmware_host
