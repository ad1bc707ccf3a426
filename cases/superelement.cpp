#include "cases/superelement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "common/files/input_file.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/formats/formats.hpp"
#include "mesh/decks/nastran.hpp"
#include "mesh/decks/nastran_cards.hpp"
#include "report/version.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

namespace fs = std::filesystem;
using mesh::Card;

/// A component 1 to 6 of a grid, or a scalar point with 0.
using Dof = std::pair<std::int64_t, int>;

enum class Role { stiffness, mass, damping, structural };

/// What matrices are called, by decks for K2GG and the like, and by Nastran itself.
struct KnownMatrix {
  const char* name;
  Role role;
};

constexpr KnownMatrix known_matrices[] = {
    {"KAA", Role::stiffness},   {"KAAX", Role::stiffness},   {"KRED", Role::stiffness},
    {"KXX", Role::stiffness},   {"KGG", Role::stiffness},    {"K2GG", Role::stiffness},
    {"MAA", Role::mass},        {"MAAX", Role::mass},        {"MRED", Role::mass},
    {"MXX", Role::mass},        {"MGG", Role::mass},         {"M2GG", Role::mass},
    {"BAA", Role::damping},     {"BAAX", Role::damping},     {"BRED", Role::damping},
    {"BXX", Role::damping},     {"BGG", Role::damping},      {"B2GG", Role::damping},
    {"K4AA", Role::structural}, {"K4AAX", Role::structural}, {"K4XX", Role::structural},
    {"K4GG", Role::structural}};

std::optional<Role> role_of(const std::string& name)
{
  for (const auto& [known, role] : known_matrices)
    if (name == known) return role;
  return std::nullopt;
}

std::vector<std::string> known_names()
{
  std::vector<std::string> names;
  for (const auto& [name, role] : known_matrices) names.emplace_back(name);
  return names;
}

std::string text_of_superelement(const fs::path& file)
{
  files::regular_file_size(file.string());
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// BEGIN SUPER is no card; what stands before it is none either. Lines keep their numbers.
std::vector<Card> cards_of(std::string text)
{
  std::size_t end = 0;
  mesh::for_each_line(text, 0, [&](std::string_view line, int) {
    const std::string words = mesh::capitals(mesh::trimmed(line));
    if (words.starts_with("BEGIN") && words.find("SUPER") != std::string::npos)
      end = std::size_t(line.data() - text.data()) + line.size();
    return end == 0;
  });
  std::replace_if(
      text.begin(), text.begin() + std::ptrdiff_t(end), [](char c) { return c != '\n'; }, ' ');
  return mesh::nastran_cards(text);
}

/// The names of sets in the comments "$ SET 3: track" of our own files.
std::map<std::int64_t, std::string> names_of_sets(const std::string& text)
{
  std::map<std::int64_t, std::string> names;
  constexpr std::string_view begin = "$ SET ";
  mesh::for_each_line(text, 0, [&](std::string_view line, int) {
    const std::size_t colon = line.find(": ");
    if (!line.starts_with(begin) || colon == std::string_view::npos) return true;
    const std::string number(line.substr(begin.size(), colon - begin.size()));
    if (!number.empty() && number.find_first_not_of("0123456789") == std::string::npos &&
        number.size() < 9)
      names[std::stol(number)] = mesh::trimmed(line.substr(colon + 2));
    return true;
  });
  return names;
}

/// A matrix of the bulk data by columns.
struct DmigMatrix {
  const Card* header;
  std::map<std::pair<Dof, Dof>, double> entries;  ///< by column and row
};

/// What the files say, with their numbers and units.
struct Superelement {
  std::map<std::int64_t, std::array<double, 3>> grids;
  std::set<std::int64_t> turned_grids;  ///< with axes CD of their own
  std::set<std::int64_t> scalar_points;
  std::set<Dof> modal;   ///< of QSET
  std::set<Dof> listed;  ///< of EXTRN, ASET and QSET
  std::vector<std::pair<std::string, std::vector<std::int64_t>>> sets;
  std::map<std::string, DmigMatrix> matrices;
  std::map<std::string, int> left_out;
};

class SuperelementReader {
 public:
  explicit SuperelementReader(const std::string& text)
      : cards_(cards_of(text)), names_(names_of_sets(text)), systems_(mesh::nastran_systems(cards_))
  {}

  Superelement read()
  {
    for (const Card& card : cards_) {
      const std::string& name = card.name();
      if (name == "GRID")
        grid(card);
      else if (name == "SPOINT")
        points(card);
      else if (name == "SET1")
        set(card);
      else if (name == "DMIG")
        matrix(card);
      else if (name == "EXTRN" || name == "ASET" || name == "QSET")
        pairs(card);
      else if (name == "ASET1" || name == "QSET1")
        listed(card);
      else
        ++found_.left_out[name];
    }
    return std::move(found_);
  }

 private:
  void grid(const Card& card)
  {
    const std::int64_t number = card.integer(1, "number of a grid");
    const auto system = systems_.find(card.integer_or(2, "CP", 0));
    if (system == systems_.end())
      card.refuse(fmt::format("there is no coordinate system {}", card.field(2)));
    const auto x = mesh::basic_position(system->second, card.vector_or_zero(3, "a coordinate"));
    found_.grids[number] = x;  // the files of a superelement may have it twice
    if (card.integer_or(6, "CD", 0) != 0) found_.turned_grids.insert(number);
  }

  /// The numbers that a card lists from a field on.
  static std::vector<std::int64_t> numbers_in(const Card& card, std::size_t first)
  {
    constexpr std::int64_t most = 1'000'000;
    std::vector<std::int64_t> numbers;
    for (const mesh::NumberRange& range : card.ranges(first, "number of a grid or scalar point")) {
      if (range.to - range.from > most) card.refuse("lists more than a million numbers");
      for (std::int64_t i = range.from; i <= range.to; i += range.step) numbers.push_back(i);
    }
    return numbers;
  }

  void points(const Card& card)
  {
    for (const std::int64_t number : numbers_in(card, 1)) found_.scalar_points.insert(number);
  }

  void set(const Card& card)
  {
    const std::int64_t number = card.integer(1, "SID");
    const auto named = names_.find(number);
    auto& [name, grids] = found_.sets.emplace_back();
    name = named == names_.end() ? fmt::format("set_{}", number) : named->second;
    grids = numbers_in(card, 2);
  }

  /// Components "123" of a grid, or a scalar point.
  void add(const Card& card, std::int64_t id, std::size_t field)
  {
    std::vector<int> components{0};
    if (card.has(field) && card.field(field) != "0") {
      components = card.components(field);
      for (int& c : components) ++c;
    }
    for (const int c : components) {
      found_.listed.emplace(id, c);
      if (is_modal(card)) found_.modal.emplace(id, c);
    }
  }

  void pairs(const Card& card)
  {
    for (std::size_t i = 1; i <= card.n_fields(); i += 2)
      if (card.has(i)) add(card, card.integer(i, "number of a grid"), i + 1);
  }

  void listed(const Card& card)
  {
    for (const std::int64_t id : numbers_in(card, 2))
      if (found_.grids.contains(id) || found_.scalar_points.contains(id) || is_modal(card))
        add(card, id, 1);
  }

  static bool is_modal(const Card& card) { return card.name().starts_with('Q'); }

  void matrix(const Card& card)
  {
    const std::string name(card.field(1));
    if (card.field(2) == "0") {
      if (!role_of(name)) {
        ++found_.left_out["DMIG " + name];
        return;
      }
      const std::int64_t form = card.integer(3, "form"), type = card.integer(4, "type");
      if (form != 1 && form != 6) card.refuse("is not square (form 1 or 6)");
      if (type > 2) card.refuse("is complex; real stiffness, mass and damping can be read");
      if (!found_.matrices.emplace(name, DmigMatrix{.header = &card, .entries = {}}).second)
        card.refuse("begins twice");
      return;
    }
    if (!role_of(name)) return;
    const auto found = found_.matrices.find(name);
    if (found == found_.matrices.end()) card.refuse("has no header, DMIG with 0 in field 3");
    const Dof column{card.integer(2, "number of a grid"), component(card, 3)};
    for (std::size_t i = 5; i <= card.n_fields(); i += 4) {
      if (!card.has(i)) continue;
      const Dof row{card.integer(i, "number of a grid"), component(card, i + 1)};
      if (!found->second.entries.emplace(std::pair(column, row), card.real(i + 2, "an entry"))
               .second)
        card.refuse(fmt::format("row {}, component {} is there twice", row.first, row.second));
    }
  }

  static int component(const Card& card, std::size_t i)
  {
    const std::int64_t c = card.integer_or(i, "component", 0);
    if (c > 6) card.refuse(fmt::format("component {} is none of 0 to 6", c));
    return static_cast<int>(c);
  }

  std::vector<Card> cards_;
  std::map<std::int64_t, std::string> names_;
  mesh::DeckSystems systems_;
  Superelement found_;
};

/// The matrices by role, with rows in the order of `dofs`.
struct Matrices {
  std::vector<Dof> dofs;
  std::map<Role, MatrixXd> of;
  std::map<Role, std::string> names;
};

[[noreturn]] void refuse_without(const Matrices& matrices, const fs::path& file)
{
  throw Error(fmt::format("{} has no {}; its matrices must have one of the names {}", file.string(),
                          matrices.of.contains(Role::stiffness) ? "mass" : "stiffness",
                          fmt::join(known_names(), ", ")));
}

void claim_role(Matrices& matrices, Role role, const std::string& name, const fs::path& file)
{
  const auto [before, is_new] = matrices.names.emplace(role, name);
  if (is_new) return;
  throw Error(fmt::format("{} has {} and {} of one kind; take one of them out", file.string(),
                          before->second, name));
}

std::string dof_name(const Dof& dof)
{
  return dof.second == 0 ? fmt::format("scalar point {}", dof.first)
                         : fmt::format("grid {}, component {}", dof.first, dof.second);
}

/// @throws chladni::Error naming row and column where the triangles differ, or the row whose
/// diagonal
///         is none of a free body.
void check_entries(const MatrixXd& A, const std::vector<Dof>& dofs, const std::string& name)
{
  constexpr double digits = 1e-8;  // of sqrt(A_ii A_jj): a field of ten digits
  constexpr double penalty = 1e30;
  for (Index i = 0; i < A.rows(); ++i) {
    if (A(i, i) < 0.0 || A(i, i) >= penalty) {
      throw Error(fmt::format(
          "{}: {:.3g} on the diagonal at {}: {}", name, A(i, i), dof_name(dofs[std::size_t(i)]),
          A(i, i) < 0.0 ? "no body has a negative one" : "take supports out of the model"));
    }
    for (Index j = 0; j < i; ++j) {
      if (std::abs(A(i, j) - A(j, i)) <= digits * std::sqrt(std::abs(A(i, i) * A(j, j)))) continue;
      throw Error(fmt::format(
          "{}: {} at row {}, column {}, but {} on the other side of the diagonal", name, A(i, j),
          dof_name(dofs[std::size_t(i)]), dof_name(dofs[std::size_t(j)]), A(j, i)));
    }
  }
}

/// Both triangles, of which a file may hold one or two equal ones.
MatrixXd both_triangles(const std::map<std::pair<Dof, Dof>, double>& entries,
                        const std::map<Dof, Index>& place, const std::string& name)
{
  const auto n = static_cast<Index>(place.size());
  MatrixXd A = MatrixXd::Zero(n, n);
  for (const auto& [at, value] : entries) {
    const auto column = place.find(at.first), row = place.find(at.second);
    if (column == place.end() || row == place.end()) {
      throw Error(fmt::format("{}: {} has no stiffness", name,
                              dof_name(column == place.end() ? at.first : at.second)));
    }
    A(row->second, column->second) = value;
  }
  for (const auto& [at, value] : entries) {
    const Index i = place.at(at.second), j = place.at(at.first);
    const auto other = entries.find({at.second, at.first});
    if (other == entries.end()) A(j, i) = value;
  }
  return A;
}

Matrices matrices_of_bulk_data(const Superelement& element, const fs::path& file)
{
  Matrices matrices;
  std::map<Dof, Index> place;
  for (const auto& [name, matrix] : element.matrices) {
    claim_role(matrices, *role_of(name), name, file);
    if (*role_of(name) != Role::stiffness) continue;
    for (const auto& [at, value] : matrix.entries) {
      place.emplace(at.first, 0);
      place.emplace(at.second, 0);
    }
  }
  for (auto& [dof, index] : place) {
    index = std::ssize(matrices.dofs);
    matrices.dofs.push_back(dof);
  }
  for (const auto& [name, matrix] : element.matrices) {
    const std::string said = fmt::format("{}: DMIG {}", file.string(), name);
    MatrixXd A = both_triangles(matrix.entries, place, said);
    check_entries(A, matrices.dofs, said);
    matrices.of[*role_of(name)] = std::move(A);
  }
  return matrices;
}

Matrices matrices_of_op4(const Superelement& element, const fs::path& file)
{
  Matrices matrices;
  const std::vector<std::string> known = known_names();
  const std::set<std::string> wanted(known.begin(), known.end());
  std::vector<mbs_export::formats::Op4Matrix> found;
  try {
    found = mbs_export::formats::read_op4(text_of_superelement(file), wanted);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file.string(), error.what()));
  }
  matrices.dofs.assign(element.listed.begin(), element.listed.end());
  for (mbs_export::formats::Op4Matrix& matrix : found) {
    const Role role = *role_of(matrix.name);
    if (matrix.A.rows() <= 1 && role != Role::stiffness && role != Role::mass) continue;  // absent
    claim_role(matrices, role, matrix.name, file);
    if (matrix.A.rows() != std::ssize(matrices.dofs) || matrix.A.rows() != matrix.A.cols()) {
      throw Error(fmt::format(
          "{}: {} is {} x {}, but the .pch beside it lists {} components of grids and scalar "
          "points (EXTRN, ASET, QSET)",
          file.string(), matrix.name, matrix.A.rows(), matrix.A.cols(), matrices.dofs.size()));
    }
    check_entries(matrix.A, matrices.dofs, fmt::format("{}: {}", file.string(), matrix.name));
    matrices.of[role] = std::move(matrix.A);
  }
  return matrices;
}

/// The factor of a coordinate in SI: lengths, radians, and amplitudes whose energy is in J.
double unit_of_coordinate(const Dof& dof, bool is_modal, const mesh::DeckUnits& units)
{
  if (is_modal) return std::sqrt(units.force * units.length);
  return dof.second <= 3 ? units.length : 1.0;
}

/// Rows in the order of a reduced system: masters, then modes.
struct Order {
  std::vector<Index> rows;
  Index n_masters = 0;
  VectorXd scale;  ///< of each coordinate, in that order
};

Order masters_first(const Superelement& element, const Matrices& matrices,
                    const mesh::DeckUnits& units)
{
  const auto is_modal = [&](const Dof& dof) {
    return dof.second == 0 || element.modal.contains(dof);
  };
  Order order;
  for (const bool modal : {false, true}) {
    for (Index i = 0; i < std::ssize(matrices.dofs); ++i)
      if (is_modal(matrices.dofs[std::size_t(i)]) == modal) order.rows.push_back(i);
    if (!modal) order.n_masters = std::ssize(order.rows);
  }
  order.scale.resize(std::ssize(order.rows));
  for (Index k = 0; k < order.scale.size(); ++k) {
    order.scale[k] = unit_of_coordinate(matrices.dofs[std::size_t(order.rows[std::size_t(k)])],
                                        k >= order.n_masters, units);
  }
  return order;
}

/// Attachment nodes, sets and masters.
void describe_grids(const Superelement& element, const Matrices& matrices, const Order& order,
                    const mesh::DeckUnits& units, mbs_export::ReducedSystem& system)
{
  std::map<std::int64_t, int> place;
  for (Index k = 0; k < order.n_masters; ++k) {
    const Dof& dof = matrices.dofs[std::size_t(order.rows[std::size_t(k)])];
    const auto grid = element.grids.find(dof.first);
    if (grid == element.grids.end()) {
      throw Error(
          fmt::format("{} has a stiffness, but there is no GRID {}", dof_name(dof), dof.first));
    }
    if (element.turned_grids.contains(dof.first)) {
      throw Error(fmt::format(
          "GRID {} has the axes CD of its own; reduce with components in the basic system",
          dof.first));
    }
    const auto [found, is_new] = place.emplace(dof.first, std::ssize(system.attachment_nodes));
    if (is_new) {
      const Eigen::Vector3d x(grid->second.data());
      system.attachment_nodes.push_back({.number = dof.first, .position = units.length * x});
    }
    system.masters.push_back({.node = found->second, .component = dof.second - 1});
  }
  mbs_export::AttachmentSet all{.name = "attachment", .nodes = {}};
  for (int i = 0; i < std::ssize(system.attachment_nodes); ++i) all.nodes.push_back(i);
  std::set<std::string> taken;
  const auto add = [&](mbs_export::AttachmentSet set) {
    if (!set.nodes.empty() && taken.insert(set.name).second) system.sets.push_back(std::move(set));
  };
  for (const auto& [name, grids] : element.sets) {
    mbs_export::AttachmentSet set{.name = name, .nodes = {}};
    for (const std::int64_t grid : grids)
      if (const auto found = place.find(grid); found != place.end())
        set.nodes.push_back(found->second);
    add(std::move(set));
  }
  add(std::move(all));
  for (const auto& [grid, node] : place)
    add({.name = fmt::format("grid_{}", grid), .nodes = {node}});
}

/// @throws chladni::Error naming the coordinate that moves most where K or M has a negative energy.
void check_energies(const mbs_export::ReducedSystem& system, const Matrices& matrices,
                    const Order& order)
{
  constexpr double digits = 1e-6;  // DMIG has ten
  for (const auto& [A, role] : {std::pair(&system.K, Role::stiffness), {&system.M, Role::mass}}) {
    const VectorXd scale =
        A->diagonal().unaryExpr([](double x) { return x > 0.0 ? 1.0 / std::sqrt(x) : 0.0; });
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
        MatrixXd(scale.asDiagonal() * *A * scale.asDiagonal()));
    if (solver.eigenvalues().minCoeff() >= -digits) continue;
    Index most = 0;
    solver.eigenvectors().col(0).cwiseAbs().maxCoeff(&most);
    throw Error(
        fmt::format("{}: a motion, most of it at {}, has a negative energy: no body has one",
                    matrices.names.at(role),
                    dof_name(matrices.dofs[std::size_t(order.rows[std::size_t(most)])])));
  }
}

/// Gives the modes unit masses and makes K diagonal among them: omega^2 of K_qq Phi = M_qq Phi
/// omega^2. Modes that are so already keep their numbers.
void normalise_modes(mbs_export::ReducedSystem& system, Index n_masters)
{
  const Index n = system.K.rows(), n_modes = n - n_masters;
  if (n_modes == 0) return;
  constexpr double digits = 1e-9;
  const MatrixXd K_qq = system.K.bottomRightCorner(n_modes, n_modes),
                 M_qq = system.M.bottomRightCorner(n_modes, n_modes);
  MatrixXd off = K_qq;
  off.diagonal().setZero();
  const bool is_normal =
      (M_qq - MatrixXd::Identity(n_modes, n_modes)).cwiseAbs().maxCoeff() <= digits &&
      off.cwiseAbs().maxCoeff() <= digits * K_qq.diagonal().cwiseAbs().maxCoeff();
  VectorXd lambda = K_qq.diagonal();
  if (!is_normal) {
    const linear::Eigenmodes modes = linear::eigenmodes(K_qq, M_qq, MatrixXd(n_modes, 0));
    if (modes.n_massless > 0 || modes.lambda.size() != n_modes)
      throw Error("some of the modes (scalar points) have no mass of their own");
    lambda = modes.lambda;
    MatrixXd T = MatrixXd::Identity(n, n);
    T.bottomRightCorner(n_modes, n_modes) = modes.X;
    for (MatrixXd* A : {&system.K, &system.M, &system.C, &system.H})
      if (A->size() > 0) *A = T.transpose() * *A * T;
  }
  if (!(lambda.minCoeff() > 0.0)) {
    throw Error(fmt::format(
        "a mode (scalar point) has the stiffness {:.3g}: modes must be those with held masters, "
        "without rigid motions",
        lambda.minCoeff()));
  }
  system.fixed_interface_frequencies = lambda.cwiseSqrt();
}

/// Rigid motions of the masters, about the mean of the grids.
MatrixXd rigid_motions_of_masters(const mbs_export::ReducedSystem& system)
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& node : system.attachment_nodes)
    centre += node.position / double(system.attachment_nodes.size());
  MatrixXd R = MatrixXd::Zero(system.K.rows(), 6);
  for (Index i = 0; i < system.n_masters(); ++i) {
    const auto& [node, c, harmonic] = system.masters[std::size_t(i)];
    R(i, c) = 1.0;
    if (c >= 3) continue;
    const Eigen::Vector3d arm = system.attachment_nodes[std::size_t(node)].position - centre;
    for (int a = 0; a < 3; ++a) R(i, 3 + a) = Eigen::Vector3d::Unit(a).cross(arm)[c];
  }
  return R;
}

/// What K says to rigid motions, and M to translations.
std::vector<std::string> notes_on_system(const mbs_export::ReducedSystem& system)
{
  constexpr double digits = 1e-6;  // DMIG has ten
  constexpr std::array motions{"translation along x", "translation along y", "translation along z",
                               "rotation about x",    "rotation about y",    "rotation about z"};
  const MatrixXd R = rigid_motions_of_masters(system), KR = system.K * R;
  const VectorXd root = system.K.diagonal().cwiseAbs().cwiseSqrt();
  std::vector<std::string> notes;
  double largest = digits;
  std::string worst;
  for (Index i = 0; i < system.n_masters(); ++i) {
    for (Index k = 0; k < 6; ++k) {
      const double scale = root[i] * root.dot(R.col(k).cwiseAbs());
      if (!(std::abs(KR(i, k)) > largest * scale)) continue;
      largest = std::abs(KR(i, k)) / scale;
      const auto& [node, c, harmonic] = system.masters[std::size_t(i)];
      worst = fmt::format("{} at grid {}, component {}", motions[std::size_t(k)],
                          system.attachment_nodes[std::size_t(node)].number, c + 1);
    }
  }
  if (!worst.empty()) {
    notes.push_back(fmt::format(
        "the stiffness resists a {}: the body is held to the ground, or the grids are not those of "
        "the matrices, or lengths are of another unit",
        worst));
  }
  const Eigen::Vector3d m = (R.leftCols<3>().transpose() * system.M * R.leftCols<3>()).diagonal();
  notes.push_back(fmt::format(
      "the mass is {:.6g} kg; if it is another, --length-unit or --force-unit is", m.mean()));
  return notes;
}

fs::path companion_of(const fs::path& file)
{
  for (const char* extension : {".pch", ".asm", ".bdf", ".dat"}) {
    fs::path beside = file;
    beside.replace_extension(extension);
    if (fs::is_regular_file(beside)) return beside;
  }
  throw Error(fmt::format(
      "{}: there is no .pch beside it, which says of which grids and components its rows are",
      file.string()));
}

std::string capital_extension(const fs::path& file)
{
  return mesh::capitals(file.extension().string());
}

}  // namespace

bool is_superelement(const std::string& file)
{
  const std::string extension = capital_extension(file);
  return extension == ".PCH" || extension == ".DMIG" || extension == ".OP4";
}

ImportedSystem imported_system(const std::string& file, const mesh::DeckUnits& units)
{
  const bool is_op4 = capital_extension(file) == ".OP4";
  const fs::path bulk = is_op4 ? companion_of(file) : fs::path(file);
  try {
    SuperelementReader reader(text_of_superelement(bulk));
    const Superelement element = reader.read();
    const Matrices matrices =
        is_op4 ? matrices_of_op4(element, file) : matrices_of_bulk_data(element, file);
    if (!matrices.of.contains(Role::stiffness) || !matrices.of.contains(Role::mass))
      refuse_without(matrices, file);
    const Order order = masters_first(element, matrices, units);
    ImportedSystem imported;
    mbs_export::ReducedSystem& system = imported.system;
    describe_grids(element, matrices, order, units, system);
    const double energy = units.force * units.length;
    const VectorXd from_SI = order.scale.cwiseInverse();
    const auto converted = [&](Role role) -> MatrixXd {
      const auto found = matrices.of.find(role);
      if (found == matrices.of.end()) return {};
      const MatrixXd A = found->second(order.rows, order.rows);
      return energy * (from_SI.asDiagonal() * A * from_SI.asDiagonal());
    };
    system.K = converted(Role::stiffness);
    system.M = converted(Role::mass);
    system.C = converted(Role::damping);
    system.H = converted(Role::structural);
    check_energies(system, matrices, order);
    normalise_modes(system, order.n_masters);
    system.title = fs::path(file).filename().string();
    system.provenance.versions =
        fmt::format("imported from {} by Chladni {}", system.title, report::version);
    imported.notes = notes_on_system(system);
    for (const auto& [card, n] : element.left_out) {
      imported.notes.push_back(
          fmt::format("{} {} are left out: they are no part of a reduced system", n, card));
    }
    return imported;
  } catch (const Error& error) {
    const std::string said = error.what();
    throw Error(said.find(bulk.string()) == 0 || said.find(file) == 0
                    ? said
                    : fmt::format("{}: {}", bulk.string(), said));
  }
}

std::string imported_scene(const ImportedSystem& imported, const std::string& name)
{
  std::string nodes;
  for (const mbs_export::AttachmentSet& set : imported.system.sets)
    if (!set.name.starts_with("grid_"))
      nodes += fmt::format("{}\"{}\"", nodes.empty() ? "" : ", ", set.name);
  std::string text =
      "# A reduced system of another program: `chladni body` makes a modal body of it. Each grid N "
      "can stand in\n# interface.nodes as grid_N too.\n";
  for (const std::string& note : imported.notes) text += "# " + note + "\n";
  return text + fmt::format("name = \"{}\"\n\n[interface]\nnodes = [{}]\n\n[body]\nfixed = []\n",
                            name, nodes);
}

}  // namespace chladni::cases
