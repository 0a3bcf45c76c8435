// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/device/sim_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "firmware-host/sim/bench/force_bench.hpp"
#include "firmware-host/sim/physics/lugre_friction.hpp"
#include "firmware-host/sim/physics/ridge_contact.hpp"
#include "firmware-host/sim/physics/runge_kutta.hpp"
#include "firmware-host/sim/physics/sensor_motion.hpp"

namespace tacto::firmware_host {
namespace {

constexpr int kLoadCellBits = 16;
constexpr double kNoiseN = 1.0 / 320;   // ATI Nano17, SI-12-0.12: resolution
constexpr double kNativeRateHz = 1000;  // ours
constexpr double kCutoffHz = 200;       // ours: well below half of the native rate

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

// States: position and speed of the pulp, bristles, and the state of the sensor (SensorState). The bone
// pulls the pulp through spring and damper; friction and slopes act on the pulp and, with the opposite sign,
// on the tray:
//   m_f x_f'' = k_f (X - x_f) + c_f (X' - x_f') - f_d,   f_d = mu(z, x_f' - x') N + sum p_i h'_i(x_f - x).
// Runge-Kutta steps of at most 12.5 us, ten to twenty per period of the fastest mode (a sticking pulp on its
// bristles, about 700 Hz).
class TouchBench final : public Bench {
 public:
  TouchBench(const schema::Transducer& transducer, const FingerParameters& finger,
             const HeightProfile& profile, double sample_rate_hz, double start_m, std::uint64_t seed,
             const std::optional<SecondMode>& second_mode = std::nullopt);

  // Diverged: a value that is not a number, or a distance of more than the patch between pulp and bone.
  bool step(const FingerPlace& bone, double load_n) override;
  BenchReading reading() const override { return reading_; }

 private:
  using State = OdeState<8>;
  struct Drag {
    double position_m, speed_mps, load_n;
  };
  double tray_force_n(const State& state, double load_n, double& bristle_rate_mps);
  State rate(const State& state, const Drag& drag);
  bool sane(const State& state, double bone_m) const;

  FingerParameters finger_;
  SensorMotion sensor_;
  RidgeContact ridges_;
  double period_s_;
  int substeps_;
  State state_{};
  BenchReading reading_;
};

enum : std::size_t {
  kPulpM,
  kPulpMps,
  kBristleM,
  kBenchTrayM,
  kBenchTrayMps,
  kChargeLagN,
  kBenchInnerM,
  kBenchInnerMps
};

SensorState sensor_part(const OdeState<8>& s) {
  return {s[kBenchTrayM], s[kBenchTrayMps], s[kChargeLagN], s[kBenchInnerM], s[kBenchInnerMps]};
}

TouchBench::TouchBench(const schema::Transducer& transducer, const FingerParameters& finger,
                       const HeightProfile& profile, double sample_rate_hz, double start_m,
                       std::uint64_t seed, const std::optional<SecondMode>& second_mode)
    : finger_(finger),
      sensor_(transducer, second_mode),
      ridges_(finger, profile, seed),
      period_s_(1 / sample_rate_hz),
      substeps_(substeps_in(period_s_)) {
  state_[kPulpM] = start_m;
}

double TouchBench::tray_force_n(const State& s, double load_n, double& bristle_rate_mps) {
  const LugreFriction friction = lugre_friction(finger_, s[kBristleM], s[kPulpMps] - s[kBenchTrayMps]);
  bristle_rate_mps = friction.bristle_rate_mps;
  return friction.coefficient * load_n + ridges_.slope_force_n(s[kPulpM] - s[kBenchTrayM], load_n);
}

TouchBench::State TouchBench::rate(const State& s, const Drag& bone) {
  double bristle_rate_mps = 0;
  const double force_n = tray_force_n(s, bone.load_n, bristle_rate_mps);
  const double pull_n = finger_.stiffness_n_per_m * (bone.position_m - s[kPulpM]) +
                        finger_.damping_n_s_per_m * (bone.speed_mps - s[kPulpMps]);
  const SensorState sensor = sensor_.rate(sensor_part(s), force_n);
  return {s[kPulpMps],      (pull_n - force_n) / finger_.mass_kg,
          bristle_rate_mps, sensor.tray_m,
          sensor.tray_mps,  sensor.charge_lag_n,
          sensor.inner_m,   sensor.inner_mps};
}

bool TouchBench::sane(const State& s, double bone_m) const {
  double sum = 0;
  for (const double value : s) sum += value;
  return std::isfinite(sum) && std::abs(s[kPulpM] - bone_m) < finger_.patch_m;
}

bool TouchBench::step(const FingerPlace& bone, double load_n) {
  const double h = period_s_ / substeps_;
  State state = state_;
  for (int i = 0; i < substeps_; ++i) {
    const double start_m = bone.position_m - bone.speed_mps * h * (substeps_ - i);
    state = runge_kutta_step(state, h, [&](const State& s, double part) {
      return rate(s, {start_m + bone.speed_mps * h * part, bone.speed_mps, load_n});
    });
  }
  if (!sane(state, bone.position_m)) return false;
  state_ = state;
  double bristle_rate_mps = 0;
  reading_ = {sensor_.output_v(sensor_part(state)), tray_force_n(state, load_n, bristle_rate_mps), load_n,
              bone.position_m};
  return true;
}

std::unique_ptr<Bench> bench_for(const SimParameters& p, const schema::Transducer& transducer,
                                 const HeightProfile& profile, double start_m) {
  const auto mode = p.tray().second_mode;
  if (p.known_force) return std::make_unique<ForceBench>(transducer, p.force, p.sample_rate_hz, mode);
  return std::make_unique<TouchBench>(transducer, p.finger, profile, p.sample_rate_hz, start_m, p.person,
                                      mode);
}

}  // namespace

LoadCell::LoadCell(double range_n, double sample_rate_hz, bool noise, Random random)
    : converter_(kLoadCellBits, range_n),
      random_(random),
      every_(std::max(1, static_cast<int>(std::lround(sample_rate_hz / kNativeRateHz)))),
      native_rate_hz_(sample_rate_hz / every_),
      follow_(1 / (1 + sample_rate_hz / (2 * std::numbers::pi * kCutoffHz))),
      noise_n_(noise ? kNoiseN : 0) {}

std::int32_t LoadCell::step(double force_n) {
  filtered_n_ += follow_ * (force_n - filtered_n_);
  if (until_next_-- > 0) return held_;
  until_next_ = every_ - 1;
  held_ = converter_.convert(filtered_n_ + noise_n_ * random_.normal());
  return held_;
}

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
