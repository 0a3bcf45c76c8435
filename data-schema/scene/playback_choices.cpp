// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/playback_choices.hpp"

#include "data-schema/scene/playback_choices_json.hpp"

namespace tacto::schema {
namespace {

template <class Table>
void take_members(Json& body, PlaybackChoices& choices, const Table& table) {
  for (const auto& [name, member] : table) {
    if (!body.contains(name)) continue;
    choices.*member = body[name].template get<typename std::decay_t<decltype(choices.*member)>::value_type>();
    body.erase(name);
  }
}

}  // namespace

PlaybackChoices PlaybackChoices::over(const PlaybackChoices& base) const {
  PlaybackChoices all = *this;
  for (const auto& [name, member] : kChosenWords)
    if (!(all.*member)) all.*member = base.*member;
  for (const auto& [name, member] : kChosenNumbers)
    if (!(all.*member)) all.*member = base.*member;
  if (contact_on_n) all.contact_off_n = contact_off_n;
  return all;
}

PlaybackChoices playback_choices_from(const Json& body) {
  PlaybackChoices choices;
  Json rest = body;
  take_members(rest, choices, kChosenWords);
  take_members(rest, choices, kChosenNumbers);
  if (!rest.empty()) choices.extra_json = rest.dump();
  return choices;
}

Json playback_choices_body(const PlaybackChoices& choices) {
  Json body = Json::object();
  for (const auto& [name, member] : kChosenWords)
    if (choices.*member) body[name] = *(choices.*member);
  for (const auto& [name, member] : kChosenNumbers)
    if (choices.*member) body[name] = *(choices.*member);
  if (!choices.extra_json.empty()) body.update(Json::parse(choices.extra_json));
  return body;
}

PlaybackChoices playback_choices_in(const Json& document) {
  return document.contains("playback") ? playback_choices_from(document["playback"]) : PlaybackChoices{};
}

}  // namespace tacto::schema
