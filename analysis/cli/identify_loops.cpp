// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/identify_loops.hpp"

#include <fmt/format.h>

#include "analysis/cli/identify_report.hpp"
#include "analysis/identify/fit/plausibility.hpp"
#include "analysis/identify/report/bode_figure.hpp"
#include "analysis/identify/report/identify_results.hpp"
#include "analysis/identify/report/loop_figure.hpp"
#include "data-schema/command/stop_signals.hpp"
#include "data-schema/command/verb.hpp"
#include "data-schema/report/progress.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Dimension;
using schema::Result;

constexpr double kSweepPart = 0.75;  // share of the total measuring time

std::string loops_words(double amplitude_v) {
  return "loops of " + schema::for_people(amplitude_v, Dimension::voltage) + " at 1 Hz";
}

Result<DrivenTray> driven_loops(const IdentifyOptions& o, IdentifySource& source,
                                schema::Identification& about) {
  firmware_host::Device& device = *source.device.device;
  const double amplitude_v = o.amplitude_v.value_or(loop_amplitude_v(source.base));
  about.source = device.capabilities().uri;
  about.simulated = device.capabilities().simulated_device;
  about.conditions = loops_words(amplitude_v);
  const cli::StopSignals signals;
  cli::Progress progress("identifying");
  auto tray = drive_tray(
      device, slow_loops(drive_rate_hz(device), amplitude_v), [&] { return signals.stop_asked(); },
      [&](double part) { progress.update(part); });
  source.stopped = signals.stop_asked();
  return tray;
}

Result<DrivenTray> loops_of(const IdentifyOptions& o, IdentifySource& source, schema::Identification& about) {
  if (source.has_device()) return driven_loops(o, source, about);
  about.source = o.file;
  auto tray = read_driven_table(o.file);
  if (tray && !(tray->rate_hz > 0)) tray->rate_hz = o.rate_hz.value_or(0);
  if (tray && o.invert)
    for (double& value : tray->displacement_m) value = -value;
  return tray;
}

void warn_of_limits(const char* what, std::size_t limited) {
  if (limited == 0) return;
  cli::warn(
      fmt::format("the device limited {} ticks of the {}: the fit uses the limited drive; a smaller "
                  "--amplitude avoids this",
                  limited, what));
}

struct SweepAndLoops {
  DrivenResponse sweep;
  DrivenTray loops;
};

// The sweep has the requested amplitude, the loops the largest that the limits allow.
Result<SweepAndLoops> measured_both(const IdentifyOptions& o, IdentifySource& source) {
  firmware_host::Device& device = *source.device.device;
  const cli::StopSignals signals;
  cli::Progress progress("identifying");
  const auto stop_asked = [&] { return signals.stop_asked(); };
  const ExcitationPlan plan = plan_on(o, device, joint_amplitude_v(o.plan, source.base));
  const double amplitude_v = loop_amplitude_v(source.base);
  auto sweep = driven_response(device, IdentifyMethod::sweep, plan, source.base, stop_asked,
                               [&](double part) { progress.update(kSweepPart * part); });
  source.stopped = signals.stop_asked();
  TACTO_TRY(sweep);
  auto loops = drive_tray(device, slow_loops(plan.rate_hz, amplitude_v, plan.amplitude_v), stop_asked,
                          [&](double part) { progress.update(kSweepPart + (1 - kSweepPart) * part); });
  source.stopped = signals.stop_asked();
  TACTO_TRY(loops);
  sweep->data.conditions += ", and " + loops_words(amplitude_v);
  return SweepAndLoops{std::move(*sweep), std::move(*loops)};
}

Result<JointFit> joint_fit_of(const IdentifyOptions& o, SweepAndLoops& both, const schema::Transducer& base) {
  BodeData& data = both.sweep.data;
  TACTO_TRY(check_measured(data, o.model, base, {}));
  auto fit = fit_jointly(data, both.sweep.drive, both.loops, o.model, base);
  if (!fit) return fit;
  TACTO_TRY(check_upright(fit->loops, data.source));
  TACTO_TRY(check_fitted(o, fit->response, base));
  return fit;
}

}  // namespace

Result<Report> identify_loops(const IdentifyOptions& o, IdentifySource& source) {
  schema::Identification about;
  about.conditions = "loops measured elsewhere";
  const auto tray = loops_of(o, source, about);
  TACTO_TRY(tray);
  if (!(tray->rate_hz > 0))
    cli::warn("no rate is known: the linear model's own lag is counted as hysteresis");
  warn_of_limits("loops", tray->limited);
  const double held_s = source.has_device() ? 0.5 / tray->rate_hz : 0;
  const auto fit = fit_loops(tray->drive_v, tray->displacement_m, tray->rate_hz,
                             delay_at_rest_s(source.base) + held_s, source.base.drive_limit_v);
  TACTO_TRY(fit);
  TACTO_TRY(check_upright(*fit, about.source, o.invert));
  TACTO_TRY(o.implausible ? Result<void>() : check_size(*fit, source.base, about.source));
  const schema::Transducer found = identified(*fit, source.base, transducer_name_of(o), about);
  TACTO_TRY(schema::write_transducer(o.stem, found));
  Report report = loop_report(*fit, found, transducer_file_of(o));
  TACTO_TRY(draw_identified(o, loop_figure(*fit, found), report));
  return with_identify_results(
      o, [&] { return identify_results(*fit, found); }, std::move(report));
}

Result<Report> identify_jointly(const IdentifyOptions& o, IdentifySource& source) {
  auto both = measured_both(o, source);
  TACTO_TRY(both);
  warn_of_limits("sweep", both->sweep.data.limited);
  warn_of_limits("loops", both->loops.limited);
  const auto fit = joint_fit_of(o, *both, source.base);
  TACTO_TRY(fit);
  const schema::Transducer found = identified(*fit, source.base, transducer_name_of(o));
  TACTO_TRY(schema::write_transducer(o.stem, found));
  Report report = joint_report(*fit, source.base, found, transducer_file_of(o));
  if (!o.base.empty()) add_paper(report, source.base, found, fit->response);
  TACTO_TRY(draw_identified(o, BodeFigure(fit->response), report));
  return with_identify_results(
      o, [&] { return identify_results(*fit, source.base, found); }, std::move(report));
}

}  // namespace tacto::analysis
