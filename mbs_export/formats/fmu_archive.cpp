#include "mbs_export/formats/fmu_archive.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "common/files/input_file.hpp"

namespace chladni::mbs_export::formats {

using Eigen::Index;

namespace {

/// A file in a zip archive.
struct ZipEntry {
  std::string name;  ///< with slashes between folders
  std::string bytes;
};

constexpr std::uint16_t version_needed = 20, deflated = 8;

constexpr std::uint16_t name_is_utf8 = 0x0800;

constexpr std::uint16_t first_of_january_1980 = 0x0021;  // no time: the archive depends on nothing

/// Little-endian, as all numbers of the format.
void append(std::string& bytes, std::uint16_t number)
{
  bytes += static_cast<char>(number & 0xFF);
  bytes += static_cast<char>(number >> 8);
}

void append(std::string& bytes, std::uint32_t number)
{
  append(bytes, static_cast<std::uint16_t>(number & 0xFFFF));
  append(bytes, static_cast<std::uint16_t>(number >> 16));
}

std::uint32_t zip_size(std::size_t n, const std::string& name)
{
  if (n < std::numeric_limits<std::uint32_t>::max()) return static_cast<std::uint32_t>(n);
  throw Error(fmt::format("{}: with it the archive has 4 GiB, more than a zip holds", name));
}

/// Without zlib's own head and checksum, as in a zip.
std::string raw_deflate(const std::string& bytes)
{
  z_stream stream{};
  constexpr int without_header = -MAX_WBITS, memory_level = 8;
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, without_header, memory_level,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error("zlib has no memory to pack an archive");
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int result = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw Error("zlib could not pack an archive");
  return packed;
}

/// What stands in front of an entry and again in the directory at the end.
std::string fields(const ZipEntry& entry, std::size_t n_packed)
{
  std::string bytes;
  append(bytes, version_needed);
  append(bytes, name_is_utf8);
  append(bytes, deflated);
  append(bytes, std::uint16_t{0});
  append(bytes, first_of_january_1980);
  append(bytes,
         static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(entry.bytes.data()),
                                          zip_size(entry.bytes.size(), entry.name))));
  append(bytes, zip_size(n_packed, entry.name));
  append(bytes, zip_size(entry.bytes.size(), entry.name));
  append(bytes, static_cast<std::uint16_t>(entry.name.size()));
  append(bytes, std::uint16_t{0});  // no extra field
  return bytes;
}

std::string in_directory(const ZipEntry& entry, const std::string& of_entry, std::size_t offset)
{
  constexpr std::uint16_t made_by_unix = 3 << 8 | version_needed;
  constexpr std::uint32_t regular_file = 0100644U << 16;
  std::string bytes = "PK\1\2";
  append(bytes, made_by_unix);
  bytes += of_entry;
  append(bytes, std::uint16_t{0});  // no comment
  append(bytes, std::uint16_t{0});  // first disk
  append(bytes, std::uint16_t{0});
  append(bytes, regular_file);
  append(bytes, zip_size(offset, entry.name));
  return bytes + entry.name;
}

/// A zip archive of compressed entries. Equal entries give equal bytes.
/// @throws chladni::Error when it is too large for the format without its 4 GiB extension.
/// Source: PKWARE, APPNOTE.TXT, .ZIP File Format Specification, sections 4.3.7, 4.3.12, 4.3.16.
std::string zip_archive(const std::vector<ZipEntry>& entries)
{
  std::string archive, directory;
  for (const ZipEntry& entry : entries) {
    zip_size(entry.bytes.size(), entry.name);
    const std::string packed = raw_deflate(entry.bytes);
    const std::string of_entry = fields(entry, packed.size());
    directory += in_directory(entry, of_entry, archive.size());
    for (const std::string& part : {std::string("PK\3\4"), of_entry, entry.name, packed})
      archive += part;
  }
  const auto n = static_cast<std::uint16_t>(entries.size());
  const std::uint32_t begin = zip_size(archive.size(), "the directory");
  archive += directory + "PK\5\6";
  append(archive, std::uint32_t{0});  // first disk, twice
  append(archive, n);
  append(archive, n);
  append(archive, zip_size(directory.size(), "the directory"));
  append(archive, begin);
  append(archive, std::uint16_t{0});  // no comment
  return archive;
}

namespace fs = std::filesystem;

/// The library beside this program as both are built and installed, or in the folder that the user
/// says.
fs::path library(const std::string& name)
{
  if (const char* said = std::getenv("CHLADNI_FMU_LIBRARIES")) return fs::path(said) / name;
  const fs::path below = fs::path("chladni") / name;
  std::error_code ignored;
  const fs::path here = fs::read_symlink("/proc/self/exe", ignored).parent_path() / "../libexec";
  for (const fs::path& folder : {here, fs::path(CHLADNI_LIBEXEC_FOLDER)})
    if (fs::exists(folder / below, ignored)) return folder / below;
  throw Error(fmt::format(
      "the library {}, which goes into FMUs, is neither in {} nor in {}; install it, or set "
      "CHLADNI_FMU_LIBRARIES to its folder",
      name, (here / "chladni").lexically_normal().string(),
      (CHLADNI_LIBEXEC_FOLDER / fs::path("chladni")).string()));
}

std::string bytes_of_file(const fs::path& path)
{
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (bytes.empty()) throw Error(fmt::format("{}: cannot be read", path.string()));
  return bytes;
}

/// The folder of an FMU for libraries of this machine.
std::string platform(FmiVersion version)
{
#if defined(__x86_64__)
  return version == FmiVersion::v2 ? "linux64" : "x86_64-linux";
#elif defined(__aarch64__)
  if (version == FmiVersion::v3) return "aarch64-linux";
#endif
  throw Error("FMI 2.0 knows no libraries for the processor of this machine; say --fmi 3");
}

std::string digest(const std::string& bytes)
{
  files::Xxh64 digest;
  const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const std::size_t whole = bytes.size() / files::Xxh64::stripe * files::Xxh64::stripe;
  digest.add({begin, whole});
  return fmt::format("{:016x}", digest.finish({begin + whole, bytes.size() - whole}));
}

std::vector<std::string> notes_on_fmu(const ModalBody& body, const FmuBody& made)
{
  std::vector<std::string> notes;
  if (body.n_free_rigid > 0) {
    notes.push_back(fmt::format(
        "{} rigid-body motions are free: the FMU has them as states, which holds for small motions "
        "about the place of the mesh",
        body.n_free_rigid));
  }
  if (made.n_still > 0) {
    notes.push_back(fmt::format("{} degrees of freedom in which the body cannot move are left out",
                                made.n_still));
  }
  if (body.C.size() == 0) {
    notes.emplace_back(
        "the body has no damping; the parameters mode[i].damping_ratio give it some");
  }
  return notes;
}

}  // namespace

std::string fmu_identifier(const std::string& name)
{
  std::string identifier;
  for (const char c : name) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool is_digit = c >= '0' && c <= '9';
    identifier += is_letter || is_digit ? c : '_';
  }
  if (identifier.empty() || (identifier.front() >= '0' && identifier.front() <= '9'))
    identifier.insert(identifier.begin(), '_');
  return identifier;
}

std::string fmu_archive(const FmuParts& parts)
{
  const std::string binary =
      fmt::format("binaries/{}/{}.so", platform(parts.version), parts.identifier);
  return zip_archive({{.name = "modelDescription.xml", .bytes = parts.description},
                      {.name = binary, .bytes = bytes_of_file(library(parts.library))},
                      {.name = "resources/" + parts.resource, .bytes = parts.model}});
}

std::string fmu_token(const std::string& model, const std::vector<FmuVariable>& variables)
{
  std::string all = model;
  for (const FmuVariable& variable : variables) all += variable.name + "\n";
  return digest(all);
}

Fmu fmu(const ModalBody& body, const FmuOptions& options)
{
  FmuBody made = fmu_body(body, options.sets);
  const std::vector<FmuVariable> variables = fmu_variables(made);
  made.model.token = fmu_token(chladni::fmu::packed(made.model), variables);
  const std::string& name = body.title.empty() ? options.identifier : body.title;
  const std::string description = fmu_description(
      variables, {.name = name, .identifier = options.identifier, .token = made.model.token},
      options.version);
  return {.archive = fmu_archive({.version = options.version,
                                  .identifier = options.identifier,
                                  .description = description,
                                  .library = "chladni-fmu.so",
                                  .resource = chladni::fmu::model_file,
                                  .model = chladni::fmu::packed(made.model)}),
          .notes = notes_on_fmu(body, made)};
}

namespace {

using Kind = FmuVariable::Kind;

/// A text as the value of an attribute of XML.
std::string attribute(const std::string& text)
{
  std::string escaped;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20)
      escaped += ' ';
    else if (c == '&' || c == '<' || c == '>' || c == '"')
      escaped += fmt::format("&#{};", code);
    else
      escaped += c;
  }
  return escaped;
}

const char* unit_definitions =
    "  <UnitDefinitions>\n"
    "    <Unit name=\"s\"><BaseUnit s=\"1\"/></Unit>\n"
    "    <Unit name=\"N\"><BaseUnit kg=\"1\" m=\"1\" s=\"-2\"/></Unit>\n"
    "    <Unit name=\"N.m\"><BaseUnit kg=\"1\" m=\"2\" s=\"-2\"/></Unit>\n"
    "    <Unit name=\"m\"><BaseUnit m=\"1\"/></Unit>\n"
    "    <Unit name=\"m/s\"><BaseUnit m=\"1\" s=\"-1\"/></Unit>\n"
    "    <Unit name=\"m/s2\"><BaseUnit m=\"1\" s=\"-2\"/></Unit>\n"
    "    <Unit name=\"rad\"><BaseUnit rad=\"1\"/></Unit>\n"
    "    <Unit name=\"rad/s\"><BaseUnit rad=\"1\" s=\"-1\"/></Unit>\n"
    "    <Unit name=\"rad/s2\"><BaseUnit rad=\"1\" s=\"-2\"/></Unit>\n"
    "  </UnitDefinitions>\n";

const char* causality(Kind kind)
{
  switch (kind) {
    case Kind::independent:
      return "independent";
    case Kind::parameter:
      return "parameter";
    case Kind::input:
      return "input";
    case Kind::output:
      return "output";
    default:
      return "local";
  }
}

/// ` initial="..."`, where the kind has one.
const char* initial(Kind kind)
{
  if (kind == Kind::independent || kind == Kind::input) return "";
  const bool is_computed = kind == Kind::output || kind == Kind::derivative;
  return is_computed ? " initial=\"calculated\"" : " initial=\"exact\"";
}

bool has_start(Kind kind)
{
  return kind == Kind::parameter || kind == Kind::input || kind == Kind::state;
}

/// In FMI 2 variables are counted from 1, in FMI 3 told by their value references.
class Writer {
 public:
  Writer(const std::vector<FmuVariable>& variables, FmiVersion version)
      : variables_(variables), version_(version)
  {}

  std::string model_variables() const
  {
    std::string text = "  <ModelVariables>\n";
    for (std::size_t i = 0; i < variables_.size(); ++i) text += variable(i);
    return text + "  </ModelVariables>\n";
  }

  std::string model_structure() const
  {
    const auto is_output = [](const FmuVariable& v) { return v.kind == Kind::output; };
    const auto is_derivative = [](const FmuVariable& v) { return v.kind == Kind::derivative; };
    const auto is_computed = [&](const FmuVariable& v) { return is_output(v) || is_derivative(v); };
    return "  <ModelStructure>\n" + list("Outputs", "Output", is_output) +
           list("Derivatives", "ContinuousStateDerivative", is_derivative) +
           list("InitialUnknowns", "InitialUnknown", is_computed) + "  </ModelStructure>\n";
  }

 private:
  bool is_v2() const { return version_ == FmiVersion::v2; }
  std::size_t number(std::size_t reference) const { return reference + (is_v2() ? 1 : 0); }

  std::string variable(std::size_t reference) const
  {
    const FmuVariable& variable = variables_[reference];
    const std::string common = fmt::format(
        "name=\"{}\" valueReference=\"{}\" description=\"{}\" causality=\"{}\" "
        "variability=\"{}\"{}",
        attribute(variable.name), reference, attribute(variable.description),
        causality(variable.kind), variable.kind == Kind::parameter ? "tunable" : "continuous",
        initial(variable.kind));
    std::string real;
    if (!variable.unit.empty()) real += fmt::format(" unit=\"{}\"", variable.unit);
    if (has_start(variable.kind)) real += fmt::format(" start=\"{}\"", variable.start);
    if (variable.kind == Kind::derivative)
      real += fmt::format(" derivative=\"{}\"", number(variable.derivative_of));
    if (!is_v2()) return fmt::format("    <Float64 {}{}/>\n", common, real);
    return fmt::format("    <ScalarVariable {}><Real{}/></ScalarVariable>\n", common, real);
  }

  std::string unknown(const char* name, std::size_t reference) const
  {
    const FmuVariable& variable = variables_[reference];
    std::string text = fmt::format("    <{} {}=\"{}\"", is_v2() ? "Unknown" : name,
                                   is_v2() ? "index" : "valueReference", number(reference));
    if (!variable.depends_on_all) {
      std::string places;
      for (const std::uint32_t state : variable.depends_on)
        places += fmt::format("{}{}", places.empty() ? "" : " ", number(state));
      text += fmt::format(" dependencies=\"{}\"", places);
    }
    return text + "/>\n";
  }

  std::string list(const char* in_v2, const char* in_v3, auto&& is_of_it) const
  {
    std::string text;
    for (std::size_t i = 0; i < variables_.size(); ++i)
      if (is_of_it(variables_[i])) text += unknown(in_v3, i);
    return is_v2() ? fmt::format("    <{0}>\n{1}    </{0}>\n", in_v2, text) : text;
  }

  const std::vector<FmuVariable>& variables_;
  FmiVersion version_;
};

std::string interfaces(const FmuDescription& of, FmiVersion version)
{
  if (version == FmiVersion::v2) {
    return fmt::format(
        "  <ModelExchange modelIdentifier=\"{0}\" completedIntegratorStepNotNeeded=\"true\" "
        "canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" "
        "canSerializeFMUstate=\"true\" "
        "providesDirectionalDerivative=\"{1}\"/>\n"
        "  <CoSimulation modelIdentifier=\"{0}\" canHandleVariableCommunicationStepSize=\"true\" "
        "canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" "
        "canSerializeFMUstate=\"true\" "
        "providesDirectionalDerivative=\"{1}\"/>\n",
        of.identifier, of.has_directional_derivatives);
  }
  return fmt::format(
      "  <ModelExchange modelIdentifier=\"{0}\" canGetAndSetFMUState=\"true\" "
      "canSerializeFMUState=\"true\" "
      "providesDirectionalDerivatives=\"{1}\"/>\n"
      "  <CoSimulation modelIdentifier=\"{0}\" canGetAndSetFMUState=\"true\" "
      "canSerializeFMUState=\"true\" "
      "canHandleVariableCommunicationStepSize=\"true\" providesDirectionalDerivatives=\"{1}\"/>\n",
      of.identifier, of.has_directional_derivatives);
}

}  // namespace

std::string fmu_description(const std::vector<FmuVariable>& variables,
                            const FmuDescription& description, FmiVersion version)
{
  const bool is_v2 = version == FmiVersion::v2;
  const Writer writer(variables, version);
  return fmt::format(
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
             "<fmiModelDescription fmiVersion=\"{}\" modelName=\"{}\" {}=\"{}\" "
             "generationTool=\"Chladni\" variableNamingConvention=\"structured\"{}>\n",
             is_v2 ? "2.0" : "3.0", attribute(description.name),
             is_v2 ? "guid" : "instantiationToken", description.token,
             is_v2 ? " numberOfEventIndicators=\"0\"" : "") +
         interfaces(description, version) + unit_definitions +
         "  <LogCategories>\n    <Category name=\"logStatusError\"/>\n  </LogCategories>\n" +
         writer.model_variables() + writer.model_structure() + "</fmiModelDescription>\n";
}

namespace {

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
