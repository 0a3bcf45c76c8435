// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/block_time_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tacto::spatial {

class BlockTimeFilter::Stage {
 public:
  Stage(double sample_rate_hz, TimeFilter filter, SpectralGain equaliser)
      : sample_rate_hz_(sample_rate_hz), filter_(filter), equaliser_(std::move(equaliser)) {}
  void push(std::span<const double> values) { held_.insert(held_.end(), values.begin(), values.end()); }
  void finish(std::vector<double>& out) {
    if (const auto filtered = filter_in_time(held_, sample_rate_hz_, filter_, equaliser_))
      out.insert(out.end(), filtered->begin(), filtered->end());
    held_.clear();
  }
  void drop() { held_.clear(); }

 private:
  double sample_rate_hz_;
  TimeFilter filter_;
  SpectralGain equaliser_;
  std::vector<double> held_;
};

BlockTimeFilter::BlockTimeFilter(std::vector<std::unique_ptr<Stage>> stages) : stages_(std::move(stages)) {}
BlockTimeFilter::BlockTimeFilter(BlockTimeFilter&&) noexcept = default;
BlockTimeFilter& BlockTimeFilter::operator=(BlockTimeFilter&&) noexcept = default;
BlockTimeFilter::~BlockTimeFilter() = default;

schema::Result<BlockTimeFilter> BlockTimeFilter::open(double sample_rate_hz, const TimeFilter& filter,
                                                      const SpectralGain& equaliser, std::size_t) {
  if (const auto fine = check(filter, sample_rate_hz); !fine) return schema::forward_error(fine);
  std::vector<std::unique_ptr<Stage>> stages;
  stages.push_back(std::make_unique<Stage>(sample_rate_hz, filter, equaliser));
  return BlockTimeFilter(std::move(stages));
}

schema::Result<void> BlockTimeFilter::push(std::span<const double> values, std::vector<double>&) {
  const auto odd = std::ranges::find_if(values, [](double value) { return !std::isfinite(value); });
  if (odd != values.end()) {
    const auto index = taken_ + static_cast<std::size_t>(odd - values.begin());
    for (auto& stage : stages_) stage->drop();
    taken_ = 0;
    return schema::fail(schema::Fault::unsuitable,
                        fmt::format("value {} of the stretch is not a finite number", index));
  }
  taken_ += values.size();
  for (auto& stage : stages_) stage->push(values);
  return {};
}

void BlockTimeFilter::finish(std::vector<double>& out) {
  for (auto& stage : stages_) stage->finish(out);
  taken_ = 0;
}

}  // namespace tacto::spatial
