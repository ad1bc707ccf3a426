#include "mbs_export/formats/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>

namespace chladni::mbs_export::formats {

using Eigen::Index, Eigen::MatrixXd;

namespace {

std::string symmetric_array(const MatrixXd& A, const char* what)
{
  std::string text = fmt::format(
      "%%MatrixMarket matrix array real symmetric\n% {}, SI units; rows as in the list of "
      "coordinates\n{} {}\n",
      what, A.rows(), A.cols());
  for (Index j = 0; j < A.cols(); ++j)
    for (Index i = j; i < A.rows(); ++i)
      fmt::format_to(std::back_inserter(text), "{:.17g}\n", A(i, j));
  return text;
}

/// The sets that a node is in, "hub;track".
std::string sets_of_node(const ReducedSystem& reduced, int node)
{
  std::string names;
  for (const AttachmentSet& set : reduced.sets) {
    if (std::ranges::find(set.nodes, node) == set.nodes.end()) continue;
    names += (names.empty() ? "" : ";") + set.name;
  }
  return names;
}

/// A field of CSV: quotes are doubled.
std::string quoted(const std::string& text)
{
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + "\"";
}

std::string line_of(const ReducedSystem& reduced, const MasterDof& dof)
{
  constexpr std::array of_node{"x", "y", "z", "rx", "ry", "rz"};
  constexpr std::array of_ring{"radial",       "tangential",       "axial",
                               "about radial", "about tangential", "about axial"};
  const auto c = static_cast<std::size_t>(dof.component);
  if (dof.harmonic) {
    const auto& [set, order, is_sine] = *dof.harmonic;
    return fmt::format("ring,{},,{},{},{},,,,",
                       quoted(reduced.sets[static_cast<std::size_t>(set)].name), of_ring[c], order,
                       is_sine ? "sin" : "cos");
  }
  const AttachmentNode& node = reduced.attachment_nodes[static_cast<std::size_t>(dof.node)];
  const Eigen::Vector3d& x = node.position;
  return fmt::format("node,{},{},{},,,{:.17g},{:.17g},{:.17g},",
                     quoted(sets_of_node(reduced, dof.node)), node.number, of_node[c], x[0], x[1],
                     x[2]);
}

std::string list_of_coordinates(const ReducedSystem& reduced)
{
  std::string text = "row,kind,set,node,component,harmonic,phase,x_m,y_m,z_m,frequency_Hz\n";
  int row = 0;
  for (const MasterDof& dof : reduced.masters)
    text += fmt::format("{},{}\n", ++row, line_of(reduced, dof));
  for (const double omega : reduced.fixed_interface_frequencies)
    text += fmt::format("{},mode,,,,,,,,,{:.17g}\n", ++row, omega / (2.0 * std::numbers::pi));
  return text;
}

}  // namespace

MatrixMarket matrix_market(const ReducedSystem& reduced)
{
  return {
      .K = symmetric_array(reduced.K, "stiffness"),
      .M = symmetric_array(reduced.M, "mass"),
      .C = reduced.C.size() > 0 ? symmetric_array(reduced.C, "damping") : std::string(),
      .H = reduced.H.size() > 0 ? symmetric_array(reduced.H, "structural damping") : std::string(),
      .coordinates = list_of_coordinates(reduced)};
}

}  // namespace chladni::mbs_export::formats
