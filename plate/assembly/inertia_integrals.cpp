#include "plate/assembly/inertia_integrals.hpp"

#include <array>
#include <numeric>
#include <vector>

#include "common/eigen_every.hpp"
#include "plate/assembly/element_motion.hpp"
#include "plate/dofs/point_elements.hpp"
#include "plate/sections/sections.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::MatrixXd;

namespace {

/// The mass m_ij of two nodes, or m_ii of one. For any linear f and g of the positions and
/// displacements, m_ij (f_i g_j + f_j g_i) = 4 m_ij f_c g_c - m_ij f_i g_i - m_ij f_j g_j, where c
/// is in the middle of both nodes: three points.
MassPoints nodal_mass_points(const mesh::Mesh& mesh, std::span<const int> nodes, double m)
{
  const Index n = std::ssize(nodes), n_points = n == 1 ? 1 : 3;
  MassPoints points{.dm = Eigen::VectorXd(n_points), .x = NodeVectors(n_points, 3), .N = {}};
  MatrixXd shares = MatrixXd::Identity(n_points, n);
  points.dm.setConstant(n == 1 ? m : -m);
  if (n == 2) {
    shares.row(2).setConstant(0.5);
    points.dm[2] = 4.0 * m;
  }
  NodeVectors x(n, 3);
  for (Index i = 0; i < n; ++i)
    x.row(i) = Eigen::RowVector3d(mesh.positions[std::size_t(nodes[std::size_t(i)])].data());
  points.x = shares * x;
  for (Index c = 0; c < 3; ++c) {
    StrainRows& N_c = points.N[std::size_t(c)];
    N_c = StrainRows::Zero(n_points, 6 * n);
    for (Index i = 0; i < n; ++i) N_c.col(6 * i + c) = shares.col(i);
  }
  return points;
}

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
  if (model.mesh.matrices) {
    for_owned_blocks(model.mesh.matrices->M, model.dofs, rank,
                     [&](std::span<const int> nodes, std::span<const mesh::MatrixEntry> entries) {
                       const ElementMotion motion = element_motion(model.dofs, nodes, {});
                       visit(nodal_mass_points(model.mesh, nodes, entries.front().value), motion,
                             counts(motion.numbers));
                     });
  } else {
    for_owned_elements(
        model.mesh, model.dofs, rank,
        [&](const mesh::ElementBlock& block, int e, const std::vector<PetscInt>& numbers) {
          const auto [points, arms] = element_points(model, block, e);
          visit(points, element_motion(model.dofs, block.element_nodes(e), arms), counts(numbers));
        });
  }
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
/// @param left, right  those of N_k and N_l
MatrixXd element_product(const MassPoints& points, const MovingColumns& left,
                         const MovingColumns& right)
{
  constexpr double round_off = 1e-14;
  const MatrixXd sums = left.N.transpose() * points.dm.asDiagonal() * right.N;
  const MatrixXd least = round_off * left.lengths * right.lengths.transpose();
  MatrixXd product = MatrixXd::Zero(points.N[0].cols(), points.N[0].cols());
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

/// Sums of S_kl of some pairs of directions.
class ProductSums {
 public:
  ProductSums(const MassModel& model, std::span<const Axes> axes)
      : model_(model), axes_(axes.begin(), axes.end())
  {
    for (std::size_t i = 0; i < axes_.size(); ++i) sums_.emplace_back(model.pattern);
  }

  void add(const MassPoints& points, const ElementMotion& motion)
  {
    if (axes_.empty()) return;
    const std::vector<std::ptrdiff_t> places = block_places(model_.pattern, motion.numbers);
    const std::array moving{MovingColumns(points, 0), MovingColumns(points, 1),
                            MovingColumns(points, 2)};
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const auto [k, l] = axes_[i];
      // `add` reads columns as rows, so it wants S_kl^T = S_lk.
      plate::add(sums_[i], element_product(points, moving[std::size_t(l)], moving[std::size_t(k)]),
                 motion, model_.dofs, places);
    }
  }

  /// @note   Collective on the communicator of the model.
  std::vector<petsc::Matrix> matrices()
  {
    std::vector<petsc::Matrix> products;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      petsc::Matrix S = sums_[i].to_matrix(model_.comm);
      if (axes_[i].first != axes_[i].second) {
        petsc::check(MatSetOption(S, MAT_SYMMETRY_ETERNAL, PETSC_FALSE));
        petsc::check(MatSetOption(S, MAT_SYMMETRIC, PETSC_FALSE));
      }
      products.push_back(std::move(S));
    }
    return products;
  }

 private:
  const MassModel& model_;
  std::vector<Axes> axes_;
  std::vector<BlockRows> sums_;
};

/// Sums of the integrals of positions.
class MomentSums {
 public:
  explicit MomentSums(const MassModel& model) : model_(model), displacement_(dense_rows(model))
  {
    petsc::check(MatDenseGetLDA(displacement_, &lda_));
    petsc::check(MatDenseGetArray(displacement_, &values_));
  }

  void add(const MassPoints& points, const ElementMotion& motion, bool is_counted)
  {
    add_rows(model_, element_moments(points), motion,
             Eigen::Map<MatrixXd>(values_, lda_, n_moments));
    if (is_counted) totals_ += totals(points);
  }

  /// @note   Collective on the communicator of the model.
  MassMoments moments() &&
  {
    petsc::check(MatDenseRestoreArray(displacement_, &values_));
    petsc::check(MatAssemblyBegin(displacement_, MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(displacement_, MAT_FINAL_ASSEMBLY));
    MPI_Allreduce(MPI_IN_PLACE, totals_.data(), static_cast<int>(totals_.size()), MPI_DOUBLE,
                  MPI_SUM, model_.comm);
    return {.mass = totals_[0],
            .first = totals_.segment<3>(1),
            .second = totals_.tail<9>().reshaped(3, 3),
            .displacement = std::move(displacement_)};
  }

 private:
  const MassModel& model_;
  petsc::Matrix displacement_;
  PetscScalar* values_ = nullptr;
  PetscInt lda_ = 0;
  Totals totals_ = Totals::Zero();
};

}  // namespace

MassModel mass_model(const mesh::Mesh& mesh, const Structure& structure, const DofMap& dofs,
                     MPI_Comm comm)
{
  MassModel model{.mesh = mesh,
                  .structure = structure,
                  .dofs = dofs,
                  .comm = comm,
                  .sections = mesh.matrices ? SectionMap() : map_sections(mesh, structure),
                  .directors = mesh.matrices ? Directors() : shell_directors(mesh),
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
  return std::move(displacement_products(model, std::array{Axes(k, l)}).front());
}

std::vector<petsc::Matrix> displacement_products(const MassModel& model, std::span<const Axes> axes)
{
  ProductSums products(model, axes);
  for_owned_points(model, [&](const MassPoints& points, const ElementMotion& motion, bool) {
    products.add(points, motion);
  });
  return products.matrices();
}

MassMoments mass_moments(const MassModel& model)
{
  return inertia_integrals(model, {}).moments;
}

InertiaIntegrals inertia_integrals(const MassModel& model, std::span<const Axes> axes)
{
  MomentSums moments(model);
  ProductSums products(model, axes);
  for_owned_points(model,
                   [&](const MassPoints& points, const ElementMotion& motion, bool is_counted) {
                     moments.add(points, motion, is_counted);
                     products.add(points, motion);
                   });
  return {.moments = std::move(moments).moments(), .products = products.matrices()};
}

PlacedPoints element_points(const MassModel& model, const mesh::ElementBlock& block, int element)
{
  const int group = block.group[element];
  const NodeVectors x = element_positions(model.mesh, block, element);
  if (block.shape == mesh::Shape::line) {
    const LineFields fields = line_fields(model.sections.on_surface, block.element_nodes(element));
    return {
        .points = beam_mass_points(x, model.structure.beams[model.sections.beam[group]], fields),
        .arms = {}};
  }
  if (mesh::is_solid(block.shape)) {
    const SolidSection& section = model.structure.solids[model.sections.solid[group]];
    return {
        .points = solid_mass_points(solid_of_mesh(model.mesh, block, element), section.material),
        .arms = {}};
  }
  const ShellSection& section = model.structure.shells[model.sections.shell[group]];
  const ShellNodes shell = shell_nodes(model.mesh, block, element, model.directors, section);
  PlacedPoints placed{
      .points = shell_mass_points(block.shape, block.order, shell, section.material.density),
      .arms = {}};
  if (section.offset != Profile(0.0)) placed.arms = shell.x - x;
  return placed;
}

MatrixXd element_moments(const MassPoints& points)
{
  MatrixXd moments(points.N[0].cols(), n_moments);
  for (Index l = 0; l < 3; ++l) {
    const StrainRows& N_l = points.N[static_cast<std::size_t>(l)];
    moments.col(l) = N_l.transpose() * points.dm;
    for (Index k = 0; k < 3; ++k)
      moments.col(3 + 3 * k + l) = N_l.transpose() * points.dm.cwiseProduct(points.x.col(k));
  }
  return moments;
}

}  // namespace chladni::plate
