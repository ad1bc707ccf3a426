#include "cases/reduce_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <utility>

#include "cases/chosen_mesh.hpp"
#include "cases/fe_model.hpp"
#include "cases/moving_body.hpp"
#include "cases/picture.hpp"
#include "cases/possible_sector.hpp"
#include "cases/ranks.hpp"
#include "cases/scene_support.hpp"
#include "cases/section_forces.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "mesh/nodal_matrices.hpp"
#include "mesh/partition.hpp"
#include "reduce/craig_bampton.hpp"
#include "reduce/reduced_system.hpp"
#include "report/origin.hpp"
#include "report/version.hpp"

namespace chladni::cases {

using Eigen::MatrixXd;

namespace {

FeModel assemble_scene(const scene::Scene& scene, mesh::Mesh mesh)
{
  expect_mass(scene);
  plate::DofMap dofs = plate::make_dof_map(
      mesh,
      {.couplings = scene.couplings, .components = scene.components, .rings = scene.ring_harmonics},
      mesh::node_owners(mesh, n_ranks()), n_ranks());
  Attachments attachments = find_attachments(mesh, dofs, scene.interface_nodes);
  plate::System system =
      plate::assemble(mesh, structure_of(scene), std::move(dofs), PETSC_COMM_WORLD);
  return {
      .mesh = std::move(mesh), .system = std::move(system), .attachments = std::move(attachments)};
}

reduce::ReductionOptions options_of(const scene::Scene& scene, const linear::SolverOptions& solver)
{
  // Of mass integrals and stiffening: 64 columns of the product of a matrix with Psi and Phi, and
  // their rows that move in one direction; the rows of Psi and Phi that several forms need
  // together; these forms and their blocks.
  constexpr double moving_rows = 0.4, rows_together = 0.7, block = 64.0;
  constexpr reduce::WorkAfterwards in_integrals{.columns = block * (1.0 + moving_rows),
                                                .of_a_part_for_each_kept = rows_together,
                                                .matrices = 3.0};
  const bool projects = scene.mass_integrals || !scene.stiffening.empty();
  reduce::WorkAfterwards later = projects ? in_integrals : reduce::WorkAfterwards{};
  if (may_keep_responses(scene)) {
    // Half a solution for the inertia of each column that the loads move, and blocks of these; for
    // each load, which are one direction of the nodes, a shape, its part in the basis, its products
    // with K and M, K_ss^-1.
    constexpr double blocks = 2.0, for_each_load = 5.0, loads = 1.0 / 6.0;
    later.columns = std::max(later.columns, blocks * block);
    later.of_a_part_for_each_kept = 1.0;
    later.columns_for_each_kept = for_each_load * loads;
  }
  return {.basis = scene.reduce,
          .solver = solver,
          .count = scene.sylvester,
          .keeps_matrices = wants_full_responses(scene),
          .later = later};
}

bool finds_modes(const reduce::Reduction& reduction)
{
  return reduction.choice.method == reduce::Method::craig_bampton;
}

SceneReduction reduce_model(const scene::Scene& scene, FeModel& fe,
                            const linear::SolverOptions& solver, Phases& phases)
{
  reduce::ReductionOptions options = options_of(scene, solver);
  mbs_export::ReducedSystem system = described_system(scene, fe);
  reduce::FactoredBody body = reduce::factored(body_of(scene, fe), options, phases);
  const SceneSupport support(system, body.masters, certified_support(scene, fe));
  const std::optional<SceneResponses> responses =
      scene_responses(scene, system, body.masters, support.fixed());
  if (responses) options.responses = responses->goal;
  reduce::Reduction reduction = reduce::reduction(body, options, support, phases);
  system = reduce::reduced_system(std::move(system), body, reduction, support.fixed());
  if (system.certificate.responses) system.certificate.responses->loads = *responses->names;
  const auto n_modes = static_cast<int>(reduction.model.omega.size());
  phases.begin("residuals");
  const double residual =
      finds_modes(reduction)
          ? reduce::largest_residual(*reduction.Q_CB.modes, body.K_blocks.ss, body.M_blocks.ss)
          : 0.0;
  phases.end();
  if (wants_full_responses(scene)) {
    reduction = reduce::with_responses(std::move(reduction), body,
                                       full_response_loads(scene, system, body.masters), phases);
    system = reduce::reduced_system(std::move(system), body, reduction, support.fixed());
  }
  std::vector<int> places = reduce::coordinate_places(body.masters, reduction.model);
  SceneReduction reduced{.body = std::move(body),
                         .reduction = std::move(reduction),
                         .places = std::move(places),
                         .system = std::move(system),
                         .n_modes = n_modes,
                         .modes_residual = residual};
  if (fe.system.C != nullptr) reduced.system.C = projected(reduced, fe.system.C);
  if (fe.system.H != nullptr) reduced.system.H = projected(reduced, fe.system.H);
  return reduced;
}

/// Of the transformation, with the columns in the order of the file.
RowsOf rows_of(const SceneReduction& reduced)
{
  return [&](const std::vector<int>& dofs) -> MatrixXd {
    return reduce::basis_rows(reduced.reduction.Q_CB, reduced.body.dofs, dofs)(every,
                                                                               reduced.places);
  };
}

/// Whether the integrals over the mass are wanted, and follow from what is known of it.
bool has_mass_integrals(const scene::Scene& scene, const mesh::Mesh& mesh)
{
  if (!scene.mass_integrals || !mesh.matrices || mesh::is_mass_of_points(*mesh.matrices))
    return scene.mass_integrals;
  if (scene.squeal) {
    scene::refuse_key(scene, "mesh.matrices",
                      "the mass couples directions or rotations, so that Coriolis and centrifugal "
                      "terms of a disc that turns do not follow from it; `mass_integrals = false` "
                      "in [reduce] leaves them out");
  }
  on_first_rank([] {
    report::tell_note(
        "the mass of the matrices couples directions or rotations: there are no integrals over the "
        "mass for a body that moves far or turns");
  });
  return false;
}

/// Room for interface modes of the whole model, mass integrals, pictures and section forces.
SceneReduction with_what_bodies_need(const scene::Scene& scene, const FeModel& fe,
                                     SceneReduction reduced, Phases& phases)
{
  if (has_mass_integrals(scene, fe.mesh)) {
    phases.begin("mass integrals");
    reduced.system.mass_integrals = mass_integrals(structure_of(scene), fe, reduced);
  }
  const RowsOf rows = rows_of(reduced);
  if (reduced.system.ring_motion) {
    reduced.system.ring_motion->displacements =
        node_rows(fe.attachments.nodes, fe.system.dofs, rows);
  }
  phases.begin("pictures");
  const reduce::OwnBasisRows own(reduced.reduction.Q_CB, reduced.body.dofs);
  reduced.system.picture = make_picture(picture_nodes(fe.mesh, scene.pictures), fe.system.dofs,
                                        {.n_columns = std::ssize(reduced.places),
                                         .has = [&](int dof) { return own.has(dof); },
                                         .rows_of = [&](const std::vector<int>& dofs) -> MatrixXd {
                                           return own.rows(dofs)(every, reduced.places);
                                         }});
  if (!scene.resultants.groups.empty()) {
    phases.begin("section forces");
    reduced.system.resultants = section_forces(scene.resultants, structure_of(scene),
                                               {.mesh = fe.mesh, .dofs = fe.system.dofs}, rows);
  }
  phases.end();
  return reduced;
}

/// "; mesh through libgmsh.so.4.8", or nothing where this program made it.
std::string maker(const mesh::Mesh& mesh)
{
  if (mesh.made_by.empty()) return "";
  return fmt::format("; mesh through {}", std::filesystem::path(mesh.made_by).filename().string());
}

}  // namespace

plate::Structure structure_of(const scene::Scene& scene)
{
  return {.shells = scene.sections,
          .beams = scene.beams,
          .solids = scene.solids,
          .masses = scene.masses,
          .springs = scene.springs};
}

void expect_mass(const scene::Scene& scene)
{
  const auto check = [&](const auto& sections) {
    for (const auto& section : sections) {
      if (section.material.density > 0.0) continue;
      throw Error(
          fmt::format("{}: section of \"{}\": its material has no density, as static loads need "
                      "none; vibrations do: write it into [material]",
                      scene.path, section.group));
    }
  };
  check(scene.sections);
  check(scene.beams);
  check(scene.solids);
}

MatrixXd projected(const SceneReduction& reduced, Mat A, linear::FormSymmetry symmetry)
{
  return reduce::project_form(reduced.reduction.Q_CB, reduce::split(A, reduced.body.dofs),
                              symmetry)(reduced.places, reduced.places);
}

mbs_export::Provenance provenance(const scene::Scene& scene, const SaidOfSolvers& solvers,
                                  const mesh::Mesh& mesh)
{
  return {.scene = scene.text,
          .mesh_checksum = mesh::checksum(mesh),
          .versions = fmt::format("Chladni {}; {}{}", report::version, reduce::library_versions(),
                                  maker(mesh)),
          .options = solvers.text,
          .ranks = n_ranks(),
          .mesh_file_digest = report::digest_of_mesh_files(scene)};
}

namespace {

/// Of a scene whose mesh is said.
ReduceSummary reduce_meshed(const scene::Scene& scene, const SaidOfSolvers& solvers, Phases& phases)
{
  phases.begin("mesh");
  MeshedScene meshed = meshed_scene(scene);
  if (meshed.mesh.sectors.count > 1) {
    const mbs_export::Provenance from = provenance(scene, solvers, meshed.mesh);
    ReduceSummary summary = reduce_sectors(scene, std::move(meshed), solvers.options, phases);
    summary.reduced.provenance = from;
    return summary;
  }
  phases.begin("assembly");
  FeModel fe = assemble_scene(scene, std::move(meshed.mesh));
  const StressedStates stressed = stressed_states(scene, fe, solvers.options, phases);
  SceneReduction reduced = reduce_model(scene, fe, solvers.options, phases);
  reduced = with_what_bodies_need(scene, fe, std::move(reduced), phases);
  if (!stressed.loads.empty()) {
    phases.begin("stiffening");
    reduced.system.stiffening = stiffening(scene, fe, reduced, stressed);
    phases.end();
  }
  mbs_export::ReducedSystem& system = reduced.system;
  system.provenance = provenance(scene, solvers, fe.mesh);
  return {.reduced = std::move(system),
          .phases = phases.times(),
          .n_dofs = fe.system.dofs.n_dofs(),
          .n_nodes = fe.mesh.n_nodes(),
          .n_masters = static_cast<int>(reduced.body.masters.size()),
          .choice = reduced.reduction.choice,
          .n_modes = reduced.n_modes,
          .n_modes_asked =
              finds_modes(reduced.reduction) ? static_cast<int>(scene.reduce.modes.value_or(0)) : 0,
          .factorization = phases.time_of("factorization"),
          .factor = linear::factor_size(reduced.body.K_ss.factor()),
          .modes_residual = reduced.modes_residual};
}

}  // namespace

ReduceSummary reduce_scene(const scene::Scene& scene, const SaidOfSolvers& solvers,
                           const ReduceProgress& progress)
{
  if (scene.interface_nodes.empty()) {
    throw Error(fmt::format("{}: interface is missing: a reduction needs [interface] and [reduce]",
                            scene.path));
  }
  Phases phases(progress);
  const MeshChoice choice = chosen_mesh(scene, supports_of(scene), solvers.options, phases);
  mbs_export::OwnCompliances compliances;
  if (choice.errors && scene.squeal) {
    scene::Scene supported = choice.scene;
    supported.supports = supports_of(scene);
    compliances = mesh_compliances(supported, solvers.options);
  }
  ReduceSummary summary = reduce_meshed(choice.scene, solvers, phases);
  if (choice.errors) {
    mbs_export::Certificate& certificate = summary.reduced.certificate;
    const Eigen::Index n = std::min(certificate.frequencies.size(), choice.errors->errors.size());
    certificate.mesh_errors = choice.errors->errors.head(n);
    certificate.mesh_shape_errors = choice.errors->shape_errors.leftCols(n);
    if (n > 0) certificate.mesh_compliances = std::move(compliances);
  }
  return summary;
}

std::vector<report::Stage> stages_of(const reduce::ReduceOptions& wanted)
{
  using report::Times;
  std::vector<report::Stage> stages{
      {"mesh", 1.0}, {"assembly", 3.0}, {"partition", 1.0}, {"factorization", 4.0}};
  const report::Stage constraint{"constraint modes", 4.0};
  const auto add = [&](const std::vector<report::Stage>& more) {
    stages.insert(stages.end(), more.begin(), more.end());
  };
  if (wanted.method == reduce::Method::guyan)
    add({constraint});
  else if (wanted.method == reduce::Method::mixed_interface)
    add({constraint, {"mixed-interface modes", 25.0}, {"residual flexibility", 5.0}});
  else if (wanted.method == reduce::Method::automatic)
    add({constraint,
         {"fixed-interface modes", 25.0, Times::unknown},
         {"mixed-interface modes", 25.0},
         {"residual flexibility", 5.0}});
  else if (wanted.method != reduce::Method::craig_bampton)
    add({constraint, {"free-interface modes", 25.0}, {"residual flexibility", 5.0}});
  else if (wanted.tolerance)
    add({constraint, {"fixed-interface modes", 40.0, Times::unknown}});
  else
    add({{"fixed-interface modes", 20.0}, constraint});
  add({{"projection", 6.0},
       {"error estimates", 8.0},
       {"condition", 1.0},
       {"count of eigenvalues", 15.0},
       {"residuals", 2.0},
       {"mass integrals", 25.0},
       {"pictures", 1.0}});
  return stages;
}

std::vector<report::Stage> stages_of_sectors()
{
  return {{"mesh", 2.0},       {"assembly", 4.0},   {"modes of harmonics", 14.0},
          {"harmonics", 60.0}, {"whole body", 2.0}, {"mass integrals", 16.0},
          {"pictures", 2.0}};
}

namespace {

/// "101 (100 asked; 1 more of the same frequency)": what a disc has twice is not parted.
std::string number_of_modes(const ReduceSummary& summary)
{
  const int n_more = summary.n_modes - summary.n_modes_asked;
  if (summary.n_modes_asked == 0 || n_more == 0) return fmt::format("{}", summary.n_modes);
  return fmt::format("{} ({} asked; {} more of the same frequency)", summary.n_modes,
                     summary.n_modes_asked, n_more);
}

/// Of the frequencies: the estimate, or what rounding may do where that is more.
double largest_error(const mbs_export::Certificate& certificate)
{
  const double estimate = mbs_export::estimated_errors(certificate).maxCoeff();
  if (certificate.rounding.size() == 0) return estimate;
  return std::max(estimate, 0.5 * certificate.rounding.maxCoeff());
}

}  // namespace

report::TextTable reduction_table(const ReduceSummary& summary)
{
  report::TextTable table{.header = {"reduction", "value"}, .rows = {}};
  table.rows.push_back({"nodes of the mesh", fmt::format("{}", summary.n_nodes)});
  table.rows.push_back({"DOFs", fmt::format("{}", summary.n_dofs)});
  table.rows.push_back({"masters", fmt::format("{}", summary.n_masters)});
  table.rows.push_back({"method", std::string(reduce::name_of(summary.choice.method))});
  table.rows.push_back({"modes", number_of_modes(summary)});
  const mbs_export::Certificate& certificate = summary.reduced.certificate;
  if (const Eigen::Index n = certificate.eta2.size(); n > 0) {
    table.rows.push_back({fmt::format("estimated error of the frequencies up to {:.0f} Hz",
                                      certificate.frequencies[n - 1] / (2.0 * std::numbers::pi)),
                          fmt::format("{:.1e}", largest_error(certificate))});
  }
  if (certificate.mesh_errors.size() > 0) {
    table.rows.push_back({"estimated error of these by the mesh",
                          fmt::format("{:.1e}", certificate.mesh_errors.maxCoeff())});
  }
  if (const mbs_export::ModeCount& count = certificate.range; count.up_to > 0.0) {
    table.rows.push_back(
        {fmt::format("modes up to {:.0f} Hz", count.up_to / (2.0 * std::numbers::pi)),
         fmt::format("{} of {}{}", count.found, count.expected,
                     count.missing() > 0 ? ": take more modes" : "")});
  }
  table.rows.push_back(
      {"CPU of the factorisation, s", fmt::format("{:.3f}", summary.factorization.cpu_s)});
  return table;
}

std::string described_reduction(const ReduceSummary& summary)
{
  const std::string table = report::format_table(reduction_table(summary));
  if (summary.choice.reason.empty()) return table;
  return fmt::format("{}{} was chosen since\n  {}\n", table, reduce::name_of(summary.choice.method),
                     summary.choice.reason);
}

std::vector<report::Json::Member> reduction_json(const ReduceSummary& summary)
{
  return {{"n_dofs", summary.n_dofs},
          {"n_nodes", summary.n_nodes},
          {"n_masters", summary.n_masters},
          {"method", std::string(reduce::name_of(summary.choice.method))},
          {"why_this_method", summary.choice.reason},
          {"n_modes", summary.n_modes},
          {"certified_frequencies_Hz",
           report::frequencies_json(summary.reduced.certificate.frequencies)},
          {"eta2", report::numbers_json(summary.reduced.certificate.eta2)},
          {"estimated_errors",
           report::numbers_json(mbs_export::estimated_errors(summary.reduced.certificate))},
          {"rounding", report::numbers_json(summary.reduced.certificate.rounding)},
          {"bounds", report::numbers_json(summary.reduced.certificate.bounds)},
          {"modes_expected", summary.reduced.certificate.range.expected},
          {"modes_found", summary.reduced.certificate.range.found},
          {"condition_K_ss", summary.reduced.certificate.condition},
          {"factor_wall_s", summary.factorization.wall_s},
          {"factor_cpu_s", summary.factorization.cpu_s},
          {"modes_residual", summary.modes_residual},
          {"factor_operations", summary.factor.operations},
          {"factor_entries", summary.factor.entries},
          {"factor_operations_of_rank", summary.factor.operations_of_rank},
          {"factor_entries_of_rank", summary.factor.entries_of_rank}};
}

}  // namespace chladni::cases
