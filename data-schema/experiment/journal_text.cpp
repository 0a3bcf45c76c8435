// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <exception>
#include <stdexcept>

#include "data-schema/base/format_version.hpp"
#include "data-schema/experiment/journal.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/json/json_text.hpp"

namespace tacto::schema {
namespace {

constexpr std::size_t kCheckDigits = 16;
constexpr std::string_view kCheckMember = R"(,"check":")";

struct FactText {
  const char* name;
  std::string IntervalFacts::*member;
};
constexpr FactText kFactTexts[] = {{"stimulus_sha256", &IntervalFacts::stimulus_sha256},
                                   {"simulated", &IntervalFacts::simulated}};

struct FactCount {
  const char* name;
  std::uint64_t IntervalFacts::*member;
};
constexpr FactCount kFactCounts[] = {{"ticks", &IntervalFacts::ticks},
                                     {"lost_ticks", &IntervalFacts::lost_ticks},
                                     {"fault_ticks", &IntervalFacts::fault_ticks},
                                     {"late_ticks", &IntervalFacts::late_ticks},
                                     {"blind_ticks", &IntervalFacts::blind_ticks},
                                     {"strokes", &IntervalFacts::strokes}};

struct FactNumber {
  const char* name;
  double IntervalFacts::*member;
};
constexpr FactNumber kFactNumbers[] = {{"slowest_mps", &IntervalFacts::slowest_mps},
                                       {"fastest_mps", &IntervalFacts::fastest_mps}};

struct PerhapsFact {
  const char* name;
  std::optional<double> IntervalFacts::*member;
};
constexpr PerhapsFact kPerhapsFacts[] = {{"removed_by_limits_db", &IntervalFacts::removed_by_limits_db},
                                         {"predicted_error_db", &IntervalFacts::predicted_error_db},
                                         {"measured_error_db", &IntervalFacts::measured_error_db},
                                         {"predicted_period_m", &IntervalFacts::predicted_period_m},
                                         {"measured_period_m", &IntervalFacts::measured_period_m},
                                         {"predicted_gain_m_per_n", &IntervalFacts::predicted_gain_m_per_n},
                                         {"measured_gain_m_per_n", &IntervalFacts::measured_gain_m_per_n},
                                         {"last_gain", &IntervalFacts::last_gain}};

struct PlanText {
  const char* name;
  std::string RunPlanned::*member;
};
constexpr PlanText kPlanTexts[] = {{"study", &RunPlanned::study},
                                   {"participant", &RunPlanned::participant},
                                   {"protocol_sha256", &RunPlanned::protocol_sha256},
                                   {"key_sha256", &RunPlanned::key_sha256},
                                   {"device", &RunPlanned::device},
                                   {"observer", &RunPlanned::observer},
                                   {"language", &RunPlanned::language},
                                   {"masking_level", &RunPlanned::masking_level},
                                   {"created", &RunPlanned::created},
                                   {"creator", &RunPlanned::creator}};

Json facts_body(const IntervalFacts& facts) {
  Json body = Json::object();
  for (const auto& [name, member] : kFactCounts) body[name] = facts.*member;
  body["closed"] = facts.closed;
  for (const auto& [name, member] : kFactTexts) put_text(body, name, facts.*member);
  for (const auto& [name, member] : kFactNumbers) body[name] = facts.*member;
  for (const auto& [name, member] : kPerhapsFacts)
    if (facts.*member) body[name] = *(facts.*member);
  return body;
}

IntervalFacts facts_from(const Json& body) {
  IntervalFacts facts;
  for (const auto& [name, member] : kFactCounts) facts.*member = body.at(name);
  facts.closed = body.at("closed");
  for (const auto& [name, member] : kFactTexts) facts.*member = text_or(body, name);
  for (const auto& [name, member] : kFactNumbers) facts.*member = body.at(name);
  for (const auto& [name, member] : kPerhapsFacts)
    if (body.contains(name)) facts.*member = body.at(name).get<double>();
  return facts;
}

// Adds the members of one entry to a line.
struct EntryWriter {
  Json& body;

  void operator()(const RunPlanned& plan) const {
    body["event"] = "plan", body["kind"] = "trials", body["version"] = kFormatVersion;
    for (const auto& [name, member] : kPlanTexts) put_text(body, name, plan.*member);
    body["order"] = plan.order;
  }
  void operator()(const AttemptBegun& begun) const {
    body["event"] = "begun", body["attempt"] = begun.attempt, body["trial"] = begun.trial;
    body["stimuli"] = begun.stimuli, body["sessions"] = begun.sessions;
    body["block"] = begun.block, body["block_s"] = begun.block_s;
  }
  void operator()(const DeliveryJudged& judged) const {
    body["event"] = "delivered", body["attempt"] = judged.attempt, body["delivered"] = judged.delivered;
    body["why"] = judged.why, body["intervals"] = Json::array();
    for (const IntervalFacts& facts : judged.intervals) body["intervals"].push_back(facts_body(facts));
    for (const std::optional<double>& share : judged.force_within)
      body["force_within"].push_back(share ? Json(*share) : Json());
  }
  void operator()(const SamplePlaced& placed) const {
    body["event"] = "placed", body["attempt"] = placed.attempt, body["label"] = placed.label;
  }
  void operator()(const StimulusExplored& explored) const {
    body["event"] = "explored", body["attempt"] = explored.attempt;
    body["stimulus"] = explored.stimulus, body["session"] = explored.session;
  }
  void operator()(const AttemptAnswered& answered) const {
    body["event"] = "answered", body["attempt"] = answered.attempt, body["choice"] = answered.choice;
    body["word"] = answered.word, body["answer_s"] = answered.answer_s;
  }
  void operator()(const BlockOver& over) const { body["event"] = "block_over", body["block"] = over.block; }
  void operator()(const BreakTaken& taken) const { body["event"] = "break", body["break_s"] = taken.break_s; }
  void operator()(const RunResumed& resumed) const {
    body["event"] = "resumed", body["created"] = resumed.created;
    put_text(body, "masking_level", resumed.masking_level);
  }
  void operator()(const RunEnded& ended) const { body["event"] = "end", body["created"] = ended.created; }
};

// Throws where the members are missing or of another type.
JournalEntry journal_entry_from(const Json& body) {
  const auto event = body.at("event").get<std::string>();
  if (event == "plan") {
    RunPlanned plan;
    for (const auto& [name, member] : kPlanTexts) plan.*member = text_or(body, name);
    plan.order = body.at("order");
    return plan;
  }
  if (event == "begun")
    return AttemptBegun{body.at("attempt"),  body.at("trial"), body.at("stimuli"),
                        body.at("sessions"), body.at("block"), body.at("block_s")};
  if (event == "delivered") {
    DeliveryJudged judged{
        body.at("attempt"), body.at("delivered"), body.at("why").get<std::vector<std::string>>(), {}};
    for (const Json& facts : body.at("intervals")) judged.intervals.push_back(facts_from(facts));
    if (body.contains("force_within"))
      for (const Json& share : body.at("force_within"))
        judged.force_within.push_back(share.is_null() ? std::nullopt : std::optional(share.get<double>()));
    return judged;
  }
  if (event == "answered")
    return AttemptAnswered{body.at("attempt"), body.at("choice"), body.at("word"), body.at("answer_s")};
  if (event == "explored")
    return StimulusExplored{body.at("attempt"), body.at("stimulus"), body.at("session")};
  if (event == "placed") return SamplePlaced{body.at("attempt"), body.at("label")};
  if (event == "block_over") return BlockOver{body.at("block")};
  if (event == "break") return BreakTaken{body.at("break_s")};
  if (event == "resumed") return RunResumed{body.at("created"), text_or(body, "masking_level")};
  if (event != "end") throw std::invalid_argument("event");
  return RunEnded{body.at("created")};
}

std::string line_check(std::string_view body) {
  return sha256_of(body).substr(0, kCheckDigits);
}

// The line without its check; empty if the check is wrong.
std::string checked_body(std::string_view line) {
  const std::size_t tail = kCheckMember.size() + kCheckDigits + 2;  // "}
  if (line.size() <= tail) return {};
  const std::string_view end = line.substr(line.size() - tail);
  std::string body = std::string(line.substr(0, line.size() - tail)) + "}";
  const bool right = end == fmt::format("{}{}\"}}", kCheckMember, line_check(body));
  return right ? body : std::string();
}

// None: not a line of this journal.
std::optional<JournalEntry> entry_in(std::string_view line, std::size_t number) try {
  const auto body = parse_json(checked_body(line), {});
  if (!body || body->at("line") != number) return std::nullopt;
  auto entry = journal_entry_from(*body);
  const bool plan = std::holds_alternative<RunPlanned>(entry);
  return plan == (number == 1) ? std::optional(std::move(entry)) : std::nullopt;
} catch (const std::exception&) {
  return std::nullopt;
}

// Another major version may have other events: it is refused before its lines are read.
Result<void> check_journal_version(std::string_view text, const std::string& where) {
  const auto plan = parse_json(checked_body(text.substr(0, text.find('\n'))), {});
  if (!plan || !plan->is_object()) return {};
  TACTO_TRY(newer_version(text_or(*plan, "version"), where, where + ": line 1"));
  return {};
}

}  // namespace

std::string journal_line(const JournalEntry& entry, std::size_t number) {
  Json body = {{"line", number}};
  std::visit(EntryWriter{body}, entry);
  std::string text = body.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string check = line_check(text);
  text.pop_back();
  return text + fmt::format("{}{}\"}}\n", kCheckMember, check);
}

Result<Journal> parse_journal(std::string_view text, const std::string& where) {
  TACTO_TRY(check_journal_version(text, where));
  Journal journal;
  std::string_view rest = text;
  for (auto end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    auto entry = entry_in(rest.substr(0, end), journal.entries.size() + 1);
    rest.remove_prefix(end + 1);
    if (!entry && rest.empty()) break;
    if (!entry)
      return fail(ErrorKind::malformed, "its check, its number or its content is wrong",
                  fmt::format("{}: line {}", where, journal.entries.size() + 1),
                  "the file was changed; take it from a copy");
    journal.entries.push_back(std::move(*entry));
    journal.sound_bytes = text.size() - rest.size();
  }
  if (journal.entries.empty())
    return fail(ErrorKind::unsuitable, "has no whole line: nothing was begun", where,
                "remove it, and run the experiment");
  journal.plan = std::get<RunPlanned>(journal.entries.front());
  return journal;
}

Result<Journal> read_journal(const std::string& path) {
  const auto text = read_file(path);
  TACTO_TRY(text);
  return parse_journal(*text, path);
}

}  // namespace tacto::schema
