#include "linear/dense/eigenmodes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"

namespace chladni::linear {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// L^-1 M L^-T without the directions L^T R of the zero-energy vectors.
struct Deflated {
  MatrixXd A;
  double size;  ///< of what it was before, which round-off in A is relative to
};

Deflated deflated(const MatrixXd& L, const MatrixXd& M, const MatrixXd& R)
{
  const auto lower = L.triangularView<Eigen::Lower>();
  const MatrixXd half = lower.solve(M);
  MatrixXd A = lower.solve(half.transpose());
  const double size = A.diagonal().cwiseAbs().maxCoeff();
  if (R.cols() > 0) {
    const MatrixXd LtR = L.transpose() * R;
    const MatrixXd Y_r = Eigen::LLT<MatrixXd>(MatrixXd(LtR.transpose() * LtR))
                             .matrixL()
                             .solve(LtR.transpose())
                             .transpose();
    A -= Y_r * (Y_r.transpose() * A);
    A -= (A * Y_r) * Y_r.transpose();
  }
  return {0.5 * (A + A.transpose()), size};
}

/// X made M-orthonormal and M-orthogonal to R, low modes first: round-off leaves a high mode with a
/// share eps lambda_max / lambda_min of low ones.
MatrixXd orthonormalized(const MatrixXd& X, const MatrixXd& M, const MatrixXd& R)
{
  const MatrixXd X_0 = X - R * (R.transpose() * M * X);
  const Eigen::LLT<MatrixXd> MX(MatrixXd(X_0.transpose() * M * X_0));
  return MX.matrixL().solve(X_0.transpose()).transpose();
}

/// The modes X, x^T M x = 1, without those of more than a thousand times the first frequency whose
/// mass is round-off of its parts |x|^T |M| |x|: the rotation of a shell about its normal, of which
/// the mass is what the other modes leave of it.
/// @param mu  relative to that of the first frequency
std::vector<Index> with_mass(const MatrixXd& X, const MatrixXd& M, const VectorXd& mu,
                             double largest_rounding)
{
  constexpr double far = 1e-6;
  const VectorXd parts =
      (X.cwiseAbs().array() * (M.cwiseAbs() * X.cwiseAbs()).array()).colwise().sum();
  std::vector<Index> massive;
  for (Index j = 0; j < X.cols(); ++j) {
    const bool is_round_off = std::numeric_limits<double>::epsilon() * parts[j] > largest_rounding;
    if (!is_round_off || mu[j] > far) massive.push_back(j);
  }
  return massive;
}

/// Coordinates, and the zero-energy vectors that move them.
struct Coordinates {
  std::vector<Index> rows, motions;
};

Coordinates all_coordinates(const MatrixXd& R)
{
  Coordinates all{.rows = std::vector<Index>(static_cast<std::size_t>(R.rows())),
                  .motions = std::vector<Index>(static_cast<std::size_t>(R.cols()))};
  std::iota(all.rows.begin(), all.rows.end(), Index{0});
  std::iota(all.motions.begin(), all.motions.end(), Index{0});
  return all;
}

/// Those that are coupled to no others; all together where a zero-energy vector moves several.
std::vector<Coordinates> decoupled(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R)
{
  std::vector<Coordinates> parts;
  std::size_t n_motions = 0;
  for (std::vector<Index>& rows : decoupled_coordinates(K, M)) {
    Coordinates part{.rows = std::move(rows), .motions = {}};
    for (Index j = 0; j < R.cols(); ++j)
      if (!R(part.rows, j).isZero(0.0)) part.motions.push_back(j);
    n_motions += part.motions.size();
    parts.push_back(std::move(part));
  }
  if (std::cmp_greater(n_motions, R.cols())) return {all_coordinates(R)};
  return parts;
}

/// The problem of coordinates that are coupled to no others, M x = mu K x, solved: L^T x = y with
/// L L^T = K, deflated as that of all coordinates: a part may have no other motion than a rigid
/// one.
struct SolvedPart {
  std::vector<Index> coordinates;
  MatrixXd M, R, L;
  VectorXd mu;  ///< descending
  MatrixXd Y;   ///< of all mu
  double size;  ///< which round-off in mu is relative to
};

SolvedPart solved(Coordinates of, const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                  double sigma)
{
  const auto& [rows, motions] = of;
  SolvedPart part{.coordinates = {},
                  .M = M(rows, rows),
                  .R = R(rows, motions),
                  .L = {},
                  .mu = {},
                  .Y = {},
                  .size = 0.0};
  const Eigen::LLT<MatrixXd> B = deflated_factor(K(rows, rows), part.M, part.R, sigma);
  part.L = B.matrixL();
  const auto [A, size] = deflated(part.L, part.M, part.R);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A);
  part.mu = solver.eigenvalues().reverse();
  part.Y = solver.eigenvectors().rowwise().reverse();
  part.size = std::max(part.mu[0], size);
  part.coordinates = std::move(of.rows);
  return part;
}

/// What the modes of a part are measured by: values of the whole.
struct Scale {
  double round_off, largest_mu, orthonormal_to;
};

/// The modes of a part, in its coordinates.
Eigenmodes modes_of(const SolvedPart& part, const Scale& of)
{
  const Index n = part.M.rows(), r = part.R.cols();
  if (part.mu[n - 1] < -of.round_off)
    throw Error("eigenmodes: the mass matrix is not positive semidefinite");
  const Index k = std::min<Index>(n - r, (part.mu.array() > of.round_off).count());
  if (k == 0) return {VectorXd(0), MatrixXd(n, 0), static_cast<int>(n - r)};
  const auto mu = part.mu.head(k);
  MatrixXd X = part.L.transpose().triangularView<Eigen::Upper>().solve(part.Y.leftCols(k));
  X.array().rowwise() /= mu.array().sqrt().transpose();
  const std::vector<Index> massive = with_mass(X, part.M, mu / of.largest_mu, of.orthonormal_to);
  const VectorXd lambda = mu(massive).cwiseInverse();
  return {lambda, orthonormalized(X(every, massive), part.M, part.R),
          static_cast<int>(n - r - lambda.size())};
}

}  // namespace

Eigenmodes merged(const std::vector<PartModes>& parts, Index n)
{
  std::vector<std::pair<double, Index>> order;  // lambda, column of all parts side by side
  int n_massless = 0;
  for (const PartModes& part : parts) {
    for (const double lambda : part.modes.lambda)
      order.emplace_back(lambda, static_cast<Index>(order.size()));
    n_massless += part.modes.n_massless;
  }
  MatrixXd X = MatrixXd::Zero(n, std::ssize(order));
  Index first = 0;
  for (const PartModes& part : parts) {
    const Index k = part.modes.lambda.size();
    X(part.coordinates, Eigen::seqN(first, k)) = part.modes.X;
    first += k;
  }
  if (parts.size() > 1) std::ranges::stable_sort(order, {}, &std::pair<double, Index>::first);
  Eigenmodes all{VectorXd(X.cols()), MatrixXd(n, X.cols()), n_massless};
  for (Index i = 0; i < X.cols(); ++i) {
    const auto [lambda, column] = order[static_cast<std::size_t>(i)];
    all.lambda[i] = lambda;
    all.X.col(i) = X.col(column);
  }
  return all;
}

Eigenmodes eigenmodes_of_part(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                              double mu_of_whole, double orthonormal_to)
{
  const Index n = K.rows(), r = R.cols();
  if (n <= r) return {VectorXd(0), MatrixXd(n, 0), 0};
  const double sigma = deflation_shift(K, M, R);
  std::vector<SolvedPart> parts;
  for (Coordinates& of : decoupled(K, M, R)) parts.push_back(solved(std::move(of), K, M, R, sigma));
  double size = mu_of_whole, largest_mu = mu_of_whole;
  for (const SolvedPart& part : parts) {
    size = std::max(size, part.size);
    largest_mu = std::max(largest_mu, part.mu[0]);
  }
  const Scale scale{
      .round_off = 4.0 * static_cast<double>(n) * std::numeric_limits<double>::epsilon() * size,
      .largest_mu = largest_mu,
      .orthonormal_to = orthonormal_to};
  std::vector<PartModes> modes;
  for (const SolvedPart& part : parts)
    modes.push_back({.coordinates = part.coordinates, .modes = modes_of(part, scale)});
  return merged(modes, n);
}

Eigenmodes eigenmodes(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                      double orthonormal_to)
{
  return eigenmodes_of_part(K, M, R, 0.0, orthonormal_to);
}

double first_eigenvalue(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R)
{
  if (K.rows() <= R.cols()) return 0.0;
  const Eigen::LLT<MatrixXd> B = deflated_factor(K, M, R, deflation_shift(K, M, R));
  constexpr int n_iterations = 30;
  // All coordinates take part, none in a pattern that a mode may have too.
  VectorXd x = VectorXd::NullaryExpr(
      K.rows(), [](Index i) { return std::cos(1.0 + static_cast<double>(i) * std::sqrt(2.0)); });
  double largest = 0.0;  // 1 / lambda, by the quotient of Rayleigh
  for (int i = 0; i < n_iterations; ++i) {
    x -= R * (R.transpose() * (M * x));
    const VectorXd Mx = M * x;
    const double mass = x.dot(Mx);
    if (!(mass > 0.0)) return 0.0;
    x = B.solve(Mx);
    largest = x.dot(Mx) / mass;
    x.normalize();
  }
  return largest > 0.0 ? 1.0 / largest : 0.0;
}

namespace {

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

namespace {

/// Pi^T K Pi with Pi = I - R R^T M: K without the round-off that it has along its zero-energy
/// vectors. Where these are most of the coordinates, as of a body with a single attachment node,
/// round-off is all that stands there, and may be of either sign.
MatrixXd without_zero_energy(const MatrixXd& K, const MatrixXd& MR, const MatrixXd& R)
{
  const MatrixXd KR = K * R;
  MatrixXd K_d = K - MR * KR.transpose() - KR * MR.transpose();
  K_d += MR * (R.transpose() * KR) * MR.transpose();
  return 0.5 * (K_d + K_d.transpose());
}

/// A pivot of round-off may be of either sign. Where it is positive, its motion L^T v = e_i is
/// refused unless its ratio of stiffness and mass is that of a low mode: what is softly supported
/// is no mechanism.
void refuse_massless_mechanism(const Eigen::LLT<MatrixXd>& B, const VectorXd& diagonal,
                               const MatrixXd& M, double sigma)
{
  const double round_off =
      4.0 * static_cast<double>(M.rows()) * std::numeric_limits<double>::epsilon();
  const MatrixXd& L = B.matrixLLT();
  for (Eigen::Index i = 0; i < L.rows(); ++i) {
    if (L(i, i) * L(i, i) > round_off * diagonal[i]) continue;
    const VectorXd v = B.matrixU().solve(VectorXd::Unit(L.rows(), i));  // of the stiffness 1
    if (sigma * v.dot(M * v) > 1.0) continue;
    throw Error(
        "eigenmodes: a motion has neither stiffness nor mass, so the pencil (K, M) is singular; "
        "give its DOFs stiffness or mass, or leave them out");
  }
}

}  // namespace

double deflation_shift(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R)
{
  const MatrixXd K_d = without_zero_energy(K, M * R, R);
  const double without_mass = M.size() > 0 ? 1e-14 * M.diagonal().maxCoeff() : 0.0;
  const VectorXd ratio = (M.diagonal().array() > without_mass)
                             .select(K_d.diagonal().array() / M.diagonal().array(), 0.0);
  const double largest = ratio.size() > 0 ? ratio.maxCoeff() : 0.0;
  if (largest <= 0.0) return 1.0;
  return (ratio.array() > 1e-10 * largest).select(ratio, largest).minCoeff();
}

Eigen::LLT<MatrixXd> deflated_factor(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                                     double sigma)
{
  const MatrixXd MR = M * R;
  const MatrixXd K_d = without_zero_energy(K, MR, R);
  const MatrixXd supported = K_d + sigma * MR * MR.transpose();
  Eigen::LLT<MatrixXd> B(supported);
  if (B.info() != Eigen::Success) {
    throw Error(
        "eigenmodes: the stiffness matrix is singular beyond the rigid-body motions, or indefinite;"
        " is the structure in one piece, without mechanisms, and no attachment node so close to "
        "another"
        " that round-off is all there is between them?");
  }
  refuse_massless_mechanism(B, supported.diagonal(), M, sigma);
  return B;
}

std::vector<std::vector<Index>> decoupled_coordinates(const Eigen::MatrixXd& K,
                                                      const Eigen::MatrixXd& M)
{
  std::vector<std::vector<Index>> sets;
  std::vector<bool> is_known(static_cast<std::size_t>(K.cols()), false);
  for (Index first = 0; first < K.cols(); ++first) {
    if (is_known[static_cast<std::size_t>(first)]) continue;
    std::vector<Index> set{first};
    is_known[static_cast<std::size_t>(first)] = true;
    for (std::size_t next = 0; next < set.size(); ++next) {
      for (Index i = 0; i < K.rows(); ++i) {
        if (is_known[static_cast<std::size_t>(i)]) continue;
        if (K(i, set[next]) == 0.0 && M(i, set[next]) == 0.0) continue;
        is_known[static_cast<std::size_t>(i)] = true;
        set.push_back(i);
      }
    }
    std::ranges::sort(set);
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace chladni::linear
