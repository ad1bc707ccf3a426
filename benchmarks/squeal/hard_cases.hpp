#pragma once

#include <string>

namespace chladni::squeal::bench {

/// All hard cases with their results, as a JSON list of {case, setting, result, reference}.
/// @param smallest  short runs, for tests
std::string hard_cases_json(bool smallest);

}  // namespace chladni::squeal::bench
