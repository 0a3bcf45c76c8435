// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/report/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/identify/fit/model_choice.hpp"
#include "analysis/identify/measure/angles.hpp"
#include "analysis/identify/measure/response_estimate.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr double kLongestSweepS = 3600;  // the whole sweep is in memory: 36e6 samples at 10 kHz

double largest_gain(const ExcitationPlan& plan, const schema::Transducer& base) {
  double most_m_per_v = 0;
  for (double hz = plan.low_hz; hz < plan.high_hz; hz *= 1.02)
    most_m_per_v = std::max(most_m_per_v, std::abs(schema::actuator_response(base, hz)));
  return most_m_per_v;
}

// Checks the drive against the limits as the base transducer predicts. If the transducer is unknown the
// prediction may be wrong; the device has its own limits.
Result<void> check_amplitude(const ExcitationPlan& plan, const schema::Transducer& base) {
  const bool low = plan.low_hz >= plan.high_hz;  // which then is the most that the rate allows
  if (low || plan.high_hz > kMostOfRate * plan.rate_hz)
    return fail(ErrorKind::unsuitable,
                fmt::format("{:g} Hz is too near half the device's rate of {:g} Hz",
                            low ? plan.low_hz : plan.high_hz, plan.rate_hz),
                low ? "--low" : "--high",
                fmt::format("{} {:g} Hz", low ? "below" : "at most", kMostOfRate * plan.rate_hz));
  const double most_m = plan.amplitude_v * largest_gain(plan, base);
  const char* const remedy = "use a smaller --amplitude";
  if (plan.amplitude_v > base.drive_limit_v)
    return fail(
        ErrorKind::unsuitable,
        fmt::format("{:g} V exceed the drive's limit of {:g} V", plan.amplitude_v, base.drive_limit_v),
        "--amplitude", remedy);
  if (most_m > base.displacement_limit_m)
    return fail(
        ErrorKind::unsuitable,
        fmt::format("the tray's displacement would reach {}, its limit is {}",
                    schema::length_for_people(most_m), schema::length_for_people(base.displacement_limit_m)),
        "--amplitude", remedy);
  if (kTurn * plan.high_hz * plan.amplitude_v > base.slew_limit_v_per_s)
    return fail(ErrorKind::unsuitable, "the drive would exceed its slew limit", "--amplitude", remedy);
  return {};
}

Result<void> check_sweep(const ExcitationPlan& plan) {
  const double takes_s = stepped_sine_s(plan);
  if (takes_s <= kLongestSweepS) return {};
  ExcitationPlan higher = plan;
  while (higher.low_hz < plan.high_hz && stepped_sine_s(higher) > kLongestSweepS) higher.low_hz *= 1.05;
  return fail(
      ErrorKind::unsuitable,
      fmt::format("a sine at each of {} frequencies from {:g} Hz on takes {:.3g} s, the maximum is an hour",
                  plan.frequencies, plan.low_hz, takes_s),
      "--low",
      fmt::format("begin at {:.3g} Hz, or use fewer --frequencies or --method multisine", higher.low_hz));
}

std::string method_words(IdentifyMethod method) {
  constexpr const char* kWords[] = {"stepped sine", "multisine", "repeated chirp",
                                    "slow loops",   "taps",      "stepped sine"};
  return kWords[static_cast<std::size_t>(method)];
}

std::string overstated_words(const ResponseFit& fit) {
  if (!(fit.noise_overstated > 0)) return "";
  return fmt::format(
      "; the noise given with the data is {:.2g} times the residuals: it is too large and was ignored",
      fit.noise_overstated);
}

std::string verdict_of(const ResponseFit& fit) {
  if (!fit.converged) return fit.ended + (fit.suggestion.empty() ? "" : "; " + fit.suggestion);
  const char* const fits = fit.data.noise_is_a_bound
                               ? "the residuals are within the noise and the operator's errors"
                               : "the residuals are noise";
  std::string words = fits;
  if (fit.misfit.found)
    words = fit.misfit.words + (fit.suggestion.empty() ? "" : "; " + fit.suggestion);
  else if (const std::string added = extension_words(fit); !added.empty())
    words += ", with " + added;
  if (!fit.misfit.found && fit.evenness.uneven) words += ", but uneven: " + evenness_words(fit.evenness);
  return words + overstated_words(fit);
}

schema::Transducer named(schema::Transducer t, const std::string& name, const schema::Identification& about,
                         const std::string& base) {
  t.name = name;
  t.identification = about;
  t.identification->date = schema::creation_time();
  t.origin = fmt::format("identified {} from {} ({}), starting from '{}'", t.identification->date,
                         about.source, about.conditions, base);
  return t;
}

// If the linear model of the base is kept, the doubts of its identification are kept, too.
void carry_over(const schema::Transducer& base, schema::Identification& found) {
  if (!base.identification || base.identification->usable()) return;
  found.converged &= base.identification->converged;
  found.misfit |= base.identification->misfit;
  found.words += fmt::format("; it keeps the linear model of '{}', which {}: {}", base.name,
                             base.identification->converged ? "does not fit" : "did not converge",
                             base.identification->words);
}

}  // namespace

Result<DrivenResponse> driven_response(firmware_host::Device& device, IdentifyMethod method,
                                       const ExcitationPlan& plan, const schema::Transducer& base,
                                       const std::function<bool()>& stop_asked,
                                       const std::function<void(double)>& progress) {
  TACTO_TRY(check_amplitude(plan, base));
  DrivenResponse answer;
  BodeData& data = answer.data;
  if (method == IdentifyMethod::sweep) {
    TACTO_TRY(check_sweep(plan));
    const SteppedSine stepped = stepped_sine(plan);
    auto tray = drive_tray(device, stepped.drive_v, stop_asked, progress);
    TACTO_TRY(tray);
    data = response_of_steps(*tray, stepped);
    answer.drive = {tray->rate_hz, std::move(tray->drive_v), lines_of(stepped, tray->rate_hz)};
  } else {
    const PeriodicDrive drive = method == IdentifyMethod::chirp ? periodic_chirp(plan) : multisine(plan);
    auto tray = drive_tray(device, drive.drive_v, stop_asked, progress);
    TACTO_TRY(tray);
    data = response_of_periods(*tray, drive);
    answer.drive = {tray->rate_hz, std::move(tray->drive_v), lines_of(drive)};
  }
  data.of_device = true;
  data.source = device.capabilities().uri;
  data.simulated = device.capabilities().simulated_device;
  data.conditions = fmt::format("{} of {} from {} to {}", method_words(method),
                                schema::for_people(plan.amplitude_v, schema::Dimension::voltage),
                                schema::for_people(plan.low_hz, schema::Dimension::frequency),
                                schema::for_people(plan.high_hz, schema::Dimension::frequency));
  return answer;
}

Result<BodeData> measured_on(firmware_host::Device& device, IdentifyMethod method, const ExcitationPlan& plan,
                             const schema::Transducer& base, const std::function<bool()>& stop_asked,
                             const std::function<void(double)>& progress) {
  auto answer = driven_response(device, method, plan, base, stop_asked, progress);
  TACTO_TRY(answer);
  return std::move(answer->data);
}

double loop_amplitude_v(const schema::Transducer& base) {
  return std::min(base.drive_limit_v,
                  base.displacement_limit_m / std::abs(schema::actuator_response(base, 0)));
}

double joint_amplitude_v(const ExcitationPlan& plan, const schema::Transducer& base) {
  constexpr double kOfLoops = 0.2, kOfLimits = 0.9;
  const double most_v = std::min({kOfLoops * loop_amplitude_v(base),
                                  kOfLimits * base.slew_limit_v_per_s / (kTurn * plan.high_hz),
                                  kOfLimits * base.displacement_limit_m / largest_gain(plan, base)});
  const double digit_v = std::pow(10, std::floor(std::log10(most_v)) - 2);  // three digits are enough
  return digit_v * std::round(most_v / digit_v);
}

schema::Transducer identified(const ResponseFit& fit, const schema::Transducer& base,
                              const std::string& name) {
  schema::Identification about;
  about.source = fit.data.source;
  about.simulated = fit.data.simulated;
  about.conditions = fmt::format("{}, model: {}", fit.data.conditions, name_of(fit.choice));
  about.converged = fit.converged;
  about.misfit = fit.misfit.found;
  about.words = verdict_of(fit);
  about.r_squared = fit.r_squared;
  about.low_hz = fit.data.frequency_hz.front();
  about.high_hz = fit.data.frequency_hz.back();
  if (fit.find("added_mass_kg") != nullptr) carry_over(base, about);
  return named(fit.transducer, name, about, base.name);
}

schema::Transducer identified(const LoopFit& fit, const schema::Transducer& base, const std::string& name,
                              const schema::Identification& about) {
  schema::Transducer t = base;
  t.hysteresis = fit.hysteresis;
  t.actuator_scale *= std::abs(fit.gain_m_per_v) / std::abs(schema::actuator_response(base, 0));
  schema::Identification found = about;
  found.converged = true;
  found.misfit = !fit.usable;
  found.r_squared = fit.r_squared;
  found.words = fmt::format("a loop of {:.3g} %; the operator leaves {:.2g} % of it{}", 100 * fit.opening,
                            100 * fit.residual_part, fit.usable ? "" : ": the operator does not describe it");
  if (base.identification) {
    found.low_hz = base.identification->low_hz;
    found.high_hz = base.identification->high_hz;
    found.words += fmt::format("; the band is that of '{}', because loops do not determine it", base.name);
  } else {
    found.high_hz = fit.loop_hz;
  }
  carry_over(base, found);
  return named(t, name, found, base.name);
}

schema::Transducer identified(const JointFit& fit, const schema::Transducer& base, const std::string& name) {
  schema::Transducer t = identified(fit.response, base, name);
  t.hysteresis.reset();
  if (fit.has_hysteresis) t.hysteresis = fit.loops.hysteresis;
  t.identification->words +=
      fit.has_hysteresis ? fmt::format("; a loop of {:.3g} %, of which the operator leaves {:.2g} %",
                                       100 * fit.loops.opening, 100 * fit.loops.residual_part)
                         : fmt::format("; the loops show no hysteresis: {:.2g} %", 100 * fit.loops.opening);
  return t;
}

schema::Transducer identified(const TapsFit& fit, const schema::Transducer& base, const std::string& name,
                              const schema::Identification& about) {
  schema::Transducer t = base;
  const double k = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m,
               w = kTurn * fit.resonance_hz.median;
  t.mass_kg = k / (w * w);
  t.damping_n_s_per_m = 2 * fit.damping_ratio.median * std::sqrt(k * t.mass_kg);
  schema::Identification found = about;
  found.converged = true;
  found.words = fmt::format("{} taps; gains and stiffnesses are those of the base", fit.taps.size());
  found.r_squared = fit.r_squared;
  found.low_hz = fit.resonance_hz.median / 2;
  found.high_hz = fit.resonance_hz.median * 2;
  carry_over(base, found);
  return named(t, name, found, base.name);
}

}  // namespace tacto::analysis
