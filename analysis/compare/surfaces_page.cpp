// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/surfaces_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "analysis/page/html.hpp"
#include "analysis/page/picture_svg.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::for_people;
using schema::ResultCurve;
using schema::ResultPicture;

constexpr const char* kSixthsLabel = "spatial frequency (1/mm)";

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

// "different, for these recordings (p 0.001; 12 + 12 strokes, 1 recording a side)"
std::string verdict_line(const SurfaceComparison& c) {
  const std::string recordings =
      c.a.recordings == c.b.recordings
          ? counted(c.a.recordings, "recording") + " a side"
          : fmt::format("{} + {}", c.a.recordings, counted(c.b.recordings, "recording"));
  std::string figures;
  if (c.verdict == SurfaceVerdict::no_difference_found)
    figures = fmt::format("{}none above {:.1f} dB; ",
                          c.test && c.test->p <= kTestLevel ? "below the tolerance; " : "",
                          c.finest_third_octave_db);
  if (c.test) figures += fmt::format("p {:.3f}; ", c.test->p);
  const bool these = !c.by_recording && c.verdict != SurfaceVerdict::undecided;
  return fmt::format("{}{} ({}{} + {}, {})", to_string(c.verdict), these ? ", for these recordings" : "",
                     figures, c.a.strokes, counted(c.b.strokes, "stroke"), recordings);
}

std::string condition_words(const SurfaceComparison& c, std::optional<double> SideFacts::*member,
                            Dimension dimension) {
  if (!(c.a.*member && c.b.*member)) return "not known";
  return fmt::format("A {}, B {}", for_people(*(c.a.*member), dimension),
                     for_people(*(c.b.*member), dimension));
}

ResultCurve curve_of(const SurfaceComparison& c, std::string name, bool dashed,
                     const std::function<double(std::size_t)>& level_db) {
  ResultCurve curve{std::move(name), {}, {}, dashed};
  for (std::size_t i = 0; i + 1 < c.edges_per_m.size(); ++i) {
    curve.x.push_back(1e-3 * std::sqrt(c.edges_per_m[i] * c.edges_per_m[i + 1]));
    curve.y.push_back(level_db(i));
  }
  return curve;
}

}  // namespace

std::vector<schema::ResultFigure> surfaces_figures(const SurfaceComparison& c) {
  std::vector<schema::ResultFigure> figures = {{"verdict", verdict_line(c)}, {"because", c.because}};
  const auto add = [&](const char* name, std::string value) { figures.push_back({name, std::move(value)}); };
  add("A", c.a.name);
  add("B", c.b.name);
  if (c.simulated().any()) add("simulated", c.simulated().words());
  add("holds for", c.by_recording ? "recordings like these: the unit is the recording"
                                  : "these recordings: the unit is the stroke");
  add("compared", fmt::format("{} to {}, in bands of a sixth of an octave",
                              for_people(c.edges_per_m.front(), Dimension::spatial_frequency),
                              for_people(c.edges_per_m.back(), Dimension::spatial_frequency)));
  if (c.test) {
    add("spread", fmt::format("{:.1f} dB standard deviation of {}s within a side, in one band",
                              c.test->spread_db, c.by_recording ? "recording" : "stroke"));
    add("detectable",
        fmt::format("{:.1f} dB over any third of an octave, {:.1f} dB over any {:.2g} octaves (each is found "
                    "in at least 8 of 10 comparisons)",
                    c.finest_third_octave_db, c.finest_level_db,
                    0.5 / 3 * static_cast<double>(c.test->windows.back().bands)));
  }
  add("speed", condition_words(c, &SideFacts::speed_mps, Dimension::speed));
  add("load", condition_words(c, &SideFacts::load_n, Dimension::force));
  add("speed and load",
      fmt::format("explain {:.0f} % of the difference between the sides", 100 * (1 - c.separable)));
  return figures;
}

std::vector<ResultPicture> surfaces_pictures(const SurfaceComparison& c) {
  std::vector<ResultPicture> pictures = {
      {"Mean levels of the strokes", kSixthsLabel, fmt::format("level (dB re 1 {}²)", c.unit), true, {}}};
  pictures[0].curves = {curve_of(c, c.a.name, false, [&](std::size_t i) { return c.a.level_db[i]; }),
                        curve_of(c, c.b.name, true, [&](std::size_t i) { return c.b.level_db[i]; })};
  if (!c.test) return pictures;
  const auto& windows = c.test->windows;
  const double reach = c.test->reach;
  pictures.push_back({"Difference: B over A", kSixthsLabel, "level (dB)", true, {}});
  pictures[1].curves = {
      curve_of(c, "level", false, [&](std::size_t i) { return windows[i].level_db; }),
      curve_of(c, "simultaneous 95 % interval", true,
               [&](std::size_t i) { return windows[i].level_db + reach * windows[i].error_db; }),
      curve_of(c, "", true,
               [&](std::size_t i) { return windows[i].level_db - reach * windows[i].error_db; })};
  return pictures;
}

schema::Result<std::string> surfaces_page(const SurfaceComparison& c) {
  const auto pictures = pictures_html(surfaces_pictures(c), c.simulated().words());
  TACTO_TRY(pictures);
  std::string body = fmt::format("<h1>{} against {}</h1>\n", escaped(c.b.name), escaped(c.a.name)) +
                     answer(verdict_line(c)) + c.simulated().box() + figures_html(surfaces_figures(c));
  for (const std::string& note : c.notes) body += fmt::format("<p class=\"note\">{}</p>\n", escaped(note));
  return html_document(fmt::format("{} against {}: {}", c.b.name, c.a.name, to_string(c.verdict)),
                       body + *pictures);
}

}  // namespace tacto::analysis
