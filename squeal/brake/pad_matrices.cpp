#include "squeal/brake/pad_matrices.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/pad_basis.hpp"
#include "squeal/brake/pads.hpp"

namespace chladni::squeal {
namespace {

void add_spring(PadMatrices& system, const Suspension& spring, Eigen::Index i, Eigen::Index j)
{
  for (const auto& [matrix, value] :
       {std::pair{&system.K, spring.stiffness}, std::pair{&system.C, spring.damping}}) {
    (*matrix)(i, i) += value;
    if (j < 0) continue;
    (*matrix)(j, j) += value;
    (*matrix)(i, j) -= value;
    (*matrix)(j, i) -= value;
  }
}

void add_pad(PadMatrices& system, const PadPair& pad, Eigen::Index first)
{
  const std::vector<PlateFreedom> all = freedoms(*pad.body, pad.shim);
  const auto n = static_cast<Eigen::Index>(all.size());
  const Eigen::Index caliper = first + 2 * n;
  for (Eigen::Index i = 0; i < 2 * n; ++i) {
    const PlateFreedom& freedom = all[static_cast<std::size_t>(i % n)];
    system.M(first + i, first + i) = freedom.inertia;
    const bool on_caliper = pad.caliper && freedom.direction == 2;
    add_spring(system, freedom.suspension, first + i, on_caliper ? caliper : -1);
  }
  if (!pad.caliper) return;
  system.M(caliper, caliper) = pad.caliper->mass;
  add_spring(system, pad.caliper->axial, caliper, -1);
}

}  // namespace

std::vector<PlateFreedom> freedoms(const PadBody& body, const std::optional<Shim>& shim)
{
  std::vector<PlateFreedom> all;
  const std::array translations{body.radial, body.tangential, body.axial};
  for (int i = 0; i < 3; ++i)
    if (const auto& suspension = translations[static_cast<std::size_t>(i)])
      all.push_back({i, body.mass, i == 2 && shim ? in_series(*suspension, *shim) : *suspension});
  const std::array rotations{body.about_radial, body.about_tangential, body.about_axial};
  for (int i = 0; i < 3; ++i)
    if (const auto& rotation = rotations[static_cast<std::size_t>(i)])
      all.push_back({3 + i, rotation->inertia, rotation->suspension});
  return all;
}

Eigen::Index n_coordinates(const PadPair& pad)
{
  if (!pad.body) return 0;
  return 2 * static_cast<Eigen::Index>(freedoms(*pad.body).size()) + (pad.caliper ? 1 : 0);
}

PadMatrices pad_matrices(const SquealOptions& options)
{
  Eigen::Index n = 0;
  for (const PadPair& pad : options.pads) n += n_coordinates(pad);
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n, n);
  PadMatrices system{zero, zero, zero};
  Eigen::Index first = 0;
  for (const PadPair& pad : options.pads) {
    if (pad.body) add_pad(system, pad, first);
    first += n_coordinates(pad);
  }
  return system;
}

Eigen::MatrixXd pad_basis(const SquealOptions& options)
{
  const PadMatrices matrices = pad_matrices(options);
  if (matrices.M.size() == 0) return {};
  // As in pad_system, so that the modes are the same.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(matrices.K, matrices.M);
  return matrices.M.diagonal().cwiseSqrt().asDiagonal() * modes.eigenvectors();
}

}  // namespace chladni::squeal
