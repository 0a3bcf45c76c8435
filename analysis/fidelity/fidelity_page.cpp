// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/fidelity/fidelity_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/page/html.hpp"
#include "analysis/page/picture_svg.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::for_people;
using schema::ResultCurve;
using schema::ResultPicture;

constexpr double kWavesShown = 20;

std::string speed_words(const FidelitySpeed& speed) {
  return speed.speed_mps > 0 ? for_people(speed.speed_mps, Dimension::speed) : "a recorded finger";
}

std::string taken_words(const FidelitySpeed& s) {
  std::string words = fmt::format(
      "the band of {:.0f}-{:.0f} Hz contains {:.1f} % of the power of the played texture; drive peak {} of "
      "{}; ",
      s.low_hz, s.high_hz, s.band_kept_percent, for_people(s.drive_peak_v, Dimension::voltage),
      for_people(s.drive_limit_v, Dimension::voltage));
  if (s.amplitude_limited + s.slew_limited == 0) return words + "no tick limited";
  words += fmt::format("{} ticks limited in range, {} in slew, of {}", s.amplitude_limited, s.slew_limited,
                       s.ticks);
  if (s.removed_db) words += fmt::format(": {:.1f} dB of the drive", *s.removed_db);
  return words;
}

ResultPicture error_picture(const FidelitySpeed& speed) {
  ResultPicture picture{
      "Error by band, " + speed_words(speed), "spatial frequency (1/mm)", "error re target (dB)", true, {}};
  for (const FidelityRow& row : speed.rows) {
    ResultCurve curve{row.tray, {}, {}, false};
    for (const BandComparison& band : row.comparison.bands) {
      curve.x.push_back(1e-3 * band.centre_per_m);
      curve.y.push_back(band.error_db.value_or(NAN));
    }
    picture.curves.push_back(std::move(curve));
  }
  return picture;
}

ResultCurve stretch_curve(const std::string& name, const Comparison& c, const std::vector<double>& values,
                          bool dashed) {
  const double target_m = kWavesShown / std::sqrt(c.low_per_m * c.high_per_m);
  const auto shown = std::min(values.size(), static_cast<std::size_t>(target_m / c.pair.pitch_m) + 2);
  const std::size_t first = (values.size() - shown) / 2, step = shown / 2000 + 1;
  ResultCurve curve{name, {}, {}, dashed};
  for (std::size_t i = first; i < first + shown; i += step) {
    curve.x.push_back(1e3 * (c.pair.a_from_m + static_cast<double>(i) * c.pair.pitch_m));
    curve.y.push_back(1e6 * values[i]);
  }
  return curve;
}

ResultPicture stretch_picture(const FidelitySpeed& speed) {
  const FidelityRow& first = speed.rows.front();
  const FidelityRow& last = speed.rows.back();
  ResultPicture picture{
      "The middle of the path, " + speed_words(speed), "position (mm)", "displacement (µm)", false, {}};
  picture.curves.push_back(stretch_curve("target", first.comparison, first.comparison.pair.a, false));
  picture.curves.push_back(
      stretch_curve("tray: " + first.tray, first.comparison, first.comparison.pair.b, true));
  if (speed.rows.size() > 1)
    picture.curves.push_back(
        stretch_curve("tray: " + last.tray, last.comparison, last.comparison.pair.b, false));
  return picture;
}

std::string in_db(double value) {
  return fmt::format("{:.1f} dB", value);
}

std::string rows_table(const FidelitySpeed& speed, const std::string& simulated) {
  using Row = FidelityRow;
  return html_table(
      speed.rows,
      {{"tray", &Row::tray},
       {"error re target", [](const Row& row) { return in_db(row.error_db); }},
       {"in place", [](const Row& row) { return in_db(row.error_in_place_db); }},
       {"re-recorded", [](const Row& row) { return row.rerecorded_db ? in_db(*row.rerecorded_db) : ""; }},
       {"shift", [](const Row& row) { return for_people(row.shift_m, Dimension::length); }},
       {"level", [](const Row& row) { return fmt::format("{:+.2f} dB", row.level_db); }},
       {"target, RMS", [](const Row& row) { return for_people(row.target_rms_m, Dimension::length); }},
       {"displacement, RMS", [](const Row& row) { return for_people(row.finger_rms_m, Dimension::length); }},
       {"from", [&](const Row&) { return simulated.empty() ? "modelled" : "simulated"; }}});
}

// The largest and the smallest error of all trays and speeds.
std::string fidelity_answer(const Fidelity& fidelity) {
  const FidelitySpeed *best_at = nullptr, *worst_at = nullptr;
  const FidelityRow *best = nullptr, *worst = nullptr;
  for (const FidelitySpeed& speed : fidelity.speeds)
    for (const FidelityRow& row : speed.rows) {
      if (best == nullptr || row.error_db < best->error_db) best = &row, best_at = &speed;
      if (worst == nullptr || row.error_db > worst->error_db) worst = &row, worst_at = &speed;
    }
  if (worst == nullptr) return "";
  if (best == worst)
    return answer(fmt::format("The error of the displacement is {:.1f} dB.", worst->error_db));
  return answer(fmt::format(
      "The error of the displacement is {:.1f} dB at the worst ({}, {}) and {:.1f} dB at the best ({}, {}).",
      worst->error_db, worst->tray, speed_words(*worst_at), best->error_db, best->tray,
      speed_words(*best_at)));
}

}  // namespace

std::vector<schema::ResultFigure> fidelity_figures(const Fidelity& fidelity) {
  std::vector<schema::ResultFigure> figures;
  const char* kind = fidelity.simulated.empty() ? "modelled" : "simulated";
  for (const FidelitySpeed& speed : fidelity.speeds) {
    for (const FidelityRow& row : speed.rows)
      figures.push_back({fmt::format("{}, {}", speed_words(speed), row.tray),
                         fmt::format("error {:.1f} dB re the target ({})", row.error_db, kind)});
    figures.push_back({speed_words(speed) + ", removed", taken_words(speed)});
  }
  return figures;
}

std::vector<ResultPicture> fidelity_pictures(const Fidelity& fidelity) {
  std::vector<ResultPicture> pictures;
  for (const FidelitySpeed& speed : fidelity.speeds) {
    pictures.push_back(error_picture(speed));
    pictures.push_back(stretch_picture(speed));
  }
  return pictures;
}

schema::Result<std::string> fidelity_page(const Fidelity& fidelity) {
  std::string body =
      fmt::format("<h1>Fidelity of {}</h1>\n<p>Played on {} at {} and {}. Displacement: {}.</p>\n",
                  escaped(fidelity.texture), escaped(fidelity.device),
                  for_people(fidelity.gain_m_per_n, Dimension::compliance),
                  for_people(fidelity.rate_hz, Dimension::frequency), escaped(fidelity.displacement));
  body += simulated_box(fidelity.simulated) + fidelity_answer(fidelity);
  const auto pictures = fidelity_pictures(fidelity);
  for (std::size_t i = 0; i < fidelity.speeds.size(); ++i) {
    const FidelitySpeed& speed = fidelity.speeds[i];
    body += fmt::format("<h2>{}</h2>\n<p>Removed: {}.</p>\n", escaped(speed_words(speed)),
                        escaped(taken_words(speed)));
    body += rows_table(speed, fidelity.simulated);
    for (const std::string& note : speed.notes)
      body += fmt::format("<p class=\"note\">{}</p>\n", escaped(note));
    const auto drawn = pictures_html(std::span(pictures).subspan(2 * i, 2), fidelity.simulated);
    if (!drawn) return drawn;
    body += *drawn;
  }
  body +=
      "<p class=\"note\">Error: the power of the displacement minus its target over the target's, in the "
      "judged band, after one constant shift along the path is removed; 'in place' keeps that shift; "
      "'re-recorded' is the error of the displacement that a sensor records. The target is the exact "
      "reference at the finger's true positions.</p>\n";
  return html_document("Fidelity of " + fidelity.texture, body);
}

}  // namespace tacto::analysis
