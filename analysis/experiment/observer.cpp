// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "analysis/experiment/trial_order.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/nearest_word.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kQuantile75 = 0.6744897501960817;  // of the normal distribution, at 0.75

using schema::Task;

constexpr double kUsualOrderNoiseDb = 1;

// Observers without a number that defines them.
const std::map<std::string_view, Task> kTaskOfWord = {{"template", Task::identification},
                                                      {"order", Task::ordering}};

struct ObserverShare {
  std::string name;
  double Observer::*member;
  double most;
  std::vector<Task> of;
};
const ObserverShare kObserverShares[] = {
    {"weber", &Observer::weber, 10, {Task::two_interval, Task::amplitude}},
    {"match", &Observer::match, 10, {Task::amplitude}},
    {"threshold", &Observer::threshold, 10, {Task::adjustment}},
    {"sd", &Observer::sd, 1, {Task::adjustment}},
    {"hysteresis", &Observer::hysteresis, 1, {Task::adjustment}},
    {"lapse", &Observer::lapse, 1, {Task::two_interval, Task::amplitude}},
    {"hurry",
     &Observer::hurry,
     1,
     {Task::two_interval, Task::identification, Task::amplitude, Task::ordering, Task::adjustment}}};

tl::unexpected<schema::Error> bad_observer(const std::string& what) {
  return fail(ErrorKind::usage, what, "--observer",
              "give for example weber=25.3%,lapse=2%,seed=1, or match=86%,weber=10%,seed=1, or "
              "template,seed=1, or order,noise=1dB,seed=1, or threshold=20%,sd=10%,seed=1");
}

bool has_noise(const Observer& observer) {
  return observer.task == Task::identification || observer.task == Task::ordering;
}

std::vector<std::string> names_of(const Observer& observer) {
  std::vector<std::string> names = {"seed"};
  if (has_noise(observer)) names.emplace_back("noise");
  for (const ObserverShare& each : kObserverShares)
    if (std::ranges::find(each.of, observer.task) != each.of.end()) names.push_back(each.name);
  return names;
}

Result<void> set(Observer& observer, const std::string& name, const std::string& value) {
  if (name == "seed" && !value.empty()) {
    observer.seed = value;
    return {};
  }
  const std::vector<std::string> names = names_of(observer);
  if (std::ranges::find(names, name) == names.end())
    return bad_observer(fmt::format("'{}' is unknown to an observer of the task {}{}", name,
                                    schema::word_of(observer.task), schema::did_you_mean(name, names)));
  if (name == "noise") {
    const auto noise_db = schema::parse_quantity(value, schema::Dimension::level);
    if (!noise_db || !(*noise_db >= 0))
      return fail(ErrorKind::usage, "noise is not a level from 0 dB", "--observer",
                  fmt::format("give for example {},noise=12dB,seed=1",
                              observer.task == Task::ordering ? "order" : "template"));
    observer.noise_db = *noise_db;
    return {};
  }
  const auto* const found = std::ranges::find(kObserverShares, name, &ObserverShare::name);
  if (found == std::end(kObserverShares)) return bad_observer("seed has no value");
  const auto share = schema::parse_quantity(value, schema::Dimension::share);
  if (!share) return bad_observer(fmt::format("{}: {}", name, share.error().what));
  if (!(*share >= 0 && *share <= found->most))
    return bad_observer(fmt::format("{} is not from 0 % to {:g} %", name, 100 * found->most));
  observer.*(found->member) = *share;
  return {};
}

// By a word at the beginning, or by a name.
Task task_of(const std::vector<std::string>& parts) {
  if (const auto found = kTaskOfWord.find(parts.front()); found != kTaskOfWord.end()) return found->second;
  const auto has = [&](std::string_view name) {
    return std::ranges::any_of(parts, [&](const std::string& part) { return part.starts_with(name); });
  };
  if (has("threshold=")) return Task::adjustment;
  return has("match=") ? Task::amplitude : Task::two_interval;
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
  std::vector<std::string> parts;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    parts.emplace_back(text.substr(from, end - from));
    from = end + 1;
  }
  observer.task = task_of(parts);
  if (kTaskOfWord.contains(parts.front())) parts.erase(parts.begin());
  for (const std::string& part : parts) {
    const auto equals = part.find('=');
    if (equals == std::string::npos) return bad_observer(fmt::format("'{}' is not NAME=VALUE", part));
    TACTO_TRY(set(observer, part.substr(0, equals), part.substr(equals + 1)));
  }
  const bool by_weber = observer.task == Task::two_interval || observer.task == Task::amplitude;
  if (by_weber && !(observer.weber > 0)) return bad_observer("weber is missing, or 0");
  if (observer.task == Task::amplitude && !(observer.match > 0)) return bad_observer("match is 0");
  if (observer.task == Task::adjustment && !(observer.threshold > 0)) return bad_observer("threshold is 0");
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

double perceived_level_db(const Observer& observer, const std::string& place, double rms_m) {
  constexpr double kReferenceM = 1e-6;
  return schema::amplitude_db(rms_m / kReferenceM) +
         observer.noise_db.value_or(kUsualOrderNoiseDb) * normal_of(observer, place);
}

double criterion_of(const Observer& observer, const std::string& place, bool ascending) {
  const double shift = std::sqrt(1 + observer.hysteresis);
  return observer.threshold * std::exp(observer.sd * normal_of(observer, place)) *
         (ascending ? 1 / shift : shift);
}

bool hurries(const Observer& observer, const std::string& place) {
  return uniform_of(observer, place, "hurry") < observer.hurry;
}

}  // namespace tacto::analysis
