#include "squeal/stability/column_eigenvalues.hpp"

#include <algorithm>
#include <complex>
#include <optional>
#include <vector>

#include "squeal/stability/eigenvalue_branches.hpp"
#include "squeal/stability/eigenvalue_discs.hpp"
#include "squeal/stability/pole_sum.hpp"
#include "squeal/stability/stability.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

/// Below these sizes the QR iteration of each matrix takes less time.
constexpr Index smallest_matrix = 24;
constexpr Index shortest_sequence = 8;

/// All eigenvalues with Im > 0 of the last matrices, the latest at the end.
class Branches {
 public:
  void add(Eigen::VectorXcd values)
  {
    if (last_.size() == 4) last_.erase(last_.begin());
    last_.push_back(std::move(values));
  }
  /// By the polynomial through the last values.
  Eigen::VectorXcd next() const
  {
    static constexpr double weights[4][4] = {{1}, {-1, 2}, {1, -3, 3}, {-1, 4, -6, 4}};
    const auto n = last_.size();
    Eigen::VectorXcd value = weights[n - 1][0] * last_[0];
    for (std::size_t i = 1; i < n; ++i) value += weights[n - 1][i] * last_[i];
    return value;
  }

 private:
  std::vector<Eigen::VectorXcd> last_;
};

/// In the eigenvectors of the first matrix, or of another one where these are nearly dependent.
std::optional<LowRankChange> change_over(const MatrixOf& A, Index n)
{
  std::vector<Eigen::MatrixXd> samples;
  for (const Index i : {Index{0}, n - 1, n / 3}) samples.push_back(A(i));
  for (const Eigen::MatrixXd& A_0 : samples)
    if (auto change = LowRankChange::about(A_0, samples)) return change;
  return std::nullopt;
}

class Follower {
 public:
  explicit Follower(const LowRankChange& change) : change_(change) {}

  /// Absent where the QR iteration has to do it.
  std::optional<Complex> follow(const Eigen::MatrixXd& A)
  {
    const std::optional<PoleSum> sum = change_.sum_of(A);
    if (!sum || !known_) return std::nullopt;
    auto found = least_stable_in_discs(*sum, change_.poles(), branches_.next(), A.trace());
    if (!found) return std::nullopt;
    branches_.add(std::move(found->all));
    return found->lambda;
  }

  /// @param all  eigenvalues of the matrix at hand, by the QR iteration
  void learn(const Eigen::VectorXcd& all)
  {
    branches_.add(matched(all, known_ ? branches_.next() : change_.poles()));
    known_ = true;
  }

 private:
  const LowRankChange& change_;
  Branches branches_;
  bool known_ = false;
};

}  // namespace

LeastStableSequence least_stable_eigenvalues(const MatrixOf& A, Index n)
{
  LeastStableSequence sequence{.lambda = Eigen::VectorXcd(n), .count = {}};
  std::optional<LowRankChange> change;
  if (n >= shortest_sequence && A(0).rows() >= smallest_matrix) change = change_over(A, n);
  std::optional<Follower> follower;
  if (change) follower.emplace(*change);
  for (Index i = 0; i < n; ++i) {
    const Eigen::MatrixXd A_i = A(i);
    if (follower)
      if (const auto lambda = follower->follow(A_i)) {
        sequence.lambda[i] = *lambda;
        ++sequence.count.by_discs;
        continue;
      }
    const Eigen::VectorXcd all = oscillating_eigenvalues(A_i);
    Index worst = 0;
    all.real().maxCoeff(&worst);
    sequence.lambda[i] = all[worst];
    ++sequence.count.by_qr;
    if (follower) follower->learn(all);
  }
  return sequence;
}

}  // namespace chladni::squeal
