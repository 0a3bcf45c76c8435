// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/session/session_blocks.hpp"
#include "data-schema/session/session_reader.hpp"
#include "data-schema/session/session_writer.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

SessionHeader made_header() {
  SessionHeader header;
  header.created = "2026-01-02T03:04:05Z";
  header.creator = "test";
  header.build = "none";
  header.rate_hz = 10e3;
  header.clock_hz = 1e6;
  header.metres_per_count = 1e-6;
  header.device_uri = "sim:";
  header.device_protocol = "1.0";
  header.transducer = read_transducer("wiertlewski2011").value();
  header.textures = {{"oak.texture.json", std::string(64, 'a'), 0.01, 1e-3, TextureEnds::loop, 0}};
  header.inverse = "full";
  header.delay_s = 1.5e-3;
  return header;
}

std::vector<SessionTick> made_ticks(std::uint64_t first, std::size_t count) {
  std::vector<SessionTick> ticks(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t n = first + i;
    ticks[i] = {n,
                static_cast<std::int64_t>(n * 100'000 + n % 7),
                static_cast<std::int32_t>(n) - 5,
                0.001F * static_cast<float>(n),
                static_cast<std::uint32_t>(n % 64),
                static_cast<std::int32_t>(n % 1000) - 10};
  }
  return ticks;
}

std::vector<SessionTick> ticks_in(SessionReader& reader) {
  std::vector<SessionTick> all;
  while (auto block = reader.next())
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block))
      all.insert(all.end(), ticks->begin(), ticks->end());
  return all;
}

class Session : public testing::Test {
 protected:
  SessionWriter created() { return std::move(*SessionWriter::create(path_, made_header())); }
  void write_whole() {
    auto writer = created();
    ASSERT_TRUE(writer.add(SessionCommand{0, 5, {1, 2, 3}}));
    ASSERT_TRUE(writer.add(made_ticks(0, 10000)));
    ASSERT_TRUE(writer.add(SessionLoss{10000, 7, SessionLoss::Why::recorder}));
    ASSERT_TRUE(writer.add(SessionEvent{10000, 99, "fault: encoder_jump"}));
    ASSERT_TRUE(writer.add(made_ticks(10007, 3)));
    ASSERT_TRUE(writer.close({10003, 7, 0}));
  }
  tests::TemporaryFolder folder_;
  std::string path_ = folder_ / "one.session";
};

TEST(SessionHeaderText, ALoopNamesItsSeam) {
  std::string text = *session_header_text(made_header());
  const std::string seam = "\"seam_m\"";
  ASSERT_NE(text.find(seam), std::string::npos) << text;
  text.replace(text.find(seam), seam.size(), "\"other\"");
  const auto header = parse_session_header(text, "session");
  ASSERT_FALSE(header);
  EXPECT_EQ(header.error().kind, ErrorKind::malformed);
  EXPECT_EQ(header.error().where, "session#/textures/0");
}

TEST_F(Session, ReadsBackToTheBit) {
  write_whole();
  auto reader = SessionReader::open(folder_ / "one");
  ASSERT_TRUE(reader) << message(reader.error());
  EXPECT_EQ(reader->header().textures[0].ends, TextureEnds::loop);
  EXPECT_EQ(reader->header().textures[0].seam_m, 0);
  EXPECT_EQ(reader->header().transducer.mass_kg, 6.8e-3);
  EXPECT_EQ(reader->header().delay_s, 1.5e-3);
  auto expected = made_ticks(0, 10000);
  const auto tail = made_ticks(10007, 3);
  expected.insert(expected.end(), tail.begin(), tail.end());
  EXPECT_EQ(ticks_in(*reader), expected);
  EXPECT_EQ(reader->ending(), SessionEnding::closed);
  auto again = SessionReader::open(path_);
  const SessionTotals totals = session_totals(*again);
  EXPECT_EQ(totals.ticks, 10003U);
  EXPECT_EQ(totals.lost_ticks, 7U);
  EXPECT_EQ(totals.commands, 1U);
  ASSERT_EQ(totals.events.size(), 1U);
  EXPECT_EQ(totals.events[0].text, "fault: encoder_jump");
  ASSERT_TRUE(check_file({FileKind::session, path_}));
  EXPECT_TRUE(check_file({FileKind::session, path_})->findings.empty());
}

TEST(SessionHeaderText, NamesTheTraysSensorWhereThereIsOne) {
  SessionHeader header = made_header();
  EXPECT_FALSE(parse_session_header(*session_header_text(header), "session")->sensor);
  header.sensor = SessionSensor{"displacement", "vibrometer", "2026-01-02", 10e3, 6e-9, 1e-6};
  const auto text = session_header_text(header);
  ASSERT_TRUE(text) << message(text.error());
  const auto read = parse_session_header(*text, "session");
  ASSERT_TRUE(read && read->sensor);
  EXPECT_EQ(read->newer_version, "");
  EXPECT_EQ(read->sensor->source, "vibrometer");
  EXPECT_EQ(read->sensor->rate_hz, 10e3);
  EXPECT_EQ(read->sensor->scale, 6e-9);
  EXPECT_EQ(read->sensor->offset, 1e-6);
}

TEST_F(Session, KeepsMeasuredSamplesToTheBit) {
  SessionHeader header = made_header();
  header.sensor = SessionSensor{"displacement", "", "", 10e3, 6e-9, 0};
  const std::vector<SessionSamples> written = {{5, 1'000'000, {1, -2, INT32_MAX}},
                                               {9, 1'400'000, {INT32_MIN}}};
  {
    auto writer = std::move(*SessionWriter::create(path_, header));
    for (const SessionSamples& samples : written) ASSERT_TRUE(writer.add(samples));
    ASSERT_TRUE(writer.add(made_ticks(0, 10)));
    ASSERT_TRUE(writer.close({10, 0, 0}));
  }
  auto reader = SessionReader::open(path_);
  std::vector<SessionSamples> read;
  while (auto block = reader->next())
    if (const auto* samples = std::get_if<SessionSamples>(&*block)) read.push_back(*samples);
  EXPECT_EQ(read, written);
  auto again = SessionReader::open(path_);
  const SessionTotals totals = session_totals(*again);
  EXPECT_EQ(totals.samples, 4U);
  EXPECT_EQ(totals.lost_samples, 1U);
  EXPECT_TRUE(check_file({FileKind::session, path_})->findings.empty());
}

TEST_F(Session, FindsSamplesThatNoHeaderDescribesOrThatGoBack) {
  auto writer = created();
  ASSERT_TRUE(writer.add(SessionSamples{5, 0, {1, 2}}));
  ASSERT_TRUE(writer.add(SessionSamples{6, 0, {3}}));
  EXPECT_EQ(check_file({FileKind::session, path_})->findings.size(), 2U);
}

TEST_F(Session, OfManyEventsTheFirstAndTheLastAreKept) {
  auto writer = created();
  for (std::uint64_t i = 0; i < 1600; ++i) ASSERT_TRUE(writer.add(SessionEvent{i, 0, std::to_string(i)}));
  auto reader = SessionReader::open(path_);
  const SessionTotals totals = session_totals(*reader);
  EXPECT_EQ(totals.event_count, 1600U);
  ASSERT_EQ(totals.events.size(), 1000U);
  EXPECT_EQ(totals.events[499].text, "499");
  EXPECT_EQ(totals.events[500].text, "1100");
  EXPECT_EQ(totals.events.back().text, "1599");
}

TEST_F(Session, IsNeverWrittenOverAnother) {
  write_whole();
  const auto second = SessionWriter::create(path_, made_header());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::usage);
}

// For a cut at any place, exactly the complete blocks are read.
TEST_F(Session, CutAnywhereGivesItsWholeBlocks) {
  {
    auto writer = created();
    for (std::uint64_t i = 0; i < 20; ++i) ASSERT_TRUE(writer.add(made_ticks(10 * i, 10)));
  }
  const auto size = std::filesystem::file_size(path_);
  const std::size_t block = 20 + 20 + 200;
  for (std::size_t cut = 0; cut < 3 * block; cut += 17) {
    std::filesystem::resize_file(path_, size - cut);
    auto reader = SessionReader::open(path_);
    ASSERT_TRUE(reader);
    EXPECT_EQ(ticks_in(*reader), made_ticks(0, 10 * (20 - (cut + block - 1) / block)));
    EXPECT_EQ(reader->ending(), cut % block == 0 ? SessionEnding::unclosed : SessionEnding::damaged);
  }
}

TEST_F(Session, AFlippedBitEndsTheReadingBeforeItsBlock) {
  write_whole();
  std::string bytes = read_file(path_).value();
  const auto sound = std::filesystem::file_size(path_);
  bytes[bytes.size() - 100] = static_cast<char>(bytes[bytes.size() - 100] ^ 4);
  std::ofstream(path_, std::ios::binary) << bytes;
  ASSERT_EQ(std::filesystem::file_size(path_), sound);
  auto reader = SessionReader::open(path_);
  EXPECT_EQ(ticks_in(*reader), made_ticks(0, 10000));
  EXPECT_EQ(reader->ending(), SessionEnding::damaged);
  const auto checked = check_file({FileKind::session, path_});
  ASSERT_EQ(checked->findings.size(), 1U);
  EXPECT_NE(checked->findings[0].where.find("byte "), std::string::npos);
}

TEST_F(Session, AKilledWriterLosesNothingThatWasSynced) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto writer = SessionWriter::create(path_, made_header());
    const bool done = writer && writer->add(made_ticks(0, 5000)) && writer->sync();
    [[maybe_unused]] const auto told = ::write(ready[1], done ? "y" : "n", 1);
    for (;;) pause();
  }
  char word = 0;
  ASSERT_EQ(read(ready[0], &word, 1), 1);
  EXPECT_EQ(word, 'y');
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  auto reader = SessionReader::open(path_);
  ASSERT_TRUE(reader);
  EXPECT_EQ(ticks_in(*reader), made_ticks(0, 5000));
  EXPECT_EQ(reader->ending(), SessionEnding::unclosed);
}

// A limit of the file size simulates a full disk: both cut a write short.
TEST_F(Session, AFullDiskLeavesWholeBlocksAndLaterOnesAreTaken) {
  auto writer = created();
  ASSERT_TRUE(writer.add(made_ticks(0, 100)));
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  rlimit tight = before;
  tight.rlim_cur = std::filesystem::file_size(path_) + 1000;
  setrlimit(RLIMIT_FSIZE, &tight);
  const auto failed = writer.add(made_ticks(100, 100));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, ErrorKind::cannot_write);
  ASSERT_TRUE(writer.add(SessionLoss{100, 100, SessionLoss::Why::disk}));
  ASSERT_TRUE(writer.add(made_ticks(200, 10)));
  ASSERT_TRUE(writer.close({110, 100, 0}));
  auto reader = SessionReader::open(path_);
  const SessionTotals totals = session_totals(*reader);
  EXPECT_EQ(totals.ending, SessionEnding::closed);
  EXPECT_EQ(totals.ticks, 110U);
  EXPECT_EQ(totals.lost_ticks, 100U);
}

TEST_F(Session, AHeaderWithNumbersThatCanNotBeIsNone) {
  const auto refused = [](auto change, const std::string& field) {
    SessionHeader header = made_header();
    change(header);
    const auto text = session_header_text(header);
    const auto parsed = text ? parse_session_header(*text, "one") : forward_error(text);
    ASSERT_FALSE(parsed) << field;
    EXPECT_EQ(parsed.error().kind, text ? ErrorKind::malformed : ErrorKind::unsuitable);
    EXPECT_NE(parsed.error().where.find(field), std::string::npos) << parsed.error().where;
  };
  for (const double metres : {0.0, 1e30, -1e-6})
    refused([=](SessionHeader& h) { h.metres_per_count = metres; }, "metres_per_count");
  refused([](SessionHeader& h) { h.transducer.mass_kg = -1; }, "transducer/mass_kg");
  EXPECT_TRUE(parse_session_header(session_header_text(made_header()).value(), "one"));
}

SessionChange made_change(const std::string& file) {
  SessionChange change{17, 18, made_header()};
  change.program.textures[0].file = file;
  change.program.scene_file = "two.scene.json";
  change.program.scene_sha256 = std::string(64, 'b');
  change.program.choices.interpolation = "sinc";
  change.program.high_hz = 400;
  return change;
}

SessionCommand change_command() {
  return {20, 21, {0, 0, 0, 0x17}};
}

// Two textures without a `change` between them: the first had no effect. The same applies to one at the end.
TEST_F(Session, AChangeNamesWhatTheNextOneBrings) {
  auto writer = created();
  for (const char* file : {"failed.texture.json", "pine.texture.json"})
    ASSERT_TRUE(writer.add(made_change(file)));
  ASSERT_TRUE(writer.add(change_command()));
  ASSERT_TRUE(writer.add(made_ticks(0, 10)));
  ASSERT_TRUE(writer.add(made_change("never.texture.json")));
  ASSERT_TRUE(writer.close({10, 0, 0}));
  auto reader = SessionReader::open(path_);
  const SessionTotals totals = session_totals(*reader);
  EXPECT_EQ(totals.ending, SessionEnding::closed);
  ASSERT_EQ(totals.changes.size(), 1U);
  EXPECT_EQ(totals.changes[0].not_before, 17U);
  EXPECT_EQ(totals.changes[0].time_ns, 18);
  const SessionProgram& program = totals.changes[0].program;
  ASSERT_EQ(program.textures.size(), 1U);
  EXPECT_EQ(program.textures[0].file, "pine.texture.json");
  EXPECT_EQ(program.textures[0].ends, TextureEnds::loop);
  EXPECT_EQ(program.scene_sha256, std::string(64, 'b'));
  EXPECT_EQ(program.choices.interpolation, "sinc");
  EXPECT_EQ(program.inverse, "full");
  EXPECT_EQ(program.high_hz, 400);
  EXPECT_TRUE(check_file({FileKind::session, path_})->findings.empty());
}

void append_block(const std::string& path, std::uint8_t type, const std::string& payload) {
  std::ofstream(path, std::ios::binary | std::ios::app)
      << sealed_block(static_cast<BlockType>(type), payload);
}

TEST_F(Session, ATypeThatIsNotKnownIsPassedOver) {
  { ASSERT_TRUE(created().add(made_ticks(0, 10))); }
  append_block(path_, 99, "of a version to come");
  append_block(path_, 1, ticks_payload(made_ticks(10, 5)));
  auto reader = SessionReader::open(path_);
  EXPECT_EQ(ticks_in(*reader), made_ticks(0, 15));
  EXPECT_EQ(reader->ending(), SessionEnding::unclosed);
}

TEST_F(Session, AChangeThatIsNoneIsDamage) {
  const std::string moment(16, '\0');
  for (const std::string& text :
       {std::string("short"), moment, moment + "{",
        moment + R"({"kind": "session_change", "version": "1.0"})", moment + std::string(1000, '[')}) {
    std::filesystem::remove(path_);
    { ASSERT_TRUE(created().add(made_ticks(0, 10))); }
    const auto sound = std::filesystem::file_size(path_);
    append_block(path_, 6, text);
    append_block(path_, 1, ticks_payload(made_ticks(10, 5)));
    auto reader = SessionReader::open(path_);
    EXPECT_EQ(ticks_in(*reader), made_ticks(0, 10));
    EXPECT_EQ(reader->ending(), SessionEnding::damaged);
    const auto checked = check_file({FileKind::session, path_});
    ASSERT_EQ(checked->findings.size(), 1U);
    EXPECT_NE(checked->findings[0].what.find("block"), std::string::npos) << sound;
  }
}

TEST_F(Session, MoreTexturesThanABlockHoldsAreRefused) {
  SessionChange change = made_change("oak.texture.json");
  change.program.textures.resize(300, change.program.textures[0]);
  for (SessionTexture& texture : change.program.textures) texture.file = std::string(4000, 'a');
  auto writer = created();
  const auto large = writer.add(change);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().kind, ErrorKind::unsuitable);
  SessionHeader header = made_header();
  header.textures = change.program.textures;
  const auto refused = SessionWriter::create(folder_ / "large.session", header);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::unsuitable);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "large.session"));
}

TEST_F(Session, NoHeaderIsNoSession) {
  std::ofstream(path_) << "nothing of the kind";
  const auto reader = SessionReader::open(path_);
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().kind, ErrorKind::malformed);
}

}  // namespace
}  // namespace tacto::schema
