// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/trace.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::spatial {
namespace {

// The samples of one column, in order.
class Column {
 public:
  Column(std::vector<Point>& out, double columns_per_point) : out_(out), per_point_(columns_per_point) {}

  void add(std::size_t index, Point point) {
    const auto column = static_cast<long>(std::floor(point.x * per_point_));
    if (count_ > 0 && column != column_) flush();
    const Kept kept{index, point};
    if (count_ == 0) first_ = top_ = bottom_ = kept;
    if (point.y < top_.point.y) top_ = kept;
    if (point.y > bottom_.point.y) bottom_ = kept;
    last_ = kept;
    column_ = column;
    ++count_;
  }

  void flush() {
    if (count_ == 0) return;
    Kept kept[] = {first_, top_, bottom_, last_};
    std::ranges::sort(kept, {}, &Kept::index);
    for (std::size_t i = 0; i < std::size(kept); ++i)
      if (i == 0 || kept[i].index != kept[i - 1].index) out_.push_back(kept[i].point);
    count_ = 0;
  }

 private:
  struct Kept {
    std::size_t index = 0;
    Point point;
  };
  std::vector<Point>& out_;
  double per_point_;
  Kept first_, top_, bottom_, last_;
  long column_ = 0;
  std::size_t count_ = 0;
};

bool drawable(Point point) {
  return std::isfinite(point.x) && std::isfinite(point.y);
}

}  // namespace

std::vector<std::vector<Point>> trace(std::span<const double> x, std::span<const double> y,
                                      const Axis& x_axis, const Axis& y_axis, double columns_per_point) {
  std::vector<std::vector<Point>> pieces;
  for (std::size_t i = 0; i < x.size();) {
    std::vector<Point> piece;
    Column column(piece, columns_per_point);
    for (; i < x.size(); ++i) {
      const Point point{x_axis.place(x[i]), y_axis.place(y[i])};
      if (!drawable(point)) break;
      column.add(i, point);
    }
    column.flush();
    if (!piece.empty()) pieces.push_back(std::move(piece));
    while (i < x.size() && !drawable({x_axis.place(x[i]), y_axis.place(y[i])})) ++i;
  }
  return pieces;
}

}  // namespace tacto::spatial
