// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of contact sheets, hatching and ridges: elements are drawn at the positions of their axes.
#include <gtest/gtest.h>

#include <cmath>

#include "spatial/features/formants.hpp"
#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/sheet_figure.hpp"
#include "spatial/picture/spectrogram_figure.hpp"
#include "spatial/spectrogram/spectrogram.hpp"
#include "tests/spatial/decoded_png.hpp"
#include "tests/spatial/texture_samples.hpp"

namespace tacto::spatial {
namespace {

using samples::decode_png;
using samples::DecodedPng;

struct SheetDrawn {
  schema::Texture texture;
  schema::Spectrogram spectrogram;
  SpectrogramPanel panel() const { return {&texture, &spectrogram}; }
};

SheetDrawn drawn_sheet(schema::Texture texture, const std::string& name) {
  auto spectrogram = spatial_spectrogram(texture, {});
  EXPECT_TRUE(spectrogram);
  spectrogram->name = name;
  return {std::move(texture), std::move(*spectrogram)};
}

int sheet_luminance(std::uint32_t rgb) {
  return static_cast<int>((rgb >> 16 & 0xFF) * 3 + (rgb >> 8 & 0xFF) * 6 + (rgb & 0xFF));
}

SheetFigure sheet_of(const std::vector<SpectrogramPanel>& panels) {
  const auto scales = sheet_scales(panels, {});
  EXPECT_TRUE(scales);
  return SheetFigure(panels, *scales, "Woods");
}

TEST(Sheet, CellsShareOneScale) {
  const SheetDrawn loud = drawn_sheet(samples::sine(1, 1000, 40000), "loud");
  const SheetDrawn quiet = drawn_sheet(samples::sine(0.01, 1000, 20000), "quiet");  // 40 dB below it
  const SheetFigure figure = sheet_of({loud.panel(), quiet.panel()});
  const DecodedPng png = decode_png(*to_png(figure));
  const auto shade = [&](std::size_t cell) {
    return sheet_luminance(png.at(static_cast<int>(figure.positions(cell).place(10) * kPixelsPerPoint),
                                  static_cast<int>(figure.frequencies(cell).place(1) * kPixelsPerPoint)));
  };
  EXPECT_GT(shade(0), 2 * shade(1));
  // 20 mm of 40 mm: the right half of the cell of `quiet` is empty.
  const int beyond = static_cast<int>(figure.positions(1).place(30) * kPixelsPerPoint);
  const int middle = static_cast<int>(figure.frequencies(1).place(1) * kPixelsPerPoint);
  EXPECT_EQ(png.at(beyond, middle) & 0xFFFFFF, 0xFFFFFFU);
}

// A spike of 50 times the amplitude in one texture does not change the axis of all.
TEST(Sheet, ASpikeDoesNotFlattenThePanels) {
  const SheetDrawn plain = drawn_sheet(samples::sine(1, 1000, 40000), "plain");
  SheetDrawn spiked = plain;
  spiked.texture.signal.values[20000] = 50;
  const std::vector<SpectrogramPanel> panels = {plain.panel(), spiked.panel()};
  const auto scales = sheet_scales(panels, {});
  ASSERT_TRUE(scales);
  EXPECT_LT(scales->high_value, 3);
  EXPECT_GE(scales->high_value, 1);
  EXPECT_TRUE(to_png(SheetFigure(panels, *scales, "Woods")));
}

TEST(Sheet, CellsKeepToTheirPlaces) {
  for (const std::size_t cells : {1U, 2U, 3U, 5U, 9U, 24U}) {
    const SheetLayout layout(cells, 0);
    EXPECT_LE(layout.columns, 4U);
    EXPECT_GE(layout.columns * layout.rows, cells);
    for (std::size_t i = 0; i < cells; ++i) {
      const SheetCell cell = layout.cell(i);
      EXPECT_LE(cell.trace.bottom(), cell.heat.y);
      EXPECT_LT(cell.heat.right(), layout.bar().x);
      const double under =
          i + layout.columns < cells ? layout.cell(i + layout.columns).title.y : layout.page().height;
      EXPECT_LT(cell.heat.bottom(), under);
    }
    EXPECT_LT(layout.bar().bottom(), layout.page().height);
  }
}

TEST(Sheet, NamesItsTexturesAndTheirSpeeds) {
  SheetDrawn oak = drawn_sheet(samples::noise(20000), "oak & ash");
  oak.texture.source.mean_speed_mps = 0.05;
  oak.texture.simulated = "a test";
  const SheetDrawn pine = drawn_sheet(samples::noise(30000), "pine");
  const auto svg = to_svg(sheet_of({oak.panel(), pine.panel()}));
  ASSERT_TRUE(svg);
  for (const char* words :
       {"Woods", "oak &amp; ash", "pine", "50 mm/s", "SIMULATED", "position (mm)", "dB re 1 N\u00b2 mm"})
    EXPECT_NE(svg->find(words), std::string::npos) << words;
}

TEST(Sheet, RefusesMixedUnits) {
  const SheetDrawn force = drawn_sheet(samples::noise(20000), "force");
  SheetDrawn height = force;
  height.spectrogram.unit = "m";
  const auto scales = sheet_scales(std::vector{force.panel(), height.panel()}, {});
  ASSERT_FALSE(scales);
  EXPECT_EQ(scales.error().kind, schema::ErrorKind::unsuitable);
}

// Below the valid band the picture is paler than without a band, and hatched.
TEST(Hatch, CoversWhatTheRecordingCouldNotKnow) {
  SheetDrawn oak = drawn_sheet(samples::noise(40000), "oak");
  const DecodedPng bare = decode_png(*to_png(SpectrogramFigure({oak.panel()}, {100.0, 60})));
  oak.texture.valid_band = {{0, 1000, 10e3}};
  const SpectrogramFigure figure({oak.panel()}, {100.0, 60});
  const DecodedPng veiled = decode_png(*to_png(figure));
  const Box heat = figure.layout(0).heat;
  const int x = static_cast<int>((heat.x + heat.width / 2) * kPixelsPerPoint);
  const auto row = [&](double per_mm) {
    return static_cast<int>(figure.frequencies(0).place(per_mm) * kPixelsPerPoint);
  };
  int paler = 0, changes = 0;
  for (int i = 0; i < 60; ++i) {
    paler += sheet_luminance(veiled.at(x + i, row(0.4))) > sheet_luminance(bare.at(x + i, row(0.4)));
    changes += std::abs(sheet_luminance(veiled.at(x + i + 1, row(0.4))) -
                        sheet_luminance(veiled.at(x + i, row(0.4)))) > 150;
    EXPECT_EQ(veiled.at(x + i, row(3)), bare.at(x + i, row(3)));  // known: as it was
  }
  EXPECT_GT(paler, 50);
  EXPECT_GE(changes, 6);  // one line every 5 points gives 6 in 60 pixels
}

TEST(Ridges, LieOnTheirFrequencyAndCarryIt) {
  const double k = 33e6 / 16384;
  const SheetDrawn oak = drawn_sheet(samples::sine(0.02, k, 40000), "oak");
  const auto formants = find_formants(oak.spectrogram);
  ASSERT_TRUE(formants);
  ASSERT_EQ(formants->size(), 1U);
  const SpectrogramFigure figure({{&oak.texture, &oak.spectrogram, *formants}});
  const DecodedPng png = decode_png(*to_png(figure));
  const Box heat = figure.layout(0).heat;
  const int y = static_cast<int>(std::lround(figure.frequencies(0).place(1e-3 * k) * kPixelsPerPoint));
  int white = 0;
  for (int x = static_cast<int>(heat.x * 2) + 200; x < static_cast<int>(heat.x * 2) + 300; ++x)
    white += sheet_luminance(png.at(x, y)) > 2300 || sheet_luminance(png.at(x, y - 1)) > 2300;
  EXPECT_GT(white, 90);
  const auto svg = to_svg(figure);
  EXPECT_NE(svg->find("2.01/mm"), std::string::npos);
  EXPECT_NE(svg->find(">formants<"), std::string::npos);
}

}  // namespace
}  // namespace tacto::spatial
