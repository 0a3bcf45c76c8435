// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/demo/demo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <filesystem>
#include <numbers>

#include "analysis/page/html.hpp"
#include "capture/record/record.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/version.hpp"
#include "firmware-host/device_to_record.hpp"
#include "firmware-host/link/device.hpp"
#include "firmware-host/sim/bench/actuated_tray.hpp"
#include "firmware-host/sim/physics/paper_surfaces.hpp"
#include "playback/render/render.hpp"
#include "spatial/dsp/fourier/fft.hpp"
#include "spatial/picture/line_plot.hpp"
#include "spatial/picture/spectrogram_figure.hpp"
#include "spatial/spectrogram/spectrogram.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"
#include "spatial/texture/make_texture.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::Dimension;
using schema::for_people;
using schema::Result;

using Spectrum = std::vector<std::complex<double>>;

// Shifts and compares two signals through one planned transform.
class ReplayComparison {
 public:
  ReplayComparison(const schema::TimeSignal& came, const schema::TimeSignal& target,
                   const spatial::Band& band, double settle_s)
      : rate_hz_(came.sample_rate_hz),
        settle_(static_cast<std::size_t>(settle_s * rate_hz_)),
        length_(came.values.size()),
        fft_(spatial::fast_length(2 * length_)),
        came_(in_band(came.values, band)),
        target_(back(in_band(target.values, band))) {}

  double error_rms(double delay_s) {
    Spectrum shifted = came_;
    const double step = 2 * std::numbers::pi * rate_hz_ / static_cast<double>(fft_.length());
    for (std::size_t k = 0; k < shifted.size(); ++k)
      shifted[k] *= std::polar(1.0, step * static_cast<double>(k) * delay_s);
    const std::vector<double> advanced = back(shifted);
    double sum = 0;
    for (std::size_t i = settle_; i < length_ - settle_; ++i) sum += std::pow(advanced[i] - target_[i], 2);
    return root_mean(sum);
  }

  double target_rms() const {
    double sum = 0;
    for (std::size_t i = settle_; i < length_ - settle_; ++i) sum += target_[i] * target_[i];
    return root_mean(sum);
  }

 private:
  double root_mean(double sum) const { return std::sqrt(sum / static_cast<double>(length_ - 2 * settle_)); }

  Spectrum in_band(std::vector<double> values, const spatial::Band& band) {
    values.resize(fft_.length());
    Spectrum spectrum(fft_.bins());
    fft_.forward(values, spectrum);
    for (std::size_t k = 0; k < spectrum.size(); ++k)
      if (!band.contains(static_cast<double>(k) * rate_hz_ / static_cast<double>(fft_.length())))
        spectrum[k] = 0;
    return spectrum;
  }

  std::vector<double> back(const Spectrum& spectrum) {
    std::vector<double> values(fft_.length());
    fft_.inverse(spectrum, values);
    return values;
  }

  double rate_hz_;
  std::size_t settle_, length_;
  spatial::RealFft fft_;
  Spectrum came_;
  std::vector<double> target_;
};

// Coarse steps find the minimum's surroundings, golden section the minimum: the error has one minimum within
// half a period of 500 Hz.
constexpr double kStepS = 2.5e-4;
constexpr double kResolutionS = 1e-7;

double coarse_delay(ReplayComparison& comparison, double max_delay_s) {
  double best = 0, smallest = comparison.error_rms(0);
  for (double delay = -max_delay_s; delay <= max_delay_s; delay += kStepS) {
    const double error = comparison.error_rms(delay);
    if (error < smallest) best = delay, smallest = error;
  }
  return best;
}

double best_delay(ReplayComparison& comparison, double max_delay_s) {
  constexpr double kGolden = 1 / std::numbers::phi;
  const double start = coarse_delay(comparison, max_delay_s);
  double low = start - kStepS, high = start + kStepS;
  while (high - low > kResolutionS) {
    const double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    const bool bottom_is_left = comparison.error_rms(left) < comparison.error_rms(right);
    (bottom_is_left ? high : low) = bottom_is_left ? right : left;
  }
  return (low + high) / 2;
}

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

constexpr const char* kNotes = "made by tactograph demo";
// The recording has the paper's speed; the replay is slower and reverses its direction.
constexpr double kRecordSpeedMps = 50e-3;
constexpr double kRecordTimeS = 1.0;
// A recording to work on, of the surface whose own period (0.5 mm: 2 /mm) is within the valid band at this
// speed: 1.5 to 10 /mm over a whole stroke. The periods of B and C (1.5 and 3 mm) are below it.
constexpr const char* kFingerSurface = "E";
constexpr const char* kFingerStem = "/finger";
constexpr double kFingerTimeS = 3.8;  // four strokes
constexpr double kReplayTimeS = 1.6;
constexpr double kSettleS = 0.1;  // the comparison leaves out onset, end, and the tray's ringing

struct Made {
  schema::Texture texture;
  schema::Spectrogram spectrogram;
};

// Back and forth over the middle of the texture, with a speed that rises and falls like a hand's.
playback::FingerPath replay_path(const schema::Texture& texture) {
  schema::TimeSignal position{1000, 0, {}};
  const double length_m = texture.signal.length_m(), rate = position.sample_rate_hz;
  for (double i = 0; i <= kReplayTimeS * rate; ++i) {
    const double phase = 2 * std::numbers::pi * i / rate / kReplayTimeS;
    position.values.push_back(length_m * (0.5 - 0.4 * std::cos(phase) + 0.03 * std::sin(3 * phase)));
  }
  return playback::finger_path_of(position);
}

double mean_speed_mps(const playback::FingerPath& path) {
  double travelled_m = 0;
  for (std::size_t i = 1; i < path.position_m.size(); ++i)
    travelled_m += std::abs(path.position_m[i] - path.position_m[i - 1]);
  return travelled_m / path.duration_s();
}

void remove_earlier(const std::string& stem) {
  std::error_code ignored;
  for (const char* ending : {".wav", ".json"}) fs::remove(stem + ending, ignored);
}

bool is_of_a_demo(const std::string& stem) {
  const auto recording = schema::open_recording(stem);
  return recording && recording->header.notes == kNotes;
}

// Replaces the files of an earlier demo, but not other files of these names.
Result<void> check_replaceable(const std::string& stem) {
  if (is_of_a_demo(stem)) return {};
  std::error_code ignored;
  for (const char* ending :
       {".json", ".wav", ".events.jsonl", ".texture.json", ".texture.wav", ".nc", ".png"})
    if (fs::exists(stem + ending, ignored))
      return schema::fail(schema::ErrorKind::usage, "exists, and was not made by an earlier demo",
                          stem + ending, "choose another folder with -o");
  return {};
}

Result<schema::Recording> recorded(const std::string& surface, double time_s, const std::string& stem) {
  remove_earlier(stem);
  auto device = firmware_host::open_device_to_record(
      fmt::format("sim:surface={},speed={}mm/s,seed=1", surface, kRecordSpeedMps * 1e3));
  TACTO_TRY(device);
  capture::RecordRequest request;
  request.name = stem;
  request.time_s = time_s;
  request.notes = kNotes;
  auto done = capture::record(*device->device, request);
  TACTO_TRY(done);
  return std::move(done->recording);
}

Result<schema::Texture> first_texture(const schema::Recording& recording) {
  auto maker = spatial::TextureMaker::open(recording, {});
  TACTO_TRY(maker);
  const auto stroke = maker->record().stroke(1);
  TACTO_TRY(stroke);
  return maker->make(*stroke, 1);
}

Result<void> write_made(const std::string& stem, const Made& made, const spatial::Figure& picture) {
  if (auto written = schema::write_texture(stem, made.texture); !written) return written;
  if (auto written = schema::write_spectrogram_nc(stem + ".nc", {&made.spectrogram, 1}); !written)
    return written;
  return spatial::write_figure(stem + ".png", picture);
}

void describe_spectrogram(const Made& made, DemoSurface& row) {
  const auto peak = spatial::strongest_peak(made.spectrogram, 0.3e3);  // 15 Hz at 50 mm/s
  row.peak_position_m = peak.position_m;
  row.peak_frequency_per_m = peak.frequency_per_m;
  row.simulated = made.texture.simulated;
  row.force_rms_n = spatial::rms_of(made.texture);
}

Result<Made> surface_made(const std::string& stem, DemoSurface& row) {
  const auto recording = recorded(row.surface, kRecordTimeS, stem);
  TACTO_TRY(recording);
  auto texture = first_texture(*recording);
  TACTO_TRY(texture);
  auto spectrogram = spatial::spatial_spectrogram(*texture, {});
  TACTO_TRY(spectrogram);
  spectrogram->name = row.surface;
  Made made{std::move(*texture), std::move(*spectrogram)};
  const spatial::SpectrogramFigure figure({{&made.texture, &made.spectrogram}});
  TACTO_TRY(write_made(stem, made, figure));
  schema::Texture shown = made.texture;
  shown.simulated = kSimulatedOnPage;
  auto svg = spatial::to_page_svg(spatial::SpectrogramFigure({{&shown, &made.spectrogram}}));
  TACTO_TRY(svg);
  row.spectrogram_svg = std::move(*svg);
  describe_spectrogram(made, row);
  return made;
}

spatial::Series series(const char* name, const schema::TimeSignal& signal, double from_s, double to_s,
                       int colour) {
  spatial::Series curve{name, {},         {}, spatial::series_colour(static_cast<std::size_t>(colour)),
                        1.2,  colour == 1};
  for (std::size_t i = 0; i < signal.values.size(); ++i) {
    if (signal.time_s(i) < from_s || signal.time_s(i) > to_s) continue;
    curve.x.push_back(signal.time_s(i) * 1e3);
    curve.y.push_back(signal.values[i] * 1e6);
  }
  return curve;
}

// A quarter of a second around the middle of the way back: short enough to show each ridge.
spatial::LineFigure replay_figure(const playback::Rendering& rendering, const schema::TimeSignal& came,
                                  const DemoSurface& row, const std::string& simulated) {
  spatial::LineFigure figure;
  figure.title = fmt::format("Surface {}: displacement of the tray, 15-500 Hz", row.surface);
  figure.x_label = "time (ms)";
  figure.y_label = "displacement (µm)";
  figure.simulated = simulated;
  figure.series = {series("target", rendering.target_m, 1.1, 1.3, 0),
                   series("emulated tray", came, 1.1, 1.3, 1)};
  return figure;
}

// 1 mm/N, or less if the transducer's limits require it. Rendering is linear, so one rendering at a small
// gain determines how much of the limits any gain would use.
Result<double> fitting_gain_m_per_n(const Made& made, const playback::FingerPath& path,
                                    const schema::Transducer& transducer, playback::RenderOptions options) {
  const double asked_m_per_n = options.gain_m_per_n;
  options.gain_m_per_n = asked_m_per_n * 1e-3;
  const auto small = playback::render(made.texture, path, transducer, options);
  TACTO_TRY(small);
  return std::min(asked_m_per_n, 0.9 * options.gain_m_per_n / small->peaks.tightest().used());
}

Result<void> replayed(const Made& made, const schema::Transducer& transducer, DemoSurface& row) {
  const playback::FingerPath path = replay_path(made.texture);
  playback::RenderOptions options;
  options.hold = playback::Hold::zero_order;
  const auto gain = fitting_gain_m_per_n(made, path, transducer, options);
  TACTO_TRY(gain);
  row.gain_m_per_n = options.gain_m_per_n = *gain;
  const auto rendering = playback::render(made.texture, path, transducer, options);
  TACTO_TRY(rendering);
  firmware_host::ActuatedTray tray(transducer, options.rate_hz);
  schema::TimeSignal came = rendering->drive_v;
  came.values = firmware_host::displacement_under(tray, rendering->drive_v.values);
  const ReplayError error = replay_error(came, rendering->target_m, options.band, kSettleS);
  row.replay_speed_mps = mean_speed_mps(path);
  row.drive_peak_v = rendering->peaks.drive_v.value;
  row.target_rms_m = error.target_rms;
  row.error_rms_m = error.error_rms;
  row.error_db = error.error_db;
  row.delay_s = error.delay_s;
  auto svg = spatial::to_page_svg(replay_figure(*rendering, came, row, kSimulatedOnPage));
  TACTO_TRY(svg);
  row.replay_svg = std::move(*svg);
  return {};
}

Result<void> check_folder(const std::string& folder, const std::string& page) {
  for (const auto& surface : firmware_host::paper_surfaces())
    if (auto free = check_replaceable(folder + "/" + surface.name); !free) return free;
  if (auto free = check_replaceable(folder + kFingerStem); !free) return free;
  std::error_code ignored;
  const bool again = is_of_a_demo(folder + kFingerStem);
  if (again || !fs::exists(page, ignored)) return {};
  return schema::fail(schema::ErrorKind::usage, "exists, and was not made by an earlier demo", page,
                      "choose another folder with -o");
}

Result<void> write_page(const DemoSummary& summary) {
  schema::PendingFiles files;
  if (auto added = files.write(summary.page, demo_page(summary.surfaces, summary.simulated)); !added)
    return added;
  return files.commit();
}

}  // namespace

ReplayError replay_error(const schema::TimeSignal& came, const schema::TimeSignal& target,
                         const spatial::Band& band, double settle_s, double max_delay_s) {
  assert(came.values.size() == target.values.size() && came.duration_s() > 2 * settle_s);
  ReplayComparison comparison(came, target, band, settle_s);
  ReplayError found;
  found.delay_s =
      std::round(best_delay(comparison, max_delay_s) / kResolutionS) * kResolutionS + 0.0;  // no -0
  found.error_rms = comparison.error_rms(found.delay_s);
  found.target_rms = comparison.target_rms();
  found.error_db = schema::amplitude_db(found.error_rms / found.target_rms);
  return found;
}

std::string demo_page(const std::vector<DemoSurface>& surfaces, const std::string& simulated) {
  std::string body = fmt::format(
      "<h1>tactograph: five surfaces, recorded and played back</h1>\n<p "
      "class=\"simulated\"><strong>Simulated</strong> {}: nothing "
      "on this page was measured on hardware or on a finger.</p>\n{}{}{}",
      escaped(simulated), demo_answer(surfaces), figures(surfaces), kIntroduction);
  for (const DemoSurface& surface : surfaces) body += section(surface);
  return html_document("tactograph demo (simulated)", body);
}

Result<DemoSummary> run_demo(const std::string& folder, const std::function<void(double)>& progress) {
  const auto transducer = schema::read_transducer("wiertlewski2011");
  TACTO_TRY(transducer);
  DemoSummary summary;
  summary.page = folder + "/index.html";
  TACTO_TRY(check_folder(folder, summary.page));
  summary.simulated = fmt::format("by the emulated device of {}", kCreator);
  const auto& surfaces = firmware_host::paper_surfaces();
  for (const auto& surface : surfaces) {
    progress(static_cast<double>(summary.surfaces.size()) / static_cast<double>(surfaces.size()));
    DemoSurface row;
    row.surface = surface.name;
    row.description = surface.description;
    row.record_speed_mps = kRecordSpeedMps;
    const auto made = surface_made(folder + "/" + row.surface, row);
    TACTO_TRY(made);
    TACTO_TRY(replayed(*made, *transducer, row));
    summary.surfaces.push_back(std::move(row));
  }
  summary.recording = folder + kFingerStem;
  TACTO_TRY(recorded(kFingerSurface, kFingerTimeS, summary.recording));
  TACTO_TRY(write_page(summary));
  return summary;
}

}  // namespace tacto::analysis
