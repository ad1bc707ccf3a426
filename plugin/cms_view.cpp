// CMSView: ascii with the certificate, or the reduced file.

#include <petscviewer.h>
#include <slepcsys.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <string_view>

#include "common/all_ranks.hpp"
#include "mbs_export/files/body_files.hpp"
#include "plugin/cms_impl.hpp"
#include "reduce/reduced_system.hpp"

using namespace chladni::plugin;  // NOLINT(google-build-using-namespace)

namespace {

/// A line; PETSc's printf would indent each part of one.
void print(PetscViewer viewer, const std::string& line)
{
  chladni::petsc::check(PetscViewerASCIIPrintf(viewer, "%s\n", line.c_str()));
}

void view_count(const CMSCount& count, const char* what, PetscViewer viewer)
{
  if (count.upto == 0.0) return;
  print(viewer, fmt::format("eigenvalues of the {} below {:.6g} Hz: {} expected (Sylvester), {} "
                            "found, {} missing{}",
                            what, count.upto, count.expected, count.found, count.missing,
                            count.missing > 0 ? ": take more modes" : ""));
}

void view_modes(const Result& result, PetscViewer viewer)
{
  constexpr std::size_t most_lines = 20;
  const chladni::reduce::Certificate& certificate = result.reduction.certificate;
  const std::size_t n = result.f_Hz.size();
  print(viewer, fmt::format("  mode    frequency, Hz   eta^2 (error of lambda){}",
                            certificate.bounds.empty() ? "" : "        bound"));
  for (std::size_t i = 0; i < std::min(n, most_lines); ++i) {
    const std::string bound =
        i < certificate.bounds.size() ? fmt::format("{:20.2e}", certificate.bounds[i]) : "";
    const std::string eta2 = i < certificate.eta2.size()
                                 ? fmt::format("{:16.2e}", certificate.eta2[i])
                                 : fmt::format("{:>16}", "-");
    print(viewer, fmt::format("{:6} {:16.8g} {}{}", i + 1, result.f_Hz[i], eta2, bound));
  }
  if (n > most_lines) print(viewer, fmt::format("  ... {} more", n - most_lines));
  if (!certificate.eta2.empty())
    print(viewer, fmt::format("  largest eta^2 {:.2e}", std::ranges::max(certificate.eta2)));
}

/// Modes beyond the number asked for belong to the last one: a frequency that a disc has twice is
/// not parted.
std::string partners(const chladni::reduce::ReduceOptions& wanted, std::size_t n_modes)
{
  const auto n_asked = static_cast<std::size_t>(wanted.modes.value_or(0));
  if (wanted.method != chladni::reduce::Method::craig_bampton || n_asked == 0 || n_modes <= n_asked)
    return "";
  return fmt::format(" ({} asked; {} more of the same frequency)", n_asked, n_modes - n_asked);
}

void view_result(const Result& result, const chladni::reduce::ReduceOptions& wanted,
                 PetscViewer viewer)
{
  const CMSQuality& quality = result.quality;
  constexpr double two_pi = 2.0 * std::numbers::pi;
  const std::vector<double>& omega = result.reduction.model.omega;
  if (!omega.empty()) {
    print(viewer, fmt::format("modes with held masters: {}{}, from {:.6g} to {:.6g} Hz",
                              omega.size(), partners(wanted, omega.size()), omega.front() / two_pi,
                              omega.back() / two_pi));
  }
  print(viewer, fmt::format("condition of K_ss (estimate): {:.2e}", quality.condition));
  print(viewer,
        quality.n_zero == 0
            ? std::string("zero-energy modes: none")
            : fmt::format("zero-energy modes: {}, largest eigenvalue over the first elastic one "
                          "{:.1e}",
                          quality.n_zero, quality.rigid_residual));
  view_count(quality.modes, "fixed interface", viewer);
  view_count(quality.model, "model", viewer);
  if (quality.complete.upto != quality.model.upto) view_count(quality.complete, "model", viewer);
  view_modes(result, viewer);
}

void view_state(CMS cms, PetscViewer viewer)
{
  const Inside& in = *cms->inside;
  if (in.set_up) {
    PetscInt n = 0;
    chladni::petsc::check(MatGetSize(in.set_up->body.K, &n, nullptr));
    print(viewer, fmt::format("rows: {}, masters: {}", n, in.set_up->body.masters.size()));
    if (in.problem) {
      const auto& coordinates = in.problem->harmonic.coordinates;
      print(viewer,
            fmt::format("harmonic {} of {} sectors{}", coordinates.order(), coordinates.count(),
                        coordinates.has_one_phase() ? "" : ": each eigenvalue twice"));
    }
  }
  if (in.result)
    view_result(*in.result, in.settings.options.basis, viewer);
  else
    print(viewer, "not solved yet");
}

PetscErrorCode view_ascii(CMS cms, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscObjectPrintClassNamePrefixType((PetscObject)cms, viewer));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscCall(guarded((PetscObject)cms, __func__, [&] { view_state(cms, viewer); }));
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode CMSView(CMS cms, PetscViewer viewer)
{
  PetscBool ascii = PETSC_FALSE;
  PetscBool hdf5 = PETSC_FALSE;
  const char* path = nullptr;
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  if (!viewer) PetscCall(PetscViewerASCIIGetStdout(PetscObjectComm((PetscObject)cms), &viewer));
  PetscValidHeaderSpecific(viewer, PETSC_VIEWER_CLASSID, 2);
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERHDF5, &hdf5));
  if (ascii) PetscCall(view_ascii(cms, viewer));
  if (hdf5) {
    PetscCall(PetscViewerFileGetName(viewer, &path));
    PetscCall(CMSWrite(cms, path));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CMSViewFromOptions(CMS cms, PetscObject prefixed, const char name[])
{
  std::array<char, PETSC_MAX_PATH_LEN> text{};
  PetscBool given = PETSC_FALSE;
  const auto owner = prefixed ? prefixed : (PetscObject)cms;
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(
      PetscOptionsGetString(owner->options, owner->prefix, name, text.data(), text.size(), &given));
  constexpr std::string_view hdf5 = "hdf5:";
  // Not by a viewer of PETSc, which would empty the file before the new one is complete.
  if (given && std::string_view(text.data()).starts_with(hdf5)) {
    PetscCall(CMSWrite(cms, text.data() + hdf5.size()));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscObjectViewFromOptions((PetscObject)cms, prefixed, name));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSWrite(CMS cms, const char filename[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCheck(cms->inside->result, PetscObjectComm((PetscObject)cms), PETSC_ERR_ORDER,
             "Call CMSSolve() before the reduced file is written");
  PetscCheck(filename && *filename, PetscObjectComm((PetscObject)cms), PETSC_ERR_FILE_OPEN,
             "No file name; give -cms_view hdf5:FILE");
  PetscCall(guarded((PetscObject)cms, __func__, [&] {
    Phase phase(cms, events.view, "reduced file");
    write_file(cms, filename);
    phase.done();
  }));
  PetscFunctionReturn(0);
}

namespace chladni::plugin {

// The reduced file of a CMS, of the same format as that of `chladni reduce`.

namespace {

/// Blocks of K's rows are nodes where a block fits the six components of one; else each row is.
std::vector<MasterPlace> default_places(Mat K, const std::vector<PetscInt>& masters)
{
  PetscInt block_size = 1;
  petsc::check(MatGetBlockSize(K, &block_size));
  if (block_size > 6) block_size = 1;
  std::vector<MasterPlace> places;
  for (const PetscInt dof : masters) {
    places.push_back(
        {.node = dof / block_size, .component = dof % block_size, .x = {0.0, 0.0, 0.0}});
  }
  return places;
}

/// Of all ranks, on every rank, in the order of the interface.
std::vector<MasterPlace> gathered_places(const std::vector<MasterPlace>& own, MPI_Comm comm)
{
  std::vector<int> sizes(petsc::size(comm)), offsets(petsc::size(comm));
  const auto n_bytes = static_cast<int>(own.size() * sizeof(MasterPlace));
  MPI_Allgather(&n_bytes, 1, MPI_INT, sizes.data(), 1, MPI_INT, comm);
  for (std::size_t i = 1; i < sizes.size(); ++i) offsets[i] = offsets[i - 1] + sizes[i - 1];
  std::vector<MasterPlace> all((offsets.back() + sizes.back()) / sizeof(MasterPlace));
  MPI_Allgatherv(own.data(), n_bytes, MPI_BYTE, all.data(), sizes.data(), offsets.data(), MPI_BYTE,
                 comm);
  return all;
}

/// Of a harmonic, whose nodes move in y, too: these are numbered on from the largest in x.
std::vector<MasterPlace> harmonic_places(const std::vector<MasterPlace>& places,
                                         const HarmonicMasters& masters)
{
  const PetscInt beyond = 1 + std::ranges::max(places, {}, &MasterPlace::node).node;
  std::vector<MasterPlace> of_harmonic;
  for (std::size_t i = 0; i < masters.places.size(); ++i) {
    of_harmonic.push_back(places[static_cast<std::size_t>(masters.places[i])]);
    of_harmonic.back().node += masters.phases[i] * beyond;
  }
  return of_harmonic;
}

/// In the order of the reduced rows.
std::vector<MasterPlace> places_of_masters(const Inside& in, MPI_Comm comm)
{
  int n_places = static_cast<int>(in.geometry.size());
  MPI_Allreduce(MPI_IN_PLACE, &n_places, 1, MPI_INT, MPI_SUM, comm);
  const std::vector<MasterPlace> places = n_places > 0
                                              ? gathered_places(in.geometry, comm)
                                              : default_places(in.K, all_indices(in.interface));
  return in.problem ? harmonic_places(places, in.problem->masters) : places;
}

/// Nodes in the order of their first master.
void add_attachments(mbs_export::ReducedSystem& system, const std::vector<MasterPlace>& places)
{
  std::map<PetscInt, int> index_of;
  for (const MasterPlace& place : places) {
    const auto [found, is_new] = index_of.try_emplace(place.node, std::ssize(index_of));
    if (is_new) {
      system.attachment_nodes.push_back(
          {.number = place.node, .position = {place.x[0], place.x[1], place.x[2]}});
    }
    system.masters.push_back(
        {.node = found->second, .component = static_cast<int>(place.component)});
  }
  mbs_export::AttachmentSet all{.name = "interface", .nodes = {}};
  for (int i = 0; i < std::ssize(system.attachment_nodes); ++i) all.nodes.push_back(i);
  system.sets.push_back(std::move(all));
}

/// A set for each component in which nodes are held, "held_z" of those along z, which the
/// certificate names "held_z.z".
/// @return the names of the support
std::vector<std::string> add_support(mbs_export::ReducedSystem& system,
                                     const reduce::FactoredBody& body,
                                     const std::vector<PetscInt>& held)
{
  constexpr std::array components{"x", "y", "z", "rx", "ry", "rz"};
  std::array<mbs_export::AttachmentSet, 6> sets;
  for (const PetscInt dof : held) {
    const auto at = std::ranges::find(body.masters, dof) - body.masters.begin();
    const mbs_export::MasterDof& master = system.masters[static_cast<std::size_t>(at)];
    sets[static_cast<std::size_t>(master.component)].nodes.push_back(master.node);
  }
  std::vector<std::string> support;
  for (std::size_t c = 0; c < sets.size(); ++c) {
    if (sets[c].nodes.empty()) continue;
    sets[c].name = fmt::format("held_{}", components[c]);
    support.push_back(fmt::format("{}.{}", sets[c].name, components[c]));
    system.sets.push_back(std::move(sets[c]));
  }
  return support;
}

mbs_export::Provenance provenance(CMS cms, MPI_Comm comm)
{
  char* options = nullptr;
  petsc::check(PetscOptionsGetAll(reinterpret_cast<PetscObject>(cms)->options, &options));
  mbs_export::Provenance result{.scene = "",
                                .mesh_checksum = "",
                                .versions = fmt::format("libchladni_petsc {}; {}", CHLADNI_VERSION,
                                                        reduce::library_versions()),
                                .options = options,
                                .ranks = petsc::size(comm)};
  petsc::check(PetscFree(options));
  return result;
}

}  // namespace

void write_file(CMS cms, const std::string& path)
{
  const Inside& in = *cms->inside;
  const reduce::FactoredBody& body = in.set_up->body;
  const VelocityForces& velocity = in.set_up->velocity;
  const MPI_Comm comm = body.comm();
  if (velocity.C && !velocity.is_symmetric) {
    throw Error(
        "CMSWrite: C is not symmetric (gyroscopic forces), and the reduced file holds damping "
        "only; give damping alone, and take the rest by CMSGetReducedOperators()");
  }
  mbs_export::ReducedSystem described;
  // PETSc would name an object that has no name by its address, which differs from run to run.
  const char* name = reinterpret_cast<PetscObject>(cms)->name;
  described.title = name ? name : "CMS";
  if (in.sectors)
    described.title += fmt::format(", harmonic {} of {} sectors", in.harmonic, in.sectors->count);
  add_attachments(described, places_of_masters(in, comm));
  const reduce::Reduction& reduction = in.result->reduction;
  std::vector<std::string> support = add_support(described, body, held_masters(in));
  mbs_export::ReducedSystem system =
      reduce::reduced_system(std::move(described), body, reduction, std::move(support));
  if (velocity.C) {
    const std::vector<int> places = reduce::coordinate_places(body.masters, reduction.model);
    system.C = reduced_velocity_forces(in)(places, places);
  }
  system.provenance = provenance(cms, comm);
  on_first_rank(comm, [&] { mbs_export::write_reduced(path, system); });
}

}  // namespace chladni::plugin
