#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/packing.hpp"
#include "mesh/generators.hpp"
#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Calls `build` in a Gmsh session with quadrilateral recombination, meshes the model in two
/// dimensions if it has no elements yet, and returns the mesh. Where elements of such a mesh lie on
/// one another or are folded, other options of Gmsh are tried, and a note says which helped. What
/// Gmsh prints is not for the user.
/// @param order        of the elements; 0 keeps that of the model
/// @param options  groups with sections, and coupled ones; curves of other groups than
///                 `line_groups` give groups of nodes only
/// @throws chladni::Error with Gmsh's message.
Mesh mesh_with_gmsh(const std::function<void()>& build, int order, const MeshOptions& options = {});

/// Sizes of elements that grow with the distance from places of small ones.
class GradedSizes {
 public:
  /// @param places  with the largest size of elements there; at least one
  explicit GradedSizes(std::vector<SizeAt> places);

  /// The largest size at a point: the least of the size at a place and what it may grow by on the
  /// way.
  double at(const std::array<double, 3>& x) const;

 private:
  std::vector<SizeAt> places_;  ///< ascending by the first coordinate
  double smallest_;             ///< m, of the sizes
};

/// Makes the elements of the open model of Gmsh no larger than the options allow at their places.
/// What the model says itself still holds where it is smaller.
/// @param unit  of the model, m
void set_local_sizes(const MeshOptions& options, double unit);

}  // namespace chladni::mesh

/// The meshes of generators whose elements Gmsh makes, of options that were checked, without the
/// groups of rings and corners.
/// @throws chladni::Error when Gmsh fails.

namespace chladni::mesh {

Mesh unstructured_annulus(const AnnulusOptions& options);
Mesh unstructured_hat_disc(const HatDiscOptions& options);
Mesh unstructured_patch(const FourEdges& patch, const PatchOptions& options);

/// A circle of Gmsh's model about an axis along z, divided into equal arcs. The first arc begins at
/// the angle 0, on the x side of the axis.
struct Circle {
  double radius;            ///< m
  int n_elements;           ///< number of elements of each arc
  std::vector<int> points;  ///< tags in Gmsh
  std::vector<int> arcs;    ///< tags in Gmsh
};

/// Radius, centre and number of arcs of a circle.
struct CirclePlace {
  double radius;                      ///< m
  std::array<double, 3> centre = {};  ///< m
  int n_arcs = 4;
};

/// Adds a circle with elements of about `size` [m], at least 12 of them: a cubic edge of 90 degrees
/// folds its element over.
Circle add_circle(const CirclePlace& place, double size);

/// Adds a circle with as many arcs and elements as `like`.
Circle add_circle(const CirclePlace& place, const Circle& like);

/// Adds rows and columns of elements between two circles with equal arcs; across the rows elements
/// have about `size` [m].
/// @return tags of the surfaces
std::vector<int> add_rows(const Circle& first, const Circle& last, double size);

/// Adds a plane surface between an outer circle and holes in it.
/// @return tag of the surface
int add_plane(const Circle& outer, const std::vector<Circle>& holes);

/// Adds the surfaces between neighbours among `circles`, which have one axis and ascend by radius:
/// rows and columns between circles at the distance `row` [m], unstructured elements elsewhere.
/// @return tags of the surfaces
std::vector<int> add_rings_of_elements(const std::vector<Circle>& circles, double size, double row);

/// Sets one element size [m] everywhere and whether elements are triangles, by `pattern`.
void set_element_size(double size, Pattern pattern);

/// Adds a named physical group of entities of one dimension, given by their tags.
void add_physical_group(int dimension, const std::vector<int>& entities, const std::string& name);

}  // namespace chladni::mesh

/// The treatment of each format that Gmsh reads. The functions that open a file need an open
/// session of Gmsh (mesh_with_gmsh) and return notes for the user.

namespace chladni::mesh {

/// Opens a .geo with its parameters, as `gmsh -setnumber` does. Algorithm 8 (frontal-Delaunay for
/// quads), which crashes in Gmsh 4.8.4, is replaced by 6.
/// @throws chladni::Error when the .geo lacks a parameter or overwrites it, when it meshes by
///         itself with algorithm 8, and when it is a stranger's and would act on other files.
std::vector<std::string> open_geo(const MeshOptions& options);

/// Imports the volumes or surfaces of a .step in millimetres, joins those that touch, cuts the
/// rings into them, and names the groups. `options.groups` number entities as the file does.
/// @throws chladni::Error when the file holds solids and no section is of solids, or has no
/// surface.
std::vector<std::string> open_step(const MeshOptions& options);

/// Adds the groups of the options to a .msh or .geo. If the file has no groups, each entity gets
/// one.
/// @throws chladni::Error naming an entity that does not exist or has another group.
void add_entity_groups(const MeshOptions& options);

/// Reads the mesh of a file in this process, in metres.
/// @param before_reading  is called when Gmsh has opened the files it needs for itself
/// @throws chladni::Error as `read_gmsh`.
Mesh read_file(const MeshOptions& options, const std::function<void()>& before_reading);

/// Dimension and tag of a point, curve, surface or volume in Gmsh.
using Entity = std::pair<int, int>;

/// The name of an entity, as "surface_3".
std::string entity_name(const Entity& entity);

/// The entities of a group, named as "surface_3" or by their label; all have one dimension.
/// @throws chladni::Error listing those that exist.
std::vector<Entity> find_entities(const EntityGroup& group);

/// Adds a physical group of the entities.
/// @throws chladni::Error when a surface, or a volume of a body of solids, already belongs to a
/// group.
void add_entity_group(const EntityGroup& group, const std::vector<Entity>& entities,
                      const MeshOptions& options);

/// Adds a group for each surface if no surface has one, and for each curve if no curve has one; of
/// a body of solids also for each volume.
void add_groups_of_each_entity(const MeshOptions& options);

/// What `made_by_mesher` and `declarations` ask chladni-mesher for, in that program.
/// @param subject  of the question: the mesh of the options, or the declarations of a deck
/// @throws chladni::Error with what is wrong with the options or the file.
void answer(const std::string& subject, Unpacker& question, Packer& answer);

}  // namespace chladni::mesh
