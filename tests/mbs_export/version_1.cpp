#include "version_1.hpp"

#include <cmath>
#include <numbers>

#include "formats/two_nodes.hpp"

namespace chladni::mbs_export::test {
namespace {

using Eigen::Index, Eigen::MatrixXd;

/// 1/3, 2/3, ...: all bits of the mantissa in use.
MatrixXd thirds(Index rows, Index cols)
{
  MatrixXd A(rows, cols);
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < cols; ++j) A(i, j) = double(i * cols + j + 1) / 3.0;
  return A;
}

MassIntegrals some_integrals(Index n)
{
  MassIntegrals integrals{.mass = 1.0 / 7.0,
                          .first = Eigen::Vector3d(0.1, 0.2, 0.3),
                          .second = thirds(3, 3),
                          .displacement = thirds(3, n),
                          .position_displacement = thirds(9, n),
                          .products = {}};
  for (std::size_t i = 0; i < integrals.products.size(); ++i)
    integrals.products[i] = double(i + 1) * thirds(n, n);
  return integrals;
}

ResultantModes some_resultants(Index n)
{
  ResultantModes resultants{.name = "arm",
                            .kinds = {"Q_z", "M_y"},
                            .units = {"N", "N m"},
                            .elements = {17},
                            .positions = thirds(1, 3),
                            .axes = ResultantModes::Rows::Zero(1, 9),
                            .S = thirds(2, n)};
  resultants.axes(0, 0) = resultants.axes(0, 4) = resultants.axes(0, 8) = 1.0;
  return resultants;
}

Picture some_picture(Index n)
{
  return {thirds(3, 3), {{0, 1, 2, 2}, {0, 1, 1, 1}}, thirds(9, n)};
}

Provenance some_provenance()
{
  return {.scene = "title = \"Größe\"\n",
          .mesh_checksum = "0123456789abcdef",
          .versions = "Chladni 0.1.0",
          .options = "-log_view",
          .ranks = 3};
}

/// Three nodes at equal angles.
ContactRing some_ring(Index n)
{
  ContactRing ring{.name = "track",
                   .radius = 0.5,
                   .height = 0.125,
                   .nodes = {0, 1, 2},
                   .angles = Eigen::Vector3d(0.0, 1.0, 2.0) * (2.0 * std::numbers::pi / 3.0),
                   .W = thirds(3, n),
                   .W_r = 2.0 * thirds(3, n),
                   .W_t = 4.0 * thirds(3, n)};
  return ring;
}

}  // namespace

ReducedSystem version_1_reduced()
{
  ReducedSystem reduced = two_nodes();
  const Index n = reduced.K.rows();
  reduced.C = 1e-3 * reduced.M;
  reduced.picture = some_picture(n);
  reduced.certificate = {.fixed = {"ends.z"},
                         .frequencies = Eigen::Vector2d(300.0, 500.0),
                         .eta2 = Eigen::Vector2d(1e-9, 1.0 / 3e6),
                         .bounds = {},
                         .fixed_interface = {},
                         .range = {},
                         .complete = {}};
  reduced.resultants = {some_resultants(n)};
  reduced.mass_integrals = some_integrals(n);
  reduced.provenance = some_provenance();
  return reduced;
}

ModalBody version_1_body()
{
  constexpr Index n = 3;
  ModalBody body{};
  body.title = "three nodes";
  body.kinds = {ModeKind::rigid, ModeKind::constrained, ModeKind::interface};
  body.omega = Eigen::Vector3d(0.0, 1000.0 / 3.0, 5000.0);
  body.C = 1e-2 * thirds(n, n);
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * std::numbers::pi / 3.0 * i;
    body.attachment_nodes.push_back(
        {10 + i, {0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.125}});
  }
  body.sets = {{"track", {0, 1, 2}}};
  body.fixed = {"track.x", "track.y"};
  body.attachment_modes = thirds(18, n);
  body.rings = {some_ring(n)};
  body.picture = some_picture(n);
  body.mass = 1.0 / 7.0;
  body.centre_of_mass = Eigen::Vector3d(0.1, 0.2, 0.3);
  body.inertia = Eigen::Vector3d(1.0, 2.0, 2.5).asDiagonal();
  body.free_frequencies = Eigen::Vector4d(0.0, 0.0, 300.0, 4000.0);
  body.n_rigid = 2;
  body.condition_Q_dd = 4.0 / 3.0;
  body.n_free_rigid = 1;
  body.preparation = {.n_constrained_modes = 7,
                      .n_partners = 1,
                      .n_interface_dropped = 2,
                      .n_massless = 3,
                      .rigid_residual = 1e-13};
  body.resultants = {some_resultants(n)};
  body.mass_integrals = some_integrals(n);
  body.selection = SelectionTable{.error = 1e-3,
                                  .Omega_max = 5e4,
                                  .loads = {"track.z"},
                                  .modes_only = {{"start", 1, 0, 0.5}, {"mode 2", 2, 0, 1e-4}},
                                  .with_interface_modes = {{"start", 1, 0, 0.5}}};
  body.provenance = some_provenance();
  return body;
}

formats::FloatingBody version_1_floating()
{
  formats::FloatingBody floating{.body = version_1_body(), .momentum = {}, .angular_momentum = {}};
  floating.momentum = floating.body.mass_integrals->displacement;
  floating.angular_momentum = 0.5 * floating.momentum;
  return floating;
}

}  // namespace chladni::mbs_export::test
