#include "cases/reduce_scene.hpp"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "cases/picture.hpp"
#include "cases/possible_sector.hpp"
#include "cases/ranks.hpp"
#include "cases/sector_deviations.hpp"
#include "cases/sector_mass.hpp"
#include "cases/sector_model.hpp"
#include "cases/whole_body.hpp"
#include "common/all_ranks.hpp"
#include "common/error.hpp"
#include "common/packing.hpp"
#include "common/petsc.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/progress.hpp"
#include "reduce/basis.hpp"
#include "reduce/cyclic/sector.hpp"
#include "reduce/reduced_system.hpp"
#include "reduce/reduction.hpp"
#include "report/progress.hpp"
#include "report/timing.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd;

namespace {

/// Exchanges the motions of harmonics between ranks. The coupling of a harmonic with lower ones is
/// computed by the rank that reduces it, and no rank keeps more motions than that needs.
class LentMotions {
 public:
  /// @param count   number of sectors
  /// @param n_dofs  number of DOFs of one sector
  /// @param groups  whose speakers have the motions; must outlive this object
  LentMotions(int count, int n_dofs, const HarmonicGroups& groups);
  /// Waits until the motions of this rank have been taken.
  ~LentMotions();
  LentMotions(const LentMotions&) = delete;
  LentMotions& operator=(const LentMotions&) = delete;

  /// Sends the motion of a harmonic of this rank and waits for those of lower ones. The speaker of
  /// the group must call it for all its harmonics in ascending order, even after an error, then
  /// without a motion.
  void exchange(int order, cyclic::SectorMotion motion);

  /// The motions of the last harmonic and of those that it may be coupled with.
  const MotionsOfHarmonics& motions() const { return motions_; }

 private:
  void lend(int order, int to);
  void borrow(int order);
  void forget_below(int order);

  int n_harmonics_, n_dofs_;
  const HarmonicGroups& groups_;
  MotionsOfHarmonics motions_;
  std::map<int, std::vector<MPI_Request>> lent_;
};

/// Columns of the matrix, so that no count exceeds an int.
class ColumnType {
 public:
  explicit ColumnType(Index n_rows)
  {
    MPI_Type_contiguous(static_cast<int>(n_rows), MPI_DOUBLE, &type_);
    MPI_Type_commit(&type_);
  }
  ~ColumnType() { MPI_Type_free(&type_); }
  ColumnType(const ColumnType&) = delete;
  ColumnType& operator=(const ColumnType&) = delete;
  MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

LentMotions::LentMotions(int count, int n_dofs, const HarmonicGroups& groups)
    : n_harmonics_(cyclic::n_harmonics(count)), n_dofs_(n_dofs), groups_(groups)
{}

LentMotions::~LentMotions()
{
  forget_below(n_harmonics_);
}

void LentMotions::lend(int order, int to)
{
  const cyclic::SectorMotion& motion = motions_.at(order);
  const ColumnType column(n_dofs_);
  for (const MatrixXd* phase : {&motion.x, &motion.y}) {
    MPI_Isend(phase->data(), static_cast<int>(phase->cols()), column.get(), to, order,
              PETSC_COMM_WORLD, &lent_[order].emplace_back());
  }
}

void LentMotions::borrow(int order)
{
  const int from = groups_.speaker(order);
  const ColumnType column(n_dofs_);
  cyclic::SectorMotion& motion = motions_[order];
  for (MatrixXd* phase : {&motion.x, &motion.y}) {
    MPI_Status status;
    int n_columns = 0;
    MPI_Probe(from, order, PETSC_COMM_WORLD, &status);
    MPI_Get_count(&status, column.get(), &n_columns);
    phase->resize(n_dofs_, n_columns);
    MPI_Recv(phase->data(), n_columns, column.get(), from, order, PETSC_COMM_WORLD,
             MPI_STATUS_IGNORE);
  }
}

void LentMotions::forget_below(int order)
{
  for (auto& [lent, requests] : lent_) {
    if (lent >= order) continue;
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    requests.clear();
  }
  std::erase_if(motions_, [&](const auto& motion) { return motion.first < order; });
}

void LentMotions::exchange(int order, cyclic::SectorMotion motion)
{
  motions_.emplace(order, std::move(motion));
  for (int higher = order + 1; higher <= std::min(order + SectorMass::reach, n_harmonics_ - 1);
       ++higher)
    if (groups_.speaker(higher) != rank()) lend(order, groups_.speaker(higher));
  forget_below(order - SectorMass::reach);
  for (int lower = std::max(order - SectorMass::reach, 0); lower < order; ++lower)
    if (groups_.speaker(lower) != rank()) borrow(lower);
}

/// The contents of the whole body's file besides the harmonics.
struct Described {
  mbs_export::ReducedSystem system;  ///< `described_whole`
  SectorSupport support;
  double lambda_max;  ///< up to which each harmonic is certified, rad^2/s^2
  PictureNodes chosen;
  /// null if the scene wants no mass integrals
  std::unique_ptr<SectorMass> mass;
  /// section forces need the motion of the whole sector
  bool with_forces;
  std::vector<int> deviating;  ///< SectorDeviations::rows
  std::optional<HarmonicResponses> responses;
};

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
    const SectorNode& node = model.interface.nodes[std::size_t(i)];
    for (const int block : {node.block, node.rotations}) {
      for (int k = 0; block >= 0 && k < std::ssize(components); ++k) {
        dofs.push_back(block * static_cast<int>(components.size()) + k);
        rows.push_back(6 * i + model.dofs.component(block, k));
      }
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

/// The reduced harmonics of this rank's group; none on ranks that do not speak for their group.
/// @note   Collective on all ranks.
/// @throws chladni::Error naming the harmonic, on all ranks.
std::vector<HarmonicPart> reduced_harmonics(const SectorModel& model,
                                            const cyclic::SectorMatrices& matrices,
                                            const reduce::ReductionOptions& options,
                                            const Described& described,
                                            const HarmonicGroups& groups)
{
  return Harmonics(model, matrices, options, described, groups).reduced();
}

double certified_up_to(const reduce::ReduceOptions& wanted)
{
  double f_Hz = wanted.certified_up_to_Hz.value_or(std::numeric_limits<double>::infinity());
  if (wanted.tolerance) f_Hz = wanted.tolerance->up_to_Hz;
  return std::pow(2.0 * std::numbers::pi * f_Hz, 2);
}

Described described_body(const scene::Scene& scene, const SectorModel& model,
                         const reduce::ReductionOptions& options,
                         const SectorDeviations& deviations)
{
  Described described{.system = described_whole(scene, model),
                      .support = sector_support(scene, model),
                      .lambda_max = certified_up_to(options.basis),
                      .chosen = picture_nodes(model.mesh, scene.pictures),
                      .mass = {},
                      .with_forces = !scene.resultants.groups.empty(),
                      .deviating = deviations.rows,
                      .responses = {}};
  described.responses = harmonic_responses(scene, model, described.system, described.support);
  on_all_ranks(PETSC_COMM_WORLD, [&] {
    if (scene.mass_integrals) described.mass = std::make_unique<SectorMass>(scene, model);
    return 0;
  });
  return described;
}

/// All that the file has, on the first rank; the parts give back what no later step wants.
/// @note   Collective on all ranks: they have the same phases.
mbs_export::ReducedSystem whole_body(const scene::Scene& scene, const SectorModel& model,
                                     std::vector<HarmonicPart>& parts, const Described& described,
                                     const SectorDeviations& deviations, Phases& phases)
{
  const Index n_m = described.system.n_masters();
  mbs_export::ReducedSystem whole;
  phases.begin("whole body");
  on_first_rank([&] {
    whole = unfolded(described.system, model, parts, described.support.names, described.lambda_max);
    if (described.responses) add_responses(whole.certificate, parts, described.responses->names);
  });
  if (described.mass) {
    phases.begin("mass integrals");
    on_first_rank(
        [&] { whole.mass_integrals = sector_integrals(*described.mass, parts, whole.M, n_m); });
  }
  if (described.with_forces) {
    phases.begin("section forces");
    on_first_rank(
        [&] { whole.resultants = sector_forces(scene, model, parts, whole.M.rows(), n_m); });
  }
  MatrixXd T;
  if (!deviations.sectors.empty()) {
    phases.begin("deviations");
    on_first_rank([&] {
      T = add_deviations(whole, deviations, parts, model.dofs.count);
      report::tell_note(
          "deviations: errors of frequencies are not estimated, and modes are not counted; both "
          "are "
          "known of the body without its [[deviation]] tables alone");
    });
  }
  for (HarmonicPart& part : parts) {
    part.sector = {};
    part.deviating = {};
    part.mass = {};
  }
  if (!described.chosen.nodes.empty()) {
    phases.begin("pictures");
    on_first_rank([&] {
      add_picture(whole, described.chosen, model, parts);
      whole.picture_of_sectors->T = std::move(T);
    });
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
  const HarmonicGroups groups(cyclic::n_harmonics(model.dofs.count), scene.ranks_per_harmonic);
  const cyclic::SectorMatrices matrices = matrices_of(model, groups.comm());
  model.dofs.mirror = mirror_of(model, matrices);
  phases.begin("modes of harmonics");
  const reduce::ReductionOptions options = harmonic_options(
      scene, model, matrices, solver, sector_support(scene, model).is_held, groups);
  const SectorDeviations deviations =
      on_all_ranks(PETSC_COMM_WORLD, [&] { return sector_deviations(scene, model); });
  const Described described = described_body(scene, model, options, deviations);
  phases.begin("harmonics");
  std::vector<HarmonicPart> parts =
      gathered(reduced_harmonics(model, matrices, options, described, groups));
  ReduceSummary summary = summary_of(model, parts);
  summary.choice = harmonic_method(scene.reduce);
  summary.n_masters = static_cast<int>(described.system.masters.size());
  summary.reduced = whole_body(scene, model, parts, described, deviations, phases);
  summary.phases = phases.times();
  return summary;
}

namespace {

void transfer(Packer& archive, const MatrixXd& A)
{
  archive(std::int64_t{A.rows()});
  archive(std::int64_t{A.cols()});
  archive(std::vector<double>(A.data(), A.data() + A.size()));
}

void transfer(Unpacker& archive, MatrixXd& A)
{
  std::int64_t rows = 0, cols = 0;
  std::vector<double> values;
  archive(rows);
  archive(cols);
  archive(values);
  A = Eigen::Map<const MatrixXd>(values.data(), rows, cols);
}

void transfer_count(auto& archive, auto& count)
{
  archive(count.sigma);
  archive(count.expected);
  archive(count.found);
}

void transfer_certificate(auto& archive, auto& certificate)
{
  archive(certificate.lambda);
  archive(certificate.eta2);
  archive(certificate.estimates);
  archive(certificate.rounding);
  archive(certificate.bounds);
  transfer_count(archive, certificate.fixed_interface);
  transfer_count(archive, certificate.range);
  transfer_count(archive, certificate.complete);
  archive(certificate.n_zero);
  archive(certificate.zero_energy);
  archive(certificate.condition);
  archive(certificate.count_share);
  archive(certificate.responses.Omega);
  archive(certificate.responses.error);
}

void transfer_mass(auto& archive, auto& mass)
{
  transfer(archive, mass.displacement);
  transfer(archive, mass.position_displacement);
  archive.each(mass.couplings, [](auto& within, auto& coupling) {
    within(coupling.other);
    for (auto* blocks : {&coupling.of_other, &coupling.of_other_transposed})
      for (auto& block : *blocks) transfer(within, block);
  });
}

void transfer_part(auto& archive, auto& part, auto& omega)
{
  archive(part.order);
  archive(part.n_coordinates);
  archive(part.masters);
  for (auto* A : {&part.K, &part.M, &part.C, &part.H, &omega, &part.interface.x, &part.interface.y,
                  &part.picture.x, &part.picture.y, &part.sector.x, &part.sector.y,
                  &part.deviating.x, &part.deviating.y})
    transfer(archive, *A);
  transfer_mass(archive, part.mass);
  transfer_certificate(archive, part.certificate);
  archive(part.factor_entries);
  archive(part.factor_s);
  archive(part.modes_residual);
}

std::vector<char> packed(const std::vector<HarmonicPart>& parts)
{
  Packer packer;
  packer(parts.size());
  for (const HarmonicPart& part : parts) {
    const MatrixXd omega = part.omega;
    transfer_part(packer, part, omega);
  }
  return packer.bytes();
}

void unpack(const std::vector<char>& bytes, std::vector<HarmonicPart>& parts)
{
  Unpacker unpacker(bytes);
  std::size_t n = 0;
  unpacker(n);
  for (std::size_t i = 0; i < n; ++i) {
    HarmonicPart& part = parts.emplace_back();
    MatrixXd omega;
    transfer_part(unpacker, part, omega);
    part.omega = omega.reshaped();
  }
}

constexpr std::size_t piece = std::size_t(1) << 30;  // an MPI count is an int

void send_packed(const std::vector<char>& bytes)
{
  const std::size_t size = bytes.size();
  MPI_Send(&size, sizeof(size), MPI_BYTE, 0, 0, PETSC_COMM_WORLD);
  for (std::size_t at = 0; at < size; at += piece) {
    MPI_Send(bytes.data() + at, static_cast<int>(std::min(piece, size - at)), MPI_BYTE, 0, 0,
             PETSC_COMM_WORLD);
  }
}

std::vector<char> received(int from)
{
  std::size_t size = 0;
  MPI_Recv(&size, sizeof(size), MPI_BYTE, from, 0, PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
  std::vector<char> bytes(size);
  for (std::size_t at = 0; at < size; at += piece) {
    MPI_Recv(bytes.data() + at, static_cast<int>(std::min(piece, size - at)), MPI_BYTE, from, 0,
             PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
  }
  return bytes;
}

}  // namespace

std::vector<HarmonicPart> gathered(std::vector<HarmonicPart> own)
{
  if (rank() > 0) {
    send_packed(packed(own));
    return {};
  }
  std::vector<HarmonicPart> parts = std::move(own);
  for (int from = 1; from < n_ranks(); ++from) unpack(received(from), parts);
  std::ranges::sort(parts, {}, &HarmonicPart::order);
  return parts;
}

}  // namespace chladni::cases
