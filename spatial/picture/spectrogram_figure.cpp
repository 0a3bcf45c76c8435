// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/spectrogram_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "spatial/picture/draw/axes.hpp"
#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/draw/display_unit.hpp"
#include "spatial/picture/draw/hatch.hpp"
#include "spatial/picture/draw/shown_range.hpp"
#include "spatial/picture/formant_ridges.hpp"
#include "spatial/picture/heatmap.hpp"
#include "spatial/picture/trace.hpp"
#include "spatial/picture/valid_band.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr double kCaptionGap = 50;
constexpr std::size_t kLabels = 12;

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

Axis value_axis(const ShownRange& shown, const Box& box) {
  Axis axis = roomy_axis(shown.low, shown.high);
  axis.at_low = box.bottom();
  axis.at_high = box.y;
  return axis;
}

std::vector<Tick> without_labels(std::vector<Tick> ticks) {
  for (Tick& tick : ticks) tick.label.clear();
  return ticks;
}

// The wavelength 1/k decreases while the frequency k increases along the same side.
Axis wavelength_axis(const Axis& frequency) {
  return {AxisScale::logarithmic, 1 / frequency.high, 1 / frequency.low, frequency.at_high, frequency.at_low};
}

// The inputs and steps of the drawing. Axes in mm and 1/mm, placed on the panel's spectrogram.
struct PanelPainter {
  Canvas& canvas;
  const schema::Texture& texture;
  const schema::Spectrogram& spectrogram;
  const Heading& heading;
  PanelLayout layout;
  Axis position;
  Axis frequency;
  LevelRange levels;
  std::span<const schema::Formant> formants;

  // Errors: those of heatmap().
  schema::Result<void> paint() {
    draw_heading(canvas, {layout.heading.x, layout.heading.y}, heading);
    paint_trace();
    if (auto painted = paint_heat(); !painted) return painted;
    paint_wavelengths();
    paint_mean();
    paint_bar();
    paint_notes();
    return {};
  }

 private:
  void paint_trace() {
    const auto& signal = texture.signal;
    const DisplayUnit unit = display_unit(texture.unit, largest_of(signal.values));
    std::vector<double> x(signal.values.size());
    std::vector<double> y(signal.values.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = 1e3 * signal.position_m(i);
      y[i] = unit.factor * signal.values[i];
    }
    const ShownRange shown = shown_range(y);
    const Axis axis = value_axis(shown, layout.trace);
    const auto ticks = ticks_of(axis, 5);
    draw_grid(canvas, layout.trace, true, axis, ticks);
    canvas.clip(layout.trace);
    for (const auto& piece : trace(x, y, position, axis, canvas.pixels_per_point()))
      canvas.polyline(piece, {kTrace, 0.6});
    canvas.release();
    if (shown.beyond > 0)
      canvas.text({layout.trace.right() - 4, layout.trace.y + 3}, out_of_range_text(shown, unit.text),
                  {.size = 8.5, .colour = kGreyInk, .align_x = 1, .align_y = 0});
    canvas.frame(layout.trace, {});
    draw_axis(canvas, layout.trace, Side::left, axis, ticks);
    draw_axis(canvas, layout.trace, Side::bottom, position, without_labels(ticks_of(position, 10)));
    draw_caption(canvas, layout.trace, Side::left,
                 fmt::format("{} ({})", axis_name(texture.quantity), unit.text), kCaptionGap);
  }

  schema::Result<void> paint_heat() {
    const Box area = covered(layout.heat, position, spectrogram);
    const auto pixels = heatmap(spectrogram, 1e3 * frequency.low, 1e3 * frequency.high, levels,
                                static_cast<int>(std::lround(area.width * canvas.pixels_per_point())),
                                static_cast<int>(std::lround(area.height * canvas.pixels_per_point())));
    TACTO_TRY(pixels);
    const double start = position.place(1e3 * texture.signal.origin_m);
    const double end = position.place(1e3 * (texture.signal.origin_m + texture.signal.length_m()));
    canvas.fill({start, layout.heat.y, end - start, layout.heat.height}, kNoWindow);
    canvas.image(area, *pixels);
    if (!texture.valid_band.empty()) draw_valid_band(canvas, area, texture.valid_band, position, frequency);
    draw_formants(canvas, area, formants, position, frequency, kLabels);
    canvas.frame(layout.heat, {});
    draw_axis(canvas, layout.heat, Side::bottom, position, ticks_of(position, 10));
    draw_axis(canvas, layout.heat, Side::left, frequency, ticks_of(frequency, 6));
    draw_caption(canvas, layout.heat, Side::bottom, "position (mm)", 29);
    draw_caption(canvas, layout.heat, Side::left, "spatial frequency (1/mm)", kCaptionGap);
    return {};
  }

  void paint_wavelengths() {
    const Axis wavelength = wavelength_axis(frequency);
    draw_axis(canvas, layout.heat, Side::right, wavelength, ticks_of(wavelength, 6));
    draw_caption(canvas, layout.heat, Side::right, "wavelength (mm)", 45);
  }

  void paint_mean() {
    const LevelReference reference = level_reference(spectrogram);
    const Axis level{AxisScale::linear, levels.low_db, levels.high_db, layout.mean.x, layout.mean.right()};
    std::vector<double> frequencies_per_mm;
    std::vector<double> levels_db;
    const auto mean = mean_spectrum(spectrogram);
    for (std::size_t k = 1; k < mean.size(); ++k) {
      frequencies_per_mm.push_back(1e-3 * spectrogram.frequency_per_m(k));
      levels_db.push_back(std::max(level_db(mean[k], reference), levels.low_db - 100));
    }
    const auto level_ticks = ticks_of(level, 3);
    draw_grid(canvas, layout.mean, false, level, level_ticks);
    draw_grid(canvas, layout.mean, true, frequency, ticks_of(frequency, 6));
    canvas.clip(layout.mean);
    for (auto piece : trace(frequencies_per_mm, levels_db, frequency, level, canvas.pixels_per_point())) {
      for (Point& point : piece) std::swap(point.x, point.y);
      canvas.polyline(piece, {kTrace, 1});
    }
    canvas.release();
    canvas.frame(layout.mean, {});
    draw_axis(canvas, layout.mean, Side::bottom, level, level_ticks);
    draw_caption(canvas, layout.mean, Side::bottom, "mean (dB)", 29);
  }

  void paint_bar() {
    const std::string unit = typeset(level_reference(spectrogram).unit);
    draw_level_bar(canvas, layout.bar, levels, fmt::format("power spectral density (dB re {})", unit));
  }

  // The legend of lines and greys, in the corner that the plots leave free.
  void paint_notes() {
    const TextStyle style{.size = 9.5, .colour = kGreyInk, .align_y = 0.5};
    const Box& box = layout.notes;
    double y = box.y + 6;
    const auto swatch = [&](const Colour& colour) {
      canvas.fill({box.x, y - 4.5, 18, 9},
                  level_colour(std::lerp(levels.low_db, levels.high_db, 0.35), levels));
      canvas.fill({box.x, y - 4.5, 18, 9}, colour);
    };
    const auto note = [&](const std::string& text) {
      canvas.text({box.x + 24, y}, text, style);
      y += 15;
    };
    const double rms = band_rms(spectrogram, 1e3 * frequency.low);
    const DisplayUnit unit = display_unit(texture.unit, rms);
    canvas.text({box.x, y},
                fmt::format("RMS {:.4g} {}, {:.2g} to {:.3g} /mm", unit.factor * rms, unit.text,
                            frequency.low, frequency.high),
                style);
    y += 15;
    if (!texture.valid_band.empty()) {
      swatch({0, 0, 0, 0});
      canvas.line({box.x, y}, {box.x + 18, y}, kBandPen);
      note("limits of the valid band");
      swatch({0, 0, 0, 0});
      draw_hatch(canvas, {box.x, y - 4.5, 18, 9});
      note("outside it: not measured");
    }
    swatch(kNoWindow);
    note("no whole window");
    if (formants.empty()) return;
    swatch({0, 0, 0, 0});
    const Point ridge[] = {{box.x + 2, y}, {box.x + 16, y}};
    draw_ridge(canvas, ridge);
    note("formants");
  }
};

// Window, hop, bins, speed, direction and band in one line.
std::string method_facts(const schema::Texture& texture, const schema::Spectrogram& spectrogram) {
  std::string facts =
      fmt::format("Blackman window {:.4g} mm, hop {:.4g} mm, {:.3g} /mm a bin", 1e3 * spectrogram.window_m,
                  1e3 * spectrogram.hop_m, 1e-3 * spectrogram.frequency_step_per_m);
  const auto& source = texture.source;
  if (source.mean_speed_mps > 0)
    facts += fmt::format("; recorded at {:.3g} mm/s", 1e3 * source.mean_speed_mps);
  facts += texture.direction < 0 ? ", backwards" : ", forwards";
  if (!source.filter.empty() && source.filter != "none")
    facts += fmt::format(", {:g}\u2013{:g} Hz ({})", source.low_hz, source.high_hz, source.filter);
  return facts;
}

// Name, surface, method and, for simulated data, their source.
Heading panel_heading(const schema::Texture& texture, const schema::Spectrogram& spectrogram) {
  const std::string title =
      spectrogram.name + (texture.surface.empty() ? "" : ", surface " + texture.surface);
  return heading_of(title, method_facts(texture, spectrogram), texture.simulated, heading_width());
}

}  // namespace

SpectrogramFigure::SpectrogramFigure(std::vector<SpectrogramPanel> panels, SpectrogramPictureOptions options)
    : panels_(std::move(panels)), options_(options) {
  for (const SpectrogramPanel& panel : panels_) {
    headings_.push_back(panel_heading(*panel.texture, *panel.spectrogram));
    heading_heights_.push_back(headings_.back().height());
  }
}

Size SpectrogramFigure::page() const {
  return page_of(heading_heights_);
}

double SpectrogramFigure::highest_per_m() const {
  double highest = 0;
  for (const auto& panel : panels_)
    highest = std::max(highest, panel.spectrogram->frequency_per_m(panel.spectrogram->bins - 1));
  return highest;
}

double SpectrogramFigure::lowest_per_m() const {
  if (options_.min_frequency_per_m) return *options_.min_frequency_per_m;
  double lowest = INFINITY;
  for (const auto& panel : panels_) lowest = std::min(lowest, lowest_of_interest_per_m(*panel.texture));
  return lowest_shown_per_m(lowest, *panels_.front().spectrogram);
}

Result<void> SpectrogramFigure::check() const {
  if (!(std::isfinite(options_.dynamic_range_db) && options_.dynamic_range_db > 0))
    return schema::fail(ErrorKind::usage, "the dynamic range must be above 0 dB", "dynamic range",
                        "60dB is the default");
  for (const auto& panel : panels_)
    if (panel.spectrogram->unit != panels_.front().spectrogram->unit)
      return schema::fail(ErrorKind::unsuitable, "its unit differs from the first texture's",
                          panel.spectrogram->name, "draw only textures of one quantity on a page");
  if (!(lowest_per_m() > 0))
    return schema::fail(ErrorKind::usage, "the minimum frequency must be above 0", "minimum frequency",
                        "the axis is logarithmic");
  if (!(lowest_per_m() * 1.5 < highest_per_m()))
    return schema::fail(ErrorKind::unsuitable, "the frequency axis is too short for a picture",
                        "frequency axis", "raise the maximum frequency or lower the minimum");
  return {};
}

Axis SpectrogramFigure::positions(std::size_t panel) const {
  double low = INFINITY;
  double high = -INFINITY;
  for (const auto& each : panels_) {
    low = std::min(low, 1e3 * each.texture->signal.origin_m);
    high = std::max(high, 1e3 * (each.texture->signal.origin_m + each.texture->signal.length_m()));
  }
  return position_axis(low, high, layout(panel).heat);
}

Axis SpectrogramFigure::frequencies(std::size_t panel) const {
  return frequency_axis(1e-3 * lowest_per_m(), 1e-3 * highest_per_m(), layout(panel).heat);
}

LevelRange SpectrogramFigure::levels() const {
  constexpr double kStep = 5;
  double highest = -INFINITY;
  for (const auto& panel : panels_) {
    const auto peak = strongest_peak(*panel.spectrogram, lowest_per_m());
    highest = std::max(highest, level_db(peak.cell, level_reference(*panel.spectrogram)));
  }
  const double top = std::isfinite(highest) ? kStep * std::ceil(highest / kStep) : 0;
  return {top - options_.dynamic_range_db, top};
}

Result<void> SpectrogramFigure::draw(Canvas& canvas) const {
  if (auto checked = check(); !checked) return checked;
  const LevelRange shared = levels();
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    PanelPainter painter{canvas,
                         *panels_[i].texture,
                         *panels_[i].spectrogram,
                         headings_[i],
                         layout(i),
                         positions(i),
                         frequencies(i),
                         shared,
                         panels_[i].formants};
    if (auto drawn = painter.paint(); !drawn) return drawn;
  }
  return {};
}

}  // namespace tacto::spatial
