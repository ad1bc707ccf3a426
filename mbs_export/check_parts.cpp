#include "mbs_export/check_parts.hpp"

#include <algorithm>
#include <cmath>

#include "linear/dense/dense_solvers.hpp"

namespace chladni::mbs_export {

Verdict worst(const std::vector<Check>& checks)
{
  Verdict verdict = Verdict::pass;
  for (const Check& check : checks) verdict = std::max(verdict, check.verdict);
  return verdict;
}

namespace check_parts {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

Check bounded(const std::string& name, double value, double limit, const std::string& meaning)
{
  const Verdict verdict = !(value <= limit)      ? Verdict::fail
                          : value > 1e-2 * limit ? Verdict::warn
                                                 : Verdict::pass;
  return {name, verdict, value, limit, meaning};
}

Check expected(const std::string& name, double value, double limit, Verdict otherwise,
               const std::string& meaning)
{
  return {name, value == limit ? Verdict::pass : otherwise, value, limit, meaning};
}

double asymmetry(const MatrixXd& A)
{
  if (A.size() == 0) return 0.0;
  const VectorXd scale = A.diagonal().cwiseAbs().cwiseSqrt();
  const double round_off = 1e-14 * A.cwiseAbs().maxCoeff();
  double largest = 0.0;
  for (Index j = 0; j < A.cols(); ++j)
    for (Index i = 0; i < j; ++i) {
      const double difference = std::abs(A(i, j) - A(j, i));
      if (difference > round_off)
        largest = std::max(largest, difference / (scale[i] * scale[j] + round_off));
    }
  return largest;
}

MatrixXd unit_diagonal(const MatrixXd& A)
{
  const double largest = A.size() > 0 ? std::sqrt(A.diagonal().cwiseAbs().maxCoeff()) : 0.0;
  if (largest == 0.0) return A;
  VectorXd scale = VectorXd::Constant(A.rows(), 1.0 / largest);
  for (Index i = 0; i < A.rows(); ++i)
    if (A(i, i) > 0.0) scale[i] = 1.0 / std::sqrt(A(i, i));
  return scale.asDiagonal() * A * scale.asDiagonal();
}

VectorXd relative_eigenvalues(const MatrixXd& A)
{
  if (A.size() == 0) return {};
  const MatrixXd symmetric = 0.5 * (A + A.transpose());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric, Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().cwiseAbs().maxCoeff();
  return largest > 0.0 ? VectorXd(solver.eigenvalues() / largest) : VectorXd();
}

Check check_inertia(const Eigen::Matrix3d& inertia)
{
  const Eigen::Matrix3d symmetric = 0.5 * (inertia + inertia.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(symmetric);
  const Eigen::Vector3d& J = solver.eigenvalues();
  const double size = J.cwiseAbs().maxCoeff();
  const double asymmetric = (inertia - symmetric).cwiseAbs().maxCoeff();
  const double excess = std::max({-J[0], J[2] - J[1] - J[0], asymmetric, 0.0});
  return bounded("inertia", size > 0.0 ? excess / size : 1.0, 1e-6,
                 "excess of the largest principal moment over the sum of the others");
}

Check check_mass_integrals(const MassIntegrals& integrals, const MatrixXd& M)
{
  const auto& S = integrals.products;
  const MatrixXd difference = S[0] + S[1] + S[2] - M;
  const Eigen::VectorXd scale = M.diagonal().cwiseMax(1e-14 * M.diagonal().maxCoeff());
  const Eigen::VectorXd s = scale.cwiseSqrt().cwiseInverse();
  return bounded("mass integrals",
                 (s.asDiagonal() * difference * s.asDiagonal()).cwiseAbs().maxCoeff(), 1e-8,
                 "S_xx + S_yy + S_zz against M over sqrt(M_ii M_jj)");
}

Check check_stiffening(const Stiffening& stiffening)
{
  double largest = 0.0;
  for (const MatrixXd& K : stiffening.K) {
    const double size = K.cwiseAbs().maxCoeff();
    if (size != 0.0) largest = std::max(largest, (K - K.transpose()).cwiseAbs().maxCoeff() / size);
  }
  return bounded("geometric stiffness", largest, 1e-10,
                 "largest |A_ij - A_ji| over the largest entry of each matrix");
}

double characteristic_length(const std::vector<AttachmentNode>& nodes)
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const AttachmentNode& node : nodes) centre += node.position;
  centre /= static_cast<double>(std::max<std::size_t>(1, nodes.size()));
  double sum = 0.0;
  for (const AttachmentNode& node : nodes) sum += (node.position - centre).squaredNorm();
  const double length =
      std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, nodes.size())));
  return length > 0.0 ? length : 1.0;
}

}  // namespace check_parts
}  // namespace chladni::mbs_export
