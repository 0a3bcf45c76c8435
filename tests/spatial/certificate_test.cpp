// SPDX-License-Identifier: GPL-3.0-or-later
// Speed certificates of simulated strokes with known lines of the surface.
#include "spatial/certificate/certificate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "tests/measured.hpp"
#include "tests/spatial/simulated_strokes.hpp"

namespace tacto::spatial {
namespace {

using samples::Dice;
using samples::Line;
using samples::Stroke;
using samples::World;
using schema::Certificate;
using schema::CertifiedPeak;
using schema::ErrorKind;
using schema::PeakVerdict;

schema::Result<std::vector<Certificate>> certificates_of(const World& world,
                                                         const std::vector<Stroke>& strokes,
                                                         std::uint64_t seed) {
  std::vector<schema::Texture> textures;
  for (const Stroke& stroke : strokes)
    textures.push_back(samples::stroke_texture(world, stroke, seed * 100 + textures.size()));
  std::vector<TextureAtSpeed> named;
  for (const auto& texture : textures)
    named.push_back({"stroke " + std::to_string(named.size() + 1), &texture});
  return certify(named);
}

std::vector<CertifiedPeak> near_hz(const Certificate& certificate, double hz) {
  std::vector<CertifiedPeak> found;
  for (const auto& peak : certificate.peaks)
    if (std::abs(peak.frequency_hz - hz) < 0.02 * hz) found.push_back(peak);
  return found;
}

std::vector<CertifiedPeak> near_per_m(const Certificate& certificate, double k) {
  std::vector<CertifiedPeak> found;
  for (const auto& peak : certificate.peaks)
    if (std::abs(peak.frequency_per_m - k) < 0.02 * k) found.push_back(peak);
  return found;
}

TEST(Certificate, AHumAcrossThreeSpeedsIsTemporal) {
  World world;
  world.hums = {{100, 0.02}};
  world.surface = {{1300, 0.05}, {2600, 0.03}};
  world.noise = 0.02;
  const auto made = certificates_of(world, {{0.03, 0.06}, {0.05, 0.06}, {0.09, 0.06}}, 1);
  ASSERT_TRUE(made);
  ASSERT_EQ(made->size(), 3U);
  for (const Certificate& certificate : *made) {
    const auto hum = near_hz(certificate, 100);
    ASSERT_EQ(hum.size(), 1U);
    EXPECT_EQ(hum[0].verdict, PeakVerdict::temporal);
    EXPECT_GT(hum[0].confidence, 0.97);
    EXPECT_EQ(hum[0].found_in.size(), 3U);
    EXPECT_NEAR(hum[0].frequency_hz, 100, 0.5);
    for (const double k : {1300, 2600}) {
      const auto line = near_per_m(certificate, k);
      ASSERT_EQ(line.size(), 1U) << k;
      EXPECT_EQ(line[0].verdict, PeakVerdict::spatial) << k;
    }
  }
  // The hum is at another spatial frequency in each texture.
  EXPECT_NEAR(near_hz((*made)[0], 100)[0].frequency_per_m, 100 / 0.03, 0.01 * 100 / 0.03);
  EXPECT_NEAR((*made)[0].speed_ratio, 3, 0.01);
}

// At 50 mm/s the hum coincides with the line of 2 /mm.
TEST(Certificate, AHumThatCrossesALineAtOneSpeedIsToldFromIt) {
  World world;
  world.hums = {{100, 0.03}};
  world.surface = {{2000, 0.03}};
  world.noise = 0.02;
  const auto made = certificates_of(world, {{0.03, 0.06}, {0.05, 0.06}, {0.08, 0.06}}, 2);
  ASSERT_TRUE(made);
  for (const std::size_t i : {0U, 2U}) {
    const auto hum = near_hz((*made)[i], 100), line = near_per_m((*made)[i], 2000);
    ASSERT_EQ(hum.size(), 1U) << i;
    ASSERT_EQ(line.size(), 1U) << i;
    EXPECT_EQ(line[0].verdict, PeakVerdict::spatial);
    EXPECT_EQ(hum[0].verdict, PeakVerdict::temporal);
  }
}

// A line at 0.4 /mm is below the fast stroke's valid band (15 Hz), so it is unknown there, not absent.
TEST(Certificate, WhatTheBandCutsOffIsUnknownNotAbsent) {
  World world;
  world.surface = {{250, 0.05}};
  world.noise = 0.02;
  const auto made = certificates_of(world, {{0.04, 0.08}, {0.12, 0.08}}, 3);
  ASSERT_TRUE(made);
  const auto temporal = [](const CertifiedPeak& peak) {
    return std::abs(peak.frequency_per_m - 250) < 30 && peak.verdict == PeakVerdict::temporal;
  };
  EXPECT_TRUE(std::ranges::none_of(made->front().peaks, temporal));
}

TEST(Certificate, NoiseIsHardlyCalled) {
  std::size_t decided = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    World world;
    world.noise = 0.02;
    const auto made = certificates_of(world, {{0.04, 0.08}, {0.08, 0.08}}, 500 + seed);
    ASSERT_TRUE(made);
    for (const auto& peak : made->front().peaks) decided += peak.verdict != PeakVerdict::undecided;
  }
  std::printf("noise alone: %zu peaks called in 20 pairs of strokes\n", decided);
  EXPECT_LE(decided, 2U);
}

TEST(Certificate, RefusesWhatTellsNothing) {
  World world;
  world.noise = 0.02;
  const auto one = certificates_of(world, {{0.04, 0.06}}, 1);
  EXPECT_EQ(one.error().kind, ErrorKind::usage);
  const auto alike = certificates_of(world, {{0.0400, 0.06}, {0.0401, 0.06}}, 1);
  ASSERT_FALSE(alike);
  EXPECT_EQ(alike.error().kind, ErrorKind::unsuitable);
  EXPECT_NE(alike.error().what.find(" 1.00"), std::string::npos) << alike.error().what;
}

// One of the two hundred cases: surfaces with harmonics, hums with harmonics, resonances, varying speeds.
struct CertificateCase {
  World world;
  std::vector<Stroke> strokes;
};

CertificateCase random_case(std::uint64_t seed) {
  Dice dice(seed);
  CertificateCase made;
  World& world = made.world;
  world.noise = 0.02;
  const int lines = static_cast<int>(dice.even(0, 4));
  for (int n = 0; n < lines; ++n) {
    const Line line{dice.ratio(400, 8000), dice.ratio(0.004, 0.08)};
    world.surface.push_back(line);
    if (dice.chance(0.4)) world.surface.push_back({2 * line.frequency, 0.6 * line.amplitude});
    if (dice.chance(0.2)) world.surface.push_back({3 * line.frequency, 0.4 * line.amplitude});
  }
  const int hums = static_cast<int>(dice.even(0, 3));
  for (int n = 0; n < hums; ++n) {
    const Line hum{dice.chance(0.5) ? 50.0 : dice.ratio(20, 450), dice.ratio(0.004, 0.08)};
    world.hums.push_back(hum);
    if (dice.chance(0.4)) world.hums.push_back({2 * hum.frequency, 0.5 * hum.amplitude});
    if (dice.chance(0.3)) world.hums.push_back({3 * hum.frequency, 0.5 * hum.amplitude});
  }
  if (dice.chance(0.25)) {
    world.resonance_hz = dice.ratio(40, 400);
    world.resonance_rms = dice.ratio(0.005, 0.03);
    world.resonance_q = dice.ratio(15, 80);
  }
  if (dice.chance(0.3)) world.rough = dice.ratio(0.005, 0.03);
  const int strokes = dice.chance(0.4) ? 2 : 3;
  // Round ratios, at which harmonics coincide, or any ratio.
  const double round[] = {1.25, 1.5, 2, 3, 4};
  double speed = dice.ratio(0.02, 0.06);
  for (int n = 0; n < strokes; ++n) {
    const double waver = dice.chance(0.5) ? dice.even(0.02, 0.15) : 0;
    made.strokes.push_back({speed, dice.even(0.04, 0.1), waver, dice.even(0.5, 4), dice.even(0, 6)});
    speed *= dice.chance(0.5) ? round[static_cast<int>(dice.even(0, 5))] : dice.ratio(1.05, 3);
  }
  return made;
}

bool near_any(const std::vector<Line>& lines, double frequency, double tolerance) {
  return std::ranges::any_of(lines,
                             [&](const Line& l) { return std::abs(l.frequency - frequency) < tolerance; });
}

// Whether a peak is certified correctly: peaks of a rough surface at any frequency; those of a resonance
// within its bandwidth.
bool right(const World& world, const CertifiedPeak& peak, double shortest_m, double longest_s) {
  if (peak.verdict == PeakVerdict::spatial)
    return world.rough > 0 ||
           near_any(world.surface, peak.frequency_per_m, 2 / shortest_m + 0.005 * peak.frequency_per_m);
  const bool rings =
      world.resonance_rms > 0 && std::abs(peak.frequency_hz - world.resonance_hz) <
                                     3 * world.resonance_hz / world.resonance_q + 3 / longest_s;
  return rings || near_any(world.hums, peak.frequency_hz, 2 / longest_s + 0.01 * peak.frequency_hz);
}

TEST(Certificate, AmongDecidedPeaksOf200CasesAtMostOneInTwentyIsWrong) {
  std::size_t decided = 0, wrong = 0, undecided = 0, refused = 0, truths = 0;
  std::map<std::string, std::size_t> reasons;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const CertificateCase each = random_case(7000 + seed);
    const auto made = certificates_of(each.world, each.strokes, 7000 + seed);
    if (!made) {
      ++refused;
      continue;
    }
    truths += each.world.surface.size() + each.world.hums.size() + (each.world.resonance_rms > 0);
    double shortest_m = 1, shortest_s = 100;
    for (const Stroke& s : each.strokes) {
      shortest_m = std::min(shortest_m, s.length_m);
      shortest_s = std::min(shortest_s, s.length_m / s.speed_mps);
    }
    for (const CertifiedPeak& peak : made->front().peaks) {
      if (peak.verdict == PeakVerdict::undecided) {
        ++undecided;
        ++reasons[peak.reason];
        continue;
      }
      ++decided;
      const bool correct = right(each.world, peak, shortest_m, shortest_s);
      wrong += !correct;
      if (!correct && std::getenv("VERBOSE"))
        std::printf(
            "  seed %d: %s at %.0f /m = %.1f Hz, confidence %.3f, snr %.1f (needs %.1f), in %zu of %zu\n",
            static_cast<int>(seed), schema::verdict_name(peak.verdict).c_str(), peak.frequency_per_m,
            peak.frequency_hz, peak.confidence, peak.snr_db, peak.snr_needed_db, peak.found_in.size(),
            each.strokes.size());
    }
  }
  std::printf(
      "200 cases (%zu refused), %zu true lines: %zu peaks called, %zu of them wrongly (%.1f %%), %zu "
      "undecided\n",
      refused, truths, decided, wrong, 100.0 * static_cast<double>(wrong) / static_cast<double>(decided),
      undecided);
  for (const auto& [reason, count] : reasons) std::printf("  undecided, %s: %zu\n", reason.c_str(), count);
  measured("spatial_certificate.classified", static_cast<double>(decided));
  measured("spatial_certificate.wrong", static_cast<double>(wrong));
  measured("spatial_certificate.wrong_percent",
           100.0 * static_cast<double>(wrong) / static_cast<double>(decided));
  EXPECT_GT(decided, 500U);
  EXPECT_LE(static_cast<double>(wrong), 0.05 * static_cast<double>(decided));
}

}  // namespace
}  // namespace tacto::spatial
