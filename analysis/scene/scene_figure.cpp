// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/scene/scene_figure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/scene/relief_raster.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/report/value_text.hpp"
#include "data-schema/scene/scene.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "spatial/picture/draw/axes.hpp"
#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/draw/display_unit.hpp"
#include "spatial/picture/draw/fitted_text.hpp"
#include "spatial/picture/line_plot.hpp"

namespace tacto::analysis {

using schema::Dimension;
using schema::Result;
using spatial::Box;
using spatial::Canvas;
using spatial::Colour;
using spatial::Pen;
using spatial::Point;
using spatial::Segment;
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

// In the order of the scene; texts that are too long for the width wrap. Returns the lower end.
double draw_patch_list(Canvas& canvas, const schema::Scene& scene, Point top_left, double width) {
  ListPainter painter(canvas, top_left, width);
  for (const schema::Patch& patch : scene.patches) painter.patch(patch);
  return painter.bottom();
}

constexpr double kPageWidth = 520, kPageMargin = 14, kMapLeft = 62, kMapHeight = 520;
constexpr double kBelowMap = 44, kLegendRow = 16;
constexpr double kLongestArrow = 42, kArrowHead = 5;
constexpr Colour kHalo{1, 1, 1, 0.8}, kLabelGround{1, 1, 1, 0.85}, kSpringInk{0.62, 0.36, 0.0};
const Pen kOutline{spatial::kInk, 1}, kAddedOutline{spatial::kInk, 1, true};
const Pen kTravelPen{spatial::kGreyInk, 0.9, true}, kSpringWay{kSpringInk, 0.7, true};
const TextStyle kName{.size = 9.5, .bold = true, .align_x = 0, .align_y = 0}, kLegendText{.size = 9};

constexpr Colour kBodyInk{0.45, 0.25, 0.55};
const Pen kBodyPath{kBodyInk, 1.2}, kLassoReach{kBodyInk, 0.7, true};

Colour path_colour() {
  return spatial::series_colour(0);
}
Colour force_colour() {
  return spatial::series_colour(1);
}

void draw_disc(Canvas& canvas, Point at, double radius, const Colour& colour) {
  std::vector<Point> edge;
  for (int i = 0; i < 24; ++i) {
    const double angle = i * std::numbers::pi / 12;
    edge.push_back({at.x + radius * std::cos(angle), at.y + radius * std::sin(angle)});
  }
  canvas.polygon(edge, colour);
}

// A circle with a cross: where the force of a spring is 0.
void draw_target(Canvas& canvas, Point at) {
  draw_disc(canvas, at, 5, kSpringInk);
  draw_disc(canvas, at, 3.9, {1, 1, 1});
  const Segment cross[] = {{{at.x - 7, at.y}, {at.x + 7, at.y}}, {{at.x, at.y - 7}, {at.x, at.y + 7}}};
  canvas.lines(cross, {kSpringInk, 0.9});
}

// A brick.
void draw_body(Canvas& canvas, Point at) {
  canvas.fill({at.x - 5, at.y - 5, 10, 10}, kHalo);
  canvas.fill({at.x - 4, at.y - 4, 8, 8}, kBodyInk);
}

void draw_circle(Canvas& canvas, Point at, double radius, const Pen& pen) {
  std::vector<Point> edge;
  for (int i = 0; i <= 48; ++i) {
    const double angle = i * std::numbers::pi / 24;
    edge.push_back({at.x + radius * std::cos(angle), at.y + radius * std::sin(angle)});
  }
  canvas.polyline(edge, pen);
}

void draw_arrow(Canvas& canvas, Point from, Point to) {
  const double x = to.x - from.x, y = to.y - from.y, length = std::hypot(x, y);
  if (length < 0.3) return;
  const double head = std::min(kArrowHead, 0.6 * length), u = x / length, v = y / length;
  const Point neck{to.x - head * u, to.y - head * v};
  const double half = 0.42 * head;
  canvas.line(from, neck, {kHalo, 2.4});
  canvas.line(from, neck, {force_colour(), 1.1});
  const Point tip[] = {to, {neck.x - half * v, neck.y + half * u}, {neck.x + half * v, neck.y - half * u}};
  canvas.polygon(tip, force_colour());
}

// The largest of 1, 2, 5 times a power of ten up to a value above 0.
double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  return power * (value >= 5 * power ? 5 : value >= 2 * power ? 2 : 1);
}

// A bump in the shading of the picture.
spatial::Pixels bump_sample(int size) {
  spatial::Pixels pixels{size, size, {}};
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const double x = (column + 0.5) / size * 2 - 1, y = 1 - (row + 0.5) / size * 2;
      const double steep = std::hypot(x, y) < 0.85 ? 1.6 : 0;
      pixels.rgb.push_back(acting_colour(kActsRelief, hill_shade(steep * x, steep * y, 1)));
    }
  return pixels;
}

bool boxes_meet(const Box& a, const Box& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

// The patches on the page. Index 0 is the topmost.
class PatchPainter {
 public:
  PatchPainter(Canvas& canvas, const SceneMap& map, const std::vector<schema::Patch>& patches)
      : canvas_(canvas), map_(map), patches_(patches) {
    for (const schema::Patch& patch : patches) frames_.emplace_back(patch);
  }

  void outlines() {
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      const auto corners = frames_[i].corners();
      std::vector<Segment> seen;
      for (std::size_t side = 0; side < 4; ++side)
        add_visible(i, corners[side], corners[(side + 1) % 4], seen);
      const bool adds = patches_[i].combine == schema::PatchCombine::add;
      canvas_.lines(seen, adds ? kAddedOutline : kOutline);
    }
  }

  void spring_places() {
    for (std::size_t i = 0; i < patches_.size(); ++i)
      for (const schema::ForceLayer& layer : patches_[i].layers)
        layer.visit(
            [&](const schema::SpringLayer& spring) {
              const Point at =
                  map_.place(frames_[i].in_plane(spring.centre_x_m.value, spring.centre_y_m.value));
              if (!holds(map_.box, at)) return;
              canvas_.line(map_.place(frames_[i].in_plane(0, 0)), at, kSpringWay);
              draw_target(canvas_, at);
              taken_.push_back({at.x - 8, at.y - 8, 16, 16});
            },
            [](const auto& /*other*/) {});
  }

  // Where a session took them up, with their paths; without a session in the middle of their patches. Around
  // a lasso: up to where its force is 0.
  void bodies(const std::vector<BodyOfScene>& all, const std::vector<HandPath>& paths) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      Point at = map_.place(frames_[all[i].patch].in_plane(0, 0));
      if (i < paths.size()) {
        if (paths[i].lines().empty()) continue;  // never taken up
        for (const auto& line : paths[i].lines()) canvas_.polyline(line, kBodyPath);
        avoid(paths[i]);
        at = paths[i].start();
      }
      if (all[i].length_m > 0) draw_circle(canvas_, at, all[i].length_m * map_.points_per_m(), kLassoReach);
      draw_body(canvas_, at);
      taken_.push_back({at.x - 5, at.y - 5, 10, 10});
    }
  }

  // Names are not written on a path.
  void avoid(const HandPath& path) {
    constexpr double kHalf = 2;
    Point last{-INFINITY, 0};
    for (const auto& line : path.lines())
      for (const Point at : line) {
        if (std::hypot(at.x - last.x, at.y - last.y) < kHalf) continue;
        taken_.push_back({at.x - kHalf, at.y - kHalf, 2 * kHalf, 2 * kHalf});
        last = at;
      }
  }

  void names() {
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      const spatial::Size size = canvas_.text_size(patches_[i].name, kName);
      const Box box = place_for(i, {size.width + 6, size.height + 2});
      taken_.push_back(box);
      canvas_.fill(box, kLabelGround);
      canvas_.text({box.x + 3, box.y + 1}, patches_[i].name, kName);
    }
  }

 private:
  static bool holds(const Box& box, Point at) {
    return at.x >= box.x && at.x <= box.right() && at.y >= box.y && at.y <= box.bottom();
  }
  Point in_plane(Point at) const { return {1e-3 * map_.x.value(at.x), 1e-3 * map_.y.value(at.y)}; }
  // Whether no patch covers patch i at this place.
  bool is_on_top(std::size_t i, Point place_m) const {
    for (std::size_t above = 0; above < i; ++above)
      if (patches_[above].combine == schema::PatchCombine::topmost && frames_[above].holds(place_m))
        return false;
    return true;
  }

  // The parts of a side that are not covered, in steps of about half a point.
  void add_visible(std::size_t i, Point from_m, Point to_m, std::vector<Segment>& seen) const {
    const double length = std::hypot(to_m.x - from_m.x, to_m.y - from_m.y) * map_.points_per_m();
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * length)));
    const auto at = [&](double step) {
      return Point{std::lerp(from_m.x, to_m.x, step / steps), std::lerp(from_m.y, to_m.y, step / steps)};
    };
    bool drawing = false;
    for (int step = 0; step < steps; ++step) {
      const bool visible = is_on_top(i, at(step + 0.5));
      if (visible && !drawing) seen.push_back({map_.place(at(step)), {}});
      if (visible) seen.back().to = map_.place(at(step + 1));
      drawing = visible;
    }
  }

  // The first place from the top left, row by row, in which the whole name is on its patch. A patch without
  // such a place has its name above it.
  Box place_for(std::size_t i, spatial::Size size) const {
    double left = INFINITY, right = -INFINITY, top = INFINITY, bottom = -INFINITY;
    for (const Point corner : frames_[i].corners()) {
      const Point at = map_.place(corner);
      left = std::min(left, at.x), right = std::max(right, at.x);
      top = std::min(top, at.y), bottom = std::max(bottom, at.y);
    }
    constexpr double kStep = 3;
    for (double y = top + kStep; y + size.height <= bottom; y += kStep)
      for (double x = left + kStep; x + size.width <= right; x += kStep)
        if (const Box box{x, y, size.width, size.height}; is_free(i, box)) return box;
    const double x = std::clamp(left, map_.box.x, std::max(map_.box.x, map_.box.right() - size.width));
    return {x, std::max(map_.box.y, top - size.height - 1), size.width, size.height};
  }

  bool is_free(std::size_t i, const Box& box) const {
    if (std::ranges::any_of(taken_, [&](const Box& other) { return boxes_meet(box, other); })) return false;
    for (const Point at : {Point{box.x, box.y}, Point{box.right(), box.y}, Point{box.x, box.bottom()},
                           Point{box.right(), box.bottom()}})
      if (const Point place_m = in_plane(at); !frames_[i].holds(place_m) || !is_on_top(i, place_m))
        return false;
    return true;
  }

  Canvas& canvas_;
  const SceneMap& map_;
  const std::vector<schema::Patch>& patches_;
  std::vector<PatchFrame> frames_;
  std::vector<Box> taken_;
};

// Samples with their words, in as many rows as they need.
class SceneLegend {
 public:
  SceneLegend(Canvas& canvas, double top) : canvas_(canvas), at_{kPageMargin, top} {}

  void add(double sample_width, const std::string& words, const auto& draw_sample) {
    constexpr double kGap = 6, kBetween = 16;
    const double width = sample_width + kGap + canvas_.text_size(words, kLegendText).width;
    if (at_.x > kPageMargin && at_.x + width > kPageWidth - kPageMargin)
      at_ = {kPageMargin, at_.y + kLegendRow};
    draw_sample(at_);
    draw_fitted(canvas_, {at_.x + sample_width + kGap, at_.y}, words, kLegendText,
                kPageWidth - kPageMargin - at_.x - sample_width - kGap);
    at_.x += width + kBetween;
  }
  void add_tint(std::uint8_t acts, const std::string& words) {
    add(18, words, [&](Point at) {
      const std::uint32_t rgb = acting_colour(acts, 1);
      const auto part = [&](int shift) { return (rgb >> shift & 0xFF) / 255.0; };
      canvas_.fill({at.x, at.y - 5, 18, 10}, {part(16), part(8), part(0)});
    });
  }
  void add_line(const Pen& pen, const std::string& words) {
    add(22, words, [&](Point at) { canvas_.line(at, {at.x + 22, at.y}, pen); });
  }
  double bottom() const { return at_.y + kLegendRow / 2; }

 private:
  Canvas& canvas_;
  Point at_;  // of the next sample, in the middle of its height
};

// Its lowest and highest place; 0 along an axis that the device does not have.
Segment travel_of(const schema::Device& device) {
  Segment travel_m;
  for (const schema::DeviceAxis& axis : device.axes) {
    if (axis.name == "x") travel_m.from.x = axis.travel_from_m, travel_m.to.x = axis.travel_to_m;
    if (axis.name == "y") travel_m.from.y = axis.travel_from_m, travel_m.to.y = axis.travel_to_m;
  }
  return travel_m;
}

void draw_travel(Canvas& canvas, const SceneMap& map, const schema::Device& device) {
  const Segment travel_m = travel_of(device);
  const Point from = map.place(travel_m.from), to = map.place(travel_m.to);
  canvas.frame({from.x, to.y, to.x - from.x, from.y - to.y}, kTravelPen);
}

double newtons_per_point(const HandPath& path) {
  return path.largest_force_n() / kLongestArrow;
}

void draw_hand(Canvas& canvas, const HandPath& path) {
  for (const Pen& pen : {Pen{kHalo, 3}, Pen{path_colour(), 1.2}})
    for (const auto& line : path.lines()) canvas.polyline(line, pen);
  for (const ForceArrow& arrow : path.arrows()) {
    const double scale = 1 / newtons_per_point(path);
    draw_arrow(canvas, arrow.from, {arrow.from.x + scale * arrow.x_n, arrow.from.y - scale * arrow.y_n});
  }
  draw_disc(canvas, path.start(), 4.2, {1, 1, 1});
  draw_disc(canvas, path.start(), 3.2, path_colour());
}

void draw_map_axes(Canvas& canvas, const SceneMap& map) {
  const auto count = [](double length) { return std::max(2, static_cast<int>(length / 45)); };
  const auto x_ticks = ticks_of(map.x, count(map.box.width)),
             y_ticks = ticks_of(map.y, count(map.box.height));
  canvas.frame(map.box, {});
  draw_axis(canvas, map.box, spatial::Side::bottom, map.x, x_ticks);
  draw_axis(canvas, map.box, spatial::Side::left, map.y, y_ticks);
  draw_caption(canvas, map.box, spatial::Side::bottom, "x (mm)", 26);
  draw_caption(canvas, map.box, spatial::Side::left, "y (mm)", 42);
}

void add_scale_bar(Canvas& canvas, SceneLegend& legend, const SceneMap& map) {
  const double bar_m = round_down(map.box.width / map.points_per_m() / 6);
  const double bar = bar_m * map.points_per_m();
  legend.add(bar, spatial::typeset(schema::length_for_people(bar_m)), [&](Point at) {
    const Segment lines[] = {{at, {at.x + bar, at.y}},
                             {{at.x, at.y - 3}, {at.x, at.y + 3}},
                             {{at.x + bar, at.y - 3}, {at.x + bar, at.y + 3}}};
    canvas.lines(lines, {spatial::kInk, 1.4});
  });
}

constexpr std::uint8_t kBothTints = kActsSpring | kActsDamper;

std::uint8_t tint_of(const schema::Patch& patch) {
  std::uint8_t tint = 0;
  for (const schema::ForceLayer& layer : patch.layers)
    tint = static_cast<std::uint8_t>(tint | (acts_of(layer) & kBothTints));
  return tint;
}

// "spring, body": the types of one tint; of the patches with this tint, or of all if there is none: then
// patches that are added to each other have it.
std::string types_with(const std::vector<schema::Patch>& patches, std::uint8_t acts, std::uint8_t tint) {
  const bool any = std::ranges::find(patches, tint, tint_of) != patches.end();
  std::vector<std::string_view> types;
  for (const schema::Patch& patch : patches)
    for (const schema::ForceLayer& layer : patch.layers)
      if (const std::string_view type = schema::type_of(layer); acts_of(layer) == acts &&
                                                                (!any || tint_of(patch) == tint) &&
                                                                std::ranges::find(types, type) == types.end())
        types.push_back(type);
  return fmt::format("{}", fmt::join(types, ", "));
}

void add_kinds(Canvas& canvas, SceneLegend& legend, const ReliefRaster& raster,
               const std::vector<schema::Patch>& patches) {
  const auto acts = [&](std::uint8_t what) {
    return std::ranges::any_of(raster.acts, [&](std::uint8_t pixel) { return (pixel & what) != 0; });
  };
  if (acts(kActsRelief)) {
    const std::string words =
        fmt::format("a bump of the relief, light from the upper left; a slope of 45\u00b0 is a force of {}",
                    schema::for_people(raster.full_n, Dimension::force));
    legend.add(14, words, [&](Point at) { canvas.image({at.x, at.y - 7, 14, 14}, bump_sample(28)); });
  }
  const auto tinted = [&](std::uint8_t tint, const std::string& words) {
    const auto is = [&](std::uint8_t pixel) { return (pixel & kBothTints) == tint; };
    if (std::ranges::any_of(raster.acts, is)) legend.add_tint(tint, words);
  };
  tinted(kActsSpring, types_with(patches, kActsSpring, kActsSpring));
  tinted(kActsDamper, types_with(patches, kActsDamper, kActsDamper));
  tinted(kBothTints, types_with(patches, kActsSpring, kBothTints) + " and " +
                         types_with(patches, kActsDamper, kBothTints));
  const auto is_spring = [](const schema::ForceLayer& layer) { return schema::type_of(layer) == "spring"; };
  if (std::ranges::any_of(
          patches, [&](const schema::Patch& patch) { return std::ranges::any_of(patch.layers, is_spring); }))
    legend.add(14, "where the force of a spring is 0", [&](Point at) {
      draw_target(canvas, {at.x + 7, at.y});
    });
}

void add_hand_words(Canvas& canvas, SceneLegend& legend, const HandSession& session, const HandPath& path) {
  const std::string words = fmt::format("hand in {}, {} from the dot", session.path,
                                        schema::for_people(session.duration_s, Dimension::time));
  legend.add(22, words, [&](Point at) {
    canvas.line(at, {at.x + 22, at.y}, {path_colour(), 1.2});
    draw_disc(canvas, at, 3.2, path_colour());
  });
  if (path.arrows().empty()) return;
  const double force_n = round_down(path.largest_force_n()), length = force_n / newtons_per_point(path);
  legend.add(length, "force on the hand, " + schema::for_people(force_n, Dimension::force), [&](Point at) {
    draw_arrow(canvas, at, {at.x + length, at.y});
  });
}

void add_body_words(Canvas& canvas, SceneLegend& legend, const std::vector<BodyOfScene>& bodies,
                    bool with_paths) {
  if (bodies.empty()) return;
  legend.add(22,
             with_paths ? "path of a body from where the hand took it up"
                        : "body: taken up where the hand enters its patch",
             [&](Point at) {
               if (with_paths) canvas.line(at, {at.x + 22, at.y}, kBodyPath);
               draw_body(canvas, {at.x + 5, at.y});
             });
  if (std::ranges::any_of(bodies, [](const BodyOfScene& body) { return body.length_m > 0; }))
    legend.add_line(kLassoReach, "up to here a lasso does not pull");
}

bool adds_a_patch(const std::vector<schema::Patch>& patches) {
  return std::ranges::any_of(
      patches, [](const schema::Patch& patch) { return patch.combine == schema::PatchCombine::add; });
}

PlaneRange plane_range_of(const ScenePicture& picture) {
  PlaneRange range;
  for (const schema::Patch& patch : picture.scene.patches)
    for (const Point corner : PatchFrame(patch).corners()) range.add(corner);
  if (picture.session) {
    range.add({picture.session->range.left_m, picture.session->range.low_m});
    range.add({picture.session->range.right_m, picture.session->range.high_m});
  }
  if (!picture.device) return range;
  const Segment travel_m = travel_of(*picture.device);
  range.add(travel_m.from);
  range.add(travel_m.to);
  return range;
}

// Grooves are filtered for a device; this one has no limit that needs a filter.
schema::Device any_device() {
  schema::Device device;
  for (const char* name : {"x", "y"}) {
    schema::DeviceAxis axis;
    axis.name = name;
    axis.mass_kg = 1;
    axis.viscous_n_s_per_m = 1e6;
    axis.encoder_step_m = 1e-5;
    device.axes.push_back(axis);
  }
  device.rates_hz = {1000};
  return device;
}

}  // namespace

Result<ScenePicture> read_scene_picture(const std::string& scene, const std::string& device,
                                        const std::string& hand, const std::string& session) {
  ScenePicture picture;
  const std::string file = schema::scene_path(scene);
  auto read = schema::read_scene(file);
  TACTO_TRY(read);
  picture.scene = std::move(*read);
  TACTO_TRY(schema::check_only_plane(picture.scene, file));
  picture.name = picture.scene.name.empty() ? scene : picture.scene.name;
  if (picture.scene.patches.empty())
    return schema::fail(schema::ErrorKind::unsuitable, "this scene has no force patches: it is of a tray",
                        file, "draw its textures with 'tactograph spectrogram'");
  schema::Device prepared_for = any_device();
  if (!device.empty()) {
    auto known = schema::read_device(device);
    TACTO_TRY(known);
    prepared_for = *known;
    picture.device = std::move(*known);
  }
  const auto setup = playback::force_setup_of(prepared_for, std::nullopt);
  TACTO_TRY(setup);
  picture.rate_hz = double{setup->rate_hz};
  std::optional<schema::Hand> held;
  if (!hand.empty()) {
    auto known = schema::read_hand(hand);
    TACTO_TRY(known);
    held = std::move(*known);
  }
  auto prepared = playback::prepare_scene(picture.scene, file, prepared_for, picture.rate_hz, held);
  TACTO_TRY(prepared);
  picture.prepared = std::move(*prepared);
  if (session.empty()) return picture;
  auto played = read_hand_session(session);
  TACTO_TRY(played);
  picture.session = std::move(*played);
  return picture;
}

Result<SceneFigure> SceneFigure::make(ScenePicture picture, const std::function<void(double)>& progress) {
  SceneFigure made(std::move(picture));
  const ScenePicture& of = made.picture_;
  made.heading_ = spatial::heading_of(of.name, "Force patches of a scene, from above",
                                      of.session ? of.session->simulated : "", kPageWidth - 2 * kPageMargin);
  made.map_ = scene_map(plane_range_of(of), {kMapLeft, kPageMargin + made.heading_.height()},
                        {kPageWidth - kMapLeft - kPageMargin, kMapHeight});
  made.raster_ = relief_raster(of.prepared, of.rate_hz, made.map_.grid, progress);
  made.bodies_ = bodies_of(of.prepared.patches);
  if (!of.session) return made;
  auto path = read_hand_path(of.session->path, made.map_);
  TACTO_TRY(path);
  made.path_ = std::move(*path);
  if (made.bodies_.empty()) return made;
  auto bodies = read_body_paths(of.session->path, made.map_, made.bodies_);
  TACTO_TRY(bodies);
  made.body_paths_ = std::move(*bodies);
  return made;
}

double SceneFigure::draw_below_map(Canvas& canvas) const {
  SceneLegend legend(canvas, map_.box.bottom() + kBelowMap);
  add_scale_bar(canvas, legend, map_);
  add_kinds(canvas, legend, raster_, picture_.prepared.patches);
  add_body_words(canvas, legend, bodies_, path_.has_value());
  if (adds_a_patch(picture_.scene.patches)) legend.add_line(kAddedOutline, "added to what is below");
  if (picture_.device) legend.add_line(kTravelPen, "travel of " + picture_.device->name);
  if (path_) add_hand_words(canvas, legend, *picture_.session, *path_);
  return draw_patch_list(canvas, picture_.scene, {kPageMargin, legend.bottom() + 4},
                         kPageWidth - 2 * kPageMargin);
}

spatial::Size SceneFigure::page() const {
  Canvas ruler(spatial::PictureFormat::png, {1, 1});
  return {kPageWidth, std::ceil(draw_below_map(ruler) + kPageMargin)};
}

Result<void> SceneFigure::draw(Canvas& canvas) const {
  draw_heading(canvas, {kPageMargin, kPageMargin}, heading_);
  canvas.clip(map_.box);
  canvas.image(map_.box, shaded(raster_));
  if (picture_.device) draw_travel(canvas, map_, *picture_.device);
  PatchPainter patches(canvas, map_, picture_.prepared.patches);
  patches.outlines();
  patches.spring_places();
  patches.bodies(bodies_, body_paths_);
  if (path_) {
    draw_hand(canvas, *path_);
    patches.avoid(*path_);
  }
  patches.names();
  canvas.release();
  draw_map_axes(canvas, map_);
  draw_below_map(canvas);
  return {};
}

}  // namespace tacto::analysis
