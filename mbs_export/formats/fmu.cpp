#include "mbs_export/formats/fmu.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/error.hpp"
#include "files/xxh64.hpp"
#include "mbs_export/formats/zip_file.hpp"

namespace chladni::mbs_export::formats {
namespace {

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

std::string bytes_of(const fs::path& path)
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

std::vector<std::string> notes_on(const ModalBody& body, const FmuBody& made)
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
                      {.name = binary, .bytes = bytes_of(library(parts.library))},
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
          .notes = notes_on(body, made)};
}

}  // namespace chladni::mbs_export::formats
