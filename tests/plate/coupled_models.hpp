#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "plate/assembly/assemble.hpp"
#include "small_disc.hpp"
#include "square_plate.hpp"

/// Small models with couplings, and what the assembled system makes of motions.
namespace chladni::plate::testing {

inline const Material material{.young = 2e11, .poisson = 0.3, .density = 8000.0};

inline mesh::Mesh plate()
{
  return rectangle({.a = 2.0, .b = 1.0, .n_x = 4, .n_y = 3, .order = 2});
}

inline DofMap dofs_of(const mesh::Mesh& mesh, const Kinematics& kinematics)
{
  const int n = petsc::size(PETSC_COMM_WORLD);
  return make_dof_map(mesh, kinematics, mesh::node_owners(mesh, n), n);
}

inline DofMap map_of(const mesh::Mesh& mesh, const std::vector<Coupling>& couplings)
{
  return dofs_of(mesh, {.couplings = couplings});
}

inline Coupling link(const std::string& group, const std::string& to)
{
  return {.name = {}, .group = group, .kind = CouplingKind::link, .to = to};
}

inline Coupling average(const std::string& name, const std::string& group)
{
  return {.name = name, .group = group, .kind = CouplingKind::averaging};
}

inline std::string error_of(const mesh::Mesh& mesh, const Kinematics& kinematics)
{
  try {
    dofs_of(mesh, kinematics);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline std::string error_of(const mesh::Mesh& mesh, const std::vector<Coupling>& couplings)
{
  return error_of(mesh, Kinematics{.couplings = couplings});
}

inline void expect_words(const std::string& message, const std::vector<std::string>& words)
{
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << word << " is not in: " << message;
}

/// A vector of random entries, the same on each number of ranks.
inline petsc::Vector random_motion(const System& system)
{
  petsc::Vector q;
  petsc::check(MatCreateVecs(system.K, q.put(), nullptr));
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> entries(-1.0, 1.0);
  PetscInt n = 0, first = 0, last = 0;
  petsc::check(VecGetSize(q, &n));
  petsc::check(VecGetOwnershipRange(q, &first, &last));
  for (PetscInt i = 0; i < n; ++i) {
    const double value = entries(generator);
    if (i >= first && i < last) petsc::check(VecSetValue(q, i, value, INSERT_VALUES));
  }
  petsc::check(VecAssemblyBegin(q));
  petsc::check(VecAssemblyEnd(q));
  return q;
}

inline System disc_system(const mesh::Mesh& mesh, const std::vector<Coupling>& couplings)
{
  return assemble(mesh, section, map_of(mesh, couplings), PETSC_COMM_WORLD);
}

/// q^T A q
inline double energy(Mat A, Vec q)
{
  petsc::Vector A_q;
  petsc::check(VecDuplicate(q, A_q.put()));
  petsc::check(MatMult(A, q, A_q));
  double energy = 0.0;
  petsc::check(VecDot(q, A_q, &energy));
  return energy;
}

/// u^T A u for a motion of all nodes that is the same with and without a coupling.
inline double rotation_energy(const System& system, Mat A)
{
  petsc::Vector q;
  petsc::check(MatCreateVecs(system.K, q.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(q, &first, &last));
  for (int node = 0; node < system.dofs.n_nodes(); ++node) {
    const Eigen::Vector3d x = system.dofs.position(node);
    const std::array<double, 6> motion{0.0, 0.0, x[0] - 2.0 * x[1], -2.0, -1.0, 0.0};
    for (int c = 0; c < 6; ++c) {
      const auto dof = system.dofs.dof(node, c);
      if (!dof || *dof < first || *dof >= last) continue;
      petsc::check(VecSetValue(q, *dof, motion[c], INSERT_VALUES));
    }
  }
  petsc::check(VecAssemblyBegin(q));
  petsc::check(VecAssemblyEnd(q));
  return energy(A, q);
}

}  // namespace chladni::plate::testing
