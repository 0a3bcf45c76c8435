// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/compare_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "analysis/page/html.hpp"
#include "analysis/page/picture_svg.hpp"
#include "data-schema/base/decibels.hpp"
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

constexpr std::size_t kMostPoints = 2000;
constexpr double kPerMm = 1e-3;  // 1/m as 1/mm
constexpr const char* kFrequencyLabel = "spatial frequency (1/mm)";

std::string signal_label(const TexturePair& pair) {
  if (pair.unit == "N") return "force (mN)";
  if (pair.unit == "m") return pair.quantity + " (µm)";
  return fmt::format("{} ({})", pair.quantity, pair.unit);
}

double shown_scale(const std::string& unit) {
  if (unit == "N") return 1e3;
  return unit == "m" ? 1e6 : 1;
}

// The mean density of the bins within each of the equal steps of a logarithmic axis.
ResultCurve density_curve(const Comparison& c, const std::string& name, const std::vector<double>& density) {
  ResultCurve curve{name, {}, {}, false};
  const double scale = (c.pair.unit == "m" ? 1e12 : 1) / kPerMm;  // per 1/mm, from per 1/m
  constexpr double kStepsADecade = 200;
  double sum = 0, frequencies = 0, count = 0;
  long step = 0;
  const auto flush = [&] {
    if (count > 0 && sum > 0) {
      curve.x.push_back(kPerMm * frequencies / count);
      curve.y.push_back(schema::power_db(scale * sum / count));
    }
    sum = frequencies = count = 0;
  };
  for (std::size_t k = 0; k < density.size(); ++k) {
    const double frequency = c.spectra.frequency[k];
    if (frequency < c.low_per_m || frequency > c.high_per_m) continue;
    const long next = std::lround(std::floor(kStepsADecade * std::log10(frequency)));
    if (next != step) flush();
    step = next;
    sum += density[k], frequencies += frequency, count += 1;
  }
  flush();
  return curve;
}

// A step curve: each band's value from its lower to its upper edge.
template <class Value>
ResultCurve band_curve(const Comparison& c, const std::string& name, bool dashed, Value value) {
  ResultCurve curve{name, {}, {}, dashed};
  for (const BandComparison& band : c.bands)
    for (const double edge :
         {std::max(band.low_per_m, c.low_per_m), std::min(band.high_per_m, c.high_per_m)}) {
      curve.x.push_back(kPerMm * edge);
      curve.y.push_back(value(band));
    }
  return curve;
}

ResultPicture spectra_picture(const Comparison& c, const ComparedNames& names) {
  const std::string unit = c.pair.unit == "m" ? "µm² mm" : c.pair.unit + "² mm";  // as in spectrograms
  return {"Spectra (Welch)",
          kFrequencyLabel,
          fmt::format("density (dB re 1 {})", unit),
          true,
          {density_curve(c, names.a, c.spectra.aa), density_curve(c, names.b, c.spectra.bb)}};
}

ResultPicture difference_picture(const Comparison& c) {
  ResultPicture picture{
      "Difference by one-third-octave band: B over A", kFrequencyLabel, "level (dB)", true, {}};
  picture.curves.push_back(band_curve(c, "level", false, [](const auto& b) { return b.level_db; }));
  picture.curves.push_back(band_curve(c, "± 2 standard errors", true,
                                      [](const auto& b) { return b.level_db + 2 * b.scatter_db; }));
  picture.curves.push_back(
      band_curve(c, "", true, [](const auto& b) { return b.level_db - 2 * b.scatter_db; }));
  picture.curves.push_back({"0 dB", {kPerMm * c.low_per_m, kPerMm * c.high_per_m}, {0, 0}, true});
  if (band_differs(c.evidence, c.tolerance_db)) {
    const NarrowBand& band = *c.evidence.narrow;
    const double level_db = c.evidence.level_db + band.level_db;
    picture.curves.push_back(
        {"narrow band", {kPerMm * band.low_per_m, kPerMm * band.high_per_m}, {level_db, level_db}, false});
  }
  if (c.pair.paired)
    picture.curves.push_back(
        band_curve(c, "error of B re A", false, [](const auto& b) { return b.error_db.value_or(NAN); }));
  return picture;
}

ResultPicture coherence_picture(const Comparison& c) {
  ResultCurve coherence{"coherence", {}, {}, false};
  const std::size_t step = c.spectra.frequency.size() / kMostPoints + 1;
  for (std::size_t k = 0; k < c.spectra.frequency.size(); k += step) {
    if (c.spectra.frequency[k] < c.low_per_m || c.spectra.frequency[k] > c.high_per_m) continue;
    coherence.x.push_back(kPerMm * c.spectra.frequency[k]);
    coherence.y.push_back(c.spectra.coherence[k]);
  }
  ResultCurve chance{"chance, once in 20", {kPerMm * c.low_per_m, kPerMm * c.high_per_m}, {}, true};
  chance.y.assign(2, c.chance_coherence);
  return {"Coherence, magnitude-squared",
          kFrequencyLabel,
          "coherence",
          true,
          {std::move(coherence), std::move(chance)}};
}

// A section in the middle, short enough to show single waves.
ResultPicture signal_picture(const Comparison& c, const ComparedNames& names) {
  const std::size_t size = std::min(c.pair.a.size(), c.pair.b.size());
  const double wave_m = 40 / std::sqrt(c.low_per_m * c.high_per_m);
  const auto shown = std::min(size, static_cast<std::size_t>(wave_m / c.pair.pitch_m) + 2);
  const std::size_t first = (size - shown) / 2, step = shown / kMostPoints + 1;
  ResultPicture picture{"The middle of the compared part",
                        "position in A (mm)",
                        signal_label(c.pair),
                        false,
                        {{names.a, {}, {}, false}, {names.b, {}, {}, true}}};
  const double scale = shown_scale(c.pair.unit);
  for (std::size_t i = first; i < first + shown; i += step) {
    const double position_mm = 1e3 * (c.pair.a_from_m + static_cast<double>(i) * c.pair.pitch_m);
    for (ResultCurve& curve : picture.curves) curve.x.push_back(position_mm);
    picture.curves[0].y.push_back(scale * c.pair.a[i]);
    picture.curves[1].y.push_back(scale * c.pair.b[i]);
  }
  return picture;
}

std::string optional_db(const std::optional<double>& value) {
  return value ? fmt::format("{:.1f} dB", *value) : "";
}

// Never "-0.0 dB".
std::string signed_db(double value) {
  return fmt::format("{:+.1f} dB", std::round(10 * value) / 10 + 0.0);
}

std::string bands_table(const Comparison& c) {
  std::vector<std::vector<std::string>> rows = {
      {"band (1/mm)", "B over A", "± standard error", "error re A", "residual after the gain", "coherence"}};
  for (const BandComparison& band : c.bands)
    rows.push_back({fmt::format("{:.3g}{}", kPerMm * band.centre_per_m, band.partial ? " (part)" : ""),
                    signed_db(band.level_db), fmt::format("{:.1f} dB", band.scatter_db),
                    optional_db(band.error_db), optional_db(band.residual_db),
                    band.coherence ? fmt::format("{:.2f}", *band.coherence) : ""});
  return html_table(rows);
}

std::string formants_table(const Comparison& c) {
  std::vector<std::vector<std::string>> rows = {{"formant", "A (1/mm)", "B (1/mm)", "level, B over A"}};
  const auto place = [](const schema::Formant& f) {
    return fmt::format("{:.3f}", kPerMm * f.frequency_per_m);
  };
  for (const auto& [i, j] : c.formants.matched)
    rows.push_back({"matched", place(c.a_formants[i]), place(c.b_formants[j]),
                    signed_db(c.b_formants[j].level_db - c.a_formants[i].level_db)});
  for (const std::size_t i : c.formants.missed) rows.push_back({"only in A", place(c.a_formants[i]), "", ""});
  for (const std::size_t j : c.formants.extra) rows.push_back({"only in B", "", place(c.b_formants[j]), ""});
  return rows.size() == 1 ? "<p>Neither has formants.</p>\n" : html_table(rows);
}

std::string strongest_words(const Comparison& c) {
  const auto& band = c.evidence.narrow;
  if (!band) return "not searched: fewer than 6 cells";
  return fmt::format("B {:+.1f} dB from {} to {}, score {:.1f}, chance {:.1f}: {}", band->level_db,
                     for_people(band->low_per_m, Dimension::spatial_frequency),
                     for_people(band->high_per_m, Dimension::spatial_frequency), band->score,
                     band->chance_score,
                     band_differs(c.evidence, c.tolerance_db) ? "a difference" : "no difference");
}

std::string line_figure(const Comparison& c) {
  const auto& line = c.evidence.line;
  if (!line) return "not searched: too short";
  return fmt::format("in {} at {}, {:.1f} dB above the density, score {:.1f}, chance {:.1f}: {}",
                     line->in_b ? "B" : "A", for_people(line->frequency_per_m, Dimension::spatial_frequency),
                     line->level_db, line->score, line->chance_score,
                     line_differs(c.evidence, c.tolerance_db) ? "a difference" : "no difference");
}

std::string rms_figure(const Comparison& c) {
  const auto words = [&](double rms) {
    if (c.pair.unit == "N") return for_people(rms, Dimension::force);
    if (c.pair.unit == "m") return for_people(rms, Dimension::length);
    return fmt::format("{:.4g} {}", rms, c.pair.unit);
  };
  return fmt::format("A {}, B {}", words(c.a_rms), words(c.b_rms));
}

// The error, or the verdict and the first of its reasons.
std::string answer_words(const Comparison& c, const ComparedNames& names) {
  if (names.with_target) return fmt::format("error {:.1f} dB of the target's power", *c.error_db);
  const std::string& because = c.verdict.because;
  return fmt::format("{}: {}.", verdict_words(c.verdict.likeness), because.substr(0, because.find("; ")));
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
                     answer(verdict_line(c)) + c.simulated().box() +
                     figures_html(surfaces_figures(c), {"verdict", "simulated"});
  for (const std::string& note : c.notes) body += fmt::format("<p class=\"note\">{}</p>\n", escaped(note));
  return html_document(fmt::format("{} against {}: {}", c.b.name, c.a.name, to_string(c.verdict)),
                       body + *pictures);
}

std::vector<ResultPicture> comparison_pictures(const Comparison& c, const ComparedNames& names) {
  std::vector<ResultPicture> pictures = {spectra_picture(c, names), difference_picture(c)};
  if (!c.pair.paired) return pictures;
  pictures.push_back(coherence_picture(c));
  pictures.push_back(signal_picture(c, names));
  return pictures;
}

std::vector<schema::ResultFigure> comparison_figures(const Comparison& c, const ComparedNames& names) {
  std::vector<schema::ResultFigure> figures;
  const auto add = [&](const char* name, std::string value) { figures.push_back({name, std::move(value)}); };
  if (names.with_target)
    add("error, re the target", optional_db(c.error_db));
  else
    add("verdict", fmt::format("{}: {}", verdict_words(c.verdict.likeness), c.verdict.because));
  add("compared",
      fmt::format("{} from {} on in A, {} to {}", for_people(c.pair.length_m(), Dimension::length),
                  for_people(c.pair.a_from_m, Dimension::length),
                  for_people(c.low_per_m, Dimension::spatial_frequency),
                  for_people(c.high_per_m, Dimension::spatial_frequency)));
  add("RMS in that band", rms_figure(c));
  if (!names.with_target) {
    add("detectable", detectable_words(c.evidence, c.tolerance_db));
    add("level, B over A", fmt::format("{:+.2f} dB", c.evidence.level_db));
    add("strongest narrow band, relative to the mean level", strongest_words(c));
    add("strongest line of one texture", line_figure(c));
    add("spectral distance",
        fmt::format("{:.2f} dB RMS over {} bands", c.spectral_distance_db, c.bands.size()));
    add("formants", fmt::format("{} matched, {} only in A, {} only in B", c.formants.matched.size(),
                                c.formants.missed.size(), c.formants.extra.size()));
  }
  if (!c.pair.paired) return figures;
  add("coherence", c.point_by_point
                       ? fmt::format("{:.2f}; chance {:.2f}: {:.0f} % of the power agrees point by point",
                                     *c.coherence, c.chance_coherence, 100 * *c.coherence)
                       : fmt::format("{:.2f}; chance {:.2f}: no agreement point by point", *c.coherence,
                                     c.chance_coherence));
  add("gain, least squares", fmt::format("{:.3g}", *c.gain));
  if (!names.with_target) add("error of B re A", optional_db(c.error_db));
  add("residual after the best gain, re B", optional_db(c.residual_db));
  return figures;
}

schema::Result<std::string> comparison_page(const Comparison& c, const ComparedNames& names) {
  const auto pictures = pictures_html(comparison_pictures(c, names), c.simulated.words());
  TACTO_TRY(pictures);
  std::string body = fmt::format("<h1>{} against {}</h1>\n", escaped(names.b), escaped(names.a)) +
                     answer(answer_words(c, names)) +
                     fmt::format("<p>A is {}, B is {}.</p>\n", escaped(names.a), escaped(names.b)) +
                     c.simulated.box();
  body += figures_html(comparison_figures(c, names));
  for (const std::string& note : c.notes) body += fmt::format("<p class=\"note\">{}</p>\n", escaped(note));
  body +=
      *pictures + folded("By one-third-octave band", bands_table(c)) + folded("Formants", formants_table(c));
  return html_document(
      fmt::format("{} against {}: {}", names.b, names.a,
                  names.with_target ? optional_db(c.error_db) : verdict_words(c.verdict.likeness)),
      body);
}

}  // namespace tacto::analysis
