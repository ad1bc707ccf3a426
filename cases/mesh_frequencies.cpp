#include "cases/mesh_frequencies.hpp"

#include <algorithm>
#include <cmath>

#include "common/error.hpp"

namespace chladni::cases {

namespace {

/// The elastic modes up to a frequency (rad/s), and the next one where there is one.
reduce::NaturalModes modes_up_to(const SupportedModel& model, double omega,
                                 const linear::SolverOptions& solver)
{
  const int n_rigid = plate::n_free_motions(model.free);
  const reduce::FreeDofs free = reduce::free_dofs(model.system.K, model.held);
  const int most =
      std::max(1, (model.system.dofs.n_dofs() - static_cast<int>(model.held.size())) / 3);
  for (int n = std::min(n_rigid + 24, most);; n = std::min(2 * n, most)) {
    reduce::NaturalModes modes = reduce::natural_modes(
        model.system.K, model.system.M, free, {.n_modes = n, .n_rigid = n_rigid, .solver = solver});
    if (n == most || modes.lambda.back() > omega * omega) return modes;
  }
}

/// The modes up to a frequency; the first elastic one in any case.
reduce::NaturalModes modes_in_range(const SupportedModel& model, double omega,
                                    const linear::SolverOptions& solver)
{
  reduce::NaturalModes modes = modes_up_to(model, omega, solver);
  const int n_rigid = plate::n_free_motions(model.free);
  const auto in_range = static_cast<int>(
      std::ranges::count_if(modes.lambda, [&](double lambda) { return lambda <= omega * omega; }));
  modes.lambda.resize(static_cast<std::size_t>(
      std::min(std::max(in_range, n_rigid + 1), static_cast<int>(modes.lambda.size()))));
  return modes;
}

/// The lowest elastic modes.
Eigen::VectorXd lowest_of(const SupportedModel& model, Eigen::Index n,
                          const linear::SolverOptions& solver)
{
  const int n_rigid = plate::n_free_motions(model.free);
  const reduce::NaturalModes modes = reduce::natural_modes(
      model.system.K, model.system.M, reduce::free_dofs(model.system.K, model.held),
      {.n_modes = n_rigid + static_cast<int>(n), .n_rigid = n_rigid, .solver = solver});
  Eigen::VectorXd omega(n);
  for (Eigen::Index i = 0; i < n; ++i)
    omega[i] = std::sqrt(std::max(modes.lambda[static_cast<std::size_t>(n_rigid + i)], 0.0));
  return omega;
}

}  // namespace

MeshFrequencies::MeshFrequencies(const scene::Scene& scene, mesh::Mesh mesh)
    : scene_(scene),
      mesh_(std::make_unique<const mesh::Mesh>(std::move(mesh))),
      sector_(SectorFrequencies::find(scene, *mesh_))
{
  if (!sector_) whole();
}

const SupportedModel& MeshFrequencies::whole()
{
  if (!whole_) whole_ = assemble_supported(scene_, *mesh_);
  return *whole_;
}

int MeshFrequencies::n_dofs() const
{
  return sector_ ? sector_->n_dofs() : whole_->system.dofs.n_dofs();
}

Eigen::VectorXd MeshFrequencies::like(const Eigen::VectorXd& known,
                                      const linear::SolverOptions& solver)
{
  const Eigen::Index n = known.size();
  if (!sector_) return lowest_of(whole(), n, solver);
  constexpr double step = 1.1, most = 10.0;
  for (double share = 1.02; share < most; share *= step) {
    const Eigen::VectorXd found = sector_->up_to(share * known[n - 1], solver);
    if (found.size() >= n) return found.head(n);
  }
  throw Error("a coarse mesh has too few modes");
}

MeshErrors MeshFrequencies::errors_up_to(double omega, const linear::SolverOptions& solver)
{
  if (sector_) {
    if (std::optional<MeshErrors> found = sector_->errors_up_to(omega, solver)) return *found;
  }
  return mesh_errors(scene_, whole(), modes_in_range(whole(), omega, solver), solver);
}

}  // namespace chladni::cases
