#include <algorithm>
#include <cmath>
#include <functional>

#include "cli/certify.hpp"
#include "cli/reduce_steps.hpp"

namespace chladni::cli {
namespace {

double largest_error(const mbs_export::Certificate& certificate)
{
  return certificate.eta2.size() > 0 ? certificate.eta2.maxCoeff() : 0.0;
}

/// The first number of modes, by bisection to 1 % or one mode, whose errors are below the
/// tolerance.
int least_modes(int n_enough, double tolerance, const std::function<double(int)>& error)
{
  int too_few = 0;
  while (n_enough - too_few > std::max(1, n_enough / 100)) {
    const int n = (n_enough + too_few) / 2;
    (error(n) <= tolerance ? n_enough : too_few) = n;
  }
  return n_enough;
}

/// A number of modes that keeps the tolerance if the error goes on to fall as a power of it, from
/// the errors with half of the modes and with all; between 1.15 and 1.5 times as many:
/// the solve costs more than in proportion, and the error falls in jumps.
int predict_modes(int n_all, double tolerance, const std::function<double(int)>& error)
{
  const double last = error(n_all);
  const double power = std::max(0.5, std::log2(error(n_all / 2) / last));
  const double predicted = 1.1 * n_all * std::pow(last / tolerance, 1.0 / power);
  return static_cast<int>(std::clamp(predicted, 1.15 * n_all, 1.5 * n_all)) + 1;
}

}  // namespace

Reduced reduce_to_tolerance(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                            const reduce::Factorization& K_ss, Phases& phases)
{
  const double tolerance = scene.reduce.tolerance->tolerance;
  petsc::Matrix Psi = constraint_basis(blocks, K_ss, phases).Psi;
  for (int n_asked = 48;;) {
    Reduced reduced = project_blocks(
        scene, fe, blocks,
        {.Psi = std::move(Psi),
         .modes = fixed_interface_modes(blocks, K_ss, {.modes = n_asked}, phases)},
        phases);
    const int n_all = static_cast<int>(reduced.model.omega.size());
    const auto error = [&](int n) {
      return largest_error(certify_scene(scene, blocks, K_ss, reduced, n));
    };
    const bool enough = phases.run("error estimates", [&] { return error(n_all) <= tolerance; });
    if (enough) {
      const int n =
          phases.run("error estimates", [&] { return least_modes(n_all, tolerance, error); });
      reduced.system = with_modes(reduced.system, n);
      reduced.places.resize(blocks.masters.size() + static_cast<std::size_t>(n));
      return reduced;
    }
    n_asked = predict_modes(n_all, tolerance, error);
    Psi = std::move(reduced.Q_CB.Psi);
  }
}

}  // namespace chladni::cli
