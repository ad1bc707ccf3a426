#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mesh/decks/declarations.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// An element with the node numbers of its file.
struct DeckElement {
  std::int64_t number;
  Shape shape;
  int order;
  /// As in `ElementBlock`; 0 for an inner node that the file lacks.
  std::vector<std::int64_t> nodes;
  int group;               ///< index into Deck::groups; -1 = none
  std::string place = {};  ///< "line 7"; empty where the file has no lines
  bool marks = false;      ///< its nodes are a set; it is no element of the mesh
};

/// What messages call an element: "line 7: element 12".
std::string name_of(const DeckElement& element);

/// det J of a solid at its centre, by its corners: negative where the nodes go round the wrong way.
/// @return 0 for other shapes, and where a corner is not there
double orientation(const DeckElement& element,
                   const std::map<std::int64_t, std::array<double, 3>>& nodes);

/// A named set of nodes. For a group of elements `mesh_of` fills in the nodes.
struct DeckGroup {
  std::string name;
  int dimension;  ///< of its elements; 0 for a set of nodes
  std::vector<std::int64_t> nodes;
  /// Numbers of a set of elements that are of other groups, from which a section of a scene takes
  /// them.
  std::vector<std::int64_t> elements = {};
  bool is_of_faces = false;  ///< a set of the nodes of faces
};

/// A reference node and the nodes that follow it as a rigid body, or whose mean it follows.
struct DeckCoupling {
  std::string entry;  ///< for messages: "line 7: RBE2 4"
  std::int64_t reference;
  std::string group;  ///< of the other nodes
  bool averages;
};

/// A linear equation between motions of nodes, in the units of the deck.
struct DeckEquation {
  struct Term {
    std::int64_t node;
    int component;  ///< 0 to 5
    double factor;
  };
  std::string entry;  ///< "line 7: *EQUATION"
  std::vector<Term> terms;
};

/// Nodes that move as the faces of solids do at which they stand.
struct DeckTie {
  std::string entry;          ///< "line 7: *TIE"
  std::string nodes, faces;   ///< groups
  std::optional<double> gap;  ///< up to which nodes are tied; absent: a part of the size of faces
  bool moves;                 ///< nodes onto the faces
};

/// The axes in which the components of a node count, as rows.
using DeckAxes = std::array<std::array<double, 3>, 3>;

/// The mesh of a file of another FE program, with the numbers and in the length unit of the file.
struct Deck {
  std::map<std::int64_t, std::array<double, 3>> nodes;
  std::vector<DeckElement> elements;
  std::vector<DeckGroup> groups;
  std::vector<DeckCoupling> couplings;
  std::vector<DeckEquation> equations = {};
  std::vector<DeckTie> ties = {};
  std::map<std::int64_t, DeckAxes> axes = {};  ///< of nodes with axes of their own
  /// Supports in such axes of nodes without an element, which no equation may move; with the line.
  std::vector<std::pair<std::int64_t, std::string>> held_apart = {};
  /// Nodes that the deck leaves out between two others.
  std::vector<std::array<std::int64_t, 3>> added_middles = {};
  std::vector<std::string> notes = {};
};

/// The index of the group of this name, which is added if missing.
int group_index(Deck& deck, const std::string& name, int dimension);

/// Whether components (0 to 5) name all or none of the displacements, and of the rotations: then
/// the axes of a node do not matter.
bool are_whole(const std::vector<int>& components);

/// Adds a factor times a component (0 to 5) of a node, in its own axes where it has some.
void add_term(const Deck& deck, DeckEquation& equation, const DeckEquation::Term& term);

/// The nodes of elements, and those of shells and beams, which have rotations.
struct NodesOfDeck {
  std::set<std::int64_t> connected, rotating;

  explicit NodesOfDeck(const Deck& deck);
  /// Whether a node can turn: not one of solids alone.
  bool turns(std::int64_t node) const
  {
    return rotating.contains(node) || !connected.contains(node);
  }
};

/// Held components (0 to 5) of nodes.
struct DeckSupport {
  std::string entry;  ///< "line 7: SPC1 4"
  std::vector<std::int64_t> nodes;
  std::vector<int> components;
};

/// Supports as equations of single nodes, of those nodes that have axes of their own and belong to
/// an element; rotations of nodes of shells and beams alone.
void hold_in_axes(Deck& deck, const NodesOfDeck& known, const DeckSupport& support);

/// The nodes without axes of their own; all where the components are whole.
std::vector<std::int64_t> held_in_basic_axes(const Deck& deck,
                                             const std::vector<std::int64_t>& nodes,
                                             const std::vector<int>& components);

/// Equations of components (0 to 5) of a node that follows another one as a rigid body.
/// @throws chladni::Error when one of the nodes is not there
void add_rigid_equations(Deck& deck, const std::string& entry, std::int64_t reference,
                         std::int64_t node, const std::vector<int>& components);

/// A spring between two nodes, of any direction.
struct DeckElongation {
  std::string entry, group;
  std::array<std::int64_t, 2> nodes;
};

/// Adds a node in a group of this name whose x is how far two nodes move apart along the line
/// between them, and whose rx is how far they turn against each other about it where both turn: a
/// spring between it and the ground is a spring between the two.
/// @throws chladni::Error when they are not there, or at one place
void add_elongation(Deck& deck, const NodesOfDeck& known, const DeckElongation& elongation);

/// Equations of components of a node that moves as others do in the mean: by the rigid motion that
/// fits their displacements best, with a weight for each.
/// @throws chladni::Error when nodes are not there, or lie on one line
void add_mean_equations(Deck& deck, const std::string& entry, std::int64_t reference,
                        const std::vector<int>& components,
                        const std::map<std::int64_t, double>& weights);

/// Gives elements of order 2 the middle nodes that they lack (0 in their places): that of a
/// neighbour at the same edge, or else a new one in the middle of the straight edge, in the sets
/// that have both ends of the edge, with a note.
/// @throws chladni::Error naming an element that lacks a middle node where an element of order 1
///         begins.
void add_missing_middles(Deck& deck);

/// Whether one of the nodes is of a shell or beam; nodes of solids alone do not turn.
bool have_rotations(const Deck& deck, const std::vector<std::int64_t>& nodes);

/// Makes the mesh of a deck: its solids, if a section names some of them, or there are some and no
/// section names anything, and the surfaces of `shell_groups`; else all its surfaces; and the lines
/// of `line_groups`. Other elements
/// become sets of nodes, and a note says so. If there are tetrahedra or wedges of order 1, all
/// solids get nodes in the middle of their edges. Nodes without an element are left out, but for
/// those of `coupled_groups`; quadrilaterals with a flat corner are split (`split_flat_corners`).
/// Ties become equations.
/// @throws chladni::Error naming an element and its missing node, a solid that is inside out or has
///         a node twice, two elements with the same nodes unless `doubled_elements` says what
///         becomes of them, and for a deck without elements.
Mesh mesh_of(Deck deck, const MeshOptions& options);

/// Finds by which groups and couplings a scene can hold nodes of a deck.
class Holders {
 public:
  /// Knows the nodes of elements and those that follow others.
  explicit Holders(const Deck& deck);

  bool is_follower(std::int64_t node) const { return followers_.contains(node); }
  /// True if an element or an equation has the node, or it follows another one: then it is a node
  /// of the mesh.
  bool is_in_mesh(std::int64_t node) const
  {
    return connected_.contains(node) || is_follower(node);
  }
  bool is_reference(std::int64_t node) const { return references_.contains(node); }
  /// As the function of this name.
  /// @throws chladni::Error for a reference node with axes of its own, which no equation holds
  std::vector<std::int64_t> held_in_basic_axes(const Deck& deck,
                                               const std::vector<std::int64_t>& nodes,
                                               const std::vector<int>& components) const;
  void add_reference(std::int64_t node) { references_.insert(node); }

  /// The groups and couplings by which a scene holds some nodes of `group`.
  /// @throws chladni::Error naming a node that belongs to no element and no coupling.
  std::set<std::string> of(const std::string& group, const std::vector<std::int64_t>& nodes) const;

 private:
  std::set<std::int64_t> connected_, followers_, references_;
};

/// The nodes that can be held. Those of no element and no coupling are held for nobody, as in other
/// programs, which a note tells.
/// @param entry  for the note: "line 7: SPC1 4"
std::vector<std::int64_t> supported_nodes(const Holders& holders, const std::string& entry,
                                          const std::vector<std::int64_t>& nodes,
                                          Declarations& all);

/// Adds a group "leader_17" for each node of the mesh that others follow as a rigid body.
void add_leaders(Deck& deck);

/// Adds the couplings of a deck, and registers their reference nodes.
/// @throws chladni::Error naming an entry whose reference is no node, or whose mean a scene cannot
///         express.
void declare_couplings(const Deck& deck, const DeckUnits& units, Holders& holders,
                       Declarations& all);

/// Adds a support unless there is an equal one.
void add_support(Declarations& all, const std::string& group, const std::vector<int>& components);

}  // namespace chladni::mesh
