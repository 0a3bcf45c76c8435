// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/demo/demo_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/page/html.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::for_people;

std::string replay_row_error(const DemoSurface& s) {
  return fmt::format("{:.1f} dB ({})", s.error_db, for_people(s.error_rms_m, Dimension::length));
}

std::string figures(const std::vector<DemoSurface>& surfaces) {
  using S = DemoSurface;
  return html_table(
      surfaces,
      {{"surface", &S::surface},
       {"recorded at", [](const S& s) { return for_people(s.record_speed_mps, Dimension::speed); }},
       {"force, RMS", [](const S& s) { return for_people(s.force_rms_n, Dimension::force); }},
       {"strongest line",
        [](const S& s) { return for_people(s.peak_frequency_per_m, Dimension::spatial_frequency); }},
       {"replayed at", [](const S& s) { return for_people(s.replay_speed_mps, Dimension::speed); }},
       {"gain", [](const S& s) { return for_people(s.gain_m_per_n, Dimension::compliance); }},
       {"target, RMS", [](const S& s) { return for_people(s.target_rms_m, Dimension::length); }},
       {"drive, peak", [](const S& s) { return for_people(s.drive_peak_v, Dimension::voltage); }},
       {"error, 15-500 Hz", replay_row_error}});
}

// The answer is the largest error of all surfaces.
std::string demo_answer(const std::vector<DemoSurface>& surfaces) {
  const auto worst = std::ranges::max_element(surfaces, {}, &DemoSurface::error_db);
  if (worst == surfaces.end()) return "";
  return answer(fmt::format(
      "Played back, the tray follows its target to {:.1f} dB or better (15-500 Hz); the worst is surface {}.",
      worst->error_db, worst->surface));
}

std::string section(const DemoSurface& s) {
  return fmt::format(
      "<h2>Surface {}: {}</h2>\n<p>The strongest cell of the spectrogram is at {} and {}.</p>\n{}<p>Replayed "
      "along a path that turns round, at {} on average: the tray's displacement against its target. The "
      "error over 15-500 Hz is {}, after the delay of {} is removed.</p>\n{}<p class=\"note\">simulated: "
      "{}</p>\n",
      escaped(s.surface), escaped(s.description), for_people(s.peak_position_m, Dimension::length),
      for_people(s.peak_frequency_per_m, Dimension::spatial_frequency),
      inline_svg(s.spectrogram_svg, fmt::format("Spatial spectrogram of surface {}, simulated", s.surface)),
      for_people(s.replay_speed_mps, Dimension::speed), replay_row_error(s),
      for_people(s.delay_s, Dimension::time),
      inline_svg(s.replay_svg,
                 fmt::format("Target and displacement of the tray on surface {}, simulated", s.surface)),
      escaped(s.simulated));
}

constexpr std::string_view kIntroduction =
    "<p>Each of the five surfaces of Wiertlewski, Lozada and Hayward (2011) was stroked by a simulated "
    "finger on the simulated transducer and recorded; the recording was turned into force against position "
    "(piecewise cubic Hermite, 1 µm grid, 15-500 Hz, divided by the sensor's response); that texture was "
    "played back along another path at another speed: force times a gain of 1 mm/N (less where the drive "
    "would exceed the transducer's 5 V), through the inverse of the modelled actuator, to the drive in "
    "volts. The emulated transducer, integrated from its equations of motion, independently of that inverse, "
    "then moved its tray.</p>\n";

}  // namespace

std::string demo_page(const std::vector<DemoSurface>& surfaces, const std::string& simulated) {
  std::string body = fmt::format(
      "<h1>tactograph: five surfaces, recorded and played back</h1>\n<p "
      "class=\"simulated\"><strong>Simulated</strong> {}: nothing "
      "on this page was measured on hardware or on a finger.</p>\n{}{}{}",
      escaped(simulated), demo_answer(surfaces), figures(surfaces), kIntroduction);
  for (const DemoSurface& surface : surfaces) body += section(surface);
  return html_document("tactograph demo (simulated)", body);
}

}  // namespace tacto::analysis
