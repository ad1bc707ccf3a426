#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/decks/deck.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// The formats whose element types are known here; Gmsh tells its own.
enum class Format { nastran, abaqus, unv, med, ansys };

/// How an element of a file is used.
enum class ElementUse {
  full,     ///< as it is
  reduced,  ///< by the element of full integration that it comes from
  marking   ///< it has no stiffness here: its nodes mark a face or an edge
};

/// What an element type of a file is.
struct FileElement {
  Shape shape;
  int order;
  std::size_t n_nodes;  ///< that the file lists
  ElementUse use;
  std::vector<int> places;  ///< in the element, of each node in the order of the file
  std::size_t n_places;     ///< of the element
};

/// The types that a format calls by this name; they differ in the number of nodes. Empty if the
/// name is not known.
const std::vector<FileElement>& file_elements(Format format, std::string_view name);

/// The element of this shape and order with its nodes in the order of a format.
const FileElement& file_element(Format format, Shape shape, int order);

/// The names of the types of a format that have stiffness here: "S3, S3R, ... and C3D20R".
std::string names_of_elements(Format format);

/// The element of a file, by its nodes in the order of the file; 0 for a node that the file leaves
/// out. Nodes on the faces and inside of solids are left out.
/// @param nodes  `n_nodes` of them, or 8 of a quadrilateral of order 2
DeckElement deck_element(const FileElement& type, std::int64_t number,
                         const std::vector<std::int64_t>& nodes, int group);

/// What an error says of solids that Chladni does not have.
extern const char* const no_such_solid;

}  // namespace chladni::mesh
