#include "squeal/stability/turning_modes.hpp"

#include <Eigen/LU>
#include <numbers>
#include <numeric>

#include "linear/dense/dense_solvers.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// Norm of a harmonic that is left out, 1/s: no exponent moves by more than about that.
constexpr double negligible = 1e-6;

}  // namespace

TurningHarmonics turning_harmonics(TurningBrake brake, int bound)
{
  const Eigen::Index N = power_of_two(2 * bound + 2);
  const Eigen::MatrixXd A_0 = brake.at(0.0);
  AngleSamples A(A_0.size(), N);
  for (Eigen::Index s = 0; s < N; ++s)
    A.col(s) = brake.at(2.0 * pi * double(s) / double(N)).reshaped().cast<std::complex<double>>();
  const AngleHarmonics c = harmonics_of(std::move(A));
  TurningHarmonics found{0, 0, 0.0};
  for (Eigen::Index k = 1; k < N / 2; ++k) {
    const double norm = 2.0 * c.col(k).norm();
    if (norm < negligible) {
      found.left += norm;
      continue;
    }
    found.nu = std::gcd(found.nu, static_cast<int>(k));
    found.highest = static_cast<int>(k);
  }
  return found;
}

TurningModes turning_modes(TurningBrake brake, double speed, const TurningHarmonics& harmonics,
                           Eigen::Index N)
{
  std::vector<Eigen::MatrixXd> A;
  for (Eigen::Index s = 0; s < N; ++s)
    A.push_back(brake.at(2.0 * pi * double(s) / (double(N) * std::max(1, harmonics.nu))));
  Eigen::MatrixXd A_0 = Eigen::MatrixXd::Zero(A[0].rows(), A[0].cols());
  for (const Eigen::MatrixXd& sample : A) A_0 += sample / double(N);
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A_0);
  const Eigen::MatrixXcd V = solver.eigenvectors();
  const Eigen::MatrixXcd V_inverse = Eigen::PartialPivLU<Eigen::MatrixXcd>(V).inverse();
  // The upper half of A, the rates of the coordinates, does not depend on the angle.
  const Eigen::Index m = A_0.rows(), n = m / 2;
  const Eigen::MatrixXd V_re = V.real(), V_im = V.imag();
  const Eigen::MatrixXcd right = V_inverse.rightCols(n);
  const int nu = std::max(1, harmonics.nu);
  TurningModes modes{nu * speed, solver.eigenvalues(), AngleSamples(m * m, N),
                     harmonics.highest / nu};
  Eigen::MatrixXcd product(n, m);
  for (Eigen::Index s = 0; s < N; ++s) {
    const Eigen::MatrixXd change = (A[static_cast<std::size_t>(s)] - A_0).bottomRows(n);
    product.real() = change * V_re;
    product.imag() = change * V_im;
    Eigen::Map<Eigen::MatrixXcd>(modes.B.col(s).data(), m, m).noalias() = right * product;
  }
  return modes;
}

}  // namespace chladni::squeal
