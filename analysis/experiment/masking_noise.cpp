// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/masking_noise.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/experiment/trial_order.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/wav/wav.hpp"
#include "playback/prepare/prepare.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

schema::MaskingNoise usual_masking_noise(double level_db) {
  const spatial::Band band = playback::PrepareOptions{}.band;
  return {band.low_hz, 3 * band.high_hz, level_db, 3};
}

std::vector<double> masking_noise(const schema::MaskingNoise& noise, const std::string& seed) {
  const auto count = static_cast<std::size_t>(std::lround(kNoiseRateHz * kNoisePeriodS));
  spatial::RealFft fft(count);
  std::vector<std::complex<double>> spectrum(fft.bins());
  const auto first = static_cast<std::size_t>(std::ceil(noise.low_hz * kNoisePeriodS));
  double lines = 0;
  for (std::size_t k = first; static_cast<double>(k) <= noise.high_hz * kNoisePeriodS; ++k, ++lines)
    spectrum[k] = std::polar(1.0, 2 * std::numbers::pi * uniform_by_sum(fmt::format("{}/noise/{}", seed, k)));
  // A line of |X| has the mean square 2 |X|^2 / count^2.
  const double scale =
      schema::amplitude_of_db(kNoiseRmsDb) * static_cast<double>(count) / std::sqrt(2 * lines);
  for (std::complex<double>& line : spectrum) line *= scale;
  std::vector<double> samples(count);
  fft.inverse(spectrum, samples);
  return samples;
}

Result<void> write_masking_noise(const std::string& path, const schema::MaskingNoise& noise,
                                 const std::string& seed, schema::Existing existing) {
  schema::PendingFiles pending;
  const auto temporary = pending.add(path);
  TACTO_TRY(temporary);
  auto writer = schema::WavWriter::create(*temporary, kNoiseRateHz, 1, schema::SampleFormat::float32);
  TACTO_TRY(writer);
  TACTO_TRY(writer->write(masking_noise(noise, seed)));
  TACTO_TRY(writer->close());
  return pending.commit(existing);
}

Result<std::string> checked_masking_level(const schema::Protocol& protocol,
                                          std::optional<double> measured_db) {
  const auto& noise = protocol.masking_noise;
  if (!noise && measured_db)
    return fail(ErrorKind::usage, "the protocol has no masking noise", "--masking-level",
                "leave it out, or add masking_noise to the protocol");
  if (!noise) return std::string();
  if (!measured_db) return std::string("not measured");
  if (std::abs(*measured_db - noise->level_db) <= noise->tolerance_db)
    return fmt::format("{:g} dB", *measured_db);
  return fail(ErrorKind::usage,
              fmt::format("{:g} dB is not within {:g} dB of the protocol's {:g} dB", *measured_db,
                          noise->tolerance_db, noise->level_db),
              "--masking-level", "change the volume of the noise, and measure again");
}

std::string noise_in_words(const std::optional<schema::MaskingNoise>& noise) {
  if (!noise) return "none";
  return fmt::format("{:g} to {:g} Hz, {:g} dB within {:g} dB", noise->low_hz, noise->high_hz,
                     noise->level_db, noise->tolerance_db);
}

std::string noise_of_run(const Run& run) {
  if (!run.study.protocol.masking_noise) return "none";
  std::vector<std::string> levels = {run.journal.plan.masking_level};
  for (const schema::JournalEntry& entry : run.journal.entries)
    if (const auto* const resumed = std::get_if<schema::RunResumed>(&entry))
      levels.push_back(resumed->masking_level);
  return fmt::format("{}; at the ear, by the operator: {}", noise_in_words(run.study.protocol.masking_noise),
                     fmt::join(levels, ", after an interruption "));
}

}  // namespace tacto::analysis
