// Couplings in chains, conflicts and groups that do not determine a motion.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "hard_case.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/dofs/free_motions.hpp"
#include "tests/plate/small_disc.hpp"
#include "tests/plate/square_plate.hpp"

namespace chladni::hard_cases {
namespace {

using namespace plate;

mesh::Mesh rectangle()
{
  return testing::rectangle({.a = 2.0, .b = 1.0, .n_x = 4, .n_y = 3, .order = 2});
}

DofMap map_of(const mesh::Mesh& mesh, const std::vector<Coupling>& couplings)
{
  return make_dof_map(mesh, {.couplings = couplings}, mesh::node_owners(mesh, 1), 1);
}

Coupling link(const std::string& group, const std::string& to)
{
  return {.name = {}, .group = group, .kind = CouplingKind::link, .to = to};
}

Coupling average(const std::string& name, const std::string& group)
{
  return {.name = name, .group = group, .kind = CouplingKind::averaging};
}

double refusal(const std::vector<Coupling>& couplings, const std::vector<std::string>& words)
{
  const mesh::Mesh mesh = rectangle();
  return words_missing([&] { map_of(mesh, couplings); }, words);
}

/// Values of a rigid motion, translation along (component < 3) or rotation about an axis, at every
/// DOF of the system.
petsc::Vector rigid_motion(const System& system, int component)
{
  petsc::Vector q;
  petsc::check(MatCreateVecs(system.K, q.put(), nullptr));
  for (int node = 0; node < system.dofs.n_nodes(); ++node) {
    const Eigen::Vector3d x = system.dofs.position(node);
    Eigen::Vector<double, 6> motion = Eigen::Vector<double, 6>::Unit(component);
    if (component >= 3) motion.head<3>() = Eigen::Vector3d::Unit(component - 3).cross(x);
    for (int c = 0; c < 6; ++c) {
      const auto dof = system.dofs.dof(node, c);
      if (dof) petsc::check(VecSetValue(q, *dof, motion[c], INSERT_VALUES));
    }
  }
  petsc::check(VecAssemblyBegin(q));
  petsc::check(VecAssemblyEnd(q));
  return q;
}

/// Largest |K r| / |K| over the six rigid motions r of the coupled plate.
double force_of_rigid_motions(const mesh::Mesh& mesh, const std::vector<ShellSection>& sections,
                              const std::vector<Coupling>& couplings)
{
  const System system = assemble(mesh, sections, map_of(mesh, couplings), PETSC_COMM_SELF);
  double K_norm = 0.0, largest = 0.0;
  petsc::check(MatNorm(system.K, NORM_FROBENIUS, &K_norm));
  for (int component = 0; component < 6; ++component) {
    const petsc::Vector r = rigid_motion(system, component);
    petsc::Vector force;
    petsc::check(VecDuplicate(r, force.put()));
    petsc::check(MatMult(system.K, r, force));
    double norm = 0.0;
    petsc::check(VecNorm(force, NORM_2, &norm));
    largest = std::max(largest, norm / K_norm);
  }
  return largest;
}

const std::vector<ShellSection> plate_section{
    {.group = "plate",
     .material = {.young = 2e11, .poisson = 0.3, .density = 8000.0},
     .thickness = 0.1}};

/// What is said of a support on these nodes of the rectangle, whose bottom follows "base".
double refusal_of_support(const std::string& group, const std::vector<std::string>& words)
{
  const mesh::Mesh mesh = rectangle();
  const DofMap dofs = map_of(mesh, {{.name = "base", .group = "bottom"}});
  return words_missing(
      [&] { held_dofs(mesh, dofs, std::vector<Support>{{.group = group, .components = {2}}}); },
      words);
}

/// Free motions that are not found of a rectangle hinged along one edge.
double missing_free_motions()
{
  const mesh::Mesh mesh = rectangle();
  const DofMap dofs = map_of(mesh, {});
  const auto parts = free_parts(
      mesh, dofs,
      held_dofs(mesh, dofs, std::vector<Support>{{.group = "left", .components = {0, 1, 2}}}));
  return std::abs(n_free_motions(parts) - 1.0);
}

/// A reference node whose nodes belong to no element.
double refusal_of_reference_without_stiffness()
{
  mesh::Mesh mesh = rectangle();
  mesh.positions.push_back({0.0, 0.0, 1.0});
  mesh.node_numbers.push_back(4711);
  mesh.groups.push_back({.name = "loose", .dimension = 0, .nodes = {mesh.n_nodes() - 1}});
  const std::vector<int> owners(mesh.n_nodes(), 0);
  const std::vector<Coupling> tip{{.name = "tip", .group = "loose"}};
  return words_missing([&] { make_dof_map(mesh, {.couplings = tip}, owners, 1); },
                       {"\"tip\"", "element"});
}

/// Force of the rigid motions of a plate at a lever, and how far its reference node is from its
/// place.
double error_of_a_lever()
{
  const std::array<double, 3> at{1.0, -2.0, 0.5};
  const std::vector<Coupling> lever{{.name = "lever", .group = "bottom", .at = at}};
  const mesh::Mesh mesh = rectangle();
  const DofMap dofs = map_of(mesh, lever);
  const Eigen::Vector3d off = Eigen::Vector3d(dofs.position(dofs.reference_node("lever").value())) -
                              Eigen::Vector3d(at.data());
  return force_of_rigid_motions(mesh, plate_section, lever) + off.norm();
}

}  // namespace

std::vector<HardCase> coupling_cases()
{
  const std::string area = "couplings", words = "words missing in the refusal";
  const std::string rigid = "force of the rigid motions over |K|";
  return {
      {area, "link to a group that is itself rigidly coupled", "a chain of dependent nodes", rigid,
       1e-13,
       [] {
         return force_of_rigid_motions(
             rectangle(), plate_section,
             {link("top", "bottom"), {.name = "base", .group = "bottom"}});
       }},
      {area, "reference node 2 m away from its nodes", "masses and springs act at a lever", rigid,
       1e-13, error_of_a_lever},
      {area, "links in a circle", "each group follows the other", words, 0.0,
       [] {
         return refusal({link("top", "bottom"), link("bottom", "top")}, {"circle", "top"});
       }},
      {area, "two couplings claim one group", "double dependence", words, 0.0,
       [] {
         return refusal({link("top", "bottom"), {.name = "base", .group = "top"}},
                        {"two couplings", "base"});
       }},
      {area, "link to a single node", "several nodes would follow the same one: ambiguous", words,
       0.0,
       [] {
         return refusal({link("right", "centre")}, {"both nearest", "pair"});
       }},
      {area, "average over nodes on a line", "its rotation about the line is not determined", words,
       0.0,
       [] {
         return refusal({average("pad", "left")}, {"pad", "left", "one line"});
       }},
      {area, "average over one node", "rotations are not determined", words, 0.0,
       [] {
         return refusal({average("pad", "corner")}, {"pad", "too few"});
       }},
      {area, "average over a circle of the disc", "dense rows, and pivots among its own nodes",
       rigid, 1e-13,
       [] {
         return force_of_rigid_motions(testing::small_disc(), testing::section,
                                       {average("pad", "inner_edge")});
       }},
      {area, "mid-surface off its mesh by half of a varying thickness",
       "bending and stretching are coupled by the offset", rigid, 1e-13,
       [] {
         const std::vector<ShellSection> tapered{
             {.group = "plate",
              .material = plate_section[0].material,
              .thickness = {Coordinate::x, {0.0, 2.0}, {0.1, 0.3}},
              .offset = {Coordinate::x, {0.0, 2.0}, {0.05, 0.15}}}};
         return force_of_rigid_motions(rectangle(), tapered, {});
       }},
      {area, "reference node of nodes without element", "a DOF without stiffness: K is singular",
       words, 0.0, refusal_of_reference_without_stiffness},
      {area, "support on nodes that follow a coupling", "an attachment node that is dependent",
       words, 0.0, [] { return refusal_of_support("bottom", {"\"base\" instead"}); }},
      {area, "plate hinged along one edge",
       "free to turn about it, though three DOFs of each node are held", "free motions not found",
       0.0, missing_free_motions},
  };
}

}  // namespace chladni::hard_cases
