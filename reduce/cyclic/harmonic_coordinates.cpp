#include "reduce/cyclic/harmonic_coordinates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "reduce/cyclic/sector.hpp"

namespace chladni::cyclic {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

namespace {

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
  /// Place of a component in a block; -1 where it is held or in another one.
  int place_of(int block, int component) const
  {
    for (int i = 0; i < n_components(); ++i)
      if (sector_.component(block, i) == component) return i;
    return -1;
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
      return new_coordinate(
          {.block = block, .place = 0, .component = sector_.component(block, i), .of_y = of_y});
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
    add_axis_block(index, sector_.axis[std::size_t(index)]);
    if (sector_.axis_rotations.empty()) return;
    const int rotations = sector_.axis_rotations[std::size_t(index)];
    if (rotations >= 0) add_axis_block(index, rotations);
  }

  void add_axis_block(int index, int block)
  {
    is_done_[std::size_t(block)] = true;
    for (int component = 0; component < 6; ++component) {
      const int i = place_of(block, component);
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
      put(y_, block, place_of(block, is_x ? component + 1 : component - 1), coordinate,
          is_x ? 1.0 : -1.0);
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

// Eigen's product of three sparse matrices sorts each of its steps by two transpositions; here each
// row is summed once, and only what stands on and above the diagonal.

namespace {

/// The sum of sparse rows of one length.
class RowSum {
 public:
  explicit RowSum(Eigen::Index n) : value_(std::size_t(n)), row_(std::size_t(n), -1) {}

  void begin(int row)
  {
    current_ = row;
    columns_.clear();
  }

  void add(int column, double value)
  {
    const auto j = static_cast<std::size_t>(column);
    if (row_[j] == current_) {
      value_[j] += value;
      return;
    }
    row_[j] = current_;
    value_[j] = value;
    columns_.push_back(column);
  }

  std::vector<int>& columns() { return columns_; }
  double operator[](int column) const { return value_[std::size_t(column)]; }

 private:
  int current_ = -1;
  std::vector<double> value_;
  std::vector<int> row_;  ///< to which the value belongs
  std::vector<int> columns_;
};

/// Rows of a matrix one after the other, the columns of each in any order.
struct Rows {
  std::vector<std::size_t> start{0};
  std::vector<int> columns;
  std::vector<double> values;

  void push_back(const RowSum& sum, const std::vector<int>& of_row)
  {
    for (const int column : of_row) {
      columns.push_back(column);
      values.push_back(sum[column]);
    }
    start.push_back(columns.size());
  }
};

Rows product(const SparseRows& A, const SparseRows& T)
{
  Rows AT;
  RowSum sum(T.cols());
  for (int row = 0; row < A.outerSize(); ++row) {
    sum.begin(row);
    for (SparseRows::InnerIterator a(A, row); a; ++a)
      for (SparseRows::InnerIterator t(T, a.index()); t; ++t)
        sum.add(int(t.index()), a.value() * t.value());
    AT.push_back(sum, sum.columns());
  }
  return AT;
}

/// A phase and what a form makes of it.
struct Phase {
  SparseRows transposed;
  Rows of_form;
};

/// The sum over the phases T of T^T A T, on and above the diagonal, which comes first in its row.
Rows upper_triangle(const std::vector<Phase>& phases, Eigen::Index n)
{
  Rows upper;
  RowSum sum(n);
  for (int row = 0; row < n; ++row) {
    sum.begin(row);
    sum.add(row, 0.0);
    for (const auto& [transposed, AT] : phases) {
      for (SparseRows::InnerIterator t(transposed, row); t; ++t) {
        const auto k = static_cast<std::size_t>(t.index());
        for (std::size_t e = AT.start[k]; e < AT.start[k + 1]; ++e)
          if (AT.columns[e] >= row) sum.add(AT.columns[e], t.value() * AT.values[e]);
      }
    }
    upper.push_back(sum, sum.columns());
  }
  return upper;
}

/// The entries by column, rows ascending: the lower triangle. What is round-off beside the
/// diagonals is left out.
Rows transposed(const Rows& upper)
{
  constexpr double round_off = 1e-14;
  const auto n = upper.start.size() - 1;
  std::vector<double> scale(n);
  for (std::size_t i = 0; i < n; ++i) scale[i] = std::sqrt(std::abs(upper.values[upper.start[i]]));
  const auto for_entries = [&](const auto& visit) {
    for (std::size_t row = 0; row < n; ++row) {
      for (std::size_t e = upper.start[row]; e < upper.start[row + 1]; ++e) {
        const auto column = static_cast<std::size_t>(upper.columns[e]);
        const double least = round_off * scale[row] * scale[column];
        if (column == row || std::abs(upper.values[e]) > least) visit(row, column, upper.values[e]);
      }
    }
  };
  Rows lower;
  lower.start.assign(n + 1, 0);
  for_entries([&](std::size_t, std::size_t column, double) { ++lower.start[column + 1]; });
  std::partial_sum(lower.start.begin(), lower.start.end(), lower.start.begin());
  lower.columns.resize(lower.start.back());
  lower.values.resize(lower.start.back());
  std::vector<std::size_t> place(lower.start.begin(), lower.start.end() - 1);
  for_entries([&](std::size_t row, std::size_t column, double value) {
    const std::size_t at = place[column]++;
    lower.columns[at] = static_cast<int>(row);
    lower.values[at] = value;
  });
  return lower;
}

/// Both triangles of `factor` times the matrix, columns ascending without any sorting: a row has
/// its entries up to the diagonal at once, and the others from later rows in their order.
SparseRows symmetric(const Rows& lower, double factor)
{
  const auto n = static_cast<int>(lower.start.size()) - 1;
  std::vector<int> place(std::size_t(n) + 1, 0);
  for (std::size_t row = 0; row < std::size_t(n); ++row) {
    for (std::size_t e = lower.start[row]; e < lower.start[row + 1]; ++e) {
      ++place[row + 1];
      if (std::cmp_not_equal(lower.columns[e], row)) ++place[std::size_t(lower.columns[e]) + 1];
    }
  }
  std::partial_sum(place.begin(), place.end(), place.begin());
  SparseRows form(n, n);
  form.resizeNonZeros(place.back());
  std::ranges::copy(place, form.outerIndexPtr());
  const auto put = [&](int row, int column, double value) {
    const int at = place[std::size_t(row)]++;
    form.innerIndexPtr()[at] = column;
    form.valuePtr()[at] = factor * value;
  };
  for (int row = 0; row < n; ++row) {
    for (std::size_t e = lower.start[std::size_t(row)]; e < lower.start[std::size_t(row) + 1];
         ++e) {
      put(row, lower.columns[e], lower.values[e]);
      if (lower.columns[e] != row) put(lower.columns[e], row, lower.values[e]);
    }
  }
  return form;
}

}  // namespace

SparseRows harmonic_form(const SparseRows& A, const HarmonicCoordinates& c)
{
  std::vector<Phase> phases;
  for (const SparseRows* T : {&c.X, &c.Y})
    if (T->nonZeros() > 0) phases.push_back({SparseRows(T->transpose()), product(A, *T)});
  return symmetric(transposed(upper_triangle(phases, c.n())), c.weight);
}

SparseRows sparse_rows(Mat A)
{
  PetscInt n_rows = 0, n_cols = 0, n = 0;
  PetscBool is_done = PETSC_FALSE;
  const PetscInt *start = nullptr, *columns = nullptr;
  const PetscScalar* values = nullptr;
  petsc::check(MatGetSize(A, &n_rows, &n_cols));
  petsc::check(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &start, &columns, &is_done));
  if (!is_done) throw Error("a sector needs a matrix of type AIJ on one rank");
  petsc::check(MatSeqAIJGetArrayRead(A, &values));
  SparseRows copy =
      Eigen::Map<const SparseRows>(n_rows, n_cols, start[n_rows], start, columns, values);
  petsc::check(MatSeqAIJRestoreArrayRead(A, &values));
  petsc::check(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &start, &columns, &is_done));
  return copy;
}

petsc::Matrix as_matrix(const SparseRows& A, Symmetry symmetry, MPI_Comm comm)
{
  petsc::Matrix matrix;
  const auto n_rows = static_cast<PetscInt>(A.rows()), n_cols = static_cast<PetscInt>(A.cols());
  PetscInt n_own = PETSC_DECIDE, n_total = n_rows, first = 0;
  petsc::check(PetscSplitOwnership(comm, &n_own, &n_total));
  MPI_Exscan(&n_own, &first, 1, MPIU_INT, MPI_SUM, comm);
  if (petsc::rank(comm) == 0) first = 0;
  petsc::check(MatCreate(comm, matrix.put()));
  petsc::check(MatSetSizes(matrix, n_own, n_rows == n_cols ? n_own : PETSC_DECIDE, n_rows, n_cols));
  petsc::check(MatSetType(matrix, MATAIJ));
  std::vector<PetscInt> starts(A.outerIndexPtr() + first, A.outerIndexPtr() + first + n_own + 1);
  const PetscInt before = starts.front();
  for (PetscInt& start : starts) start -= before;
  const PetscInt* columns = A.innerIndexPtr() + before;
  const double* values = A.valuePtr() + before;
  petsc::check(MatSeqAIJSetPreallocationCSR(matrix, starts.data(), columns, values));
  petsc::check(MatMPIAIJSetPreallocationCSR(matrix, starts.data(), columns, values));
  if (symmetry == Symmetry::symmetric) {
    petsc::check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
    petsc::check(MatSetOption(matrix, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  }
  return matrix;
}

namespace {

std::vector<double> each_twice(const std::vector<double>& values)
{
  std::vector<double> twice;
  for (const double value : values) twice.insert(twice.end(), 2, value);
  return twice;
}

reduce::EigenvalueCount twice(reduce::EigenvalueCount count)
{
  count.expected *= 2;
  count.found *= 2;
  return count;
}

/// Masters of the half and their modes, each of these now and later.
MatrixXd spread(const MatrixXd& rows, const MatrixXd& masters, Index first_mode)
{
  const Index n_half = masters.cols(), n_m = masters.rows(), n_modes = rows.cols() - n_half;
  MatrixXd wide = MatrixXd::Zero(rows.rows(), n_m + 2 * n_modes);
  wide.leftCols(n_m) = rows.leftCols(n_half) * masters.transpose();
  for (Index k = 0; k < n_modes; ++k) wide.col(n_m + 2 * k + first_mode) = rows.col(n_half + k);
  return wide;
}

}  // namespace

HarmonicCoordinates symmetric_half(const HarmonicCoordinates& c)
{
  const SparseRows& B = c.symmetric;
  HarmonicCoordinates half{.order = c.order,
                           .count = c.count,
                           .weight = c.weight,
                           .X = SparseRows(c.X * B),
                           .Y = SparseRows(c.Y * B),
                           .masters = {},
                           .partner = {},
                           .sign = {},
                           .origins = {}};
  std::vector<bool> is_known(std::size_t(B.cols()), false);
  for (const Master& master : c.masters) {
    for (SparseRows::InnerIterator it(B, master.coordinate); it; ++it) {
      if (is_known[std::size_t(it.index())]) continue;
      is_known[std::size_t(it.index())] = true;
      half.masters.push_back(master);
      half.masters.back().coordinate = int(it.index());
    }
  }
  return half;
}

MasterHalves master_halves(const HarmonicCoordinates& c, const HarmonicCoordinates& half)
{
  const SparseRows& B = c.symmetric;
  std::vector<Index> place(std::size_t(B.cols()), -1);
  for (Index k = 0; k < std::ssize(half.masters); ++k)
    place[std::size_t(half.masters[std::size_t(k)].coordinate)] = k;
  const Index n_m = std::ssize(c.masters);
  MasterHalves masters{.now = MatrixXd::Zero(n_m, std::ssize(half.masters)),
                       .later = MatrixXd::Zero(n_m, std::ssize(half.masters))};
  for (Index i = 0; i < n_m; ++i) {
    const auto row = std::size_t(c.masters[std::size_t(i)].coordinate);
    for (SparseRows::InnerIterator it(B, Index(row)); it; ++it)
      masters.now(i, place[std::size_t(it.index())]) = it.value();
    for (SparseRows::InnerIterator it(B, c.partner[row]); it; ++it)
      masters.later(i, place[std::size_t(it.index())]) = c.sign[row] * it.value();
  }
  return masters;
}

MatrixXd unfolded_form(const MatrixXd& A, const MasterHalves& masters)
{
  const auto both = [&](const MatrixXd& half, Index first_mode) {
    const MatrixXd rows = spread(A, half, first_mode);
    return spread(rows.transpose(), half, first_mode).transpose().eval();
  };
  return both(masters.now, 0) + both(masters.later, 1);
}

SectorMotion unfolded_motion(const SectorMotion& half, const MasterHalves& masters)
{
  // A quarter of a period later (x, y) is (-y, x).
  return {.x = spread(half.x, masters.now, 0) - spread(half.y, masters.later, 1),
          .y = spread(half.y, masters.now, 0) + spread(half.x, masters.later, 1)};
}

reduce::Certificate unfolded_certificate(const reduce::Certificate& half)
{
  reduce::Certificate whole = half;
  for (auto member :
       {&reduce::Certificate::lambda, &reduce::Certificate::eta2, &reduce::Certificate::estimates,
        &reduce::Certificate::rounding, &reduce::Certificate::bounds})
    whole.*member = each_twice(half.*member);
  for (auto member : {&reduce::Certificate::fixed_interface, &reduce::Certificate::range,
                      &reduce::Certificate::complete})
    whole.*member = twice(half.*member);
  whole.n_zero = 2 * half.n_zero;
  return whole;
}

namespace {

Vector3d position(const Eigen::MatrixX3d& positions, int block)
{
  return positions.row(block).transpose();
}

/// Of displacements, at the plane through the z axis with this angle.
Matrix3d reflection(double angle)
{
  const Vector3d normal(-std::sin(angle), std::cos(angle), 0.0);
  return Matrix3d::Identity() - 2.0 * normal * normal.transpose();
}

/// Of two components of a node: rotations are turned by a reflection besides.
double reflection_entry(const Matrix3d& Q, int a, int b)
{
  if (a / 3 != b / 3) return 0.0;
  return (a < 3 ? 1.0 : -1.0) * Q(a % 3, b % 3);
}

/// The angle in the middle of the two cut edges, where they are straight.
std::optional<double> middle_angle(const SectorDofs& sector, const Eigen::MatrixX3d& positions)
{
  constexpr double placement = 1e-7;  // rad
  std::optional<double> angle;
  for (const auto& [low, high] : sector.edges) {
    const Vector3d x = position(positions, low);
    const double here = std::atan2(x.y(), x.x()) + std::numbers::pi / sector.count;
    if (angle && std::abs(std::remainder(here - *angle, 2.0 * std::numbers::pi)) > placement)
      return std::nullopt;
    if (!angle) angle = here;
  }
  return angle;
}

/// The block at each block's mirrored position; empty where there is none.
std::vector<int> images(const SectorDofs& sector, const Eigen::MatrixX3d& positions, double angle)
{
  constexpr double placement = 1e-6;
  const double tolerance = placement * positions.rowwise().norm().maxCoeff();
  std::vector<int> by_x(static_cast<std::size_t>(positions.rows()));
  std::iota(by_x.begin(), by_x.end(), 0);
  const auto x_of = [&](int block) { return positions(block, 0); };
  std::ranges::sort(by_x, {}, x_of);
  const Matrix3d Q = reflection(angle);
  std::vector<int> image;
  for (int block = 0; block < positions.rows(); ++block) {
    const Vector3d there = Q * position(positions, block);
    int nearest = -1;
    double least = tolerance;
    for (auto it = std::ranges::lower_bound(by_x, there.x() - tolerance, {}, x_of);
         it != by_x.end() && x_of(*it) <= there.x() + tolerance; ++it) {
      const double distance = (position(positions, *it) - there).norm();
      if (distance > least || sector.is_rotating(*it) != sector.is_rotating(block)) continue;
      least = distance;
      nearest = *it;
    }
    if (nearest < 0) return {};
    image.push_back(nearest);
  }
  return image;
}

/// S of the DOFs of the sector.
SparseRows reflection_of_dofs(const SectorDofs& sector, const Mirror& mirror)
{
  const Matrix3d Q = reflection(mirror.angle);
  const auto n_c = static_cast<int>(sector.components.size());
  Triplets entries;
  for (int block = 0; block < sector.n_blocks; ++block) {
    for (int i = 0; i < n_c; ++i) {
      for (int j = 0; j < n_c; ++j) {
        const int image = mirror.image[std::size_t(block)];
        const double value =
            reflection_entry(Q, sector.component(block, i), sector.component(image, j));
        if (value != 0.0) entries.emplace_back(n_c * block + i, n_c * image + j, value);
      }
    }
  }
  SparseRows S(sector.n_dofs(), sector.n_dofs());
  S.setFromTriplets(entries.begin(), entries.end());
  return S;
}

/// Whether S A S^T is A.
bool agrees(const SparseRows& A, const SparseRows& S)
{
  constexpr double same = 1e-9;
  const SparseRows difference = SparseRows(SparseRows(S * A) * SparseRows(S.transpose())) - A;
  const VectorXd scale = VectorXd(A.diagonal()).cwiseAbs().cwiseSqrt();
  for (int row = 0; row < difference.outerSize(); ++row)
    for (SparseRows::InnerIterator it(difference, row); it; ++it)
      if (std::abs(it.value()) > same * scale[row] * scale[it.index()]) return false;
  return true;
}

/// The reflection in the coordinates of a harmonic: of the sector (x, y) becomes (S x, -S y).
class Reflection {
 public:
  Reflection(const HarmonicCoordinates& c, const SectorDofs& sector)
      : c_(c), sector_(sector), Q_(reflection(sector.mirror->angle))
  {}

  SparseRows matrix() const
  {
    Triplets entries;
    for (int row = 0; row < c_.n(); ++row) {
      const CoordinateOrigin& origin = c_.origins[std::size_t(row)];
      if (origin.block >= 0)
        add_own(entries, row, origin);
      else
        add_harmonic(entries, row, origin);
    }
    SparseRows sigma(c_.n(), c_.n());
    sigma.setFromTriplets(entries.begin(), entries.end());
    return sigma;
  }

 private:
  /// A component of a node is that of the node at its image, which may be of the other cut edge.
  void add_own(Triplets& entries, int row, const CoordinateOrigin& origin) const
  {
    const int image = sector_.mirror->image[std::size_t(origin.block)];
    const auto n_c = static_cast<int>(sector_.components.size());
    const SparseRows& phase = origin.of_y ? c_.Y : c_.X;
    for (int j = 0; j < n_c; ++j) {
      const double value = (origin.of_y ? -1.0 : 1.0) *
                           reflection_entry(Q_, origin.component, sector_.component(image, j));
      if (value == 0.0) continue;
      for (SparseRows::InnerIterator it(phase, n_c * image + j); it; ++it)
        entries.emplace_back(row, int(it.index()), value * it.value());
    }
  }

  /// f(phi) becomes +-f(2 angle - phi): tangential displacements and rotations about the radius and
  /// the axis change their sign.
  void add_harmonic(Triplets& entries, int row, const CoordinateOrigin& origin) const
  {
    const int order = (origin.place + 1) / 2, component = origin.component;
    const bool is_sine = origin.place % 2 == 0;
    const auto n_c = static_cast<int>(sector_.components.size());
    const double sign = component == 1 || component == 3 || component == 5 ? -1.0 : 1.0;
    const double turned = 2.0 * order * sector_.mirror->angle;
    entries.emplace_back(row, row, sign * (is_sine ? -1.0 : 1.0) * std::cos(turned));
    entries.emplace_back(row, is_sine ? row - n_c : row + n_c, sign * std::sin(turned));
  }

  const HarmonicCoordinates& c_;
  const SectorDofs& sector_;
  Matrix3d Q_;
};

/// Coordinates that a reflection mixes with the first of them, ascending.
std::vector<int> mixed_with(const SparseRows& sigma, int first, std::vector<bool>& is_known)
{
  std::vector<int> members{first};
  is_known[std::size_t(first)] = true;
  for (std::size_t k = 0; k < members.size(); ++k) {
    for (SparseRows::InnerIterator it(sigma, members[k]); it; ++it) {
      if (std::abs(it.value()) < 1e-13 || is_known[std::size_t(it.index())]) continue;
      is_known[std::size_t(it.index())] = true;
      members.push_back(int(it.index()));
    }
  }
  std::ranges::sort(members);
  return members;
}

/// An orthonormal basis of what (I + sigma) / 2 leaves as it is, among a few coordinates.
MatrixXd kept_directions(const SparseRows& sigma, const std::vector<int>& members)
{
  const Index n = std::ssize(members);
  MatrixXd P = 0.5 * MatrixXd::Identity(n, n);
  for (Index i = 0; i < n; ++i) {
    for (SparseRows::InnerIterator it(sigma, members[std::size_t(i)]); it; ++it) {
      const auto place = std::ranges::lower_bound(members, int(it.index()));
      if (place != members.end() && *place == it.index())
        P(i, place - members.begin()) += 0.5 * it.value();
    }
  }
  const auto rank = static_cast<Index>(std::lround(P.trace()));
  MatrixXd B(n, rank);
  Index found = 0;
  for (Index j = 0; j < n && found < rank; ++j) {
    VectorXd column = P.col(j);
    for (int pass = 0; pass < 2; ++pass)
      column -= B.leftCols(found) * (B.leftCols(found).transpose() * column).eval();
    constexpr double dependent = 1e-6;
    if (column.norm() > dependent) B.col(found++) = column.normalized();
  }
  return B.leftCols(found);
}

}  // namespace

std::optional<Mirror> find_mirror(const SectorDofs& sector, const Eigen::MatrixX3d& positions,
                                  const std::vector<const SparseRows*>& forms)
{
  const std::optional<double> angle = middle_angle(sector, positions);
  if (!angle) return std::nullopt;
  Mirror mirror{.angle = *angle, .image = images(sector, positions, *angle)};
  if (mirror.image.empty()) return std::nullopt;
  const auto maps_to_itself = [&](const Ring& ring) {
    return std::ranges::all_of(ring.blocks, [&](int block) {
      return std::ranges::find(ring.blocks, mirror.image[std::size_t(block)]) != ring.blocks.end();
    });
  };
  if (!std::ranges::all_of(sector.rings, maps_to_itself)) return std::nullopt;
  const SparseRows S = reflection_of_dofs(sector, mirror);
  for (const SparseRows* A : forms)
    if (A->size() > 0 && !agrees(*A, S)) return std::nullopt;
  return mirror;
}

SparseRows symmetric_motions(const HarmonicCoordinates& c, const SectorDofs& sector)
{
  const SparseRows sigma = Reflection(c, sector).matrix();
  std::vector<bool> is_known(std::size_t(c.n()), false);
  Triplets entries;
  int n = 0;
  for (int first = 0; first < c.n(); ++first) {
    if (is_known[std::size_t(first)]) continue;
    const std::vector<int> members = mixed_with(sigma, first, is_known);
    const MatrixXd B = kept_directions(sigma, members);
    for (Index k = 0; k < B.cols(); ++k, ++n)
      for (Index i = 0; i < B.rows(); ++i)
        if (B(i, k) != 0.0) entries.emplace_back(members[std::size_t(i)], n, B(i, k));
  }
  SparseRows basis(c.n(), n);
  basis.setFromTriplets(entries.begin(), entries.end());
  return basis;
}

}  // namespace chladni::cyclic
