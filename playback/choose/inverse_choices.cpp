// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/choose/inverse_choices.hpp"

#include <algorithm>

#include "playback/prepare/undone_chain.hpp"

namespace tacto::playback {
namespace {

constexpr std::uint16_t kTapCounts[] = {8, 16, 24, 32, 48, 64, 96, 128};
constexpr double kDelaysS[] = {0.5e-3, 1e-3, 2e-3, 3e-3, 4e-3};

InverseChoice judged_choice(const UndoneChain& undone, const PrepareOptions& options) {
  const InverseFilter filter = inverse_of(undone, options);
  return {options.inverse, filter.delay_s, static_cast<std::uint16_t>(filter.taps.size()),
          largest_inverse_error(undone, filter)};
}

// The taps of a filter must extend beyond its delay.
bool reaches_answer(std::uint16_t taps, double delay_s, double rate_hz) {
  return taps > 1.25 * delay_s * rate_hz;
}

}  // namespace

PrepareOptions InverseChoice::in(PrepareOptions options) const {
  options.inverse = inverse;
  options.delay_s = delay_s;
  options.inverse_taps = taps;
  return options;
}

std::vector<InverseChoice> inverse_choices(const schema::Transducer& transducer,
                                           const PrepareOptions& options, bool keep_inverse) {
  const UndoneChain undone = undone_chain(transducer, options);
  PrepareOptions shaping = options, flat = options;
  if (!keep_inverse) shaping.inverse = Inverse::full, flat.inverse = Inverse::gain;
  const bool shapes = shaping.inverse == Inverse::full || shaping.inverse == Inverse::magnitude;
  std::vector<InverseChoice> choices;
  if (!keep_inverse || !shapes) choices.push_back(judged_choice(undone, flat));
  for (const std::uint16_t taps : kTapCounts)
    for (const double delay_s : kDelaysS)
      if (shapes && reaches_answer(taps, delay_s, options.rate_hz))
        choices.push_back(
            judged_choice(undone, InverseChoice{shaping.inverse, delay_s, taps, 0}.in(shaping)));
  return choices;
}

}  // namespace tacto::playback
