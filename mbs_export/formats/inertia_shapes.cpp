#include "mbs_export/formats/inertia_shapes.hpp"

namespace chladni::mbs_export::formats {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd;

Matrix3d position_tilde_shape(const MassIntegrals& integrals, Index j)
{
  // Column j by rows: W_kl = int x_k phi_l dm.
  const Matrix3d W = integrals.position_displacement.col(j).reshaped(3, 3).transpose();
  return W.transpose() - W.trace() * Matrix3d::Identity();
}

MatrixXd cross_product(const MassIntegrals& integrals, int c)
{
  const MatrixXd S = displacement_product(integrals, (c + 1) % 3, (c + 2) % 3);
  return S - S.transpose();
}

Matrix3d inertia_about_origin(const MassIntegrals& integrals)
{
  return integrals.second.trace() * Matrix3d::Identity() - integrals.second;
}

}  // namespace chladni::mbs_export::formats
