// SPDX-License-Identifier: GPL-3.0-or-later
// Sweep and slow loops fitted together. If plant and model are of one kind, the intervals cover as stated; on
// the emulated bender, whose 32 play operators are not the model's, they are wider and nothing is refused.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>

#include "analysis/identify/report/identification.hpp"
#include "playback/model/hysteresis_inverse.hpp"
#include "playback/player/player_device.hpp"
#include "tests/analysis/identify_plants.hpp"
#include "tests/measured.hpp"
#include "tests/sanitized.hpp"

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;

constexpr double kSweepRateHz = 4e3, kLoopsRateHz = 500, kSweepV = 1, kLoopsV = 5;

schema::Transducer joint_base() {
  return schema::read_transducer("wiertlewski2011").value();
}

std::vector<double> as_doubles(const std::vector<float>& drive) {
  return {drive.begin(), drive.end()};
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

SweptDrive sweep_drive(double rate_hz = kSweepRateHz) {
  const SteppedSine stepped =
      stepped_sine({.rate_hz = rate_hz, .amplitude_v = kSweepV, .low_hz = 20, .frequencies = 20});
  return {rate_hz, as_doubles(stepped.drive_v), lines_of(stepped, rate_hz)};
}

// Gelb and Vander Velde 1968, backlash: u = 1 - 2 r / A.
Complex play_in_closed_form(double threshold_v, double amplitude_v) {
  if (amplitude_v <= threshold_v) return 0;
  const double u = 1 - 2 * threshold_v / amplitude_v, rest = 1 - u * u;
  return {0.5 + (std::asin(u) + u * std::sqrt(rest)) / std::numbers::pi, -rest / std::numbers::pi};
}

// The drive is held for short times (at least 50 samples per period), so that its peaks are the sine's.
TEST(IdentifyJoint, APlaysPartOfASineIsItsDescribingFunction) {
  const double rate_hz = 50e3, pole_hz = 143;
  const SweptDrive drive = sweep_drive(rate_hz);
  SweptOperator swept(drive, pole_hz);
  for (const double threshold_v : {0.0, 0.1, 0.3}) {
    const auto left = swept.left_by({{threshold_v}, {1}});
    for (std::size_t i = 0; i < left.size(); ++i) {
      const double hz = drive.lines[i].turns_per_sample * rate_hz;
      const double charge_v = kSweepV / std::abs(Complex(1, hz / pole_hz));
      EXPECT_LT(std::abs(left[i] - play_in_closed_form(threshold_v, charge_v)), 3e-3) << hz << " Hz";
    }
  }
}

// At 128 points a period or more the samples are the fine points: plays one by one, by the model's own code.
TEST(IdentifyJoint, PlaysInOnePassAreThoseOfEachAlone) {
  const double rate_hz = 50e3, pole_hz = 143;
  const SteppedSine stepped = stepped_sine({.rate_hz = rate_hz, .high_hz = 390, .frequencies = 8});
  const SweptDrive drive{rate_hz, as_doubles(stepped.drive_v), lines_of(stepped, rate_hz)};
  const std::vector<double> charge_v = charge_of(drive.drive_v, pole_hz, rate_hz);
  const std::vector<schema::Hysteresis> operators = {{{0, 0.05, 0.1, 0.3}, {0.5, 0.2, 0, 0.3}},
                                                     {{0.02, 0.1, 0.2}, {1, -0.5, 0.25}}};
  const auto in_one_pass = SweptOperator(drive, pole_hz).left_by(operators);
  for (std::size_t o = 0; o < operators.size(); ++o)
    for (std::size_t i = 0; i < drive.lines.size(); ++i) {
      const MeasuredLine& line = drive.lines[i];
      const auto charge = std::span(charge_v).subspan(line.begin, line.end() - line.begin);
      const auto sine = [&](std::span<const double> x) {
        return amplitude_of(x.subspan(line.first - line.begin), line.turns_per_sample);
      };
      const Complex alone = sine(playback::played_through(operators[o], charge)) / sine(charge);
      EXPECT_LT(std::abs(in_one_pass[o][i] - alone), 1e-13) << "operator " << o << ", line " << i;
    }
}

// A plant of the model's own kind: the thresholds that the fit takes, weights of any size.
struct Plant {
  schema::Transducer linear;
  schema::Hysteresis bender;
};

void scale_to_swing(schema::Hysteresis& bender, double limit_v) {
  double at_limit = 0;
  for (std::size_t i = 0; i < bender.weights.size(); ++i)
    at_limit += bender.weights[i] * (limit_v - bender.thresholds_v[i]);
  for (double& weight : bender.weights) weight *= limit_v / at_limit;
}

Plant drawn_plant(const SweptDrive& drive, const std::vector<double>& loops_v, std::mt19937_64& random) {
  std::uniform_real_distribution<double> density(0.06, 0.2);  // weights per volt: the paper's 16 % is 0.13
  Plant plant{varied(joint_base(), random), {}};
  const double pole_hz = schema::actuator_pole_hz(plant.linear);
  auto& thresholds_v = plant.bender.thresholds_v;
  thresholds_v = thresholds_finer_below(SweptOperator(drive, pole_hz).largest_charge_v(),
                                        largest(charge_of(loops_v, pole_hz, kLoopsRateHz)));
  for (std::size_t i = 0; i < thresholds_v.size(); ++i)
    plant.bender.weights.push_back(i == 0 ? 0.7 : density(random) * (thresholds_v[i] - thresholds_v[i - 1]));
  scale_to_swing(plant.bender, plant.linear.drive_limit_v);
  return plant;
}

BodeData sweep_of(const Plant& plant, const SweptDrive& drive, double noise_part, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> frequencies;
  for (const MeasuredLine& line : drive.lines) frequencies.push_back(line.turns_per_sample * kSweepRateHz);
  BodeData data = measured(plant.linear, Direction::actuator, frequencies, 0, random);
  const double sigma = noise_part * std::abs(schema::actuator_response(plant.linear, 100));
  const auto left = SweptOperator(drive, schema::actuator_pole_hz(plant.linear)).left_by(plant.bender);
  for (std::size_t i = 0; i < data.size(); ++i) {
    data.response[i] = data.response[i] * left[i] + sigma * Complex(normal(random), normal(random));
    data.noise[i] = sigma;
  }
  return data;
}

DrivenTray loops_of(const Plant& plant, const std::vector<double>& loops_v, double noise_m,
                    std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, noise_m);
  const auto& t = plant.linear;
  const double gain = std::abs(schema::actuator_response(t, 0)),
               delay_s = t.damping_n_s_per_m / (t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m);
  const auto bent =
      playback::played_through(plant.bender, charge_of(loops_v, schema::actuator_pole_hz(t), kLoopsRateHz));
  DrivenTray tray{kLoopsRateHz, loops_v, {}, 0};
  for (std::size_t i = 0; i < bent.size(); ++i) {
    const double slope = i == 0 ? 0 : bent[i] - bent[i - 1];
    tray.displacement_m.push_back(gain * (bent[i] - slope * delay_s * kLoopsRateHz) + normal(random));
  }
  return tray;
}

struct Covered {
  std::map<std::string, int> covered;
  int claimed = 0, misfits = 0, unsettled = 0;

  void add(const JointFit& fit, const schema::Transducer& truth) {
    misfits += fit.response.misfit.found;
    unsettled += !fit.settled || !fit.response.converged;
    if (!fit.response.claims_intervals()) return;
    ++claimed;
    const auto count = [&](const char* name, double value) {
      const FittedParameter* p = fit.response.find(name);
      covered[name] += p->low <= value && value <= p->high;
    };
    count("gain_m_per_v", std::abs(schema::actuator_response(truth, 0)));
    count("resonance_hz", schema::resonance_hz(truth));
    count("damping_ratio", schema::damping_ratio(truth));
    count("pole_hz", schema::actuator_pole_hz(truth));
  }
  void print(const char* what) const {
    std::printf("  %s: %d claimed, %d misfits, %d unsettled\n", what, claimed, misfits, unsettled);
    for (const auto& [name, times] : covered)
      std::printf("    %s covered in %.1f %%\n", name.c_str(), 100.0 * times / std::max(1, claimed));
  }
};

// TACTO_DRAWS=2000 in the environment: so many.
int coverage_draws() {
  const char* const asked = std::getenv("TACTO_DRAWS");
  return asked != nullptr ? std::max(1, std::atoi(asked)) : draws(600, 6);
}

// 95 % +- 3.4 standard deviations of so many draws; 93 to 97 % once that is wider.
double most_percent_off(int claimed) {
  const double by_chance = 3.4 * 100 * std::sqrt(0.95 * 0.05 / std::max(1, claimed));
  return claimed >= 2000 ? std::min(by_chance, 2.0) : by_chance;
}

TEST(IdentifyJointCoverage, IntervalsCoverInNineteenOfTwenty) {
  std::mt19937_64 random(2031);
  const SweptDrive drive = sweep_drive();
  const auto loops_v = as_doubles(slow_loops(kLoopsRateHz, kLoopsV, kSweepV));
  const int count = coverage_draws();
  Covered tally;
  for (int draw = 0; draw < count; ++draw) {
    const Plant plant = drawn_plant(drive, loops_v, random);
    const BodeData sweep = sweep_of(plant, drive, 3e-4, random);
    const auto fit = fit_jointly(sweep, drive, loops_of(plant, loops_v, 20e-9, random), {}, joint_base());
    ASSERT_TRUE(fit) << schema::message(fit.error());
    EXPECT_TRUE(fit->has_hysteresis);
    tally.add(*fit, plant.linear);
  }
  tally.print("plant and model of one kind");
  EXPECT_EQ(tally.unsettled, 0);
  // Three tests at 5 in 10,000: 0.9 expected of 600; more than that and five standard deviations in 1e-5 of
  // runs.
  const double expected = 1.5e-3 * count;
  EXPECT_LE(tally.misfits, 1 + expected + 5 * std::sqrt(expected));
  for (const auto& [name, times] : tally.covered) {
    const double percent = 100.0 * times / tally.claimed;
    tacto::measured("identify_joint." + name + "_covered_percent", percent);
    EXPECT_NEAR(percent, 95, sanitized() ? 100 : most_percent_off(tally.claimed)) << name;
  }
}

struct Bench {
  const char* keys;
  double sweep_v;
};

schema::Result<JointFit> identified_bench(const Bench& bench, int seed) {
  const std::string uri = "sim:tray_sensor=on,finger=up,rate=4kHz,seed=" + std::to_string(seed) + bench.keys;
  const auto opened = playback::open_player_device(uri, std::nullopt);
  TACTO_TRY(opened);
  const auto going = [] { return false; };
  const auto silent = [](double) {};
  const auto sweep =
      driven_response(*opened->device, IdentifyMethod::sweep, {.rate_hz = 4e3, .amplitude_v = bench.sweep_v},
                      joint_base(), going, silent);
  TACTO_TRY(sweep);
  const auto loops = drive_tray(*opened->device, slow_loops(4e3, kLoopsV, bench.sweep_v), going, silent);
  TACTO_TRY(loops);
  return fit_jointly(sweep->data, sweep->drive, *loops, {}, joint_base());
}

// The emulated bender has 32 play operators, at other thresholds than the fit's. The residual of 0.1 % is not
// noise.
TEST(IdentifyJointDevice, ABenderOfAnotherKindWidensTheIntervalsAndIsNotRefused) {
  Covered tally;
  for (const Bench& bench :
       {Bench{",hysteresis=0.16", 1}, Bench{",hysteresis=0.16", 0.5}, Bench{",hysteresis=0.16", 2},
        Bench{",hysteresis=0.05", 1}, Bench{",hysteresis=0.3", 1}})
    for (int seed = 1; seed <= draws(2, 1); ++seed) {
      const auto fit = identified_bench(bench, seed);
      ASSERT_TRUE(fit) << schema::message(fit.error());
      EXPECT_TRUE(fit->has_hysteresis) << bench.keys;
      EXPECT_FALSE(fit->response.misfit.found)
          << bench.keys << " " << bench.sweep_v << " V: " << fit->response.misfit.words;
      const double resonance =
                       fit->response.find("resonance_hz")->value / schema::resonance_hz(joint_base()) - 1,
                   damping =
                       fit->response.find("damping_ratio")->value / schema::damping_ratio(joint_base()) - 1;
      EXPECT_LT(std::abs(resonance), 5e-4) << bench.keys;  // a lag instead: up to 0.4 %
      EXPECT_LT(std::abs(damping), 5e-3) << bench.keys;    // twelve even thresholds: 1.3 %
      tally.add(*fit, joint_base());
    }
  tally.print("the emulated bender");
  EXPECT_EQ(tally.misfits + tally.unsettled, 0);
  for (const auto& [name, times] : tally.covered) EXPECT_GE(times, 0.85 * tally.claimed) << name;
}

TEST(IdentifyJointDevice, ABenderWithoutHysteresisHasNone) {
  for (int seed = 1; seed <= draws(2, 1); ++seed) {
    const auto fit = identified_bench({"", 1}, seed);
    ASSERT_TRUE(fit) << schema::message(fit.error());
    EXPECT_FALSE(fit->has_hysteresis) << fit->loops.opening;
    EXPECT_FALSE(fit->response.misfit.found) << fit->response.misfit.words;
  }
}

}  // namespace
}  // namespace tacto::analysis
