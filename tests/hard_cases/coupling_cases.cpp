// Couplings in chains, conflicts and groups that do not determine a motion.
#include <Eigen/Geometry>
#include <cmath>

#include "hard_case.hpp"
#include "plate/free_motions.hpp"
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
  return make_dof_map(mesh, couplings, mesh::node_owners(mesh, 1), 1);
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

/// How many free motions more or less than the six of one rigid body the coupled plate has.
double surplus_of_free_motions(const mesh::Mesh& mesh, const std::vector<ShellSection>& sections,
                               const std::vector<Coupling>& couplings)
{
  const System system = assemble(mesh, sections, map_of(mesh, couplings), PETSC_COMM_SELF);
  return std::abs(n_free_motions(free_parts(mesh, system, {})) - 6);
}

const std::vector<ShellSection> plate_section{
    {.group = "plate",
     .material = {.young = 2e11, .poisson = 0.3, .density = 8000.0},
     .thickness = 0.1}};

}  // namespace

std::vector<HardCase> coupling_cases()
{
  const std::string area = "couplings", words = "words missing in the refusal";
  const std::string surplus = "free motions beyond or below six";
  return {
      {area, "link to a group that is itself rigidly coupled", "a chain of dependent nodes",
       surplus, 0.0,
       [] {
         return surplus_of_free_motions(
             rectangle(), plate_section,
             {link("top", "bottom"), {.name = "base", .group = "bottom"}});
       }},
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
       surplus, 0.0,
       [] {
         return surplus_of_free_motions(testing::small_disc(), testing::section,
                                        {average("pad", "inner_edge")});
       }},
      {area, "mid-surface off its mesh by half of a varying thickness",
       "bending and stretching are coupled by the offset", surplus, 0.0,
       [] {
         const std::vector<ShellSection> tapered{
             {.group = "plate",
              .material = plate_section[0].material,
              .thickness = {Coordinate::x, {0.0, 2.0}, {0.1, 0.3}},
              .offset = {Coordinate::x, {0.0, 2.0}, {0.05, 0.15}}}};
         return surplus_of_free_motions(rectangle(), tapered, {});
       }},
  };
}

}  // namespace chladni::hard_cases
