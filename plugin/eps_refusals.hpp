#pragma once

#include <slepceps.h>

#include <span>

/// What the solver type "blocklanczos" does not do, and why: one table for EPSSetUp, for -help and
/// for docs/how-to/plugin.md.
namespace chladni::plugin {

struct Refusal {
  const char* what;    ///< as a user asks for it
  const char* reason;  ///< and what to do instead
  bool (*is_asked)(EPS eps);
};

std::span<const Refusal> refusals();

/// @throws chladni::Error for the first row that the EPS asks for. Call it from EPSSetUp.
void refuse_what_is_not_there(EPS eps);

}  // namespace chladni::plugin
