#include "plate/assembly/geometric_stiffness.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>

#include "plate/assembly/element_motion.hpp"
#include "plate/assembly/inertia_integrals.hpp"
#include "plate/assembly/recovery.hpp"
#include "plate/elements/geometric_stiffness.hpp"
#include "plate/sections/sections.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// An element of the model under its load.
struct LoadedElement {
  const MassModel& model;
  const mesh::ElementBlock& block;
  int element;
  const MatrixXd& motions;  ///< [n_nodes x 6] of all nodes
  const MassLoad& load;

  std::span<const int> nodes() const { return block.element_nodes(element); }
};

/// From a node that others follow to one of these; zero at other nodes.
Vector3d coupling_arm(const DofMap& dofs, int node)
{
  return dofs.is_dependent(node) ? dofs.arm(node) : Vector3d::Zero();
}

/// u_e at the points where the DOFs of the element stand.
VectorXd element_displacements(const LoadedElement& of, const NodeVectors& arms)
{
  const std::span<const int> nodes = of.nodes();
  VectorXd u_e(6 * std::ssize(nodes));
  for (Index i = 0; i < std::ssize(nodes); ++i) {
    u_e.segment<6>(6 * i) = of.motions.row(nodes[i]).transpose();
    if (arms.size() == 0) continue;
    const Eigen::Vector3d arm = arms.row(i);
    u_e.segment<3>(6 * i) += u_e.segment<3>(6 * i + 3).cross(arm);
  }
  return u_e;
}

MatrixXd stress_stiffness(const LoadedElement& of, const VectorXd& u_e)
{
  const auto& [model, block, element, motions, load] = of;
  const int group = block.group[element];
  if (block.shape == mesh::Shape::line) {
    return beam_geometric_stiffness(element_positions(model.mesh, block, element),
                                    model.structure.beams[model.sections.beam[group]], u_e,
                                    line_fields(model.sections.on_surface, of.nodes()));
  }
  if (mesh::is_solid(block.shape)) {
    return solid_geometric_stiffness(solid_of_mesh(model.mesh, block, element),
                                     model.structure.solids[model.sections.solid[group]].material,
                                     u_e);
  }
  const ShellSection& section = model.structure.shells[model.sections.shell[group]];
  return shell_geometric_stiffness(
      block.shape, block.order, shell_nodes(model.mesh, block, element, model.directors, section),
      section.material, u_e);
}

/// Adds what the element pulls at the arms by which it follows: K_e u_e and the load that it passes
/// on.
void add_arms(const LoadedElement& of, const NodeVectors& offsets, const VectorXd& u_e,
              MatrixXd& K_e)
{
  const MassModel& model = of.model;
  const std::span<const int> nodes = of.nodes();
  const auto follows = [&](int node) { return model.dofs.is_dependent(node); };
  if (offsets.size() == 0 && std::ranges::none_of(nodes, follows)) return;
  const ElementContext context{model.sections, model.structure, model.directors};
  const VectorXd forces =
      element_matrices(model.mesh, of.block, of.element, context).matrices.K * u_e -
      element_moments(element_points(model, of.block, of.element).points) * of.load;
  for (Index i = 0; i < std::ssize(nodes); ++i) {
    Vector3d arm = coupling_arm(model.dofs, nodes[i]);
    if (offsets.size() > 0) arm += offsets.row(i).transpose();
    K_e.block<3, 3>(6 * i + 3, 6 * i + 3) += arm_geometric_stiffness(forces.segment<3>(6 * i), arm);
  }
}

/// Of a lumped mass, in the motion of its node: the load of each of its points at its arm.
MatrixXd mass_stiffness(const MassModel& model, std::size_t i, const MassLoad& load)
{
  const int node = model.mass_nodes[i];
  const Vector3d x = model.dofs.position(node);
  const Vector3d end = x - coupling_arm(model.dofs, node);
  const MassPoints points = rigid_mass_points(model.masses[i], x);
  MatrixXd K = MatrixXd::Zero(6, 6);
  for (Index p = 0; p < points.dm.size(); ++p) {
    const Vector3d at = points.x.row(p);
    const Vector3d force = points.dm[p] * (load.head<3>() + load.tail<9>().reshaped(3, 3) * at);
    K.bottomRightCorner<3, 3>() += arm_geometric_stiffness(-force, at - end);
  }
  return K;
}

}  // namespace

petsc::Matrix geometric_stiffness(const MassModel& model, Vec u, const MassLoad& load)
{
  const MatrixXd motions = node_motions(model.dofs, u);
  const int rank = petsc::rank(model.comm);
  BlockRows K(model.pattern);
  const auto add_at = [&](MatrixXd K_e, const ElementMotion& motion) {
    add_symmetric(K, std::move(K_e), motion, model.dofs,
                  block_places(model.pattern, motion.numbers));
  };
  for_owned_elements(model.mesh, model.dofs, rank,
                     [&](const mesh::ElementBlock& block, int e, const auto& /*numbers*/) {
                       const LoadedElement of{model, block, e, motions, load};
                       const NodeVectors offsets = element_points(model, block, e).arms;
                       const VectorXd u_e = element_displacements(of, offsets);
                       MatrixXd K_e = stress_stiffness(of, u_e);
                       add_arms(of, offsets, u_e, K_e);
                       add_at(std::move(K_e),
                              element_motion(model.dofs, block.element_nodes(e), offsets));
                     });
  for (std::size_t i = 0; i < model.masses.size(); ++i) {
    const std::array nodes{model.mass_nodes[i]};
    add_at(mass_stiffness(model, i, load), element_motion(model.dofs, nodes, {}));
  }
  return K.to_matrix(model.comm);
}

}  // namespace chladni::plate
