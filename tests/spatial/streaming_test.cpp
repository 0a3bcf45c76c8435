// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings of any length in bounded memory, from a source that computes its frames during reading.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>

#include "spatial/texture/filtered_track.hpp"
#include "spatial/texture/make_texture.hpp"
#include "tests/measured.hpp"
#include "tests/spatial/force_and_position.hpp"

namespace tacto::spatial {
namespace {

constexpr double kStreamRate_hz = 1000;
constexpr double kStroke_m = 0.04;
constexpr double kStreamTurn = 2 * std::numbers::pi;

double stream_surface(double position_m) {
  return 0.1 * std::sin(kStreamTurn * 1000 * position_m) +
         0.05 * std::sin(kStreamTurn * 1900 * position_m + 1);
}

// 40 mm ahead in 0.8 s, with speed varying by a tenth, and back after 4.2 s of rest: 10 s, repeated.
std::vector<double> ten_seconds() {
  std::vector<double> position_m;
  for (int i = 0; i < 5000; ++i) {
    const double t_s = std::min(i / kStreamRate_hz, 0.8);
    const double way_m = 0.05 * (t_s + 0.1 * std::sin(kStreamTurn * 2.5 * t_s) / (kStreamTurn * 2.5));
    position_m.push_back(std::round(way_m / 1e-6) * 1e-6);
  }
  for (std::size_t i = 0; i < 5000; ++i)
    position_m.push_back(std::round((kStroke_m - position_m[i]) / 1e-6) * 1e-6);
  return position_m;
}

// The force of a surface along a path that is repeated without end, with a slow drift.
class EndlessSource : public samples::ForceAndPosition {
 public:
  explicit EndlessSource(std::vector<double> path) : path_(std::move(path)) {
    for (const double x : path_) force_n_.push_back(stream_surface(x));
  }
  schema::Result<void> read_stored(Track track, std::size_t first, std::span<double> out) override {
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::size_t at = (first + i) % path_.size();
      out[i] = track == Track::position ? path_[at] : force_n_[at] + 1e-8 * static_cast<double>(first + i);
    }
    return {};
  }

 private:
  std::vector<double> path_, force_n_;
};

schema::Result<TouchRecord> record_of(std::vector<double> path, std::uint64_t frames) {
  schema::RecordingHeader header;
  header.frames = frames;
  header.sample_rate_hz = kStreamRate_hz;
  return TouchRecord::open(std::make_unique<EndlessSource>(std::move(path)), header, "endless");
}

TextureOptions options_for(FilterMethod method = FilterMethod::fourier) {
  TextureOptions options;
  options.filter = {method, {15, 300}, Edges::treated, 4};
  options.pitch_m = 1e-5;
  options.method = ResampleMethod::sinc;
  return options;
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// RMS difference from the surface re its RMS, 5 mm and more from the ends.
double stream_error(const schema::Texture& texture) {
  double miss = 0, size = 0;
  for (std::size_t i = 0; i < texture.signal.values.size(); ++i) {
    const double at_m = texture.signal.position_m(i);
    if (at_m < 0.005 || at_m > texture.signal.length_m() - 0.005) continue;
    const double exact = stream_surface(texture.source_origin_m + at_m);
    miss += std::pow(texture.signal.values[i] - exact, 2);
    size += exact * exact;
  }
  return std::sqrt(miss / size);
}

// This test is first, because the peak is that of the process.
TEST(Streaming, ADayFitsInLittleMemory) {
  constexpr std::uint64_t kDay = 24 * 3600 * 1000;
  const double before_mb = peak_mb();
  auto record = record_of(ten_seconds(), kDay);
  ASSERT_TRUE(record) << schema::message(record.error());
  ASSERT_EQ(record->strokes().size(), 2 * kDay / 10000);
  auto maker = TextureMaker::open(std::move(*record), options_for());
  ASSERT_TRUE(maker) << schema::message(maker.error());
  const auto& strokes = maker->record().strokes();
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, strokes.size() / 2, strokes.size() - 2}) {
    EXPECT_EQ(strokes[n].direction, n % 2 == 0 ? 1 : -1);
    const auto texture = maker->make(strokes[n], static_cast<int>(n) + 1);
    ASSERT_TRUE(texture) << schema::message(texture.error());
    // A quantum of 1 um at 1 and 1.9 /mm is 0.2 % of phase noise; the rest is the filter at the ends.
    EXPECT_LT(stream_error(*texture), 0.02) << n;
  }
  // AddressSanitizer keeps freed memory.
  const bool judged = std::getenv("TACTO_SANITIZED") == nullptr;
  EXPECT_TRUE(!judged || peak_mb() - before_mb < 32) << peak_mb() - before_mb;
  measured("spatial_streaming.day_at_1_khz_mb", peak_mb() - before_mb);
}

TEST(Streaming, TenMinutesOfRestInMidStroke) {
  std::vector<double> path(2000, 0.0);
  const auto go = [&](double to_m) {
    const double from_m = path.back();
    for (int i = 1; i <= 400; ++i)
      path.push_back(std::round((from_m + (to_m - from_m) * i / 400) * 1e6) * 1e-6);
  };
  go(0.02);
  path.insert(path.end(), 600000, path.back());
  go(0.04);
  path.insert(path.end(), 2000, path.back());
  auto record = record_of(path, path.size());
  ASSERT_TRUE(record);
  EXPECT_EQ(record->strokes().size(), 2U);  // without the option a pause separates them
  auto maker = TextureMaker::open(std::move(*record), options_for());
  const auto section = maker->record().section(2.0, 602.8);
  ASSERT_TRUE(section) << schema::message(section.error());
  const auto texture = maker->make(*section, 0);
  ASSERT_TRUE(texture) << schema::message(texture.error());
  EXPECT_NEAR(texture->signal.length_m(), 0.04, 1e-4);
  // Away from the stop it is the surface; at the stop the valid band begins far above the surface's lines.
  double miss = 0, size = 0, lowest_at_stop = 0;
  for (std::size_t i = 0; i < texture->signal.values.size(); ++i) {
    const double at_m = texture->source_origin_m + texture->signal.position_m(i);
    if (at_m < 0.005 || at_m > 0.035 || std::abs(at_m - 0.02) < 0.005) continue;
    miss += std::pow(texture->signal.values[i] - stream_surface(at_m), 2);
    size += std::pow(stream_surface(at_m), 2);
  }
  EXPECT_LT(std::sqrt(miss / size), 0.03);
  for (const auto& point : texture->valid_band)
    if (std::abs(texture->source_origin_m + point.position_m - 0.02) < 2e-4)
      lowest_at_stop = std::max(lowest_at_stop, point.low_per_m);
  EXPECT_GT(lowest_at_stop, 1e5);  // 15 Hz at under 0.15 mm/s
}

TEST(Streaming, GivesWhatTheWholeSectionGives) {
  constexpr std::size_t kFrames = 120000;
  for (const FilterMethod method : {FilterMethod::fourier, FilterMethod::butterworth, FilterMethod::none})
    for (const Edges edges : {Edges::treated, Edges::none}) {
      const TimeFilter filter{method, {15, 300}, edges, 4};
      EndlessSource source(ten_seconds());
      std::vector<double> all(kFrames);
      ASSERT_TRUE(source.read(Track::value, 0, all));
      const auto whole = filter_in_time(all, kStreamRate_hz, filter);
      ASSERT_TRUE(whole);
      FilteredTrack track(kStreamRate_hz, filter, {});
      double miss = 0, size = 0;
      for (const FrameRange frames :
           {FrameRange{0, 900}, FrameRange{5000, 6000}, FrameRange{90000, 120000}}) {
        const auto part = track.values(source, {0, kFrames}, frames);
        ASSERT_TRUE(part);
        for (std::size_t i = frames.begin; i < frames.end; ++i) {
          miss += std::pow((*part)[i - frames.begin] - (*whole)[i], 2);
          size += std::pow((*whole)[i], 2);
        }
      }
      EXPECT_LT(std::sqrt(miss / size), 1e-4) << name_of(method) << " " << name_of(edges);
    }
}

TEST(Streaming, AFaultOfTheSourceIsPassedOn) {
  class Broken : public EndlessSource {
   public:
    Broken() : EndlessSource(ten_seconds()) {}
    schema::Result<void> read_stored(Track track, std::size_t first, std::span<double> out) override {
      if (track == Track::value && first + out.size() > 60000)
        return schema::fail(schema::ErrorKind::malformed, "the tape is torn");
      return EndlessSource::read_stored(track, first, out);
    }
  };
  schema::RecordingHeader header;
  header.frames = 100000;
  header.sample_rate_hz = kStreamRate_hz;
  auto record = TouchRecord::open(std::make_unique<Broken>(), header, "torn");
  ASSERT_TRUE(record);
  auto maker = TextureMaker::open(std::move(*record), options_for());
  ASSERT_TRUE(maker);
  const auto& strokes = maker->record().strokes();
  const auto last = maker->make(strokes.back(), 1);
  ASSERT_FALSE(last);
  EXPECT_EQ(last.error().what, "the tape is torn");
  EXPECT_FALSE(maker->make(strokes.back(), 1));
}

}  // namespace
}  // namespace tacto::spatial
