// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/experiment/trial_order.hpp"
#include "data-schema/base/nearest_word.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kQuantile75 = 0.6744897501960817;  // of the normal distribution, at 0.75

constexpr std::string_view kTemplateWord = "template";

struct ObserverShare {
  std::string name;
  double Observer::*member;
  double most;
};
const ObserverShare kObserverShares[] = {{"weber", &Observer::weber, 10},
                                         {"match", &Observer::match, 10},
                                         {"lapse", &Observer::lapse, 1},
                                         {"hurry", &Observer::hurry, 1}};

tl::unexpected<schema::Error> bad_observer(const std::string& what) {
  return fail(
      ErrorKind::usage, what, "--observer",
      "give for example weber=25.3%,lapse=2%,seed=1, or match=86%,weber=10%,seed=1, or template,seed=1");
}

Result<void> set(Observer& observer, const std::string& name, const std::string& value) {
  if (name == "seed" && !value.empty()) {
    observer.seed = value;
    return {};
  }
  if (name == "noise" && observer.identifies) {
    const auto noise_db = schema::parse_quantity(value, schema::Dimension::level);
    if (!noise_db || !(*noise_db >= 0))
      return fail(ErrorKind::usage, "noise is not a level from 0 dB", "--observer",
                  "give for example template,noise=12dB,seed=1");
    observer.noise_db = *noise_db;
    return {};
  }
  const auto* const found = std::ranges::find(kObserverShares, name, &ObserverShare::name);
  if (found == std::end(kObserverShares) || (observer.identifies && found->member != &Observer::hurry))
    return bad_observer(fmt::format(
        "'{}' is unknown{}", name,
        schema::did_you_mean(name, observer.identifies ? std::vector<std::string>{"noise", "hurry", "seed"}
                                                       : std::vector<std::string>{"weber", "match", "lapse",
                                                                                  "hurry", "seed"})));
  const auto share = schema::parse_quantity(value, schema::Dimension::share);
  if (!share) return bad_observer(fmt::format("{}: {}", name, share.error().what));
  if (!(*share >= 0 && *share <= found->most))
    return bad_observer(fmt::format("{} is not from 0 % to {:g} %", name, 100 * found->most));
  observer.*(found->member) = *share;
  return {};
}

}  // namespace

double uniform_of(const Observer& observer, const std::string& place, const char* what) {
  return uniform_by_sum(fmt::format("{}/{}/{}", observer.seed, place, what));
}

// Box and Muller 1958.
double normal_of(const Observer& observer, const std::string& place) {
  return std::sqrt(-2 * std::log(uniform_of(observer, place, "radius"))) *
         std::cos(2 * std::numbers::pi * uniform_of(observer, place, "angle"));
}

Result<Observer> parse_observer(std::string_view text) {
  Observer observer;
  observer.text = text;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    const std::string part(text.substr(from, end - from));
    const auto equals = part.find('=');
    if (from == 0 && part == kTemplateWord) {
      observer.identifies = true;
      from = end + 1;
      continue;
    }
    if (equals == std::string::npos) return bad_observer(fmt::format("'{}' is not NAME=VALUE", part));
    TACTO_TRY(set(observer, part.substr(0, equals), part.substr(equals + 1)));
    from = end + 1;
  }
  if (!observer.identifies && !(observer.weber > 0)) return bad_observer("weber is missing, or 0");
  return observer;
}

int smaller_period(const Observer& observer, const std::string& place,
                   const std::array<std::optional<double>, 2>& period_m, double standard_m) {
  const bool by_chance = uniform_of(observer, place, "lapse") < observer.lapse;
  if (by_chance || !period_m[0] || !period_m[1]) return uniform_of(observer, place, "guess") < 0.5 ? 1 : 2;
  const double noise_m = observer.weber * standard_m / kQuantile75 * normal_of(observer, place);
  return *period_m[0] - *period_m[1] + noise_m < 0 ? 1 : 2;
}

int rated(const Observer& observer, const std::string& place, double ratio) {
  constexpr int kMost = schema::kLargestRating;
  if (uniform_of(observer, place, "lapse") < observer.lapse)
    return static_cast<int>((2 * kMost + 1) * uniform_of(observer, place, "guess")) - kMost;
  const double noise = observer.weber / kQuantile75 * normal_of(observer, place);
  return static_cast<int>(
      std::lround(std::clamp<double>(kMost * (ratio - observer.match + noise), -kMost, kMost)));
}

bool hurries(const Observer& observer, const std::string& place) {
  return uniform_of(observer, place, "hurry") < observer.hurry;
}

}  // namespace tacto::analysis
