#include "mbs_export/files/certificate_file.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>

#include "mbs_export/files/file_parts.hpp"

namespace chladni::mbs_export {
namespace {

using Counts = std::array<ModeCount Certificate::*, 3>;
constexpr Counts counts = {&Certificate::fixed_interface, &Certificate::range,
                           &Certificate::complete};

void write_counts(files::Writer& file, const Certificate& certificate)
{
  Eigen::Vector3d up_to;
  std::vector<int> expected, found;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const ModeCount& count = certificate.*counts[i];
    up_to[Eigen::Index(i)] = count.up_to;
    expected.push_back(count.expected);
    found.push_back(count.found);
  }
  file.write("certificate/counts/up_to", up_to, "rad/s");
  file.write("certificate/counts/expected", std::span<const int>(expected), "1");
  file.write("certificate/counts/found", std::span<const int>(found), "1");
}

void read_counts(const files::Reader& file, Certificate& certificate)
{
  const auto n = Eigen::Index(counts.size());
  const Eigen::VectorXd up_to = file.vector("certificate/counts/up_to", n);
  constexpr Eigen::Index many = std::numeric_limits<int>::max();
  const auto expected = file_parts::read_indices(file, "certificate/counts/expected", many, n);
  const auto found = file_parts::read_indices(file, "certificate/counts/found", many, n);
  for (std::size_t i = 0; i < counts.size(); ++i)
    certificate.*counts[i] = {up_to[Eigen::Index(i)], expected[i], found[i]};
}

/// Of the first modes of the certificate.
void check_length(const files::Reader& file, const std::string& name, const Eigen::VectorXd& values,
                  const Certificate& certificate)
{
  if (values.size() <= certificate.eta2.size()) return;
  file.fail(name,
            fmt::format("has {} values for {} modes", values.size(), certificate.eta2.size()));
}

}  // namespace

Eigen::VectorXd estimated_errors(const Certificate& certificate)
{
  if (certificate.estimates.size() > 0) return certificate.estimates;
  return 0.5 * certificate.eta2;
}

void write_certificate(files::Writer& file, const Certificate& certificate)
{
  if (certificate.eta2.size() == 0) return;
  file.write("certificate/fixed", certificate.fixed);
  file.write("certificate/frequencies", certificate.frequencies, "rad/s");
  file.write("certificate/eta2", certificate.eta2, "1");
  if (certificate.rounding.size() > 0) {
    file.write("certificate/estimates", certificate.estimates, "1");
    file.write("certificate/rounding", certificate.rounding, "1");
  }
  if (certificate.mesh_errors.size() > 0) {
    file.write("certificate/mesh_errors", certificate.mesh_errors, "1");
    file.write("certificate/mesh_shape_errors", certificate.mesh_shape_errors, "1");
  }
  if (const OwnCompliances& own = certificate.mesh_compliances; !own.sets.empty()) {
    file.write("certificate/mesh_compliances/sets", own.sets);
    file.write("certificate/mesh_compliances/growth", own.growth, "m/N or rad/(N m)");
  }
  file.write("certificate/rigid_modes", std::int64_t{certificate.n_rigid}, "1");
  file.write("certificate/rigid_residual", certificate.rigid_residual, "1");
  if (certificate.condition > 0.0)
    file.write("certificate/condition_K_ss", certificate.condition, "1");
  if (certificate.responses) {
    file.write("certificate/responses/up_to", certificate.responses->up_to, "rad/s");
    file.write("certificate/responses/error", certificate.responses->error, "1");
    file.write("certificate/responses/loads", certificate.responses->loads);
  }
  if (certificate.range.up_to == 0.0) return;
  file.write("certificate/bounds", certificate.bounds, "1");
  write_counts(file, certificate);
}

Certificate read_certificate(const files::Reader& file)
{
  if (!file.contains("certificate")) return {};
  Certificate certificate;
  certificate.fixed = file.texts("certificate/fixed");
  certificate.frequencies = file.vector("certificate/frequencies");
  certificate.eta2 = file.vector("certificate/eta2", certificate.frequencies.size());
  if (file.contains("certificate/rounding")) {
    certificate.estimates = file.vector("certificate/estimates", certificate.eta2.size());
    certificate.rounding = file.vector("certificate/rounding", certificate.eta2.size());
  }
  if (file.contains("certificate/mesh_errors")) {
    certificate.mesh_errors = file.vector("certificate/mesh_errors");
    check_length(file, "certificate/mesh_errors", certificate.mesh_errors, certificate);
    certificate.mesh_shape_errors =
        file.matrix("certificate/mesh_shape_errors", {6, certificate.mesh_errors.size()});
  }
  if (file.contains("certificate/mesh_compliances")) {
    OwnCompliances& own = certificate.mesh_compliances;
    own.sets = file.texts("certificate/mesh_compliances/sets");
    own.growth = file.matrix("certificate/mesh_compliances/growth", {3, std::ssize(own.sets)});
  }
  if (file.contains("certificate/rigid_modes")) {
    certificate.n_rigid = file_parts::read_count(file, "certificate/rigid_modes");
    certificate.rigid_residual = file.real("certificate/rigid_residual");
  }
  if (file.contains("certificate/condition_K_ss"))
    certificate.condition = file.real("certificate/condition_K_ss");
  if (file.contains("certificate/responses")) {
    certificate.responses = {.up_to = file.real("certificate/responses/up_to"),
                             .error = file.real("certificate/responses/error"),
                             .loads = file.texts("certificate/responses/loads")};
  }
  if (!file.contains("certificate/counts")) return certificate;
  certificate.bounds = file.vector("certificate/bounds");
  check_length(file, "certificate/bounds", certificate.bounds, certificate);
  read_counts(file, certificate);
  return certificate;
}

}  // namespace chladni::mbs_export
