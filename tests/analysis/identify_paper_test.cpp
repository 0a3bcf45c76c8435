// SPDX-License-Identifier: GPL-3.0-or-later
// Contradictions in the paper, against numbers computed by hand from Table I.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/identify/report/paper_words.hpp"
#include "tests/analysis/identify_plants.hpp"

namespace tacto::analysis {
namespace {

class PaperFigures : public testing::Test {
 protected:
  static PaperFigure figure(const std::string& name, Direction direction = Direction::actuator) {
    const auto paper = *schema::read_transducer("wiertlewski2011");
    std::mt19937_64 random(2);
    const BodeData data = measured(paper, direction, octaves(10, 1000, 60), 1e-3, random);
    const auto figures = paper_figures(paper, fit_response(data, {.direction = direction}, paper));
    EXPECT_TRUE(figures);
    const auto found = std::ranges::find(*figures, name, &PaperFigure::what);
    EXPECT_NE(found, figures->end()) << name;
    return *found;
  }
};

// 547.7 Hz of sqrt(80,520 / 0.0068); one pole at 1 / (4 pi 680 Ohm 818 nF) = 143.06 Hz and one tray at 300
// Hz.
TEST_F(PaperFigures, OfTheTrayAreTableOnes) {
  EXPECT_NEAR(figure("resonance_hz").by_table, std::sqrt(80520 / 6.8e-3) / (2 * M_PI), 0.01);
  EXPECT_EQ(figure("resonance_hz").reported, 500);
  const double r = 300 / 547.68, pole = 300 / 143.06, zeta = 0.0959;
  const double tray = std::pow(1 - r * r, 2) + std::pow(2 * zeta * r, 2);
  EXPECT_NEAR(figure("actuator_at_300hz_db").by_table, -10 * std::log10((1 + pole * pole) * tray), 0.02);
  EXPECT_EQ(figure("actuator_at_300hz_db").reported, 0);
  EXPECT_NEAR(figure("sensor_at_100hz_v_per_n").by_table, 50.3, 1.5);
}

// Butterworth's |H|^2 = 1 / (1 + (f / fc)^6).
TEST_F(PaperFigures, OfTheFilterAndTheConverter) {
  const PaperFigure filter = figure("reconstruction_filter_at_500hz_db");
  EXPECT_NEAR(filter.by_table, -10 * std::log10(1 + std::pow(500.0 / 600, 6)), 1e-9);
  EXPECT_NEAR(filter.by_table, -1.25, 0.01);
  EXPECT_EQ(filter.reported, -3);
  EXPECT_NEAR(figure("resolution_n").by_table, 20.0 / 65536 / 26, 1e-12);
  EXPECT_EQ(figure("stretch_factors").reported, 6);
  EXPECT_EQ(figure("stretch_factors").by_table, 8);
}

// The peak is 1 / (2 zeta sqrt(1 - zeta^2) k): nearly 1 / (b w), and a fingertip adds 1000 / (2 pi 90) N s/m
// to 4.49, 1000 N/m to 80,520 and 1.5 % to the mass.
TEST_F(PaperFigures, AFingerTakesWhatItsDamperSays) {
  const double b = 4.49, more = 1000 / (2 * M_PI * 90);
  const auto peak = [](double damping, double k, double m) {
    double most = 0;
    for (double hz = 500; hz < 600; hz += 0.01) {
      const double w = 2 * M_PI * hz;
      most = std::max(most, 1 / std::hypot(k - m * w * w, damping * w));
    }
    return most;
  };
  const double exact = 20 * std::log10(peak(b + more, 81520, 6.902e-3) / peak(b, 80520, 6.8e-3));
  const PaperFigure finger = figure("finger_at_resonance_db");
  EXPECT_NEAR(finger.by_table, exact, 1e-3);
  EXPECT_NEAR(finger.by_table, finger.reported, 0.2);  // the paper is consistent here
}

// A constant lag of 8 degrees causes a residual of at most |1 - exp(-i 8 deg)|^2 = 2 %; the fit explains a
// part of it.
TEST_F(PaperFigures, TheLagDoesNotExplainRSquared) {
  const double left = 4 * std::pow(std::sin(4 * M_PI / 180), 2);
  const PaperFigure actuator = figure("r_squared_actuator");
  EXPECT_EQ(actuator.reported, 0.85);
  EXPECT_GT(actuator.by_table, 1 - 2 * left);
  EXPECT_LT(actuator.by_table, 1);
  EXPECT_GT(actuator.identified, 0.9999);
  EXPECT_TRUE(std::isnan(figure("r_squared_sensor").identified));
  EXPECT_GT(figure("r_squared_sensor", Direction::sensor).identified, 0.9999);
  EXPECT_TRUE(std::isnan(figure("r_squared_actuator", Direction::sensor).identified));
  EXPECT_EQ(figure("r_squared_sensor").reported, 0.91);
}

// A fit of one direction does not change the other's base values, so those are not identified.
TEST_F(PaperFigures, OfADirectionThatWasNotMeasuredNothingIsIdentified) {
  for (const char* name : {"sensor_at_100hz_v_per_n", "sensor_at_500_over_100_hz", "resolution_n"}) {
    EXPECT_TRUE(std::isnan(figure(name).identified)) << name;
    EXPECT_TRUE(std::isfinite(figure(name, Direction::sensor).identified)) << name;
  }
  for (const char* name : {"actuator_gain_m_per_v", "actuator_at_300hz_db"}) {
    EXPECT_TRUE(std::isnan(figure(name, Direction::sensor).identified)) << name;
    EXPECT_TRUE(std::isfinite(figure(name).identified)) << name;
  }
}

}  // namespace
}  // namespace tacto::analysis
