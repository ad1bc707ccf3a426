#include "cases/fe_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/dofs/drilling.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd;

namespace {

/// "node 17 (0.1, 0.2, 0), z"; nothing for a DOF that is no component of a node.
std::string name_of_dof(const FeModel& fe, PetscInt dof)
{
  const plate::DofMap& dofs = fe.system.dofs;
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    for (const int c : dofs.components_of(node)) {
      if (dofs.dof(node, c) != dof) continue;
      const Eigen::Vector3d x = dofs.position(node);
      return fmt::format("node {} ({:.6g}, {:.6g}, {:.6g}), {}", node_number(fe.mesh, dofs, node),
                         x[0], x[1], x[2], plate::component_names[static_cast<std::size_t>(c)]);
    }
  }
  return "";
}

/// For other programs: -cms_view_stiffness binary:K.petsc, -cms_view_mass, -cms_view_masters, and
/// what else PETSc's viewers know.
void view_from_options(const FeModel& fe)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(fe.system.K, &first, &last));
  std::vector<PetscInt> own;
  std::ranges::copy_if(fe.attachments.master_dofs, std::back_inserter(own),
                       [&](PetscInt dof) { return dof >= first && dof < last; });
  petsc::IndexSet masters;
  petsc::check(ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(own.size()), own.data(),
                               PETSC_COPY_VALUES, masters.put()));
  petsc::check(MatViewFromOptions(fe.system.K, nullptr, "-cms_view_stiffness"));
  petsc::check(MatViewFromOptions(fe.system.M, nullptr, "-cms_view_mass"));
  petsc::check(ISViewFromOptions(masters, nullptr, "-cms_view_masters"));
}

}  // namespace

bool geometry_tells_motions(const scene::Scene& scene, const FeModel& fe)
{
  const bool is_free = std::ranges::all_of(
      scene.springs, [](const plate::Spring& spring) { return spring.to.has_value(); });
  return is_free && !fe.system.dofs.has_combined_motions();
}

reduce::Body body_of(const scene::Scene& scene, FeModel& fe)
{
  view_from_options(fe);
  petsc::Matrix R =
      geometry_tells_motions(scene, fe) ? plate::rigid_motions(fe.system) : petsc::Matrix();
  return {.K = std::move(fe.system.K),
          .M = std::move(fe.system.M),
          .masters = {fe.attachments.master_dofs.begin(), fe.attachments.master_dofs.end()},
          .R = std::move(R),
          .name_of_dof = [&](PetscInt dof) { return name_of_dof(fe, dof); }};
}

namespace {

bool is_of_ring(const plate::DofMap& dofs, int node)
{
  return std::ranges::any_of(dofs.harmonic_rings(), [&](const plate::HarmonicRing& ring) {
    return std::ranges::find(ring.nodes, node) != ring.nodes.end();
  });
}

void add_node_masters(Attachments& attachments, const plate::DofMap& dofs)
{
  for (int i = 0; i < std::ssize(attachments.nodes); ++i) {
    const int node = attachments.nodes[static_cast<std::size_t>(i)];
    if (is_of_ring(dofs, node)) continue;
    for (const int c : dofs.components_of(node)) {
      attachments.masters.push_back({.node = i, .component = c});
      attachments.master_dofs.push_back(dofs.dof(node, c).value());
    }
  }
}

void add_ring_masters(Attachments& attachments, const plate::DofMap& dofs)
{
  for (const plate::HarmonicRing& ring : dofs.harmonic_rings()) {
    const auto set =
        std::ranges::find(attachments.sets, ring.name, &mbs_export::AttachmentSet::name);
    for (int k = 0; k < ring.n_wanted(); ++k) {
      const plate::Harmonic harmonic = plate::harmonic_of(k);
      for (const int c : dofs.components_of(ring.nodes.front())) {
        attachments.masters.push_back({.node = -1,
                                       .component = c,
                                       .harmonic = mbs_export::RingHarmonic{
                                           .set = static_cast<int>(set - attachments.sets.begin()),
                                           .order = harmonic.order,
                                           .is_sine = harmonic.is_sine}});
        attachments.master_dofs.push_back(dofs.harmonic_dof(ring, k, c).value());
      }
    }
  }
}

void check_independent(const mesh::Mesh& mesh, const plate::DofMap& dofs, const std::string& name,
                       int node)
{
  for (const int component : dofs.components_of(node)) {
    if (dofs.dof(node, component) || is_of_ring(dofs, node)) continue;
    const std::string& followed = dofs.followed(node);
    if (followed.empty()) {
      throw Error(
          fmt::format("interface node set \"{}\": an equation of the mesh moves node {} as "
                      "others move; name one of those in interface.nodes instead",
                      name, mesh.node_numbers[node]));
    }
    throw Error(
        fmt::format("interface node set \"{}\": node {} follows \"{}\"; put \"{}\" into "
                    "interface.nodes instead",
                    name, mesh.node_numbers[node], followed, followed));
  }
}

}  // namespace

std::int64_t node_number(const mesh::Mesh& mesh, const plate::DofMap& dofs, int node)
{
  if (node < dofs.n_mesh_nodes()) return mesh.node_numbers[node];
  return mesh.node_numbers.back() + 1 + node - dofs.n_mesh_nodes();
}

Attachments find_attachments(const mesh::Mesh& mesh, const plate::DofMap& dofs,
                             const std::vector<std::string>& names)
{
  Attachments attachments;
  for (const std::string& name : names) {
    mbs_export::AttachmentSet set{.name = name, .nodes = {}};
    for (const int node : dofs.named_nodes(mesh, name)) {
      check_independent(mesh, dofs, name, node);
      const auto it = std::ranges::find(attachments.nodes, node);
      set.nodes.push_back(static_cast<int>(it - attachments.nodes.begin()));
      if (it == attachments.nodes.end()) attachments.nodes.push_back(node);
    }
    attachments.sets.push_back(std::move(set));
  }
  add_node_masters(attachments, dofs);
  add_ring_masters(attachments, dofs);
  const Eigen::MatrixX3d axes = plate::drilling_axes(mesh, dofs, attachments.nodes);
  for (Index i = 0; i < axes.rows(); ++i) attachments.drilling_axes.push_back(axes.row(i));
  return attachments;
}

bool has_ring_nodes(const Attachments& attachments, const plate::DofMap& dofs,
                    const mbs_export::AttachmentSet& set)
{
  return std::ranges::any_of(set.nodes, [&](int node) {
    return is_of_ring(dofs, attachments.nodes[static_cast<std::size_t>(node)]);
  });
}

MatrixXd master_shapes(const Attachments& attachments, const plate::DofMap& dofs)
{
  std::map<int, Index> column_of;
  for (const int dof : attachments.master_dofs) column_of.emplace(dof, std::ssize(column_of));
  MatrixXd F = MatrixXd::Zero(6 * std::ssize(attachments.nodes), std::ssize(column_of));
  for (Index i = 0; i < std::ssize(attachments.nodes); ++i) {
    for (const plate::MotionTerm& term :
         dofs.motion(attachments.nodes[static_cast<std::size_t>(i)])) {
      for (const int c : dofs.components()) {
        const auto found = column_of.find(dofs.dof_of_number(term.number, c).value());
        if (found != column_of.end()) F.block<6, 1>(6 * i, found->second) += term.T.col(c);
      }
    }
  }
  return F;
}

mbs_export::ReducedSystem described_system(const scene::Scene& scene, const FeModel& fe)
{
  mbs_export::ReducedSystem system;
  system.title = scene.title;
  system.sets = fe.attachments.sets;
  for (std::size_t i = 0; i < fe.attachments.nodes.size(); ++i) {
    const int node = fe.attachments.nodes[i];
    const Eigen::Vector3d x = fe.system.dofs.position(node);
    system.attachment_nodes.push_back({.number = node_number(fe.mesh, fe.system.dofs, node),
                                       .position = {x[0], x[1], x[2]},
                                       .drilling_axis = fe.attachments.drilling_axes[i]});
  }
  system.masters = fe.attachments.masters;
  if (!fe.system.dofs.harmonic_rings().empty()) {
    const Eigen::MatrixXd F = master_shapes(fe.attachments, fe.system.dofs);
    system.ring_motion = {.shapes = F, .displacements = F};  // of the masters alone
  }
  return system;
}

std::vector<std::string> certified_support(const scene::Scene& scene, const FeModel& fe)
{
  std::vector<std::string> support;
  for (const std::string& fixed : scene.body.fixed) {
    const bool is_master = std::ranges::none_of(fe.attachments.sets, [&](const auto& set) {
      const bool is_meant = fixed == set.name || fixed.substr(0, fixed.rfind('.')) == set.name;
      return is_meant && has_ring_nodes(fe.attachments, fe.system.dofs, set);
    });
    if (is_master) support.push_back(fixed);
  }
  return support;
}

namespace {

/// The first components of the motions of nodes.
template <int n_components>
MatrixXd motion_rows(const std::vector<int>& nodes, const plate::DofMap& dofs,
                     const RowsOf& rows_of)
{
  const int n_c = dofs.n_components();
  std::vector<int> numbers;  // on which the nodes depend, each once
  for (const int node : nodes)
    for (const plate::MotionTerm& term : dofs.motion(node)) numbers.push_back(term.number);
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<int> wanted;
  for (const int number : numbers)
    for (int c = 0; c < n_c; ++c) wanted.push_back(n_c * number + c);
  const MatrixXd known = rows_of(wanted);
  MatrixXd rows = MatrixXd::Zero(n_components * std::ssize(nodes), known.cols());
  for (Index k = 0; k < std::ssize(nodes); ++k) {
    for (const plate::MotionTerm& term : dofs.motion(nodes[static_cast<std::size_t>(k)])) {
      const auto place = std::ranges::lower_bound(numbers, term.number) - numbers.begin();
      const MatrixXd T = term.T.topRows<n_components>()(every, dofs.components());
      rows.middleRows<n_components>(n_components * k).noalias() +=
          T.lazyProduct(known.middleRows(n_c * place, n_c));
    }
  }
  return rows;
}

}  // namespace

MatrixXd node_rows(const std::vector<int>& nodes, const plate::DofMap& dofs, const RowsOf& rows_of)
{
  return motion_rows<6>(nodes, dofs, rows_of);
}

MatrixXd displacement_rows(const std::vector<int>& nodes, const plate::DofMap& dofs,
                           const RowsOf& rows_of)
{
  return motion_rows<3>(nodes, dofs, rows_of);
}

}  // namespace chladni::cases
