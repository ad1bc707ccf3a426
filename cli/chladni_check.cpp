#include <fmt/format.h>

#include <cmath>

#include "cases/ranks.hpp"
#include "cli/chladni_commands.hpp"
#include "cli/chladni_steps.hpp"
#include "common/error.hpp"
#include "files/hdf5.hpp"
#include "mbs_export/check_body.hpp"
#include "mbs_export/files/body_file.hpp"
#include "mbs_export/files/reduced_file.hpp"
#include "report/output.hpp"

namespace chladni::cli {
namespace {

using mbs_export::Check, mbs_export::Verdict;

std::vector<Check> checks_of(const std::string& path)
{
  const files::Reader file(path);
  const std::string format = file.text_attribute("/", "format");
  if (format == mbs_export::reduced_format) return check_reduced(mbs_export::read_reduced(file));
  if (format == mbs_export::body_format) return check_body(mbs_export::read_body(file));
  throw Error(fmt::format(
      "{}: a file of format '{}' has no checks; *.reduced.h5 and *.body.h5 have", path, format));
}

const char* name_of(Verdict verdict)
{
  if (verdict == Verdict::pass) return "pass";
  return verdict == Verdict::warn ? "warn" : "FAIL";
}

std::string number(double x)
{
  return std::isnan(x) ? "-" : fmt::format("{:.3g}", x);
}

report::TextTable table_of(const std::vector<Check>& checks)
{
  report::TextTable table{.header = {"check", "verdict", "value", "limit"}, .rows = {}};
  for (const Check& check : checks) {
    table.rows.push_back(
        {check.name, name_of(check.verdict), number(check.value), number(check.limit)});
  }
  return table;
}

void write_json(const std::string& file, const std::string& json, const std::vector<Check>& checks)
{
  std::vector<report::Json> list;
  for (const Check& check : checks) {
    list.push_back(report::Json::object({{"check", check.name},
                                         {"verdict", name_of(check.verdict)},
                                         {"value", check.value},
                                         {"limit", check.limit},
                                         {"meaning", check.meaning}}));
  }
  write_summary({.scene = file, .output = {}, .json = json},
                {{"file", file},
                 {"verdict", name_of(mbs_export::worst(checks))},
                 {"checks", report::Json::array(list)}},
                report::cost_so_far({}));
}

void print_checks(const std::string& file, const std::string& json)
{
  const std::vector<Check> checks = checks_of(file);
  write_json(file, json, checks);
  fmt::print("{}\n\n{}", file, report::format_table(table_of(checks)));
  int n_failed = 0;
  for (const Check& check : checks) {
    if (check.verdict == Verdict::pass) continue;
    fmt::print("\n{}: {}: {}", name_of(check.verdict), check.name, check.meaning);
    n_failed += check.verdict == Verdict::fail ? 1 : 0;
  }
  fmt::print("\n");
  if (n_failed > 0)
    throw Error(fmt::format("{}: {} of {} checks failed", file, n_failed, checks.size()));
}

}  // namespace

void check_command(const ChladniArguments& arguments)
{
  cases::on_first_rank([&] { print_checks(arguments.check_file, arguments.check_json); });
}

}  // namespace chladni::cli
