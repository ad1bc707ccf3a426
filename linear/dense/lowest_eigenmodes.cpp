#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "linear/dense/deflated_factor.hpp"
#include "linear/dense/part_modes.hpp"

namespace chladni::linear {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index block_size = 8;      // more than equal frequencies that come together
constexpr double tolerance = 1e-10;  // of residuals relative to 1 / lambda
constexpr Index few = 200;           // coordinates: all modes are as cheap
constexpr Index share = 2;           // of the coordinates that a basis may have

/// Block Lanczos for B^-1 M, B the stiffness with R deflated: B^-1 M V = V T + Q S E_last^T with
/// V^T M V = I and V^T M R = 0.
class DenseLanczos {
 public:
  DenseLanczos(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R, Index capacity)
      : B_(deflated_factor(K, M, R, deflation_shift(K, M, R))),
        M_(M),
        R_(R),
        MR_(M * R),
        V_(K.rows(), capacity),
        MV_(K.rows(), capacity),
        T_(capacity, capacity)
  {
    // The same each time, and no pattern that a mode may have too.
    const MatrixXd start = MatrixXd::NullaryExpr(K.rows(), block_size, [](Index i, Index j) {
      return std::cos(1.0 + std::sqrt(2.0) * static_cast<double>(i * (2 * j + 3) + j));
    });
    const MatrixXd W = B_.solve(M_ * start);
    take_next(W, std::sqrt((W.transpose() * (M_ * W)).trace()));
  }

  Index size() const { return m_; }
  /// B^-1 M maps the basis to itself.
  bool is_invariant() const { return Q_.cols() == 0; }
  bool is_full() const { return m_ + Q_.cols() > V_.cols(); }

  void step()
  {
    const Index b = Q_.cols();
    V_.middleCols(m_, b) = Q_;
    MV_.middleCols(m_, b) = MQ_;
    last_ = b;
    MatrixXd W = B_.solve(MQ_);
    m_ += b;
    MatrixXd C = MV_.leftCols(m_).transpose() * W;
    W.noalias() -= V_.leftCols(m_) * C;
    T_.block(0, m_ - b, m_, b) = C;
    T_.block(m_ - b, 0, b, m_) = C.transpose();
    take_next(std::move(W), T_.diagonal().head(m_).cwiseAbs().maxCoeff());
  }

  /// theta = 1 / lambda, falling, and the coefficients of the Ritz vectors.
  void solve()
  {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(
        MatrixXd(0.5 * (T_.topLeftCorner(m_, m_) + T_.topLeftCorner(m_, m_).transpose())));
    theta_ = ritz.eigenvalues().reverse();
    Y_ = ritz.eigenvectors().rowwise().reverse();
  }

  const VectorXd& theta() const { return theta_; }
  bool has_converged(Index i) const
  {
    return (S_ * Y_.col(i).tail(last_)).norm() <= tolerance * theta_[i];
  }
  /// X of the first k pairs after x <- B^-1 M x / theta, which takes out what has no mass.
  Eigenmodes pairs(Index k) const
  {
    MatrixXd X = V_.leftCols(m_) * Y_.leftCols(k);
    if (!is_invariant()) {
      const VectorXd inverse = theta_.head(k).cwiseInverse();
      X += Q_ * (S_ * Y_.bottomRows(last_).leftCols(k) * inverse.asDiagonal());
    }
    return {theta_.head(k).cwiseInverse(), X, 0};
  }

 private:
  void orthogonalize(MatrixXd& W) const
  {
    W.noalias() -= R_ * (MR_.transpose() * W);
    W.noalias() -= V_.leftCols(m_) * (MV_.leftCols(m_).transpose() * W);
  }

  /// W = Q S with Q^T M Q = I, Q as wide as the rank of W: what is below round-off of `scale` is
  /// nothing.
  void take_next(MatrixXd W, double scale)
  {
    orthogonalize(W);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> gram(MatrixXd(W.transpose() * (M_ * W)));
    const VectorXd g = gram.eigenvalues().reverse();
    const double negligible = 1e-12 * scale;
    const Index rank = (g.array() > negligible * negligible).count();
    const VectorXd length = g.head(rank).cwiseSqrt();
    const MatrixXd U = gram.eigenvectors().rowwise().reverse().leftCols(rank);
    S_ = length.asDiagonal() * U.transpose();
    Q_ = W * U * length.cwiseInverse().asDiagonal();
    if (rank == 0) return;
    // Once more: what was left of a small difference is not orthogonal to the last digits.
    orthogonalize(Q_);
    MQ_ = M_ * Q_;
    const Eigen::LLT<MatrixXd> L(MatrixXd(Q_.transpose() * MQ_));
    Q_ = L.matrixL().solve(Q_.transpose()).transpose();
    MQ_ = L.matrixL().solve(MQ_.transpose()).transpose();
    S_ = (L.matrixU() * S_).eval();
  }

  Eigen::LLT<MatrixXd> B_;
  const MatrixXd& M_;
  const MatrixXd& R_;
  MatrixXd MR_, V_, MV_, T_, Q_, MQ_, S_, Y_;
  VectorXd theta_;
  Index m_ = 0;     ///< columns of V
  Index last_ = 0;  ///< of them those of the last block
};

/// How many of the lowest modes are wanted, as far as the basis knows.
Index n_wanted(const VectorXd& theta, const LowestModes& wanted)
{
  const Index n_below = (theta.array() * wanted.lambda_max >= 1.0).count();
  return std::min(n_below + 1, wanted.most);
}

/// Whether so many of the first k values are equal that a block may not have seen all of them.
bool may_miss_equal_ones(const VectorXd& theta, Index k)
{
  constexpr double equal = 1e-6;
  for (Index i = 0; i + block_size <= k; ++i)
    if (theta[i] - theta[i + block_size - 1] < equal * theta[i]) return true;
  return false;
}

/// None where the basis would have to be too large, or wider blocks would be needed.
std::optional<Eigenmodes> by_lanczos(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                                     const LowestModes& wanted)
{
  const Index capacity = K.rows() / share;
  DenseLanczos lanczos(K, M, R, capacity);
  for (Index next_look = 0; !lanczos.is_invariant() && !lanczos.is_full();) {
    lanczos.step();
    if (lanczos.size() < next_look) continue;
    lanczos.solve();
    const Index k = n_wanted(lanczos.theta(), wanted);
    if (3 * k > capacity) return std::nullopt;
    next_look = std::max(lanczos.size() + block_size, 3 * k);
    if (k > lanczos.size()) continue;
    bool has_all = true;
    for (Index i = k; has_all && i-- > 0;) has_all = lanczos.has_converged(i);
    if (has_all && may_miss_equal_ones(lanczos.theta(), k)) return std::nullopt;
    if (has_all) return lanczos.pairs(k);
  }
  return std::nullopt;
}

/// The first ones of some modes, as many as are wanted.
Eigenmodes first_wanted(const Eigenmodes& all, const LowestModes& wanted)
{
  const Index k = std::min(n_wanted(all.lambda.cwiseInverse(), wanted), all.lambda.size());
  return {all.lambda.head(k), all.X.leftCols(k), 0};
}

/// Of coordinates that are all coupled, in a problem whose largest 1 / lambda is `mu_of_whole` or
/// more.
Eigenmodes lowest_of_part(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                          const LowestModes& wanted, double mu_of_whole)
{
  if (K.rows() > few)
    if (std::optional<Eigenmodes> found = by_lanczos(K, M, R, wanted)) return *std::move(found);
  return first_wanted(eigenmodes_of_part(K, M, R, mu_of_whole), wanted);
}

/// A lower bound of the largest 1 / lambda.
double largest_ratio(const MatrixXd& K, const MatrixXd& M)
{
  return (K.diagonal().array() > 0.0)
      .select(M.diagonal().array() / K.diagonal().array(), 0.0)
      .maxCoeff();
}

}  // namespace

Eigenmodes lowest_eigenmodes(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                             const LowestModes& wanted)
{
  const bool wants_all = std::isinf(wanted.lambda_max) && wanted.most >= K.rows() - R.cols();
  if (K.rows() <= few || wants_all) return first_wanted(eigenmodes(K, M, R), wanted);
  if (R.cols() > 0) return lowest_of_part(K, M, R, wanted, 0.0);
  const std::vector<std::vector<Index>> sets = decoupled_coordinates(K, M);
  const double mu_of_whole = largest_ratio(K, M);
  std::vector<PartModes> parts;
  for (const std::vector<Index>& set : sets) {
    parts.push_back({.coordinates = set,
                     .modes = lowest_of_part(K(set, set), M(set, set), MatrixXd(std::ssize(set), 0),
                                             wanted, mu_of_whole)});
  }
  return first_wanted(merged(parts, K.rows()), wanted);
}

}  // namespace chladni::linear
