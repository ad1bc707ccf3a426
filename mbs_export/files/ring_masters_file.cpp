#include "mbs_export/files/ring_masters_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "mbs_export/files/file_parts.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index;

/// A DOF of a node, cos(n phi) or sin(n phi) of a ring.
constexpr std::array kind_names{"node", "cosine", "sine"};

std::size_t kind_of(const MasterDof& dof)
{
  if (!dof.harmonic) return 0;
  return dof.harmonic->is_sine ? 2 : 1;
}

/// Index in `kind_names`.
std::vector<int> read_kinds(const files::Reader& file)
{
  std::vector<int> kinds;
  for (const std::string& name : file.texts("masters/kind")) {
    const auto found = std::ranges::find(kind_names, name);
    if (found == kind_names.end()) {
      file.fail("masters/kind",
                fmt::format("has '{}', expected {}", name, fmt::join(kind_names, ", ")));
    }
    kinds.push_back(static_cast<int>(found - kind_names.begin()));
  }
  return kinds;
}

/// -1 where the master is of the other kind, else 0 .. limit - 1.
std::vector<std::int64_t> read_places(const files::Reader& file, const std::string& name,
                                      Index limit, const std::vector<char>& is_there)
{
  std::vector<std::int64_t> places = file.integers(name, Index(is_there.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool is_good = is_there[i] != 0 ? places[i] >= 0 && places[i] < limit : places[i] == -1;
    if (!is_good) {
      file.fail(name, is_there[i] != 0
                          ? fmt::format("has the index {}, expected 0 .. {}", places[i], limit - 1)
                          : fmt::format("has {} for a master of another kind, "
                                        "expected -1",
                                        places[i]));
    }
  }
  return places;
}

}  // namespace

void write_ring_masters(files::Writer& file, const ReducedSystem& reduced)
{
  if (!reduced.ring_motion) return;
  std::vector<std::string> kinds;
  std::vector<int> rings, orders;
  for (const MasterDof& dof : reduced.masters) {
    kinds.emplace_back(kind_names[kind_of(dof)]);
    rings.push_back(dof.harmonic ? dof.harmonic->set : -1);
    orders.push_back(dof.harmonic ? dof.harmonic->order : -1);
  }
  file.write("masters/kind", kinds);
  file.write("masters/ring", std::span<const int>(rings), "1");
  file.write("masters/harmonic", std::span<const int>(orders), "1");
  file.write("masters/shapes", reduced.ring_motion->shapes, "1");
  file.write("attachment/displacements", reduced.ring_motion->displacements,
             "m, rad per unit of each coordinate");
}

bool has_ring_masters(const files::Reader& file)
{
  return file.contains("masters/kind");
}

std::vector<MasterDof> read_ring_masters(const files::Reader& file, Index n_nodes,
                                         const std::vector<AttachmentSet>& sets)
{
  const std::vector<int> kinds = read_kinds(file);
  std::vector<char> is_node, is_ring;
  for (const int kind : kinds) {
    is_node.push_back(kind == 0 ? 1 : 0);
    is_ring.push_back(kind == 0 ? 0 : 1);
  }
  const Index n = Index(kinds.size());
  const auto nodes = read_places(file, "masters/node", n_nodes, is_node);
  const auto components = file_parts::read_indices(file, "masters/component", 6, n);
  const auto rings = read_places(file, "masters/ring", Index(sets.size()), is_ring);
  const auto orders = read_places(file, "masters/harmonic", n_nodes, is_ring);
  std::vector<MasterDof> masters;
  std::set<std::tuple<int, std::int64_t, std::int64_t, std::int64_t, int>> seen;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (!seen.emplace(kinds[i], nodes[i], rings[i], orders[i], components[i]).second)
      file.fail("masters", fmt::format("number {} stands there twice", i));
    MasterDof dof{.node = static_cast<int>(nodes[i]), .component = components[i]};
    if (kinds[i] > 0) {
      dof.harmonic = {.set = static_cast<int>(rings[i]),
                      .order = static_cast<int>(orders[i]),
                      .is_sine = kinds[i] == 2};
    }
    masters.push_back(dof);
  }
  return masters;
}

std::optional<RingMotion> read_ring_motion(const files::Reader& file, files::Shape shape, Index n)
{
  if (!has_ring_masters(file)) return std::nullopt;
  RingMotion motion{.shapes = file.matrix("masters/shapes", shape),
                    .displacements = file.matrix("attachment/displacements", {shape.rows, n})};
  const Eigen::MatrixXd gram = motion.shapes.transpose() * motion.shapes;
  const double error = (gram - Eigen::MatrixXd::Identity(shape.cols, shape.cols)).norm();
  if (!(error <= 1e-8)) {
    file.fail("masters/shapes",
              fmt::format("has columns that are not orthonormal ({:.1e})", error));
  }
  return motion;
}

}  // namespace chladni::mbs_export
