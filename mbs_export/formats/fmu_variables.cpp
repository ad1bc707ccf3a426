#include "mbs_export/formats/fmu_variables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <set>

#include "common/eigen_every.hpp"
#include "common/error.hpp"

namespace chladni::mbs_export::formats {
namespace {

using Eigen::Index;
using Kind = FmuVariable::Kind;

constexpr std::array axes{"x", "y", "z"};

/// A part of a structured name: letters, digits and _, or in quotes.
std::string identifier(const std::string& name)
{
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  const auto is_part = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); };
  if (!name.empty() && is_letter(name.front()) && std::ranges::all_of(name, is_part)) return name;
  std::string quoted = "'";
  for (const char c : name)
    quoted += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + "'";
}

/// Of the first set that the node is in; the nodes of a set count from 1.
std::string name_of_node(const ModalBody& body, int node)
{
  for (const AttachmentSet& set : body.sets) {
    const auto found = std::ranges::find(set.nodes, node);
    if (found == set.nodes.end()) continue;
    if (set.nodes.size() == 1) return identifier(set.name);
    return fmt::format("{}[{}]", identifier(set.name), found - set.nodes.begin() + 1);
  }
  return fmt::format("node[{}]", body.attachment_nodes[std::size_t(node)].number);
}

std::set<int> chosen_nodes(const ModalBody& body, const std::vector<std::string>& sets)
{
  std::set<int> chosen;
  for (const std::string& name : sets) {
    const auto set = std::ranges::find(body.sets, name, &AttachmentSet::name);
    if (set == body.sets.end()) {
      std::vector<std::string> names;
      for (const AttachmentSet& known : body.sets) names.push_back(known.name);
      throw Error(fmt::format("the body has no set \"{}\" of attachment nodes; it has {}", name,
                              fmt::join(names, ", ")));
    }
    chosen.insert(set->nodes.begin(), set->nodes.end());
  }
  for (int node = 0; sets.empty() && node < std::ssize(body.attachment_nodes); ++node)
    chosen.insert(node);
  return chosen;
}

/// What a group of variables of degrees of freedom is called.
struct OfDofs {
  Kind kind;
  std::array<const char*, 2> symbols, units, descriptions;  ///< along, and about, an axis
};

const OfDofs forces{Kind::input, {"F", "M"}, {"N", "N.m"}, {"force along", "moment about"}};
const OfDofs displacements{
    Kind::output, {"u", "theta"}, {"m", "rad"}, {"displacement along", "rotation about"}};
const OfDofs velocities{
    Kind::output, {"v", "omega"}, {"m/s", "rad/s"}, {"velocity along", "angular velocity about"}};
const OfDofs accelerations{Kind::output,
                           {"a", "alpha"},
                           {"m/s2", "rad/s2"},
                           {"acceleration along", "angular acceleration about"}};

class Variables {
 public:
  explicit Variables(const FmuBody& body)
      : body_(body), references_(body.model.n_modes(), body.model.n_dofs())
  {}

  std::vector<FmuVariable> all()
  {
    add({.name = "time", .description = "time", .kind = Kind::independent, .unit = "s"});
    add({.name = "damping_factor",
         .description = "factor of the damping that the body has by itself",
         .kind = Kind::parameter,
         .start = 1.0});
    add_of_modes("damping_ratio", "damping ratio besides the body's own", Kind::parameter);
    add_of_dofs(forces, {});
    add_of_dofs(displacements, references_.q());
    add_of_dofs(velocities, references_.q_dot());
    add_of_dofs(accelerations, {});
    add_of_modes("q", "modal coordinate", Kind::state);
    add_of_modes("q_dot", "its rate", Kind::state);
    add_derivatives("q", references_.q());
    add_derivatives("q_dot", references_.q_dot());
    assert(variables_.size() == references_.end());
    return std::move(variables_);
  }

 private:
  void add(FmuVariable variable) { variables_.push_back(std::move(variable)); }

  std::string of_mode(Index i) const
  {
    return fmt::format("of the mode at {:.6g} Hz", body_.model.omega[i] / (2.0 * EIGEN_PI));
  }

  void add_of_modes(const char* name, const char* what, Kind kind)
  {
    for (Index i = 0; i < body_.model.n_modes(); ++i) {
      add({.name = fmt::format("mode[{}].{}", i + 1, name),
           .description = fmt::format("{} {}", what, of_mode(i)),
           .kind = kind});
    }
  }

  void add_derivatives(const char* name, std::uint32_t first)
  {
    const bool is_rate = first == references_.q();
    for (Index i = 0; i < body_.model.n_modes(); ++i) {
      const auto place = static_cast<std::uint32_t>(i);
      FmuVariable variable{.name = fmt::format("der(mode[{}].{})", i + 1, name),
                           .description = fmt::format("derivative {}", of_mode(i)),
                           .kind = Kind::derivative,
                           .derivative_of = first + place,
                           .depends_on_all = !is_rate};
      if (is_rate) variable.depends_on = {references_.q_dot() + place};
      add(std::move(variable));
    }
  }

  /// @param modes  the first state of those that an output is a sum of; nothing: it depends on all
  void add_of_dofs(const OfDofs& group, std::optional<std::uint32_t> modes)
  {
    for (std::size_t j = 0; j < body_.dofs.size(); ++j) {
      const FmuDof& dof = body_.dofs[j];
      const auto turn = static_cast<std::size_t>(dof.component / 3);
      const char* axis = axes[static_cast<std::size_t>(dof.component % 3)];
      FmuVariable variable{
          .name = fmt::format("{}.{}_{}", dof.node, group.symbols[turn], axis),
          .description = fmt::format("{} {} at {}", group.descriptions[turn], axis, dof.node),
          .kind = group.kind,
          .unit = group.units[turn],
          .depends_on_all = !modes};
      for (Index i = 0; modes && i < body_.model.n_modes(); ++i)
        if (body_.model.Phi(Index(j), i) != 0.0)
          variable.depends_on.push_back(*modes + static_cast<std::uint32_t>(i));
      add(std::move(variable));
    }
  }

  const FmuBody& body_;
  fmu::References references_;
  std::vector<FmuVariable> variables_;
};

}  // namespace

FmuBody fmu_body(const ModalBody& body, const std::vector<std::string>& sets)
{
  FmuBody made{.dofs = {}, .model = {.token = {}, .omega = body.omega, .C = body.C, .Phi = {}}};
  std::vector<Index> rows;
  const double still = 1e-12 * body.attachment_modes.cwiseAbs().maxCoeff();
  for (const int node : chosen_nodes(body, sets)) {
    for (int component = 0; component < 6; ++component) {
      const Index row = 6 * Index(node) + component;
      if (body.attachment_modes.row(row).cwiseAbs().maxCoeff() <= still) {
        ++made.n_still;
        continue;
      }
      rows.push_back(row);
      made.dofs.push_back({.node = name_of_node(body, node), .component = component});
    }
  }
  if (rows.empty()) throw Error("the body moves at none of these attachment nodes");
  made.model.Phi = body.attachment_modes(rows, every);
  return made;
}

std::vector<FmuVariable> fmu_variables(const FmuBody& body)
{
  return Variables(body).all();
}

}  // namespace chladni::mbs_export::formats
