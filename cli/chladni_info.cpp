#include <fmt/format.h>

#include "cli/chladni_commands.hpp"
#include "cli/describe.hpp"
#include "cli/petsc_session.hpp"

namespace chladni::cli {

void info_command(const ChladniArguments& arguments)
{
  on_first_rank([&] { fmt::print("{}", describe_file(arguments.info_file)); });
}

}  // namespace chladni::cli
