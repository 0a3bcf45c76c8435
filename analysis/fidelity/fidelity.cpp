// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/fidelity/fidelity.hpp"

#include <fmt/format.h>

#include <stdlib.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "analysis/compare/along_path.hpp"
#include "analysis/compare/band_sums.hpp"
#include "analysis/compare/played_texture.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "data-schema/version.hpp"
#include "firmware-host/sim/bench/actuated_tray.hpp"
#include "firmware-host/sim/bench/lvdt.hpp"
#include "firmware-host/sim/device/sim_parameters.hpp"
#include "firmware-host/sim/physics/tray_mechanics.hpp"
#include "firmware-host/sim/physics/tray_physics.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/model/spatial_content.hpp"
#include "playback/render/reference/exact_target.hpp"
#include "playback/session/session_rows.hpp"
#include "spatial/dsp/filter/band.hpp"
#include "spatial/features/band_kept.hpp"
#include "spatial/texture/valid_band.hpp"

namespace tacto::analysis {
namespace {

using firmware_host::TrayPhysics;
using playback::FingerPath;
using schema::ErrorKind;
using schema::Result;
using schema::Texture;

/// Created in the system's folder for temporary files. The destructor deletes it with its contents.
class ScratchFolder {
 public:
  /// Errors: cannot_write.
  static schema::Result<ScratchFolder> make();
  ScratchFolder(ScratchFolder&& other) noexcept;
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder();

  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

namespace fs = std::filesystem;

schema::Result<ScratchFolder> ScratchFolder::make() {
  const char* const wanted = std::getenv("TMPDIR");
  std::string path = fs::path(wanted != nullptr && *wanted != '\0' ? wanted : "/tmp") / "tactograph-XXXXXX";
  if (mkdtemp(path.data()) != nullptr) return ScratchFolder(path);
  return schema::fail(schema::ErrorKind::cannot_write, "no temporary folder can be made", path,
                      "set TMPDIR to a folder that can be written");
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

constexpr double kLeftOutS = 0.05, kFadeM = 1e-3;  // left out at either end of the texture
constexpr double kFarthestShiftM = 50e-6;
constexpr double kFastestMps = 10, kLeastKeptPercent = 1;
// Samples of the emulated tray. Each needs 100 bytes during the comparison (measured), so this is 1 GB.
constexpr double kMostTraySamples = 1e7;
constexpr double kAroundS = 2;            // s before and behind the texture, and for the drive's ramps
constexpr double kPlayedShare = 0.4;      // share of the time of one speed; the trays take the rest
constexpr double kOtherUnitRatio = 31.6;  // times the displacement limit: 30 dB

// A section of samples over time, with the positions of the finger.
struct Stretch {
  std::vector<double> position_m;
  std::size_t first = 0, count = 0;
  double rate_hz = 0;
};

constexpr double kTrayRateHz = 20e3;
constexpr firmware_host::LvdtParameters kTraySensor{0, 5e3, 5e-9};

// Samples per tick: at least 20 kHz, so that the images of the held drive do not alias.
std::size_t samples_a_tick(double tick_rate_hz) {
  return static_cast<std::size_t>(std::ceil(kTrayRateHz / tick_rate_hz));
}

struct EmulatedPass {
  playback::SessionColumns columns;  // the drive as it was sent, tick by tick
  playback::PlayOutcome outcome;
  // Exact position of the finger at each tick; the encoder's resolution is one count.
  std::vector<double> position_m;
};

constexpr double kBesideS = 0.25;  // before the texture, for the drive's initial ramp, and behind it

FingerPath straight_path(const schema::Texture& texture, double at_m, double speed_mps) {
  const double way_m = texture.signal.length_m() + 2 * kBesideS * speed_mps;
  const double from_m = at_m - kBesideS * speed_mps;
  return {{0, way_m / speed_mps}, {from_m, from_m + way_m}};
}

// Tick i is (i + 1) periods after arming. The emulated finger starts at arming.
std::vector<double> true_positions(const FingerPath& path, double rate_hz, std::size_t ticks) {
  auto positions = playback::positions_along(path, rate_hz, ticks + 1);
  positions.erase(positions.begin());
  return positions;
}

Result<void> check_counts(const EmulatedPass& pass) {
  const double step_m = pass.columns.header.metres_per_count;
  for (std::size_t i = 0; i < pass.position_m.size(); ++i)
    if (std::abs(pass.columns.position_m[i] - pass.position_m[i]) > 1.01 * step_m)
      return schema::fail(ErrorKind::internal, "the emulated finger was not where its path is",
                          fmt::format("tick {}", pass.columns.tick[i]));
  return {};
}

Result<void> check_played(const EmulatedPass& pass, const std::string& device) {
  if (pass.outcome.status.state == playback::PlayerState::fault)
    return schema::fail(ErrorKind::device, "playing ended in a fault: " + pass.outcome.status.fault, device);
  if (pass.columns.lost_at)
    return schema::fail(ErrorKind::device, fmt::format("{} ticks were lost", pass.columns.lost), device);
  return check_counts(pass);
}

// Plays as `tactograph play` does: texture, upload over the wire, the firmware's kernel with the counts of
// the emulated encoder, session. The finger moves at `speed_mps` from 0.25 s before the texture to 0.25 s
// behind it. `progress` receives the played fraction. `options` contains program, device and preparation;
// path, time and session are set here. Errors: those of play_once; usage: stopped; internal: the session's
// counts do not match the path.
Result<EmulatedPass> emulated_pass(const schema::Texture& texture, playback::PlayOptions options,
                                   double speed_mps, const std::function<bool()>& stop_asked,
                                   const std::function<void(double)>& progress) {
  const auto scratch = ScratchFolder::make();
  TACTO_TRY(scratch);
  const FingerPath path = straight_path(texture, options.program.at_m.value_or(0), speed_mps);
  options.finger_path = path;
  options.session = *scratch / "pass.session";
  options.program.any_displacement = options.device_uri.starts_with("sim:");
  auto outcome = playback::play_once(options, stop_asked, progress);
  TACTO_TRY(outcome);
  if (stop_asked()) return schema::fail(ErrorKind::usage, "stopped before the end", "fidelity");
  auto columns = playback::read_session_columns(options.session);
  TACTO_TRY(columns);
  EmulatedPass pass{std::move(*columns), std::move(*outcome), {}};
  // The final ramp of the drive is longer than the path, at the end of which the finger rests.
  const auto along = static_cast<std::size_t>(path.duration_s() * pass.columns.header.rate_hz);
  pass.position_m =
      true_positions(path, pass.columns.header.rate_hz, std::min(along, pass.columns.tick.size()));
  TACTO_TRY(check_played(pass, options.device_uri));
  return pass;
}

// Displacement of the tray, m, for the drive of the pass, integrated from its equations of motion
// (firmware_host::ActuatedTray); samples_a_tick() samples for each of the pass's positions.
std::vector<double> displacement_at_finger_m(const EmulatedPass& pass, const schema::Transducer& real,
                                             const firmware_host::TrayPhysics& physics) {
  const double rate_hz = pass.columns.header.rate_hz;
  const std::size_t fine = samples_a_tick(rate_hz);
  firmware_host::ActuatedTray tray(real, rate_hz * static_cast<double>(fine), physics);
  std::vector<double> displacement_m;
  for (std::size_t tick = 0; tick < pass.position_m.size(); ++tick)
    for (std::size_t i = 0; i < fine; ++i) displacement_m.push_back(tray.tick(pass.columns.drive_v[tick]));
  return displacement_m;
}

// The displacement as a sensor measures it: the emulated LVDT (first-order low-pass, noise, 16 bits) over
// twice the displacement limit, 5 kHz, 5 nm RMS of noise. We chose these values; they are usual for sensors
// of such strokes.
std::vector<double> through_sensor(const std::vector<double>& displacement_m, double rate_hz,
                                   const schema::Transducer& real) {
  firmware_host::LvdtParameters parameters = kTraySensor;
  parameters.range_m = 4 * real.displacement_limit_m;
  firmware_host::Lvdt sensor(parameters, 0, 0, rate_hz, true, firmware_host::Random(1, 1));
  std::vector<double> seen_m;
  for (const double place_m : displacement_m)
    seen_m.push_back(sensor.step(place_m) * sensor.converter().scale());
  return seen_m;
}

// gain x force at the finger's exact positions, by the exact reference, in the band.
std::vector<double> target_displacement_m(const EmulatedPass& pass, const schema::Texture& texture,
                                          double at_m, double gain_m_per_n, const spatial::Band& band) {
  const double rate_hz = pass.columns.header.rate_hz;
  const auto fine = static_cast<double>(samples_a_tick(rate_hz));
  const playback::FingerPath path = playback::finger_path_of({rate_hz, 0, pass.position_m});
  const double finest_hz =
      playback::highest_spatial_frequency(texture.signal) * playback::greatest_speed_mps(path);
  const auto grid = playback::reading_grid(path.duration_s(), rate_hz * fine, band, finest_hz);
  const playback::TextureLookup lookup(texture.signal, at_m);
  return playback::signal_of(
      playback::exact_target(lookup, path, grid, band, gain_m_per_n, playback::kReferenceOnsetS));
}

// A displacement in that band, filtered as the reference is (playback::keep_band), so that the parts outside
// of the band are neither target nor error.
std::vector<double> in_band(const std::vector<double>& displacement_m, double rate_hz,
                            const spatial::Band& band) {
  const double duration_s = static_cast<double>(displacement_m.size()) / rate_hz;
  const auto grid = playback::reading_grid(duration_s, rate_hz, band, 0);
  auto spectrum = playback::spectrum_of(displacement_m, rate_hz, grid.period);
  playback::keep_band(spectrum, band);
  return playback::signal_of(spectrum);
}

Result<Stretch> judged_stretch(const EmulatedPass& pass, const Texture& texture, double at_m,
                               double speed_mps) {
  const std::size_t fine = samples_a_tick(pass.columns.header.rate_hz);
  Stretch stretch;
  stretch.rate_hz = pass.columns.header.rate_hz * static_cast<double>(fine);
  const auto path = playback::finger_path_of({pass.columns.header.rate_hz, 0, pass.position_m});
  const std::size_t samples = (pass.position_m.size() - 1) * fine;
  const auto all = playback::positions_along(path, stretch.rate_hz, samples);
  const double margin_m = kFadeM + kLeftOutS * speed_mps;
  const auto first = std::ranges::lower_bound(all, at_m + margin_m);
  const auto last = std::ranges::upper_bound(all, at_m + texture.signal.length_m() - margin_m);
  if (last <= first)
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("is {} long, too short for {}",
                                    schema::for_people(texture.signal.length_m(), schema::Dimension::length),
                                    schema::for_people(speed_mps, schema::Dimension::speed)),
                        "texture", "play it slower");
  stretch.first = static_cast<std::size_t>(first - all.begin());
  stretch.count = static_cast<std::size_t>(last - first);
  stretch.position_m.assign(first, last);
  return stretch;
}

Result<Texture> along_stretch(const std::vector<double>& values, const Stretch& stretch,
                              const spatial::Band& band) {
  SignalAlongPath signal;
  signal.values = std::span(values).subspan(stretch.first, stretch.count);
  signal.position_m = stretch.position_m;
  signal.rate_hz = stretch.rate_hz;
  signal.band = band;
  signal.quantity = "displacement";
  signal.unit = "m";
  return texture_along(signal);
}

void judge(FidelityRow& row) {
  const Comparison& c = row.comparison;
  const ShiftedError shifted = shifted_error(c.spectra, c.low_per_m, c.high_per_m, kFarthestShiftM);
  row.error_db = shifted.error_db;
  row.shift_m = shifted.shift;
  row.error_in_place_db = *c.error_db;
  row.level_db = c.power_level_db;
  row.target_rms_m = c.a_rms;
  row.finger_rms_m = c.b_rms;
}

Result<FidelityRow> compared_row(const std::string& tray, const Texture& target, const Texture& played) {
  CompareOptions options;
  options.formants = false;
  auto comparison = compare(target, played, options);
  TACTO_TRY(comparison);
  FidelityRow row;
  row.tray = tray;
  row.comparison = std::move(*comparison);
  judge(row);
  return row;
}

struct FidelityTarget {
  const Texture& texture;
  const Stretch& stretch;
  spatial::Band band;
};

// Compares the displacement, and the displacement as the sensor measures it, with the target.
Result<FidelityRow> twice_compared_row(const std::string& tray, const FidelityTarget& target,
                                       const std::vector<double>& finger_m,
                                       const std::vector<double>& seen_m) {
  const auto row_of = [&](const std::vector<double>& moved_m) -> Result<FidelityRow> {
    const auto played =
        along_stretch(in_band(moved_m, target.stretch.rate_hz, target.band), target.stretch, target.band);
    TACTO_TRY(played);
    return compared_row(tray, target.texture, *played);
  };
  auto row = row_of(finger_m);
  if (!row) return row;
  const auto seen = row_of(seen_m);
  if (!seen) return seen;
  row->rerecorded_db = seen->error_db;
  return row;
}

FidelitySpeed speed_of(const EmulatedPass& pass, const Texture& texture, double speed_mps) {
  FidelitySpeed speed;
  speed.speed_mps = speed_mps;
  speed.low_hz = pass.columns.header.low_hz;
  speed.high_hz = pass.columns.header.high_hz;
  speed.band_kept_percent = spatial::band_kept_percent(texture, speed_mps, {speed.low_hz, speed.high_hz});
  speed.drive_peak_v = pass.outcome.status.ticks.drive_peak_v();
  speed.drive_limit_v = pass.columns.header.transducer.drive_limit_v;
  speed.ticks = pass.columns.tick.size();
  if (const auto& limits = pass.outcome.limits) {
    speed.amplitude_limited = limits->amplitude_limited();
    speed.slew_limited = limits->slew_limited();
    speed.removed_db = limits->removed_db();
  }
  speed.delay_left_s = pass.outcome.delay_left_s;
  speed.inverse_error_db = pass.outcome.inverse_error_db;
  speed.notes = pass.outcome.notes;
  speed.gain_m_per_n = pass.outcome.gain_m_per_n;
  if (speed.band_kept_percent < kLeastKeptPercent)
    speed.notes.push_back(
        fmt::format("at {:g} mm/s only {:.2g} % of the texture's power is in {:g}-{:g} Hz: the figures "
                    "describe little of it",
                    1e3 * speed_mps, speed.band_kept_percent, speed.low_hz, speed.high_hz));
  return speed;
}

// A target thirty times over the limit suggests a wrong unit rather than a gain that is too large.
void note_unit(FidelitySpeed& speed, const std::vector<double>& target_m, double limit_m) {
  double peak_m = 0;
  for (const double value : target_m) peak_m = std::max(peak_m, std::abs(value));
  if (peak_m < kOtherUnitRatio * limit_m) return;
  speed.notes.push_back(
      fmt::format("at {:g} mm/s the target is {}, {:.0f} dB over the transducer's limit of {}: check the "
                  "texture's unit, and "
                  "--gain",
                  1e3 * speed.speed_mps, schema::length_for_people(peak_m),
                  schema::amplitude_db(peak_m / limit_m), schema::length_for_people(limit_m)));
}

tl::unexpected<schema::Error> fidelity_stopped() {
  return schema::fail(ErrorKind::usage, "stopped before the end", "fidelity");
}

double share_done(std::size_t done, std::size_t all) {
  return static_cast<double>(done) / static_cast<double>(all);
}

struct Tray {
  std::string name;
  firmware_host::TrayPhysics physics;
};

struct Trays {
  schema::Transducer transducer;  // of the emulated device
  std::string simulated;          // origin of the simulation
  std::vector<Tray> trays;
};

constexpr double kPaperHysteresis = 0.16;

bool names_physics(const TrayPhysics& physics) {
  return physics.second_mode || physics.finger_load || physics.hysteresis > 0 ||
         physics.reconstruction_cutoff_hz;
}

firmware_host::SecondMode usual_mode(const schema::Transducer& transducer) {
  firmware_host::SecondMode mode;
  mode.frequency_hz =
      std::max(mode.frequency_hz, 1.2 * firmware_host::least_second_mode_hz(transducer, mode));
  return mode;
}

std::vector<Tray> usual_trays(const schema::Transducer& transducer) {
  TrayPhysics hysteresis, mode, load, all;
  hysteresis.hysteresis = all.hysteresis = kPaperHysteresis;
  mode.second_mode = all.second_mode = usual_mode(transducer);
  load.finger_load.emplace();
  all.finger_load.emplace();
  return {{"ideal", {}},
          {fmt::format("hysteresis {:g} %", 100 * kPaperHysteresis), hysteresis},
          {fmt::format("mode at {:.0f} Hz", mode.second_mode->frequency_hz), mode},
          {"finger's load", load},
          {"all three", all}};
}

// The trays of a `sim:` URI. If it sets hysteresis, a second mode, a finger's load or a reconstruction
// filter: one tray with exactly these. Otherwise: ideal; hysteresis of 16 % (Wiertlewski 2011, Figure 7); a
// second mode at 800 Hz (section III-B), or a fifth above the lowest that the transducer can have; a
// finger's load; all three. Errors: those of parse_sim_parameters and read_transducer.
schema::Result<Trays> trays_of(const std::string& uri) {
  constexpr std::string_view kScheme = "sim:";
  const auto parameters = firmware_host::parse_sim_parameters(std::string_view(uri).substr(kScheme.size()));
  TACTO_TRY(parameters);
  auto transducer = schema::read_transducer(parameters->transducer);
  TACTO_TRY(transducer);
  Trays trays{std::move(*transducer), fmt::format("by the emulated device of {}", kCreator), {}};
  const TrayPhysics named = parameters->tray();
  trays.trays =
      names_physics(named) ? std::vector<Tray>{{"defined by " + uri, named}} : usual_trays(trays.transducer);
  return trays;
}

// Computes the target once, and the displacement for each tray.
Result<FidelitySpeed> emulated_speed(const FidelityOptions& options, const Texture& texture,
                                     const Trays& trays, double speed_mps,
                                     const std::function<void(double)>& progress) {
  const auto played = [&](double part) { progress(kPlayedShare * part); };
  const auto pass = emulated_pass(texture, options.play, speed_mps, options.stop_asked, played);
  TACTO_TRY(pass);
  FidelitySpeed speed = speed_of(*pass, texture, speed_mps);
  const spatial::Band band{speed.low_hz, speed.high_hz};
  const double at_m = options.play.program.at_m.value_or(0);
  const auto stretch = judged_stretch(*pass, texture, at_m, speed_mps);
  TACTO_TRY(stretch);
  const auto target_m = target_displacement_m(*pass, texture, at_m, pass->outcome.gain_m_per_n, band);
  note_unit(speed, target_m, pass->columns.header.transducer.displacement_limit_m);
  const auto target = along_stretch(target_m, *stretch, band);
  TACTO_TRY(target);
  for (const Tray& tray : trays.trays) {
    if (options.stop_asked()) return fidelity_stopped();
    progress(kPlayedShare + (1 - kPlayedShare) * share_done(speed.rows.size(), trays.trays.size()));
    const auto finger_m = displacement_at_finger_m(*pass, trays.transducer, tray.physics);
    const auto seen_m = through_sensor(finger_m, stretch->rate_hz, trays.transducer);
    auto row = twice_compared_row(tray.name, {*target, *stretch, band}, finger_m, seen_m);
    TACTO_TRY(row);
    speed.rows.push_back(std::move(*row));
  }
  return speed;
}

Result<Fidelity> emulated_fidelity(const FidelityOptions& options, const Texture& texture,
                                   const std::function<void(double)>& progress) {
  const auto trays = trays_of(options.play.device_uri);
  TACTO_TRY(trays);
  Fidelity whole;
  whole.simulated = trays->simulated;
  whole.displacement =
      "the emulated tray's, integrated from its equations of motion under the session's drive";
  for (const double speed_mps : options.speeds_mps) {
    const double before = share_done(whole.speeds.size(), options.speeds_mps.size());
    auto speed = emulated_speed(options, texture, *trays, speed_mps, [&](double part) {
      if (progress) progress(before + part * share_done(1, options.speeds_mps.size()));
    });
    TACTO_TRY(speed);
    whole.speeds.push_back(std::move(*speed));
  }
  return whole;
}

// For a real device: applies the recorded drive to the transducer's model, in the user's longest stroke.
Result<Fidelity> modelled_fidelity(const FidelityOptions& options, const Texture& texture,
                                   const std::function<void(double)>& progress) {
  const auto scratch = ScratchFolder::make();
  TACTO_TRY(scratch);
  playback::PlayOptions play = options.play;
  play.session = *scratch / "pass.session";
  const auto outcome = playback::play_once(play, options.stop_asked, progress);
  TACTO_TRY(outcome);
  const auto played = played_texture(play.session, 0);
  TACTO_TRY(played);
  const auto target = target_of(texture, play.program.file, *played);
  TACTO_TRY(target);
  auto row = compared_row("the model: no load, no hysteresis", *target, played->texture);
  TACTO_TRY(row);
  FidelitySpeed speed;
  speed.low_hz = played->header.low_hz;
  speed.high_hz = played->header.high_hz;
  speed.drive_peak_v = outcome->status.ticks.drive_peak_v();
  speed.drive_limit_v = played->header.transducer.drive_limit_v;
  speed.ticks = outcome->recorder.ticks;
  speed.amplitude_limited = outcome->status.ticks.limited();
  speed.delay_left_s = outcome->delay_left_s;
  speed.inverse_error_db = outcome->inverse_error_db;
  speed.notes = outcome->notes;
  speed.gain_m_per_n = outcome->gain_m_per_n;
  speed.rows.push_back(std::move(*row));
  Fidelity whole;
  whole.simulated = outcome->simulated;
  whole.displacement = "not measured: the transducer's model under the recorded drive";
  whole.speeds.push_back(std::move(speed));
  return whole;
}

Result<void> check_speeds(const FidelityOptions& options) {
  for (const double speed : options.speeds_mps)
    if (!(speed > 0 && speed <= kFastestMps))
      return schema::fail(
          ErrorKind::usage,
          fmt::format("{:g} m/s is not a finger's speed: it has to be above 0, and at most {:g} m/s", speed,
                      kFastestMps),
          "speed", "fingers slide with 10 to 500 mm/s");
  if (options.speeds_mps.empty()) return schema::fail(ErrorKind::usage, "no speed is given", "speed");
  return {};
}

// A slower speed would fill the memory, after minutes of playing.
Result<void> check_duration(const FidelityOptions& options, const Texture& texture) {
  const double rate_hz = options.play.prepare.rate_hz;
  const double longest_s = kMostTraySamples / (rate_hz * static_cast<double>(samples_a_tick(rate_hz)));
  const double length_m = texture.signal.length_m(), slowest_mps = length_m / (longest_s - kAroundS);
  const auto words = [](double mps) { return schema::for_people(mps, schema::Dimension::speed); };
  for (const double speed : options.speeds_mps)
    if (speed < slowest_mps)
      return schema::fail(
          ErrorKind::unsuitable,
          fmt::format("at {} the texture's {} take {:.3g} s; at {:g} Hz at most {:.3g} s fit into memory",
                      words(speed), schema::length_for_people(length_m), length_m / speed, rate_hz,
                      longest_s - kAroundS),
          "speed", fmt::format("choose {} or more", words(1.001 * slowest_mps)));
  return {};
}

}  // namespace

Result<Fidelity> fidelity(const FidelityOptions& options, const std::function<void(double)>& progress) {
  TACTO_TRY(check_speeds(options));
  const auto texture = schema::read_texture(options.play.program.file);
  TACTO_TRY(texture);
  const bool emulated = options.play.device_uri.starts_with("sim:");
  if (emulated) TACTO_TRY(check_duration(options, *texture));
  auto whole = emulated ? emulated_fidelity(options, *texture, progress)
                        : modelled_fidelity(options, *texture, progress);
  if (!whole) return whole;
  whole->texture = options.play.program.file;
  whole->device = options.play.device_uri;
  whole->gain_m_per_n = whole->speeds.front().gain_m_per_n;
  whole->rate_hz = options.play.prepare.rate_hz;
  return whole;
}

}  // namespace tacto::analysis
