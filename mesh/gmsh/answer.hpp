#pragma once

#include <string>

#include "common/packing.hpp"

namespace chladni::mesh {

/// What `made_by_mesher` and `declarations` ask chladni-mesher for, in that program.
/// @param subject  of the question: the mesh of the options, or the declarations of a deck
/// @throws chladni::Error with what is wrong with the options or the file.
void answer(const std::string& subject, Unpacker& question, Packer& answer);

}  // namespace chladni::mesh
