#include "mbs_export/files/reduced_file.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "mbs_export/files/certificate_file.hpp"
#include "mbs_export/files/file_parts.hpp"
#include "mbs_export/files/provenance.hpp"
#include "mbs_export/files/ring_masters_file.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr std::int64_t version = 1;

/// |A_ij - A_ji| beyond 1e-8 of sqrt(A_ii A_jj), the bound of a semidefinite A, is no round-off.
void require_symmetric(const files::Reader& file, const std::string& name, const MatrixXd& A)
{
  const Eigen::VectorXd scale = A.diagonal().cwiseAbs().cwiseSqrt();
  const double floor = A.size() > 0 ? 1e-14 * A.cwiseAbs().maxCoeff() : 0.0;
  for (Index j = 0; j < A.cols(); ++j)
    for (Index i = 0; i < j; ++i)
      if (std::abs(A(i, j) - A(j, i)) > 1e-8 * scale[i] * scale[j] + floor) {
        file.fail(name, fmt::format("is not symmetric: [{}, {}] = {} but [{}, {}] = {}", i, j,
                                    A(i, j), j, i, A(j, i)));
      }
}

MatrixXd read_symmetric(const files::Reader& file, const std::string& name, Index n)
{
  MatrixXd A = file.matrix(name, {n, n});
  require_symmetric(file, name, A);
  for (Index i = 0; i < n; ++i)
    if (A(i, i) < 0.0)
      file.fail(name, fmt::format("has the negative diagonal value {} in row {}", A(i, i), i));
  return A;
}

std::vector<MasterDof> read_node_masters(const files::Reader& file, Index n_nodes)
{
  const auto nodes = file_parts::read_indices(file, "masters/node", n_nodes);
  const auto components =
      file_parts::read_indices(file, "masters/component", 6, Index(nodes.size()));
  std::vector<MasterDof> masters;
  std::set<std::pair<int, int>> seen;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!seen.insert({nodes[i], components[i]}).second) {
      file.fail("masters",
                fmt::format("has component {} of node {} twice", components[i], nodes[i]));
    }
    masters.push_back({nodes[i], components[i]});
  }
  return masters;
}

}  // namespace

void write_reduced(const std::string& path, const ReducedSystem& reduced)
{
  files::Writer file(path);
  file.attribute("/", "format", reduced_format);
  file.attribute("/", "version", version);
  file.attribute("/", "title", reduced.title);
  file_parts::write_attachment(file, reduced.attachment_nodes, reduced.sets);
  std::vector<int> nodes, components;
  for (const MasterDof& dof : reduced.masters) {
    nodes.push_back(dof.node);
    components.push_back(dof.component);
  }
  file.write("masters/node", std::span<const int>(nodes), "1");
  file.write("masters/component", std::span<const int>(components), "1");
  write_ring_masters(file, reduced);
  file.write("matrices/stiffness", reduced.K, "N/m, N, N m; 1/s^2 of fixed-interface modes");
  file.write("matrices/mass", reduced.M, "kg, kg m, kg m^2; 1 of fixed-interface modes");
  if (reduced.C.size() > 0)
    file.write("matrices/damping", reduced.C, "N s/m, N s, N m s; 1/s of fixed-interface modes");
  if (reduced.H.size() > 0) {
    file.write("matrices/structural_damping", reduced.H,
               "N/m, N, N m; 1/s^2 of fixed-interface modes");
  }
  file.write("fixed_interface_frequencies", reduced.fixed_interface_frequencies, "rad/s");
  file_parts::write_sector_harmonics(file, reduced.sector_harmonics);
  write_certificate(file, reduced.certificate);
  file_parts::write_picture(file, reduced.picture);
  file_parts::write_sector_motions(file, reduced.picture_of_sectors);
  file_parts::write_resultants(file, reduced.resultants);
  file_parts::write_mass_integrals(file, reduced.mass_integrals);
  file_parts::write_stiffening(file, reduced.stiffening);
  file_parts::write_provenance(file, reduced.provenance);
  file.commit();
}

ReducedSystem read_reduced(const std::string& path)
{
  return read_reduced(files::Reader(path));
}

ReducedSystem read_reduced(const files::Reader& file)
{
  file.expect_format(reduced_format, version);
  auto [nodes, sets] = file_parts::read_attachment(file);
  auto masters = has_ring_masters(file) ? read_ring_masters(file, Index(nodes.size()), sets)
                                        : read_node_masters(file, Index(nodes.size()));
  Eigen::VectorXd frequencies = file.vector("fixed_interface_frequencies");
  if (frequencies.size() > 0 && frequencies.minCoeff() <= 0.0)
    file.fail("fixed_interface_frequencies", "has a value that is not positive");
  const Index n = Index(masters.size()) + frequencies.size();
  if (n == 0)
    file.fail("masters", "are none, and there is no fixed-interface mode: nothing to read");
  MatrixXd C;
  if (file.contains("matrices/damping")) C = file.matrix("matrices/damping", {n, n});
  MatrixXd H;
  if (file.contains("matrices/structural_damping"))
    H = read_symmetric(file, "matrices/structural_damping", n);
  Picture picture = file.contains("picture/sectors") ? file_parts::read_surface(file)
                                                     : file_parts::read_picture(file, n);
  auto picture_of_sectors = file_parts::read_sector_motions(file, picture.positions.rows(), n);
  auto ring_motion = read_ring_motion(file, {6 * Index(nodes.size()), Index(masters.size())}, n);
  return {.title = file.text_attribute("/", "title"),
          .attachment_nodes = std::move(nodes),
          .sets = std::move(sets),
          .masters = std::move(masters),
          .ring_motion = std::move(ring_motion),
          .K = read_symmetric(file, "matrices/stiffness", n),
          .M = read_symmetric(file, "matrices/mass", n),
          .C = std::move(C),
          .H = std::move(H),
          .fixed_interface_frequencies = std::move(frequencies),
          .picture = std::move(picture),
          .picture_of_sectors = std::move(picture_of_sectors),
          .sector_harmonics = file_parts::read_sector_harmonics(file, n),
          .certificate = read_certificate(file),
          .resultants = file_parts::read_resultants(file, n),
          .mass_integrals = file_parts::read_mass_integrals(file, n),
          .stiffening = file_parts::read_stiffening(file, n),
          .provenance = file_parts::read_provenance(file)};
}

}  // namespace chladni::mbs_export
