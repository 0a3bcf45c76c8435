// SPDX-License-Identifier: GPL-3.0-or-later
// Documents: the messages about broken ones, and the handling of newer versions.
#include "data-schema/json/json_document.hpp"
#include "data-schema/files/embedded_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "data-schema/json/json_schema.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {
namespace {

Json channel() {
  return {
      {"name", "force"}, {"quantity", "tangential_force"}, {"unit", "N"}, {"scale", 2.5}, {"offset", 0.0}};
}

Json sound_recording() {
  Json document = {{"kind", "recording"}, {"version", "1.0"}};
  document["data"] = {
      {"file", "a.wav"}, {"sha256", std::string(64, '0')}, {"format", "pcm32"}, {"frames", 3}};
  document["sample_rate_hz"] = 1000.0;
  document["channels"] = Json::array({channel()});
  return document;
}

Error error_in_text(std::string_view text) {
  const auto document = parse_document(text, "a.json", "recording");
  EXPECT_FALSE(document);
  return document ? Error{} : document.error();
}
Error error_of(const Json& document) {
  return error_in_text(document.dump());
}

TEST(Document, ReadsASoundOne) {
  const auto document = parse_document(sound_recording().dump(), "a.json", "recording");
  ASSERT_TRUE(document) << message(document.error());
  EXPECT_EQ(document->newer_version, "");
}

TEST(Document, SaysLineAndColumnOfWhatIsNotJson) {
  const Error error = error_in_text("{\n  \"kind\": \"recording\",\n  oops\n}");
  EXPECT_EQ(error.kind, ErrorKind::malformed);
  EXPECT_EQ(error.where, "a.json, line 3, column 3");
  EXPECT_NE(error_in_text("").what.find("not JSON"), std::string::npos);
  EXPECT_NE(error_in_text("{\"kind\": 1e999}").what.find("1e999"), std::string::npos);
  EXPECT_NE(error_in_text("{\"kind\": NaN}").what.find("not JSON"), std::string::npos);
  EXPECT_EQ(error_in_text(std::string(100000, '[')).kind, ErrorKind::malformed);
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  EXPECT_EQ(error_in_text("{\"a\": " + deep + "}").what, "the JSON is nested too deeply");
}

TEST(Document, AMemberThatAppearsTwiceIsRefusedWithItsPlace) {
  const Error top = error_in_text(R"({"kind":"recording","version":"1.0","kind":"recording"})");
  EXPECT_EQ(top.kind, ErrorKind::malformed);
  EXPECT_NE(top.what.find("'kind'"), std::string::npos);
  EXPECT_EQ(top.where, "a.json");
  const Error deep =
      error_in_text(R"({"kind":"recording","channels":[{"unit":"N"},[7],{"a/b":{"unit":1,"unit":1}}]})");
  EXPECT_NE(deep.what.find("'unit'"), std::string::npos);
  EXPECT_EQ(deep.where, "a.json#/channels/2/a~1b");
  EXPECT_FALSE(deep.remedy.empty());
  const std::string name(10000, 'n');
  EXPECT_LT(error_in_text("{\"" + name + "\":1,\"" + name + "\":2}").what.size(), 100U);
}

TEST(Document, AMemberOfEachOfTwoObjectsIsNoSecondOne) {
  EXPECT_EQ(error_in_text(R"({"a":{"x":1},"b":{"x":1},"c":[{"x":1},{"x":1}],"x":1})").what,
            "JSON without a `kind`: not a file of tactograph");
}

TEST(Document, SaysWhichKindItIsInstead) {
  Json document = sound_recording();
  document["kind"] = "texture";
  EXPECT_EQ(error_of(document).where, "a.json#/kind");
  EXPECT_EQ(error_in_text("[1, 2]").kind, ErrorKind::malformed);
}

TEST(Document, RefusesAnotherMajorVersionNamingBoth) {
  Json document = sound_recording();
  for (const char* version : {"2.0", "0.9"}) {
    document["version"] = version;
    const Error error = error_of(document);
    EXPECT_EQ(error.kind, ErrorKind::unsupported_version);
    EXPECT_NE(error.what.find(version), std::string::npos) << error.what;
    EXPECT_NE(error.what.find("1.x"), std::string::npos) << error.what;
  }
  for (const char* version : {"1", "1.", "1.0.0", "one", "-1.0x"}) {
    document["version"] = version;
    EXPECT_EQ(error_of(document).where, "a.json#/version") << version;
  }
}

TEST(Document, ReadsANewerMinorVersionAndKeepsItsMembers) {
  Json document = sound_recording();
  document["version"] = "1.7";
  document["aroma"] = {{"note", "resin"}, {"levels", {1, 2.5}}};
  const auto read = parse_document(document.dump(), "a.json", "recording");
  ASSERT_TRUE(read) << message(read.error());
  EXPECT_EQ(read->newer_version, "1.7");
  const std::string& extra = read->extra_json;
  EXPECT_EQ(Json::parse(extra), Json({{"aroma", document["aroma"]}}));
  Json body = sound_recording();
  body.erase("kind");
  body.erase("version");
  const auto text = document_text("recording", body, extra);
  ASSERT_TRUE(text) << message(text.error());
  EXPECT_EQ(Json::parse(*text)["aroma"], document["aroma"]);
  EXPECT_EQ(text->rfind("{\n  \"kind\": \"recording\",\n  \"version\": \"1.0\",\n", 0), 0U);
  EXPECT_TRUE(text->ends_with("}\n"));
}

struct Breach {
  const char* pointer;
  Json value;
  const char* what;
};

TEST(Document, NamesBreachesByPointer) {
  const Breach breaches[] = {
      {"/sample_rate_hz", 0, "greater than 0"},
      {"/sample_rate_hz", "fast", "\"fast\" is not of type number"},
      {"/channels", Json::array(), "no fewer than 1"},
      {"/channels/0/unit", "mN", "\"mN\" is not one of N, m, m/s, m/s^2, V, 1"},
      {"/channels/0/quantity", "taste", "is not one of tangential_force"},
      {"/channels/0/scale", nullptr, "null is not of type number"},
      {"/data/file", "../a.wav", "does not match"},
      {"/data/frames", -1, "greater than or equal to 0"},
      {"/humidity_percent", 101, "less than or equal to 100"},
      {"/gaps", Json::array({{{"frame", 1}, {"device_sequence", 1}}}), "'count'"},
  };
  for (const Breach& breach : breaches) {
    Json document = sound_recording();
    document[Json::json_pointer(breach.pointer)] = breach.value;
    const Error error = error_of(document);
    EXPECT_EQ(error.where.rfind(std::string("a.json#") + breach.pointer, 0), 0U) << message(error);
    EXPECT_NE(error.what.find(breach.what), std::string::npos) << message(error);
    EXPECT_EQ(error.kind, ErrorKind::malformed);
  }
}

TEST(Document, ListsEveryBreachOnce) {
  Json document = sound_recording();
  document["channels"][0].erase("scale");
  document["channels"].push_back(channel());
  document["channels"][1]["unit"] = "kg";
  document["sample_rate_hz"] = -1;
  const auto list = breaches(document, schema_of("recording").value());
  ASSERT_EQ(list.size(), 3U);
  std::vector<std::string> pointers;
  for (const Violation& each : list) pointers.push_back(each.pointer);
  EXPECT_EQ(std::ranges::count(pointers, "/channels/0"), 1);
  EXPECT_EQ(std::ranges::count(pointers, "/channels/1/unit"), 1);
  EXPECT_EQ(std::ranges::count(pointers, "/sample_rate_hz"), 1);
}

TEST(Document, ChecksAnEmbeddedTransducerByItsOwnSchema) {
  Json document = sound_recording();
  document["transducer"] = {{"kind", "transducer"}, {"version", "1.0"}, {"name", "bare"}};
  const Error error = error_of(document);
  EXPECT_EQ(error.where, "a.json#/transducer");
  EXPECT_NE(error.what.find("Missing required property"), std::string::npos) << error.what;
}

TEST(DocumentText, KeepsEveryBitOfADouble) {
  for (const double value : {0.1, 4.0 / 9, 1e-300, 5e-324, 1.7976931348623157e308, -0.0, 3.0}) {
    Json body = sound_recording();
    body["channels"][0]["offset"] = value;
    const auto text = document_text("recording", body, "");
    ASSERT_TRUE(text);
    const double back = Json::parse(*text)["channels"][0]["offset"];
    EXPECT_EQ(std::memcmp(&back, &value, sizeof back), 0) << value;
  }
}

TEST(DocumentText, RefusesWhatCantBeStored) {
  Json body = sound_recording();
  body["channels"][0]["offset"] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(document_text("recording", body, "").error().where, "/channels/0/offset");
  body["channels"][0]["offset"] = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(document_text("recording", body, "").error().kind, ErrorKind::unsuitable);
  body = sound_recording();
  body["notes"] = "caf\xE9";
  EXPECT_NE(document_text("recording", body, "").error().what.find("UTF-8"), std::string::npos);
  body = sound_recording();
  body["channels"][0]["unit"] = "kg";
  EXPECT_EQ(document_text("recording", body, "").error().where, "/channels/0/unit");
}

TEST(RecordingSchema, KnowsTheSameQuantitiesAndUnitsAsTheCode) {
  const Json rules = schema_of("recording").value();
  const Json& members = rules["properties"]["channels"]["items"]["properties"];
  Json names = Json::array();
  for (const QuantityName& quantity : quantity_names()) {
    names.push_back(quantity.name);
    const Json unit = si_symbol(quantity.dimension);
    EXPECT_EQ(std::ranges::count(members["unit"]["enum"], unit), 1) << quantity.name;
  }
  EXPECT_EQ(names, members["quantity"]["enum"]);
}

}  // namespace
}  // namespace tacto::schema
