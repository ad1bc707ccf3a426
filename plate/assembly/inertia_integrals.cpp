#include "plate/assembly/inertia_integrals.hpp"

#include <array>
#include <numeric>
#include <vector>

#include "common/eigen_every.hpp"
#include "plate/assembly/element_motion.hpp"
#include "plate/assembly/element_points.hpp"
#include "plate/dofs/point_elements.hpp"
#include "plate/sections/directors.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Calls visit(mass points, motion, is counted here) for all elements and masses that have to do
/// with numbers of this rank; each is counted on one rank alone.
template <typename Visit>
void for_owned_points(const MassModel& model, const Visit& visit)
{
  const int rank = petsc::rank(model.comm);
  const PetscInt first = model.dofs.first_number(rank), last = model.dofs.first_number(rank + 1);
  const auto counts = [&](const std::vector<PetscInt>& numbers) {
    const PetscInt least = *std::ranges::min_element(numbers);
    return least >= first && least < last;
  };
  for_owned_elements(
      model.mesh, model.dofs, rank,
      [&](const mesh::ElementBlock& block, int e, const std::vector<PetscInt>& numbers) {
        const auto [points, arms] = element_points(model, block, e);
        visit(points, element_motion(model.dofs, block.element_nodes(e), arms), counts(numbers));
      });
  for (std::size_t i = 0; i < model.masses.size(); ++i) {
    const std::array nodes{model.mass_nodes[i]};
    const ElementMotion motion = element_motion(model.dofs, nodes, {});
    const Eigen::Vector3d x = model.dofs.position(nodes[0]);
    visit(rigid_mass_points(model.masses[i], x), motion, counts(motion.numbers));
  }
}

/// A dense matrix of zeros with the rows of the system.
petsc::Matrix dense_rows(const MassModel& model)
{
  const int n = model.dofs.n_components();
  petsc::Matrix rows;
  petsc::check(MatCreateDense(model.comm, n * model.pattern.n_rows(), PETSC_DECIDE, PETSC_DETERMINE,
                              n_moments, nullptr, rows.put()));
  return rows;
}

/// Adds the rows of this rank's numbers.
void add_rows(const MassModel& model, MatrixXd V_e, const ElementMotion& motion,
              Eigen::Ref<MatrixXd> rows)
{
  if (motion.T_e.size() > 0) V_e = motion.T_e.transpose() * V_e;
  const std::vector<int>& components = model.dofs.components();
  const Index n = std::ssize(components);
  for (std::size_t i = 0; i < motion.numbers.size(); ++i) {
    const PetscInt place = motion.numbers[i] - model.pattern.first;
    if (place < 0 || place >= model.pattern.n_rows()) continue;
    for (Index c = 0; c < n; ++c) {
      rows.row(n * place + c) +=
          V_e.row(6 * static_cast<Index>(i) + components[static_cast<std::size_t>(c)]);
    }
  }
}

/// The DOFs that move the points of an element in a direction.
struct MovingColumns {
  std::vector<Index> numbers;
  MatrixXd N;               ///< [n_points x n]
  Eigen::VectorXd lengths;  ///< [n] square roots of sum |dm| N^2

  MovingColumns(const MassPoints& points, std::size_t direction)
  {
    const StrainRows& all = points.N[direction];
    const Eigen::VectorXd squares = all.cwiseAbs2().transpose() * points.dm.cwiseAbs();
    for (Index i = 0; i < squares.size(); ++i)
      if (squares[i] > 0.0) numbers.push_back(i);
    N = all(every, numbers);
    lengths = squares(numbers).cwiseSqrt();
  }
};

/// sum dm N_k^T N_l without round-off, where the contributions of the two halves of the thickness
/// are opposite: what does not move together is not coupled.
MatrixXd element_product(const MassPoints& points, std::size_t k, std::size_t l)
{
  constexpr double round_off = 1e-14;
  const MovingColumns left(points, k), right(points, l);
  const MatrixXd sums = left.N.transpose() * points.dm.asDiagonal() * right.N;
  const MatrixXd least = round_off * left.lengths * right.lengths.transpose();
  MatrixXd product = MatrixXd::Zero(points.N[k].cols(), points.N[l].cols());
  product(left.numbers, right.numbers) = (sums.array().abs() > least.array()).select(sums, 0.0);
  return product;
}

/// mass, int x dm, int x x^T dm in one row to be summed over ranks.
using Totals = Eigen::Matrix<double, 13, 1>;

Totals totals(const MassPoints& points)
{
  Totals sums;
  const Eigen::Matrix3d second = points.x.transpose() * points.dm.asDiagonal() * points.x;
  sums << points.dm.sum(), points.x.transpose() * points.dm, second.reshaped();
  return sums;
}

}  // namespace

MassModel mass_model(const mesh::Mesh& mesh, const Structure& structure, const DofMap& dofs,
                     MPI_Comm comm)
{
  MassModel model{.mesh = mesh,
                  .structure = structure,
                  .dofs = dofs,
                  .comm = comm,
                  .sections = map_sections(mesh, structure),
                  .normals = mean_normals(mesh),
                  .mass_nodes = {},
                  .masses = {},
                  .pattern = {}};
  std::vector<PointElement> points;
  for (const PointMass& mass : structure.masses) {
    for (const int node : dofs.named_nodes(mesh, mass.at)) {
      model.mass_nodes.push_back(node);
      model.masses.push_back(mass);
      points.push_back({.nodes = {node}, .K = {}, .M = {}, .C = {}});
    }
  }
  model.pattern = element_pattern(mesh, points, dofs, petsc::rank(comm));
  return model;
}

petsc::Matrix displacement_product(const MassModel& model, int k, int l)
{
  BlockRows S(model.pattern);
  for_owned_points(model, [&](const MassPoints& points, const ElementMotion& motion, bool) {
    // `add` reads columns as rows, so it wants S_kl^T = S_lk.
    add(S, element_product(points, std::size_t(l), std::size_t(k)), motion, model.dofs,
        block_places(model.pattern, motion.numbers));
  });
  petsc::Matrix A = S.to_matrix(model.comm);
  if (k != l) {
    petsc::check(MatSetOption(A, MAT_SYMMETRY_ETERNAL, PETSC_FALSE));
    petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_FALSE));
  }
  return A;
}

MassMoments mass_moments(const MassModel& model)
{
  petsc::Matrix displacement = dense_rows(model);
  PetscScalar* values = nullptr;
  PetscInt lda = 0;
  petsc::check(MatDenseGetLDA(displacement, &lda));
  petsc::check(MatDenseGetArray(displacement, &values));
  Eigen::Map<MatrixXd> rows(values, lda, n_moments);
  Totals sums = Totals::Zero();
  for_owned_points(model,
                   [&](const MassPoints& points, const ElementMotion& motion, bool is_counted) {
                     add_rows(model, element_moments(points), motion, rows);
                     if (is_counted) sums += totals(points);
                   });
  petsc::check(MatDenseRestoreArray(displacement, &values));
  petsc::check(MatAssemblyBegin(displacement, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(displacement, MAT_FINAL_ASSEMBLY));
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM,
                model.comm);
  return {.mass = sums[0],
          .first = sums.segment<3>(1),
          .second = sums.tail<9>().reshaped(3, 3),
          .displacement = std::move(displacement)};
}

}  // namespace chladni::plate
