// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/plausible_range.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/json/known_members.hpp"
#include "data-schema/json/named_document.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kHandKind = "hand";

struct HandNumber {
  const char* name;
  double Hand::*member;
  PlausibleRange range;
};

// Anchors: Minsky 1990 (0.8 kg, 3 and 10 N s/m, 400 N/m); fingertips (some grams, 1e3 N/m, 1 N s/m); arms
// that are stiffened on purpose (up to some kg, 100 N s/m, some kN/m). Each range goes an order of magnitude
// beyond.
constexpr HandNumber kHandNumbers[] = {
    {"mass_kg", &Hand::mass_kg, {1e-4, 50}},
    {"damping_n_s_per_m", &Hand::damping_n_s_per_m, {1e-3, 1e4, true}},  // none: an ideal spring
    {"stiffness_n_per_m", &Hand::stiffness_n_per_m, {0.1, 1e5, true}},   // none: a hand that is carried along
};

Hand hand_from(const Document& document) {
  const Json& body = document.body;
  Hand hand;
  hand.name = body["name"];
  for (const auto& [name, member, range] : kHandNumbers) hand.*member = body[name];
  hand.source = body["source"];
  hand.notes = text_or(body, "notes");
  keep_unknown(document, hand);
  return hand;
}

Json hand_body(const Hand& hand) {
  Json body = Json::object();
  put_text(body, "version", hand.newer_version);
  body["name"] = hand.name;
  for (const auto& [name, member, range] : kHandNumbers) body[name] = hand.*member;
  body["source"] = hand.source;
  put_text(body, "notes", hand.notes);
  return body;
}

}  // namespace

Result<void> check_hand(const Hand& hand, const std::string& where) {
  for (const auto& [name, member, range] : kHandNumbers)
    TACTO_TRY(check_range(range, hand.*member, name, where));
  return {};
}

std::vector<std::string_view> hand_preset_names() {
  return preset_names(kHandKind);
}

Result<Hand> read_hand(const std::string& name) {
  const auto found = open_named(kHandKind, name);
  TACTO_TRY(found);
  TACTO_TRY(check_document_known(found->document, kHandKind, found->where));
  Hand hand = hand_from(found->document);
  TACTO_TRY(check_hand(hand, found->where));
  return hand;
}

Result<void> write_hand(const std::string& stem, const Hand& hand) {
  TACTO_TRY(check_hand(hand, path_of_kind(kHandKind, stem)));
  return write_named(kHandKind, stem, hand_body(hand), hand.extra_json);
}

}  // namespace tacto::schema
