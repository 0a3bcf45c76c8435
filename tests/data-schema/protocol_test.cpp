// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/experiment/protocol.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

class ProtocolFile : public testing::Test {
 protected:
  Result<Protocol> read_with(const std::string& pointer, const nlohmann::json& value) {
    nlohmann::json body = body_;
    body[nlohmann::json::json_pointer(pointer)] = value;
    PendingFiles pending;
    EXPECT_TRUE(pending.write(folder_ / "odd.protocol.json", body.dump()));
    EXPECT_TRUE(pending.commit());
    return read_protocol(folder_ / "odd");
  }
  void expect_fault(const std::string& pointer, const nlohmann::json& value, const std::string& place) {
    const auto refused = read_with(pointer, value);
    ASSERT_FALSE(refused) << pointer;
    EXPECT_EQ(refused.error().kind, ErrorKind::malformed) << pointer;
    EXPECT_TRUE(refused.error().where.ends_with("odd.protocol.json#" + place)) << refused.error().where;
  }

  tests::TemporaryFolder folder_;
  const nlohmann::json body_ = nlohmann::json::parse(R"({
    "kind": "protocol", "version": "1.0", "task": "two_interval", "keep": "slope", "levels": [-0.5, 0.5],
    "standard": {"period_m": 0.00176, "amplitude_m": 1.28e-5, "length_m": 0.06},
    "repetitions": 2, "seed": "1", "gain_m_per_n": 0.001, "lead_s": 0.5, "most_attempts": 3, "participants": 8,
    "pace": {"from_m": 0.01, "to_m": 0.05, "speed_mps": 0.06, "strokes": 2},
    "answers": {"choices": [{"key": "f", "word": "first"}, {"key": "j", "word": "second"}], "begin_key": " "},
    "delivered": {"lost_ticks": 0, "fault_ticks": 0, "late_ticks": 0, "blind_ticks": 0,
                  "removed_by_limits_db": -40, "error_db": -20, "slowest_mps": 0.045, "fastest_mps": 0.085},
    "texts": {"en": {"welcome": "w", "begin": "b", "interval": "i", "question": "q", "end": "e"}}})");
};

TEST_F(ProtocolFile, ReadsBack) {
  const auto protocol = read_with("/notes", "a note");
  ASSERT_TRUE(protocol) << message(protocol.error());
  const auto text = protocol_text(*protocol);
  ASSERT_TRUE(text) << message(text.error());
  nlohmann::json expected = body_;
  expected["notes"] = "a note";
  EXPECT_EQ(nlohmann::json::parse(*text), expected);
  EXPECT_EQ(stored_files(folder_ / "odd")->front().kind, FileKind::protocol);
  EXPECT_TRUE(check_file({FileKind::protocol, folder_ / "odd.protocol.json"})->findings.empty());
  EXPECT_EQ(protocol->sha256, sha256_of_file(folder_ / "odd.protocol.json").value());
}

TEST_F(ProtocolFile, TextsAreByLanguageAndEachFaultHasItsPlace) {
  nlohmann::json other = body_["texts"]["en"];
  other["question"] = "f", other["x_lab"] = "n";
  const auto two = read_with("/texts/de", other);
  ASSERT_TRUE(two) << message(two.error());
  EXPECT_EQ(texts_in(*two, "de").value().question, "f");
  EXPECT_EQ(question_of(*two), "q");
  const auto absent = texts_in(*two, "fr");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().kind, ErrorKind::usage);
  EXPECT_EQ(nlohmann::json::parse(protocol_text(*two).value())["texts"]["de"], other);
  const auto one = read_with("/texts", {{"pt-BR", other}});
  ASSERT_TRUE(one) << message(one.error());
  EXPECT_EQ(question_of(*one), "f");
  expect_fault("/texts", nlohmann::json::object(), "/texts");
  expect_fault("/texts/English", other, "/texts/English");
  expect_fault("/texts/en/welcome", "", "/texts/en/welcome");
  expect_fault("/texts/en/welcome", 3, "/texts/en/welcome");
  expect_fault("/texts/en/welcom", "w", "/texts/en/welcom");
  nlohmann::json less = other;
  less.erase("end");
  const auto refused = read_with("/texts/de", less);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().where.find("#/texts/de") != std::string::npos) << refused.error().where;
}

TEST_F(ProtocolFile, BreaksAndNoiseReadBackAndEachFaultHasItsPlace) {
  nlohmann::json body = body_;
  body["breaks"] = {{"after_trials", 20}, {"after_s", 600.0}};
  body["masking_noise"] = {{"low_hz", 15.0}, {"high_hz", 1500.0}, {"level_db", 65.0}, {"tolerance_db", 3.0}};
  body["texts"]["en"]["break"] = "p";
  const auto read = read_with("", body);
  ASSERT_TRUE(read) << message(read.error());
  EXPECT_EQ(nlohmann::json::parse(protocol_text(*read).value()), body);
  expect_fault("/breaks", {{"after_trials", 20}}, "/texts/en/break");
  const auto expect = [&](const char* pointer, const nlohmann::json& value, const char* place) {
    nlohmann::json odd = body;
    odd[nlohmann::json::json_pointer(pointer)] = value;
    expect_fault("", odd, place);
  };
  expect("/breaks", nlohmann::json::object(), "/breaks");
  expect("/breaks/after_trials", 0, "/breaks/after_trials");
  expect("/breaks/after_min", 10, "/breaks/after_min");
  expect("/masking_noise/high_hz", 15.0, "/masking_noise/high_hz");
  expect("/masking_noise/level_db", 90.0, "/masking_noise/level_db");
}

TEST_F(ProtocolFile, EachFaultHasItsPlace) {
  expect_fault("/task", "ranking", "/task");
  expect_fault("/levels", {0.5, 0.5}, "/levels/1");
  expect_fault("/levels", {-0.5, 0.0, 0.5}, "/levels/1");
  expect_fault("/levels", {0.5}, "/levels");
  expect_fault("/answers/choices/1/key", "f", "/answers");
  expect_fault("/answers/begin_key", "j", "/answers");
  expect_fault("/answers/choices/1/word", "first", "/answers/choices/1/word");
  expect_fault("/answers/choices/1/word", "f", "/answers/choices/1/word");
  expect_fault("/answers/choices/1/word", "K12", "/answers/choices/1/word");
  expect_fault("/answers/choices/0/key", "ff", "/answers/choices/0/key");
  expect_fault("/answers/choices/2", {{"key", "k"}, {"word", "third"}}, "/answers/choices");
  expect_fault("/standards", {"A", "B"}, "/standards");
  expect_fault("/pace/to_m", 0.014, "/pace/to_m");
  expect_fault("/pace/to_m", 0.07, "/pace/to_m");
  expect_fault("/pace/speed_mps", 0.1, "/pace/speed_mps");
  expect_fault("/seed", "a/b", "/seed");
  expect_fault("/repetitions", 0, "/repetitions");
  const auto unknown = read_with("/repetition", 3);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::malformed);
  EXPECT_NE(unknown.error().remedy.find("repetitions"), std::string::npos) << unknown.error().remedy;
  for (const char* method : {"staircase", "quest_plus"}) {
    nlohmann::json body = body_;
    body["levels"] = {0.5, 0.7}, body["method"] = method;
    PendingFiles pending;
    ASSERT_TRUE(pending.write(folder_ / "adaptive.protocol.json", body.dump()));
    ASSERT_TRUE(pending.commit());
    const auto protocol = read_protocol(folder_ / "adaptive");
    ASSERT_TRUE(protocol) << message(protocol.error());
    EXPECT_EQ(word_of(protocol->method), std::string(method));
    EXPECT_EQ(nlohmann::json::parse(protocol_text(*protocol).value()), body);
  }
  EXPECT_TRUE(read_with("/method", "quest_plus"));
  expect_fault("/method", "staircase", "/levels");  // of both signs
  expect_fault("/method", "quest", "/method");
  EXPECT_TRUE(read_with("/x_lab", 3));
  const auto newer = read_with("/version", "2.0");
  ASSERT_FALSE(newer);
  EXPECT_EQ(newer.error().kind, ErrorKind::unsupported_version);
}

// The task identification in place of the other one; `change` is merged into it, null removes a member.
nlohmann::json identification(nlohmann::json body, const nlohmann::json& change) {
  for (const char* member : {"standard", "keep", "levels"}) body.erase(member);
  body.merge_patch(nlohmann::json::parse(R"({
    "task": "identification", "standards": ["A", "B"], "comparisons": ["B"], "conditions": ["virtual", "real"],
    "most_trials": 100, "longest_s": 900.0})"));
  body["texts"]["en"]["place"] = "p";
  body["answers"]["choices"][0]["word"] = "A", body["answers"]["choices"][1]["word"] = "B";
  body.merge_patch(change);
  return body;
}

TEST_F(ProtocolFile, AnAmplitudeReadsBackAndEachFaultHasItsPlace) {
  nlohmann::json amplitude = body_;
  for (const char* member : {"standard", "keep", "levels"}) amplitude.erase(member);
  amplitude.merge_patch({{"task", "amplitude"}, {"standards", {"E"}}, {"largest_ratio", 2.0}});
  nlohmann::json choices = nlohmann::json::array();
  for (int rating = -3; rating <= 3; ++rating)
    choices.push_back({{"key", std::string(1, "asdfjkl"[rating + 3])}, {"word", std::to_string(rating)}});
  amplitude["answers"]["choices"] = choices;
  const auto read = [&](const nlohmann::json& change) {
    nlohmann::json body = amplitude;
    body.merge_patch(change);
    PendingFiles pending;
    EXPECT_TRUE(pending.write(folder_ / "odd.protocol.json", body.dump()));
    EXPECT_TRUE(pending.commit());
    return read_protocol(folder_ / "odd");
  };
  const auto protocol = read(nlohmann::json::object());
  ASSERT_TRUE(protocol) << message(protocol.error());
  EXPECT_EQ(nlohmann::json::parse(protocol_text(*protocol).value()), amplitude);
  nlohmann::json key_is_a_word = choices;
  key_is_a_word[0]["key"] = "1";
  for (const auto& [change, place] :
       {std::pair<nlohmann::json, const char*>{{{"standards", {"E", "F"}}}, "/standards"},
        {{{"largest_ratio", nullptr}}, "/largest_ratio"},
        {{{"largest_ratio", 1.0}}, "/largest_ratio"},
        {{{"longest_s", 900.0}}, "/longest_s"},
        {{{"answers", {{"choices", {choices[0], choices[1]}}}}}, "/answers/choices"},
        {{{"answers", {{"choices", key_is_a_word}}}}, "/answers/choices/4/word"}}) {
    const auto refused = read(change);
    ASSERT_FALSE(refused) << change;
    EXPECT_EQ(refused.error().kind, ErrorKind::malformed) << change;
    EXPECT_TRUE(refused.error().where.ends_with(std::string("odd.protocol.json#") + place))
        << refused.error().where;
  }
}

TEST_F(ProtocolFile, AnOrderingAndAnAdjustmentReadBackAndEachFaultHasItsPlace) {
  nlohmann::json ordering = body_, adjustment;
  for (const char* member : {"standard", "keep", "levels"}) ordering.erase(member);
  ordering.merge_patch({{"task", "ordering"}, {"standards", {"A", "B", "C"}}, {"intended", {0.5, 2.0, 1.0}}});
  ordering["texts"]["en"]["left"] = "l";
  const auto choices = [](const std::vector<std::string>& words) {
    nlohmann::json all = nlohmann::json::array();
    for (std::size_t i = 0; i < words.size(); ++i)
      all.push_back({{"key", std::string(1, "123456789"[i])}, {"word", words[i]}});
    return all;
  };
  adjustment = ordering;
  adjustment.erase("intended"), adjustment["texts"]["en"].erase("left");
  ordering["answers"]["choices"] = choices({"1", "2", "3"});
  adjustment.merge_patch({{"task", "adjustment"}, {"standards", {"A"}}, {"goal", "match"}});
  adjustment.merge_patch({{"smallest_ratio", 0.05}, {"largest_ratio", 4.0}, {"step_db", 1.0}});
  adjustment["answers"]["choices"] = choices({"weaker", "stronger", "accepted"});
  adjustment["texts"]["en"]["too_early"] = "t";
  const auto read = [&](nlohmann::json body, const nlohmann::json& change) {
    body.merge_patch(change);
    PendingFiles pending;
    EXPECT_TRUE(pending.write(folder_ / "odd.protocol.json", body.dump()));
    EXPECT_TRUE(pending.commit());
    return read_protocol(folder_ / "odd");
  };
  for (const nlohmann::json& body : {ordering, adjustment}) {
    const auto protocol = read(body, nlohmann::json::object());
    ASSERT_TRUE(protocol) << message(protocol.error());
    EXPECT_EQ(nlohmann::json::parse(protocol_text(*protocol).value()), body);
  }
  EXPECT_TRUE(read(ordering, {{"intended", nullptr}}));
  nlohmann::json fidelity = ordering;
  fidelity.erase("intended"), fidelity["texts"]["en"].erase("left");
  fidelity.merge_patch({{"task", "fidelity"}});
  fidelity["texts"]["en"]["place"] = "p", fidelity["answers"]["choices"] = choices({"same", "different"});
  const auto beside = read(fidelity, nlohmann::json::object());
  ASSERT_TRUE(beside) << message(beside.error());
  EXPECT_EQ(nlohmann::json::parse(protocol_text(*beside).value()), fidelity);
  EXPECT_TRUE(read(adjustment, {{"standards", {"A", "B"}}}));
  using Fault = std::tuple<const nlohmann::json*, nlohmann::json, const char*>;
  for (const auto& [body, change, place] :
       {Fault{&ordering, {{"standards", {"A"}}}, "/standards"},
        {&ordering, {{"intended", {1.0, 2.0}}}, "/intended"},
        {&ordering, {{"goal", "least"}}, "/goal"},
        {&ordering, {{"standards", nullptr}}, "/standards"},
        {&ordering, {{"standards", {"A", "B"}}, {"intended", nullptr}}, "/answers/choices"},
        {&ordering, {{"texts", {{"en", {{"left", nullptr}}}}}}, "/texts/en/left"},
        {&adjustment, {{"texts", {{"en", {{"too_early", nullptr}}}}}}, "/texts/en/too_early"},
        {&fidelity, {{"standards", {"A"}}}, "/standards"},
        {&fidelity, {{"intended", {1.0, 2.0, 3.0}}}, "/intended"},
        {&fidelity, {{"texts", {{"en", {{"place", nullptr}}}}}}, "/texts/en/place"},
        {&fidelity, {{"answers", {{"choices", choices({"a", "b", "c"})}}}}, "/answers/choices"},
        {&adjustment, {{"standards", {"A", "B", "C"}}}, "/standards"},
        {&adjustment, {{"standards", {"A", "B"}}, {"goal", "least"}}, "/standards"},
        {&adjustment, {{"intended", {1.0, 2.0}}}, "/intended"},
        {&adjustment, {{"goal", "most"}}, "/goal"},
        {&adjustment, {{"goal", nullptr}}, "/goal"},
        {&adjustment, {{"smallest_ratio", 1.0}}, "/smallest_ratio"},
        {&adjustment, {{"smallest_ratio", nullptr}}, "/smallest_ratio"},
        {&adjustment, {{"largest_ratio", 1.0}}, "/largest_ratio"},
        {&adjustment, {{"step_db", 0.0}}, "/step_db"},
        {&adjustment, {{"step_db", "1dB"}}, "/step_db"},
        {&adjustment, {{"answers", {{"choices", choices({"a", "b"})}}}}, "/answers/choices"}}) {
    const auto refused = read(*body, change);
    ASSERT_FALSE(refused) << change;
    EXPECT_EQ(refused.error().kind, ErrorKind::malformed) << change;
    EXPECT_TRUE(refused.error().where.ends_with(std::string("odd.protocol.json#") + place))
        << refused.error().where;
  }
}

TEST_F(ProtocolFile, AnIdentificationReadsBackAndEachFaultHasItsPlace) {
  const auto read = [&](const nlohmann::json& change) {
    PendingFiles pending;
    EXPECT_TRUE(pending.write(folder_ / "odd.protocol.json", identification(body_, change).dump()));
    EXPECT_TRUE(pending.commit());
    return read_protocol(folder_ / "odd");
  };
  const auto protocol = read(nlohmann::json::object());
  ASSERT_TRUE(protocol) << message(protocol.error());
  EXPECT_EQ(nlohmann::json::parse(protocol_text(*protocol).value()),
            identification(body_, nlohmann::json::object()));
  for (const auto& [change, place] : {std::pair{R"({"standards": ["A", "A"]})", "/standards"},
                                      {R"({"comparisons": ["C"]})", "/comparisons/0"},
                                      {R"({"comparisons": ["B", "B"]})", "/comparisons/1"},
                                      {R"({"standards": ["A", "B", "C"]})", "/answers/choices"},
                                      {R"({"standards": ["B", "A"]})", "/answers/choices/0/word"},
                                      {R"({"conditions": ["real", "real"]})", "/conditions"},
                                      {R"({"longest_s": null})", "/longest_s"},
                                      {R"({"texts": {"en": {"place": null}}})", "/texts/en/place"},
                                      {R"({"levels": [0.5, 0.7]})", "/levels"}}) {
    const auto refused = read(nlohmann::json::parse(change));
    ASSERT_FALSE(refused) << change;
    EXPECT_EQ(refused.error().kind, ErrorKind::malformed) << change;
    EXPECT_TRUE(refused.error().where.ends_with(std::string("odd.protocol.json#") + place))
        << refused.error().where;
  }
}

TEST_F(ProtocolFile, AKeyWithACodeTwiceIsRefused) {
  const std::string sum(64, 'a');
  PendingFiles pending;
  for (const auto& [name, code, stretch] :
       {std::tuple{"good", "K2", 0.5}, std::tuple{"code", "K1", 0.5}, std::tuple{"stretch", "K2", 0.0}}) {
    const auto text = protocol_key_text({{{"K1", 0.0, "", sum}, {code, stretch, "", sum}}, ""});
    ASSERT_TRUE(text) << message(text.error());
    ASSERT_TRUE(pending.write(folder_ / (std::string(name) + ".key.json"), *text));
  }
  ASSERT_TRUE(pending.commit());
  const auto good = read_protocol_key(folder_ / "good.key.json");
  ASSERT_TRUE(good) << message(good.error());
  EXPECT_EQ(good->stimuli.at(1).stretch, 0.5);
  for (const char* name : {"code", "stretch"}) {
    const auto refused = read_protocol_key(folder_ / (std::string(name) + ".key.json"));
    ASSERT_FALSE(refused) << name;
    EXPECT_TRUE(refused.error().where.ends_with("#/stimuli/1")) << refused.error().where;
  }
}

}  // namespace
}  // namespace tacto::schema
