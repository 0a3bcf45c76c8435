// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/report/bode_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/identify/fit/shared_errors.hpp"
#include "analysis/identify/measure/angles.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/report/value_text.hpp"
#include "spatial/picture/draw/axes.hpp"
#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/draw/heading.hpp"
#include "spatial/picture/line_plot.hpp"
#include "spatial/picture/trace.hpp"

namespace tacto::analysis {
namespace {

using spatial::Axis;
using spatial::Box;
using spatial::Canvas;
using spatial::Point;

double decibels(double part) {
  return schema::amplitude_db(part);
}

double reference_of(const ResponseFit& fit) {
  if (const FittedParameter* gain = fit.find("gain_m_per_v")) return gain->value;
  const auto largest = std::ranges::max_element(fit.curve, {}, [](auto h) { return std::abs(h); });
  return fit.data.direction == Direction::actuator ? std::abs(fit.curve.front()) : std::abs(*largest);
}

void put_model(const ResponseFit& fit, double reference, BodeCurves& c) {
  c.model_deg = carried_phase_deg(fit.curve);
  for (std::size_t i = 0; i < fit.curve.size(); ++i) {
    c.model_db.push_back(decibels(std::abs(fit.curve[i]) / reference));
    c.inverse_db.push_back(-c.model_db.back());
    c.inverse_deg.push_back(-c.model_deg[i]);
    if (fit.band.empty()) continue;
    c.low_db.push_back(c.model_db.back() - decibels(1 + fit.band[i]));
    c.high_db.push_back(c.model_db.back() + decibels(1 + fit.band[i]));
  }
}

void put_data(const ResponseFit& fit, double reference, BodeCurves& c) {
  const std::vector<double> model_deg = carried_phase_deg(fit.modelled);
  for (std::size_t i = 0; i < fit.data.size(); ++i) {
    const auto model = fit.modelled[i], measured = fit.data.response[i];
    c.data_db.push_back(decibels(std::abs(measured) / reference));
    c.data_deg.push_back(model_deg[i] + std::arg(measured / model) * kDegrees);
  }
  for (const auto& residual : turned_residuals(fit.data, fit.modelled)) {
    c.along.push_back(residual.real());
    c.across.push_back(residual.imag());
  }
}

constexpr spatial::Size kBodePage{720, 640};
constexpr double kBodeMargin = 14, kLeft = 66, kWidth = 630, kTop = 76;
constexpr double kHeights[] = {230, 150, 80};
constexpr double kPanelGap = 14;
constexpr double kDot = 1.6;
constexpr double kNearResidual = 1.96;  // 95 % of normal noise is within this

// One of the stacked plots.
struct Panel {
  Canvas& canvas;
  const std::vector<double>& hz;
  Box box;
  Axis x, y;

  Panel(Canvas& on, const std::vector<double>& frequencies, double first_top, int row,
        std::initializer_list<const std::vector<double>*> shown)
      : canvas(on), hz(frequencies) {
    double top = first_top;
    for (int above = 0; above < row; ++above) top += kHeights[above] + kPanelGap;
    box = {kLeft, top, kWidth, kHeights[row]};
    double low = INFINITY, high = -INFINITY;
    for (const auto* values : shown)
      for (const double value : *values) low = std::min(low, value), high = std::max(high, value);
    x = {spatial::AxisScale::logarithmic, hz.front(), hz.back(), box.x, box.right()};
    y = spatial::roomy_axis(low, high);
    y.at_low = box.bottom();
    y.at_high = box.y;
  }
  void grid() const {
    spatial::draw_grid(canvas, box, false, x, spatial::ticks_of(x, 10));
    spatial::draw_grid(canvas, box, true, y,
                       spatial::ticks_of(y, std::max(2, static_cast<int>(box.height / 36))));
    canvas.clip(box);
  }
  void curve(const std::vector<double>& at_hz, const std::vector<double>& values, std::size_t colour,
             bool dashed = false) const {
    for (const auto& piece : spatial::trace(at_hz, values, x, y))
      canvas.polyline(piece, {spatial::series_colour(colour), 1.25, dashed});
  }
  void dots(const std::vector<double>& values, const spatial::Colour& colour) const {
    for (std::size_t i = 0; i < hz.size(); ++i)
      canvas.fill({x.place(hz[i]) - kDot, y.place(values[i]) - kDot, 2 * kDot, 2 * kDot}, colour);
  }
  void band(const std::vector<double>& at_hz, const std::vector<double>& low,
            const std::vector<double>& high) const {
    std::vector<Point> outline;
    for (std::size_t i = 0; i < low.size(); ++i) outline.push_back({x.place(at_hz[i]), y.place(high[i])});
    for (std::size_t i = low.size(); i-- > 0;) outline.push_back({x.place(at_hz[i]), y.place(low[i])});
    spatial::Colour shade = spatial::series_colour(4);
    shade.alpha = 0.45;
    if (!outline.empty()) canvas.polygon(outline, shade);
  }
  void frame(const std::string& caption, bool lowest) const {
    canvas.release();
    canvas.frame(box, {});
    auto ticks = spatial::ticks_of(x, 10);
    if (!lowest)
      for (spatial::Tick& tick : ticks) tick.label.clear();
    spatial::draw_axis(canvas, box, spatial::Side::bottom, x, ticks);
    spatial::draw_axis(canvas, box, spatial::Side::left, y,
                       spatial::ticks_of(y, std::max(2, static_cast<int>(box.height / 36))));
    spatial::draw_caption(canvas, box, spatial::Side::left, caption, 50);
    if (lowest) spatial::draw_caption(canvas, box, spatial::Side::bottom, "frequency (Hz)", 28);
  }
};

struct Legend {
  const char* name;
  spatial::Pen pen;
};

void draw_bode_legend(Canvas& canvas, double top, bool with_band) {
  spatial::Colour shade = spatial::series_colour(4);
  shade.alpha = 0.45;
  const Legend entries[] = {{"measured", {spatial::kInk, 2 * kDot}},
                            {"model", {spatial::series_colour(0), 1.5}},
                            {"95 % band of the model", {shade, 7}},
                            {"inverse", {spatial::series_colour(1), 1.5, true}}};
  Point at{kLeft, top - 11};
  for (const Legend& entry : entries) {
    if (!with_band && entry.pen.width > 5) continue;
    canvas.line(at, {at.x + 20, at.y}, entry.pen);
    canvas.text({at.x + 25, at.y}, entry.name, {.size = 10});
    at.x += 25 + canvas.text_size(entry.name, {.size = 10}).width + 18;
  }
}

std::string title_of(const ResponseFit& fit) {
  return fmt::format("{}: {}", fit.data.direction == Direction::actuator ? "Actuator" : "Sensor",
                     fit.claims_intervals() ? "the model fits"
                     : fit.converged        ? "THE MODEL DOES NOT FIT"
                                            : "THE FIT DID NOT CONVERGE");
}

std::string facts_of(const ResponseFit& fit) {
  std::vector<std::string> names;
  for (const FittedParameter& p : fit.parameters) names.push_back(p.name);
  const auto labels = cli::labels_of(names);
  std::string facts;
  for (std::size_t i = 0; i < names.size(); ++i)
    facts += fmt::format("{} {}, ", labels[i], cli::cell_text(names[i], fit.parameters[i].value));
  return fmt::format("{}R\u00b2 {:.5f}", facts, fit.r_squared);
}

spatial::Heading heading_of(const ResponseFit& fit) {
  return spatial::heading_of(title_of(fit), facts_of(fit), fit.data.simulated,
                             kBodePage.width - 2 * kBodeMargin);
}

}  // namespace

BodeCurves bode_curves(const ResponseFit& fit) {
  BodeCurves c;
  const double reference = reference_of(fit);
  put_model(fit, reference, c);
  put_data(fit, reference, c);
  return c;
}

spatial::Size BodeFigure::page() const {
  return {kBodePage.width, kBodePage.height + heading_of(fit).extra()};
}

schema::Result<void> BodeFigure::draw(Canvas& canvas) const {
  const BodeCurves c = bode_curves(fit);
  const auto& hz = fit.data.frequency_hz;
  const spatial::Heading heading = heading_of(fit);
  const double top = kTop + heading.extra();
  spatial::draw_heading(canvas, {kBodeMargin, kBodeMargin}, heading);
  draw_bode_legend(canvas, top, !fit.band.empty());
  const Panel amplitude(canvas, hz, top, 0, {&c.model_db, &c.data_db, &c.inverse_db, &c.low_db, &c.high_db});
  amplitude.grid();
  amplitude.band(fit.curve_hz, c.low_db, c.high_db);
  amplitude.curve(fit.curve_hz, c.inverse_db, 1, true);
  amplitude.curve(fit.curve_hz, c.model_db, 0);
  amplitude.dots(c.data_db, spatial::kInk);
  amplitude.frame("amplitude (dB re rest)", false);
  const Panel phase(canvas, hz, top, 1, {&c.model_deg, &c.data_deg, &c.inverse_deg});
  phase.grid();
  phase.curve(fit.curve_hz, c.inverse_deg, 1, true);
  phase.curve(fit.curve_hz, c.model_deg, 0);
  phase.dots(c.data_deg, spatial::kInk);
  phase.frame("phase (degrees)", false);
  const std::vector<double> near(hz.size(), kNearResidual), below(hz.size(), -kNearResidual);
  const Panel residual(canvas, hz, top, 2, {&c.along, &c.across, &near, &below});
  residual.grid();
  residual.curve(hz, near, 4, true);
  residual.curve(hz, below, 4, true);
  residual.dots(c.along, spatial::series_colour(2));
  residual.dots(c.across, spatial::series_colour(3));
  residual.frame("residual / sigma", true);
  canvas.text({kLeft + kWidth, page().height - 12},
              fmt::format("residual along the model (green: amplitude) and across it (pink: phase); dashed: "
                          "{:g} sigma",
                          kNearResidual),
              {.size = 9, .colour = spatial::kGreyInk, .align_x = 1});
  return {};
}

}  // namespace tacto::analysis
