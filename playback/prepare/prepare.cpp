// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "data-schema/base/quantity.hpp"
#include "playback/model/hysteresis_inverse.hpp"
#include "playback/model/identified_band.hpp"
#include "playback/model/spatial_content.hpp"
#include "playback/prepare/pyramid.hpp"
#include "playback/prepare/pyramid_shape.hpp"
#include "playback/prepare/texture_check.hpp"
#include "playback/prepare/texture_layout.hpp"
#include "playback/prepare/undone_chain.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

LeftOut levels_left_out(const Prepared& prepared) {
  const double coarsest_per_m = prepared.finest_per_m * std::exp2(-0.5 * (prepared.scale.levels - 1));
  return {fmt::format("{} of {} levels", wire::kMaxLevels - prepared.scale.levels, wire::kMaxLevels),
          fmt::format("no content is finer than {:.4g} /mm, no finger faster than {:.3g} m/s is expected",
                      1e-3 * prepared.finest_per_m, prepared.passes_to_hz / coarsest_per_m)};
}

constexpr double kLeastRateHz = 100, kMostRateHz = 100e3;
// core::half_octaves() may be 0.02 too large, so levels are chosen that much finer.
constexpr double kSpeedMargin = 1.01;
constexpr double kMostSamplesPerCount = 1024;
constexpr double kQ32 = 4294967296.0;
constexpr double kMostEnergyV = 1000, kLongestWindowS = 3600, kMostContactN = 100;

// The device checks the same with its own limits.
Result<void> check_guards(const PrepareOptions& o) {
  const auto wrong = [](const char* what, const char* remedy) {
    return fail(ErrorKind::usage, what, {}, remedy);
  };
  if (!(o.energy_rms_v >= 0 && o.energy_rms_v <= kMostEnergyV))
    return wrong("the energy limit is outside 0 to 1000 V", "an RMS of the drive; 0V turns it off");
  if (!(o.energy_window_s > 0 && o.energy_window_s <= kLongestWindowS))
    return wrong("the energy window is outside 0 to 3600 s", "1s is usual");
  if (!(o.contact_on_n >= 0 && o.contact_on_n <= kMostContactN))
    return wrong("the contact force is outside 0 to 100 N",
                 "a finger presses with 0.1 to 3 N; 0N turns it off");
  if (o.contact_on_n > 0 && !(o.contact_off_n >= 0 && o.contact_off_n <= o.contact_on_n))
    return wrong("contact ends at a larger force than it begins",
                 "choose --contact-off (contact_off_n) at most --contact (contact_on_n)");
  return {};
}

Result<void> check_prepare_options(const PrepareOptions& o) {
  const auto wrong = [](std::string what, std::string remedy) {
    return fail(ErrorKind::usage, std::move(what), {}, std::move(remedy));
  };
  if (!(o.rate_hz >= kLeastRateHz && o.rate_hz <= kMostRateHz))
    return wrong(fmt::format("a tick rate of {:g} Hz is out of range", o.rate_hz),
                 "choose from 100Hz to 100kHz; the paper's is 2kHz");
  if (!(o.metres_per_count > 0 && o.metres_per_count < 1))
    return wrong("the encoder's step is not above 0", "give the length of one count");
  if (!(o.gain_m_per_n >= 0 && o.gain_m_per_n <= 1))
    return wrong("the gain is below 0, or larger than 1 m/N", "a fingertip needs about 1mm/N");
  if (!(o.band.low_hz > 0 && o.band.low_hz < o.band.high_hz && o.band.high_hz < kMostRateHz))
    return wrong("the band is empty or reaches 0 Hz", "0 < low < high");
  if (!(o.delay_s >= 0 && o.delay_s <= 0.02)) return wrong("the delay is outside 0 to 20 ms", "2ms is usual");
  if (!(o.samples_per_period == 0 || (o.samples_per_period > 2 && o.samples_per_period <= 1000)))
    return wrong("the samples per period are outside 2 to 1000", "16 are usual");
  if (o.inverse_taps > wire::kMaxTaps)
    return wrong(fmt::format("{} taps were requested, the kernel holds {}", o.inverse_taps, wire::kMaxTaps),
                 "use fewer");
  if (!(o.max_speed_mps > 0 && o.max_speed_mps <= 10))
    return wrong("the largest speed is outside 0 to 10 m/s", "a finger moves at up to 0.5 m/s");
  if (!(o.onset_s >= 0 && o.release_s >= 0 && o.seam_m >= 0 && std::isfinite(o.onset_s + o.release_s)))
    return wrong("an onset, release or seam is below 0", "0 turns each off");
  if (!(o.reconstruction_cutoff_hz > 0 && o.reconstruction_cutoff_hz <= kMostRateHz))
    return wrong("the reconstruction filter's cut-off is not above 0", "the paper's is 600Hz");
  if (!std::isfinite(o.origin_m)) return wrong("the origin is not finite", "give a length");
  return check_guards(o);
}

Result<void> check_placed(std::span<const PlacedTexture> textures, const PrepareOptions& options) {
  if (textures.empty()) return fail(ErrorKind::unsuitable, "there is no texture to play", "scene");
  for (const PlacedTexture& placed : textures) {
    if (auto sound = check_playable(*placed.texture); !sound) return sound;
    if (!std::isfinite(placed.at_m) || !std::isfinite(placed.weight))
      return fail(ErrorKind::usage, "a texture's place or weight is not finite", "scene");
  }
  if (textures.size() > 1 && options.ends != Ends::stop)
    return fail(ErrorKind::usage, "several textures can't be looped or mirrored", "scene",
                "use the ends stop");
  return {};
}

Result<void> fill_levels(Prepared& prepared, const schema::SpaceSignal& path, const PrepareOptions& o) {
  const PyramidShape shape = pyramid_shape(highest_spatial_frequency(path), prepared.passes_to_hz, o);
  const std::size_t size = pyramid_size(path, shape);
  if (size > o.most_samples) {
    const double fits = static_cast<double>(o.most_samples) / static_cast<double>(size);
    return fail(
        ErrorKind::unsuitable,
        fmt::format("the texture needs {} samples in {} levels, the memory holds {}: about {} of its {}",
                    size, shape.levels, o.most_samples, schema::length_for_people(fits * path.length_m()),
                    schema::length_for_people(path.length_m())),
        "texture", ways_to_fit(o.interpolation));
  }
  Pyramid pyramid = make_pyramid(path, shape);
  prepared.samples = std::move(pyramid.samples);
  prepared.built.levels = pyramid.levels;
  prepared.built.sample_bytes = prepared.samples.size() * sizeof(float);
  prepared.scale.samples = static_cast<std::uint32_t>(pyramid.first_level_samples);
  prepared.scale.levels = static_cast<std::uint8_t>(shape.levels);
  prepared.finest_per_m = shape.finest_per_m;
  prepared.pitch_m = pyramid.pitch_m;
  const double full_mps = kSpeedMargin * prepared.passes_to_hz / shape.finest_per_m;
  prepared.full_detail_counts_per_tick = static_cast<float>(full_mps / (o.metres_per_count * o.rate_hz));
  return {};
}

// Textures that are far apart form one profile, with the space between them.
std::string words_of_way_between(std::span<const PlacedTexture> textures) {
  double own_m = 0;
  for (const PlacedTexture& placed : textures) own_m += placed.texture->signal.length_m();
  const double bare_m = uncovered_length_m(textures);
  if (bare_m < own_m) return {};
  return fmt::format(
      "{} between the textures need as many samples as a texture: place them closer together, or in separate "
      "scenes",
      schema::length_for_people(bare_m));
}

void tell_loop(Prepared& prepared, const schema::SpaceSignal& whole, const schema::SpaceSignal& period) {
  prepared.loop_period_m = static_cast<double>(period.values.size()) * period.pitch_m;
  prepared.loop_seam_m = static_cast<double>(whole.values.size() - period.values.size()) * period.pitch_m;
}

Result<void> lay_on_counts(Prepared& prepared, double first_m, const PrepareOptions& o) {
  core::ProfileScale& scale = prepared.scale;
  const double per_count = o.metres_per_count / prepared.pitch_m;
  if (per_count > kMostSamplesPerCount)
    return fail(ErrorKind::unsuitable,
                fmt::format("one count of the encoder spans {:.0f} samples", per_count), "encoder",
                "a texture this fine needs a finer encoder");
  scale.samples_per_count_q32 = static_cast<std::uint64_t>(std::llround(per_count * kQ32));
  scale.origin_count = o.origin_count;
  // Without timing of the edges, the middle of the count is the best estimate.
  const double at_origin =
      (o.origin_m - first_m) / prepared.pitch_m + (o.between_counts ? 0 : 0.5 * per_count);
  scale.at_origin_q32 = std::llround(at_origin * kQ32);
  scale.ends = o.ends;
  scale.interpolation = o.interpolation;
  return {};
}

bool shapes_chain(Inverse inverse) {
  return inverse == Inverse::full || inverse == Inverse::magnitude;
}

// The highest usual rate below this one at which the same inverse works, because its taps cover more time.
std::optional<double> rate_that_works(const schema::Transducer& transducer, PrepareOptions o) {
  const double asked_hz = o.rate_hz;
  for (const double rate_hz : {50e3, 40e3, 20e3, 10e3}) {
    o.rate_hz = rate_hz;
    if (rate_hz >= asked_hz) continue;
    if (inverse_of(undone_chain(transducer, o), o).error_db <= kMostInverseErrorDb) return rate_hz;
  }
  return std::nullopt;
}

Result<void> fail_by_rate(const InverseFilter& filter, const PrepareOptions& o, double works_hz) {
  return fail(ErrorKind::unsuitable,
              fmt::format("{} taps at {:g} Hz last {:.2g} ms: too short for the transducer's inverse, which "
                          "leaves an error of {:.1f} dB of the target",
                          filter.taps.size(), o.rate_hz,
                          1e3 * static_cast<double>(filter.taps.size()) / o.rate_hz, filter.error_db),
              "rate", fmt::format("play at {:g} kHz, or with --inverse gain", 1e-3 * works_hz));
}

// Either the rate is too high for the kernel's taps, or no bounded inverse exists for the transducer's model.
Result<void> check_inverse(const InverseFilter& filter, const schema::Transducer& transducer,
                           const PrepareOptions& o, const spatial::Band& band) {
  if (!shapes_chain(o.inverse) || filter.error_db <= kMostInverseErrorDb) return {};
  if (const auto works_hz = rate_that_works(transducer, o)) return fail_by_rate(filter, o, *works_hz);
  return fail(ErrorKind::unsuitable,
              fmt::format("from {:g} to {:.4g} Hz its inverse, limited to 20 dB of gain, leaves an error of "
                          "{:.1f} dB of the target",
                          band.low_hz, band.high_hz, filter.error_db),
              "transducer", "check its resonance, damping and pole; or play with --inverse gain");
}

Result<void> undo_chain(Prepared& prepared, const schema::Transducer& transducer, const UndoneChain& undone,
                        const PrepareOptions& o) {
  if (undoes_hysteresis(transducer, o)) {
    prepared.play_operators = inverse_of(*transducer.hysteresis);
    prepared.sections = {pole_lead(undone.chain.compensated_pole_hz, o.rate_hz)};
    ++prepared.built.hysteresis;
    prepared.built.play_operators = prepared.play_operators.count;
    prepared.built.sections = prepared.sections.size();
  }
  InverseFilter filter = inverse_of(undone, o);
  if (auto sound = check_inverse(filter, transducer, o, undone.band); !sound) return sound;
  prepared.built.filters += filter.solutions > 0;
  prepared.built.taps = filter.taps.size();
  prepared.taps = std::move(filter.taps);
  prepared.delay_s = filter.delay_s;
  const double delay_s = filter.delay_s + o.loop_delay_s;
  prepared.delay_left_s = o.look_ahead ? 0 : delay_s;
  prepared.inverse_error_db = filter.error_db;
  prepared.inverse_gain_db = filter.gain_db;
  prepared.beyond_band_db = filter.beyond_band_db;
  const double ahead_ticks = o.look_ahead ? delay_s * o.rate_hz : 0;
  prepared.tracker = {o.between_counts, static_cast<float>(ahead_ticks),
                      static_cast<float>(kTrackerS * o.rate_hz)};
  prepared.built.following = (o.between_counts ? 1U : 0U) + (ahead_ticks > 0 ? 1U : 0U);
  return {};
}

wire::Limits limits_of(const schema::Transducer& t, const PrepareOptions& o) {
  const double jump_mps = o.jump_mps > 0 ? o.jump_mps : 4 * o.max_speed_mps;
  const double counts = std::ceil(jump_mps / (o.metres_per_count * o.rate_hz));
  return {static_cast<float>(t.drive_limit_v),
          static_cast<float>(t.slew_limit_v_per_s),
          static_cast<float>(o.onset_s),
          static_cast<float>(o.release_s),
          o.watchdog_ms,
          static_cast<std::uint16_t>(std::clamp(counts, 10.0, 65535.0))};
}

// Adds only the limits that are requested.
void add_guards(Prepared& prepared, const PrepareOptions& o) {
  if (o.energy_rms_v > 0) {
    prepared.energy_rms_v = static_cast<float>(o.energy_rms_v);
    ++prepared.built.energy_limits;
  }
  if (o.contact_on_n > 0) {
    prepared.gate_on_n = static_cast<float>(o.contact_on_n);
    prepared.gate_off_n = static_cast<float>(o.contact_off_n);
    ++prepared.built.touch_gates;
  }
}

Prepared settled(const schema::Transducer& transducer, const UndoneChain& undone, const PrepareOptions& o) {
  Prepared prepared;
  prepared.rate_hz = o.rate_hz;
  prepared.limits = limits_of(transducer, o);
  prepared.gain_m_per_n = static_cast<float>(o.gain_m_per_n);
  prepared.energy_window_s = static_cast<float>(o.energy_window_s);
  add_guards(prepared, o);
  prepared.passes_to_hz = undone.band.high_hz;
  prepared.stops_at_hz = undone.stops_at_hz;
  if (prepared.passes_to_hz < o.band.high_hz)
    prepared.notes.push_back(
        fmt::format("at {:g} ticks per second the band ends at {:.4g} Hz", o.rate_hz, prepared.passes_to_hz));
  if (auto beyond = beyond_identified(transducer, undone.band)) prepared.notes.push_back(std::move(*beyond));
  return prepared;
}

}  // namespace

std::vector<LeftOut> left_out_of(const Prepared& prepared) {
  const ConstructionTally& built = prepared.built;
  std::vector<LeftOut> left_out;
  const auto tell = [&](std::size_t count, const char* part, const char* because) {
    if (count == 0) left_out.push_back({part, because});
  };
  tell(built.seams, "a loop's seam",
       prepared.loop_period_m > 0 ? "the texture's end meets its beginning" : "the texture is not a loop");
  if (built.levels < wire::kMaxLevels) left_out.push_back(levels_left_out(prepared));
  tell(built.filters, "a filter that inverts the transducer", "only its gain, or no inverse, was requested");
  tell(built.hysteresis, "play operators that invert a hysteresis",
       "the transducer's file has no hysteresis, or it is not inverted");
  tell(built.sections, "recursive sections", "only the inverse of a hysteresis needs them");
  tell(built.energy_limits, "an energy limit", "no limit was requested");
  tell(built.touch_gates, "a touch gate", "no contact force was requested");
  tell(built.following, "looking ahead and the timing of edges", "turned off");
  left_out.push_back(
      {"memory for another texture", "only a texture that is loaded during playback needs it"});
  return left_out;
}

core::KernelSetup Prepared::setup() const {
  core::KernelSetup setup;
  setup.texture = {{samples.data(), scale}, tracker, core::per_full_detail(full_detail_counts_per_tick)};
  setup.taps = taps.data();
  setup.tap_count = static_cast<std::uint16_t>(taps.size());
  setup.hysteresis = &play_operators;
  setup.sections = sections.data();
  setup.section_count = static_cast<std::uint8_t>(sections.size());
  setup.limits = limits;
  setup.rate_hz = core::rate_of(rate_millihertz());
  setup.energy_rms_v = energy_rms_v;
  setup.energy_window_s = energy_window_s;
  setup.gate_on_n = gate_on_n;
  setup.gate_off_n = gate_off_n;
  return setup;
}

std::string ways_to_fit(wire::Interpolation interpolation) {
  const bool sparse = interpolation == wire::Interpolation::sinc;
  return fmt::format(
      "play a shorter part{}, or close the loop on the host (--loop host; \"loop\": \"host\" in the daemon's "
      "configuration)",
      sparse ? "" : ", interpolate by sinc (--interpolation sinc; \"interpolation\" in playback)");
}

Result<void> check_prepare(std::span<const PlacedTexture> textures, const PrepareOptions& options) {
  if (auto sound = check_prepare_options(options); !sound) return sound;
  return check_placed(textures, options);
}

Result<Prepared> prepare(std::span<const PlacedTexture> textures, const schema::Transducer& transducer,
                         const PrepareOptions& options) {
  TACTO_TRY(check_prepare(textures, options));
  const UndoneChain undone = undone_chain(transducer, options);
  Prepared prepared = settled(transducer, undone, options);
  const schema::SpaceSignal path = one_period(textures, options.ends, options.seam_m, prepared.built);
  if (options.ends == Ends::loop) tell_loop(prepared, textures.front().texture->signal, path);
  const std::string between = words_of_way_between(textures);
  if (!between.empty()) prepared.notes.push_back(between);
  if (auto filled = fill_levels(prepared, path, options); !filled) {
    if (!between.empty()) filled.error().remedy += "; " + between;
    return schema::forward_error(filled);
  }
  TACTO_TRY(lay_on_counts(prepared, path.origin_m, options));
  TACTO_TRY(undo_chain(prepared, transducer, undone, options));
  return prepared;
}

}  // namespace tacto::playback
