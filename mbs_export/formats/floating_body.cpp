#include "mbs_export/formats/floating_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/check_body.hpp"
#include "mbs_export/formats/export_error.hpp"
#include "mbs_export/free_modes.hpp"
#include "mbs_export/make_body.hpp"

namespace chladni::mbs_export::formats {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd;

namespace {

/// Asks for all reduced coordinates where a picture asks for the displacements of some nodes, so
/// that the body comes with its modes in the reduced coordinates.
ReducedSystem with_all_coordinates(ReducedSystem reduced)
{
  const Index n = reduced.K.rows();
  reduced.resultants.clear();
  reduced.mass_integrals.reset();
  reduced.stiffening.reset();
  reduced.picture_of_sectors.reset();
  reduced.picture = {};
  reduced.picture.positions.setZero(1, 3);
  reduced.picture.transformation = MatrixXd::Identity(n, n);
  return reduced;
}

/// The modes from `n_rigid` on.
ModalBody elastic_part(const ModalBody& body, Index n_rigid)
{
  const Index n = body.n_modes() - n_rigid;
  ModalBody elastic = body;
  elastic.kinds.erase(elastic.kinds.begin(), elastic.kinds.begin() + n_rigid);
  elastic.omega = body.omega.tail(n);
  if (body.C.size() > 0) elastic.C = body.C.bottomRightCorner(n, n);
  elastic.attachment_modes = body.attachment_modes.rightCols(n);
  elastic.rings.clear();
  elastic.picture = {};
  elastic.resultants.clear();
  elastic.mass_integrals.reset();
  return elastic;
}

/// What it is in the reduced coordinates, for the modes T.
void add_from_reduced(ModalBody& elastic, const ReducedSystem& reduced, const MatrixXd& T)
{
  if (reduced.mass_integrals) elastic.mass_integrals = in_coordinates(*reduced.mass_integrals, T);
  if (reduced.stiffening && are_same_support(reduced, reduced.stiffening->fixed, elastic.fixed))
    elastic.stiffening = in_coordinates(*reduced.stiffening, T);
  elastic.picture = picture_in(reduced, T);
}

/// Whether A R != 0 for the rigid motions R of the masters, where A = A^T >= 0: then and only then
/// R_k^T A R_k > 0. Beyond round-off, which is a share of the largest such sum without signs; the
/// size of the body makes rotations and translations comparable.
bool resists_rigid_motion(const ReducedSystem& reduced, const MatrixXd& A, double round_off)
{
  MatrixXd R = rigid_body_vectors(reduced, centre_of_nodes(reduced));
  R.rightCols(3) /= check_parts::characteristic_length(reduced.attachment_nodes);
  const MatrixXd terms = R.cwiseAbs().transpose() * A.cwiseAbs() * R.cwiseAbs();
  return (R.transpose() * A * R).diagonal().cwiseAbs().maxCoeff() >
         round_off * terms.diagonal().maxCoeff();
}

void refuse_dampers_to_ground(const ReducedSystem& reduced, const Damping& damping)
{
  if (damping.type != Damping::Type::matrix || reduced.C.size() == 0) return;
  // C_r = Q_CB^T C Q_CB has the round-off of a product, and Q_CB R that of a solution, squared.
  if (!resists_rigid_motion(reduced, reduced.C, 1e-10)) return;
  throw ExportError(
      "spring.damping",
      "a damper to the ground slows the rigid motion, but this format has no damping except "
      "between elastic modes; put the damper into the model of the other program and take it out "
      "of the scene, or leave all dampers out with damping = { type = \"none\" } in [body]");
}

void require_rigid_motions(const ReducedSystem& reduced, int n_rigid)
{
  if (n_rigid == 6) return;
  // K_r is a difference of large numbers.
  if (resists_rigid_motion(reduced, reduced.K, 1e-8)) {
    throw ExportError(
        "spring.stiffness",
        "a spring to the ground holds the body, but a floating frame needs a free one; put the "
        "spring into the model of the other program and take it out of the scene");
  }
  throw ExportError(
      "interface.nodes",
      fmt::format("the interface nodes show {} of the 6 rigid-body motions; a floating frame needs "
                  "a free body with all of them",
                  n_rigid));
}

}  // namespace

FloatingBody floating_body(const ReducedSystem& reduced, const BodyOptions& options)
{
  refuse_dampers_to_ground(reduced, options.damping);
  const ModalBody body = make_body(with_all_coordinates(reduced), options);
  require_rigid_motions(reduced, body.n_rigid);
  const Index n_rigid = std::ranges::count(body.kinds, ModeKind::rigid);
  const MatrixXd T = body.picture.transformation.rightCols(body.n_modes() - n_rigid);
  const MatrixXd P =
      rigid_body_vectors(reduced, Eigen::Vector3d::Zero()).transpose() * (reduced.M * T);
  ModalBody elastic = elastic_part(body, n_rigid);
  add_from_reduced(elastic, reduced, T);
  return {
      .body = std::move(elastic), .momentum = P.topRows(3), .angular_momentum = P.bottomRows(3)};
}

double coupling(const FloatingBody& floating)
{
  const ModalBody& body = floating.body;
  if (body.n_modes() == 0) return 0.0;
  const double inertia = body.inertia.trace() + body.mass * body.centre_of_mass.squaredNorm();
  return std::max(floating.momentum.colwise().norm().maxCoeff() / std::sqrt(body.mass),
                  floating.angular_momentum.colwise().norm().maxCoeff() / std::sqrt(inertia));
}

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
