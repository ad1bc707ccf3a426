#include <fmt/format.h>

#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "report/describe.hpp"

namespace chladni::cli {

void info_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { fmt::print("{}", report::describe_file(arguments.info_file)); });
}

}  // namespace chladni::cli
