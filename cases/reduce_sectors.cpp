#include "cases/reduce_sectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "cases/harmonic_options.hpp"
#include "cases/harmonic_part.hpp"
#include "cases/ranks.hpp"
#include "cases/sector_forces.hpp"
#include "cases/sector_integrals.hpp"
#include "common/all_ranks.hpp"
#include "common/error.hpp"
#include "cyclic/mirror.hpp"
#include "cyclic/sparse_rows.hpp"
#include "linear/progress.hpp"
#include "reduce_export/reduced_system.hpp"
#include "report/timing.hpp"

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::MatrixXd;

/// Remembers how long the factorisations took.
class FactorTime : public reduce::PhaseListener {
 public:
  double seconds() const { return seconds_; }

 private:
  void begun(const std::string& phase) override
  {
    is_factor_ = phase == "factorization";
    watch_ = {};
  }
  void ended() override
  {
    if (is_factor_) seconds_ += watch_.wall_s();
  }

  bool is_factor_ = false;
  report::Stopwatch watch_;
  double seconds_ = 0.0;
};

cyclic::SectorMatrices matrices_of(const SectorModel& model)
{
  return {
      .K = cyclic::sparse_rows(model.system.K),
      .M = cyclic::sparse_rows(model.system.M),
      .C = model.system.C != nullptr ? cyclic::sparse_rows(model.system.C) : cyclic::SparseRows()};
}

std::optional<cyclic::Mirror> mirror_of(const SectorModel& model,
                                        const cyclic::SectorMatrices& matrices)
{
  const plate::DofMap& dofs = model.system.dofs;
  Eigen::MatrixX3d positions(model.dofs.n_blocks, 3);
  // A mean has no block of its own: its DOFs stand in those of its group.
  for (int node = 0; node < dofs.n_nodes(); ++node)
    if (!dofs.is_dependent(node) && dofs.number(node) >= 0)
      positions.row(dofs.number(node)) = dofs.position(node);
  return cyclic::find_mirror(model.dofs, positions, {&matrices.K, &matrices.M, &matrices.C});
}

/// Six rows for each interface node: components that the model does not have are at rest.
cyclic::SectorMotion interface_motion(const cyclic::HarmonicModel& harmonic,
                                      const SectorModel& model)
{
  const std::vector<int>& components = model.dofs.components;
  std::vector<int> dofs;
  std::vector<Index> rows;
  for (Index i = 0; i < std::ssize(model.interface.nodes); ++i) {
    for (std::size_t k = 0; k < components.size(); ++k) {
      dofs.push_back(model.interface.nodes[std::size_t(i)].block *
                         static_cast<int>(components.size()) +
                     static_cast<int>(k));
      rows.push_back(6 * i + components[k]);
    }
  }
  const cyclic::SectorMotion known = cyclic::sector_motion(harmonic, dofs);
  const Index n = 6 * std::ssize(model.interface.nodes);
  cyclic::SectorMotion motion{.x = MatrixXd::Zero(n, known.x.cols()),
                              .y = MatrixXd::Zero(n, known.y.cols())};
  motion.x(rows, Eigen::seqN(0, known.x.cols())) = known.x;
  motion.y(rows, Eigen::seqN(0, known.y.cols())) = known.y;
  return motion;
}

/// Displacements of nodes of the mesh, dependent ones too.
cyclic::SectorMotion picture_motion(const cyclic::HarmonicModel& harmonic, const SectorModel& model,
                                    const std::vector<int>& nodes)
{
  const plate::DofMap& dofs = model.system.dofs;
  const int n_c = dofs.n_components();
  std::vector<int> wanted;
  for (const int node : nodes) {
    for (const plate::MotionTerm& term : dofs.motion(node))
      for (int c = 0; c < n_c; ++c) wanted.push_back(n_c * term.number + c);
  }
  const cyclic::SectorMotion known = cyclic::sector_motion(harmonic, wanted);
  const Index n = 3 * std::ssize(nodes);
  cyclic::SectorMotion motion{.x = MatrixXd::Zero(n, known.x.cols()),
                              .y = MatrixXd::Zero(n, known.y.cols())};
  Index row = 0;
  for (Index i = 0; i < std::ssize(nodes); ++i) {
    for (const plate::MotionTerm& term : dofs.motion(nodes[std::size_t(i)])) {
      const MatrixXd T = term.T.topRows<3>()(Eigen::seqN(0, 3), dofs.components());
      motion.x.middleRows<3>(3 * i) += T * known.x.middleRows(row, n_c);
      motion.y.middleRows<3>(3 * i) += T * known.y.middleRows(row, n_c);
      row += n_c;
    }
  }
  return motion;
}

HarmonicPart part_of(const cyclic::HarmonicModel& harmonic, const SectorModel& model,
                     const mbs_export::ReducedSystem& whole, const PictureNodes& chosen,
                     bool with_sector)
{
  HarmonicPart part{.order = harmonic.coordinates.order,
                    .n_coordinates = harmonic.coordinates.n(),
                    .masters = {},
                    .K = harmonic.K,
                    .M = harmonic.M,
                    .C = harmonic.C,
                    .omega = harmonic.omega,
                    .certificate = harmonic.certificate,
                    .interface = interface_motion(harmonic, model),
                    .picture = picture_motion(harmonic, model, chosen.nodes),
                    .sector = {}};
  if (with_sector) {
    std::vector<int> all(std::size_t(model.dofs.n_dofs()));
    std::iota(all.begin(), all.end(), 0);
    part.sector = cyclic::sector_motion(harmonic, all);
  }
  for (const cyclic::Master& master : harmonic.coordinates.masters)
    part.masters.push_back(master_index(whole, model, master));
  part.factor_entries = linear::factor_size(harmonic.body.K_ss.factor()).entries;
  if (harmonic.basis.modes && harmonic.basis.n_modes() > 0) {
    part.modes_residual = reduce::largest_residual(*harmonic.basis.modes, harmonic.body.K_blocks.ss,
                                                   harmonic.body.M_blocks.ss);
  }
  return part;
}

/// The harmonics of this rank.
std::vector<HarmonicPart> reduced_harmonics(const SectorModel& model,
                                            const cyclic::SectorMatrices& matrices,
                                            const reduce::ReductionOptions& options,
                                            const mbs_export::ReducedSystem& whole,
                                            const SectorSupport& support,
                                            const PictureNodes& chosen, bool with_sector)
{
  return on_all_ranks(PETSC_COMM_WORLD, [&] {
    std::vector<HarmonicPart> parts;
    const std::vector<int> orders = own_harmonics(model.dofs.count);
    for (const int order : orders) {
      FactorTime phases;
      try {
        const linear::ListenToProgress to_no_step({});  // a harmonic is a step of the whole
        const cyclic::HarmonicModel harmonic =
            cyclic::reduce_harmonic(matrices, cyclic::harmonic_coordinates(model.dofs, order),
                                    options, support.is_held, phases);
        parts.push_back(part_of(harmonic, model, whole, chosen, with_sector));
      } catch (const Error& error) {
        throw Error(
            fmt::format("harmonic {} of {} sectors: {}", order, model.dofs.count, error.what()));
      }
      parts.back().factor_s = phases.seconds();
      linear::report_progress(double(parts.size()) / double(orders.size()));
    }
    return parts;
  });
}

/// What the file of the whole body is made of, besides the parts.
struct Described {
  mbs_export::ReducedSystem system;  ///< `described_whole`
  std::vector<std::string> fixed;    ///< the support of the certificates
  double lambda_max;                 ///< up to which each harmonic is certified, rad^2/s^2
  PictureNodes chosen;
};

double certified_up_to(const reduce::ReduceOptions& wanted)
{
  double f_Hz = wanted.certified_up_to_Hz.value_or(std::numeric_limits<double>::infinity());
  if (wanted.tolerance) f_Hz = wanted.tolerance->up_to_Hz;
  return std::pow(2.0 * std::numbers::pi * f_Hz, 2);
}

/// All that the file has, on the first rank; the parts give back what no later step wants.
/// @note   Collective on all ranks: they have the same phases.
mbs_export::ReducedSystem whole_body(const scene::Scene& scene, const SectorModel& model,
                                     std::vector<HarmonicPart>& parts, const Described& described,
                                     Phases& phases)
{
  const Index n_m = described.system.n_masters();
  mbs_export::ReducedSystem whole;
  phases.begin("whole body");
  on_first_rank([&] {
    whole = unfolded(described.system, model, parts, described.fixed, described.lambda_max);
  });
  if (scene.mass_integrals) {
    phases.begin("mass integrals");
    on_first_rank(
        [&] { whole.mass_integrals = sector_integrals(scene, model, parts, whole.M, n_m); });
  }
  if (!scene.resultants.groups.empty()) {
    phases.begin("section forces");
    on_first_rank(
        [&] { whole.resultants = sector_forces(scene, model, parts, whole.M.rows(), n_m); });
  }
  for (HarmonicPart& part : parts) part.sector = {};
  if (!described.chosen.nodes.empty()) {
    phases.begin("pictures");
    on_first_rank([&] { whole.picture = unfolded_picture(described.chosen, model, parts, n_m); });
  }
  phases.end();
  return whole;
}

ReduceSummary summary_of(const SectorModel& model, const std::vector<HarmonicPart>& parts)
{
  ReduceSummary summary{};
  for (const HarmonicPart& part : parts) {
    summary.n_dofs += part.n_coordinates;
    summary.n_modes += static_cast<int>(part.omega.size());
    summary.factorization.wall_s += part.factor_s;
    summary.modes_residual = std::max(summary.modes_residual, part.modes_residual);
    summary.factor.entries = std::max(summary.factor.entries, part.factor_entries);
  }
  summary.n_nodes = std::int64_t{model.mesh.sectors.count} *
                    (model.mesh.n_nodes() - std::ssize(model.mesh.sectors.pairs));
  summary.factorization.name = "factorization";
  return summary;
}

}  // namespace

ReduceSummary reduce_sectors(const scene::Scene& scene, MeshedScene meshed,
                             const linear::SolverOptions& solver, Phases& phases)
{
  phases.begin("assembly");
  SectorModel model = on_all_ranks(PETSC_COMM_WORLD, [&] {
    return meshed.sector ? std::move(*meshed.sector) : sector_model(scene, std::move(meshed.mesh));
  });
  SectorSupport support = sector_support(scene, model);
  const cyclic::SectorMatrices matrices = matrices_of(model);
  model.dofs.mirror = mirror_of(model, matrices);
  phases.begin("modes of harmonics");
  const reduce::ReductionOptions options = harmonic_options(scene, model, matrices, solver);
  const Described described{.system = described_whole(scene, model),
                            .fixed = std::move(support.names),
                            .lambda_max = certified_up_to(options.basis),
                            .chosen = picture_nodes(model.mesh, scene.pictures)};
  phases.begin("harmonics");
  std::vector<HarmonicPart> parts = gathered(
      reduced_harmonics(model, matrices, options, described.system, support, described.chosen,
                        scene.mass_integrals || !scene.resultants.groups.empty()));
  ReduceSummary summary = summary_of(model, parts);
  summary.choice.method = options.basis.method;
  summary.n_masters = static_cast<int>(described.system.masters.size());
  summary.reduced = whole_body(scene, model, parts, described, phases);
  summary.phases = phases.times();
  return summary;
}

}  // namespace chladni::cases
