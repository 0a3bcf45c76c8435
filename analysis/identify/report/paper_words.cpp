// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/report/paper_words.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "analysis/identify/measure/angles.hpp"
#include "data-schema/base/decibels.hpp"
#include "firmware-host/sim/physics/tray_physics.hpp"

namespace tacto::analysis {
namespace {

constexpr double kReportedResonanceHz = 500;  // Wiertlewski 2011, section III-B
constexpr double kReportedGain = 20e-6;       // ibid., m/V quasi-static
constexpr double kReportedSensor = 26;        // ibid., V/N over 10-500 Hz
constexpr double kReportedResolutionN = 1e-5;
constexpr double kReportedRSquaredActuator = 0.85, kReportedRSquaredSensor = 0.91;  // ibid.
constexpr double kReportedFingerDb = -3;   // ibid., off the resonance under a finger
constexpr double kReportedOpening = 0.16;  // ibid., III-C and Figure 7
constexpr double kReportedLagDeg = 8;      // ibid.
constexpr double kFilterHz = 600;          // ibid., the 3rd-order Butterworth that limits the band ...
constexpr double kFilterEndsHz = 500;      // ... to this frequency, where the limit of a band is 3 dB down
constexpr double kReportedFilterDb = -3;
constexpr double kReportedStretches = 6;                                     // ibid., experiment 2 ...
constexpr double kListedStretches[] = {-70, -50, -30, -10, 10, 30, 50, 70};  // ... and the list, per cent
constexpr int kConverterBits = 16;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double gain_by_theory(schema::Transducer t) {
  t.actuator_scale = 1;
  return std::abs(schema::actuator_response(t, 0));
}

double sensor_at(const schema::Transducer& t, double hz) {
  return std::abs(schema::sensor_response(t, hz));
}

double actuator_db(const schema::Transducer& t, double hz) {
  return schema::amplitude_db(std::abs(schema::actuator_response(t, hz) / schema::actuator_response(t, 0)));
}

// Peak of the mechanics' 1 / |s^2 m + s b + k|, in m/N: 1 / (b w) at the damped resonance.
double mechanical_peak(const schema::Transducer& t) {
  const double ratio = schema::damping_ratio(t);
  const double stiffness = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m;
  return 1 / (2 * ratio * std::sqrt(1 - ratio * ratio) * stiffness);
}

double finger_db(const schema::Transducer& tray) {
  const firmware_host::FingerLoad finger;
  schema::Transducer loaded = tray;
  const double stiffness = 1 / finger.compliance_m_per_n;
  loaded.flexure_stiffness_n_per_m += stiffness;
  loaded.damping_n_s_per_m += stiffness / (kTurn * finger.corner_hz);
  loaded.mass_kg *= 1 + finger.mass_share;
  return schema::amplitude_db(mechanical_peak(loaded) / mechanical_peak(tray));
}

// R^2 of this program's one-mode fit to Table I's response with the reported lag.
double r_squared_under_lag(const schema::Transducer& paper, Direction direction) {
  constexpr int kFrequencies = 60;
  BodeData data;
  data.direction = direction;
  for (int i = 0; i < kFrequencies; ++i) {
    const double hz = 10 * std::pow(100, i / (kFrequencies - 1.0));
    const auto exact = direction == Direction::actuator ? schema::actuator_response(paper, hz)
                                                        : schema::sensor_response(paper, hz);
    data.frequency_hz.push_back(hz);
    data.response.push_back(exact * std::polar(1.0, -kReportedLagDeg / kDegrees));
  }
  return fit_response(data, {.direction = direction}, paper).r_squared;
}

std::vector<PaperFigure> fit_figures(const schema::Transducer& paper, const ResponseFit& fit) {
  const FittedParameter* const lag = fit.find("lag_rad");
  const auto found = [&](Direction direction) {
    return fit.data.direction == direction ? fit.r_squared : kNothing;
  };
  return {{"hysteresis_lag_degrees", kReportedLagDeg, std::asin(kReportedOpening) * kDegrees,
           lag != nullptr ? lag->value * kDegrees : kNothing,
           "a loop that opens by 16 % is an ellipse of 9.2 degrees, 8 degrees one of 13.9 %"},
          {"r_squared_actuator", kReportedRSquaredActuator, r_squared_under_lag(paper, Direction::actuator),
           found(Direction::actuator),
           "two fits of one tray; by Table I: R^2 that remains under a lag of 8 degrees, so the lag is not "
           "the cause"},
          {"r_squared_sensor", kReportedRSquaredSensor, r_squared_under_lag(paper, Direction::sensor),
           found(Direction::sensor), "0.91 against the actuator's 0.85, of the same mechanics"}};
}

// An identification has no value for a direction that was not measured.
double where_measured(const ResponseFit& fit, Direction direction, double value) {
  return fit.data.direction == direction ? value : kNothing;
}

std::vector<PaperFigure> other_figures(const schema::Transducer& paper, const schema::Transducer& found,
                                       const ResponseFit& fit) {
  return {{"finger_at_resonance_db", kReportedFingerDb, finger_db(paper), finger_db(found),
           "a fingertip of 1 mm/N that damps from 90 Hz on, 1.5 % of the tray's mass"},
          {"resolution_n", kReportedResolutionN,
           2 * paper.converter_range_v / std::exp2(kConverterBits) / kReportedSensor,
           where_measured(fit, Direction::sensor,
                          2 * found.converter_range_v / std::exp2(kConverterBits) / sensor_at(found, 100)),
           "16 bits over +-10 V"},
          {"reconstruction_filter_at_500hz_db", kReportedFilterDb,
           schema::amplitude_db(std::abs(schema::butterworth3_response(kFilterHz, kFilterEndsHz))), kNothing,
           "a 3rd-order Butterworth of 600 Hz does not end at 500 Hz"},
          {"stretch_factors", kReportedStretches, static_cast<double>(std::size(kListedStretches)), kNothing,
           "the text says six, the list has eight: +-10, 30, 50, 70 %"}};
}

std::vector<PaperFigure> transducer_figures(const schema::Transducer& paper,
                                            const schema::Transducer& printed,
                                            const schema::Transducer& found, const ResponseFit& fit) {
  const auto actuator = [&](double value) { return where_measured(fit, Direction::actuator, value); };
  const auto sensor = [&](double value) { return where_measured(fit, Direction::sensor, value); };
  schema::Transducer theory = paper;
  theory.sensor_scale = 1;
  return {{"resonance_hz", kReportedResonanceHz, schema::resonance_hz(paper), schema::resonance_hz(found),
           "Table I is above the reported value with any k_r"},
          {"resonance_k_r_as_printed_hz", kReportedResonanceHz, schema::resonance_hz(printed),
           schema::resonance_hz(found), "k_r printed 4.05e-3 N/m, read as 4.05e3"},
          {"damping_ratio", kNothing, schema::damping_ratio(paper), schema::damping_ratio(found),
           "b_r printed in N/(mm s), read as 4.49 N s/m"},
          {"actuator_gain_m_per_v", kReportedGain, gain_by_theory(paper),
           actuator(std::abs(schema::actuator_response(found, 0))),
           "with the 2 beta of equation (6); as printed half of it"},
          {"actuator_at_300hz_db", 0, actuator_db(paper, 300), actuator(actuator_db(found, 300)),
           "called quasi-static to 500 Hz; the electrical pole is at 143 Hz"},
          {"sensor_at_100hz_v_per_n", kReportedSensor, sensor_at(theory, 100), sensor(sensor_at(found, 100)),
           "as printed; half of it is near what was reported"},
          {"sensor_at_500_over_100_hz", 1, sensor_at(paper, 500) / sensor_at(paper, 100),
           sensor(sensor_at(found, 500) / sensor_at(found, 100)), "called flat from 10 to 500 Hz"}};
}

}  // namespace

schema::Result<std::vector<PaperFigure>> paper_figures(const schema::Transducer& found,
                                                       const ResponseFit& fit) {
  const auto paper = schema::read_transducer("wiertlewski2011");
  TACTO_TRY(paper);
  const auto printed = schema::read_transducer("wiertlewski2011-as-printed");
  TACTO_TRY(printed);
  std::vector<PaperFigure> figures = transducer_figures(*paper, *printed, found, fit);
  std::ranges::move(fit_figures(*paper, fit), std::back_inserter(figures));
  std::ranges::move(other_figures(*paper, found, fit), std::back_inserter(figures));
  return figures;
}

bool is_the_papers(const schema::Transducer& transducer) {
  return transducer.name.starts_with("wiertlewski2011");
}

}  // namespace tacto::analysis
