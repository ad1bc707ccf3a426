#pragma once

#include <string>
#include <vector>

#include "mbs_export/measured/measured_modes.hpp"
#include "mbs_export/responses/frequency_responses.hpp"
#include "report/json.hpp"
#include "report/text_table.hpp"

/// Frequency responses as `chladni response` and `chladni info` report them.

namespace chladni::report {

/// The largest amplitude of a response over the frequency range.
struct Peak {
  double amplitude;
  double f_Hz;
};

/// The peak of one output (column) of the responses to one load.
Peak peak_of(const mbs_export::FrequencyResponses& responses, std::size_t load,
             Eigen::Index output);

/// A table with model, quantity, range, damping, and the numbers of loads and outputs.
TextTable describe(const mbs_export::FrequencyResponses& responses);

/// The peak of each output for each load, at most the 40 largest.
TextTable list_peaks(const mbs_export::FrequencyResponses& responses);

/// The FRAC of each measured response with the computed one, and how large this is beside it; at
/// most the 40 that agree least.
TextTable list_measured(const mbs_export::FrequencyResponses& responses);

/// JSON members `model`, `quantity`, `damping`, `loss_factor`, `frequencies_Hz` (first and last),
/// `n_frequencies`, `loads`, `outputs`, and `peaks`: for each load and output `load`, `output`,
/// `unit`, `amplitude`, `frequency_Hz`. With measured responses also `measured_file` and
/// `measured`: for each `load`, `output`, `name`, `line` in the file, `frac`, `amplitude_ratio`.
std::vector<Json::Member> responses_json(const mbs_export::FrequencyResponses& responses);

}  // namespace chladni::report

/// The report of `chladni mac`: measured mode shapes compared with a body's modes.

namespace chladni::report {

/// For each measured mode the most similar mode of the body: both frequencies, their difference,
/// the MAC, and the second largest MAC.
TextTable list_assurance(const mbs_export::MeasuredModes& measured,
                         const mbs_export::ModalAssurance& found);

/// The numbers of compared nodes and components, and the distances between paired nodes.
TextTable describe(const mbs_export::ModalAssurance& found);

/// JSON members `measured_Hz`, `body_modes`, `body_Hz`, `mac` (a row for each measured mode),
/// `n_components`, and `nodes` with `node`, `position`, `distance_m`.
std::vector<Json::Member> assurance_json(const mbs_export::ModalAssurance& found);

}  // namespace chladni::report
