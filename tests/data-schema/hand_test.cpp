// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/device/hand.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>

#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

class HandFile : public testing::Test {
 protected:
  Error error_of(const std::string& member, const nlohmann::json& value) {
    nlohmann::json body = body_;
    body[member] = value;
    if (value.is_null()) body.erase(member);
    write_text("odd", body);
    const auto refused = read_hand(folder_ / "odd");
    EXPECT_FALSE(refused) << body;
    return refused ? Error{} : refused.error();
  }
  void write_text(const std::string& stem, const nlohmann::json& body) {
    PendingFiles pending;
    ASSERT_TRUE(pending.write(folder_ / (stem + ".hand.json"), body.dump()));
    ASSERT_TRUE(pending.commit());
  }

  tests::TemporaryFolder folder_;
  const nlohmann::json body_ = {{"kind", "hand"},      {"version", "1.0"},       {"name", "mine"},
                                {"mass_kg", 0.8},      {"damping_n_s_per_m", 3}, {"stiffness_n_per_m", 400},
                                {"source", "measured"}};
};

// The paper's damping by direction, and 400 N/m and 0.8 kg for both.
TEST_F(HandFile, PresetsHaveThePapersValues) {
  EXPECT_EQ(hand_preset_names(), (std::vector<std::string_view>{"minsky-radial", "minsky-tangential"}));
  for (const auto& [name, damping] :
       {std::pair{"minsky-tangential", 3.0}, std::pair{"minsky-radial", 10.0}}) {
    const auto hand = read_hand(name);
    ASSERT_TRUE(hand) << message(hand.error());
    EXPECT_EQ(hand->name, name);
    EXPECT_EQ(hand->damping_n_s_per_m, damping);
    EXPECT_EQ(hand->stiffness_n_per_m, 400);
    EXPECT_EQ(hand->mass_kg, 0.8);
    EXPECT_NE(hand->source.find("Minsky"), std::string::npos);
    EXPECT_EQ(stored_files(name).value().front().kind, FileKind::hand);
    EXPECT_TRUE(check_file({FileKind::hand, name})->findings.empty());
  }
}

TEST_F(HandFile, ReadsBackToTheBit) {
  const Hand hand = {"mine", 0.8 / 3, 1.0 / 3, 1000.0 / 7, "measured", "a note", "", ""};
  ASSERT_TRUE(write_hand(folder_ / "mine", hand));
  for (const char* name : {"mine", "mine.hand", "mine.hand.json"}) {
    const auto read = read_hand(folder_ / name);
    ASSERT_TRUE(read) << message(read.error());
    EXPECT_EQ(std::tie(read->name, read->mass_kg, read->damping_n_s_per_m, read->stiffness_n_per_m,
                       read->source, read->notes),
              std::tie(hand.name, hand.mass_kg, hand.damping_n_s_per_m, hand.stiffness_n_per_m, hand.source,
                       hand.notes));
  }
  EXPECT_EQ(stored_files(folder_ / "mine").value().front().kind, FileKind::hand);
}

TEST_F(HandFile, NumbersThatNoHandHasAreRefusedWithValueAndRange) {
  for (const auto& [member, value, words] :
       {std::tuple{"mass_kg", 800.0, "mass_kg is 800: a plausible value is from 0.0001 to 50"},
        std::tuple{"damping_n_s_per_m", 1e5, "damping_n_s_per_m is 100000: a plausible value is from 0.001"},
        std::tuple{"stiffness_n_per_m", 1e-3, "stiffness_n_per_m is 0.001: a plausible value is from 0.1"}}) {
    const Error error = error_of(member, value);
    EXPECT_EQ(error.kind, ErrorKind::unsuitable);
    EXPECT_TRUE(error.where.ends_with(std::string("odd.hand.json#/") + member)) << error.where;
    EXPECT_NE(error.what.find(words), std::string::npos) << error.what;
    const auto found = check_file({FileKind::hand, folder_ / "odd.hand.json"});
    EXPECT_EQ(found->findings.at(0).where, error.where);
  }
}

TEST_F(HandFile, FaultsOfFormAreRefused) {
  EXPECT_TRUE(error_of("source", nullptr).what.find("'source'") != std::string::npos);
  EXPECT_TRUE(error_of("source", "").where.ends_with("#/source"));
  EXPECT_TRUE(error_of("mass_kg", 0).where.ends_with("#/mass_kg"));
  EXPECT_TRUE(error_of("stiffness_n_per_m", "soft").where.ends_with("#/stiffness_n_per_m"));
  EXPECT_EQ(error_of("mas_kg", 1).remedy, "did you mean 'mass_kg'?");
  EXPECT_EQ(error_of("version", "3.1").kind, ErrorKind::unsupported_version);
  const auto missing = read_hand(folder_ / "none");
  EXPECT_EQ(missing.error().kind, ErrorKind::not_found);
  EXPECT_NE(missing.error().remedy.find("minsky-tangential"), std::string::npos);
}

TEST_F(HandFile, NeitherNanNorAHandWithoutASourceIsWritten) {
  Hand hand = {"mine", std::numeric_limits<double>::quiet_NaN(), 3, 400, "measured", "", "", ""};
  EXPECT_TRUE(write_hand(folder_ / "x", hand).error().where.ends_with("x.hand.json#/mass_kg"));
  hand.mass_kg = 0.8;
  hand.source = "";
  EXPECT_EQ(write_hand(folder_ / "x", hand).error().kind, ErrorKind::unsuitable);
  EXPECT_FALSE(is_file(folder_ / "x.hand.json"));
}

TEST_F(HandFile, ANewerMinorVersionIsReadAndItsMembersAreKept) {
  nlohmann::json body = body_;
  body["version"] = "1.4";
  body["muscle"] = {{"gain", 2}};
  write_text("newer", body);
  const auto newer = read_hand(folder_ / "newer");
  ASSERT_TRUE(newer) << message(newer.error());
  EXPECT_EQ(newer->newer_version, "1.4");
  ASSERT_TRUE(write_hand(folder_ / "again", *newer));
  EXPECT_EQ(nlohmann::json::parse(read_file(folder_ / "again.hand.json").value()), body);
}

}  // namespace
}  // namespace tacto::schema
