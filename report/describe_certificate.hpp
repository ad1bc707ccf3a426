#pragma once

#include <string>

#include "mbs_export/certificate.hpp"

namespace chladni::report {

/// The certificate of a reduced system as text for the terminal; empty when no error was estimated
/// and no eigenvalue counted.
std::string describe_certificate(const mbs_export::Certificate& certificate);

}  // namespace chladni::report
