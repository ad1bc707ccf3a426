#pragma once

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"

/// Expectations that two values of the files are equal to the last bit, member by member.
namespace chladni::mbs_export::test {

void expect_equal(const ReducedSystem& a, const ReducedSystem& b);
void expect_equal(const ModalBody& a, const ModalBody& b);

}  // namespace chladni::mbs_export::test
