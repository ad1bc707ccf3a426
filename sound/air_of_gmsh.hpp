#pragma once

#include <vector>

#include "common/packing.hpp"
#include "sound/air_mesh.hpp"
#include "sound/outline.hpp"

/// A mesh of the air on its way from chladni-mesher, the program in which Gmsh makes it.
namespace chladni::sound {

/// The mesh that is asked for.
struct AirQuestion {
  Outline outline;
  AirMeshOptions options;
  int dimension;  ///< 2: the meridian plane, 3: space
  double centre;  ///< z of the centre of the sphere, m
};

/// Elements of one type. A position has as many numbers as the mesh has dimensions.
struct AirOfGmsh {
  int order;  ///< of the elements
  int nodes_per_element;
  std::vector<double> reference;  ///< [nodes_per_element] positions in the reference cell
  std::vector<double> positions;  ///< [nodes] m
  std::vector<int> elements;      ///< [elements x nodes_per_element] nodes
};

void pack(Packer& packer, const AirQuestion& question);
AirQuestion unpack_question(Unpacker& unpacker);

void pack(Packer& packer, const AirOfGmsh& air);
AirOfGmsh unpack_air(Unpacker& unpacker);

}  // namespace chladni::sound
