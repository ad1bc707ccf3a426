#include "report/page/pages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "common/files/output_file.hpp"
#include "mbs_export/files/body_files.hpp"
#include "report/describe_body.hpp"
#include "report/describe_responses.hpp"
#include "report/origin.hpp"
#include "report/page/body_page.hpp"
#include "report/page/page.hpp"
#include "report/page/sound.hpp"
#include "report/page/squeal_page.hpp"
#include "report/text_table.hpp"
#include "report/version.hpp"
#include "scene/scene.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::report {

using Eigen::Index;
using mbs_export::FrequencyResponses;
using std::filesystem::path;

namespace {

namespace file_parts = mbs_export::file_parts;

/// What the folder holds of a scene.
struct FoundFiles {
  scene::Scene scene;
  std::optional<mbs_export::ModalBody> body;
  mbs_export::Certificate certificate;
  std::optional<squeal::SquealResults> results;
  Json sound;  ///< null without
};

/// The sound, or why it is left out: the other sections do without it. Null where there is none.
Json sound_of(const ReportSource& source)
{
  const path file = source.folder / (source.scene.name + ".sound.h5");
  if (!exists(file)) return Json();
  const files::Reader reader(file.string());
  const mbs_export::Provenance origin = file_parts::read_provenance(reader);
  try {
    require_of_scene(source.scene, {.file = file, .what = Made::sound, .origin = origin},
                     source.stale);
  } catch (const Error& stale) {
    return Json::object({{"left_out", stale.what()}});
  }
  const auto& sound = source.scene.sound;
  return sound_page(reader, {.file = path(file).replace_extension(".wav"),
                             .microphone = sound && sound->wav ? sound->wav->microphone : ""});
}

FoundFiles find_files(const ReportSource& source)
{
  FoundFiles found{
      .scene = source.scene, .body = {}, .certificate = {}, .results = {}, .sound = {}};
  const auto file = [&](const char* kind) { return source.folder / (found.scene.name + kind); };
  const auto check = [&](const char* kind, Made what, const mbs_export::Provenance& origin) {
    require_of_scene(found.scene, {.file = file(kind), .what = what, .origin = origin},
                     source.stale);
  };
  if (exists(file(".body.h5"))) {
    found.body = mbs_export::read_body(file(".body.h5"));
    check(".body.h5", Made::body, found.body->provenance);
  }
  if (exists(file(".reduced.h5"))) {
    const mbs_export::ReducedSystem reduced = mbs_export::read_reduced(file(".reduced.h5"));
    check(".reduced.h5", Made::reduction, reduced.provenance);
    found.certificate = reduced.certificate;
  }
  if (exists(file(".squeal.h5"))) {
    const files::Reader reader(file(".squeal.h5").string());
    found.results = squeal::read_results(reader);
    check(".squeal.h5", Made::results, file_parts::read_provenance(reader));
  }
  found.sound = sound_of(source);
  if (!found.body && !found.results) {
    throw Error(fmt::format(
        "{}: holds neither {} nor {}; make them with `chladni run {} --output {}` and `squeal run`",
        source.folder.string(), file(".body.h5").filename().string(),
        file(".squeal.h5").filename().string(), found.scene.path, source.folder.string()));
  }
  return found;
}

std::string read_benchmark(const std::string& file)
{
  if (file.empty()) return "null";
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw Error(fmt::format("{}: cannot be read", file));
  const auto json = nlohmann::json::parse(text.str(), nullptr, false);
  if (!json.is_object() || !json.contains("studies") || !json["studies"].is_array()) {
    throw Error(
        fmt::format("{}: must be the end_to_end.json of `./dev bench`; docs/how-to/report.md "
                    "says what is read of it",
                    file));
  }
  return json["studies"].dump();
}

Json provenance_json(const mbs_export::Provenance& origin)
{
  return Json::object({{"mesh_checksum", origin.mesh_checksum},
                       {"versions", origin.versions},
                       {"options", origin.options},
                       {"ranks", origin.ranks}});
}

/// The disc of the study; absent without body or [squeal], or when the study does not fit the body.
std::optional<squeal::Disc> disc_of(const FoundFiles& found)
{
  if (!found.body || !found.scene.squeal) return std::nullopt;
  const squeal::SquealOptions& study = *found.scene.squeal;
  if (found.results) return squeal::make_disc(*found.body, squeal::ring_choice(study), study.modes);
  return std::nullopt;
}

ModeLooks looks_of(const FoundFiles& found, const std::optional<squeal::Disc>& used)
{
  if (!used) return {};
  const squeal::RingChoice rings = squeal::ring_choice(*found.scene.squeal);
  return mode_looks(squeal::make_disc(*found.body, rings, {}), *found.body);
}

/// @throws chladni::Error naming the file when the results are of another body.
std::vector<Motion> motions_of(const FoundFiles& found, const std::optional<squeal::Disc>& disc)
try {
  if (!disc) return {};
  return squeal_motions(*found.results, disc->mode_numbers, found.body->n_modes());
} catch (const Error& error) {
  throw Error(fmt::format("{}.squeal.h5: {}", found.scene.name, error.what()));
}

std::vector<Json::Member> body_members(const FoundFiles& found,
                                       const std::optional<squeal::Disc>& disc,
                                       const ModeLooks& looks)
{
  const std::vector<Motion> motions = motions_of(found, disc);
  return {{"surface", shapes_json(*found.body, motions)},
          {"modes", modes_json(*found.body, found.certificate, looks)},
          {"certified_support", texts(found.certificate.fixed)},
          {"support", texts(found.body->fixed)},
          {"counts", counts_json(found.certificate)},
          {"selection", selection_json(*found.body)},
          {"provenance", provenance_json(found.body->provenance)}};
}

Json content_of(const FoundFiles& found, const std::string& label)
{
  const std::optional<squeal::Disc> disc = disc_of(found);
  const ModeLooks looks = looks_of(found, disc);
  std::vector<Json::Member> members{{"title", found.scene.title},
                                    {"label", label},
                                    {"version", version},
                                    {"scene", found.scene.text}};
  std::vector<Json> tables;
  if (found.body) {
    tables.push_back(table_json("Modal body", describe(*found.body)));
    for (Json::Member& member : body_members(found, disc, looks))
      members.push_back(std::move(member));
  }
  if (found.results) {
    tables.push_back(table_json("Squeal", describe(*found.results)));
    for (Json::Member& member : squeal_members(*found.results, looks))
      members.push_back(std::move(member));
  }
  if (found.sound.text() != "null") members.emplace_back("sound", found.sound);
  members.emplace_back("tables", Json::array(tables));
  return Json::object(members);
}

}  // namespace

void declare_report(CLI::App& app, ReportArguments& arguments)
{
  CLI::App* report = app.add_subcommand(
      "report",
      "writes a page with pictures of a body, its squeal and its sound: NAME.report.html");
  report
      ->add_option("SCENE", arguments.scenes,
                   "the scene file (TOML); several are compared, in NAME.comparison.html")
      ->required();
  report
      ->add_option("--output", arguments.outputs,
                   "folder of the scene's files, and of the report; once for each scene, or for "
                   "each run of one scene")
      ->type_name("DIR")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->default_str(".");
  report
      ->add_option("--benchmark", arguments.benchmark,
                   "also draws speed against error from the end_to_end.json of ./dev bench")
      ->type_name("FILE");
  report->add_flag("--stale", arguments.stale,
                   "also shows files that were made before the scene changed");
  report->footer(
      fmt::format("Example (after `chladni run` and `squeal run` with the same SCENE and DIR):\n"
                  "  {0} report scene.toml --output out\n"
                  "  {0} report scene.toml stiffer.toml --output out     (compares the two)\n"
                  "The page opens in any browser and loads nothing from elsewhere.",
                  app.get_name()));
}

std::string report_html(const ReportSource& source, std::string_view benchmark)
{
  const FoundFiles found = find_files(source);
  return report_page(found.scene.title, content_of(found, found.scene.title), benchmark);
}

std::string comparison_html(const std::vector<ReportSource>& sources, std::string_view benchmark)
{
  const std::vector<std::string> labels = labels_of(sources);
  std::vector<Json> runs;
  for (std::size_t i = 0; i < sources.size(); ++i)
    runs.push_back(content_of(find_files(sources[i]), labels[i]));
  const std::string title = fmt::format("{}", fmt::join(labels, " beside "));
  const Json content =
      Json::object({{"title", title}, {"version", version}, {"runs", Json::array(runs)}});
  return report_page(title, content, benchmark);
}

void write_report(const ReportArguments& arguments)
{
  const std::vector<ReportSource> sources = runs_of(arguments);
  const std::string benchmark = read_benchmark(arguments.benchmark);
  const ReportSource& first = sources.front();
  const bool is_one = sources.size() == 1;
  const std::string page =
      is_one ? report_html(first, benchmark) : comparison_html(sources, benchmark);
  const path file =
      first.folder / (first.scene.name + (is_one ? ".report.html" : ".comparison.html"));
  files::write_text(file, page);
  fmt::print("wrote {}, {:.1f} MB\n", file.string(), static_cast<double>(page.size()) / 1e6);
}

std::vector<ReportSource> runs_of(const ReportArguments& arguments)
{
  const std::size_t n_scenes = arguments.scenes.size(), n_folders = arguments.outputs.size();
  if (n_scenes > 1 && n_folders > 1 && n_scenes != n_folders) {
    throw Error(
        fmt::format("report: {} scenes and {} folders; name one folder for all scenes, or "
                    "one for each (--output once for each)",
                    n_scenes, n_folders));
  }
  std::vector<ReportSource> sources;
  for (std::size_t i = 0; i < std::max(n_scenes, n_folders); ++i) {
    sources.push_back({.scene = scene::read_scene(arguments.scenes[n_scenes > 1 ? i : 0]),
                       .folder = arguments.outputs[n_folders > 1 ? i : 0],
                       .stale = arguments.stale ? Stale::use : Stale::refuse});
  }
  return sources;
}

std::vector<std::string> labels_of(const std::vector<ReportSource>& sources)
{
  using Label = std::function<std::string(const ReportSource&)>;
  const std::vector<Label> choices{
      [](const ReportSource& source) { return source.scene.title; },
      [](const ReportSource& source) { return source.folder.string(); },
      [](const ReportSource& source) { return source.scene.path; },
      [](const ReportSource& source) {
        return fmt::format("{} in {}", source.scene.path, source.folder.string());
      }};
  std::vector<std::string> labels(sources.size());
  for (const Label& label : choices) {
    std::ranges::transform(sources, labels.begin(), label);
    const std::set<std::string> different(labels.begin(), labels.end());
    if (different.size() == sources.size() && !different.contains("")) break;
  }
  return labels;
}

namespace {

constexpr Index most_curves = 24;  // of each load, to keep the page small

/// The measured response of a load and an output, the first one in the file; none without any.
const mbs_export::MeasuredResponse* measured_of(const FrequencyResponses& responses,
                                                std::size_t load, Index output)
{
  for (const mbs_export::MeasuredResponse& one : responses.measured.functions)
    if (one.load == load && one.output == output) return &one;
  return nullptr;
}

/// The outputs that are drawn for a load, in their order: measured ones, then the largest.
std::vector<Index> drawn(const FrequencyResponses& responses, std::size_t load)
{
  std::vector<Index> outputs(responses.outputs.size());
  std::iota(outputs.begin(), outputs.end(), 0);
  if (std::ssize(outputs) <= most_curves) return outputs;
  std::ranges::stable_sort(outputs, std::ranges::greater{}, [&](Index output) {
    return std::pair(measured_of(responses, load, output) != nullptr,
                     peak_of(responses, load, output).amplitude);
  });
  outputs.resize(most_curves);
  std::ranges::sort(outputs);
  return outputs;
}

std::vector<Json::Member> amplitude_and_phase(const Eigen::VectorXcd& H)
{
  return {{"amplitude", rounded(Eigen::VectorXd(H.cwiseAbs()))},
          {"phase", rounded(Eigen::VectorXd(H.array().arg() * (180.0 / std::numbers::pi)))}};
}

Json curve_json(const FrequencyResponses& responses, std::size_t load, Index output)
{
  const auto& point = responses.outputs[static_cast<std::size_t>(output)];
  std::vector<Json::Member> members = amplitude_and_phase(responses.H[load].col(output));
  members.push_back({"name", point.name});
  members.push_back({"unit", unit_of(responses.quantity, point, responses.loads[load])});
  if (const auto* const measured = measured_of(responses, load, output))
    members.push_back({"measured", Json::object(amplitude_and_phase(measured->H))});
  return Json::object(members);
}

Json load_json(const FrequencyResponses& responses, std::size_t load)
{
  std::vector<Json> curves;
  for (const Index output : drawn(responses, load))
    curves.push_back(curve_json(responses, load, output));
  return Json::object({{"name", responses.loads[load].name},
                       {"curves", Json::array(curves)},
                       {"left_out", responses.outputs.size() - curves.size()}});
}

/// Whether the frequencies multiply from one to the next rather than add.
bool is_logarithmic(const Eigen::VectorXd& Omega)
{
  const Index n = Omega.size();
  return n > 2 && Omega[0] > 0.0 && Omega[n - 1] - Omega[n - 2] > 1.5 * (Omega[1] - Omega[0]);
}

}  // namespace

std::string responses_page(const FrequencyResponses& responses)
{
  std::vector<Json> loads;
  for (std::size_t l = 0; l < responses.loads.size(); ++l) loads.push_back(load_json(responses, l));
  const Json drawing = Json::object(
      {{"quantity", name_of(responses.quantity)},
       {"model", name_of(responses.model)},
       {"logarithmic", is_logarithmic(responses.Omega) ? 1 : 0},
       {"frequency_Hz", rounded(Eigen::VectorXd(responses.Omega / (2.0 * std::numbers::pi)))},
       {"loads", Json::array(loads)}});
  std::vector<Json> tables{table_json("Responses", describe(responses)),
                           table_json("Largest amplitudes", list_peaks(responses))};
  if (!responses.measured.functions.empty())
    tables.push_back(table_json("Measured responses", list_measured(responses)));
  const Json content = Json::object({{"title", responses.title},
                                     {"version", version},
                                     {"responses", drawing},
                                     {"tables", Json::array(tables)},
                                     {"mesh_checksum", responses.provenance.mesh_checksum},
                                     {"scene", responses.provenance.scene}});
  return report_page(responses.title, content, "null");
}

}  // namespace chladni::report
