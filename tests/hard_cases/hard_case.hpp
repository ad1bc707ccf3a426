#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/error.hpp"

namespace chladni::hard_cases {

/// A case that breaks methods which work on easy ones: what makes it hard, the error that is
/// measured, and the limit that it must keep.
struct HardCase {
  std::string area;      ///< "elements", "reduction", ...
  std::string name;      ///< of the case
  std::string hard;      ///< what makes it hard
  std::string measured;  ///< what `measure` returns, with its unit
  double limit;          ///< measured <= limit passes
  std::function<double()> measure;
  std::string fails_because = {};  ///< of a case that is known to fail: why
};

std::vector<HardCase> element_cases();
std::vector<HardCase> vibration_cases();
std::vector<HardCase> coupling_cases();
std::vector<HardCase> reduction_cases();
std::vector<HardCase> body_cases();
std::vector<HardCase> contact_cases();
std::vector<HardCase> integration_cases();
std::vector<HardCase> sound_cases();
std::vector<HardCase> file_cases();

/// |value / exact - 1|
double relative_error(double value, double exact);

/// 0 when `statement` throws a chladni::Error that contains all words, the number of words missing
/// otherwise; without an error one more than there are words.
template <class Statement>
double words_missing(Statement statement, const std::vector<std::string>& words)
{
  try {
    statement();
  } catch (const Error& error) {
    double missing = 0.0;
    for (const std::string& word : words)
      missing += std::string(error.what()).find(word) == std::string::npos;
    return missing;
  }
  return double(words.size()) + 1.0;
}

}  // namespace chladni::hard_cases
