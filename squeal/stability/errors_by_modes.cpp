#include "squeal/stability/errors_by_modes.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace chladni::squeal {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// Where the errors of W, W_r, W_t, V_r and V_t stand in ModeErrors::mesh_shapes: a radial slope is
/// a rotation about the circumferential direction.
constexpr std::array<Index, 5> rows_of_functions{2, 4, 3, 0, 1};

/// The frequency of a mode or a pair.
DiscScaling of_frequency(Index first, Index size)
{
  return [=](InertialDisc& disc, double factor) { disc.omega.segment(first, size) *= factor; };
}

/// What the rings do in some modes.
/// @param f  which of W, W_r, W_t, V_r, V_t
DiscScaling of_motion(Index first, Index size, std::size_t f)
{
  return [=](InertialDisc& disc, double factor) {
    for (InertialRing& ring : disc.rings) {
      const std::vector<VectorXd*> amplitudes = amplitudes_of(ring);
      if (f < amplitudes.size()) amplitudes[f]->segment(first, size) *= factor;
    }
  };
}

/// Halvings of the elements that the error by the mesh covers: there is no end to them for a force
/// at a point. Another mesh of a quarter of the size may place its nodes still nearer to the pads.
constexpr double halvings = 2.0, of_other_meshes = 1.4;
/// Where the functions of a ring stand in ModeErrors::mesh_compliances.
constexpr std::array<Index, 5> compliances_of_functions{0, 2, 2, 1, 1};

/// The compliance of one function of a ring under a pad, by an amount for a factor of e. It belongs
/// to a point alone, so that all harmonics have the same of it.
DiscScaling of_compliance(Index ring, Index f, double amount)
{
  return [=](InertialDisc& disc, double factor) {
    std::vector<Eigen::MatrixXcd>& C = disc.compliance.C;
    const Index n_functions = std::ssize(amplitudes_of(disc.rings.front()));
    const Index n = n_functions * std::ssize(disc.rings), row = n_functions * ring + f;
    if (C.empty())
      C.assign(static_cast<std::size_t>(disc.errors.n_harmonics), Eigen::MatrixXcd::Zero(n, n));
    const double share = (factor - 1.0) * amount / (2.0 * double(C.size()) - 1.0);
    for (std::size_t d = 0; d < C.size(); ++d) C[d](row, row) += (d == 0 ? 1.0 : 2.0) * share;
  };
}

/// The results of a disc, and how they change.
struct ChangingResults {
  const InertialDisc& disc;
  Index n;
  const DerivativeByDisc& derivative;

  /// The sum over all modes and pairs of error times derivative, without sign.
  /// @param errors   [n_modes] relative
  /// @param scaling  of a mode or pair by its first coordinate and their number
  template <class Scaling>
  VectorXd sum_over_modes(const VectorXd& errors, const Scaling& scaling) const
  {
    VectorXd sum = VectorXd::Zero(n);
    Index size = 1;
    for (Index i = 0; i < errors.size(); i += size) {
      size = disc.nodal_diameters[static_cast<std::size_t>(i)] > 0 ? 2 : 1;
      if (errors[i] > 0.0) sum += errors[i] * derivative(scaling(i, size)).cwiseAbs();
    }
    return sum;
  }
};

/// What a finer mesh yields more of each function of each ring.
std::vector<DiscScaling> finer_functions(const InertialDisc& disc)
{
  std::vector<DiscScaling> all;
  const std::size_t n_functions = disc.rings.front().V_r.size() > 0 ? 5 : 3;
  const Eigen::MatrixXd& growth = disc.errors.mesh_compliances;
  for (Index ring = 0; ring < growth.cols(); ++ring)
    for (std::size_t f = 0; f < n_functions; ++f) {
      const double amount = halvings * of_other_meshes * growth(compliances_of_functions[f], ring);
      all.push_back(of_compliance(ring, static_cast<Index>(f), amount));
    }
  return all;
}

}  // namespace

ErrorBudget ErrorsByModes::budget(Index result) const
{
  const auto part = [result](const std::optional<VectorXd>& errors) {
    return errors ? std::optional((*errors)[result]) : std::nullopt;
  };
  return {.mesh = part(mesh), .reduction = part(reduction), .body = part(body)};
}

VectorXd errors_by_compliance(const InertialDisc& disc, Index n_results,
                              const DerivativeByDisc& derivative)
{
  VectorXd sum = VectorXd::Zero(n_results);
  for (const DiscScaling& finer : finer_functions(disc)) sum += derivative(finer).cwiseAbs();
  return sum;
}

DiscScaling finer_under_the_pads(const InertialDisc& disc)
{
  return [all = finer_functions(disc)](InertialDisc& changed, double factor) {
    for (const DiscScaling& finer : all) finer(changed, factor);
  };
}

ErrorsByModes errors_by_modes(const InertialDisc& disc, double omega, Index n_results,
                              const DerivativeByDisc& derivative)
{
  ErrorsByModes found;
  const ModeErrors& errors = disc.errors;
  if (omega > errors.range) return found;
  const ChangingResults results{disc, n_results, derivative};
  if (errors.mesh.size() > 0) {
    found.mesh = results.sum_over_modes(errors.mesh, of_frequency);
    for (std::size_t f = 0; f < rows_of_functions.size() && errors.mesh_shapes.size() > 0; ++f) {
      *found.mesh += results.sum_over_modes(
          errors.mesh_shapes.row(rows_of_functions[f]),
          [f](Index first, Index size) { return of_motion(first, size, f); });
    }
    *found.mesh += errors_by_compliance(disc, n_results, derivative);
  }
  if (errors.reduction.size() > 0)
    found.reduction = results.sum_over_modes(errors.reduction, of_frequency);
  if (errors.responses) {
    // A response is quadratic in the motion of its place.
    found.body = VectorXd::Zero(n_results);
    for (std::size_t f = 0; f < rows_of_functions.size(); ++f)
      *found.body += derivative(of_motion(0, disc.n_modes(), f)).cwiseAbs();
    *found.body *= 0.5 * *errors.responses;
  }
  return found;
}

}  // namespace chladni::squeal
