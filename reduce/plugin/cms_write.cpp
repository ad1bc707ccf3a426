// The reduced file of a CMS, of the same format as that of `chladni reduce`.
#include <slepcsys.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "common/all_ranks.hpp"
#include "mbs_export/reduced_file.hpp"
#include "reduce/plugin/cms_impl.hpp"

namespace chladni::reduce::plugin {

namespace {

using Eigen::Map, Eigen::MatrixXd, Eigen::VectorXd;

/// Blocks of K's rows are nodes where a block fits the six components of one; else each row is.
std::vector<MasterPlace> default_places(const SetUp& set_up)
{
  PetscInt block_size = 1;
  petsc::check(MatGetBlockSize(set_up.K, &block_size));
  if (block_size > 6) block_size = 1;
  std::vector<MasterPlace> places;
  for (const PetscInt dof : set_up.masters) {
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

/// A distributed dense matrix on every rank.
MatrixXd gathered(Mat A)
{
  const SmallMatrix all = replicate(A);
  return Map<const MatrixXd>(all.values.data(), all.n_rows, all.n_cols);
}

VectorXd as_vector(const std::vector<double>& x, double factor)
{
  return factor * Map<const VectorXd>(x.data(), std::ssize(x));
}

mbs_export::ModeCount as_mode_count(const CMSCount& count)
{
  return {.up_to = 2.0 * std::numbers::pi * count.upto,
          .expected = static_cast<int>(count.expected),
          .found = static_cast<int>(count.found)};
}

mbs_export::Certificate certificate_of(const Result& result)
{
  return {.fixed = {},
          .frequencies =
              result.eta2.empty() ? VectorXd(0) : as_vector(result.f_Hz, 2.0 * std::numbers::pi),
          .eta2 = as_vector(result.eta2, 1.0),
          .estimates = as_vector(result.estimates, 1.0),
          .rounding = as_vector(result.rounding, 1.0),
          .bounds = as_vector(result.bounds, 1.0),
          .fixed_interface = as_mode_count(result.quality.modes),
          .range = as_mode_count(result.quality.model),
          .complete = as_mode_count(result.quality.complete),
          .n_rigid = static_cast<int>(result.quality.n_zero),
          .rigid_residual = result.quality.rigid_residual,
          .condition = result.quality.condition};
}

mbs_export::Provenance provenance(CMS cms, MPI_Comm comm)
{
  std::array<char, 256> petsc_version{};
  std::array<char, 256> slepc_version{};
  petsc::check(PetscGetVersion(petsc_version.data(), petsc_version.size()));
  petsc::check(SlepcGetVersion(slepc_version.data(), slepc_version.size()));
  char* options = nullptr;
  petsc::check(PetscOptionsGetAll(reinterpret_cast<PetscObject>(cms)->options, &options));
  mbs_export::Provenance result{
      .scene = "",
      .mesh_checksum = "",
      .versions = fmt::format("libchladni_petsc {}; {}; {}", CHLADNI_VERSION, petsc_version.data(),
                              slepc_version.data()),
      .options = options,
      .ranks = petsc::size(comm)};
  petsc::check(PetscFree(options));
  return result;
}

}  // namespace

void write_file(CMS cms, const std::string& path)
{
  const Inside& in = *cms->inside;
  const MPI_Comm comm = petsc::communicator(in.set_up->K);
  Mat K_r = nullptr, M_r = nullptr, C_r = nullptr;
  petsc::check(CMSGetReducedOperators(cms, &K_r, &M_r, &C_r));
  mbs_export::ReducedSystem system;
  const char* name = nullptr;
  petsc::check(PetscObjectGetName(reinterpret_cast<PetscObject>(cms), &name));
  system.title = name;
  int n_places = static_cast<int>(in.geometry.size());
  MPI_Allreduce(MPI_IN_PLACE, &n_places, 1, MPI_INT, MPI_SUM, comm);
  add_attachments(system,
                  n_places > 0 ? gathered_places(in.geometry, comm) : default_places(*in.set_up));
  system.K = gathered(K_r);
  system.M = gathered(M_r);
  if (C_r && !in.set_up->velocity.is_symmetric) {
    throw Error(
        "CMSWrite: C is not symmetric (gyroscopic forces), and the reduced file holds damping "
        "only; give damping alone, and take the rest by CMSGetReducedOperators()");
  }
  if (C_r) system.C = gathered(C_r);
  system.fixed_interface_frequencies = as_vector(in.result->model.omega, 1.0);
  system.certificate = certificate_of(*in.result);
  system.provenance = provenance(cms, comm);
  std::optional<std::string> complaint;
  if (petsc::rank(comm) == 0) {
    try {
      mbs_export::write_reduced(path, system);
    } catch (const Error& error) {
      complaint = error.what();
    }
  }
  agree_on(complaint, comm);
}

}  // namespace chladni::reduce::plugin
