#include <fmt/format.h>

#include <optional>

#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "mbs_export/files/body_file.hpp"
#include "mbs_export/measured/measured_modes.hpp"
#include "mbs_export/measured/modal_assurance.hpp"
#include "report/describe_assurance.hpp"
#include "report/progress.hpp"

namespace chladni::cli {
namespace {

void compare_modes(const MacArguments& arguments)
{
  const mbs_export::ModalBody body = mbs_export::read_body(arguments.body);
  std::optional<double> metres;
  if (!arguments.length_unit.empty()) metres = metres_of(arguments.length_unit);
  const mbs_export::MeasuredModes measured =
      mbs_export::read_measured_modes(arguments.measured, metres);
  for (const std::string& note : measured.notes) report::tell_note(report::printable(note));
  const mbs_export::ModalAssurance found =
      mbs_export::modal_assurance(body, measured, arguments.distance);
  fmt::print("{}\n\n{}\n{}", report::printable(body.title),
             report::format_table(report::list_assurance(measured, found)),
             report::format_table(report::describe(found)));
  write_summary({.scene = arguments.body, .output = {}, .json = arguments.json},
                report::assurance_json(found), report::cost_so_far({}));
}

}  // namespace

void mac_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { compare_modes(arguments.mac); });
}

}  // namespace chladni::cli
