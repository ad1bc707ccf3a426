#include "cli/declare_measurements.hpp"

#include <CLI/CLI.hpp>

namespace chladni::cli {

void declare_length_unit(CLI::App& app, std::string& unit)
{
  app.add_option("--length-unit", unit, "unit of length of a deck, .unv, .med or .vtu file")
      ->type_name("UNIT")
      ->check(CLI::IsMember({"m", "cm", "mm", "inch"}));
}

void declare_mac(CLI::App& app, MacArguments& arguments)
{
  CLI::App* mac = app.add_subcommand("mac", "compares measured mode shapes with those of a body");
  mac->add_option("BODY", arguments.body, "*.body.h5")->required();
  mac->add_option("MEASURED", arguments.measured,
                  "universal file with modes (55) and nodes (15, 2411)")
      ->required();
  mac->add_option("--distance", arguments.distance,
                  "largest distance from a measured node to its node of the body, m")
      ->type_name("METRES")
      ->check(CLI::PositiveNumber)
      ->required();
  declare_length_unit(*mac, arguments.length_unit);
  mac->add_option("--json", arguments.json, "writes the MAC matrix as JSON")->type_name("FILE");
  mac->footer(
      "Example:\n  chladni mac out/disc.body.h5 modes.unv --distance 0.002 --json mac.json");
}

void declare_response(CLI::App& response, ResponseChoice& choice)
{
  response
      .add_option("--uff", choice.universal_file,
                  "also writes the responses to a universal file (datasets 58, 2411, 164)")
      ->type_name("FILE");
  CLI::Option* const measured =
      response
          .add_option("--measured", choice.measured,
                      "compares with the frequency responses of a universal file (dataset 58), at "
                      "its frequencies from from_Hz to to_Hz")
          ->type_name("FILE");
  response
      .add_option("--distance", choice.distance,
                  "largest distance from a measured node to a load or output, m")
      ->type_name("METRES")
      ->check(CLI::PositiveNumber)
      ->needs(measured);
  declare_length_unit(response, choice.length_unit);
  response.get_option("--length-unit")->needs(measured);
}

}  // namespace chladni::cli
