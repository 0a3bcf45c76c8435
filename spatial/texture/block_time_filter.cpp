// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/block_time_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "spatial/dsp/filter/block_fourier_filter.hpp"
#include "spatial/dsp/filter/block_zero_phase.hpp"
#include "spatial/dsp/filter/butterworth.hpp"

namespace tacto::spatial {

class BlockTimeFilter::Stage {
 public:
  virtual ~Stage() = default;
  /// Both append to `out`; finish() also resets the stage.
  virtual void push(std::span<const double> values, std::vector<double>& out) = 0;
  virtual void finish(std::vector<double>& out) = 0;
  virtual void reset() = 0;
};

namespace {

using Stage = BlockTimeFilter::Stage;
using Stages = std::vector<std::unique_ptr<Stage>>;

// A filter that itself processes chunks.
template <class Filter>
class Fed final : public Stage {
 public:
  template <class... Arguments>
  explicit Fed(Arguments&&... arguments) : filter_(std::forward<Arguments>(arguments)...) {}
  void push(std::span<const double> values, std::vector<double>& out) override { filter_.push(values, out); }
  void finish(std::vector<double>& out) override { filter_.finish(out); }
  void reset() override { filter_.reset(); }

 private:
  Filter filter_;
};

// Plain truncation, which transforms a whole section at once.
class Held final : public Stage {
 public:
  Held(double sample_rate_hz, Band band, SpectralGain gain)
      : sample_rate_hz_(sample_rate_hz), band_(band), gain_(std::move(gain)) {}
  void push(std::span<const double> values, std::vector<double>&) override {
    values_.insert(values_.end(), values.begin(), values.end());
  }
  void finish(std::vector<double>& out) override {
    const auto filtered = fourier_filter(values_, sample_rate_hz_, band_, Edges::none, gain_);
    out.insert(out.end(), filtered.begin(), filtered.end());
    reset();
  }
  void reset() override { values_ = {}; }

 private:
  double sample_rate_hz_;
  Band band_;
  SpectralGain gain_;
  std::vector<double> values_;
};

std::unique_ptr<Stage> fourier_stage(double sample_rate_hz, Band band, Edges edges, const SpectralGain& gain,
                                     std::size_t longest) {
  if (edges == Edges::none) return std::make_unique<Held>(sample_rate_hz, band, gain);
  return std::make_unique<Fed<BlockFourierFilter>>(sample_rate_hz, band, gain, longest);
}

schema::Result<std::unique_ptr<Stage>> butterworth_stage(double sample_rate_hz, const TimeFilter& filter,
                                                         std::size_t longest) {
  const auto sections = butterworth_band_pass(filter.order, filter.band, sample_rate_hz);
  TACTO_TRY(sections);
  const std::size_t padding =
      filter.edges == Edges::none
          ? default_padding(*sections)
          : EndTreatment::for_lowest(filter.band.low_hz, sample_rate_hz, std::max<std::size_t>(longest, 2))
                .padding;
  return std::make_unique<Fed<BlockZeroPhase>>(*sections, padding);
}

}  // namespace

BlockTimeFilter::BlockTimeFilter(Stages stages) : stages_(std::move(stages)) {}
BlockTimeFilter::BlockTimeFilter(BlockTimeFilter&&) noexcept = default;
BlockTimeFilter& BlockTimeFilter::operator=(BlockTimeFilter&&) noexcept = default;
BlockTimeFilter::~BlockTimeFilter() = default;

schema::Result<BlockTimeFilter> BlockTimeFilter::open(double sample_rate_hz, const TimeFilter& filter,
                                                      const SpectralGain& equaliser, std::size_t longest) {
  TACTO_TRY(check(filter, sample_rate_hz));
  Stages stages;
  if (filter.method == FilterMethod::fourier) {
    stages.push_back(fourier_stage(sample_rate_hz, filter.band, filter.edges, equaliser, longest));
    return BlockTimeFilter(std::move(stages));
  }
  if (filter.method == FilterMethod::butterworth) {
    auto stage = butterworth_stage(sample_rate_hz, filter, longest);
    TACTO_TRY(stage);
    stages.push_back(std::move(*stage));
  }
  if (equaliser)
    stages.push_back(
        fourier_stage(sample_rate_hz, {0, sample_rate_hz / 2}, filter.edges, equaliser, longest));
  return BlockTimeFilter(std::move(stages));
}

void BlockTimeFilter::reset() {
  for (auto& stage : stages_) stage->reset();
  taken_ = 0;
}

schema::Result<void> BlockTimeFilter::push(std::span<const double> values, std::vector<double>& out) {
  const auto odd = std::ranges::find_if(values, [](double value) { return !std::isfinite(value); });
  if (odd != values.end()) {
    const auto index = taken_ + static_cast<std::size_t>(odd - values.begin());
    reset();
    return schema::fail(schema::ErrorKind::unsuitable,
                        fmt::format("value {} of the time range is not a finite number", index), {},
                        "repair the recording, or end the time range before it");
  }
  taken_ += values.size();
  for (std::size_t i = 0; i + 1 < stages_.size(); ++i) {
    next_.clear();
    stages_[i]->push(values, next_);
    std::swap(between_, next_);
    values = between_;
  }
  if (stages_.empty())
    out.insert(out.end(), values.begin(), values.end());
  else
    stages_.back()->push(values, out);
  return {};
}

void BlockTimeFilter::finish(std::vector<double>& out) {
  between_.clear();
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    next_.clear();
    std::vector<double>& into = i + 1 == stages_.size() ? out : next_;
    stages_[i]->push(between_, into);
    stages_[i]->finish(into);
    std::swap(between_, next_);
  }
  taken_ = 0;
}

}  // namespace tacto::spatial
