// SPDX-License-Identifier: GPL-3.0-or-later
// Refusals of import: the fault, the message, and no files left.
#include <functional>

#include "tests/capture/import_fixture.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;

class ImportRefusals : public ImportTest {
 protected:
  ImportRequest good() const {
    auto made = request(folder_ / "t.csv", {"tangential_force=f*1N"});
    made.name = folder_ / "out";
    return made;
  }

  void refused(const ImportRequest& asked, ErrorKind fault, const std::string& says) const {
    const std::size_t before = folder_.files();
    const auto done = import(asked);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().kind, fault) << schema::message(done.error());
    EXPECT_NE(schema::message(done.error()).find(says), std::string::npos) << schema::message(done.error());
    EXPECT_EQ(folder_.files(), before);
  }

  void refused(const std::function<void(ImportRequest&)>& spoil, ErrorKind fault,
               const std::string& says) const {
    ImportRequest asked = good();
    spoil(asked);
    refused(asked, fault, says);
  }

  void SetUp() override { write("t.csv", "f,x,v,t\n1,2,3,0\n4,5,6,1\n7,8,9,2\n"); }
};

TEST_F(ImportRefusals, TheGoodRequestIsGood) {
  EXPECT_TRUE(import(good()));
}

TEST_F(ImportRefusals, Files) {
  refused([&](auto& r) { r.file = folder_ / "absent.csv"; }, ErrorKind::not_found,
          "absent.csv: there is no such file");
  refused([&](auto& r) { r.file = folder_ / "."; }, ErrorKind::not_found, "folder");
  refused([&](auto& r) { r.file = "/dev/zero"; }, ErrorKind::not_found, "/dev/zero");
  refused([&](auto& r) { r.file = write("binary.csv", std::string("PK\3\4\0\0\0\0 zip", 12)); },
          ErrorKind::unsuitable, "is a ZIP archive, which import does not read; unpack it");
  refused([&](auto& r) { r.file = write("binary.dat", std::string("\1\2\3\0\0\0\0\0 any", 12)); },
          ErrorKind::malformed, "not a sound file");
  refused([&](auto& r) { r.file = write("oak.json", "{}"); }, ErrorKind::unsuitable, "is JSON");
  refused([&](auto& r) { r.file = write("oak.csv", " {\"kind\": \"recording\"}"); }, ErrorKind::unsuitable,
          "is JSON");
  refused([&](auto& r) { r.file = write("oak.texture.wav", "RIFF"); }, ErrorKind::unsuitable,
          "is already a texture");
  refused(
      [&](auto& r) {
        r.file = write("bad.csv", "f,x\n1,2\n3,4\n5,\n");
        r.channels = {"signal=x"};
      },
      ErrorKind::malformed, "bad.csv: line 4, column 2 ('x'): has no value");
}

// The first bytes of such files.
TEST_F(ImportRefusals, FilesOfOtherKindsByName) {
  const auto named = [&](const std::string& name, const std::string& bytes, const std::string& what) {
    refused([&](auto& r) { r.file = write(name, bytes); }, ErrorKind::unsuitable,
            "is " + what + ", which import");
  };
  const std::string zeros(200, '\0');
  named("c.mat", zeros, "a MATLAB file (version 4)");
  named("a.tdms", "TDSm\x0E" + zeros, "a TDMS file of LabVIEW");
  named("a.h5", "\x89HDF\r\n\x1a\n" + zeros, "an HDF5 or netCDF-4 file");
  named("a.x3p", "PK\3\4 main.xml" + zeros, "an X3P height profile (ISO 25178-72)");
  named("b.zip", "PK\3\4 xl/workbook.xml" + zeros, "an Excel workbook");
  named("a.xls", "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1" + zeros,
        "an old Excel workbook (.xls) or another Office document");
  named("a.csv", "PK\3\4 [Content_Types].xml xl/" + zeros, "an Excel workbook");
  named("a.npy", "\x93NUMPY" + zeros, "an array of NumPy");
  named("a.sdf", "aBCR-1.0\nManufacID = x\n", "an SDF height profile");
  named("b.csv", "<!DOCTYPE html>\n<html>\n", "HTML");
}

TEST_F(ImportRefusals, Options) {
  refused([](auto& r) { r.rate_hz = 0; }, ErrorKind::usage, "--rate: ");
  refused([](auto& r) { r.rate_hz = -5; }, ErrorKind::usage, "--rate: ");
  refused([](auto& r) { r.rate_hz = 3e9; }, ErrorKind::usage, "--rate: ");
  refused([](auto& r) { r.rate_hz.reset(); }, ErrorKind::usage,
          "add --rate, for example --rate 10kHz, or --time-column");
  refused([](auto& r) { r.skip_lines = 9; }, ErrorKind::usage, "--skip, ");
  refused([](auto& r) { r.time_column = "t*1s"; }, ErrorKind::usage, "--time-column");
  refused([](auto& r) { r.channels.clear(); }, ErrorKind::usage, "1 'f', 2 'x', 3 'v', 4 't'");
  refused([](auto& r) { r.channels.clear(); }, ErrorKind::usage,
          "--rate 10kHz --channel 'tangential_force=f*1N'");
  refused([](auto& r) { r.channels = {"position=y*1mm"}; }, ErrorKind::usage, "'y'");
  refused([](auto& r) { r.speed_mps = 0; }, ErrorKind::usage, "--speed: ");
  refused(
      [](auto& r) {
        r.speed_mps = 1;
        r.channels = {"position=x*1mm"};
      },
      ErrorKind::usage, "there is a position channel");
  refused(
      [](auto& r) {
        r.speed_mps = 1;
        r.channels = {"speed=v*1mm/s"};
      },
      ErrorKind::usage, "a speed channel is integrated");
  refused([](auto& r) { r.recorded = "14.3.2026"; }, ErrorKind::usage, "--date: '14.3.2026'");
  refused([](auto& r) { r.calibrated = "2026-13-01"; }, ErrorKind::usage, "--calibrated");
  refused([](auto& r) { r.humidity_percent = 101; }, ErrorKind::usage, "--humidity: 101 %");
}

TEST_F(ImportRefusals, ClocksThatAreNone) {
  const auto timed = [&](const char* text) {
    return [this, text](auto& r) {
      r.file = write("timed.csv", text);
      r.rate_hz.reset();
      r.time_column = "t*1s";
    };
  };
  write("timed.csv", "");
  refused(timed("f,t\n1,0\n1,1\n1,1\n"), ErrorKind::malformed,
          "timed.csv: line 4: time goes from 1 s to 1 s");
  refused(timed("f,t\n1,0\n1,1\n1,2\n1,3\n1,4.4\n1,5\n"), ErrorKind::malformed,
          "timed.csv: line 6: the time step of 1.4 s");
}

TEST_F(ImportRefusals, Outputs) {
  write("file", "");
  refused([&](auto& r) { r.name = folder_ / "file/out"; }, ErrorKind::cannot_write,
          "is a file, not a folder");
  refused([](auto& r) { r.name = "/proc/out"; }, ErrorKind::cannot_write, "/proc/out");
  ASSERT_TRUE(import(good()));
  refused([](auto&) {}, ErrorKind::usage, "out.wav: ");
}

TEST_F(ImportRefusals, TheOutputIsCheckedBeforeTheDataAreRead) {
  write("broken.csv", "f\n1\nbroken\n");
  refused(
      [&](auto& r) {
        r.file = folder_ / "broken.csv";
        r.name = "/proc/out";
      },
      ErrorKind::cannot_write, "/proc/out");
  refused(
      [&](auto& r) {
        r.file = folder_ / "broken.csv";
        r.name = folder_ / "absent/out";
      },
      ErrorKind::malformed, "broken.csv");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "absent"));
}

TEST_F(ImportRefusals, TheSourceIsNeverTheTarget) {
  const std::string wav = folder_ / "a.wav";
  auto writer = schema::WavWriter::create(wav, 1000, 1, schema::SampleFormat::float64);
  const std::vector<double> samples = {1, 2};
  ASSERT_TRUE(writer && writer->write(std::span<const double>(samples)) && writer->close());
  auto asked = request(wav);
  asked.name = folder_ / "a";
  asked.replace = true;
  refused(asked, ErrorKind::usage, "a.wav: ");
}

TEST_F(ImportRefusals, AFailedImportLeavesTheOldRecording) {
  ASSERT_TRUE(import(good()));
  refused(
      [&](auto& r) {
        r.file = write("broken.csv", "f\n1\nbroken\n");
        r.replace = true;
      },
      ErrorKind::malformed, "broken");
  EXPECT_TRUE(schema::open_recording(folder_ / "out"));
}

}  // namespace
}  // namespace tacto::capture
