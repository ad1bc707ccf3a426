#include "cases/sector_mass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/KroneckerProduct>
#include <utility>

#include "cases/fe_model.hpp"
#include "common/eigen_every.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "reduce/cyclic/harmonic_coordinates.hpp"
#include "reduce/cyclic/sector.hpp"

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Of a motion in its two phases: that of sector j is cos(n phi) x - sin(n phi) y at phi = 2 pi j /
/// count, turned with it.
double weight(int n, bool of_y, int sector, int count)
{
  const double angle = 2.0 * std::numbers::pi * n * sector / count;
  return of_y ? -std::sin(angle) : std::cos(angle);
}

/// sum R over the sectors
Matrix3d sum_of_turns(int count, int n, bool of_y)
{
  Matrix3d sum = Matrix3d::Zero();
  for (int j = 0; j < count; ++j)
    sum += weight(n, of_y, j, count) * cyclic::turn_of_sector(j, count);
  return sum;
}

/// sum of the Kronecker product of R and R: row 3 k + l, column 3 p + q of R_kp R_lq
Matrix9d sum_of_two_turns(int count, const HarmonicPhase& a, const HarmonicPhase& b)
{
  Matrix9d sum = Matrix9d::Zero();
  for (int j = 0; j < count; ++j) {
    const Matrix3d R = cyclic::turn_of_sector(j, count);
    sum += weight(a.order, a.of_y, j, count) * weight(b.order, b.of_y, j, count) *
           Matrix9d(Eigen::kroneckerProduct(R, R));
  }
  return sum;
}

const MatrixXd& motion_in(const HarmonicPhase& phase, const cyclic::SectorMotion& motion)
{
  return phase.of_y ? motion.y : motion.x;
}

/// The phases that a harmonic has.
std::vector<HarmonicPhase> phases_of(int order, int count)
{
  if (cyclic::has_one_phase(order, count)) return {{order, false}};
  return {{order, false}, {order, true}};
}

plate::Structure structure_of_sector(const scene::Scene& scene, const SectorModel& model)
{
  plate::Structure structure = structure_of(scene);
  structure.masses = model.masses;
  return structure;
}

}  // namespace

SectorMass::SectorMass(const scene::Scene& scene, const SectorModel& model)
    : count_(model.dofs.count),
      structure_(structure_of_sector(scene, model)),
      mass_(plate::mass_model(model.mesh, structure_, model.system.dofs, PETSC_COMM_SELF)),
      moments_(plate::mass_moments(mass_)),
      moving_{moving_rows(0), moving_rows(1), moving_rows(2)}
{}

SectorMass::MovingRows SectorMass::moving_rows(int p) const
{
  std::array<cyclic::SparseRows, 3> S;
  std::vector<plate::Axes> axes;
  for (int q = 0; q < 3; ++q)
    if (p != 2 || q != 2) axes.emplace_back(p, q);
  const std::vector<petsc::Matrix> products = plate::displacement_products(mass_, axes);
  for (std::size_t q = 0; q < products.size(); ++q) S[q] = cyclic::sparse_rows(products[q]);
  MovingRows moving;
  std::array<std::vector<Eigen::Triplet<double>>, 3> entries;
  for (int row = 0; row < S[0].outerSize(); ++row) {
    bool moves = false;
    for (std::size_t q = 0; q < 3; ++q) {
      if (S[q].size() == 0) continue;
      for (cyclic::SparseRows::InnerIterator it(S[q], row); it; ++it) {
        if (it.value() == 0.0) continue;
        entries[q].emplace_back(int(moving.rows.size()), int(it.index()), it.value());
        moves = true;
      }
    }
    if (moves) moving.rows.push_back(row);
  }
  for (std::size_t q = 0; q < 3; ++q) {
    moving.S[q].resize(std::ssize(moving.rows), S[0].cols());
    moving.S[q].setFromTriplets(entries[q].begin(), entries[q].end());
  }
  return moving;
}

mbs_export::MassIntegrals SectorMass::of_rigid_body() const
{
  const Eigen::Matrix<double, 9, 1> second = Matrix3d(moments_.second.transpose()).reshaped();
  const Eigen::Matrix<double, 9, 1> turned =
      sum_of_two_turns(count_, {0, false}, {0, false}) * second;
  return {.mass = count_ * moments_.mass,
          .first = sum_of_turns(count_, 0, false) * moments_.first,
          .second = turned.reshaped(3, 3).transpose(),
          .displacement = {},
          .position_displacement = {},
          .products = {}};
}

namespace {

/// S_zz follows from M.
bool is_needed(std::size_t kl)
{
  return kl != 2;
}

MassCoupling no_coupling(int other, Index n_other, Index n, bool is_itself)
{
  MassCoupling coupling{.other = other, .of_other = {}, .of_other_transposed = {}};
  for (std::size_t kl = 0; kl < 6; ++kl) {
    if (!is_needed(kl)) continue;
    coupling.of_other[kl] = MatrixXd::Zero(n_other, n);
    if (!is_itself) coupling.of_other_transposed[kl] = MatrixXd::Zero(n, n_other);
  }
  return coupling;
}

}  // namespace

void SectorMass::add_product(MassCoupling& coupling, const PhasedProduct& product) const
{
  const auto& [a, b, p, q, G] = product;
  const Matrix9d ab = sum_of_two_turns(count_, a, b), ba = sum_of_two_turns(count_, b, a);
  for (std::size_t kl = 0; kl < 6; ++kl) {
    if (!is_needed(kl)) continue;
    const auto [k, l] = mbs_export::product_axes[kl];
    const double forward = ab(3 * k + l, 3 * p + q), backward = ba(3 * k + l, 3 * q + p);
    if (std::abs(forward) > 1e-12) coupling.of_other[kl] += forward * G;
    MatrixXd& transposed = coupling.of_other_transposed[kl];
    if (transposed.size() > 0 && std::abs(backward) > 1e-12) transposed += backward * G.transpose();
  }
}

std::vector<MassCoupling> SectorMass::couplings(int n, const MotionsOfHarmonics& motions) const
{
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const cyclic::SectorMotion& of_n = motions.at(n);
  const Index n_n = of_n.x.cols();
  std::vector<MassCoupling> couplings;
  for (int m = std::max(n - reach, 0); m <= n; ++m)
    couplings.push_back(no_coupling(m, motions.at(m).x.cols(), n_n, m == n));
  for (const HarmonicPhase& b : phases_of(n, count_)) {
    const Rows of_b = motion_in(b, of_n);  // whose rows a sparse product takes one after the other
    for (int p = 0; p < 3; ++p) {
      const MovingRows& moving = moving_[std::size_t(p)];
      const int n_q = p == 2 ? 2 : 3;
      MatrixXd S_b(std::ssize(moving.rows), n_q * n_n);
      for (int q = 0; q < n_q; ++q)
        S_b.middleCols(q * n_n, n_n) = Rows(moving.S[std::size_t(q)] * of_b);
      for (MassCoupling& coupling : couplings) {
        for (const HarmonicPhase& a : phases_of(coupling.other, count_)) {
          const MatrixXd of_a = motion_in(a, motions.at(coupling.other))(moving.rows, every);
          const MatrixXd G = linear::inner_product(of_a, S_b);
          for (int q = 0; q < n_q; ++q)
            add_product(coupling, {a, b, p, q, G.middleCols(q * n_n, n_n)});
        }
      }
    }
  }
  return couplings;
}

HarmonicMass SectorMass::of_harmonic(int order, const MotionsOfHarmonics& motions) const
{
  const cyclic::SectorMotion& own = motions.at(order);
  const Index n = own.x.cols();
  HarmonicMass mass{.displacement = MatrixXd::Zero(3, n),
                    .position_displacement = MatrixXd::Zero(9, n),
                    .couplings = couplings(order, motions)};
  if (std::min(order, count_ - order) <= reach) {
    const MatrixXd V = linear::replicate(moments_.displacement);
    for (const bool of_y : {false, true}) {
      const MatrixXd of_sector = V.transpose() * motion_in({order, of_y}, own);  // [12 x n]
      mass.displacement += sum_of_turns(count_, order, of_y) * of_sector.topRows<3>();
      mass.position_displacement +=
          sum_of_two_turns(count_, {order, of_y}, {0, false}) * of_sector.bottomRows<9>();
    }
  }
  return mass;
}

}  // namespace chladni::cases
