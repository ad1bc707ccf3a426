// Runs every hard case and writes the table of them.
//
// usage: hard_case_table [--markdown FILE] [--json FILE]
//
// Ends with 1 when a case does not keep its limit, or when one that is known to fail does.
#include <fmt/format.h>
#include <slepcsys.h>

#include <chrono>
#include <fstream>
#include <map>

#include "hard_case.hpp"

namespace {

using chladni::hard_cases::HardCase;

struct Outcome {
  HardCase of;
  double measured;
  double seconds;
  std::string error;

  bool passes() const { return measured <= of.limit; }
  bool as_expected() const { return passes() == of.fails_because.empty(); }
};

Outcome outcome(const HardCase& of)
{
  const auto start = std::chrono::steady_clock::now();
  double measured = std::nan("");
  std::string error;
  try {
    measured = of.measure();
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return {of, measured, seconds.count(), error};
}

void add(std::vector<Outcome>& outcomes, const std::vector<HardCase>& cases)
{
  for (const HardCase& of : cases) {
    outcomes.push_back(outcome(of));
    const Outcome& last = outcomes.back();
    fmt::print("{} {:<13} {}: {:.2g} (limit {:.2g}), {:.1f} s {}\n",
               last.passes() ? "pass" : "FAIL", of.area, of.name, last.measured, of.limit,
               last.seconds, last.error);
  }
}

/// A power of ten above the value: what stays the same on another machine.
std::string rounded(double value)
{
  if (value == 0.0 || !std::isfinite(value)) return fmt::format("{:g}", value);
  return value < 0.0 ? fmt::format("{:.0e}", value)
                     : fmt::format("< {:.0e}", std::pow(10.0, std::floor(std::log10(value)) + 1.0));
}

std::string markdown(const std::vector<Outcome>& outcomes)
{
  std::size_t n_passed = 0;
  for (const Outcome& each : outcomes) n_passed += each.passes();
  std::string text = fmt::format(
      "# Hard cases\n\nWritten by the test program `hard_case_table` (`./dev hard-cases`): {} "
      "cases, {} "
      "of them pass. What is measured is given as\nthe next power of ten, which does not depend on "
      "the machine; a count is given as it is.\n\n"
      "| area | case | what makes it hard | measured | value | limit | |\n"
      "|---|---|---|---|---|---|---|\n",
      outcomes.size(), n_passed);
  for (const Outcome& each : outcomes) {
    const HardCase& of = each.of;
    text += fmt::format("| {} | {} | {} | {} | {} | {:.2g} | {} |\n", of.area, of.name, of.hard,
                        of.measured, rounded(each.measured), of.limit,
                        each.passes() ? "pass" : "**fails**: " + of.fails_because + each.error);
  }
  return text;
}

std::string json(const std::vector<Outcome>& outcomes)
{
  std::string text = "[\n";
  for (const Outcome& each : outcomes) {
    text += fmt::format(
        "{}{{\"area\": \"{}\", \"name\": \"{}\", \"measured\": {}, \"limit\": {:.3g}, \"seconds\": "
        "{:.2f}, \"pass\": {}}}",
        text.size() > 2 ? ",\n" : "", each.of.area, each.of.name,
        std::isfinite(each.measured) ? fmt::format("{:.6g}", each.measured) : "null", each.of.limit,
        each.seconds, each.passes());
  }
  return text + "\n]\n";
}

}  // namespace

int main(int argc, char** argv)
{
  using namespace chladni::hard_cases;
  std::map<std::string, std::string> files;
  for (int i = 1; i + 1 < argc; i += 2) files[argv[i]] = argv[i + 1];
  std::vector<Outcome> outcomes;
  add(outcomes, file_cases());  // these fork, which MPI does not allow
  int n_arguments = 1;
  SlepcInitialize(&n_arguments, &argv, nullptr, nullptr);
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  for (const auto& cases : {element_cases(), coupling_cases(), vibration_cases(), reduction_cases(),
                            body_cases(), contact_cases(), integration_cases(), sound_cases()})
    add(outcomes, cases);
  SlepcFinalize();
  if (files.contains("--markdown")) std::ofstream(files["--markdown"]) << markdown(outcomes);
  if (files.contains("--json")) std::ofstream(files["--json"]) << json(outcomes);
  int n_unexpected = 0;
  for (const Outcome& each : outcomes) n_unexpected += !each.as_expected();
  fmt::print("{} hard cases, {} not as expected\n", outcomes.size(), n_unexpected);
  return n_unexpected > 0;
}
