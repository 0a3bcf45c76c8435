// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <limits>

#include "made_textures.hpp"
#include "playback/render/render.hpp"

namespace tacto::playback {
namespace {

class RenderRefusals : public testing::Test {
 protected:
  schema::Texture texture_ = sine_texture(0.02, 4e3, 0.01);
  FingerPath path_ = steady_path(0, 0.02, 1);
  RenderOptions options_;

  void expect_refused(schema::ErrorKind fault, const std::string& said) const {
    const auto rendering = render(texture_, path_, *schema::read_transducer("wiertlewski2011"), options_);
    ASSERT_FALSE(rendering) << said;
    EXPECT_EQ(rendering.error().kind, fault);
    EXPECT_NE(message(rendering.error()).find(said), std::string::npos) << message(rendering.error());
  }
};

TEST_F(RenderRefusals, PathThatNeverMeetsTheTexture) {
  options_.at_m = 0.5;
  expect_refused(schema::ErrorKind::unsuitable, "path: ");
}

TEST_F(RenderRefusals, PathShorterThanOnePeriod) {
  path_ = steady_path(0, 0.02, 0.06);
  expect_refused(schema::ErrorKind::unsuitable, "path: ");
}

TEST_F(RenderRefusals, PathTooLongForOneRendering) {
  path_ = steady_path(0, 1e-6, 1e5);
  expect_refused(schema::ErrorKind::unsuitable, "1e+05 s");
}

TEST_F(RenderRefusals, PathThatRunsBackInTime) {
  path_ = {{0, 2, 1}, {0, 0.01, 0.02}};
  expect_refused(schema::ErrorKind::unsuitable, "knot 2");
}

TEST_F(RenderRefusals, RateThatCannotHoldTheBand) {
  options_.rate_hz = 1000;
  expect_refused(schema::ErrorKind::usage, "above 1000Hz");
}

TEST_F(RenderRefusals, OptionsOutOfRange) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    options_ = {};
    options_.gain_m_per_n = bad;
    expect_refused(schema::ErrorKind::usage, "gain");
    options_ = {};
    options_.band.low_hz = bad;
    expect_refused(schema::ErrorKind::usage, "band");
  }
  options_ = {};
  options_.onset_s = -1;
  expect_refused(schema::ErrorKind::usage, "onset");
}

TEST_F(RenderRefusals, TextureThatIsNoForce) {
  texture_.quantity = "height";
  texture_.unit = "m";
  expect_refused(schema::ErrorKind::unsuitable, "texture: ");
}

TEST_F(RenderRefusals, TextureWithoutSamplesOrWithNaN) {
  texture_.signal.values[123] = std::numeric_limits<double>::quiet_NaN();
  expect_refused(schema::ErrorKind::unsuitable, "sample 123");
  texture_.signal.values.resize(1);
  expect_refused(schema::ErrorKind::unsuitable, "texture: ");
}

}  // namespace
}  // namespace tacto::playback
