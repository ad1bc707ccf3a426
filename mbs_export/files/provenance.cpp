#include "mbs_export/files/provenance.hpp"

#include "mbs_export/files/file_parts.hpp"

namespace chladni::mbs_export::file_parts {

void write_provenance(files::Writer& file, const Provenance& provenance)
{
  file.write("provenance/scene", provenance.scene);
  file.write("provenance/mesh_checksum", provenance.mesh_checksum);
  file.write("provenance/versions", provenance.versions);
  file.write("provenance/options", provenance.options);
  file.write("provenance/ranks", std::int64_t{provenance.ranks}, "1");
  const auto write_if_any = [&](const char* name, const std::string& text) {
    if (!text.empty()) file.write(name, text);
  };
  write_if_any("provenance/reduction_scene", provenance.reduction_scene);
  write_if_any("provenance/body_scene", provenance.body_scene);
  write_if_any("provenance/mesh_file_digest", provenance.mesh_file_digest);
  write_if_any("provenance/scene_file", provenance.scene_file);
}

Provenance read_provenance(const files::Reader& file)
{
  const auto optional_text = [&](const char* name) {
    return file.contains(name) ? file.text(name) : std::string();
  };
  return {.scene = file.text("provenance/scene"),
          .mesh_checksum = file.text("provenance/mesh_checksum"),
          .versions = file.text("provenance/versions"),
          .options = file.text("provenance/options"),
          .ranks = read_count(file, "provenance/ranks"),
          .reduction_scene = optional_text("provenance/reduction_scene"),
          .body_scene = optional_text("provenance/body_scene"),
          .mesh_file_digest = optional_text("provenance/mesh_file_digest"),
          .scene_file = optional_text("provenance/scene_file")};
}

Provenance read_provenance(const std::filesystem::path& file)
{
  return read_provenance(files::Reader(file.string()));
}

}  // namespace chladni::mbs_export::file_parts
