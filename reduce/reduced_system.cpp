#include "reduce/reduced_system.hpp"

#include <slepcsys.h>

#include <array>
#include <cmath>

namespace chladni::reduce {
namespace {

using Eigen::Map, Eigen::MatrixXd, Eigen::VectorXd;

VectorXd as_vector(const std::vector<double>& values)
{
  return Map<const VectorXd>(values.data(), std::ssize(values));
}

mbs_export::ModeCount as_mode_count(const reduce::EigenvalueCount& count)
{
  return {.up_to = std::sqrt(count.sigma), .expected = count.expected, .found = count.found};
}

}  // namespace

mbs_export::ReducedSystem with_model(mbs_export::ReducedSystem described,
                                     const reduce::ReducedModel& model,
                                     const std::vector<int>& places)
{
  described.K = model.K(places, places);
  described.M = model.M(places, places);
  described.fixed_interface_frequencies = as_vector(model.omega);
  if (described.ring_motion) {  // what modes add to it follows with the rows of the basis
    const MatrixXd& F = described.ring_motion->shapes;
    described.ring_motion->displacements = MatrixXd::Zero(F.rows(), std::ssize(places));
    described.ring_motion->displacements.leftCols(F.cols()) = F;
  }
  return described;
}

namespace {

std::optional<mbs_export::ResponseCheck> as_check(const reduce::ResponseCertificate& responses)
{
  if (responses.Omega == 0.0) return std::nullopt;
  return mbs_export::ResponseCheck{.up_to = responses.Omega, .error = responses.error, .loads = {}};
}

}  // namespace

mbs_export::Certificate certificate_of(const reduce::Certificate& certificate,
                                       std::vector<std::string> fixed)
{
  const bool has_errors = !certificate.eta2.empty();
  return {
      .fixed = std::move(fixed),
      .frequencies = has_errors ? VectorXd(as_vector(certificate.lambda).cwiseSqrt()) : VectorXd(0),
      .eta2 = as_vector(certificate.eta2),
      .estimates = as_vector(certificate.estimates),
      .rounding = as_vector(certificate.rounding),
      .bounds = as_vector(certificate.bounds),
      .fixed_interface = as_mode_count(certificate.fixed_interface),
      .range = as_mode_count(certificate.range),
      .complete = as_mode_count(certificate.complete),
      .n_rigid = certificate.n_zero,
      .rigid_residual = certificate.zero_energy,
      .condition = certificate.condition,
      .count_share = certificate.count_share,
      .responses = as_check(certificate.responses)};
}

mbs_export::ReducedSystem reduced_system(mbs_export::ReducedSystem described,
                                         const reduce::FactoredBody& body,
                                         const reduce::Reduction& reduction,
                                         std::vector<std::string> fixed)
{
  mbs_export::ReducedSystem system =
      with_model(std::move(described), reduction.model,
                 reduce::coordinate_places(body.masters, reduction.model));
  system.certificate = certificate_of(reduction.certificate, std::move(fixed));
  return system;
}

std::string library_versions()
{
  std::array<char, 256> petsc_version{}, slepc_version{};
  petsc::check(PetscGetVersion(petsc_version.data(), petsc_version.size()));
  petsc::check(SlepcGetVersion(slepc_version.data(), slepc_version.size()));
  return fmt::format("{}; {}", petsc_version.data(), slepc_version.data());
}

}  // namespace chladni::reduce
