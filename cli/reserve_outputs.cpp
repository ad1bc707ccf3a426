#include "cli/reserve_outputs.hpp"

#include "report/output.hpp"

namespace chladni::cli {

ReservedOutputs reserve_outputs(const SceneArguments& arguments,
                                const std::vector<std::filesystem::path>& files)
{
  if (!files.empty()) report::make_folder(arguments.output);
  ReservedOutputs reserved;
  for (const std::filesystem::path& file : files) reserved.push_back(files::lock_output(file));
  if (!arguments.json.empty()) reserved.push_back(files::lock_output(arguments.json));
  return reserved;
}

}  // namespace chladni::cli
