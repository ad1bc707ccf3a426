// Parts, instances and the assembly of an input file as a flat model.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>

#include "common/error.hpp"
#include "mesh/decks/abaqus_keywords.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {
namespace {

/// Where an instance stands: translated first, then turned about an axis.
struct Placement {
  Vector translation = {};
  Vector from = {}, axis = {};  ///< a point of the axis, and its direction of length 1
  double angle = 0.0;           ///< rad

  bool is_turned() const { return angle != 0.0; }

  /// Rodrigues' formula.
  Vector turned(const Vector& v) const
  {
    const double c = std::cos(angle), s = std::sin(angle), along = dot(axis, v);
    const Vector across = cross(axis, v);
    Vector sum{};
    for (std::size_t i = 0; i < 3; ++i)
      sum[i] = c * v[i] + s * across[i] + (1.0 - c) * along * axis[i];
    return sum;
  }

  Vector place(Vector x) const
  {
    for (std::size_t i = 0; i < 3; ++i) x[i] += translation[i] - from[i];
    if (is_turned()) x = turned(x);
    for (std::size_t i = 0; i < 3; ++i) x[i] += from[i];
    return x;
  }
};

Placement placement_of(const Keyword& instance)
{
  if (instance.rows.size() > 2) instance.refuse("has more than a translation and a rotation");
  if (!instance.rows.empty() && !Keyword::field(instance.rows[0], 3).empty()) {
    instance.refuse(instance.rows[0],
                    "is a rotation without a translation before it; write 0., 0., 0. there");
  }
  Placement placement;
  const auto vector = [&](const KeywordRow& row, std::size_t first) {
    Vector v{};
    for (std::size_t c = 0; c < 3; ++c) v[c] = instance.real_or(row, first + c, "a length", 0.0);
    return v;
  };
  if (!instance.rows.empty()) placement.translation = vector(instance.rows[0], 0);
  if (instance.rows.size() < 2) return placement;
  const KeywordRow& rotation = instance.rows[1];
  placement.from = vector(rotation, 0);
  const Vector along = minus(vector(rotation, 3), placement.from);
  if (!(norm(along) > 0.0)) instance.refuse(rotation, "its axis has no direction");
  placement.axis = unit(along);
  placement.angle = instance.real_or(rotation, 6, "an angle", 0.0) * std::numbers::pi / 180.0;
  return placement;
}

/// What the numbers and names of keywords become.
struct Scope {
  std::string prefix;  ///< "A-1." of an instance, empty of the assembly
  std::int64_t offset = 0;
  Placement placement = {};
};

class Flattening {
 public:
  explicit Flattening(std::vector<Keyword> keywords) : keywords_(std::move(keywords)) {}

  std::vector<Keyword> flat()
  {
    find_parts();
    find_instances();
    for (at_ = 0; at_ < keywords_.size(); ++at_) {
      const Keyword& keyword = keywords_[at_];
      if (keyword.name == "PART")
        at_ = end_of(at_);
      else if (keyword.name == "INSTANCE")
        add_instance();
      else if (keyword.name != "ASSEMBLY" && keyword.name != "END ASSEMBLY")
        add_of_assembly(keyword);
    }
    return std::move(flat_);
  }

 private:
  using Range = std::pair<std::size_t, std::size_t>;

  /// The place of the keyword that ends the part or instance at `begin`.
  std::size_t end_of(std::size_t begin) const
  {
    const std::string wanted = "END " + keywords_[begin].name;
    for (std::size_t i = begin + 1; i < keywords_.size(); ++i) {
      if (keywords_[i].name == wanted) return i;
      if (keywords_[i].name == keywords_[begin].name) break;
    }
    keywords_[begin].refuse(fmt::format("does not end with *{}", wanted));
  }

  /// Parts by name, and a power of ten beyond all numbers of nodes and elements.
  void find_parts()
  {
    for (std::size_t i = 0; i < keywords_.size(); ++i) {
      const Keyword& keyword = keywords_[i];
      if (keyword.name == "PART") parts_[keyword.parameter("NAME")] = {i + 1, end_of(i)};
      if (keyword.name != "NODE" && keyword.name != "ELEMENT") continue;
      for (const KeywordRow& row : keyword.rows)
        if (!row.fields.empty() && keyword.is_integer(row.fields.front()))
          greatest_ = std::max(greatest_, keyword.integer(row, 0, "number"));
    }
    while (step_ <= greatest_) step_ *= 10;
  }

  void find_instances()
  {
    for (const Keyword& keyword : keywords_) {
      if (keyword.name != "INSTANCE") continue;
      keyword.expect_only({"NAME", "PART"});
      const auto n = static_cast<std::int64_t>(scopes_.size());
      Scope scope{.prefix = keyword.parameter("NAME") + ".",
                  .offset = n * step_,
                  .placement = placement_of(keyword)};
      if ((n + 2) * step_ > std::numeric_limits<std::int32_t>::max())
        keyword.refuse("the numbers of nodes and elements become too large; number them from 1");
      if (!scopes_.emplace(keyword.parameter("NAME"), std::move(scope)).second)
        keyword.refuse("there is an instance of this name already");
    }
    const bool is_plain = scopes_.empty() || !has_nodes_of_assembly();
    assembly_.offset =
        is_plain && scopes_.size() < 2 ? 0 : static_cast<std::int64_t>(scopes_.size()) * step_;
  }

  bool has_nodes_of_assembly() const
  {
    int depth = 0;
    for (const Keyword& keyword : keywords_) {
      if (keyword.name == "PART" || keyword.name == "INSTANCE") ++depth;
      if (keyword.name == "END PART" || keyword.name == "END INSTANCE") --depth;
      if (depth == 0 && keyword.name == "NODE") return true;
    }
    return false;
  }

  void add_instance()
  {
    const Keyword& instance = keywords_[at_];
    const Scope& scope = scopes_.at(instance.parameter("NAME"));
    const auto part = parts_.find(instance.parameter("PART"));
    if (part == parts_.end())
      instance.refuse(fmt::format("there is no part \"{}\"", instance.parameter("PART")));
    flat_.push_back({.name = "INSTANCE",
                     .place = instance.place,
                     .parameters = {{"NAME", instance.parameter("NAME")},
                                    {"OFFSET", fmt::format("{}", scope.offset)}},
                     .rows = {}});
    const std::size_t end = end_of(at_);
    for (const auto& [first, last] : {part->second, Range{at_ + 1, end}})
      for (std::size_t i = first; i < last; ++i) flat_.push_back(in_scope(keywords_[i], scope));
    at_ = end;
  }

  /// Of the assembly and of the model: the names of sets may be those of an instance.
  void add_of_assembly(const Keyword& keyword)
  {
    if (!keyword.has("INSTANCE")) return flat_.push_back(in_scope(keyword, assembly_));
    const auto scope = scopes_.find(keyword.parameter("INSTANCE"));
    if (scope == scopes_.end())
      keyword.refuse(fmt::format("there is no instance \"{}\"", keyword.parameter("INSTANCE")));
    Keyword listed = keyword;
    listed.parameters.erase("INSTANCE");
    for (KeywordRow& row : listed.rows) rename_list(listed, row, scope->second);
    flat_.push_back(std::move(listed));
  }

  /// A name or a number as it is called in the flat model.
  std::string renamed(const Keyword& keyword, const std::string& text, const Scope& scope) const
  {
    if (text.empty()) return text;
    if (keyword.is_integer(text)) return shifted(keyword, text, scope.offset);
    const std::size_t dot = text.find('.');
    if (!scope.prefix.empty() || dot == std::string::npos) return scope.prefix + text;
    const auto instance = scopes_.find(text.substr(0, dot));
    const std::string rest = text.substr(dot + 1);
    if (instance == scopes_.end() || !keyword.is_integer(rest)) return text;
    return shifted(keyword, rest, instance->second.offset);
  }

  static std::string shifted(const Keyword& keyword, const std::string& number, std::int64_t offset)
  {
    if (offset == 0) return number;
    return fmt::format("{}", keyword.integer({keyword.place, {number}}, 0, "number") + offset);
  }

  void rename_list(const Keyword& keyword, KeywordRow& row, const Scope& scope) const
  {
    const std::size_t n = keyword.has("GENERATE") ? 2 : row.fields.size();
    for (std::size_t i = 0; i < std::min(n, row.fields.size()); ++i)
      row.fields[i] = renamed(keyword, row.fields[i], scope);
  }

  Keyword in_scope(Keyword keyword, const Scope& scope) const
  {
    static const std::set<std::string> names{"NSET",     "ELSET",    "SURFACE", "REF NODE",
                                             "ROT NODE", "TIE NSET", "PIN NSET"};
    for (auto& [parameter, value] : keyword.parameters) {
      const bool is_name =
          names.contains(parameter) || (keyword.name == "SURFACE" && parameter == "NAME");
      if (is_name) value = renamed(keyword, value, scope);
    }
    for (std::size_t i = 0; i < keyword.rows.size(); ++i) change_row(keyword, i, scope);
    const bool has_place = keyword.has("TYPE") && keyword.parameter("TYPE") == "C";
    if (keyword.name == "TRANSFORM" && !scope.prefix.empty() &&
        (scope.placement.is_turned() || (has_place && norm(scope.placement.translation) > 0.0))) {
      keyword.refuse(
          "is of a part whose instance is moved; write it in the assembly, with the axes there");
    }
    return keyword;
  }

  void change_row(Keyword& keyword, std::size_t i, const Scope& scope) const
  {
    KeywordRow& row = keyword.rows[i];
    if (keyword.name == "NODE") place_node(keyword, row, scope);
    if (keyword.name == "ELEMENT" || keyword.name == "NSET" || keyword.name == "ELSET")
      rename_list(keyword, row, scope);
    if (keyword.name == "EQUATION" && row.fields.size() > 1)
      for (std::size_t k = 0; k < row.fields.size(); k += 3)
        row.fields[k] = renamed(keyword, row.fields[k], scope);
    if (keyword.name == "TIE")
      for (std::string& surface : row.fields) surface = renamed(keyword, surface, scope);
    if (keyword.name == "MPC")
      for (std::size_t k = 1; k < row.fields.size(); ++k)
        row.fields[k] = renamed(keyword, row.fields[k], scope);
    static const std::set<std::string> begin_with_a_name{"SURFACE", "BOUNDARY", "NODAL THICKNESS"};
    if (begin_with_a_name.contains(keyword.name) && !row.fields.empty())
      row.fields[0] = renamed(keyword, row.fields[0], scope);
    if (keyword.name == "BEAM SECTION" && i == 1 && scope.placement.is_turned()) {
      Vector n1{};
      for (std::size_t c = 0; c < 3; ++c) n1[c] = keyword.real_or(row, c, "n1", 0.0);
      set_vector(row, 0, scope.placement.turned(n1));
    }
  }

  static void place_node(const Keyword& keyword, KeywordRow& row, const Scope& scope)
  {
    if (!row.fields.empty() && keyword.is_integer(row.fields[0]))
      row.fields[0] = shifted(keyword, row.fields[0], scope.offset);
    if (!scope.placement.is_turned() && norm(scope.placement.translation) == 0.0) return;
    Vector x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = keyword.real_or(row, 1 + c, "a coordinate", 0.0);
    set_vector(row, 1, scope.placement.place(x));
  }

  static void set_vector(KeywordRow& row, std::size_t first, const Vector& x)
  {
    row.fields.resize(std::max(row.fields.size(), first + 3));
    for (std::size_t c = 0; c < 3; ++c) row.fields[first + c] = fmt::format("{}", x[c]);
  }

  std::vector<Keyword> keywords_, flat_;
  std::map<std::string, Range> parts_;
  std::map<std::string, Scope> scopes_;  ///< of instances
  Scope assembly_;
  std::int64_t greatest_ = 0, step_ = 1;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<Keyword> flat_keywords(std::vector<Keyword> keywords)
{
  const auto is_of_assembly = [](const Keyword& keyword) {
    return keyword.name == "PART" || keyword.name == "INSTANCE" || keyword.name == "ASSEMBLY";
  };
  if (std::ranges::none_of(keywords, is_of_assembly)) return keywords;
  return Flattening(std::move(keywords)).flat();
}

}  // namespace chladni::mesh
