// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of pictures: elements are drawn at the positions of their axes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "spatial/numbers/band_at.hpp"
#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/line_plot.hpp"
#include "spatial/picture/spectrogram_figure.hpp"
#include "spatial/spectrogram/spectrogram.hpp"
#include "tests/spatial/decoded_png.hpp"
#include "tests/spatial/texture_samples.hpp"

namespace tacto::spatial {
namespace {

using samples::decode_png;
using samples::DecodedPng;
using schema::ErrorKind;

struct Drawn {
  schema::Texture texture;
  schema::Spectrogram spectrogram;
  SpectrogramFigure figure() const { return SpectrogramFigure({{&texture, &spectrogram}}); }
};

Drawn drawn(schema::Texture texture, const std::string& name = "oak") {
  auto spectrogram = spatial_spectrogram(texture, {});
  EXPECT_TRUE(spectrogram);
  spectrogram->name = name;
  return {std::move(texture), std::move(*spectrogram)};
}

int luminance(std::uint32_t rgb) {
  return static_cast<int>((rgb >> 16 & 0xFF) * 3 + (rgb >> 8 & 0xFF) * 6 + (rgb & 0xFF));
}

int brightest_row(const DecodedPng& png, int x, const Box& box) {
  int best = static_cast<int>(box.y * kPixelsPerPoint) + 3;
  for (int y = best; y < box.bottom() * kPixelsPerPoint - 3; ++y)
    if (luminance(png.at(x, y)) > luminance(png.at(x, best))) best = y;
  return best;
}

TEST(SpectrogramFigure, PngHasTwoPixelsAPoint) {
  const Drawn oak = drawn(samples::sine(0.02, 2000, 40000));
  const auto bytes = to_png(oak.figure());
  ASSERT_TRUE(bytes);
  const DecodedPng png = decode_png(*bytes);
  EXPECT_EQ(png.width, 1600);
  EXPECT_EQ(png.height, 1000);
}

// The bright line of a sine is in the pixel row of its frequency. Bins are 61/m apart and the window 100/m
// wide, so a line at a bin's centre is brightest there. Above about 4/mm a row is wider than a bin.
TEST(SpectrogramFigure, DrawsASineAtItsFrequency) {
  for (const double bin : {10.0, 33.0, 130.0}) {
    const double frequency_per_m = bin * 1e6 / 16384;
    const Drawn oak = drawn(samples::sine(0.02, frequency_per_m, 40000));
    const SpectrogramFigure figure = oak.figure();
    const DecodedPng png = decode_png(*to_png(figure));
    const Box box = figure.layout(0).heat;
    const double expected = figure.frequencies(0).place(1e-3 * frequency_per_m) * kPixelsPerPoint - 0.5;
    const int x = static_cast<int>((box.x + box.width / 2) * kPixelsPerPoint);
    // Colours have 256 steps of 0.23 dB: several rows around the line have the brightest colour.
    const int brightest = brightest_row(png, x, box);
    int last = brightest;
    while (png.at(x, last + 1) == png.at(x, brightest)) ++last;
    EXPECT_NEAR(0.5 * (brightest + last), expected, 1) << bin;
  }
}

// A step in frequency in the middle of the texture is in the middle of the axis.
TEST(SpectrogramFigure, DrawsAChangeAtItsPosition) {
  auto texture = samples::sine(0.02, 1000, 80000);
  const auto second = samples::sine(0.02, 4000, 80000);
  std::copy(second.signal.values.begin() + 40000, second.signal.values.end(),
            texture.signal.values.begin() + 40000);
  const Drawn oak = drawn(texture);
  const SpectrogramFigure figure = oak.figure();
  const DecodedPng png = decode_png(*to_png(figure));
  const auto row = [&](double per_mm) {
    return static_cast<int>(figure.frequencies(0).place(per_mm) * kPixelsPerPoint);
  };
  const auto column = [&](double mm) {
    return static_cast<int>(figure.positions(0).place(mm) * kPixelsPerPoint);
  };
  for (const double mm : {10.0, 30.0, 38.0})
    EXPECT_GT(luminance(png.at(column(mm), row(1))), luminance(png.at(column(mm), row(4)))) << mm;
  for (const double mm : {42.0, 50.0, 70.0})
    EXPECT_GT(luminance(png.at(column(mm), row(4))), luminance(png.at(column(mm), row(1)))) << mm;
}

TEST(SpectrogramFigure, IsTheSameEachTime) {
  const Drawn oak = drawn(samples::noise(30000));
  EXPECT_TRUE(*to_png(oak.figure()) == *to_png(oak.figure()));
  EXPECT_TRUE(*to_svg(oak.figure()) == *to_svg(oak.figure()));
}

TEST(SpectrogramFigure, SvgHoldsItsWordsAndStaysSmall) {
  Drawn oak = drawn(samples::noise(90'000), "oak & <ash>");
  oak.texture.simulated = "emulated device";
  const auto svg = to_svg(oak.figure());
  ASSERT_TRUE(svg);
  EXPECT_LT(svg->size(), 1U << 20);
  for (const char* words : {"position (mm)", "spatial frequency (1/mm)", "wavelength (mm)", "force (mN)",
                            "N\u00b2 mm", "oak &amp; &lt;ash&gt;", "SIMULATED: emulated device"})
    EXPECT_NE(svg->find(words), std::string::npos) << words;
}

// For any number of samples the curves have a few points per pixel column; only the embedded image grows.
TEST(SpectrogramFigure, SvgOfALongTextureKeepsItsCurvesSmall) {
  const auto svg = to_svg(drawn(samples::noise(1'000'000)).figure());
  ASSERT_TRUE(svg);
  const auto image = svg->find(";base64,");
  ASSERT_NE(image, std::string::npos);
  EXPECT_LT(svg->size() - (svg->find('"', image) - image), 300'000U);
}

TEST(SpectrogramFigure, SeveralShareColoursAndAxes) {
  const Drawn loud = drawn(samples::sine(1, 1000, 40000));
  const Drawn quiet = drawn(samples::sine(0.01, 1000, 20000));  // 40 dB below it
  const SpectrogramFigure figure({{&loud.texture, &loud.spectrogram}, {&quiet.texture, &quiet.spectrogram}});
  EXPECT_DOUBLE_EQ(figure.positions(1).high, 39.999);
  EXPECT_DOUBLE_EQ(figure.levels().high_db,
                   SpectrogramFigure({{&loud.texture, &loud.spectrogram}}).levels().high_db);
  const DecodedPng png = decode_png(*to_png(figure));
  EXPECT_EQ(png.height, 1600);
  const auto shade = [&](std::size_t panel) {
    return luminance(png.at(static_cast<int>(figure.positions(panel).place(10) * kPixelsPerPoint),
                            static_cast<int>(figure.frequencies(panel).place(1) * kPixelsPerPoint)));
  };
  EXPECT_GT(shade(0), 2 * shade(1));
}

TEST(SpectrogramFigure, RefusesWhatItCantDraw) {
  const Drawn oak = drawn(samples::noise(20000));
  SpectrogramPictureOptions options;
  options.dynamic_range_db = 0;
  EXPECT_EQ(to_png(SpectrogramFigure({{&oak.texture, &oak.spectrogram}}, options)).error().kind,
            ErrorKind::usage);
  options = {};
  options.min_frequency_per_m = 20e3;
  EXPECT_EQ(to_png(SpectrogramFigure({{&oak.texture, &oak.spectrogram}}, options)).error().kind,
            ErrorKind::unsuitable);
  Drawn height = oak;
  height.spectrogram.unit = "m";
  const SpectrogramFigure mixed({{&oak.texture, &oak.spectrogram}, {&height.texture, &height.spectrogram}});
  EXPECT_EQ(to_svg(mixed).error().kind, ErrorKind::unsuitable);
  const std::vector<SpectrogramPanel> many(100, {&oak.texture, &oak.spectrogram});
  EXPECT_EQ(to_png(SpectrogramFigure(many)).error().kind, ErrorKind::unsuitable);
}

TEST(SpectrogramFigure, DrawsSilence) {
  const Drawn silence = drawn(samples::texture_of(std::vector<double>(20000, 0.0)));
  EXPECT_TRUE(to_png(silence.figure()));
}

TEST(Heatmap, HoldsTheLevelOfAFlatSpectrum) {
  schema::Spectrogram flat;
  flat.unit = "N";
  flat.bins = 50000;  // more than cv::remap can index
  flat.frequency_step_per_m = 1;
  flat.hop_m = 1e-3;
  flat.position_m = {0, 1e-3, 2e-3};
  flat.cells.assign(3 * flat.bins, 2e-6F);
  const LevelRange levels{-60, 0};
  const auto pixels = heatmap(flat, 10, 40000, levels, 40, 30);
  ASSERT_TRUE(pixels);
  ASSERT_EQ(pixels->rgb.size(), 1200U);
  for (const std::uint32_t rgb : pixels->rgb) ASSERT_EQ(rgb, level_pixel(10 * std::log10(2e-3), levels));
}

TEST(ValidBand, IsStraightBetweenBreakpoints) {
  const std::vector<schema::BandPoint> band = {
      {0, 100, 1000}, {1e-3, 300, 3000}, {1e-3, 400, 4000}, {2e-3, 400, 4000}};
  EXPECT_DOUBLE_EQ(band_at(band, -1).low_per_m, 100);
  EXPECT_DOUBLE_EQ(band_at(band, 0.25e-3).low_per_m, 150);
  EXPECT_DOUBLE_EQ(band_at(band, 0.25e-3).high_per_m, 1500);
  EXPECT_DOUBLE_EQ(band_at(band, 5).high_per_m, 4000);
}

TEST(Picture, ExtensionsAreNamedWhereOneIsUnknown) {
  LineFigure figure;
  figure.series = {{"a", {0, 1}, {0, 1}, series_colour(0)}};
  const auto refused = encode_as("a.jpg", figure);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::usage);
  EXPECT_EQ(refused.error().remedy, "use .png or .svg");
  EXPECT_TRUE(encode_as("A.PNG", figure)->starts_with("\x89PNG"));
  EXPECT_TRUE(encode_as("a.svg", figure)->starts_with("<?xml"));
}

LineFigure two_curves() {
  LineFigure figure;
  figure.title = "Wanted and modelled";
  figure.x_label = "time (s)";
  figure.y_label = "displacement (\u00b5m)";
  figure.series = {{"wanted", {}, {}, series_colour(0)}, {"modelled", {}, {}, series_colour(1), 1, true}};
  for (int i = 0; i <= 1000; ++i) {
    const double t = i * 1e-3;
    figure.series[0].x.push_back(t);
    figure.series[0].y.push_back(50 * std::sin(2 * std::numbers::pi * 5 * t));
    figure.series[1].x.push_back(t);
    figure.series[1].y.push_back(45 * std::sin(2 * std::numbers::pi * 5 * t - 0.2));
  }
  return figure;
}

TEST(LineFigure, NamesItsCurvesAndAxes) {
  const auto svg = to_svg(two_curves());
  ASSERT_TRUE(svg);
  for (const char* words :
       {"Wanted and modelled", "time (s)", "displacement (\u00b5m)", ">wanted<", ">modelled<"})
    EXPECT_NE(svg->find(words), std::string::npos) << words;
}

// The element of a label in the SVG's text layer, with its position and width; empty: not drawn.
std::string placed_label(const LineFigure& figure, const std::string& text) {
  const auto svg = to_svg(figure);
  const auto end = svg ? svg->find(">" + text + "<") : std::string::npos;
  return end == std::string::npos ? ""
                                  : svg->substr(svg->rfind("<text", end), end - svg->rfind("<text", end));
}

// A label avoids every mark, also those of later series, and is omitted if there is no space.
TEST(LineFigure, LabelsCoverNoMark) {
  LineFigure figure;
  figure.series = {{"frame", {0, 1}, {0, 1}, series_colour(0)},
                   {"", {0.4}, {0.5}, series_colour(1), 1, false, true, {"a choice"}}};
  const std::string alone = placed_label(figure, "a choice");
  ASSERT_FALSE(alone.empty());
  // 0.43 is about 18 points to the right, 0.52 about 5 above: below the label without the second mark.
  figure.series.push_back({"", {0.43}, {0.52}, series_colour(2), 1, false, true});
  const std::string beside = placed_label(figure, "a choice");
  EXPECT_FALSE(beside.empty());
  EXPECT_NE(beside, alone);
  Series crowd{"", {}, {}, series_colour(2), 1, false, true};
  for (int i = 0; i <= 20; ++i)
    for (int k = 0; k <= 20; ++k) {
      crowd.x.push_back(0.3 + 0.01 * i);
      crowd.y.push_back(0.4 + 0.01 * k);
    }
  figure.series.push_back(std::move(crowd));
  EXPECT_TRUE(placed_label(figure, "a choice").empty());
}

TEST(LineFigure, RefusesUnevenOrEmptySeries) {
  LineFigure figure = two_curves();
  figure.series[1].y.pop_back();
  const auto uneven = to_png(figure);
  ASSERT_FALSE(uneven);
  EXPECT_EQ(uneven.error().where, "series 'modelled'");
  figure.series = {{"nothing", {NAN}, {1}, {}}};
  EXPECT_EQ(to_png(figure).error().kind, ErrorKind::unsuitable);
}

TEST(LineFigure, DrawsAConstantAndAPoint) {
  LineFigure figure;
  figure.series = {{"level", {0, 1, 2}, {3, 3, 3}, series_colour(0)}};
  EXPECT_TRUE(to_png(figure));
  figure.series = {{"point", {0}, {0}, series_colour(0)}};
  EXPECT_TRUE(to_png(figure));
}

}  // namespace
}  // namespace tacto::spatial
