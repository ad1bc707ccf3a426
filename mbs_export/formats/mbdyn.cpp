#include "mbs_export/formats/mbdyn.hpp"

#include <fmt/format.h>

#include <iterator>

#include "common/error.hpp"

namespace chladni::mbs_export::formats {
namespace {

using Eigen::Index, Eigen::MatrixXd;

std::string group(int number, const std::string& title)
{
  return fmt::format("**\n** RECORD GROUP {},{}\n", number, title);
}

/// By rows, as the reader takes it.
std::string rows(const MatrixXd& A)
{
  std::string text;
  for (Index i = 0; i < A.rows(); ++i)
    for (Index j = 0; j < A.cols(); ++j)
      fmt::format_to(std::back_inserter(text), "{:24.16e}{}", A(i, j),
                     j + 1 == A.cols() ? "\n" : "");
  return text;
}

std::string header(const ModalBody& body, MbdynVersion version)
{
  return fmt::format(
      "** Modal body in SI units, made by Chladni for MBDyn {}. Use it as\n"
      "**   joint: LABEL, modal, NODE, {}, from file, damping from file, \"FILE.fem\",\n"
      "**     origin position, null, N_INTERFACES, ...;\n"
      "** (without \"origin position\" the moments of inertia are not read)\n",
      version == MbdynVersion::v1_7 ? "1.7" : "develop (2023 or later)", body.n_modes());
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

}  // namespace

std::string mbdyn_fem(const FloatingBody& floating, MbdynVersion version)
{
  const ModalBody& body = floating.body;
  if (body.n_modes() == 0) throw Error("MBDyn: the body has no elastic mode");
  if (version == MbdynVersion::v1_7 && coupling(floating) > 1e-6)
    throw Error(
        "MBDyn 1.7 cannot read how the modes of a held body move its centre of mass; leave the "
        "body free (fixed = []), whose modes need no such coupling, or write for mbdyn-develop");
  std::string text =
      header(body, version) + node_groups(body) + mode_group(body) + matrix_groups(body);
  if (version == MbdynVersion::develop)
    text += group(14, "INVARIANT 3") + rows(floating.momentum) + group(15, "INVARIANT 4") +
            rows(floating.angular_momentum);
  return text + "** END OF FILE\n";
}

}  // namespace chladni::mbs_export::formats
