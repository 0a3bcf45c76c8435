// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/fourier/cosine_transform.hpp"

#include <cassert>
#include <utility>

#include "spatial/dsp/fourier/fftw_parts.hpp"

namespace tacto::spatial {
namespace {

void transform(std::span<double> values, GridSize size, fftw_r2r_kind kind) {
  assert(values.size() == size.columns * size.rows && !values.empty());
  const int rows = static_cast<int>(size.rows), columns = static_cast<int>(size.columns);
  std::unique_lock lock(planner_mutex());
  const fftw_plan plan =
      fftw_plan_r2r_2d(rows, columns, values.data(), values.data(), kind, kind, FFTW_ESTIMATE);
  lock.unlock();
  fftw_execute(plan);
  lock.lock();
  fftw_destroy_plan(plan);
}

}  // namespace

// FFTW's sums have a factor of 2 for each axis.
void to_cosines(std::span<double> values, GridSize size) {
  transform(values, size, FFTW_REDFT10);
  for (double& value : values) value *= 0.25;
}

void from_cosines(std::span<double> values, GridSize size) {
  transform(values, size, FFTW_REDFT01);
  const double scale = 1 / static_cast<double>(values.size());
  for (double& value : values) value *= scale;
}

}  // namespace tacto::spatial
