#include "linear/dense/eigenmodes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"

namespace chladni::linear {

using Eigen::Index, Eigen::MatrixXd;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// For each row of the matrix; two are usual.
constexpr Index most_steps = 40;
/// After so many in vain for one eigenvalue a shift of another kind is taken, and once more.
constexpr int steps_in_vain = 10;

/// A reflection of two or three neighbouring rows or columns.
struct Reflection {
  Index n;      ///< 2 or 3
  double v[3];  ///< v[0] = 1
  double beta;  ///< 1 - beta v v^T
  double norm;  ///< what the first component of the reflected vector becomes

  /// That which leaves x but its first component; nothing to reflect where its norm is 0.
  static Reflection of(const double* x, Index n)
  {
    Reflection to{n, {1.0, 0.0, 0.0}, 0.0, 0.0};
    const double length = std::hypot(x[0], x[1], n == 3 ? x[2] : 0.0);
    if (length == 0.0) return to;
    to.norm = -std::copysign(length, x[0]);
    const double first = x[0] - to.norm;
    to.beta = -first / to.norm;
    for (Index i = 1; i < n; ++i) to.v[i] = x[i] / first;
    return to;
  }

  /// Rows k, k + 1 ... of the columns from `begin` to before `end`.
  void of_rows(MatrixXd& H, Index k, Index begin, Index end) const
  {
    double* h = &H(k, begin);
    for (Index j = begin; j < end; ++j, h += H.rows()) {
      const double third = n == 3 ? h[2] : 0.0;
      const double s = beta * (h[0] + v[1] * h[1] + v[2] * third);
      h[0] -= s;
      h[1] -= s * v[1];
      if (n == 3) h[2] -= s * v[2];
    }
  }

  /// Columns k, k + 1 ... of the rows from `begin` to before `end`.
  void of_columns(MatrixXd& H, Index k, Index begin, Index end) const
  {
    const Index n_rows = end - begin;
    const auto column = [&](Index j) { return H.col(k + j).segment(begin, n_rows); };
    if (n == 2) {
      for (Index i = begin; i < end; ++i) {
        const double s = beta * (H(i, k) + v[1] * H(i, k + 1));
        H(i, k) -= s;
        H(i, k + 1) -= s * v[1];
      }
      return;
    }
    auto a = column(0), b = column(1), c = column(2);
    for (Index i = 0; i < n_rows; ++i) {
      const double s = beta * (a[i] + v[1] * b[i] + v[2] * c[i]);
      a[i] -= s;
      b[i] -= s * v[1];
      c[i] -= s * v[2];
    }
  }
};

/// The QR iteration by double shifts (Francis), which transforms only the block whose eigenvalues
/// are looked for.
class QrIteration {
 public:
  explicit QrIteration(const MatrixXd& A)
      : H_(Eigen::HessenbergDecomposition<MatrixXd>(A).matrixH()),
        nothing_(std::max(epsilon * epsilon * H_.cwiseAbs().sum() / double(H_.rows()),
                          std::numeric_limits<double>::min())),
        found_(H_.rows())
  {}

  Eigen::VectorXcd eigenvalues()
  {
    int steps = 0;  // for the eigenvalue at the end
    Index all_steps = 0;
    for (Index last = H_.rows() - 1; last >= 0;) {
      const Index first = begin_of_block(last);
      if (last - first < 2) {
        last - first == 0 ? take_one(last) : take_pair(last);
        last = first - 1;
        steps = 0;
        continue;
      }
      ++steps;
      if (++all_steps > most_steps * H_.rows())
        throw Error("eigenvalues of a matrix: the QR iteration did not converge");
      step(first, last, shifts(last, steps == steps_in_vain || steps == 2 * steps_in_vain));
    }
    return found_;
  }

 private:
  /// The eigenvalues of two rows, as two diagonal entries and the product of the others: they are
  /// near to those of H, and their sum and product would lose digits.
  struct Shifts {
    double a, d, bc;
  };

  /// The first row of the block that ends in a row: what is below the diagonal before it is nothing
  /// beside its neighbours, or beside what rounding has left of the whole matrix.
  Index begin_of_block(Index last)
  {
    for (Index i = last; i > 0; --i) {
      const double beside = std::abs(H_(i - 1, i - 1)) + std::abs(H_(i, i));
      if (std::abs(H_(i, i - 1)) <= std::max(epsilon * beside, nothing_)) {
        H_(i, i - 1) = 0.0;
        return i;
      }
    }
    return 0;
  }

  void take_one(Index i) { found_[i] = H_(i, i); }

  /// Of the block of two rows that ends in row i.
  void take_pair(Index i)
  {
    const double half = 0.5 * (H_(i - 1, i - 1) - H_(i, i)), bc = H_(i, i - 1) * H_(i - 1, i);
    const double q = half * half + bc, root = std::sqrt(std::abs(q));
    if (q < 0.0) {
      found_[i - 1] = {H_(i, i) + half, root};
      found_[i] = std::conj(found_[i - 1]);
      return;
    }
    const double far = half + std::copysign(root, half);  // the other one without cancellation
    found_[i - 1] = H_(i, i) + far;
    found_[i] = far == 0.0 ? H_(i, i) : H_(i, i) - bc / far;
  }

  /// The eigenvalues of the last two rows; others where these lead nowhere.
  Shifts shifts(Index last, bool are_in_vain) const
  {
    if (are_in_vain) {
      const double size = std::abs(H_(last, last - 1)) + std::abs(H_(last - 1, last - 2));
      const double off = H_(last, last) + 0.75 * size;
      return {off, off, -0.4375 * size * size};
    }
    return {H_(last - 1, last - 1), H_(last, last), H_(last, last - 1) * H_(last - 1, last)};
  }

  /// The first column of (H - s_1)(H - s_2) of the rows from k on, but for a factor.
  void first_column(Index k, const Shifts& s, double (&x)[3]) const
  {
    const double a = s.a - H_(k, k), d = s.d - H_(k, k);
    x[0] = (a * d - s.bc) / H_(k + 1, k) + H_(k, k + 1);
    x[1] = H_(k + 1, k + 1) - H_(k, k) - a - d;
    x[2] = H_(k + 2, k + 1);
  }

  /// One sweep over the rows from `first` to `last`.
  void step(Index first, Index last, const Shifts& s)
  {
    double x[3];
    Index begin = last - 2;
    for (;; --begin) {
      first_column(begin, s, x);
      if (begin == first) break;
      // Two small ones in a row: the sweep may begin below them.
      const double left = std::abs(H_(begin, begin - 1)) * (std::abs(x[1]) + std::abs(x[2]));
      const double beside = std::abs(H_(begin - 1, begin - 1)) + std::abs(H_(begin, begin)) +
                            std::abs(H_(begin + 1, begin + 1));
      if (left <= epsilon * std::abs(x[0]) * beside) break;
    }
    for (Index k = begin; k < last; ++k) {
      const Index n = std::min<Index>(3, last - k + 1);
      if (k > begin)
        for (Index i = 0; i < n; ++i) x[i] = H_(k + i, k - 1);
      const Reflection reflection = Reflection::of(x, n);
      if (reflection.norm == 0.0) continue;
      if (k > begin) {
        H_(k, k - 1) = reflection.norm;
        for (Index i = 1; i < n; ++i) H_(k + i, k - 1) = 0.0;
      } else if (k > first) {
        H_(k, k - 1) *= 1.0 - reflection.beta;  // the two below are nothing
      }
      reflection.of_rows(H_, k, k, last + 1);
      reflection.of_columns(H_, k, first, std::min(k + 4, last + 1));
    }
  }

  MatrixXd H_;
  double nothing_;
  Eigen::VectorXcd found_;
};

}  // namespace

Eigen::VectorXcd real_eigenvalues(const MatrixXd& A)
{
  if (A.rows() == 0) return {};
  if (!A.allFinite()) throw Error("eigenvalues of a matrix with entries that are not finite");
  const double largest = A.cwiseAbs().maxCoeff();
  if (largest == 0.0) return Eigen::VectorXcd::Zero(A.rows());
  // A power of two changes no digit, and keeps products from overflow and underflow.
  const double scale = std::scalbn(1.0, std::ilogb(largest));
  return scale * QrIteration(A / scale).eigenvalues();
}

}  // namespace chladni::linear
