// SPDX-License-Identifier: GPL-3.0-or-later
// How often `compare` calls two recordings of one emulated surface different, and how often it finds a
// difference. The surfaces are fixed height profiles; the seeds of the recordings vary. Each figure is a rate
// over pairs of different recordings, drawn from a pool; all seeds are fixed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <map>
#include <random>
#include <string>

#include "analysis/compare/surfaces.hpp"
#include "capture/record/record.hpp"
#include "data-schema/texture/texture.hpp"
#include "firmware-host/open_device.hpp"
#include "firmware-host/sim/physics/paper_surfaces.hpp"
#include "spatial/dsp/fourier/fft.hpp"
#include "spatial/texture/make_texture.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/measured.hpp"

namespace tacto::analysis {
namespace {

using RecordedStrokes = std::vector<schema::Texture>;
using Pool = std::vector<RecordedStrokes>;  // recordings

constexpr std::string_view kSurfaces = "ABCDE";
constexpr double kRateToleranceDb = 2;

firmware_host::Heights heights_of(char surface) {
  constexpr std::size_t kPoints = 20001;
  constexpr double kHeightPitchM = 2e-6;
  constexpr std::uint64_t kSurfaceSeed = 1;
  return firmware_host::paper_surfaces()[kSurfaces.find(surface)].heights(kPoints, kHeightPitchM,
                                                                          kSurfaceSeed);
}

// The pools of all surfaces, made when they are needed first.
class Pools {
 public:
  Pools() {
    for (const char surface : kSurfaces) {
      schema::Texture profile;
      profile.signal = {2e-6, 0, heights_of(surface)};
      profile.quantity = "height";
      profile.unit = "m";
      if (!schema::write_texture(profile_of(surface), profile)) std::abort();
    }
  }

  // `keys` are further keys of the device; {} in them is the number of the recording.
  const Pool& operator()(char surface, const std::string& keys = "", int recordings = 100,
                         std::size_t strokes = 12) {
    const std::string name = fmt::format("{}{}", surface, keys);
    if (const auto found = pools_.find(name); found != pools_.end()) return found->second;
    Pool pool;
    for (int i = 0; i < recordings; ++i) {
      const std::string more = fmt::format(fmt::runtime(keys), i + 2);
      pool.push_back(recorded(fmt::format("sim:surface=profile:{},strokes={},seed={}{}", profile_of(surface),
                                          strokes + 2, ++seed_, more),
                              strokes));
    }
    return pools_.emplace(name, std::move(pool)).first->second;
  }

 private:
  std::string profile_of(char surface) const { return folder_ / fmt::format("profile-{}", surface); }

  RecordedStrokes recorded(const std::string& uri, std::size_t strokes) const {
    auto device = firmware_host::open_device(uri);
    capture::RecordRequest request;
    request.name = folder_ / fmt::format("recording-{}", seed_);
    request.strokes = strokes;
    if (!device) std::abort();
    const auto done = capture::record(**device, request);
    if (!done) std::abort();
    spatial::TextureOptions options;
    options.pitch_m = 20e-6;
    auto maker = spatial::TextureMaker::open(done->recording, options);
    if (!maker) std::abort();
    RecordedStrokes made;
    for (const spatial::Stroke& stroke : maker->record().strokes())
      if (auto texture = maker->make(stroke, static_cast<int>(made.size()) + 1))
        made.push_back(std::move(*texture));
    for (const char* ending : {".wav", ".json"}) std::filesystem::remove(request.name + ending);
    return made;
  }

  tests::TemporaryFolder folder_;
  std::map<std::string, Pool> pools_;
  int seed_ = 0;
};

Pools& pools() {
  static Pools all;
  return all;
}

// A number of successive strokes of a recording.
SurfaceSide some_strokes(const RecordedStrokes& recording, std::size_t count, std::mt19937_64& random) {
  const std::size_t first = random() % (recording.size() - count + 1);
  SurfaceSide side{"side", std::vector<std::string>(count, "stroke"), {}};
  side.strokes.assign(recording.begin() + static_cast<std::ptrdiff_t>(first),
                      recording.begin() + static_cast<std::ptrdiff_t>(first + count));
  return side;
}

struct SurfaceRates {
  int pairs = 0, below_level = 0, different = 0, undecided = 0, unwarned = 0;

  void add(const schema::Result<SurfaceComparison>& c) {
    ASSERT_TRUE(c.has_value()) << schema::message(c.error());
    ++pairs;
    below_level += c->test && c->test->p <= kTestLevel;
    different += c->verdict == SurfaceVerdict::different;
    undecided += c->verdict == SurfaceVerdict::undecided;
    unwarned += c->verdict == SurfaceVerdict::different && c->notes.empty();
  }
  double percent(int count) const { return 100.0 * count / pairs; }
};

using Change = std::function<void(SurfaceSide&)>;

std::vector<std::size_t> shuffled(std::size_t size, std::mt19937_64& random) {
  std::vector<std::size_t> order(size);
  for (std::size_t i = 0; i < size; ++i) order[i] = i;
  for (std::size_t i = size; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

// Pairs of different recordings; `change` alters B. Within one pool no recording is used again before all are
// used, so that a rate is not that of a few recordings.
SurfaceRates surface_rates(const Pool& a, const Pool& b, std::size_t strokes, int pairs, unsigned seed,
                           const Change& change = {}) {
  std::mt19937_64 random(seed);
  SurfaceRates found;
  std::vector<std::size_t> left_over;
  while (found.pairs < pairs) {
    if (left_over.size() < 2) left_over = shuffled(a.size(), random);
    const std::size_t i = left_over.back();
    left_over.pop_back();
    const std::size_t j = &a == &b ? left_over.back() : random() % b.size();
    if (&a == &b) left_over.pop_back();
    const SurfaceSide left = some_strokes(a[i], strokes, random);
    SurfaceSide right = some_strokes(b[j], strokes, random);
    if (change) change(right);
    found.add(compare_surfaces(left, right, kRateToleranceDb));
    if (::testing::Test::HasFatalFailure()) return found;
  }
  return found;
}

// Raises the spectrum of each stroke from `low` to `high` 1/m.
Change raised(double low_per_m, double high_per_m, double level_db) {
  return [=](SurfaceSide& side) {
    for (schema::Texture& texture : side.strokes) {
      std::vector<double>& values = texture.signal.values;
      spatial::RealFft fft(values.size());
      std::vector<std::complex<double>> spectrum(fft.bins());
      fft.forward(values, spectrum);
      for (std::size_t k = 0; k < spectrum.size(); ++k) {
        const double per_m =
            static_cast<double>(k) / (static_cast<double>(values.size()) * texture.signal.pitch_m);
        if (per_m >= low_per_m && per_m <= high_per_m) spectrum[k] *= std::pow(10, level_db / 20);
      }
      fft.inverse(spectrum, values);
    }
  };
}

double shown_rate(const std::string& what, std::size_t strokes, double percent) {
  tacto::measured(fmt::format("surfaces_rates.{}_{}_strokes_percent", key_part(what), strokes), percent);
  return percent;
}

// 200 pairs per surface. p itself has the nominal rate; the verdict also demands the tolerance.
TEST(SurfacesRates, OneSurfaceIsRarelyDifferent) {
  for (const std::size_t strokes : {6, 12}) {
    double below = 0, different = 0;
    for (const char surface : kSurfaces) {
      const Pool& pool = pools()(surface);
      const SurfaceRates r = surface_rates(pool, pool, strokes, 200, 1);
      const double percent = shown_rate(fmt::format("p_on_{}", surface), strokes, r.percent(r.below_level));
      EXPECT_GE(percent, 2) << surface << strokes;
      EXPECT_LE(percent, 8.5) << surface << strokes;
      below += percent / kSurfaces.size();
      different += r.percent(r.different) / kSurfaces.size();
    }
    EXPECT_GE(shown_rate("p_on_one_surface", strokes, below), 3.5);
    EXPECT_LE(below, 7);
    EXPECT_LE(shown_rate("one_surface_different", strokes, different), 7);
  }
}

TEST(SurfacesRates, OtherSurfacesAreFound) {
  for (const std::size_t strokes : {6, 12})
    for (const std::string pair : {"CB", "CD", "CE", "CA", "AE", "DE", "AD"}) {
      const SurfaceRates r = surface_rates(pools()(pair[0]), pools()(pair[1]), strokes, 100, 2);
      EXPECT_GE(shown_rate("found_" + pair, strokes, r.percent(r.different)), strokes == 6 ? 95 : 98) << pair;
    }
}

TEST(SurfacesRates, RaisedBandsAreFound) {
  const auto pooled = [](const std::string& what, std::size_t strokes, const Change& change) {
    double percent = 0;
    for (const char surface : kSurfaces) {
      const SurfaceRates r = surface_rates(pools()(surface), pools()(surface), strokes, 80, 3, change);
      percent += r.percent(r.different) / kSurfaces.size();
    }
    return shown_rate(what, strokes, percent);
  };
  EXPECT_GE(pooled("6_db_narrow", 6, raised(2000, 2600, 6)), 85);
  EXPECT_GE(pooled("6_db_narrow", 12, raised(2000, 2600, 6)), 98);
  // 90 % are required; the standard error of 400 pairs is 1.5 %.
  EXPECT_GE(pooled("3_db_wide", 6, raised(1000, 4000, 3)), 88);
  EXPECT_GE(pooled("3_db_wide", 12, raised(1000, 4000, 3)), 98);
}

// Another load or speed over the same surface.
TEST(SurfacesRates, OtherConditionsAreRarelyDifferent) {
  const auto pooled = [](const std::string& keys, std::size_t strokes) {
    SurfaceRates all;
    for (const char surface : kSurfaces) {
      const SurfaceRates r = surface_rates(pools()(surface), pools()(surface, keys, 20), strokes, 60, 4);
      all.pairs += r.pairs;
      all.different += r.different;
      all.unwarned += r.unwarned;
    }
    return all;
  };
  for (const std::size_t strokes : {6, 12}) {
    const SurfaceRates load = pooled(",load=0.55N", strokes), faster = pooled(",speed=55mm/s", strokes);
    EXPECT_LE(shown_rate("load_550_mn", strokes, load.percent(load.different)), 9);
    EXPECT_LE(shown_rate("speed_55_mm_s", strokes, faster.percent(faster.different)), 9);
    for (const int speed : {40, 60}) {
      const std::string what = fmt::format("speed_{}_mm_s", speed);
      const SurfaceRates other = pooled(fmt::format(",speed={}mm/s", speed), strokes);
      EXPECT_LE(shown_rate(what, strokes, other.percent(other.different)), 20);
      EXPECT_LE(shown_rate(what + "_without_a_warning", strokes, other.percent(other.unwarned)), 5)
          << "a difference that the speed may cause has a warning";
    }
  }
}

// 4 + 4 persons with a recording each: the recording is the unit.
TEST(SurfacesRates, OtherPersonsAreRarelyDifferent) {
  SurfaceRates all;
  std::mt19937_64 random(5);
  for (const char surface : kSurfaces) {
    const Pool& pool = pools()(surface, ",person={}", 24, 6);
    for (int pair = 0; pair < 60; ++pair) {
      const std::vector<std::size_t> order = shuffled(pool.size(), random);
      SurfaceSide sides[2];
      for (std::size_t i = 0; i < 8; ++i)
        for (const schema::Texture& texture : pool[order[i]]) {
          sides[i / 4].strokes.push_back(texture);
          sides[i / 4].stroke_names.emplace_back("stroke");
        }
      const auto c = compare_surfaces(sides[0], sides[1], kRateToleranceDb);
      ASSERT_TRUE(c.has_value() && c->by_recording && c->units_a == 4 && c->units_b == 4);
      all.add(c);
    }
  }
  EXPECT_LE(shown_rate("persons_4", 6, all.percent(all.different)), 8);
}

// Adds known differences to strokes of one surface: the interval of the named band, and the difference that
// is called detectable.
TEST(SurfacesRates, IntervalsAndDetectableDifferencesHold) {
  for (const std::size_t strokes : {6, 12}) {
    int pairs = 0, held = 0, third_found = 0, wide_found = 0;
    std::mt19937_64 random(6);
    for (const char surface : kSurfaces) {
      const Pool& pool = pools()(surface);
      for (int pair = 0; pair < 60; ++pair) {
        const std::size_t i = random() % pool.size(),
                          j = (i + 1 + random() % (pool.size() - 1)) % pool.size();
        const SurfaceSide a = some_strokes(pool[i], strokes, random),
                          b = some_strokes(pool[j], strokes, random);
        const auto plain = compare_surfaces(a, b, kRateToleranceDb);
        ASSERT_TRUE(plain.has_value());
        if (!plain->test) continue;  // undecided, because of load or speed
        ++pairs;
        const std::vector<double>& edges = plain->edges_per_m;
        const auto with = [&](std::size_t first, std::size_t bands, double level_db) {
          SurfaceSide changed = b;
          raised(edges[first], edges[first + bands], level_db)(changed);
          return *compare_surfaces(a, changed, kRateToleranceDb);
        };
        const std::size_t bands = edges.size() - 1;
        const double sign = random() % 2 == 0 ? 1 : -1;
        const std::size_t first = random() % (bands - 6);
        const SurfaceComparison c = with(first, 6, sign * 6);
        const BandWindow& window = c.test->windows[c.test->strongest];
        double truth = 0;
        for (std::size_t band = window.first; band < window.first + window.bands; ++band)
          truth += (band >= first && band < first + 6 ? sign * 6 : 0) / static_cast<double>(window.bands);
        held += std::abs(window.level_db - truth) <= c.test->reach * window.error_db;
        third_found += with(random() % (bands - 1), 2, sign * plain->finest_third_octave_db).verdict ==
                       SurfaceVerdict::different;
        wide_found += with(0, bands, sign * plain->finest_level_db).verdict == SurfaceVerdict::different;
      }
    }
    EXPECT_GE(shown_rate("interval_holds", strokes, 100.0 * held / pairs), 93);
    EXPECT_GE(shown_rate("detectable_third_octave", strokes, 100.0 * third_found / pairs), 80);
    EXPECT_GE(shown_rate("detectable_level", strokes, 100.0 * wide_found / pairs), 80);
  }
}

}  // namespace
}  // namespace tacto::analysis
