// SPDX-License-Identifier: GPL-3.0-or-later
// Formants, descriptions and certificates as files: they read back as written; invalid ones are refused.
#include <gtest/gtest.h>

#include <cmath>

#include "data-schema/files/files.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/texture/description.hpp"
#include "data-schema/texture/formants.hpp"
#include "data-schema/texture/texture.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

FormantFile formants() {
  Formant formant;
  formant.from_m = 5e-3;
  formant.to_m = 85e-3;
  formant.open_from = true;
  formant.frequency_per_m = 2000;
  formant.lowest_per_m = 1990;
  formant.highest_per_m = 2010;
  formant.width_per_m = 164;
  formant.level_db = -40.5;
  formant.peak_level_db = -38;
  formant.peak_position_m = 44e-3;
  formant.prominence_db = 21;
  formant.track = {{5e-3, 1990, -41, 20}, {85e-3, 2010, -40, 22}};
  FormantTable table{"oak, planed", "tangential_force", "N", "1 N^2 mm", 10e-3, 1e-4, 172.68, 13, 8, "",
                     {formant}};
  return {{table}, "2024-05-01T12:00:00Z", "a test", "", ""};
}

DescriptionFile descriptions() {
  Description each;
  each.texture = "oak";
  each.quantity = "tangential_force";
  each.unit = "N";
  each.length_m = 0.089;
  each.pitch_m = 1e-6;
  each.low_per_m = 375;
  each.high_per_m = 12500;
  each.window_m = 0.02;
  each.rms = 0.0046;
  each.total_rms = 0.005;
  each.centroid_per_m = 2300;
  each.slope_db_per_octave = NAN;
  each.bands = {{-4, 398.1, 354.8, 446.7, true, 1e-3, 2e-9}, {0, 1000, 891, 1122, false, 2e-3, 3e-9}};
  return {{each}, "2024-05-01T12:00:00Z", "a test", "", ""};
}

Texture certified() {
  Texture texture;
  texture.signal.pitch_m = 1e-6;
  texture.signal.values.assign(100, 0.25);
  Certificate certificate{{"slow", "fast"}, {0.03, 0.09}, 3, 0.97, "2024-05-01T12:00:00Z", "a test", {}};
  certificate.peaks.push_back(
      {PeakVerdict::temporal, 0.99, "", 3333, 100, 0.02, 31, 6.4, 3, 1.1, {"slow", "fast"}});
  certificate.peaks.push_back(
      {PeakVerdict::undecided, 0.5, "outside_band", 300, 9, 0.01, 12, 6.4, 1, 2, {"slow"}});
  texture.certificate = certificate;
  return texture;
}

class Tables : public testing::Test {
 protected:
  void write(const std::string& name, const Result<std::string>& text) {
    ASSERT_TRUE(text) << message(text.error());
    PendingFiles pending;
    ASSERT_TRUE(pending.write(folder_ / name, *text));
    ASSERT_TRUE(pending.commit());
  }
  tests::TemporaryFolder folder_;
};

TEST_F(Tables, FormantsReadBack) {
  write("oak.formants.json", formants_json(formants()));
  for (const char* name : {"oak", "oak.formants.json"}) {
    const auto read = read_formants(folder_ / name);
    ASSERT_TRUE(read) << message(read.error());
    EXPECT_EQ(formants_json(*read).value(), formants_json(formants()).value());
    EXPECT_TRUE(read->tables[0].formants[0].open_from);
    EXPECT_EQ(read->tables[0].formants[0].track[1].frequency_per_m, 2010);
  }
  EXPECT_EQ(stored_files(folder_ / "oak")->front().kind, FileKind::formants);
}

TEST_F(Tables, FormantsAsCsvNameTheirUnits) {
  const std::string csv = formants_csv(formants());
  EXPECT_NE(csv.find("frequency_per_mm"), std::string::npos);
  EXPECT_NE(csv.find("\"level (dB re 1 N^2 mm)\""), std::string::npos);
  EXPECT_NE(csv.find("\n\"oak, planed\",5,85,1,0,2,"), std::string::npos) << csv;
}

// JSON has no NaN: the member is left out and reads back as NaN.
TEST_F(Tables, DescriptionsReadBack) {
  write("oak.descriptions.json", descriptions_json(descriptions()));
  const auto read = read_descriptions(folder_ / "oak");
  ASSERT_TRUE(read) << message(read.error());
  EXPECT_TRUE(std::isnan(read->textures[0].slope_db_per_octave));
  EXPECT_EQ(descriptions_json(*read).value(), descriptions_json(descriptions()).value());
  EXPECT_EQ(stored_files(folder_ / "oak.descriptions.json")->front().kind, FileKind::descriptions);
}

TEST_F(Tables, DescriptionsAsCsvLeaveUnknownCellsEmpty) {
  DescriptionFile two = descriptions();
  two.textures.push_back(two.textures[0]);
  two.textures[1].texture = "pine";
  two.textures[1].bands.erase(two.textures[1].bands.begin());
  const std::string csv = descriptions_csv(two);
  EXPECT_NE(csv.find("rms at 0.398/mm (N),partial at 0.398/mm,rms at 1/mm (N)"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",2.3,,0.001,1,0.002,0\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",2.3,,,,0.002,0\n"), std::string::npos) << csv;
}

TEST_F(Tables, CertificatesStayWithTheirTexture) {
  ASSERT_TRUE(write_texture(folder_ / "slow", certified()));
  const auto read = read_texture(folder_ / "slow");
  ASSERT_TRUE(read) << message(read.error());
  ASSERT_TRUE(read->certificate);
  EXPECT_EQ(read->certificate->textures, (std::vector<std::string>{"slow", "fast"}));
  EXPECT_EQ(read->certificate->peaks[0].verdict, PeakVerdict::temporal);
  EXPECT_EQ(read->certificate->peaks[0].frequency_hz, 100);
  EXPECT_EQ(read->certificate->peaks[1].reason, "outside_band");
  ASSERT_TRUE(write_texture(folder_ / "copy", *read));
  EXPECT_EQ(read_texture(folder_ / "copy")->certificate->peaks.size(), 2U);
}

TEST_F(Tables, UnsoundOnesAreRefused) {
  Texture texture = certified();
  texture.certificate->peaks[0].confidence = 1.5;
  const auto written = write_texture(folder_ / "odd", texture);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().where.find("/certificate/peaks/0/confidence"), std::string::npos)
      << message(written.error());
  FormantFile odd = formants();
  odd.tables[0].window_m = -1;
  EXPECT_FALSE(formants_json(odd));
  EXPECT_EQ(read_formants(folder_ / "absent").error().kind, ErrorKind::not_found);
}

}  // namespace
}  // namespace tacto::schema
