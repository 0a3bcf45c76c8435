// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/scene/patch_list.hpp"

#include <fmt/format.h>

#include "data-schema/base/quantity.hpp"
#include "data-schema/report/value_text.hpp"
#include "spatial/picture/draw/display_unit.hpp"
#include "spatial/picture/draw/fitted_text.hpp"

namespace tacto::analysis {

using spatial::Canvas;
using spatial::Point;
using spatial::TextStyle;

namespace {

constexpr double kLine = 13, kIndent = 12, kAbovePatch = 5;
constexpr double kSliderName = 150, kSliderEnd = 62, kSliderLength = 120;
const TextStyle kPatchName{.size = 9.5, .bold = true}, kGreyWords{.size = 9, .colour = spatial::kGreyInk},
    kLayerWords{.size = 9};

std::string value_words(std::string_view name, double value) {
  const std::string key(name);
  if (name == "seed") return fmt::format("{:.0f}", value);
  return spatial::typeset(cli::cell_text(key, cli::ReportPrinter::Value(value)));
}

std::string name_words(std::string_view name) {
  return cli::labels_of({std::string(name)}).front();
}

std::string place_words(const schema::Patch& patch) {
  const auto length = [](double metres) { return spatial::typeset(schema::length_for_people(metres)); };
  std::string words = fmt::format("{} \u00d7 {} at x {}, y {}", length(patch.width_m), length(patch.height_m),
                                  length(patch.x_m), length(patch.y_m));
  if (patch.angle_deg != 0) words += fmt::format("; turned by {:g} degrees", patch.angle_deg);
  if (patch.order != 0) words += fmt::format("; order {:g}", patch.order);
  if (patch.combine == schema::PatchCombine::add) words += "; added to what is below";
  return words;
}

std::string layer_words(const schema::ForceLayer& layer) {
  std::string words(schema::type_of(layer));
  layer.visit(
      [&](const schema::GroovesLayer& grooves) { words += fmt::format(", {}", to_string(grooves.profile)); },
      [](const auto& /*other*/) {});
  if (const std::string file = schema::file_of(layer); !file.empty()) words += ", " + file;
  const char* before = ": ";
  for (const auto& [name, number, changes, whole] : schema::numbers_of(layer)) {
    words += fmt::format("{}{} {}", before, name_words(name), value_words(name, number.value));
    before = ", ";
  }
  if (schema::is_adaptive(layer)) words += ", adaptive";
  return words;
}

// Draws one below the other.
class ListPainter {
 public:
  ListPainter(Canvas& canvas, Point top_left, double width)
      : canvas_(canvas), left_(top_left.x), y_(top_left.y), width_(width) {}

  void patch(const schema::Patch& patch) {
    y_ += kAbovePatch;
    canvas_.text({left_, y_ + kLine / 2}, patch.name, kPatchName);
    const double beside = canvas_.text_size(patch.name, kPatchName).width + 8;
    if (beside > width_ / 2) y_ += kLine;
    paragraph(place_words(patch), kGreyWords, beside > width_ / 2 ? kIndent : beside);
    for (const schema::ForceLayer& layer : patch.layers) {
      paragraph(layer_words(layer), kLayerWords, kIndent);
      for (const auto& [name, number, changes, whole] : schema::numbers_of(layer))
        if (number.slider) slider(name, number.value, *number.slider);
    }
  }
  double bottom() const { return y_; }

 private:
  void paragraph(const std::string& words, const TextStyle& style, double indent) {
    for (const std::string& line : spatial::wrapped(canvas_, words, style, width_ - indent)) {
      canvas_.text({left_ + indent, y_ + kLine / 2}, line, style);
      y_ += kLine;
    }
  }

  // Its name, its ends, and a knob at the value.
  void slider(std::string_view name, double value, const schema::SliderRange& range) {
    const double middle = y_ + kLine / 2, from = left_ + 2 * kIndent + kSliderName + kSliderEnd,
                 to = from + kSliderLength;
    canvas_.text({left_ + 2 * kIndent, middle},
                 fmt::format("slider {} {}", name_words(name), value_words(name, value)), kGreyWords);
    canvas_.text({from - 6, middle}, value_words(name, range.from),
                 {.size = 9, .colour = spatial::kGreyInk, .align_x = 1});
    canvas_.text({to + 6, middle}, value_words(name, range.to), kGreyWords);
    canvas_.line({from, middle}, {to, middle}, {spatial::kGreyInk, 1.6});
    const double part = range.to > range.from ? (value - range.from) / (range.to - range.from) : 0;
    canvas_.fill({from + part * kSliderLength - 2, middle - 4, 4, 8}, spatial::kInk);
    y_ += kLine;
  }

  Canvas& canvas_;
  double left_, y_, width_;
};

}  // namespace

double draw_patch_list(Canvas& canvas, const schema::Scene& scene, Point top_left, double width) {
  ListPainter painter(canvas, top_left, width);
  for (const schema::Patch& patch : scene.patches) painter.patch(patch);
  return painter.bottom();
}

}  // namespace tacto::analysis
