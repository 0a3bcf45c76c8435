// SPDX-License-Identifier: GPL-3.0-or-later
// Members that no schema names: refused where they steer something, kept elsewhere; x_... is free everywhere.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "data-schema/base/unknown_note.hpp"
#include "data-schema/check/check.hpp"
#include "data-schema/control/control.hpp"
#include "data-schema/control/daemon_config.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/results/results.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

using Body = nlohmann::json;
using Pointer = Body::json_pointer;

class UnknownMembers : public testing::Test {
 protected:
  Body body_of(const std::string& file) { return Body::parse(read_file(folder_ / file).value()); }
  void write(const std::string& file, const Body& body) { std::ofstream(folder_ / file) << body; }
  Body with(Body body, const char* pointer) {
    body[Pointer(pointer)] = 1;
    return body;
  }

  tests::TemporaryFolder folder_;
};

// One kind that steers something: a correct body, and how it is read.
struct Steering {
  const char* file;
  std::function<std::optional<Error>(const std::string& path)> error;
  Body body;
};

template <class Read>
auto error_by(Read read) {
  return [read](const std::string& path) -> std::optional<Error> {
    const auto value = read(path);
    return value ? std::nullopt : std::optional(value.error());
  };
}

Steering scene_kind() {
  return {"a.scene.json", error_by([](const std::string& path) { return read_scene(path); }),
          Body::parse(R"({"kind":"scene","version":"1.0","playback":{"inverse":"gain"},
                          "layers":[{"type":"texture","texture":"oak","at_m":0,"gain_m_per_n":0.001}]})")};
}

Steering daemon_kind() {
  return {"a.json", error_by([](const std::string& path) { return read_daemon_config(path); }),
          Body::parse(R"({"kind":"daemon","version":"1.0","device":"sim:","transducer":"t","socket":"s",
                          "sessions":"f","playback":{"inverse":"gain"}})")};
}

TEST_F(UnknownMembers, AreRefusedByPlaceAndNearestNameWhereTheySteer) {
  ASSERT_TRUE(write_device(folder_ / "a", read_device("sandpaper-1990").value()));
  ASSERT_TRUE(write_hand(folder_ / "a", read_hand("minsky-radial").value()));
  Transducer transducer = read_transducer("wiertlewski2011").value();
  transducer.hysteresis = Hysteresis{{0, 0.5}, {0.9, 0.1}};
  ASSERT_TRUE(write_transducer(folder_ / "a", transducer));
  const Steering device{"a.device.json", error_by([](const std::string& p) { return read_device(p); }),
                        body_of("a.device.json")};
  const Steering hand{"a.hand.json", error_by([](const std::string& p) { return read_hand(p); }),
                      body_of("a.hand.json")};
  const Steering bender{"a.transducer.json",
                        error_by([](const std::string& p) { return read_transducer(p); }),
                        body_of("a.transducer.json")};
  struct Case {
    Steering kind;
    const char *pointer, *nearest, *free;
  };
  for (const Case& each :
       {Case{scene_kind(), "/note", "notes", "/x_light"},
        Case{scene_kind(), "/layers/0/end", "ends", "/layers/0/x_colour"},
        Case{scene_kind(), "/playback/energy_rms", "energy_rms_v", "/playback/x_why"},
        Case{daemon_kind(), "/dead_man", "dead_man_s", "/x_room"},
        Case{daemon_kind(), "/playback/contact_on", "contact_on_n", "/playback/x_why"},
        Case{device, "/note", "notes", "/x_room"},
        Case{device, "/axes/1/mas_kg", "mass_kg", "/axes/1/x_serial"}, Case{hand, "/note", "notes", "/x_age"},
        Case{bender, "/orgin", "origin", "/x_room"},
        Case{bender, "/hysteresis/weight", "weights", "/hysteresis/x_fit"}}) {
    const std::string path = folder_ / each.kind.file;
    write(each.kind.file, with(each.kind.body, each.pointer));
    const auto error = each.kind.error(path);
    ASSERT_TRUE(error) << path << each.pointer;
    EXPECT_EQ(error->kind, ErrorKind::malformed);
    EXPECT_EQ(error->where, path + "#" + each.pointer) << message(*error);
    EXPECT_NE(error->remedy.find(std::string("'") + each.nearest + "'"), std::string::npos)
        << message(*error);
    write(each.kind.file, with(each.kind.body, each.free));
    EXPECT_FALSE(each.kind.error(path)) << path << each.free;
  }
}

TEST_F(UnknownMembers, ARequestIsRefused) {
  struct Case {
    const char *line, *where, *nearest;
  };
  for (const Case& each :
       {Case{R"({"request":"load","file":"C1","gain_m_per_N":1e-5})", "gain_m_per_N", "'gain_m_per_n'"},
        Case{R"({"request":"arm","while_conected":true})", "while_conected", "'while_connected'"},
        Case{R"({"request":"status","gian":1})", "gian", "'gain'"},
        Case{R"({"request":"stop","colour":"red"})", "colour", "request"},
        Case{R"({"request":"load","file":"a","playback":{"a/b":1}})", "playback/a~1b", "hold"}}) {
    std::string id;
    const auto request = parse_control_request(each.line, &id);
    ASSERT_FALSE(request) << each.line;
    EXPECT_EQ(request.error().kind, ErrorKind::malformed);
    EXPECT_EQ(request.error().where, std::string("request#/") + each.where);
    EXPECT_NE(request.error().remedy.find(each.nearest), std::string::npos) << message(request.error());
  }
  EXPECT_TRUE(parse_control_request(R"({"request":"status","x_trial":7})"));
  EXPECT_TRUE(parse_control_request(R"({"request":"load","file":"a","playback":{"x_why":"b"}})"));
  // The error does not repeat a long name.
  const auto longest = parse_control_request(R"({"request":"stop","n)" + std::string(9000, 'n') + R"(":1})");
  ASSERT_FALSE(longest);
  EXPECT_LT(message(longest.error()).size(), 500U);
}

TEST_F(UnknownMembers, FreeOnesOfASceneAreWrittenAgain) {
  Body body = with(with(scene_kind().body, "/x_light"), "/layers/0/x_colour");
  body["playback"]["x_why"] = {{"a", 1}};
  body["patches"] = Body::parse(R"([{"name":"a","place":{"x_m":0,"y_m":0,"x_z_m":2},
    "size":{"width_m":0.1,"height_m":0.1},"x_note":[1],
    "layers":[{"type":"spring","stiffness_n_per_m":100,"x_from":"lab"}]}])");
  write("a.scene.json", body);
  const auto scene = read_scene(folder_ / "a");
  ASSERT_TRUE(scene) << message(scene.error());
  EXPECT_EQ(unknown_note("a", *scene), "");
  ASSERT_TRUE(write_scene(folder_ / "b", *scene));
  const Body again = body_of("b.scene.json");
  for (const char* free : {"/x_light", "/layers/0/x_colour", "/playback/x_why", "/patches/0/place/x_z_m",
                           "/patches/0/x_note", "/patches/0/layers/0/x_from"})
    EXPECT_EQ(again.value(Pointer(free), Body()), body.at(Pointer(free))) << free;
}

TEST_F(UnknownMembers, OfARecordingAreNamedAndKept) {
  RecordingHeader header;
  header.sample_rate_hz = 1000;
  header.channels.resize(1);
  header.channels[0].name = header.channels[0].quantity = "tangential_force";
  header.channels[0].unit = "N";
  auto writer = RecordingWriter::create(folder_ / "oak", header, true);
  ASSERT_TRUE(writer && writer->write(std::vector<double>{1, 2}) && writer->close());
  Body body = body_of("oak.json");
  for (const char* pointer : {"/channels/0/colour", "/channels/0/x_serial", "/surfase", "/x_room"})
    body[Pointer(pointer)] = 1;
  body["data"].erase("numbers_sha256");  // it would cover colour, which is in a covered member and not free
  write("oak.json", body);
  const auto oak = open_recording(folder_ / "oak");
  ASSERT_TRUE(oak) << message(oak.error());
  EXPECT_EQ(oak->header.unknown_members, (std::vector<std::string>{"channels/0/colour", "surfase"}));
  EXPECT_NE(unknown_note("oak", oak->header).find("channels/0/colour, surfase"), std::string::npos);
  EXPECT_EQ(check_file({FileKind::recording, folder_ / "oak.json"})->unknown_members,
            oak->header.unknown_members);
  auto copy = RecordingWriter::create(folder_ / "copy", oak->header, true);
  ASSERT_TRUE(copy && copy->write(std::vector<double>{1, 2}) && copy->close());
  const Body again = body_of("copy.json");
  for (const char* pointer : {"/channels/0/colour", "/channels/0/x_serial", "/surfase", "/x_room"})
    EXPECT_EQ(again.value(Pointer(pointer), 0), 1) << pointer;
}

TEST_F(UnknownMembers, OfAnObjectThatIsRemovedDoNotComeBack) {
  RecordingHeader header;
  header.sample_rate_hz = 1000;
  header.channels.resize(1);
  header.channels[0].name = header.channels[0].quantity = "tangential_force";
  header.channels[0].unit = "N";
  header.gaps = {{1, 3, 2}};
  header.extra_json = R"({"transducer":{"x_room":1},"gaps":[{"x_a":1},{"x_b":2}],"x_c":3})";
  auto writer = RecordingWriter::create(folder_ / "oak", header, true);
  ASSERT_TRUE(writer && writer->write(std::vector<double>{1, 2}));
  ASSERT_TRUE(writer->close());
  const Body body = body_of("oak.json");
  EXPECT_FALSE(body.contains("transducer"));
  EXPECT_EQ(body["gaps"].size(), 1U);
  EXPECT_EQ(body["gaps"][0]["x_a"], 1);
  EXPECT_EQ(body["x_c"], 3);
}

TEST_F(UnknownMembers, OfTexturesAndResultsAreNamedAndKept) {
  Texture texture;
  texture.signal = {1e-6, 0, std::vector<double>(100, 0.5)};
  ASSERT_TRUE(write_texture(folder_ / "oak", texture));
  write("oak.texture.json", with(with(body_of("oak.texture.json"), "/data/colour"), "/x_room"));
  const auto oak = read_texture(folder_ / "oak");
  ASSERT_TRUE(oak) << message(oak.error());
  EXPECT_EQ(oak->unknown_members, std::vector<std::string>{"data/colour"});
  ASSERT_TRUE(write_texture(folder_ / "copy", *oak));
  EXPECT_EQ(body_of("copy.texture.json")["data"]["colour"], 1);
  EXPECT_EQ(body_of("copy.texture.json")["x_room"], 1);

  write("a.results.json", Body::parse(R"({"kind":"results","version":"1.0","verb":"compare","inputs":[],
    "figures":[{"name":"n","value":"v","colour":1}],"pictures":[],"details":{"anything":1}})"));
  const auto results = read_results(folder_ / "a");
  ASSERT_TRUE(results) << message(results.error());
  EXPECT_EQ(results->unknown_members, std::vector<std::string>{"figures/0/colour"});
}

}  // namespace
}  // namespace tacto::schema
