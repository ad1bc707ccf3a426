#pragma once

#include <string>

namespace chladni::squeal::bench {

/// The hard cases with what comes out of them, as a JSON list of {case, setting, result,
/// reference}.
std::string hard_cases_json(bool smallest);

}  // namespace chladni::squeal::bench
