// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/sheet_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "spatial/picture/draw/axes.hpp"
#include "spatial/picture/draw/display_unit.hpp"
#include "spatial/picture/draw/fitted_text.hpp"
#include "spatial/picture/draw/heading.hpp"
#include "spatial/picture/draw/shown_range.hpp"
#include "spatial/picture/formant_ridges.hpp"
#include "spatial/picture/heatmap.hpp"
#include "spatial/picture/spectrogram_layout.hpp"
#include "spatial/picture/trace.hpp"
#include "spatial/picture/valid_band.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {
namespace {

using schema::Result;

constexpr double kSheetMargin = 14;
constexpr double kLeft = 58, kRight = 82, kBottom = 46;  // space for axes and the bar
constexpr double kSheetTitle = 30, kTraceHeight = 46, kGap = 5, kHeat = 120;
constexpr double kBetweenColumns = 14, kBetweenRows = 12;
constexpr double kRow = kSheetTitle + kTraceHeight + kGap + kHeat;

// A single column is wide; four columns fit on a page.
double cell_width(std::size_t columns) {
  return columns == 1 ? 440 : columns == 2 ? 300 : 226;
}

std::size_t usual_columns(std::size_t cells) {
  return std::clamp<std::size_t>(
      static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(cells) * 0.8))), 1, 4);
}

constexpr std::size_t kSheetLabels = 4;
const TextStyle kName{.size = 11, .bold = true, .align_y = 0};
const TextStyle kFacts{.size = 8.5, .colour = kGreyInk, .align_y = 0};
const TextStyle kSimulated{.size = 8.5, .colour = kAlarm, .bold = true, .align_x = 1, .align_y = 0};

Axis upwards(double low, double high, const Box& box) {
  return {AxisScale::linear, low, high, box.bottom(), box.y};
}

std::vector<Tick> unlabelled(std::vector<Tick> ticks) {
  for (Tick& tick : ticks) tick.label.clear();
  return ticks;
}

std::vector<Tick> ticks_for(const Axis& axis, int target, bool labelled) {
  return labelled ? ticks_of(axis, target) : unlabelled(ticks_of(axis, target));
}

std::string facts_of(const schema::Texture& texture) {
  std::string facts;
  if (texture.source.mean_speed_mps > 0)
    facts = fmt::format("{:.3g} mm/s, ", 1e3 * texture.source.mean_speed_mps);
  facts += texture.direction < 0 ? "backwards" : "forwards";
  if (!texture.surface.empty()) facts += ", " + texture.surface;
  return facts;
}

std::string sheet_facts(const std::vector<SpectrogramPanel>& panels) {
  const auto& first = *panels.front().spectrogram;
  return fmt::format(
      "{} textures at one scale; Blackman window {:.4g} mm, hop {:.4g} mm; hatched: not measured, grey: no "
      "whole "
      "window",
      panels.size(), 1e3 * first.window_m, 1e3 * first.hop_m);
}

ShownRange outside(const Axis& axis, std::span<const double> values) {
  ShownRange range{axis.low, axis.high, 0, values.size(), 0};
  for (const double value : values) {
    if (value >= axis.low && value <= axis.high) continue;
    ++range.beyond;
    if (std::abs(value) > std::abs(range.furthest)) range.furthest = value;
  }
  return range;
}

}  // namespace

SheetLayout::SheetLayout(std::size_t cell_count, std::size_t target_columns)
    : cells(cell_count),
      columns(std::min(target_columns == 0 ? usual_columns(cell_count) : target_columns, cell_count)),
      heading_height(kHeadingHeight) {
  rows = (cells + columns - 1) / columns;
}

Size SheetLayout::page() const {
  const auto across = static_cast<double>(columns), down = static_cast<double>(rows);
  return {kLeft + across * cell_width(columns) + (across - 1) * kBetweenColumns + kRight,
          kSheetMargin + heading_height + down * kRow + (down - 1) * kBetweenRows + kBottom};
}

Box SheetLayout::heading() const {
  return {kSheetMargin, kSheetMargin, page().width - 2 * kSheetMargin, heading_height};
}

SheetCell SheetLayout::cell(std::size_t index) const {
  const std::size_t rows_above = index / columns;
  const auto column = static_cast<double>(index % columns), row = static_cast<double>(rows_above);
  const double width = cell_width(columns);
  const double x = kLeft + column * (width + kBetweenColumns);
  const double y = kSheetMargin + heading_height + row * (kRow + kBetweenRows);
  SheetCell cell;
  cell.title = {x, y, width, kSheetTitle};
  cell.trace = {x, y + kSheetTitle, width, kTraceHeight};
  cell.heat = {x, y + kSheetTitle + kTraceHeight + kGap, width, kHeat};
  cell.leftmost = index % columns == 0;
  cell.lowest = index + columns >= cells;
  return cell;
}

Box SheetLayout::bar() const {
  const double top = cell(0).trace.y;
  const double height =
      std::min(rows == 1 ? kTraceHeight + kGap + kHeat : 220.0, page().height - top - kBottom);
  return {page().width - kRight + 14, top, 12, height};
}

Result<SheetScales> sheet_scales(std::span<const SpectrogramPanel> panels,
                                 const SpectrogramPictureOptions& options) {
  const SpectrogramFigure together({panels.begin(), panels.end()}, options);
  TACTO_TRY(together.check());
  SheetScales scales;
  scales.length_mm = 0;
  double low = INFINITY, high = -INFINITY;
  for (const SpectrogramPanel& panel : panels) {
    const auto& signal = panel.texture->signal;
    scales.length_mm = std::max(scales.length_mm, 1e3 * signal.length_m());
    const ShownRange shown = shown_range(signal.values);  // a spike in one panel must not compress the others
    low = std::min(low, shown.low);
    high = std::max(high, shown.high);
  }
  const Axis roomy = roomy_axis(low, high);
  scales.low_value = roomy.low;
  scales.high_value = roomy.high;
  scales.low_per_mm = 1e-3 * together.lowest_per_m();
  scales.high_per_mm = 1e-3 * together.highest_per_m();
  scales.levels = together.levels();
  return scales;
}

SheetFigure::SheetFigure(std::vector<SpectrogramPanel> panels, const SheetScales& scales,
                         const std::string& title, std::size_t columns)
    : panels_(std::move(panels)),
      scales_(scales),
      layout_(panels_.size(), columns),
      heading_(heading_of(title, sheet_facts(panels_), "", layout_.heading().width)) {
  layout_.heading_height = heading_.height();
}

Axis SheetFigure::positions(std::size_t cell) const {
  return position_axis(0, scales_.length_mm, layout_.cell(cell).heat);
}

Axis SheetFigure::frequencies(std::size_t cell) const {
  return frequency_axis(scales_.low_per_mm, scales_.high_per_mm, layout_.cell(cell).heat);
}

Result<void> SheetFigure::draw(Canvas& canvas) const {
  draw_heading(canvas, {layout_.heading().x, layout_.heading().y}, heading_);
  for (std::size_t i = 0; i < panels_.size(); ++i)
    if (auto drawn = draw_cell(canvas, i); !drawn) return drawn;
  draw_bar(canvas);
  return {};
}

Result<void> SheetFigure::draw_cell(Canvas& canvas, std::size_t index) const {
  draw_title(canvas, index);
  draw_trace(canvas, index);
  return draw_heat(canvas, index);
}

void SheetFigure::draw_title(Canvas& canvas, std::size_t index) const {
  const Box box = layout_.cell(index).title;
  const schema::Texture& texture = *panels_[index].texture;
  double width = box.width;
  if (!texture.simulated.empty()) {
    canvas.text({box.right(), box.y + 2}, "SIMULATED", kSimulated);
    width -= canvas.text_size("SIMULATED", kSimulated).width + 8;
  }
  draw_fitted(canvas, {box.x, box.y}, panels_[index].spectrogram->name, kName, width);
  draw_fitted(canvas, {box.x, box.y + 15}, facts_of(texture), kFacts, box.width);
}

void SheetFigure::draw_trace(Canvas& canvas, std::size_t index) const {
  const SheetCell cell = layout_.cell(index);
  const auto& signal = panels_[index].texture->signal;
  const DisplayUnit unit =
      display_unit(panels_[index].texture->unit, std::max(-scales_.low_value, scales_.high_value));
  std::vector<double> x(signal.values.size()), y(signal.values.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = 1e3 * static_cast<double>(i) * signal.pitch_m;
    y[i] = unit.factor * signal.values[i];
  }
  const Axis axis = upwards(unit.factor * scales_.low_value, unit.factor * scales_.high_value, cell.trace);
  canvas.clip(cell.trace);
  for (const auto& piece : trace(x, y, positions(index), axis, canvas.pixels_per_point()))
    canvas.polyline(piece, {kTrace, 0.5});
  canvas.release();
  if (const ShownRange beyond = outside(axis, y); beyond.beyond > 0)
    canvas.text({cell.trace.right() - 3, cell.trace.y + 2}, out_of_range_text(beyond, unit.text),
                {.size = 7, .colour = kGreyInk, .align_x = 1, .align_y = 0});
  canvas.frame(cell.trace, {});
  draw_axis(canvas, cell.trace, Side::left, axis, ticks_for(axis, 3, cell.leftmost));
  if (cell.leftmost)
    draw_caption(canvas, cell.trace, Side::left,
                 fmt::format("{} ({})", axis_name(panels_[index].texture->quantity), unit.text), 46);
}

Result<void> SheetFigure::draw_heat(Canvas& canvas, std::size_t index) const {
  const SheetCell cell = layout_.cell(index);
  const auto& [texture, spectrogram, formants] = panels_[index];
  const Axis position = positions(index), frequency = frequencies(index);
  const Box area = covered(cell.heat, position, *spectrogram);
  const auto pixels = heatmap(*spectrogram, 1e3 * frequency.low, 1e3 * frequency.high, scales_.levels,
                              static_cast<int>(std::lround(area.width * canvas.pixels_per_point())),
                              static_cast<int>(std::lround(area.height * canvas.pixels_per_point())));
  TACTO_TRY(pixels);
  const double end = position.place(1e3 * texture->signal.length_m());
  canvas.fill({cell.heat.x, cell.heat.y, end - cell.heat.x, cell.heat.height}, kNoWindow);
  canvas.image(area, *pixels);
  if (!texture->valid_band.empty()) draw_valid_band(canvas, area, texture->valid_band, position, frequency);
  draw_formants(canvas, area, formants, position, frequency, kSheetLabels);
  canvas.frame(cell.heat, {});
  draw_axis(canvas, cell.heat, Side::left, frequency, ticks_for(frequency, 5, cell.leftmost));
  draw_axis(canvas, cell.heat, Side::bottom, position, ticks_for(position, 5, cell.lowest));
  if (cell.leftmost) draw_caption(canvas, cell.heat, Side::left, "frequency (1/mm)", 46);
  if (cell.lowest) draw_caption(canvas, cell.heat, Side::bottom, "position (mm)", 27);
  return {};
}

void SheetFigure::draw_bar(Canvas& canvas) const {
  const Box bar = layout_.bar();
  const std::string unit = typeset(level_reference(*panels_.front().spectrogram).unit);
  draw_level_bar(canvas, bar, scales_.levels, fmt::format("density (dB re {})", unit));
}

}  // namespace tacto::spatial
