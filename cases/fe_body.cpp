#include "cases/fe_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "plate/assembly/rigid_motions.hpp"

namespace chladni::cases {
namespace {

/// "node 17 (0.1, 0.2, 0), z"; nothing for a DOF that is no component of a node.
std::string name_of_dof(const FeModel& fe, PetscInt dof)
{
  const plate::DofMap& dofs = fe.system.dofs;
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    for (const int c : dofs.components()) {
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

}  // namespace chladni::cases
