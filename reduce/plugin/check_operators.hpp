#pragma once

#include <optional>
#include <string>

#include "common/petsc.hpp"

namespace chladni::reduce::plugin {

/// Throws the first complaint that any rank has, on all ranks.
/// @note   Collective.
void agree(MPI_Comm comm, const std::optional<std::string>& complaint);

/// An operator as AIJ: a reference where it is AIJ, else a converted copy.
/// @note   Collective.
/// @throws chladni::Error on all ranks when A has not the rows and columns of `like`, is not
/// assembled, has a value that is not finite or a negative diagonal value, or is not symmetric.
petsc::Matrix checked_operator(Mat A, Mat like, const char* name);

}  // namespace chladni::reduce::plugin
