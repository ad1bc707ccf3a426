#include "bending_modes.hpp"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <complex>
#include <ctime>
#include <numbers>

#include "common/eigen_every.hpp"
#include "plate/elements/shell_element.hpp"
#include "plate/sections/sections.hpp"
#include "reduce/fixed_interface_modes.hpp"
#include "serendipity.hpp"

namespace chladni::benchmarks {

namespace {

using Eigen::Index;
using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor, PetscInt>;

double cpu_seconds()
{
  return double(std::clock()) / CLOCKS_PER_SEC;
}

/// Equation of w, theta_x, theta_y of each node in use; -1 for nodes that are held or unused.
struct Equations {
  std::vector<int> of_node;  ///< [n_nodes] the first of three
  int n = 0;
};

std::vector<int> lattice_places(const mesh::ElementBlock& block, Formulation formulation)
{
  if (formulation == Formulation::serendipity) return serendipity_places(block.shape);
  std::vector<int> all(block.nodes_per_element);
  for (int i = 0; i < block.nodes_per_element; ++i) all[i] = i;
  return all;
}

Equations number_equations(const mesh::Mesh& plate, Formulation formulation)
{
  Equations equations{.of_node = std::vector<int>(plate.n_nodes(), -1)};
  for (const mesh::ElementBlock& block : plate.blocks) {
    const std::vector<int> places = lattice_places(block, formulation);
    for (int e = 0; e < block.n_elements(); ++e)
      for (const int k : places) equations.of_node[block.element_nodes(e)[k]] = 0;
  }
  for (const int node : mesh::find_group(plate, "inner_edge").nodes) equations.of_node[node] = -1;
  for (int& first : equations.of_node) {
    if (first < 0) continue;
    first = equations.n;
    equations.n += 3;
  }
  return equations;
}

plate::ShellNodes selected(const plate::ShellNodes& nodes, const std::vector<int>& places)
{
  return {.x = nodes.x(places, every), .D = nodes.D(places, every)};
}

struct Triplets {
  std::vector<Eigen::Triplet<double, PetscInt>> K, M;
};

void add_element(Triplets& entries, const plate::ElementMatrices& matrices,
                 const std::vector<int>& first_equations)
{
  for (std::size_t a = 0; a < first_equations.size(); ++a) {
    for (std::size_t b = 0; b < first_equations.size(); ++b) {
      if (first_equations[a] < 0 || first_equations[b] < 0) continue;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          const auto row = static_cast<Index>(6 * a + 2 + i),
                     column = static_cast<Index>(6 * b + 2 + j);
          entries.K.emplace_back(first_equations[a] + i, first_equations[b] + j,
                                 matrices.K(row, column));
          entries.M.emplace_back(first_equations[a] + i, first_equations[b] + j,
                                 matrices.M(row, column));
        }
      }
    }
  }
}

Triplets assemble(const mesh::Mesh& plate, Formulation formulation,
                  const plate::ShellSection& section, const Equations& equations)
{
  const plate::Directors directors = plate::shell_directors(plate);
  Triplets entries;
  for (const mesh::ElementBlock& block : plate.blocks) {
    const std::vector<int> places = lattice_places(block, formulation);
    for (int e = 0; e < block.n_elements(); ++e) {
      const plate::ShellNodes nodes = plate::shell_nodes(plate, block, e, directors, section);
      std::vector<int> first_equations;
      for (const int k : places)
        first_equations.push_back(equations.of_node[block.element_nodes(e)[k]]);
      add_element(entries,
                  formulation == Formulation::serendipity
                      ? serendipity_matrices(block.shape, selected(nodes, places), section.material)
                      : plate::shell_matrices(block.shape, block.order, nodes, section.material),
                  first_equations);
    }
  }
  return entries;
}

petsc::Matrix to_petsc(const std::vector<Eigen::Triplet<double, PetscInt>>& entries, int n)
{
  Sparse A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  petsc::Matrix view, matrix;
  petsc::check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, A.outerIndexPtr(),
                                         A.innerIndexPtr(), A.valuePtr(), view.put()));
  petsc::check(MatDuplicate(view, MAT_COPY_VALUES, matrix.put()));
  petsc::check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  petsc::check(MatSetOption(matrix, MAT_SPD, PETSC_TRUE));
  return matrix;
}

/// The harmonic around the disc that the outermost nodes show most of.
std::vector<int> count_diameters(const mesh::Mesh& plate, const Equations& equations, Mat Phi,
                                 int n_modes)
{
  double r_a = 0.0;
  for (const auto& x : plate.positions) r_a = std::max(r_a, std::hypot(x[0], x[1]));
  constexpr int n_harmonics = 16;
  Eigen::MatrixXcd amplitude = Eigen::MatrixXcd::Zero(n_harmonics, n_modes);
  const double* values = nullptr;
  petsc::check(MatDenseGetArrayRead(Phi, &values));
  for (int node = 0; node < plate.n_nodes(); ++node) {
    const auto& x = plate.positions[node];
    if (equations.of_node[node] < 0 || std::hypot(x[0], x[1]) < r_a * (1.0 - 1e-9)) continue;
    const double angle = std::atan2(x[1], x[0]);
    for (int n = 0; n < n_harmonics; ++n) {
      for (int k = 0; k < n_modes; ++k) {
        const double w = values[std::ptrdiff_t(k) * equations.n + equations.of_node[node]];
        amplitude(n, k) += w * std::polar(n == 0 ? std::numbers::sqrt2 / 2.0 : 1.0, n * angle);
      }
    }
  }
  petsc::check(MatDenseRestoreArrayRead(Phi, &values));
  std::vector<int> diameters(n_modes);
  for (int k = 0; k < n_modes; ++k) amplitude.col(k).cwiseAbs().maxCoeff(&diameters[k]);
  return diameters;
}

}  // namespace

BendingModes bending_modes(const mesh::Mesh& plate, Formulation formulation,
                           const plate::ShellSection& section, int n_modes)
{
  const double start = cpu_seconds();
  const Equations equations = number_equations(plate, formulation);
  const Triplets entries = assemble(plate, formulation, section, equations);
  const petsc::Matrix K = to_petsc(entries.K, equations.n);
  const petsc::Matrix M = to_petsc(entries.M, equations.n);
  const double assembled = cpu_seconds();
  const reduce::FixedInterfaceModes modes =
      reduce::fixed_interface_modes(linear::factorize(K), M, {.modes = n_modes});
  const double solved = cpu_seconds();
  const auto n = static_cast<int>(modes.omega.size());
  return {.n_dofs = equations.n,
          .f_Hz = Eigen::Map<const Eigen::VectorXd>(modes.omega.data(), n) / (2 * std::numbers::pi),
          .n_diameters = count_diameters(plate, equations, modes.Phi, n),
          .assembly_s = assembled - start,
          .modes_s = solved - assembled};
}

}  // namespace chladni::benchmarks
