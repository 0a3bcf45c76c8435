// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "data-schema/experiment/protocol.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/json/known_members.hpp"
#include "data-schema/json/named_document.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kProtocolKind = "protocol";
constexpr std::string_view kKeyKind = "protocol_key";

struct LimitCount {
  const char* name;
  int DeliveryLimits::*member;
};
constexpr LimitCount kLimitCounts[] = {{"lost_ticks", &DeliveryLimits::lost_ticks},
                                       {"fault_ticks", &DeliveryLimits::fault_ticks},
                                       {"late_ticks", &DeliveryLimits::late_ticks},
                                       {"blind_ticks", &DeliveryLimits::blind_ticks}};

struct LimitNumber {
  const char* name;
  double DeliveryLimits::*member;
};
constexpr LimitNumber kLimitNumbers[] = {{"removed_by_limits_db", &DeliveryLimits::removed_by_limits_db},
                                         {"error_db", &DeliveryLimits::error_db},
                                         {"slowest_mps", &DeliveryLimits::slowest_mps},
                                         {"fastest_mps", &DeliveryLimits::fastest_mps}};

struct ShownText {
  const char* name;
  std::string ProtocolTexts::*member;
  bool (*is_shown)(const Protocol&);
};
constexpr const char* kTaskWords[] = {"two_interval", "identification", "amplitude",
                                      "ordering",     "adjustment",     "fidelity"};
constexpr const char* kMethodWords[] = {"constant", "staircase", "quest_plus"};
constexpr const char* kGoalWords[] = {"least", "greatest", "match"};
// Those that a task may have.
const std::pair<std::string, Task> kOptionalMembers[] = {{"intended", Task::ordering},
                                                         {"method", Task::two_interval}};
// The members of each task. Those of another one are refused.
const std::vector<std::string> kTaskMembers[] = {
    {"standard", "keep", "levels"},
    {"standards", "comparisons", "conditions", "most_trials", "longest_s"},
    {"standards", "largest_ratio"},
    {"standards"},
    {"standards", "goal", "smallest_ratio", "largest_ratio", "step_db"},
    {"standards"}};
bool is_always_shown(const Protocol& /*protocol*/) {
  return true;
}

bool places_samples(const Protocol& protocol) {
  return protocol.task == Task::fidelity ||
         std::ranges::find(protocol.conditions, kRealCondition) != protocol.conditions.end();
}

bool has_force_range(const Protocol& protocol) {
  return protocol.normal_force.has_value();
}

constexpr ShownText kShownTexts[] = {
    {"welcome", &ProtocolTexts::welcome, is_always_shown},
    {"begin", &ProtocolTexts::begin, is_always_shown},
    {"interval", &ProtocolTexts::interval, is_always_shown},
    {"question", &ProtocolTexts::question, is_always_shown},
    {"end", &ProtocolTexts::end, is_always_shown},
    {"break", &ProtocolTexts::rest, [](const Protocol& protocol) { return protocol.breaks.any(); }},
    {"place", &ProtocolTexts::place, places_samples},
    {"left", &ProtocolTexts::left, [](const Protocol& protocol) { return protocol.task == Task::ordering; }},
    {"too_early", &ProtocolTexts::too_early,
     [](const Protocol& protocol) { return protocol.task == Task::adjustment; }},
    {"practice", &ProtocolTexts::practice, [](const Protocol& protocol) { return protocol.practice > 0; }},
    {"force_below", &ProtocolTexts::force_below, has_force_range},
    {"force_within", &ProtocolTexts::force_within, has_force_range},
    {"force_above", &ProtocolTexts::force_above, has_force_range}};

Task task_of(const Json& body) {
  return static_cast<Task>(std::ranges::find(kTaskWords, body["task"].get<std::string>()) -
                           std::begin(kTaskWords));
}

void take_two_interval(const Json& body, Protocol& protocol) {
  const Json& standard = body["standard"];
  protocol.standard = {standard["period_m"], standard["amplitude_m"], standard["length_m"]};
  protocol.keep_slope = body["keep"] == "slope";
  protocol.levels = body["levels"].get<std::vector<double>>();
  if (const auto method = text_or(body, "method"); !method.empty())
    protocol.method =
        static_cast<LevelMethod>(std::ranges::find(kMethodWords, method) - std::begin(kMethodWords));
}

void take_identification(const Json& body, Protocol& protocol) {
  protocol.standards = body["standards"].get<std::vector<std::string>>();
  protocol.comparisons = body["comparisons"].get<std::vector<std::string>>();
  protocol.conditions = body["conditions"].get<std::vector<std::string>>();
  protocol.most_trials = body["most_trials"];
  protocol.longest_s = body["longest_s"];
}

void take_amplitude(const Json& body, Protocol& protocol) {
  protocol.standards = body["standards"].get<std::vector<std::string>>();
  protocol.largest_ratio = body["largest_ratio"];
}

void take_ordering(const Json& body, Protocol& protocol) {
  protocol.standards = body["standards"].get<std::vector<std::string>>();
  if (body.contains("intended")) protocol.intended = body["intended"].get<std::vector<double>>();
}

void take_adjustment(const Json& body, Protocol& protocol) {
  take_amplitude(body, protocol);
  protocol.goal = *goal_of(body["goal"].get<std::string>());
  protocol.smallest_ratio = body["smallest_ratio"];
  protocol.step_db = body["step_db"];
}

Protocol protocol_from(const Document& document) {
  const Json& body = document.body;
  Protocol protocol;
  const Json &pace = body["pace"], &answers = body["answers"];
  protocol.task = task_of(body);
  if (protocol.task == Task::two_interval) take_two_interval(body, protocol);
  if (protocol.task == Task::identification) take_identification(body, protocol);
  if (protocol.task == Task::amplitude) take_amplitude(body, protocol);
  if (protocol.task == Task::ordering || protocol.task == Task::fidelity) take_ordering(body, protocol);
  if (protocol.task == Task::adjustment) take_adjustment(body, protocol);
  protocol.repetitions = body["repetitions"];
  protocol.seed = body["seed"];
  protocol.gain_m_per_n = body["gain_m_per_n"];
  protocol.pace = {pace["from_m"], pace["to_m"], pace["speed_mps"], pace["strokes"],
                   pace.value("cue", false)};
  protocol.lead_s = body["lead_s"];
  for (const Json& choice : answers["choices"]) protocol.choices.push_back({choice["key"], choice["word"]});
  protocol.begin_key = answers["begin_key"];
  protocol.most_attempts = body["most_attempts"];
  protocol.participants = body["participants"];
  const Json& delivered = body["delivered"];
  for (const auto& [name, member] : kLimitCounts) protocol.delivered.*member = delivered[name];
  for (const auto& [name, member] : kLimitNumbers) protocol.delivered.*member = delivered[name];
  if (body.contains("breaks"))
    protocol.breaks = {body["breaks"].value("after_trials", 0), body["breaks"].value("after_s", 0.0)};
  if (body.contains("masking_noise")) {
    const Json& noise = body["masking_noise"];
    protocol.masking_noise =
        MaskingNoise{noise["low_hz"], noise["high_hz"], noise["level_db"], noise["tolerance_db"]};
  }
  if (body.contains("normal_force"))
    protocol.normal_force = ForceRange{body["normal_force"]["low_n"], body["normal_force"]["high_n"]};
  for (const auto& [language, texts] : body["texts"].items())
    for (const ShownText& each : kShownTexts)
      protocol.texts[language].*each.member = text_or(texts, each.name);
  protocol.practice = body.value("practice", 0);
  protocol.analysis = text_or(body, "analysis");
  protocol.notes = text_or(body, "notes");
  keep_unknown(document, protocol);
  return protocol;
}

void put_two_interval(Json& body, const Protocol& protocol) {
  body["standard"] = {{"period_m", protocol.standard.period_m},
                      {"amplitude_m", protocol.standard.amplitude_m},
                      {"length_m", protocol.standard.length_m}};
  body["keep"] = protocol.keep_slope ? "slope" : "amplitude";
  body["levels"] = protocol.levels;
  if (protocol.method != LevelMethod::constant) body["method"] = word_of(protocol.method);
}

void put_identification(Json& body, const Protocol& protocol) {
  body["standards"] = protocol.standards;
  body["comparisons"] = protocol.comparisons;
  body["conditions"] = protocol.conditions;
  body["most_trials"] = protocol.most_trials;
  body["longest_s"] = protocol.longest_s;
}

void put_amplitude(Json& body, const Protocol& protocol) {
  body["standards"] = protocol.standards;
  body["largest_ratio"] = protocol.largest_ratio;
}

void put_ordering(Json& body, const Protocol& protocol) {
  body["standards"] = protocol.standards;
  if (!protocol.intended.empty()) body["intended"] = protocol.intended;
}

void put_adjustment(Json& body, const Protocol& protocol) {
  put_amplitude(body, protocol);
  body["goal"] = word_of(protocol.goal);
  body["smallest_ratio"] = protocol.smallest_ratio;
  body["step_db"] = protocol.step_db;
}

Json protocol_body(const Protocol& protocol) {
  Json body = Json::object();
  put_text(body, "version", protocol.newer_version);
  body["task"] = word_of(protocol.task);
  if (protocol.task == Task::two_interval) put_two_interval(body, protocol);
  if (protocol.task == Task::identification) put_identification(body, protocol);
  if (protocol.task == Task::amplitude) put_amplitude(body, protocol);
  if (protocol.task == Task::ordering || protocol.task == Task::fidelity) put_ordering(body, protocol);
  if (protocol.task == Task::adjustment) put_adjustment(body, protocol);
  body["repetitions"] = protocol.repetitions;
  body["seed"] = protocol.seed;
  body["gain_m_per_n"] = protocol.gain_m_per_n;
  body["pace"] = {{"from_m", protocol.pace.from_m},
                  {"to_m", protocol.pace.to_m},
                  {"speed_mps", protocol.pace.speed_mps},
                  {"strokes", protocol.pace.strokes}};
  if (protocol.pace.cue) body["pace"]["cue"] = true;
  body["lead_s"] = protocol.lead_s;
  body["answers"] = {{"choices", Json::array()}, {"begin_key", protocol.begin_key}};
  for (const auto& [key, word] : protocol.choices)
    body["answers"]["choices"].push_back({{"key", key}, {"word", word}});
  body["most_attempts"] = protocol.most_attempts;
  body["participants"] = protocol.participants;
  body["delivered"] = Json::object();
  for (const auto& [name, member] : kLimitCounts) body["delivered"][name] = protocol.delivered.*member;
  for (const auto& [name, member] : kLimitNumbers) body["delivered"][name] = protocol.delivered.*member;
  if (const auto& noise = protocol.masking_noise)
    body["masking_noise"] = {{"low_hz", noise->low_hz},
                             {"high_hz", noise->high_hz},
                             {"level_db", noise->level_db},
                             {"tolerance_db", noise->tolerance_db}};
  if (const auto& force = protocol.normal_force)
    body["normal_force"] = {{"low_n", force->low_n}, {"high_n", force->high_n}};
  if (protocol.breaks.after_trials > 0) body["breaks"]["after_trials"] = protocol.breaks.after_trials;
  if (protocol.breaks.after_s > 0) body["breaks"]["after_s"] = protocol.breaks.after_s;
  for (const auto& [language, texts] : protocol.texts)
    for (const ShownText& each : kShownTexts)
      put_text(body["texts"][language], each.name, texts.*each.member);
  if (protocol.practice > 0) body["practice"] = protocol.practice;
  put_text(body, "analysis", protocol.analysis);
  put_text(body, "notes", protocol.notes);
  return body;
}

Result<void> malformed_at(const std::string& path, const char* member, const std::string& what,
                          const std::string& remedy) {
  return fail(ErrorKind::malformed, what, path + "#/" + member, remedy);
}

Result<void> check_levels(const Protocol& protocol, const std::string& path) {
  if (protocol.method == LevelMethod::staircase && protocol.levels.front() < 0 && protocol.levels.back() > 0)
    return malformed_at(path, "levels", "a staircase has longer and shorter periods",
                        "give only longer ones, or only shorter ones");
  for (std::size_t i = 0; i < protocol.levels.size(); ++i) {
    const std::string place = fmt::format("levels/{}", i);
    if (protocol.levels[i] == 0)
      return malformed_at(path, place.c_str(), "the stretch 0 is that of the standard", "leave it out");
    if (i > 0 && !(protocol.levels[i] > protocol.levels[i - 1]))
      return malformed_at(path, place.c_str(), "the levels do not rise", "sort them; each occurs once");
  }
  return {};
}

std::size_t answers_of(const Protocol& protocol) {
  if (protocol.task == Task::two_interval || protocol.task == Task::fidelity) return 2;
  if (protocol.task == Task::amplitude) return 2 * kLargestRating + 1;
  if (protocol.task == Task::adjustment) return static_cast<std::size_t>(Turn::accept);
  return protocol.standards.size();
}

Result<void> check_answers(const Protocol& protocol, const std::string& path) {
  std::set<std::string> keys = {protocol.begin_key}, words;
  for (const auto& [key, word] : protocol.choices) {
    if (!keys.insert(key).second)
      return malformed_at(path, "answers", "one key has two meanings",
                          "give each choice and begin_key a different key");
    if (!words.insert(word).second)
      return malformed_at(path, fmt::format("answers/choices/{}/word", words.size()).c_str(),
                          "two answers have the same word", "give them different words");
  }
  const std::size_t expected = answers_of(protocol);
  if (protocol.choices.size() == expected) return {};
  return malformed_at(path, "answers/choices",
                      fmt::format("has {} answers, the task {}", protocol.choices.size(), expected),
                      "give one for each interval, for each standard, for each rating from -3 to 3, for "
                      "weaker, stronger and accepted, or for same and different");
}

// A line of a file of answers is a word, a key or a label (K3): each has one meaning.
Result<void> check_words(const Protocol& protocol, const std::string& path) {
  const bool identifies = protocol.task == Task::identification;
  for (std::size_t i = 0; i < protocol.choices.size(); ++i) {
    const std::string place = fmt::format("answers/choices/{}/word", i), &word = protocol.choices[i].word;
    if (identifies && word != protocol.standards[i])
      return malformed_at(path, place.c_str(),
                          fmt::format("'{}' is not standard {}, '{}'", word, i + 1, protocol.standards[i]),
                          "name the choices after the standards, in their order");
    for (std::size_t j = 0; j < protocol.choices.size(); ++j)
      if (j != i && protocol.choices[j].key == word)
        return malformed_at(path, place.c_str(),
                            fmt::format("'{}' is also the key of '{}'", word, protocol.choices[j].word),
                            "choose another word or key; a texture's name is that of its file");
    if (is_label(word))
      return malformed_at(path, place.c_str(), fmt::format("'{}' could be the label of a sample", word),
                          "choose a word that is not K and a number; a texture's name is that of its file");
  }
  return {};
}

Result<void> check_names(const Protocol& protocol, const std::string& path) {
  const std::size_t names = protocol.standards.size();
  const bool matches = protocol.task == Task::adjustment && protocol.goal == Goal::match;
  const bool one = protocol.task == Task::amplitude || protocol.task == Task::adjustment;
  if (protocol.task != Task::two_interval && (one != (names == 1)) && !(matches && names == 2))
    return malformed_at(
        path, "standards", fmt::format("has {} names", names),
        "give two or more in an identification, ordering or fidelity, else one; to match them, one or "
        "two");
  if (!protocol.intended.empty() && protocol.intended.size() != names)
    return malformed_at(path, "intended",
                        fmt::format("has {} numbers for {} standards", protocol.intended.size(), names),
                        "give one for each standard, in their order, or leave it out");
  std::set<std::string> standards;
  for (const std::string& name : protocol.standards)
    if (!standards.insert(name).second)
      return malformed_at(path, "standards", name + " occurs twice", "name each texture once");
  for (std::size_t i = 0; i < protocol.comparisons.size(); ++i)
    if (standards.erase(protocol.comparisons[i]) == 0)
      return malformed_at(path, fmt::format("comparisons/{}", i).c_str(),
                          protocol.comparisons[i] + " is no standard, or occurs twice",
                          "name each once, and only standards");
  return {};
}

Result<void> check_members_of_task(const Json& body, const std::string& path) {
  const std::vector<std::string>& own = kTaskMembers[static_cast<int>(task_of(body))];
  for (const std::vector<std::string>& members : kTaskMembers)
    for (const std::string& name : members) {
      const bool expected = std::ranges::find(own, name) != own.end();
      if (body.contains(name) == expected) continue;
      return malformed_at(path, name.c_str(),
                          fmt::format("a protocol of the task {} {}", body["task"].get<std::string>(),
                                      expected ? "needs this member" : "does not have this member"),
                          expected ? "add it" : "remove it");
    }
  for (const auto& [name, task] : kOptionalMembers)
    if (body.contains(name) && task_of(body) != task)
      return malformed_at(path, name.c_str(),
                          fmt::format("only a protocol of the task {} may have this member", word_of(task)),
                          "remove it");
  return {};
}

Result<void> check_pace(const Protocol& protocol, const std::string& path) {
  const ProtocolPace& pace = protocol.pace;
  if (!(pace.to_m - pace.from_m >= 5e-3))
    return malformed_at(path, "pace/to_m", "a stroke from from_m to to_m is shorter than 5 mm",
                        "give a longer path: shorter movements are not strokes");
  if (protocol.task == Task::two_interval && pace.to_m > protocol.standard.length_m)
    return malformed_at(
        path, "pace/to_m",
        fmt::format("the path ends at {:g} m, the texture at {:g} m", pace.to_m, protocol.standard.length_m),
        "end the path earlier, or make standard/length_m longer");
  if (!(protocol.delivered.slowest_mps <= pace.speed_mps && pace.speed_mps <= protocol.delivered.fastest_mps))
    return malformed_at(
        path, "pace/speed_mps",
        fmt::format("{:g} m/s is not between delivered/slowest_mps and fastest_mps", pace.speed_mps),
        "every trial would fail: change one of them");
  return {};
}

// "en", "pt-BR"
bool is_language(const std::string& code) {
  const std::size_t letters = std::min(code.find_first_not_of("abcdefghijklmnopqrstuvwxyz"), code.size());
  return (letters == 2 || letters == 3) && (letters == code.size() || code[letters] == '-');
}

// Each language has all texts that are shown.
Result<void> check_texts(const Protocol& protocol, const std::string& path) {
  for (const auto& [language, texts] : protocol.texts) {
    if (!is_language(language))
      return malformed_at(path, fmt::format("texts/{}", language).c_str(), "this is no code of a language",
                          "give a code such as en or pt-BR");
    for (const ShownText& each : kShownTexts)
      if (each.is_shown(protocol) && (texts.*each.member).empty())
        return malformed_at(path, fmt::format("texts/{}/{}", language, each.name).c_str(),
                            "this text is shown in a run, and is missing or empty",
                            fmt::format("add it in the language {}", language));
  }
  return {};
}

Result<void> check_protocol(const Protocol& protocol, const std::string& path) {
  TACTO_TRY(check_levels(protocol, path));
  TACTO_TRY(check_names(protocol, path));
  TACTO_TRY(check_answers(protocol, path));
  TACTO_TRY(check_words(protocol, path));
  TACTO_TRY(check_texts(protocol, path));
  if (const auto& noise = protocol.masking_noise; noise && noise->high_hz < noise->low_hz + 1)
    return malformed_at(path, "masking_noise/high_hz", "the band is narrower than 1 Hz", "give a wider band");
  if (const auto& force = protocol.normal_force; force && !(force->low_n < force->high_n))
    return malformed_at(path, "normal_force/high_n", "is not above low_n", "give a higher force");
  return check_pace(protocol, path);
}

std::string stem_of_study(const std::string& study) {
  return stem_of(study, ".protocol");
}

Result<Document> open_known(const std::string& path, std::string_view kind) {
  auto document = open_document(path, kind);
  TACTO_TRY(document);
  TACTO_TRY(check_document_known(*document, kind, path));
  return document;
}

}  // namespace

const char* word_of(Task task) {
  return kTaskWords[static_cast<int>(task)];
}

const char* word_of(LevelMethod method) {
  return kMethodWords[static_cast<int>(method)];
}

const char* word_of(Goal goal) {
  return kGoalWords[static_cast<int>(goal)];
}

std::optional<Goal> goal_of(std::string_view word) {
  const auto* const found = std::ranges::find(kGoalWords, word);
  if (found == std::end(kGoalWords)) return std::nullopt;
  return static_cast<Goal>(found - std::begin(kGoalWords));
}

Result<ProtocolTexts> texts_in(const Protocol& protocol, const std::string& language) {
  if (const auto found = protocol.texts.find(language); found != protocol.texts.end()) return found->second;
  std::vector<std::string> languages;
  for (const auto& [each, texts] : protocol.texts) languages.push_back(each);
  return fail(
      ErrorKind::usage, fmt::format("the protocol has no texts in the language '{}'", language), "--language",
      fmt::format("give one of {}, or add texts/{} to the protocol", fmt::join(languages, ", "), language));
}

std::string question_of(const Protocol& protocol) {
  const auto usual = protocol.texts.find(kUsualLanguage);
  return (usual != protocol.texts.end() ? usual : protocol.texts.begin())->second.question;
}

bool is_label(std::string_view line) {
  return line.size() > 1 && line.front() == 'K' &&
         line.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

std::string protocol_path(const std::string& study) {
  return stem_of_study(study) + ".protocol.json";
}

std::string key_path(const std::string& study) {
  return stem_of_study(study) + ".key.json";
}

Result<Protocol> read_protocol(const std::string& name) {
  const std::string path = name.ends_with(".json") && is_file(name) ? name : protocol_path(name);
  const auto document = open_known(path, kProtocolKind);
  TACTO_TRY(document);
  TACTO_TRY(check_members_of_task(document->body, path));
  Protocol protocol = protocol_from(*document);
  TACTO_TRY(check_protocol(protocol, path));
  const auto sum = sha256_of_file(path);
  TACTO_TRY(sum);
  protocol.sha256 = *sum;
  return protocol;
}

Result<std::string> protocol_text(const Protocol& protocol) {
  TACTO_TRY(check_protocol(protocol, std::string(kProtocolKind)));
  return document_text(kProtocolKind, protocol_body(protocol), protocol.extra_json);
}

Result<ProtocolKey> read_protocol_key(const std::string& path) {
  const auto document = open_known(path, kKeyKind);
  TACTO_TRY(document);
  ProtocolKey key;
  std::set<std::string> codes;
  std::set<std::pair<double, std::string>> meanings;
  for (const Json& body : document->body["stimuli"]) {
    const CodedStimulus& stimulus = key.stimuli.emplace_back(
        CodedStimulus{body["code"], body.value("stretch", 0.0), text_or(body, "name"), body["sha256"]});
    const std::string where = fmt::format("{}#/stimuli/{}", path, key.stimuli.size() - 1);
    if (body.contains("stretch") == body.contains("name"))
      return fail(ErrorKind::malformed, "has both stretch and name, or neither", where, "give one of them");
    if (!codes.insert(stimulus.code).second || !meanings.emplace(stimulus.stretch, stimulus.name).second)
      return fail(ErrorKind::malformed, "its code, or its stretch or name, occurs twice", where,
                  "each has one code");
  }
  const auto sum = sha256_of_file(path);
  TACTO_TRY(sum);
  key.sha256 = *sum;
  return key;
}

Result<std::string> protocol_key_text(const ProtocolKey& key) {
  Json body = {{"stimuli", Json::array()}};
  for (const CodedStimulus& each : key.stimuli) {
    Json& stimulus = body["stimuli"].emplace_back(Json{{"code", each.code}, {"sha256", each.sha256}});
    if (each.name.empty())
      stimulus["stretch"] = each.stretch;
    else
      stimulus["name"] = each.name;
  }
  return document_text(kKeyKind, body, {});
}

Result<void> check_participant(const std::string& participant) {
  const auto is = [](int (*kind)(int)) {
    return [kind](char c) { return kind(static_cast<unsigned char>(c)) != 0; };
  };
  if (!participant.empty() && participant.size() <= 16 &&
      std::ranges::all_of(participant, is(std::isalnum)) &&
      std::ranges::any_of(participant, is(std::isdigit)))
    return {};
  return fail(ErrorKind::usage, fmt::format("'{}' is not the code of a participant", participant),
              "--participant",
              "give letters and digits, such as P07: names of people do not belong in files");
}

}  // namespace tacto::schema
