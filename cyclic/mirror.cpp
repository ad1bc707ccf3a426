#include "cyclic/mirror.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace chladni::cyclic {

namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

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
std::vector<int> images(const Eigen::MatrixX3d& positions, double angle)
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
      if (distance > least) continue;
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
        const double value = reflection_entry(Q, sector.components[std::size_t(i)],
                                              sector.components[std::size_t(j)]);
        if (value != 0.0)
          entries.emplace_back(n_c * block + i, n_c * mirror.image[std::size_t(block)] + j, value);
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
      const double value =
          (origin.of_y ? -1.0 : 1.0) *
          reflection_entry(Q_, origin.component, sector_.components[std::size_t(j)]);
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
  Mirror mirror{.angle = *angle, .image = images(positions, *angle)};
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
