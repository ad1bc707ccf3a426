#include "mbs_export/formats/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "mbs_export/formats/export_error.hpp"
#include "mbs_export/formats/floating_body.hpp"

namespace chladni::mbs_export::formats {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd;

namespace {

std::string group(int number, const std::string& title)
{
  return fmt::format("**\n** RECORD GROUP {},{}\n", number, title);
}

/// By rows, as the reader takes it.
std::string rows(const MatrixXd& A)
{
  std::string text;
  for (Index i = 0; i < A.rows(); ++i)
    for (Index j = 0; j < A.cols(); ++j) {
      fmt::format_to(std::back_inserter(text), "{:24.16e}{}", A(i, j),
                     j + 1 == A.cols() ? "\n" : "");
    }
  return text;
}

std::string mbdyn_header(const ModalBody& body, MbdynVersion version)
{
  const bool is_old = version == MbdynVersion::v1_7;
  return fmt::format(
      "** Modal body in SI units, made by Chladni for MBDyn {}. Use it as\n"
      "**   joint: LABEL, modal, NODE, {}, from file, damping from file, \"FILE.fem\",\n"
      "**     N_INTERFACES, ...;\n{}",
      is_old ? "1.7" : "develop (2023 or later)", body.n_modes(),
      is_old
          ? ""
          : "** To find the modes of a body that spins, say \"use automatic differentiation;\" in "
            "the control data.\n");
}

std::string node_groups(const ModalBody& body)
{
  std::string text =
      group(1, "HEADER") + "** REVISION, NODES, NORMAL, ATTACHMENT, CONSTRAINT, REJECTED MODES\n" +
      fmt::format("REV0 {} {} 0 0 0\n", body.attachment_nodes.size(), body.n_modes());
  text += group(2, "NODE NUMBERS");
  for (const AttachmentNode& node : body.attachment_nodes) text += fmt::format("{}\n", node.number);
  for (int axis = 0; axis < 3; ++axis) {
    text += group(5 + axis, fmt::format("{} COORDINATES OF THE NODES", "XYZ"[axis]));
    for (const AttachmentNode& node : body.attachment_nodes)
      text += fmt::format("{:24.16e}\n", node.position[axis]);
  }
  return text;
}

std::string mode_group(const ModalBody& body)
{
  std::string text = group(8, "MODE SHAPES");
  for (Index j = 0; j < body.n_modes(); ++j) {
    const Eigen::VectorXd mode = body.attachment_modes.col(j);
    const auto by_node = mode.reshaped(6, mode.size() / 6).transpose();
    text += fmt::format("** MODE {}, {:.6g} rad/s\n", j + 1, body.omega[j]) + rows(by_node);
  }
  return text;
}

std::string matrix_groups(const ModalBody& body)
{
  const Index n = body.n_modes();
  const MatrixXd K = body.omega.cwiseAbs2().asDiagonal();
  return group(9, "MODAL MASS MATRIX") + rows(MatrixXd::Identity(n, n)) +
         group(10, "MODAL STIFFNESS MATRIX") + rows(K) +
         group(12, "MASS, CENTRE OF MASS, INERTIA ABOUT IT") +
         fmt::format("{:24.16e}\n", body.mass) + rows(body.centre_of_mass.transpose()) +
         rows(body.inertia) + group(13, "MODAL DAMPING MATRIX") +
         rows(body.C.size() > 0 ? body.C : MatrixXd::Zero(n, n));
}

/// Inv5_jk = int u_j x u_k dm, [3 x n^2]: k runs fastest.
MatrixXd invariant_5(const MassIntegrals& integrals)
{
  const Index n = integrals.displacement.cols();
  MatrixXd I5(3, n * n);
  for (int c = 0; c < 3; ++c)
    I5.row(c) = cross_product(integrals, c).reshaped<Eigen::RowMajor>().transpose();
  return I5;
}

/// Inv8_j = -int x~ u~_j dm, [3 x 3 n].
MatrixXd invariant_8(const MassIntegrals& integrals)
{
  const Index n = integrals.displacement.cols();
  MatrixXd I8(3, 3 * n);
  for (Index j = 0; j < n; ++j) I8.middleCols<3>(3 * j) = -position_tilde_shape(integrals, j);
  return I8;
}

/// Inv9_jk = int u~_j u~_k dm = int u_k u_j^T - (u_j . u_k) I dm, [3 x 3 n^2]: k before j, the
/// three columns first.
MatrixXd invariant_9(const MassIntegrals& integrals)
{
  const Index n = integrals.displacement.cols();
  const MatrixXd M = integrals.products[0] + integrals.products[1] + integrals.products[2];
  MatrixXd I9(3, 3 * n * n);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      MatrixXd P = displacement_product(integrals, c, r);  // (r, c) of u_k u_j^T: u_c,j u_r,k
      if (r == c) P -= M;
      const RowVectorXd by_rows = P.reshaped<Eigen::RowMajor>();
      for (Index i = 0; i < n * n; ++i) I9(r, 3 * i + c) = by_rows(i);
    }
  return I9;
}

/// How the body's momentum and inertia change with its deformation.
std::string invariant_groups(const FloatingBody& floating)
{
  std::string text = group(14, "INVARIANT 3") + rows(floating.momentum) + group(15, "INVARIANT 4") +
                     rows(floating.angular_momentum);
  if (!floating.body.mass_integrals) return text;
  const MassIntegrals& integrals = *floating.body.mass_integrals;
  return text + group(16, "INVARIANT 8") + rows(invariant_8(integrals)) + group(17, "INVARIANT 5") +
         rows(invariant_5(integrals)) + group(18, "INVARIANT 9") + rows(invariant_9(integrals));
}

/// The factors of MBDyn's record group 19 are those of `stiffening_loads`, counted from 1.
std::string stiffening_matrix_group(const ModalBody& body)
{
  if (!body.stiffening || body.stiffening->loads.empty()) return "";
  const Stiffening& stiffening = *body.stiffening;
  std::string text =
      group(19, "MODAL STRESS STIFFENING MATRICES: NUMBER, LOAD AND MATRIX OF EACH") +
      fmt::format("{}\n", stiffening.loads.size());
  for (std::size_t i = 0; i < stiffening.loads.size(); ++i) {
    const auto load = std::ranges::find(stiffening_loads, stiffening.loads[i]);
    text += fmt::format("{}\n", load - stiffening_loads.begin() + 1) + rows(stiffening.K[i]);
  }
  return text;
}

}  // namespace

std::string mbdyn_fem(const FloatingBody& floating, MbdynVersion version)
{
  const ModalBody& body = floating.body;
  if (body.n_modes() == 0) throw ExportError("body.keep", "MBDyn: the body has no elastic mode");
  if (version == MbdynVersion::v1_7 && coupling(floating) > 1e-6) {
    throw ExportError(
        "body.fixed",
        "MBDyn 1.7 cannot read how the modes of a held body move its centre of mass; leave the "
        "body free (fixed = []), whose modes need no such coupling, or write for mbdyn-develop");
  }
  std::string text =
      mbdyn_header(body, version) + node_groups(body) + mode_group(body) + matrix_groups(body);
  if (version == MbdynVersion::develop)
    text += invariant_groups(floating) + stiffening_matrix_group(body);
  return text + "** END OF FILE\n";
}

}  // namespace chladni::mbs_export::formats
