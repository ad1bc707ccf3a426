#include "mbs_export/files/body_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace chladni::mbs_export::file_parts {

using Eigen::Index, Eigen::MatrixXd;

namespace {

const std::string integrals_group = "mass_integrals/";

std::string product_name(std::size_t i)
{
  const std::string axes = "xyz";
  const auto [k, l] = product_axes[i];
  return integrals_group + "displacement_" + axes[static_cast<std::size_t>(k)] +
         axes[static_cast<std::size_t>(l)];
}

}  // namespace

void write_mass_integrals(files::Writer& file, const std::optional<MassIntegrals>& integrals)
{
  if (!integrals) return;
  file.write(integrals_group + "mass", integrals->mass, "kg");
  file.write(integrals_group + "first_moment", integrals->first, "kg m");
  file.write(integrals_group + "second_moment", integrals->second, "kg m^2");
  file.write(integrals_group + "displacement", integrals->displacement,
             "kg m per unit of each coordinate");
  file.write(integrals_group + "position_displacement", integrals->position_displacement,
             "kg m^2 per unit of each coordinate");
  for (std::size_t i = 0; i < product_axes.size(); ++i)
    file.write(product_name(i), integrals->products[i], "kg m^2 per units of the two coordinates");
}

std::optional<MassIntegrals> read_mass_integrals(const files::Reader& file, Index n)
{
  if (!file.contains("mass_integrals")) return std::nullopt;
  MassIntegrals integrals{
      .mass = file.real(integrals_group + "mass"),
      .first = file.vector(integrals_group + "first_moment", 3),
      .second = file.matrix(integrals_group + "second_moment", {3, 3}),
      .displacement = file.matrix(integrals_group + "displacement", {3, n}),
      .position_displacement = file.matrix(integrals_group + "position_displacement", {9, n}),
      .products = {}};
  for (std::size_t i = 0; i < product_axes.size(); ++i)
    integrals.products[i] = file.matrix(product_name(i), {n, n});
  return integrals;
}

namespace {

const std::string stiffening_group = "stiffening/";

/// Known names, none twice, in their order: what writers write.
void check_loads(const files::Reader& file, const std::vector<std::string>& loads)
{
  auto next = stiffening_loads.begin();
  for (const std::string& load : loads) {
    next = std::find(next, stiffening_loads.end(), load);
    if (next == stiffening_loads.end()) {
      file.fail(stiffening_group + "loads",
                "has an unknown load, or one out of order: \"" + load + "\"");
    }
    ++next;
  }
}

}  // namespace

void write_stiffening(files::Writer& file, const std::optional<Stiffening>& stiffening)
{
  if (!stiffening) return;
  file.write(stiffening_group + "fixed", stiffening->fixed);
  file.write(stiffening_group + "loads", stiffening->loads);
  for (std::size_t i = 0; i < stiffening->loads.size(); ++i) {
    const bool is_acceleration = stiffening->loads[i].starts_with("acceleration");
    file.write(stiffening_group + stiffening->loads[i], stiffening->K[i],
               is_acceleration ? "kg m per units of the two coordinates"
                               : "kg m^2 per units of the two coordinates");
  }
}

std::optional<Stiffening> read_stiffening(const files::Reader& file, Eigen::Index n)
{
  if (!file.contains("stiffening")) return std::nullopt;
  Stiffening stiffening{.fixed = file.texts(stiffening_group + "fixed"),
                        .loads = file.texts(stiffening_group + "loads"),
                        .K = {}};
  check_loads(file, stiffening.loads);
  for (const std::string& load : stiffening.loads)
    stiffening.K.push_back(file.matrix(stiffening_group + load, {n, n}));
  return stiffening;
}

namespace {

void write_one(files::Writer& file, const ResultantModes& resultants)
{
  const std::string group = "resultants/" + link_name(resultants.name) + "/";
  file.write(group + "kinds", resultants.kinds);
  file.write(group + "units", resultants.units);
  file.write(group + "elements", std::span<const std::int64_t>(resultants.elements), "1");
  file.write(group + "positions", MatrixXd(resultants.positions), "m");
  file.write(group + "axes", MatrixXd(resultants.axes), "1");
  file.write(group + "modes", resultants.S, "units of the kinds per unit of each coordinate");
}

/// Frames of unit vectors at right angles, to the digits of a writer of single precision.
void require_orthonormal(const files::Reader& file, const std::string& name,
                         const ResultantModes::Rows& axes)
{
  for (Index i = 0; i < axes.rows(); ++i) {
    const Eigen::Matrix3d e = Eigen::Map<const Eigen::Matrix3d>(axes.row(i).data());
    if ((e.transpose() * e - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-6)
      file.fail(name, fmt::format("is not orthonormal in row {}", i));
  }
}

ResultantModes read_one(const files::Reader& file, const std::string& name, Index n_columns)
{
  const std::string group = "resultants/" + name + "/";
  ResultantModes resultants{.name = name,
                            .kinds = file.texts(group + "kinds"),
                            .units = file.texts(group + "units"),
                            .elements = {},
                            .positions = {},
                            .axes = {},
                            .S = {}};
  const Index n_kinds = Index(resultants.kinds.size());
  if (n_kinds == 0) file.fail(group + "kinds", "names no kind");
  if (Index(resultants.units.size()) != n_kinds) {
    file.fail(group + "units",
              fmt::format("has {} values for {} kinds", resultants.units.size(), n_kinds));
  }
  resultants.positions = file.matrix(group + "positions", {files::any, 3});
  const Index n_points = resultants.positions.rows();
  resultants.elements = file.integers(group + "elements", n_points);
  resultants.axes = file.matrix(group + "axes", {n_points, 9});
  require_orthonormal(file, group + "axes", resultants.axes);
  resultants.S = file.matrix(group + "modes", {n_points * n_kinds, n_columns});
  return resultants;
}

}  // namespace

void write_resultants(files::Writer& file, const std::vector<ResultantModes>& resultants)
{
  if (resultants.empty()) return;
  std::vector<std::string> names;
  for (const ResultantModes& one : resultants) names.push_back(one.name);
  file.write("resultant_names", names);
  for (const ResultantModes& one : resultants) write_one(file, one);
}

std::vector<ResultantModes> read_resultants(const files::Reader& file, Index n_columns)
{
  std::vector<ResultantModes> resultants;
  if (!file.contains("resultant_names")) return resultants;
  std::set<std::string> names;
  for (const std::string& name : file.texts("resultant_names")) {
    if (!names.insert(name).second) file.fail("resultant_names", "names '" + name + "' twice");
    resultants.push_back(read_one(file, name, n_columns));
  }
  return resultants;
}

}  // namespace chladni::mbs_export::file_parts

namespace chladni::mbs_export {

using Eigen::Index;

namespace {

/// A DOF of a node, cos(n phi) or sin(n phi) of a ring.
constexpr std::array master_kind_names{"node", "cosine", "sine"};

std::size_t kind_of_master(const MasterDof& dof)
{
  if (!dof.harmonic) return 0;
  return dof.harmonic->is_sine ? 2 : 1;
}

/// Index in `master_kind_names`.
std::vector<int> read_master_kinds(const files::Reader& file)
{
  std::vector<int> kinds;
  for (const std::string& name : file.texts("masters/kind")) {
    const auto found = std::ranges::find(master_kind_names, name);
    if (found == master_kind_names.end()) {
      file.fail("masters/kind",
                fmt::format("has '{}', expected {}", name, fmt::join(master_kind_names, ", ")));
    }
    kinds.push_back(static_cast<int>(found - master_kind_names.begin()));
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
    kinds.emplace_back(master_kind_names[kind_of_master(dof)]);
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
  const std::vector<int> kinds = read_master_kinds(file);
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

namespace chladni::mbs_export::file_parts {

using Eigen::Index, Eigen::MatrixXd;

namespace {

const std::string unit = "m per unit of each coordinate";

Index n_columns_of(const SectorMotions& motions)
{
  Index n = 0;
  for (const SectorMotions::Harmonic& h : motions.harmonics) n += h.x.cols();
  return n;
}

std::vector<int> read_orders(const files::Reader& file, int n_sectors)
{
  const std::string name = "picture/sectors/harmonics";
  std::vector<int> orders;
  for (const std::int64_t order : file.integers(name)) {
    const int last = orders.empty() ? 0 : orders.back();
    if (order < last || order > n_sectors / 2)
      file.fail(name, fmt::format("has {}, expected {} .. {} there", order, last, n_sectors / 2));
    orders.push_back(static_cast<int>(order));
  }
  return orders;
}

}  // namespace

void write_sector_motions(files::Writer& file, const std::optional<SectorMotions>& motions)
{
  if (!motions) return;
  const Index n = n_columns_of(*motions);
  MatrixXd x(motions->rows_of_sector(), n), y(motions->rows_of_sector(), n);
  std::vector<int> orders;
  std::vector<std::int64_t> coordinates;
  for (const SectorMotions::Harmonic& h : motions->harmonics) {
    x.middleCols(Index(orders.size()), h.x.cols()) = h.x;
    y.middleCols(Index(orders.size()), h.y.cols()) = h.y;
    orders.insert(orders.end(), h.columns.size(), h.order);
    coordinates.insert(coordinates.end(), h.columns.begin(), h.columns.end());
  }
  file.write("picture/sectors/count", std::int64_t{motions->n_sectors}, "1");
  file.write("picture/sectors/harmonics", std::span<const int>(orders), "1");
  file.write("picture/sectors/coordinates", std::span<const std::int64_t>(coordinates), "1");
  file.write("picture/sectors/x", x, unit);
  file.write("picture/sectors/y", y, unit);
  if (motions->T.size() > 0) file.write("picture/sectors/transformation", motions->T, "1");
}

std::optional<SectorMotions> read_sector_motions(const files::Reader& file, Index n_points,
                                                 Index n_columns)
{
  if (!file.contains("picture/sectors")) return std::nullopt;
  SectorMotions motions{.n_sectors = read_count(file, "picture/sectors/count"),
                        .n_coordinates = n_columns,
                        .harmonics = {}};
  if (motions.n_sectors < 3 || n_points % motions.n_sectors != 0) {
    file.fail("picture/sectors/count",
              fmt::format("is {}, of a picture of {} nodes", motions.n_sectors, n_points));
  }
  const std::vector<int> orders = read_orders(file, motions.n_sectors);
  if (orders.empty()) file.fail("picture/sectors/harmonics", "is empty");
  const Index n = Index(orders.size()), n_rows = 3 * n_points / motions.n_sectors;
  const std::vector<int> coordinates =
      read_indices(file, "picture/sectors/coordinates", n_columns, n);
  const MatrixXd x = file.matrix("picture/sectors/x", {n_rows, n}),
                 y = file.matrix("picture/sectors/y", {n_rows, n});
  for (Index first = 0, last = 0; first < n; first = last) {
    const int order = orders[std::size_t(first)];
    while (last < n && orders[std::size_t(last)] == order) ++last;
    motions.harmonics.push_back(
        {.order = order,
         .x = x.middleCols(first, last - first),
         .y = y.middleCols(first, last - first),
         .columns = {coordinates.begin() + first, coordinates.begin() + last}});
  }
  if (file.contains("picture/sectors/transformation"))
    motions.T = file.matrix("picture/sectors/transformation", {n_columns, n_columns});
  return motions;
}

}  // namespace chladni::mbs_export::file_parts

namespace chladni::mbs_export {

using Eigen::Index;

// The layout is that of https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.

namespace {

/// Cells as VTK lists them, without repeated corners.
struct Cells {
  std::vector<std::int64_t> connectivity;
  std::vector<std::int64_t> offsets = {0};
  std::vector<std::uint8_t> types;
};

Cells vtk_cells(const Picture& picture)
{
  constexpr std::array<std::uint8_t, 5> types{0, 1, 3, 5, 9};  // vertex, line, triangle, quadrangle
  Cells cells;
  for (const std::array<int, 4>& corners : picture.cells) {
    for (std::size_t k = 0; k < corners.size(); ++k)
      if (k == 0 || corners[k] != corners[k - 1]) cells.connectivity.push_back(corners[k]);
    const auto end = static_cast<std::int64_t>(cells.connectivity.size());
    cells.types.push_back(types[static_cast<std::size_t>(end - cells.offsets.back())]);
    cells.offsets.push_back(end);
  }
  return cells;
}

std::string mode_name(const ModalBody& body, Index j)
{
  return fmt::format("mode {:02d}, {:.6g} Hz", j + 1, body.omega[j] / (2.0 * std::numbers::pi));
}

}  // namespace

void write_vtkhdf(files::Writer& file, const ModalBody& body)
{
  const Index n = body.picture.positions.rows();
  if (n == 0) return;
  const auto count = [&](const std::string& name, std::size_t x) {
    const std::array values{static_cast<std::int64_t>(x)};
    file.write("VTKHDF/NumberOf" + name, std::span<const std::int64_t>(values), "1");
  };
  const Cells cells = vtk_cells(body.picture);
  file.group("VTKHDF/PointData");
  file.attribute("VTKHDF", "Version", std::array<std::int64_t, 2>{1, 0});
  file.attribute("VTKHDF", "Type", "UnstructuredGrid");
  count("Points", static_cast<std::size_t>(n));
  count("Cells", cells.types.size());
  count("ConnectivityIds", cells.connectivity.size());
  file.write("VTKHDF/Connectivity", std::span<const std::int64_t>(cells.connectivity), "1");
  file.write("VTKHDF/Offsets", std::span<const std::int64_t>(cells.offsets), "1");
  file.write("VTKHDF/Types", std::span<const std::uint8_t>(cells.types), "1");
  file.link("VTKHDF/Points", "/picture/positions");
  for (Index j = 0; j < body.n_modes(); ++j) {
    file.view_column("VTKHDF/PointData/" + mode_name(body, j),
                     {"/picture/displacements", 3 * n, body.n_modes(), j});
  }
}

}  // namespace chladni::mbs_export
