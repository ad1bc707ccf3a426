#include "version_1_results.hpp"

#include "tests/common/files/scratch_folder.hpp"

namespace chladni::squeal::test {
namespace {

using Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

const std::complex<double> i{0.0, 1.0};

/// 1/3, 2/3, ...: all bits of the mantissa in use.
VectorXd thirds(Eigen::Index n)
{
  return VectorXd::LinSpaced(n, 1.0, double(n)) / 3.0;
}

std::vector<double> series(Eigen::Index n)
{
  const VectorXd x = thirds(n);
  return {x.begin(), x.end()};
}

StabilityProfile profile()
{
  return {{1.0, -2.0, 300.0},
          {9.0, 0.5, 310.0},
          {{{7.0, 0.0, 303.0}, {9.0, 0.5, 310.0}, {8.0, 1.5, 304.0}}}};
}

void add_stability(SquealResults& results)
{
  results.largest_split = 1e-5;
  results.eigenvalues = EigenvalueMap{
      thirds(2), MatrixXcd{{-1.0 + 10.0 * i, 2.0 + 11.0 * i}, {-3.0 + 12.0 * i, 4.0 + 13.0 * i}}};
  results.eigenvalues->shapes = {MatrixXcd::Constant(3, 2, 0.5 + 0.5 * i),
                                 MatrixXcd::Constant(3, 2, 0.5 - 0.5 * i)};
  results.eigenvalues->mode_numbers = {1, 3};  // the third row: a pad with a mass
  results.searched_critical_speed = true;
  results.speed_stability = profile();
  results.critical_speed = CriticalSpeed{7.0, 303.0, 4};
  results.critical_values = {{"friction", 10.0, 7.0, 303.0, 3, profile()},
                             {"preload", 10.0, {}, 0.0, 0, {}}};
  results.map = StabilityMap{"preload", thirds(2), thirds(3), MatrixXd::Constant(2, 3, 0.1),
                             MatrixXd::Constant(2, 3, 300.0)};
  results.rotation_stability = RotationStability{thirds(3), thirds(3), thirds(3), 0.5};
  results.mode_sensitivity =
      ModeSensitivity{13.0,
                      1700.0,
                      {{2, 600.0, {}, {}, -0.5, "stable"}, {8, 900.0, 12.0, 1600.0, 0.5, "lost"}},
                      {{3, 1672.0, 0.9, {}, {}}, {0, 700.0, 0.1, 0.25, 12.0}}};
}

Transient transient()
{
  const History history{series(4), series(4), series(4), series(4), series(4), series(4)};
  return {.speed = 18.0,
          .step = 1e-4,
          .finished = true,
          .integrator = "dop853",
          .integrator_reason = "named in the scene",
          .n_steps = 100,
          .n_contact_evaluations = 1200,
          .n_events = 2,
          .events = {{0.1, 0, false}, {0.2, 1, true}},
          .envelope = {series(2), series(2), series(2)},
          .windows = {},
          .band = {},
          .history = history,
          .tail = history,
          .tail_a = {},
          .N_min = 0.0,
          .N_max = 900.0,
          .slip_speed_min = 1.5,
          .t_zero_force = 0.15,
          .growth_rate = 2.5,
          .warning = "short"};
}

void add_motions(SquealResults& results)
{
  results.growth = {{15.0, {series(2), series(2), series(2)}, 1.25, 1.5}};
  results.transient = transient();
  results.limit_cycle = LimitCycle{.speed = 18.0,
                                   .frequency_Hz = 1672.0,
                                   .pad_velocity = 0.7,
                                   .pad_displacement = 7e-5,
                                   .N_min = 0.0,
                                   .N_max = 900.0,
                                   .drift = 1e-4,
                                   .settled = true,
                                   .t_zero_force = 0.15,
                                   .t_99 = 1.2,
                                   .mode_numbers = {1, 3},
                                   .amplitude = VectorXcd::Constant(2, 1e-3 + 1e-3 * i)};
  results.limit_cycle_direct =
      DirectLimitCycle{.speed = 18.0,
                       .frequency_Hz = 1672.0,
                       .pad_velocity = 0.7,
                       .pad_displacement = 7e-5,
                       .N_min = 0.0,
                       .N_max = 900.0,
                       .slip_speed_min = 1.5,
                       .multipliers = VectorXcd::Constant(4, 0.5 + 0.1 * i),
                       .n_newton_steps = 6,
                       .n_contact_evaluations = 5000,
                       .x = thirds(4),
                       .mode_numbers = {1, 3},
                       .amplitude = VectorXcd::Constant(2, 1e-3 + 1e-3 * i),
                       .energy = {thirds(1), thirds(1), -0.5, thirds(1), 2.0}};
  const BranchPoint point{18.0, 1672.0, 0.7, 7e-5, 0.0, 900.0, 0.9};
  results.limit_cycle_branch = LimitCycleBranch{{point, point}, {point}, 12.0, 24.0};
  results.spectrum = Spectrum{thirds(3), thirds(3), {{1672.0, 0.7}}};
}

}  // namespace

SquealResults version_1_results()
{
  SquealResults results;
  add_stability(results);
  add_motions(results);
  results.failure = "limit-cycle-branch: lost";
  return results;
}

Radiation version_1_radiation()
{
  return {{1, 3}, thirds(2), thirds(2), thirds(2), thirds(2)};
}

SquealResults returned(const SquealResults& written)
{
  const files::test::ScratchFolder folder;
  write_results(folder.file("x.squeal.h5"), written, {});
  return read_results(std::filesystem::path(folder.file("x.squeal.h5")));
}

}  // namespace chladni::squeal::test
