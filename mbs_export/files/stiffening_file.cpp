#include <algorithm>

#include "mbs_export/files/file_parts.hpp"

namespace chladni::mbs_export::file_parts {
namespace {

const std::string group = "stiffening/";

/// Known names, none twice, in their order: what writers write.
void check_loads(const files::Reader& file, const std::vector<std::string>& loads)
{
  auto next = stiffening_loads.begin();
  for (const std::string& load : loads) {
    next = std::find(next, stiffening_loads.end(), load);
    if (next == stiffening_loads.end())
      file.fail(group + "loads", "has an unknown load, or one out of order: \"" + load + "\"");
    ++next;
  }
}

}  // namespace

void write_stiffening(files::Writer& file, const std::optional<Stiffening>& stiffening)
{
  if (!stiffening) return;
  file.write(group + "fixed", stiffening->fixed);
  file.write(group + "loads", stiffening->loads);
  for (std::size_t i = 0; i < stiffening->loads.size(); ++i) {
    const bool is_acceleration = stiffening->loads[i].starts_with("acceleration");
    file.write(group + stiffening->loads[i], stiffening->K[i],
               is_acceleration ? "kg m per units of the two coordinates"
                               : "kg m^2 per units of the two coordinates");
  }
}

std::optional<Stiffening> read_stiffening(const files::Reader& file, Eigen::Index n)
{
  if (!file.contains("stiffening")) return std::nullopt;
  Stiffening stiffening{
      .fixed = file.texts(group + "fixed"), .loads = file.texts(group + "loads"), .K = {}};
  check_loads(file, stiffening.loads);
  for (const std::string& load : stiffening.loads)
    stiffening.K.push_back(file.matrix(group + load, {n, n}));
  return stiffening;
}

}  // namespace chladni::mbs_export::file_parts
