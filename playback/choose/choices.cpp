// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/choose/choices.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "playback/choose/budget_words.hpp"

namespace tacto::playback {
namespace {

constexpr double kContactOffPart = 0.8;  // of the force at which contact begins

constexpr std::pair<std::string_view, Inverse> kInverses[] = {{"full", Inverse::full},
                                                              {"magnitude", Inverse::magnitude},
                                                              {"gain", Inverse::gain},
                                                              {"none", Inverse::none}};
constexpr std::pair<std::string_view, Reconstruction> kReconstructions[] = {
    {"none", Reconstruction::none}, {"butterworth3", Reconstruction::butterworth3}};
constexpr std::pair<std::string_view, Hold> kHolds[] = {{"none", Hold::none},
                                                        {"zero-order", Hold::zero_order}};

template <class Table, class Choice>
std::string word_in(const Table& table, Choice choice) {
  for (const auto& [word, meaning] : table)
    if (meaning == choice) return std::string(word);
  return {};
}

// Writes an unknown word to `wrong`.
template <class Table, class Choice>
void take_word(const Table& table, const std::optional<std::string>& word, Choice& choice,
               std::string& wrong) {
  if (!word) return;
  for (const auto& [name, meaning] : table)
    if (name == *word) return void(choice = meaning);
  wrong = *word;
}

void take_numbers(PrepareOptions& options, const schema::PlaybackChoices& choices) {
  options.reconstruction_cutoff_hz = choices.cutoff_hz.value_or(options.reconstruction_cutoff_hz);
  options.energy_rms_v = choices.energy_rms_v.value_or(options.energy_rms_v);
  options.energy_window_s = choices.energy_window_s.value_or(options.energy_window_s);
  if (choices.contact_on_n) {
    options.contact_on_n = *choices.contact_on_n;
    options.contact_off_n = kContactOffPart * options.contact_on_n;
  }
  options.contact_off_n = choices.contact_off_n.value_or(options.contact_off_n);
}

}  // namespace

std::string_view to_string(Inverse inverse) {
  return std::ranges::find(kInverses, inverse, &std::pair<std::string_view, Inverse>::second)->first;
}

schema::Result<PrepareOptions> with_choices(PrepareOptions options, const schema::PlaybackChoices& choices) {
  std::string wrong;
  if (choices.interpolation) {
    const auto reading = interpolation_of(*choices.interpolation);
    options.interpolation = reading.value_or(options.interpolation);
    if (!reading) wrong = *choices.interpolation;
  }
  take_word(kInverses, choices.inverse, options.inverse, wrong);
  take_word(kReconstructions, choices.reconstruction, options.reconstruction, wrong);
  take_word(kHolds, choices.hold, options.hold, wrong);
  take_numbers(options, choices);
  if (wrong.empty()) return options;
  return schema::fail(schema::ErrorKind::usage, fmt::format("'{}' is not a choice of playback", wrong),
                      "playback", "playback.schema.json lists the choices");
}

schema::Result<void> check_consistent(const schema::PlaybackChoices& said,
                                      const schema::PlaybackChoices& all) {
  const auto nothing = [](const char* what, const char* where, const char* remedy) {
    return schema::fail(schema::ErrorKind::usage, what, where, remedy);
  };
  if (said.cutoff_hz && all.reconstruction.value_or("none") == "none")
    return nothing("a cut-off is given, but no filter", "--cutoff (cutoff_hz)",
                   "name the filter (--reconstruction butterworth3; \"reconstruction\" in playback), or omit "
                   "the cut-off");
  if (said.energy_window_s && !(all.energy_rms_v.value_or(0) > 0))
    return nothing("an energy window is given, but no limit", "--energy-window (energy_window_s)",
                   "give the limit (--energy-limit; \"energy_rms_v\" in playback), or omit the window");
  if (said.contact_off_n && !(all.contact_on_n.value_or(0) > 0))
    return nothing("a force is given at which contact ends, but none at which it begins",
                   "--contact-off (contact_off_n)",
                   "give both (--contact; \"contact_on_n\" in playback), or neither");
  return {};
}

schema::PlaybackChoices choices_in(const PrepareOptions& options) {
  schema::PlaybackChoices choices;
  choices.interpolation = std::string(to_string(options.interpolation));
  choices.inverse = word_in(kInverses, options.inverse);
  choices.reconstruction = word_in(kReconstructions, options.reconstruction);
  choices.hold = word_in(kHolds, options.hold);
  if (options.reconstruction != Reconstruction::none) choices.cutoff_hz = options.reconstruction_cutoff_hz;
  if (options.energy_rms_v > 0) {
    choices.energy_rms_v = options.energy_rms_v;
    choices.energy_window_s = options.energy_window_s;
  }
  if (!(options.contact_on_n > 0)) return choices;
  choices.contact_on_n = options.contact_on_n;
  choices.contact_off_n = options.contact_off_n;
  return choices;
}

}  // namespace tacto::playback
