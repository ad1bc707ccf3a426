#pragma once

#include "mbs_export/formats/floating_body.hpp"
#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::test {

/// What tests/data/version_1.reduced.h5 holds: every group of the format with small made-up values.
/// Both files were written once, by the first release of the format; later ones must read them.
ReducedSystem version_1_reduced();

/// What tests/data/version_1.body.h5 holds.
ModalBody version_1_body();

/// The same body as other programs get it: what their golden files, three_nodes.*, hold.
formats::FloatingBody version_1_floating();

}  // namespace chladni::mbs_export::test
