#include "mbs_export/condensed_body.hpp"

#include <fmt/format.h>

#include <utility>

#include "common/error.hpp"
#include "linear/dense/orthogonal_factor.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// An orthonormal basis of the columns, each of which counts alike.
MatrixXd orthonormal(MatrixXd shapes)
{
  constexpr double independent = 1e-10;
  Index n = 0;
  for (Index j = 0; j < shapes.cols(); ++j)
    if (const double norm = shapes.col(j).norm(); norm > 0.0)
      shapes.col(n++) = shapes.col(j) / norm;
  if (n == 0) return MatrixXd(shapes.rows(), 0);
  const MatrixXd unit = shapes.leftCols(n);
  Eigen::ColPivHouseholderQR<MatrixXd> qr(unit);
  qr.setThreshold(independent);
  return linear::columns_of_Q(qr, qr.rank());
}

/// Frequencies and kinds of the vectors that take the place of the modes.
struct Condensed {
  VectorXd omega;
  std::vector<ModeKind> kinds;
  MatrixXd V;  ///< [n_modes x k]
};

Condensed ritz_vectors(const ModalBody& body, const MatrixXd& Q)
{
  constexpr double same = 1e-6, at_rest = 1e-13;  // of the squares of frequencies
  const VectorXd lambda = body.omega.cwiseAbs2();
  const MatrixXd K = Q.transpose() * lambda.asDiagonal() * Q;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(K);
  Condensed modes{ritz.eigenvalues(), {}, Q * ritz.eigenvectors()};
  const double largest = modes.omega.cwiseAbs().maxCoeff();
  for (Index j = 0; j < modes.omega.size(); ++j) {
    double& value = modes.omega[j];
    const bool is_rigid = value <= at_rest * largest && body.n_free_rigid > 0;
    if (is_rigid) value = 0.0;
    const double residual = (lambda.cwiseProduct(modes.V.col(j)) - value * modes.V.col(j)).norm();
    modes.kinds.push_back(is_rigid                   ? ModeKind::rigid
                          : residual <= same * value ? ModeKind::constrained
                                                     : ModeKind::interface);
  }
  modes.omega = modes.omega.cwiseMax(0.0).cwiseSqrt();
  return modes;
}

/// A V; of what the body does not have, nothing.
MatrixXd along(const MatrixXd& A, const MatrixXd& V)
{
  if (A.cols() == 0) return {};
  return A * V;
}

MatrixXd projected(const MatrixXd& A, const MatrixXd& V)
{
  if (A.size() == 0) return {};
  return V.transpose() * A * V;
}

}  // namespace

ModalBody condensed(const ModalBody& body, const MatrixXd& shapes)
{
  if (shapes.rows() != body.n_modes()) {
    throw Error(fmt::format("shapes of {} rows cannot condense a body of {} modes", shapes.rows(),
                            body.n_modes()));
  }
  const MatrixXd Q = orthonormal(shapes);
  if (Q.cols() == 0) throw Error("a body cannot be condensed to no shape at all");
  Condensed modes = ritz_vectors(body, Q);
  const MatrixXd& V = modes.V;
  ModalBody result = body;
  result.omega = modes.omega;
  result.kinds = std::move(modes.kinds);
  result.C = projected(body.C, V);
  result.H = projected(body.H, V);
  result.attachment_modes = along(body.attachment_modes, V);
  for (ContactRing& ring : result.rings) {
    ring.W = along(ring.W, V);
    ring.W_r = along(ring.W_r, V);
    ring.W_t = along(ring.W_t, V);
  }
  result.picture.transformation = along(body.picture.transformation, V);
  for (ResultantModes& one : result.resultants) one.S = one.S * V;
  if (body.mass_integrals) result.mass_integrals = in_coordinates(*body.mass_integrals, V);
  if (body.stiffening) result.stiffening = in_coordinates(*body.stiffening, V);
  if (body.sector_harmonics) {
    const MatrixXd I = MatrixXd::Identity(body.n_modes(), body.n_modes());
    result.sector_harmonics = in_coordinates(*body.sector_harmonics, I, V);
  }
  result.selection = {};
  return result;
}

}  // namespace chladni::mbs_export
