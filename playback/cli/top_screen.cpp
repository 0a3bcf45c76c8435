// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/cli/top_screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "playback/host-loop/time_histogram.hpp"

namespace tacto::playback {
namespace {

using schema::ControlFields;

// Histogram of the lateness between the bounds of the status: one sign is 2 %; smaller parts above 0 show as
// a dot.
std::string lateness_bars(const ControlFields& fields) {
  std::string bars;
  double beyond_lower = 1;
  const auto add = [&](const std::string& name, double beyond_upper) {
    const double part = std::max(beyond_lower - beyond_upper, 0.0);
    const auto signs = static_cast<std::size_t>(50 * part);
    bars += fmt::format("  {:<8} {:7.3f} % {}\n", name, 100 * part,
                        signs > 0  ? std::string(signs, '#')
                        : part > 0 ? "."
                                   : "");
    beyond_lower = beyond_upper;
  };
  for (const double bound_s : kLateBoundsS)
    add(fmt::format("< {:g} us", 1e6 * bound_s), schema::control_number(fields, late_part_name(bound_s)));
  add("more", 0);
  return bars;
}

std::string lateness_lines(const ControlFields& fields) {
  const auto number = [&](std::string_view name) { return schema::control_number(fields, name); };
  if (!(number("wake_p99_s") > 0)) return {};
  return fmt::format("late by  p50 {:.1f}  p99 {:.1f}  p99.9 {:.1f} us   busy p99 {:.2f} us\n",
                     1e6 * number("wake_p50_s"), 1e6 * number("wake_p99_s"), 1e6 * number("wake_p999_s"),
                     1e6 * number("busy_p99_s")) +
         lateness_bars(fields) +
         fmt::format("edge to drive  p50 {:.2f}  p99 {:.2f} ms, looked ahead by {:.2f} ms\n",
                     1e3 * number("latency_p50_s"), 1e3 * number("latency_p99_s"),
                     1e3 * number("looked_ahead_s"));
}

// The count of limited ticks is known slightly earlier than what the limits removed.
std::string words_of_taken(const ControlFields& fields) {
  if (const std::string unknown = schema::control_text(fields, "limits_took"); !unknown.empty())
    return unknown;
  const double all_db = schema::control_number(fields, "limits_took_db", NAN);
  const double second_db = schema::control_number(fields, "limits_took_last_second_db", NAN);
  if (std::isnan(all_db)) return "not known yet";
  return fmt::format("{} in the last second, {:.1f} dB since arming",
                     std::isnan(second_db) ? "nothing" : fmt::format("{:.1f} dB", second_db), all_db);
}

// RMS relative to the unlimited drive; `tactograph session` reports it for each stroke.
std::string limits_line(const ControlFields& fields) {
  const std::string tells = schema::control_text(fields, "limits_in_db");
  if (tells.empty()) return {};
  return fmt::format("limits   removed {}   by stroke: {}\n", words_of_taken(fields), tells);
}

// Empty before a load.
std::string gain_words(const ControlFields& fields) {
  if (schema::control_text(fields, "loaded").empty()) return {};
  return fmt::format("   gain {:.4g} mm/N", 1e3 * schema::control_number(fields, "gain_m_per_n"));
}

std::string drive_line(const ControlFields& fields) {
  const auto number = [&](std::string_view name) { return schema::control_number(fields, name); };
  return fmt::format("drive    {:8.3f} V    rms {:.3f} V   peak {:.3f} V{}\n", number("drive_v"),
                     number("drive_rms_v"), number("drive_peak_v"), gain_words(fields));
}

// Of each axis, and the peak: force_x_n, ... Empty without forces.
std::string force_line(const ControlFields& fields) {
  std::string line;
  for (const auto& [name, value] : fields)
    if (const auto* force_n = std::get_if<double>(&value); force_n != nullptr && name.starts_with("force_"))
      line += fmt::format("   {} {:.3f} N", name.substr(6, name.size() - 8), *force_n);
  return line.empty() ? line : "force " + line + "\n";
}

// Of the drive; forces have none.
std::string band_words(const ControlFields& fields) {
  const double band_hz = schema::control_number(fields, "passes_to_hz", NAN);
  return std::isnan(band_hz) ? "" : fmt::format("   band up to {:.4g} Hz", band_hz);
}

}  // namespace

std::string top_screen(const ControlFields& fields) {
  const auto number = [&](std::string_view name) { return schema::control_number(fields, name); };
  std::string text;
  const auto out = std::back_inserter(text);
  // `why` contains the fault, and from protocol 1.2 on also other causes of a state.
  const std::string why = schema::control_text(fields, "why");
  fmt::format_to(out, "{:<8} {}\n", schema::control_text(fields, "state"),
                 why.empty() ? schema::control_text(fields, "fault") : why);
  fmt::format_to(out, "period   {:8.1f} us   round trip {:.2f} ms{}\n", 1e6 * number("period_s"),
                 1e3 * number("round_trip_s"), band_words(fields));
  fmt::format_to(out, "finger   {:8.2f} mm   {:8.1f} mm/s\n", 1e3 * number("position_m"),
                 1e3 * number("speed_mps"));
  const std::string forces = force_line(fields);
  text += forces.empty() ? drive_line(fields) : forces;
  fmt::format_to(out, "ticks    {:8.0f}      late {:.0f}   lost {:.0f}   limited {:.0f}   energy {:.0f}",
                 number("ticks"), number("late_ticks"), number("lost_ticks"), number("limited_ticks"),
                 number("energy_limited_ticks"));
  fmt::format_to(out, "   gated {:.0f}   blind {:.0f}\n", number("gated_ticks"), number("blind_ticks"));
  return text + limits_line(fields) + lateness_lines(fields);
}

std::string clipped_to(const std::string& text, std::size_t rows, std::size_t columns) {
  std::string clipped;
  for (std::size_t at = 0; at < text.size() && rows > 0; --rows) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    clipped += (clipped.empty() ? "" : "\n") + text.substr(at, std::min(end - at, columns));
    at = end + 1;
  }
  return clipped;
}

}  // namespace tacto::playback
