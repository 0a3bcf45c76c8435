// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::schema {
namespace {

Result<void> checked_hysteresis(const Hysteresis& hysteresis, const std::string& place) {
  const auto& [thresholds_v, weights] = hysteresis;
  if (thresholds_v.size() != weights.size() || weights.empty())
    return fail(ErrorKind::malformed,
                fmt::format("{} weights for {} thresholds", weights.size(), thresholds_v.size()), place);
  if (thresholds_v.front() != 0 || !std::ranges::is_sorted(thresholds_v, std::ranges::less_equal{}))
    return fail(ErrorKind::malformed, "the thresholds do not increase from 0", place + "/thresholds_v");
  if (!(weights.front() > 0) || std::ranges::any_of(weights, [](double w) { return !(w >= 0); }))
    return fail(ErrorKind::malformed, "the first weight must be above 0 and no other weight below 0",
                place + "/weights", "otherwise the operator has no inverse");
  return {};
}

}  // namespace

Result<void> check_extras(const Transducer& transducer, const std::string& where) {
  const auto& found = transducer.identification;
  if (found && !(found->low_hz < found->high_hz))
    return fail(ErrorKind::malformed,
                fmt::format("valid from {} to {} Hz is not a band", found->low_hz, found->high_hz),
                where + "#/identification");
  if (!transducer.hysteresis) return {};
  return checked_hysteresis(*transducer.hysteresis, where + "#/hysteresis");
}

Result<void> check_usable(const Transducer& transducer, bool forced) {
  const auto& found = transducer.identification;
  if (forced || !found || found->usable()) return {};
  return fail(ErrorKind::unsuitable,
              found->converged ? "by its identification the model does not fit: " + found->words
                               : "its identification did not converge: " + found->words,
              fmt::format("transducer '{}'", transducer.name),
              "identify it again, or accept it with --unfit-transducer");
}

}  // namespace tacto::schema
