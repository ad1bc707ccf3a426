#pragma once

#include <string>
#include <vector>

#include "mbs_export/responses/frequency_responses.hpp"
#include "report/json.hpp"
#include "report/output.hpp"

/// What `chladni response` and `chladni info` tell of frequency responses.
namespace chladni::report {

/// The largest amplitude over the range.
struct Peak {
  double amplitude;
  double f_Hz;
};

/// Of one column of a load's responses.
Peak peak_of(const mbs_export::FrequencyResponses& responses, std::size_t load,
             Eigen::Index output);

/// Model, quantity, range, damping, numbers of loads and outputs.
TextTable describe(const mbs_export::FrequencyResponses& responses);

/// The largest amplitude of each output for each load, the largest 40 of them.
TextTable list_peaks(const mbs_export::FrequencyResponses& responses);

/// Members `model`, `quantity`, `damping`, `loss_factor`, `frequencies_Hz` (ends), `n_frequencies`,
/// `loads`, `outputs`, and `peaks`: for each load and output `load`, `output`, `unit`, `amplitude`,
/// `frequency_Hz`.
std::vector<Json::Member> responses_json(const mbs_export::FrequencyResponses& responses);

}  // namespace chladni::report
