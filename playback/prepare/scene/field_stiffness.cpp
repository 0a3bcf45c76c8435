// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/field_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <queue>
#include <utility>

namespace tacto::playback {
namespace {

constexpr double kTolerance = 1.02;  // of the bound, above a stiffness that was found
constexpr double kFrozenPart =
    0.005;  // of that stiffness: the widths of all atoms that are not computed again
constexpr std::size_t kMostWork = 6'000'000;  // evaluations of an atom
constexpr std::size_t kWorkOfCell = 10;       // as many evaluations as handling a cell takes
constexpr double kRounding = 1e-9;            // relative, far above that of the sums
constexpr int kSeedAtoms = 64, kDirections = 8;

struct Interval {
  double low = 0, high = 0;

  void add(const Interval& other) { low += other.low, high += other.high; }
  void remove(const Interval& other) { low -= other.low, high -= other.high; }
  void include(double value) { low = std::min(low, value), high = std::max(high, value); }
  double width() const { return high - low; }
  double middle() const { return low + width() / 2; }
  double most() const { return std::max(std::abs(low), std::abs(high)); }
  double least() const { return std::max({low, -high, 0.0}); }
  Interval from(double place) const { return {low - place, high - place}; }
  Interval squared() const { return {least() * least(), most() * most()}; }
};

// -dF/dplace is symmetric, because each force is along the distance: (mean + by_axis, cross; cross, mean -
// by_axis), each with its limits in a box.
struct Stiffness {
  Interval mean, by_axis, cross;

  void add(const Stiffness& other) {
    mean.add(other.mean), by_axis.add(other.by_axis), cross.add(other.cross);
  }
  void remove(const Stiffness& other) {
    mean.remove(other.mean), by_axis.remove(other.by_axis), cross.remove(other.cross);
  }
  double width() const { return mean.width() + by_axis.width() + cross.width(); }
  Interval eigenvalues() const {
    const double apart = std::hypot(by_axis.most(), cross.most());
    return {mean.low - apart, mean.high + apart};
  }
  // What the larger of the two, absolute, has at least.
  double least() const { return mean.least() + std::hypot(by_axis.least(), cross.least()); }
};

// Of one atom; its eigenvalues have narrower limits than those that follow from the matrix.
struct AtomStiffness {
  Stiffness matrix;
  Interval eigenvalues;
};

struct Box {
  Interval x, y, z;

  Box centre() const {
    return {{x.middle(), x.middle()}, {y.middle(), y.middle()}, {z.middle(), z.middle()}};
  }
  std::pair<Box, Box> halves() const {
    std::pair<Box, Box> made{*this, *this};
    const double longest = std::max({x.width(), y.width(), z.width()});
    Interval Box::*const side = x.width() == longest ? &Box::x : y.width() == longest ? &Box::y : &Box::z;
    (made.first.*side).high = (made.second.*side).low = (this->*side).middle();
    return made;
  }
};

// Of a s^7 - b s^4 with a, b >= 0, which falls up to s^3 = 4 b / 7 a and then grows.
Interval of_lennard_jones(double a, double b, double turn, const Interval& s) {
  const auto at = [&](double of) {
    const double s4 = of * of * of * of;
    return s4 * (a * of * of * of - b);
  };
  Interval found{at(s.low), at(s.low)};
  found.include(at(s.high));
  if (s.low < turn && turn < s.high) found.include(at(turn));
  return found;
}

Interval of_coulomb(double factor, const Interval& s) {
  const double low = factor * s.low * std::sqrt(s.low), high = factor * s.high * std::sqrt(s.high);
  return {std::min(low, high), std::max(low, high)};
}

// With s = sigma^2 / d^2 the force is F = g d, g = L (2 s^7 - s^4) + C s^1.5. Its derivative has in space the
// eigenvalue R = L (26 s^7 - 7 s^4) + 2 C s^1.5 along d and T = -g across; in the plane, where d has the part
// c = (dx^2 + dy^2) / d^2, c R + (1 - c) T and T. In the core both are T at its border.
AtomStiffness stiffness_in(const Box& box, const SectionAtom& atom, double core) {
  static const double kTurnAlong = std::cbrt(2.0 / 13), kTurnAcross = std::cbrt(2.0 / 7);
  const Interval dx = box.x.from(atom.x_m), dy = box.y.from(atom.y_m), dz = box.z.from(atom.z_m);
  const Interval x2 = dx.squared(), y2 = dy.squared(), z2 = dz.squared();
  const double sigma2 = atom.sigma_m * atom.sigma_m, core2 = core * core * sigma2;
  const double nearest2 = x2.low + y2.low + z2.low, farthest2 = x2.high + y2.high + z2.high;
  const Interval square{std::max(nearest2, core2), std::max(farthest2, core2)};
  const Interval s{sigma2 / square.high, sigma2 / square.low};
  const double jones = atom.lennard_jones_n_per_m, coulomb = atom.coulomb_n_per_m;
  Interval along = of_lennard_jones(26 * jones, 7 * jones, kTurnAlong, s);
  along.add(of_coulomb(2 * coulomb, s));
  Interval across = of_lennard_jones(2 * jones, jones, kTurnAcross, s);
  across.add(of_coulomb(coulomb, s));
  across = {-across.high, -across.low};
  if (farthest2 <= core2) return {{across, {}, {}}, across};
  const bool meets_core = nearest2 <= core2;
  // The differences of R and T, halved, times parts of d^2 that are within -1 and 1.
  Interval apart = of_lennard_jones(14 * jones, 4 * jones, kTurnAcross, s);
  apart.add(of_coulomb(1.5 * coulomb, s));
  const auto times = [&](const Interval& part) {
    Interval made{apart.low * part.low, apart.low * part.low};
    made.include(apart.low * part.high), made.include(apart.high * part.low);
    made.include(apart.high * part.high);
    if (meets_core) made.include(0);
    return made;
  };
  const auto ratio = [](double above, double beside) {  // above / (above + beside)
    return above + beside > 0 ? above / (above + beside) : 1;
  };
  const Interval in_plane{meets_core ? 0 : ratio(x2.low + y2.low, z2.high), ratio(x2.high + y2.high, z2.low)};
  const auto difference = [](double a, double b, double more, double less) {
    const double top = a - b, bottom = a + b + (top > 0 ? more : less);
    return bottom > 0 ? top / bottom : 0;
  };
  const Interval by_axis{difference(x2.low, y2.high, z2.high, z2.low),
                         difference(x2.high, y2.low, z2.low, z2.high)};
  Interval product{dx.low * dy.low, dx.low * dy.low};
  product.include(dx.low * dy.high), product.include(dx.high * dy.low), product.include(dx.high * dy.high);
  const Interval cross{std::max(product.low / (product.low < 0 ? square.low : square.high), -0.5),
                       std::min(product.high / (product.high > 0 ? square.low : square.high), 0.5)};
  AtomStiffness made;
  made.matrix = {across, times(by_axis), times({2 * cross.low, 2 * cross.high})};
  made.matrix.mean.add(times(in_plane));
  const auto mixed = [](double part, double one, double other) { return part * one + (1 - part) * other; };
  made.eigenvalues = {std::min({across.low, mixed(in_plane.low, along.low, across.low),
                                mixed(in_plane.high, along.low, across.low)}),
                      std::max({across.high, mixed(in_plane.low, along.high, across.high),
                                mixed(in_plane.high, along.high, across.high)})};
  return made;
}

using Atoms = std::vector<std::uint32_t>;

// A part of the section, and what its stiffness is at most.
struct Cell {
  Box box;
  Stiffness frozen;  // the sum over atoms that are not in `atoms`
  double frozen_width = 0;
  std::shared_ptr<const Atoms> atoms;
  double bound = INFINITY;

  bool operator<(const Cell& other) const { return bound < other.bound; }
};

// Divides the section where its bound is the largest, until a stiffness that was found is near.
class StiffnessSearch {
 public:
  explicit StiffnessSearch(const FieldSection& section) : section_(section) {}

  double bound(const Box& whole) {
    Atoms all(section_.atoms.size());
    std::iota(all.begin(), all.end(), 0);
    add_seeds(whole, all);
    take({whole, {}, 0, std::make_shared<const Atoms>(std::move(all)), INFINITY});
    while (!cells_.empty() && cells_.top().bound > kTolerance * found_ && work_ < kMostWork) {
      const Cell cell = cells_.top();
      cells_.pop();
      const auto [first, second] = cell.box.halves();
      take({first, cell.frozen, cell.frozen_width, cell.atoms, cell.bound});
      take({second, cell.frozen, cell.frozen_width, cell.atoms, cell.bound});
    }
    const double rest = cells_.empty() ? 0 : cells_.top().bound;
    return std::max(rest, left_out_) * (1 + kRounding);
  }

 private:
  AtomStiffness of_atom(const Box& box, std::uint32_t atom) {
    ++work_;
    return stiffness_in(box, section_.atoms[atom], section_.core);
  }

  double found_at(const Box& place, Stiffness sum, const Atoms& atoms) {
    for (const std::uint32_t atom : atoms) sum.add(of_atom(place, atom).matrix);
    return sum.least();
  }

  // Just outside of the cores of the stiffest atoms.
  void add_seeds(const Box& whole, const Atoms& all) {
    Atoms stiffest = all;
    const auto count = std::min<std::size_t>(all.size(), kSeedAtoms);
    const auto own = [&](std::uint32_t atom) {
      const SectionAtom& of = section_.atoms[atom];
      return of.lennard_jones_n_per_m + std::abs(of.coulomb_n_per_m);
    };
    std::ranges::partial_sort(stiffest, stiffest.begin() + static_cast<std::ptrdiff_t>(count),
                              [&](std::uint32_t a, std::uint32_t b) { return own(a) > own(b); });
    for (std::size_t i = 0; i < count; ++i) add_seeds_of(section_.atoms[stiffest[i]], whole, all);
  }

  void add_seeds_of(const SectionAtom& atom, const Box& whole, const Atoms& all) {
    const double z_m = std::clamp(atom.z_m, whole.z.low, whole.z.high), dz = z_m - atom.z_m,
                 core_m = section_.core * atom.sigma_m * (1 + kRounding);
    const double radius_m = std::sqrt(std::max(core_m * core_m - dz * dz, 0.0));
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * std::numbers::pi * i / kDirections,
                   x_m = atom.x_m + radius_m * std::cos(angle), y_m = atom.y_m + radius_m * std::sin(angle);
      if (x_m < whole.x.low || x_m > whole.x.high || y_m < whole.y.low || y_m > whole.y.high) continue;
      found_ = std::max(found_, found_at({{x_m, x_m}, {y_m, y_m}, {z_m, z_m}}, {}, all));
    }
  }

  // By the matrices of all atoms, or by the eigenvalues of one, which is the widest, and the matrices of the
  // others: the eigenvalues of a sum are within the sums of the least and of the largest.
  void take(Cell cell) {
    work_ += kWorkOfCell;
    Stiffness sum = cell.frozen;
    Atoms kept;
    AtomStiffness widest;
    const double allowed =
        (kFrozenPart * found_ - cell.frozen_width) / (2 * static_cast<double>(cell.atoms->size()));
    for (const std::uint32_t atom : *cell.atoms) {
      const AtomStiffness one = of_atom(cell.box, atom);
      const double width = one.matrix.width();
      sum.add(one.matrix);
      if (width > widest.matrix.width()) widest = one;
      if (width > allowed)
        kept.push_back(atom);
      else
        cell.frozen.add(one.matrix), cell.frozen_width += width;
    }
    cell.bound = std::min(cell.bound, sum.eigenvalues().most());
    sum.remove(widest.matrix);
    Interval apart = sum.eigenvalues();
    apart.add(widest.eigenvalues);
    cell.bound = std::min(cell.bound, apart.most());
    if (cell.bound > kTolerance * found_)
      found_ = std::max(found_, found_at(cell.box.centre(), cell.frozen, kept));
    if (kept.size() < cell.atoms->size()) cell.atoms = std::make_shared<const Atoms>(std::move(kept));
    if (cell.bound > kTolerance * found_)
      cells_.push(std::move(cell));
    else
      left_out_ = std::max(left_out_, cell.bound);
  }

  const FieldSection& section_;
  std::priority_queue<Cell> cells_;
  double found_ = 0;
  double left_out_ = 0;  // the largest bound of a cell that is not divided
  std::size_t work_ = 0;
};

}  // namespace

double stiffest_n_per_m(const FieldSection& section, const schema::LayerNumber& z_m,
                        const schema::Patch& patch) {
  const double x_m = patch.width_m / 2, y_m = patch.height_m / 2;
  return StiffnessSearch(section).bound({{-x_m, x_m}, {-y_m, y_m}, {least_value(z_m), largest_value(z_m)}});
}

}  // namespace tacto::playback
