#include "cyclic/harmonic_coordinates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cyclic/mirror.hpp"
#include "cyclic/turn.hpp"

namespace chladni::cyclic {

namespace {

using Eigen::Matrix3d;
using Triplets = std::vector<Eigen::Triplet<double>>;

int order_of(int place)
{
  return (place + 1) / 2;
}

bool is_sine(int place)
{
  return place > 0 && place % 2 == 0;
}

/// Writes the coordinates one block after the other.
class Builder {
 public:
  Builder(const SectorDofs& sector, int order)
      : sector_(sector),
        order_(order),
        mu_(2.0 * std::numbers::pi * order / sector.count),
        one_phase_(has_one_phase(order, sector.count)),
        is_done_(static_cast<std::size_t>(sector.n_blocks), false)
  {}

  HarmonicCoordinates build() &&
  {
    for (int i = 0; i < std::ssize(sector_.axis); ++i) add_axis(i);
    for (int i = 0; i < std::ssize(sector_.rings); ++i) add_ring(i);
    std::vector<std::array<int, 2>> followers;
    for (const auto& pair : sector_.edges) {
      if (is_done_[static_cast<std::size_t>(pair[1])]) continue;
      followers.push_back(pair);
      is_done_[static_cast<std::size_t>(pair[1])] = true;
    }
    std::vector<int> first(static_cast<std::size_t>(sector_.n_blocks), -1);
    for (int block = 0; block < sector_.n_blocks; ++block)
      if (!is_done_[static_cast<std::size_t>(block)]) first[std::size_t(block)] = add_own(block);
    for (const auto& [low, high] : followers) add_follower(first[std::size_t(low)], high);
    HarmonicCoordinates c{.order = order_,
                          .count = sector_.count,
                          .weight = sector_.count * (one_phase_ ? 1.0 : 0.5),
                          .X = rows_of(x_),
                          .Y = rows_of(y_),
                          .masters = std::move(masters_),
                          .partner = std::move(partner_),
                          .sign = std::move(sign_),
                          .origins = std::move(origins_)};
    if (sector_.mirror && !one_phase_) c.symmetric = symmetric_motions(c, sector_);
    return c;
  }

 private:
  int n_components() const { return static_cast<int>(sector_.components.size()); }
  int row(int block, int i) const { return block * n_components() + i; }
  /// Place of a component in a block; -1 where it is held.
  int place_of(int component) const
  {
    const auto it = std::ranges::find(sector_.components, component);
    return it == sector_.components.end() ? -1 : static_cast<int>(it - sector_.components.begin());
  }

  int new_coordinate(const CoordinateOrigin& origin)
  {
    origins_.push_back(origin);
    partner_.push_back(-1);
    sign_.push_back(0.0);
    return static_cast<int>(partner_.size()) - 1;
  }

  /// J takes a to b, and b to -a, if s = 1.
  void pair(int a, int b, double s)
  {
    partner_[std::size_t(b)] = a;
    sign_[std::size_t(b)] = s;
    partner_[std::size_t(a)] = b;
    sign_[std::size_t(a)] = -s;
  }

  void put(Triplets& to, int block, int i, int coordinate, double value)
  {
    if (value != 0.0) to.emplace_back(row(block, i), coordinate, value);
  }

  /// A node with coordinates of its own: x, then y.
  int add_own(int block)
  {
    const int first = static_cast<int>(partner_.size());
    const int n = n_components();
    const auto new_one = [&](int i, bool of_y) {
      return new_coordinate({.block = block,
                             .place = 0,
                             .component = sector_.components[std::size_t(i)],
                             .of_y = of_y});
    };
    for (int i = 0; i < n; ++i) put(x_, block, i, new_one(i, false), 1.0);
    if (one_phase_) return first;
    for (int i = 0; i < n; ++i) {
      put(y_, block, i, new_one(i, true), 1.0);
      pair(first + i, first + n + i, 1.0);  // x' = -y, y' = x
    }
    return first;
  }

  /// exp(i mu) R times the node at the other cut edge.
  void add_follower(int first, int block)
  {
    const int n = n_components();
    const Matrix3d R = turn_of_sector(1, sector_.count);
    const double c = std::cos(mu_), s = one_phase_ ? 0.0 : std::sin(mu_);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const double R_ij = entry(R, i, j);
        put(x_, block, i, first + j, c * R_ij);
        if (one_phase_) continue;
        put(x_, block, i, first + n + j, -s * R_ij);
        put(y_, block, i, first + j, s * R_ij);
        put(y_, block, i, first + n + j, c * R_ij);
      }
    }
  }

  /// Of diag(R, R), between places of a block.
  double entry(const Matrix3d& R, int i, int j) const
  {
    const int a = sector_.components[std::size_t(i)], b = sector_.components[std::size_t(j)];
    return a / 3 == b / 3 ? R(a % 3, b % 3) : 0.0;
  }

  /// Nodes on the axis move along and about it with harmonic 0, across it with harmonic 1.
  void add_axis(int index)
  {
    const int block = sector_.axis[std::size_t(index)];
    is_done_[std::size_t(block)] = true;
    for (int component = 0; component < 6; ++component) {
      const int i = place_of(component);
      const bool is_along = component % 3 == 2;
      if (i < 0 || order_ != (is_along ? 0 : 1)) continue;
      const int coordinate =
          new_coordinate({.block = block, .place = 0, .component = component, .of_y = false});
      masters_.push_back(
          {.ring = -1, .place = index, .component = component, .coordinate = coordinate});
      put(x_, block, i, coordinate, 1.0);
      if (is_along) continue;
      // (x, y) of the node: along x with (e_x, e_y), along y with (e_y, -e_x).
      const bool is_x = component % 3 == 0;
      put(y_, block, place_of(is_x ? component + 1 : component - 1), coordinate, is_x ? 1.0 : -1.0);
      if (!is_x) pair(coordinate - 1, coordinate, -1.0);
    }
  }

  /// Whether a harmonic of a ring belongs to this one; and with which sense it runs.
  bool belongs(int ring_order, double& sense) const
  {
    const int rest = ring_order % sector_.count;
    sense = rest == order_ ? 1.0 : -1.0;
    return rest == order_ || (sector_.count - rest) % sector_.count == order_;
  }

  void add_ring(int index)
  {
    const Ring& ring = sector_.rings[std::size_t(index)];
    for (const int block : ring.blocks) is_done_[std::size_t(block)] = true;
    for (int place = 0; place < ring.n_nodes; ++place) {
      double sense = 1.0;
      if (!belongs(order_of(place), sense)) continue;
      const int first = static_cast<int>(partner_.size());
      for (int j = 0; j < n_components(); ++j) {
        const int component = sector_.components[std::size_t(j)];
        const int coordinate =
            new_coordinate({.block = -1, .place = place, .component = component, .of_y = false});
        if (order_of(place) <= ring.up_to) {
          masters_.push_back(
              {.ring = index, .place = place, .component = component, .coordinate = coordinate});
        }
        // c_cos' = sense c_sin, c_sin' = -sense c_cos
        if (is_sine(place) && !one_phase_) pair(coordinate - n_components(), coordinate, -sense);
      }
      add_harmonic(ring, place, first, sense);
    }
  }

  void add_harmonic(const Ring& ring, int place, int first, double sense)
  {
    const int d = order_of(place);
    const bool is_highest = 2 * d == ring.n_nodes;
    const double length = std::sqrt((d == 0 || is_highest ? 1.0 : 2.0) / ring.n_nodes);
    for (std::size_t k = 0; k < ring.blocks.size(); ++k) {
      const double phase = d * (ring.angles[k] - (is_highest ? ring.first_angle : 0.0));
      const double cosine = length * std::cos(phase), sine = length * std::sin(phase);
      const Matrix3d E = turn(ring.angles[k]);
      for (int i = 0; i < n_components(); ++i) {
        for (int j = 0; j < n_components(); ++j) {
          const double E_ij = entry(E, i, j);
          put(x_, ring.blocks[k], i, first + j, (is_sine(place) ? sine : cosine) * E_ij);
          if (one_phase_) continue;
          put(y_, ring.blocks[k], i, first + j, sense * (is_sine(place) ? -cosine : sine) * E_ij);
        }
      }
    }
  }

  SparseRows rows_of(const Triplets& entries) const
  {
    SparseRows rows(sector_.n_dofs(), static_cast<int>(partner_.size()));
    rows.setFromTriplets(entries.begin(), entries.end());
    return rows;
  }

  const SectorDofs& sector_;
  int order_;
  double mu_;
  bool one_phase_;
  std::vector<bool> is_done_;
  Triplets x_, y_;
  std::vector<Master> masters_;
  std::vector<int> partner_;
  std::vector<double> sign_;
  std::vector<CoordinateOrigin> origins_;
};

}  // namespace

HarmonicCoordinates harmonic_coordinates(const SectorDofs& sector, int order)
{
  return Builder(sector, order).build();
}

SparseRows times_quarter_turn(const SparseRows& A, const HarmonicCoordinates& c)
{
  // Row i of J has sign[i] in column partner[i].
  Triplets entries;
  entries.reserve(std::size_t(A.nonZeros()));
  for (int row = 0; row < A.outerSize(); ++row) {
    for (SparseRows::InnerIterator it(A, row); it; ++it) {
      const auto i = static_cast<std::size_t>(it.index());
      entries.emplace_back(row, c.partner[i], it.value() * c.sign[i]);
    }
  }
  SparseRows sorted(A.rows(), A.cols());
  sorted.setFromTriplets(entries.begin(), entries.end());
  return sorted;
}

}  // namespace chladni::cyclic
