#include "mbs_export/files/condensation_file.hpp"

namespace chladni::mbs_export::file_parts {

void write_condensation(files::Writer& file, const std::optional<Condensation>& condensation)
{
  if (!condensation) return;
  file.write("condensation/brake", condensation->brake);
  file.write("condensation/highest", condensation->highest, "rad/s");
  file.write("condensation/tolerance", condensation->tolerance, "1");
  file.write("condensation/error", condensation->error, "1");
}

std::optional<Condensation> read_condensation(const files::Reader& file)
{
  if (!file.contains("condensation/highest")) return std::nullopt;
  Condensation found{.brake = file.text("condensation/brake"),
                     .highest = file.real("condensation/highest"),
                     .tolerance = file.real("condensation/tolerance"),
                     .error = file.real("condensation/error")};
  if (!(found.highest > 0.0)) file.fail("condensation/highest", "expected a positive frequency");
  return found;
}

}  // namespace chladni::mbs_export::file_parts
