#pragma once

#include <string>

#include "mbs_export/certificate.hpp"

namespace chladni::report {

/// How good the reduced system is, for people; empty where nobody looked.
std::string describe_certificate(const mbs_export::Certificate& certificate);

}  // namespace chladni::report
