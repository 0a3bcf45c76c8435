// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/transform/stretch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "data-schema/base/quantity.hpp"
#include "data-schema/base/statistics.hpp"
#include "spatial/dsp/resample/windowed_sinc.hpp"
#include "spatial/numbers/band_at.hpp"
#include "spatial/transform/period.hpp"
#include "spatial/transform/transformed.hpp"

namespace tacto::spatial {
namespace {

using schema::BandPoint;
using schema::ErrorKind;
using schema::Lengthening;
using schema::Result;
using schema::Texture;
using Values = std::span<const double>;

// Quarters that contain the ends of a joint, and room for the interpolation.
constexpr std::size_t kFewestStretched = 8 * WindowedSinc::kReach;
constexpr double kSincReach = static_cast<double>(WindowedSinc::kReach);
constexpr double kAllRemoved = 0.99;
constexpr double kEqualJoints = 1e-3;        // re the RMS of value and slope: 60 dB below the texture
constexpr std::size_t kCoarsePlaces = 2000;  // on each side of a joint: 4e6 pairs

// The way through the source, in its samples: from 0 to `end`, where it goes on at end - length.
struct Course {
  double end, length;

  double at(double way) const { return way < end ? way : end - length + std::fmod(way - end, length); }
  int joints(double way) const {
    return way < end ? 0 : 1 + static_cast<int>(std::floor((way - end) / length));
  }
};

// A texture's period in samples. `repeats`: it has whole periods, so that its first sample follows its last.
struct Repetition {
  double samples = 0;
  bool repeats = false;
};

// Values between the samples. Beyond the ends the record repeats itself, or is mirrored about its ends.
class Interpolated {
 public:
  Interpolated(Values values, bool repeats) {
    if (!repeats) {
      extended_ = extend_odd(values, WindowedSinc::kReach);
      return;
    }
    extended_.assign(values.end() - WindowedSinc::kReach, values.end());
    extended_.insert(extended_.end(), values.begin(), values.end());
    extended_.insert(extended_.end(), values.begin(), values.begin() + WindowedSinc::kReach);
  }
  double value(double place) const { return sinc_(extended_, place + kSincReach); }
  double slope(double place) const { return value(place + 0.5) - value(place - 0.5); }

 private:
  WindowedSinc sinc_;
  std::vector<double> extended_;
};

// RMS of the values about their mean, and of their slopes: the units of a joint's error.
struct JointScale {
  double value = 0, slope = 0;

  explicit JointScale(Values values) {
    std::vector<double> deviations = about_mean(values);
    value = schema::rms_of(deviations);
    std::adjacent_difference(deviations.begin(), deviations.end(), deviations.begin());
    slope = schema::rms_of(std::span(deviations).subspan(1));
  }
  double error(double jump, double kink) const { return std::hypot(jump / value, kink / slope); }
};

// The pair of samples, one in the first quarter and one in the last, whose values and slopes fit best. Of
// pairs that fit as well, within kEqualJoints, the latest one: after it the texture is left out.
class BestJoint {
 public:
  explicit BestJoint(Values values) : values_(values), scale_(values) {}

  Course course() const {
    const std::size_t size = values_.size(), reach = WindowedSinc::kReach;
    const Range early{reach, size / 4}, late{size - size / 4, size - 1 - reach};
    const std::size_t step = std::max<std::size_t>(1, size / 4 / kCoarsePlaces);
    Joint joint = best(early, late, step);
    if (step > 1) joint = best(early.near(joint.early, step), late.near(joint.late, step), 1);
    return {static_cast<double>(joint.late), static_cast<double>(joint.late - joint.early)};
  }

 private:
  struct Range {
    std::size_t first, last;
    Range near(std::size_t place, std::size_t reach) const {
      return {std::max(first, place - std::min(place, reach)), std::min(last, place + reach)};
    }
  };
  struct Joint {
    std::size_t early = 0, late = 0;
    double error = std::numeric_limits<double>::infinity();
  };

  Joint best(Range early, Range late, std::size_t step) const {
    std::vector<Joint> joints;  // of each end the best one
    for (std::size_t b = late.first; b <= late.last; b += step) {
      Joint& joint = joints.emplace_back();
      for (std::size_t a = early.first; a <= early.last; a += step)
        if (const double error = scale_.error(values_[b] - values_[a], slope(b) - slope(a));
            error < joint.error)
          joint = {a, b, error};
    }
    const double least = std::ranges::min(joints, {}, &Joint::error).error;
    return *std::ranges::find_if(joints.rbegin(), joints.rend(),
                                 [&](const Joint& joint) { return joint.error <= least + kEqualJoints; });
  }
  double slope(std::size_t i) const { return 0.5 * (values_[i + 1] - values_[i - 1]); }

  Values values_;
  JointScale scale_;
};

Result<void> check_stretch(const Texture& texture, const Stretch& stretch) {
  if (!(stretch.factor >= kLeastStretch && stretch.factor <= kMostStretch))
    return schema::fail(ErrorKind::usage, fmt::format("cannot stretch by a factor of {:g}", stretch.factor),
                        {}, fmt::format("use a factor from {:g} to {:g}", kLeastStretch, kMostStretch));
  if (stretch.period_m && !(*stretch.period_m > 2 * texture.signal.pitch_m))
    return schema::fail(ErrorKind::usage, "the period must be longer than two steps of the grid");
  const std::size_t size = texture.signal.values.size();
  if (size < kFewestStretched)
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("has {} samples, stretching needs at least {}", size, kFewestStretched),
                        {}, "use a longer texture");
  const auto [least, most] = std::ranges::minmax(texture.signal.values);
  if (!(least < most))
    return schema::fail(ErrorKind::unsuitable, "all values are the same: there is nothing to stretch");
  return {};
}

// The period, if the texture is to have whole periods.
Result<std::optional<Repetition>> repetition_of(const Texture& texture, const Stretch& stretch) {
  if (stretch.lengthening == Lengthening::best_fit) return std::nullopt;
  const double pitch_m = texture.signal.pitch_m;
  Repetition found;
  if (stretch.period_m) {
    found.samples = *stretch.period_m / pitch_m;
  } else {
    const auto period = find_period(texture.signal.values);
    if (!period && !stretch.lengthening) return std::nullopt;
    if (!period)
      return schema::fail(
          ErrorKind::unsuitable,
          fmt::format("no period was found: at no shift up to half of its length does the texture correlate "
                      "with itself by {:g}",
                      kLeastPeriodCorrelation),
          {}, "state it with --period, or use --lengthen best");
    found.samples = *period;
  }
  const auto size = static_cast<double>(texture.signal.values.size());
  const double whole = std::round(size / found.samples);
  found.repeats = is_whole_periods(texture.signal.values.size(), found.samples);
  if (found.repeats) found.samples = size / whole;
  if (!found.repeats && size - 1 - kSincReach < found.samples)
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("is too short: {} is less than a period of {} and {:g} samples",
                                    schema::length_for_people(size * pitch_m),
                                    schema::length_for_people(found.samples * pitch_m), kSincReach + 1),
                        {}, "use a longer texture");
  return found;
}

// At a joint of a texture that does not repeat itself, the interpolation needs samples on both sides.
Course course_of(Values values, const std::optional<Repetition>& repetition, double factor) {
  const auto size = static_cast<double>(values.size());
  if (!repetition) return factor < 1 ? BestJoint(values).course() : Course{size, size};
  if (repetition->repeats) return {size, size};
  const double end = size - 1 - kSincReach;
  const double periods = std::max(1.0, std::floor((end - kSincReach) / repetition->samples));
  return {end, periods * repetition->samples};
}

std::size_t stretched_count(std::size_t size, const std::optional<Repetition>& repetition,
                            const Course& course, double factor) {
  if (!repetition) return size;
  const double longer = repetition->samples * factor;
  double periods = std::max(1.0, std::round(static_cast<double>(size) / longer));
  if (factor > 1) periods = std::min(periods, std::max(1.0, std::floor(course.end / repetition->samples)));
  return static_cast<std::size_t>(std::llround(periods * longer));
}

// In a texture that repeats itself the end is its beginning, so its last sample is compared with the one that
// is as many whole periods before it as there are.
double joint_error(const Interpolated& source, const JointScale& scale, const Course& course,
                   const std::optional<Repetition>& repetition) {
  const bool repeats = repetition && repetition->repeats;
  const double late = repeats ? course.end - 1 : course.end;
  const double early = repeats ? late - (course.length - repetition->samples) : late - course.length;
  return scale.error(source.value(late) - source.value(early), source.slope(late) - source.slope(early));
}

// In the source's samples and frequencies: its breakpoints along the course, at most `high_per_m`.
std::vector<BandPoint> stretched_band(const Texture& texture, const Course& course, double factor,
                                      double high_per_m, std::size_t count) {
  const auto& band = texture.valid_band;
  std::vector<BandPoint> result;
  if (band.empty()) return result;
  const double pitch_m = texture.signal.pitch_m, way = static_cast<double>(count - 1) / factor;
  double begin = 0;
  for (double before = 0; before + begin <= way;
       before += course.length, begin = course.end - course.length) {
    const double end = std::min(course.end, way - before);
    const auto add = [&](double place) {
      const BandPoint here = band_at(band, place * pitch_m);
      // At a joint rounding must not make positions decrease.
      const double position_m = (before + place) * factor * pitch_m;
      result.push_back({result.empty() ? position_m : std::max(position_m, result.back().position_m),
                        std::min(here.low_per_m, high_per_m) / factor,
                        std::min(here.high_per_m, high_per_m) / factor});
    };
    add(begin);
    for (const BandPoint& point : band)
      if (point.position_m > begin * pitch_m && point.position_m < end * pitch_m)
        add(point.position_m / pitch_m);
    add(end);
  }
  return result;
}

// The values without what is above `high_per_m`, a frequency of the source.
Result<BandLimited> held_by_grid(const Texture& texture, double factor, double high_per_m, bool repeats) {
  const double pitch_m = texture.signal.pitch_m;
  auto limited =
      band_limited(texture.signal.values, pitch_m, high_per_m, repeats ? Edges::none : Edges::treated);
  if (!limited || limited->removed_share <= kAllRemoved) return limited;
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format("the grid of {} cannot hold it: all but {:.2g} % of its power would be above {}",
                  schema::length_for_people(pitch_m), 100 * (1 - std::pow(limited->removed_share, 2)),
                  schema::for_people(high_per_m / factor, schema::Dimension::spatial_frequency)),
      {}, "use a larger factor, or a texture on a finer grid");
}

}  // namespace

Result<Texture> stretch(const Texture& texture, const Stretch& stretch) {
  TACTO_TRY(check_stretch(texture, stretch));
  const auto repetition = repetition_of(texture, stretch);
  TACTO_TRY(repetition);
  const double factor = stretch.factor, pitch_m = texture.signal.pitch_m;
  const bool repeats = *repetition && (*repetition)->repeats;
  const double high_per_m = kInterpolatedShare * std::min(1.0, factor) / pitch_m;
  const auto limited = held_by_grid(texture, factor, high_per_m, repeats);
  TACTO_TRY(limited);

  const Course course = course_of(limited->values, *repetition, factor);
  const std::size_t count = stretched_count(limited->values.size(), *repetition, course, factor);
  const Interpolated source(limited->values, repeats);
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i)
    values[i] = source.value(course.at(static_cast<double>(i) / factor)) * (stretch.keep_slope ? factor : 1);

  schema::TransformStep step;
  step.operation = schema::TransformOperation::stretch;
  step.factor = factor;
  step.keep_slope = stretch.keep_slope;
  step.lengthening = *repetition ? Lengthening::periods : Lengthening::best_fit;
  if (*repetition) step.period_m = (*repetition)->samples * pitch_m;
  const double way = static_cast<double>(count - 1) / factor;
  step.joints = course.joints(way);
  if (*step.joints > 0 || (*repetition && !repeats))
    step.joint_error = joint_error(source, JointScale(limited->values), course, *repetition);
  const double unused = static_cast<double>(limited->values.size() - 1) - std::min(way, course.end);
  if (unused >= 1) step.left_out_m = unused * pitch_m;
  if (limited->removed_share > 0) {
    step.removed_above_per_m = high_per_m / factor;
    step.removed_share = limited->removed_share;
  }
  Texture result = transformed(texture, std::move(values), std::move(step));
  result.valid_band = stretched_band(texture, course, factor, high_per_m, count);
  return result;
}

}  // namespace tacto::spatial
