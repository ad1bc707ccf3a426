#include "cases/reduced_harmonics.hpp"

#include <fmt/format.h>

#include <exception>
#include <numeric>
#include <utility>

#include "cases/lent_motions.hpp"
#include "common/all_ranks.hpp"
#include "common/error.hpp"
#include "linear/cholesky/cholesky_types.hpp"
#include "linear/progress.hpp"
#include "reduce/basis.hpp"
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
                     const Described& described)
{
  HarmonicPart part{.order = harmonic.coordinates.order,
                    .n_coordinates = harmonic.coordinates.n(),
                    .masters = {},
                    .K = harmonic.K,
                    .M = harmonic.M,
                    .C = harmonic.C,
                    .H = harmonic.H,
                    .omega = harmonic.omega,
                    .certificate = harmonic.certificate,
                    .interface = interface_motion(harmonic, model),
                    .picture = picture_motion(harmonic, model, described.chosen.nodes),
                    .sector = {},
                    .deviating = cyclic::sector_motion(harmonic, described.deviating)};
  for (const cyclic::Master& master : harmonic.coordinates.masters)
    part.masters.push_back(master_index(described.system, model, master));
  part.factor_entries = linear::factor_size(harmonic.body.K_ss.factor()).entries;
  const bool are_fixed_interface = !reduce::has_free_masters(harmonic.method);
  if (are_fixed_interface && harmonic.basis.modes && harmonic.basis.n_modes() > 0) {
    part.modes_residual = reduce::largest_residual(*harmonic.basis.modes, harmonic.body.K_blocks.ss,
                                                   harmonic.body.M_blocks.ss);
  }
  return part;
}

cyclic::SectorMotion motion_of_sector(const cyclic::HarmonicModel& harmonic,
                                      const SectorModel& model)
{
  std::vector<int> all(std::size_t(model.dofs.n_dofs()));
  std::iota(all.begin(), all.end(), 0);
  return cyclic::sector_motion(harmonic, all);
}

/// The harmonics of a group, one after the other.
class Harmonics {
 public:
  Harmonics(const SectorModel& model, const cyclic::SectorMatrices& matrices,
            const reduce::ReductionOptions& options, const Described& described,
            const HarmonicGroups& groups)
      : model_(model),
        matrices_(matrices),
        options_(options),
        described_(described),
        groups_(groups),
        lent_(model.dofs.count, model.dofs.n_dofs(), groups)
  {}

  /// @note   Collective on all ranks. A rank that fails goes on lending nothing, so that none waits
  ///         for it.
  /// @throws chladni::Error naming the harmonic, on all ranks.
  std::vector<HarmonicPart> reduced()
  {
    std::vector<HarmonicPart> parts;
    std::size_t n_done = 0;
    for (const int order : groups_.own()) {
      cyclic::SectorMotion motion;
      agree_in_group();
      attempt(order, [&] { parts.push_back(reduced(order, motion)); });
      if (described_.mass && groups_.speaks()) {
        lent_.exchange(order, std::move(motion));
        attempt(order,
                [&] { parts.back().mass = described_.mass->of_harmonic(order, lent_.motions()); });
      }
      if (!groups_.speaks()) parts.clear();
      linear::report_progress(double(++n_done) / double(groups_.own().size()));
    }
    on_all_ranks(PETSC_COMM_WORLD, [&] {
      if (failure_) std::rethrow_exception(failure_);
      return 0;
    });
    return parts;
  }

 private:
  /// What one rank of the group failed at, all give up: they would wait for each other.
  void agree_in_group()
  {
    try {
      on_all_ranks(groups_.comm(), [&] {
        if (failure_) std::rethrow_exception(failure_);
        return 0;
      });
    } catch (...) {
      failure_ = std::current_exception();
    }
  }

  /// Unless something has failed before, or a harmonic that this one needs has on another rank.
  template <typename Work>
  void attempt(int order, const Work& work)
  {
    if (failure_) return;
    try {
      work();
    } catch (const Error& error) {
      failure_ = std::make_exception_ptr(Error(
          fmt::format("harmonic {} of {} sectors: {}", order, model_.dofs.count, error.what())));
    } catch (...) {
      failure_ = std::current_exception();
    }
  }

  HarmonicPart reduced(int order, cyclic::SectorMotion& motion) const
  {
    FactorTime phases;
    const linear::ListenToProgress to_no_step({});  // a harmonic is a step of the whole
    const cyclic::HarmonicModel harmonic =
        cyclic::reduce_harmonic(matrices_, cyclic::harmonic_coordinates(model_.dofs, order),
                                options_, described_.support.is_held, phases, goal());
    HarmonicPart part = part_of(harmonic, model_, described_);
    part.factor_s = phases.seconds();
    if (described_.mass || described_.with_forces) motion = motion_of_sector(harmonic, model_);
    if (described_.with_forces) part.sector = motion;
    return part;
  }

  std::optional<cyclic::HarmonicGoal> goal() const
  {
    if (!described_.responses) return std::nullopt;
    return described_.responses->goal;
  }

  const SectorModel& model_;
  const cyclic::SectorMatrices& matrices_;
  const reduce::ReductionOptions& options_;
  const Described& described_;
  const HarmonicGroups& groups_;
  LentMotions lent_;
  std::exception_ptr failure_;
};

}  // namespace

std::vector<HarmonicPart> reduced_harmonics(const SectorModel& model,
                                            const cyclic::SectorMatrices& matrices,
                                            const reduce::ReductionOptions& options,
                                            const Described& described,
                                            const HarmonicGroups& groups)
{
  return Harmonics(model, matrices, options, described, groups).reduced();
}

}  // namespace chladni::cases
