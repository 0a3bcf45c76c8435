// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures show everything: texts are complete, a spike does not compress the curve; and on a page they are
// small.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "spatial/picture/draw/engine.hpp"
#include "spatial/picture/draw/shown_range.hpp"
#include "spatial/picture/draw/svg_numbers.hpp"
#include "spatial/picture/line_plot.hpp"
#include "spatial/picture/spectrogram_figure.hpp"
#include "spatial/spectrogram/spectrogram.hpp"
#include "tests/spatial/decoded_png.hpp"
#include "tests/spatial/texture_samples.hpp"

namespace tacto::spatial {
namespace {

const std::string kBywhat =
    "by tactograph's emulated device: finger of person 1 (elastic ridges, LuGre friction, mass-spring-damper "
    "pulp) at "
    "50 mm/s and 500 mN, on C: milled grating of 3 mm period, 0.1 mm deep, seed 1";

LineFigure one_curve(const std::string& title, const std::string& simulated) {
  LineFigure figure;
  figure.title = title;
  figure.simulated = simulated;
  figure.series = {{"a", {0, 1}, {0, 1}, series_colour(0)}};
  return figure;
}

// All words of the text layer, line by line.
std::string words_of(const std::string& svg) {
  std::string words;
  for (auto at = svg.find("<text"); at != svg.npos; at = svg.find("<text", at + 1)) {
    const auto from = svg.find('>', at) + 1;
    words += svg.substr(from, svg.find('<', from) - from) + " ";
  }
  return words;
}

TEST(WholePicture, LongTitlesAndBadgesWrap) {
  const std::string title =
      "The middle of the section that is compared, of a texture with a name that is far too long";
  const LineFigure figure = one_curve(title, kBywhat);
  for (const auto& svg : {to_svg(figure), to_page_svg(figure)}) {
    ASSERT_TRUE(svg);
    const std::string words = words_of(*svg);
    EXPECT_NE(words.find("SIMULATED: " + kBywhat), words.npos) << words;
    EXPECT_NE(words.find(title), words.npos) << words;
    EXPECT_EQ(words.find("\u2026"), words.npos) << words;
  }
  EXPECT_GT(figure.page().height, one_curve("short", "").page().height);
}

TEST(WholePicture, AShortHeadingTakesNoMoreRoom) {
  EXPECT_EQ(one_curve("short", "by a test").page().height, 320);
}

TEST(WholePicture, AWordWithoutSpacesIsBroken) {
  const auto svg = to_svg(one_curve(std::string(300, 'w'), ""));
  ASSERT_TRUE(svg);
  EXPECT_EQ(std::ranges::count(words_of(*svg), 'w'), 300);
}

TEST(WholePicture, LegendsWrap) {
  LineFigure figure = one_curve("t", "");
  figure.series.clear();
  for (int i = 0; i < 6; ++i)
    figure.series.push_back(
        {"a curve with a long name, number " + std::to_string(i), {0, 1}, {0, 1}, series_colour(0)});
  const auto svg = to_svg(figure);
  ASSERT_TRUE(svg);
  for (int i = 0; i < 6; ++i) EXPECT_NE(svg->find("number " + std::to_string(i)), svg->npos);
  EXPECT_GT(figure.page().height, 320);
}

TEST(WholePicture, ASpectrogramsHeadingIsWhole) {
  schema::Texture texture = samples::noise(30000);
  texture.simulated = kBywhat;
  auto spectrogram = spatial_spectrogram(texture, {});
  ASSERT_TRUE(spectrogram);
  spectrogram->name = "oak";
  const SpectrogramFigure two({{&texture, &*spectrogram}, {&texture, &*spectrogram}});
  const auto svg = to_svg(two);
  ASSERT_TRUE(svg);
  EXPECT_NE(words_of(*svg).find("SIMULATED: " + kBywhat), std::string::npos);
  // The second panel begins below the first, for any height of its heading.
  EXPECT_GT(two.layout(1).heading.y, two.layout(0).heat.bottom());
  EXPECT_LT(two.layout(1).heat.bottom(), two.page().height);
}

// On a page with sixty such pictures each may have 160 kB; noise gives the largest.
TEST(WholePicture, APagesPictureIsSmall) {
  const schema::Texture texture = samples::noise(90'000);
  auto spectrogram = spatial_spectrogram(texture, {});
  ASSERT_TRUE(spectrogram);
  const SpectrogramFigure figure({{&texture, &*spectrogram}});
  const auto svg = to_page_svg(figure);
  ASSERT_TRUE(svg);
  EXPECT_LT(svg->size(), 150'000U);
  EXPECT_NE(svg->find(">position (mm)<"), std::string::npos);
}

TEST(Palette, KeepsEachPixel) {
  Pixels pixels{16, 15, {}};
  for (std::uint32_t i = 0; i < 240; ++i) pixels.rgb.push_back(i << 16 | (255 - i) << 8 | i / 2);
  const auto png = samples::decode_png(palette_png(pixels));
  ASSERT_EQ(png.width, 16);
  for (int i = 0; i < 240; ++i) ASSERT_EQ(png.at(i % 16, i / 16), pixels.rgb[static_cast<std::size_t>(i)]);
}

TEST(Palette, TooManyColoursHaveNone) {
  Pixels pixels{257, 1, {}};
  for (std::uint32_t i = 0; i < 257; ++i) pixels.rgb.push_back(i);
  EXPECT_EQ(palette_png(pixels), "");
}

TEST(SvgNumbers, PathsAreRoundedAndNothingElse) {
  EXPECT_EQ(
      with_rounded_paths("<path id=\"p1.2345\" d=\"M -0.001 2.345678 L 10 1.999999 Z\"/><a x=\"1.23456\"/>"),
      "<path id=\"p1.2345\" d=\"M 0 2.35 L 10 2 Z\"/><a x=\"1.23456\"/>");
}

std::vector<double> drawn_noise(std::size_t size) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> values(size);
  for (double& value : values) value = normal(random);
  return values;
}

TEST(ShownRange, NoiseAndSinesAreShownWhole) {
  std::vector<double> sine(10000);
  for (std::size_t i = 0; i < sine.size(); ++i) sine[i] = std::sin(0.01 * static_cast<double>(i));
  for (const auto& values : {drawn_noise(1'000'000), sine}) {
    const ShownRange range = shown_range(values);
    EXPECT_EQ(range.beyond, 0U);
    EXPECT_EQ(range.low, *std::ranges::min_element(values));
    EXPECT_EQ(range.high, *std::ranges::max_element(values));
  }
}

TEST(ShownRange, OneSpikeDoesNotSquashTheRest) {
  std::vector<double> values = drawn_noise(10000);
  values[17] = 1000;
  const ShownRange range = shown_range(values);
  EXPECT_LT(range.high, 10);
  EXPECT_EQ(range.furthest, 1000);
  EXPECT_NE(out_of_range_text(range, "mN").find("1000 mN"), std::string::npos)
      << out_of_range_text(range, "mN");
}

// A twentieth of each stroke, like the onset in a recording of a finger.
TEST(ShownRange, OnsetsDoNotSquashTheStrokes) {
  std::vector<double> values = drawn_noise(100'000);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (i % 10'000 < 500) values[i] += 20;
  const ShownRange range = shown_range(values);
  EXPECT_LT(range.high, 8);
  EXPECT_GT(range.high, 3);
  EXPECT_EQ(range.beyond, 5000U);
}

// Rest with one short stroke: the picture must show the stroke.
TEST(ShownRange, AStrokeAmongRestIsShown) {
  std::vector<double> values = drawn_noise(100'000);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (i >= 5'000) values[i] *= 1e-3;
  EXPECT_EQ(shown_range(values).beyond, 0U);
}

TEST(ShownRange, NothingAndConstantsHaveARange) {
  EXPECT_EQ(shown_range(std::vector<double>{}).values, 0U);
  const ShownRange constant = shown_range(std::vector<double>(100, 3.0));
  EXPECT_EQ(constant.low, 3);
  EXPECT_EQ(constant.beyond, 0U);
}

}  // namespace
}  // namespace tacto::spatial
