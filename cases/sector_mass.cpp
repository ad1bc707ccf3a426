#include "cases/sector_mass.hpp"

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/KroneckerProduct>
#include <utility>

#include "cases/reduce_steps.hpp"
#include "common/eigen_every.hpp"
#include "cyclic/sparse_rows.hpp"
#include "cyclic/turn.hpp"
#include "linear/kernels/dense_matrices.hpp"

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

/// A phase of a harmonic.
struct Phase {
  int order;
  bool of_y;
};

/// sum of the Kronecker product of R and R: row 3 k + l, column 3 p + q of R_kp R_lq
Matrix9d sum_of_two_turns(int count, const Phase& a, const Phase& b)
{
  Matrix9d sum = Matrix9d::Zero();
  for (int j = 0; j < count; ++j) {
    const Matrix3d R = cyclic::turn_of_sector(j, count);
    sum += weight(a.order, a.of_y, j, count) * weight(b.order, b.of_y, j, count) *
           Matrix9d(Eigen::kroneckerProduct(R, R));
  }
  return sum;
}

const MatrixXd& motion_in(const Phase& phase, const cyclic::SectorMotion& motion)
{
  return phase.of_y ? motion.y : motion.x;
}

/// The phases that a harmonic has.
std::vector<Phase> phases_of(int order, int count)
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
  for (int q = 0; q < 3; ++q)
    if (p != 2 || q != 2)
      S[std::size_t(q)] = cyclic::sparse_rows(plate::displacement_product(mass_, p, q));
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

MassCoupling SectorMass::coupling(int n, const cyclic::SectorMotion& of_n, int m,
                                  const cyclic::SectorMotion& of_m) const
{
  const Index n_n = of_n.x.cols(), n_m = of_m.x.cols();
  MassCoupling coupling{.other = m, .of_other = {}, .of_other_transposed = {}};
  const auto is_needed = [](std::size_t kl) { return kl != 2; };  // M tells S_zz
  for (std::size_t kl = 0; kl < 6; ++kl) {
    if (!is_needed(kl)) continue;
    coupling.of_other[kl] = MatrixXd::Zero(n_m, n_n);
    if (n != m) coupling.of_other_transposed[kl] = MatrixXd::Zero(n_n, n_m);
  }
  /// What S_pq of the sector is to S_kl and, transposed, S_qp to S_kl of the whole body.
  const auto add = [&](const Phase& a, const Phase& b, int p, int q, const auto& G) {
    const Matrix9d ab = sum_of_two_turns(count_, a, b), ba = sum_of_two_turns(count_, b, a);
    for (std::size_t kl = 0; kl < 6; ++kl) {
      if (!is_needed(kl)) continue;
      const auto [k, l] = mbs_export::product_axes[kl];
      const double forward = ab(3 * k + l, 3 * p + q), backward = ba(3 * k + l, 3 * q + p);
      if (std::abs(forward) > 1e-12) coupling.of_other[kl] += forward * G;
      if (n != m && std::abs(backward) > 1e-12)
        coupling.of_other_transposed[kl] += backward * G.transpose();
    }
  };
  for (int p = 0; p < 3; ++p) {
    const MovingRows& moving = moving_[std::size_t(p)];
    const int n_q = p == 2 ? 2 : 3;
    for (const Phase& b : phases_of(n, count_)) {
      MatrixXd S_b(std::ssize(moving.rows), n_q * n_n);
      for (int q = 0; q < n_q; ++q)
        S_b.middleCols(q * n_n, n_n).noalias() = moving.S[std::size_t(q)] * motion_in(b, of_n);
      for (const Phase& a : phases_of(m, count_)) {
        const MatrixXd of_a = motion_in(a, of_m)(moving.rows, every);
        const MatrixXd G = linear::inner_product(of_a, S_b);
        for (int q = 0; q < n_q; ++q) add(a, b, p, q, G.middleCols(q * n_n, n_n));
      }
    }
  }
  return coupling;
}

HarmonicMass SectorMass::of_harmonic(int order, const MotionsOfHarmonics& motions) const
{
  const cyclic::SectorMotion& own = motions.at(order);
  const Index n = own.x.cols();
  HarmonicMass mass{.displacement = MatrixXd::Zero(3, n),
                    .position_displacement = MatrixXd::Zero(9, n),
                    .couplings = {}};
  if (std::min(order, count_ - order) <= reach) {
    const MatrixXd V = linear::replicate(moments_.displacement);
    for (const bool of_y : {false, true}) {
      const MatrixXd of_sector = V.transpose() * motion_in({order, of_y}, own);  // [12 x n]
      mass.displacement += sum_of_turns(count_, order, of_y) * of_sector.topRows<3>();
      mass.position_displacement +=
          sum_of_two_turns(count_, {order, of_y}, {0, false}) * of_sector.bottomRows<9>();
    }
  }
  for (int other = std::max(order - reach, 0); other <= order; ++other)
    mass.couplings.push_back(coupling(order, own, other, motions.at(other)));
  return mass;
}

}  // namespace chladni::cases
