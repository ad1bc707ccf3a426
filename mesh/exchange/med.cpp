// Names of groups and attributes as the MED library writes them: ENS_MAA meshes, NOE nodes, MAI
// elements, FAS families, GRO groups, NOD connectivity, COO coordinates.

#include "mesh/exchange/med.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/files/hdf5_objects.hpp"
#include "mesh/decks/file_elements.hpp"
#include "mesh/element_types.hpp"

namespace chladni::mesh {

using files::Handle, files::shown;

namespace {

/// The HDF5 groups, attributes and datasets of a MED file, by their path from the root. All
/// functions throw chladni::Error that names the object.
class MedFile {
 public:
  /// @param bytes  contents of the file, read from memory: libhdf5 opens and locks nothing
  /// @throws chladni::Error when it is no HDF5, or a link leads out of the file.
  explicit MedFile(const std::string& bytes);

  bool has(const std::string& name) const;
  /// The names of the members of a group in alphabetical order; empty if there is no such group.
  std::vector<std::string> members(const std::string& name) const;
  std::int64_t integer_attribute(const std::string& name, const std::string& attribute) const;

  std::vector<std::int64_t> integers(const std::string& name) const;
  std::vector<double> reals(const std::string& name) const;
  /// Texts of `length` characters each, without trailing blanks and zeros.
  std::vector<std::string> texts(const std::string& name, std::size_t length) const;

 private:
  files::Handle file_;
};

[[noreturn]] void refuse(const std::string& name, const std::string& why)
{
  throw Error(fmt::format("{}: {}", files::shown(name), why));
}

Handle opened(const std::string& bytes)
{
  files::prepare_to_read();
  const Handle access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
  constexpr std::size_t increment = 1 << 16;
  std::string image = bytes;  // libhdf5 takes no const, and copies it
  H5Pset_fapl_core(access.get(), increment, 0);
  H5Pset_file_image(access.get(), image.data(), image.size());
  const char* no_file = "/dev/null/mesh";  // libhdf5 takes no image for a file that is there
  Handle file{H5Fopen(no_file, H5F_ACC_RDONLY, access.get()), H5Fclose};
  if (!file.valid()) throw Error("it is no HDF5 file, as MED files are, or is cut off");
  const std::string link = files::foreign_link(file.get());
  if (!link.empty()) throw Error(link);
  return file;
}

/// A dataset whose values stand in the file.
struct Dataset {
  Handle id, space;
  hsize_t n;  ///< values, of all extents together
};

Dataset open_dataset(hid_t file, const std::string& name)
{
  Handle id{H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!id.valid()) refuse(name, "there is no such dataset");
  const Handle creation{H5Dget_create_plist(id.get()), H5Pclose};
  const std::string foreign = files::foreign_part(creation.get());
  if (!foreign.empty()) refuse(name, foreign);
  Handle space{H5Dget_space(id.get()), H5Sclose};
  const hssize_t n = H5Sget_simple_extent_npoints(space.get());
  hsize_t file_size = 0;
  H5Fget_filesize(file, &file_size);
  if (n != 0 && !files::plausible_shape(id.get(), creation.get(), file_size))
    refuse(name, "claims more values than the file can hold; the file is damaged or cut off");
  return {std::move(id), std::move(space), static_cast<hsize_t>(n)};
}

template <class T>
std::vector<T> values(hid_t file, const std::string& name, H5T_class_t expected, hid_t memory_type)
{
  const Dataset dataset = open_dataset(file, name);
  const Handle type{H5Dget_type(dataset.id.get()), H5Tclose};
  if (H5Tget_class(type.get()) != expected) {
    refuse(name,
           expected == H5T_INTEGER ? "does not hold whole numbers" : "does not hold real numbers");
  }
  std::vector<T> read(dataset.n);
  if (H5Dread(dataset.id.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()) < 0)
    refuse(name, "cannot be read; the file is damaged");
  return read;
}

MedFile::MedFile(const std::string& bytes) : file_(opened(bytes)) {}

bool MedFile::has(const std::string& name) const
{
  for (std::size_t end = name.find('/');; end = name.find('/', end + 1)) {
    if (H5Lexists(file_.get(), name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<std::string> MedFile::members(const std::string& name) const
{
  if (!has(name)) return {};
  const Handle group{H5Gopen2(file_.get(), name.c_str(), H5P_DEFAULT), H5Gclose};
  H5G_info_t info{};
  if (!group.valid() || H5Gget_info(group.get(), &info) < 0) refuse(name, "is no group");
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const auto name_of = [&](char* text, std::size_t size) {
      return H5Lget_name_by_idx(group.get(), ".", H5_INDEX_NAME, H5_ITER_INC, i, text, size,
                                H5P_DEFAULT);
    };
    const ssize_t length = name_of(nullptr, 0);
    if (length < 0) refuse(name, "has a member without a name; the file is damaged");
    std::string member(static_cast<std::size_t>(length), '\0');
    name_of(member.data(), member.size() + 1);
    names.push_back(std::move(member));
  }
  return names;
}

std::int64_t MedFile::integer_attribute(const std::string& name, const std::string& attribute) const
{
  const Handle id{
      H5Aopen_by_name(file_.get(), name.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose};
  const Handle type{id.valid() ? H5Aget_type(id.get()) : -1, H5Tclose};
  const Handle space{id.valid() ? H5Aget_space(id.get()) : -1, H5Sclose};
  std::int64_t value = 0;
  if (!id.valid() || H5Tget_class(type.get()) != H5T_INTEGER ||
      H5Sget_simple_extent_npoints(space.get()) != 1 ||
      H5Aread(id.get(), H5T_NATIVE_INT64, &value) < 0)
    refuse(name, fmt::format("has no whole number as attribute {}", attribute));
  return value;
}

std::vector<std::int64_t> MedFile::integers(const std::string& name) const
{
  return values<std::int64_t>(file_.get(), name, H5T_INTEGER, H5T_NATIVE_INT64);
}

std::vector<double> MedFile::reals(const std::string& name) const
{
  std::vector<double> read = values<double>(file_.get(), name, H5T_FLOAT, H5T_NATIVE_DOUBLE);
  for (const double x : read)
    if (!std::isfinite(x)) refuse(name, "holds a value that is no finite number");
  return read;
}

/// An array of bytes for each text, or all texts in rows of bytes.
std::vector<std::string> MedFile::texts(const std::string& name, std::size_t length) const
{
  const Dataset dataset = open_dataset(file_.get(), name);
  const Handle type{H5Dget_type(dataset.id.get()), H5Tclose};
  const std::size_t n_bytes = dataset.n * H5Tget_size(type.get());
  const bool is_of_bytes = H5Tget_class(type.get()) == H5T_INTEGER ||
                           H5Tget_class(type.get()) == H5T_ARRAY ||
                           H5Tget_class(type.get()) == H5T_STRING;
  if (!is_of_bytes || H5Tis_variable_str(type.get()) > 0 || n_bytes % length != 0)
    refuse(name, fmt::format("does not hold texts of {} characters", length));
  std::string bytes(n_bytes, '\0');
  if (H5Dread(dataset.id.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
    refuse(name, "cannot be read; the file is damaged");
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < n_bytes; at += length) {
    std::string text = bytes.substr(at, length);
    text.erase(std::min(text.find('\0'), text.size()));
    text.erase(text.find_last_not_of(' ') + 1);
    texts.push_back(std::move(text));
  }
  return texts;
}

/// Numbers of families and the groups that each is of.
using Families = std::map<std::int64_t, std::vector<std::string>>;

class MedReader {
 public:
  explicit MedReader(const std::string& bytes) : file_(bytes) {}

  ExchangeMesh read()
  {
    check_version();
    find_mesh();
    read_nodes();
    for (const std::string& type : file_.members(step_ + "/MAI")) read_elements(type);
    const std::size_t n_fields = file_.members("CHA").size();
    if (n_fields > 0) mesh_.notes.push_back(fmt::format("{} fields are left out", n_fields));
    return std::move(mesh_);
  }

 private:
  void check_version() const
  {
    if (!file_.has("INFOS_GENERALES"))
      throw Error("it is no MED file: INFOS_GENERALES, its version, is missing");
    const std::int64_t major = file_.integer_attribute("INFOS_GENERALES", "MAJ");
    if (major == 3 || major == 4) return;
    throw Error(fmt::format(
        "it is of version {} of MED; 3 and 4 are read: convert it with medimport", major));
  }

  /// The only member of a group.
  std::string only_member(const std::string& name, const char* what) const
  {
    std::vector<std::string> names = file_.members(name);
    if (names.size() == 1) return names.front();
    for (std::string& text : names) text = shown(text);
    throw Error(fmt::format("{}: has {} {} instead of one{}{}", shown(name), names.size(), what,
                            names.empty() ? "" : ": ", fmt::join(names, ", ")));
  }

  void find_mesh()
  {
    const std::string name = only_member("ENS_MAA", "meshes");
    const std::string mesh = "ENS_MAA/" + name;
    if (file_.integer_attribute(mesh, "TYP") != 0) {
      throw Error(
          fmt::format("{}: is a structured grid; save it as an unstructured mesh", shown(mesh)));
    }
    if (file_.integer_attribute(mesh, "REP") != 0)
      throw Error(fmt::format("{}: has no Cartesian coordinates", shown(mesh)));
    dimension_ = file_.integer_attribute(mesh, "ESP");
    if (dimension_ != 2 && dimension_ != 3) {
      throw Error(
          fmt::format("{}: stands in {} dimensions; 2 or 3 are known", shown(mesh), dimension_));
    }
    step_ = mesh + "/" + only_member(mesh, "states");
    of_nodes_ = families("FAS/" + name + "/NOEUD");
    of_elements_ = families("FAS/" + name + "/ELEME");
  }

  Families families(const std::string& name) const
  {
    constexpr std::size_t length = 80;  // MED_LNAME_SIZE
    Families found;
    for (const std::string& family : file_.members(name)) {
      const std::string path = fmt::format("{}/{}", name, family);
      std::vector<std::string>& groups = found[file_.integer_attribute(path, "NUM")];
      if (file_.has(path + "/GRO/NOM")) groups = file_.texts(path + "/GRO/NOM", length);
      std::erase(groups, "");
    }
    return found;
  }

  /// Values of which there must be `n`; nothing where the file leaves them out.
  std::optional<std::vector<std::int64_t>> optional_numbers(const std::string& name,
                                                            std::size_t n) const
  {
    if (!file_.has(name)) return std::nullopt;
    std::vector<std::int64_t> numbers = file_.integers(name);
    if (numbers.size() == n) return numbers;
    throw Error(
        fmt::format("{}: has {} values for {} nodes or elements", shown(name), numbers.size(), n));
  }

  const std::vector<std::string>& groups_of(const Families& families, std::int64_t family) const
  {
    static const std::vector<std::string> none;
    if (family == 0) return none;
    const auto found = families.find(family);
    if (found == families.end()) throw Error(fmt::format("FAS: there is no family {}", family));
    return found->second;
  }

  /// Coordinates stand component by component, as all that MED writes.
  void read_nodes()
  {
    const std::string nodes = step_ + "/NOE";
    const std::vector<double> x = file_.reals(nodes + "/COO");
    const auto dimension = static_cast<std::size_t>(dimension_);
    if (x.empty() || x.size() % dimension != 0)
      throw Error(fmt::format("{}/COO: has {} values", shown(nodes), x.size()));
    n_nodes_ = x.size() / dimension;
    const auto numbers = optional_numbers(nodes + "/NUM", n_nodes_);
    const auto families = optional_numbers(nodes + "/FAM", n_nodes_);
    for (std::size_t i = 0; i < n_nodes_; ++i) {
      const std::int64_t number = numbers ? (*numbers)[i] : static_cast<std::int64_t>(i) + 1;
      if (number < 1 ||
          !mesh_.nodes
               .emplace(number, std::array{x[i], x[n_nodes_ + i],
                                           dimension == 3 ? x[2 * n_nodes_ + i] : 0.0})
               .second)
        throw Error(fmt::format("{}/NUM: {} is no number of a node, or is there twice",
                                shown(nodes), number));
      node_numbers_.push_back(number);
      if (!families) continue;
      for (const std::string& group : groups_of(of_nodes_, (*families)[i]))
        exchange_group(mesh_, group, Members::nodes).nodes.push_back(number);
    }
  }

  static const FileElement& known_type(const std::string& name)
  {
    const std::vector<FileElement>& types = file_elements(Format::med, name);
    if (!types.empty()) return types.front();
    static const std::set<std::string> solids{"PY5", "P13", "PO6", "POE", "OCT12"};
    if (solids.contains(name)) throw Error(fmt::format("MAI: {} is {}", name, no_such_solid));
    throw Error(fmt::format("MAI: elements {} are not known; PO1, {} are", shown(name),
                            names_of_elements(Format::med)));
  }

  std::vector<std::int64_t> node_indices(const std::string& name) const
  {
    std::vector<std::int64_t> nodes = file_.integers(name + "/NOD");
    for (const std::int64_t node : nodes)
      if (node < 1 || node > static_cast<std::int64_t>(n_nodes_))
        throw Error(fmt::format("{}/NOD: there is no node {}", shown(name), node));
    return nodes;
  }

  void read_elements(const std::string& type_name)
  {
    const std::string name = step_ + "/MAI/" + type_name;
    const bool is_point = type_name == "PO1";
    const FileElement* const type = is_point ? nullptr : &known_type(type_name);
    const std::size_t n_each = is_point ? 1 : type->n_nodes;
    const std::vector<std::int64_t> nodes = node_indices(name);
    if (nodes.size() % n_each != 0)
      throw Error(fmt::format("{}/NOD: has {} values", shown(name), nodes.size()));
    const std::size_t n = nodes.size() / n_each;
    if (!is_point && n_each > type->places.size()) {
      mesh_.notes.push_back(fmt::format(
          "{} elements {}: their nodes on faces and inside are left out", n, type_name));
    }
    const auto numbers = optional_numbers(name + "/NUM", n);
    const auto families = optional_numbers(name + "/FAM", n);
    for (std::size_t e = 0; e < n; ++e) {
      std::vector<std::int64_t> of_element;
      for (std::size_t k = 0; k < n_each; ++k)
        of_element.push_back(node_numbers_[static_cast<std::size_t>(nodes[k * n + e] - 1)]);
      static const std::vector<std::string> none;
      const auto& groups = families ? groups_of(of_elements_, (*families)[e]) : none;
      for (const std::string& group : groups)
        if (is_point)
          exchange_group(mesh_, group, Members::nodes).nodes.push_back(of_element.front());
        else
          exchange_group(mesh_, group, Members::elements).elements.push_back(mesh_.elements.size());
      if (is_point) continue;
      const std::int64_t number =
          numbers ? (*numbers)[e] : static_cast<std::int64_t>(mesh_.elements.size()) + 1;
      mesh_.elements.push_back(turned_outside(deck_element(*type, number, of_element, -1)));
    }
  }

  /// MED lists the nodes of solids in the sense that turns them inside out here; some programs do
  /// not.
  DeckElement turned_outside(DeckElement element) const
  {
    if (!(orientation(element, mesh_.nodes) < 0.0)) return element;
    const std::vector<std::int64_t> nodes = element.nodes;
    const std::vector<int> places = mirrored_places(element.shape, element.order);
    for (std::size_t i = 0; i < nodes.size(); ++i) element.nodes[i] = nodes[std::size_t(places[i])];
    return element;
  }

  MedFile file_;
  ExchangeMesh mesh_;
  std::string step_;
  std::int64_t dimension_ = 0;
  std::size_t n_nodes_ = 0;
  std::vector<std::int64_t> node_numbers_;
  Families of_nodes_, of_elements_;
};

}  // namespace

ExchangeMesh med_mesh(const std::string& bytes)
{
  return MedReader(bytes).read();
}

}  // namespace chladni::mesh
