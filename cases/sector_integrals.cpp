#include "cases/sector_integrals.hpp"

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/KroneckerProduct>

#include "cases/reduce_steps.hpp"
#include "common/eigen_every.hpp"
#include "cyclic/sparse_rows.hpp"
#include "cyclic/turn.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "plate/assembly/inertia_integrals.hpp"

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd;
using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Places = std::vector<std::vector<Index>>;

/// Sums over the sectors. A motion of order n is cos(n phi) x - sin(n phi) y at the angle phi.
class Turns {
 public:
  explicit Turns(int count) : count_(count)
  {
    for (int j = 0; j < count; ++j) R_.push_back(cyclic::turn_of_sector(j, count));
  }

  int count() const { return count_; }

  /// Whether two harmonics have anything in common.
  bool couple(int n, int m) const
  {
    const auto is_near = [&](int k) { return std::min(k % count_, count_ - k % count_) <= 2; };
    return is_near(n + m) || is_near(std::abs(n - m));
  }

  /// sum R
  Matrix3d first(int n, bool of_y) const
  {
    Matrix3d sum = Matrix3d::Zero();
    for (int j = 0; j < count_; ++j) sum += weight(n, of_y, j) * R_[std::size_t(j)];
    return sum;
  }

  /// sum of the Kronecker product of R and R: row 3 k + l, column 3 p + q of R_kp R_lq
  Matrix9d second(int n, bool n_of_y, int m, bool m_of_y) const
  {
    Matrix9d sum = Matrix9d::Zero();
    for (int j = 0; j < count_; ++j) {
      const Matrix3d& R = R_[std::size_t(j)];
      sum += weight(n, n_of_y, j) * weight(m, m_of_y, j) * Matrix9d(Eigen::kroneckerProduct(R, R));
    }
    return sum;
  }

 private:
  double angle(int j) const { return 2.0 * std::numbers::pi * j / count_; }
  double weight(int n, bool of_y, int j) const
  {
    return of_y ? -std::sin(n * angle(j)) : std::cos(n * angle(j));
  }

  int count_;
  std::vector<Matrix3d> R_;
};

const MatrixXd& phase(const HarmonicPart& part, bool of_y)
{
  return of_y ? part.sector.y : part.sector.x;
}

/// What does not depend on products of motions.
void add_moments(mbs_export::MassIntegrals& whole, const plate::MassMoments& moments,
                 const Turns& turns, int count, const std::vector<HarmonicPart>& parts,
                 const Places& places)
{
  whole.mass = count * moments.mass;
  whole.first = turns.first(0, false) * moments.first;
  const Eigen::Matrix<double, 9, 1> second = Matrix3d(moments.second.transpose()).reshaped();
  const Eigen::Matrix<double, 9, 1> turned = turns.second(0, false, 0, false) * second;
  whole.second = turned.reshaped(3, 3).transpose();
  const MatrixXd V = linear::replicate(moments.displacement);
  for (std::size_t a = 0; a < parts.size(); ++a) {
    const int n = parts[a].order;
    if (!turns.couple(n, 0)) continue;
    for (const bool of_y : {false, true}) {
      const MatrixXd of_sector = V.transpose() * phase(parts[a], of_y);  // [12 x n of the part]
      whole.displacement(every, places[a]) += turns.first(n, of_y) * of_sector.topRows<3>();
      whole.position_displacement(every, places[a]) +=
          turns.second(n, of_y, 0, false) * of_sector.bottomRows<9>();
    }
  }
}

/// The rows of a matrix that are not empty, which a motion in one direction has a third of.
struct MovingRows {
  std::vector<Index> rows;
  cyclic::SparseRows S;  ///< these alone
};

MovingRows moving_rows(const cyclic::SparseRows& S)
{
  MovingRows moving;
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < S.outerSize(); ++row) {
    bool is_new = true;
    for (cyclic::SparseRows::InnerIterator it(S, row); it; ++it) {
      if (it.value() == 0.0) continue;
      if (is_new) moving.rows.push_back(row);
      is_new = false;
      entries.emplace_back(int(moving.rows.size()) - 1, int(it.index()), it.value());
    }
  }
  moving.S.resize(Index(moving.rows.size()), S.cols());
  moving.S.setFromTriplets(entries.begin(), entries.end());
  return moving;
}

/// The phases that a harmonic has.
std::vector<bool> phases_of(const HarmonicPart& part, int count)
{
  return cyclic::has_one_phase(part.order, count) ? std::vector{false} : std::vector{false, true};
}

/// Adds what S_pq of the sector is to S_kl of the whole body, and its transpose S_qp.
void add_products(mbs_export::MassIntegrals& whole, const MovingRows& moving, int p, int q,
                  const Turns& turns, const std::vector<HarmonicPart>& parts, const Places& places)
{
  const auto add = [&](std::size_t a, std::size_t b, const Matrix9d& sums, int pq, const auto& G) {
    for (std::size_t i = 0; i < whole.products.size(); ++i) {
      const auto [k, l] = mbs_export::product_axes[i];
      const double factor = sums(3 * k + l, pq);
      if (std::abs(factor) > 1e-12) whole.products[i](places[a], places[b]) += factor * G;
    }
  };
  const auto of_rows = [&](std::size_t a, bool of_y) -> MatrixXd {
    return phase(parts[a], of_y)(moving.rows, every);
  };
  for (std::size_t b = 0; b < parts.size(); ++b) {
    for (const bool b_of_y : phases_of(parts[b], turns.count())) {
      const MatrixXd S_b = moving.S * phase(parts[b], b_of_y);
      for (std::size_t a = 0; a < parts.size(); ++a) {
        const int n = parts[a].order, m = parts[b].order;
        if (!turns.couple(n, m)) continue;
        for (const bool a_of_y : phases_of(parts[a], turns.count())) {
          const MatrixXd G = linear::inner_product(of_rows(a, a_of_y), S_b);
          add(a, b, turns.second(n, a_of_y, m, b_of_y), 3 * p + q, G);
          if (p != q) add(b, a, turns.second(m, b_of_y, n, a_of_y), 3 * q + p, G.transpose());
        }
      }
    }
  }
}

}  // namespace

mbs_export::MassIntegrals sector_integrals(const scene::Scene& scene, const SectorModel& model,
                                           const std::vector<HarmonicPart>& parts,
                                           const MatrixXd& M, Index n_masters)
{
  const int count = model.dofs.count;
  const Index n = M.rows();
  const Turns turns(count);
  const Places places = places_of(parts, n_masters);
  plate::Structure structure = structure_of(scene);
  structure.masses = model.masses;
  const plate::MassModel mass =
      plate::mass_model(model.mesh, structure, model.system.dofs, PETSC_COMM_SELF);
  mbs_export::MassIntegrals whole{.mass = 0.0,
                                  .first = Eigen::Vector3d::Zero(),
                                  .second = Matrix3d::Zero(),
                                  .displacement = MatrixXd::Zero(3, n),
                                  .position_displacement = MatrixXd::Zero(9, n),
                                  .products = {}};
  add_moments(whole, plate::mass_moments(mass), turns, count, parts, places);
  for (MatrixXd& S : whole.products) S = MatrixXd::Zero(n, n);
  for (const auto& [p, q] : mbs_export::product_axes) {
    if (p == 2 && q == 2) continue;  // a turn about z makes S_zz of it alone, which M tells
    const petsc::Matrix S = plate::displacement_product(mass, p, q);
    add_products(whole, moving_rows(cyclic::sparse_rows(S)), p, q, turns, parts, places);
  }
  auto& S = whole.products;
  for (const std::size_t i : {0, 1}) S[i] = 0.5 * (S[i] + S[i].transpose()).eval();
  S[2] = M - S[0] - S[1];  // M = S_xx + S_yy + S_zz
  return whole;
}

}  // namespace chladni::cases
