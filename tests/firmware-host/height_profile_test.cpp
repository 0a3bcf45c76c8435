// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/height_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "data-schema/texture/texture.hpp"
#include "firmware-host/sim/physics/surface.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::firmware_host {
namespace {

struct Extent {
  double least = 0, most = 0;
};

Extent extent_of(const HeightProfile& profile) {
  Extent extent;
  for (const double height : profile.heights_m()) {
    extent.least = std::min(extent.least, height);
    extent.most = std::max(extent.most, height);
  }
  return extent;
}

HeightProfile surface(const std::string& name) {
  SurfaceChoice choice;
  choice.name = name;
  return make_surface(choice)->profile;
}

TEST(HeightProfile, IsLinearBetweenPointsAndLevelBeyond) {
  const HeightProfile ramp(1e-3, {0, 1e-4, 2e-4, 3e-4});
  EXPECT_NEAR(ramp.at(1.5e-3).height_m, 1.5e-4, 1e-12);
  EXPECT_NEAR(ramp.at(1.5e-3).slope, 0.1, 1e-9);
  EXPECT_EQ(ramp.at(-1).height_m, 0);
  EXPECT_EQ(ramp.at(-1).slope, 0);
  EXPECT_NEAR(ramp.at(1).height_m, 3e-4, 1e-12);
  EXPECT_DOUBLE_EQ(ramp.length_m(), 3e-3);
}

// Running means do not change a sine's shape; each multiplies its amplitude by sinc(w / period).
TEST(HeightProfile, SofteningShrinksASineByTheCubedSinc) {
  constexpr double kPitchM = 2e-6, kPeriodM = 0.5e-3;
  std::vector<double> heights;
  for (int i = 0; i <= 5000; ++i)
    heights.push_back(50e-6 * std::cos(2 * std::numbers::pi * i * kPitchM / kPeriodM));
  const HeightProfile soft = softened(HeightProfile(kPitchM, heights), 100e-6);
  const double width = 51 * kPitchM;  // the odd number of points around 100 um
  const double sinc = std::sin(std::numbers::pi * width / kPeriodM) / (std::numbers::pi * width / kPeriodM);
  EXPECT_NEAR(soft.at(5e-3).height_m, 50e-6 * sinc * sinc * sinc, 50e-6 * 1e-3);
}

TEST(Surface, SamplesAreAsDeepAsTableTwoSays) {
  const Extent grating = extent_of(surface("C"));
  EXPECT_NEAR(grating.most - grating.least, 0.1e-3, 0.02e-3);
  EXPECT_NEAR(extent_of(surface("B")).least, -0.1e-3, 0.03e-3);
  EXPECT_NEAR(extent_of(surface("E")).least, -0.1e-3, 0.02e-3);
  EXPECT_EQ(extent_of(surface("flat")).most, 0);
  EXPECT_NEAR(surface("A").length_m(), 40e-3, 1e-9);
}

TEST(Surface, SeedsChangeWhatIsRandomAndNothingElse) {
  SurfaceChoice one, two;
  two.seed = 2;
  for (const char* name : {"A", "B", "C", "D", "E"}) {
    one.name = two.name = name;
    EXPECT_EQ(make_surface(one)->profile.heights_m(), make_surface(one)->profile.heights_m());
    EXPECT_NE(make_surface(one)->profile.heights_m(), make_surface(two)->profile.heights_m()) << name;
  }
  one.name = two.name = "triangle";
  EXPECT_EQ(make_surface(one)->profile.heights_m(), make_surface(two)->profile.heights_m());
}

TEST(Surface, GratingsHaveTheirPeriodAndDepth) {
  SurfaceChoice choice;
  choice.period_m = 1.76e-3;  // Wiertlewski 2011, section V-A2
  choice.depth_m = 25.6e-6;
  for (const char* name : {"sine", "triangle", "square"}) {
    choice.name = name;
    const HeightProfile profile = make_surface(choice)->profile;
    const Extent extent = extent_of(profile);
    EXPECT_NEAR(extent.most - extent.least, 25.6e-6, 1e-7) << name;
    for (double x = 1e-3; x < 30e-3; x += 0.37e-3)
      EXPECT_NEAR(profile.at(x).height_m, profile.at(x + 1.76e-3).height_m, 1e-7) << name << " at " << x;
  }
}

TEST(Surface, RefusesWhatItCanNotMake) {
  SurfaceChoice choice;
  choice.name = "F";
  EXPECT_NE(make_surface(choice).error().remedy.find("A, B, C"), std::string::npos);
  choice.name = "C";
  choice.period_m = 1e-3;
  EXPECT_EQ(make_surface(choice).error().kind, schema::ErrorKind::usage);
  choice.name = "sine";
  choice.period_m = 10e-6;
  EXPECT_EQ(make_surface(choice).error().where, "period");
  choice.period_m = std::nan("");
  EXPECT_EQ(make_surface(choice).error().where, "period");
  choice = {};
  choice.length_m = 1e-3;
  EXPECT_EQ(make_surface(choice).error().where, "length");
}

schema::Texture heights_of(std::size_t count, double pitch_m, double tall_m) {
  schema::Texture texture;
  texture.quantity = "height";
  texture.unit = "m";
  texture.surface = "a coin";
  texture.signal.pitch_m = pitch_m;
  for (std::size_t i = 0; i < count; ++i)
    texture.signal.values.push_back(tall_m / 2 * std::sin(0.01 * static_cast<double>(i)));
  return texture;
}

TEST(Surface, AMeasuredProfileIsTouchedAsItIs) {
  const tests::TemporaryFolder folder;
  const schema::Texture texture = heights_of(2001, 10e-6, 80e-6);
  ASSERT_TRUE(schema::write_texture(folder / "coin", texture));
  SurfaceChoice choice;
  choice.name = "profile:" + (folder / "coin");
  const auto made = make_surface(choice);
  ASSERT_TRUE(made) << message(made.error());
  EXPECT_EQ(made->description, "profile of a coin");
  EXPECT_DOUBLE_EQ(made->profile.length_m(), 20e-3);
  for (std::size_t i = 0; i < 2001; i += 100)  // stored in 32 bits, and rounded to 1 pm
    EXPECT_NEAR(made->profile.at(10e-6 * static_cast<double>(i)).height_m, texture.signal.values[i], 4e-12);
}

TEST(Surface, AProfileThatNoFingerFollowsIsRefused) {
  const tests::TemporaryFolder folder;
  const auto refused = [&](const schema::Texture& texture) {
    if (!schema::write_texture(folder / "p", texture)) throw std::runtime_error("not written");
    SurfaceChoice choice;
    choice.name = "profile:" + (folder / "p");
    return message(make_surface(choice).error());
  };
  EXPECT_NE(refused(heights_of(100, 10e-6, 1e-5)).find("10 mm"), std::string::npos);
  EXPECT_NE(refused(heights_of(1000, 0.2e-3, 1e-5)).find("0.1 mm"), std::string::npos);
  EXPECT_NE(refused(heights_of(2000, 10e-6, 2e-3)).find("1 mm"), std::string::npos);
  schema::Texture force = heights_of(2000, 10e-6, 0.1);
  force.quantity = "tangential_force";
  force.unit = "N";
  EXPECT_NE(refused(force).find("not of heights"), std::string::npos);
  SurfaceChoice absent;
  absent.name = "profile:" + (folder / "absent");
  EXPECT_EQ(make_surface(absent).error().kind, schema::ErrorKind::not_found);
}

}  // namespace
}  // namespace tacto::firmware_host
