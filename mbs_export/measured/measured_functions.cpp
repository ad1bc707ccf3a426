#include "mbs_export/measured/measured_functions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mbs_export/measured/function_58.hpp"
#include "mbs_export/measured/record_reader.hpp"
#include "mbs_export/measured/universal_geometry.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index;

/// What a file says of responses and points.
struct FileOfFunctions {
  UniversalGeometry geometry;
  std::vector<Function58> functions;
  std::map<int, int> left_out;            ///< numbers of datasets, and how many of each
  std::map<std::string, int> unsuitable;  ///< why functions are none that can be compared
};

FileOfFunctions read_functions(const std::filesystem::path& path)
{
  FileOfFunctions contents;
  for (const UniversalDataset& dataset : read_universal_datasets(path)) {
    RecordReader records(path, dataset);
    if (dataset.number == 58) {
      auto function = read_function_58(records, dataset);
      if (function.why_not.empty())
        contents.functions.push_back(std::move(function));
      else
        ++contents.unsuitable[function.why_not];
    } else if (dataset.binary || !contents.geometry.take(records, dataset)) {
      ++contents.left_out[dataset.number];
    }
  }
  return contents;
}

std::vector<std::string> notes_on(const std::string& file, const FileOfFunctions& contents)
{
  std::vector<std::string> notes;
  for (const auto& [why, n] : contents.unsuitable)
    notes.push_back(fmt::format("{}: left out: {} {} (dataset 58)", file, n, why));
  std::string numbers;
  for (const auto& [number, n] : contents.left_out)
    numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", number);
  if (!numbers.empty()) notes.push_back(fmt::format("{}: datasets not read: {}", file, numbers));
  if (!contents.geometry.units()) {
    const Function58& one = contents.functions.front();
    notes.push_back(fmt::format(
        "{}: no units (dataset 164), so that values are taken for SI; the first function "
        "has '{}' per '{}' at its axes",
        file, one.unit_of_output, one.unit_of_load));
  }
  return notes;
}

void require_same_frequencies(const std::string& file, const std::vector<Function58>& functions)
{
  const Function58& first = functions.front();
  for (const Function58& one : functions) {
    // Six digits of single precision.
    const bool is_same =
        one.f_Hz.size() == first.f_Hz.size() &&
        (one.f_Hz - first.f_Hz).cwiseAbs().maxCoeff() <= 1e-5 * first.f_Hz.cwiseAbs().maxCoeff();
    if (is_same) continue;
    throw Error(
        fmt::format("{}:{}: dataset 58: its {} frequencies are others than the {} of the function "
                    "in line {}; write functions of different frequencies into files of their own",
                    file, one.line, one.f_Hz.size(), first.f_Hz.size(), first.line));
  }
}

/// What turns values of the file into those of the SI. An angle has no unit of length.
double scale_of(const UniversalUnits& units, const MeasuredDof& output, const MeasuredDof& load)
{
  const double motion = output.component < 3 ? units.metres : 1.0;
  return motion / (load.component < 3 ? units.newtons : units.newtons * units.metres);
}

MeasuredFunction in_si(const Function58& one, const UniversalGeometry& geometry)
{
  MeasuredFunction function{.line = one.line,
                            .name = one.name,
                            .output = {one.output.node, std::abs(one.output.direction) - 1},
                            .load = {one.load.node, std::abs(one.load.direction) - 1},
                            .quantity = one.quantity,
                            .H = one.H};
  const double scale =
      geometry.units() ? scale_of(*geometry.units(), function.output, function.load) : 1.0;
  const bool is_reversed = (one.output.direction < 0) != (one.load.direction < 0);
  function.H *= is_reversed ? -scale : scale;
  return function;
}

std::map<std::int64_t, MeasuredPlace> places_of(const std::string& file,
                                                const FileOfFunctions& contents,
                                                std::optional<double> metres)
{
  std::map<std::int64_t, MeasuredPlace> places;
  const UniversalGeometry& geometry = contents.geometry;
  if (geometry.nodes().empty()) return places;
  if (geometry.units()) metres = geometry.units()->metres;
  if (!metres) {
    throw Error(fmt::format(
        "{}: has nodes and does not say their unit of length (dataset 164); give --length-unit",
        file));
  }
  std::set<std::int64_t> used;
  for (const Function58& one : contents.functions) used.insert({one.output.node, one.load.node});
  for (const std::int64_t number : used) {
    const auto found = geometry.nodes().find(number);
    if (found == geometry.nodes().end()) continue;
    places.emplace(number, MeasuredPlace{*metres * found->second.position,
                                         geometry.is_in_global_axes(found->second)});
  }
  return places;
}

}  // namespace

MeasuredFunctions read_measured_functions(const std::filesystem::path& path,
                                          std::optional<double> metres)
{
  const FileOfFunctions contents = read_functions(path);
  if (contents.functions.empty()) {
    std::string others;
    for (const auto& [why, n] : contents.unsuitable) others += fmt::format("; {} {}", n, why);
    throw Error(fmt::format(
        "{}: has no frequency response for a load at a node (dataset 58 of type 4){}; write the "
        "responses to forces with nodes and directions",
        path.string(), others));
  }
  require_same_frequencies(path.string(), contents.functions);
  MeasuredFunctions measured{.file = path.string(),
                             .f_Hz = contents.functions.front().f_Hz,
                             .functions = {},
                             .nodes = places_of(path.string(), contents, metres),
                             .notes = notes_on(path.string(), contents)};
  for (const Function58& one : contents.functions)
    measured.functions.push_back(in_si(one, contents.geometry));
  return measured;
}

MeasuredFunctions within(const MeasuredFunctions& measured, double from_Hz, double to_Hz)
{
  const auto& f = measured.f_Hz;
  const auto first = std::ranges::lower_bound(f, from_Hz),
             last = std::ranges::upper_bound(f, to_Hz);
  const Index n = last - first;
  if (n < 2) {
    throw Error(fmt::format(
        "{}: has {} of its frequencies, {:.6g} to {:.6g} Hz, within the range of {:.6g} to {:.6g} "
        "Hz that [response] asks for (from_Hz, to_Hz); two or more are needed",
        measured.file, std::max<Index>(n, 0), f[0], f[f.size() - 1], from_Hz, to_Hz));
  }
  MeasuredFunctions part = measured;
  part.f_Hz = f.segment(first - f.begin(), n);
  part.functions.clear();
  for (const MeasuredFunction& one : measured.functions) {
    part.functions.push_back(one);
    part.functions.back().H = one.H.segment(first - f.begin(), n);
    if (one.H.segment(first - f.begin(), n).cwiseAbs().maxCoeff() > 0.0) continue;
    part.functions.pop_back();
    part.notes.push_back(
        fmt::format("{}:{}: left out: a function that is zero from {:.6g} to {:.6g} "
                    "Hz (dataset 58)",
                    measured.file, one.line, from_Hz, to_Hz));
  }
  if (part.functions.empty()) {
    throw Error(fmt::format("{}: all its functions are zero from {:.6g} to {:.6g} Hz",
                            measured.file, from_Hz, to_Hz));
  }
  return part;
}

}  // namespace chladni::mbs_export
