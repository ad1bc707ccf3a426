#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/certificate.hpp"
#include "mbs_export/inertia.hpp"

namespace chladni::mbs_export {

/// The circumferential harmonic to which each coordinate of a body of n_sectors equal sectors
/// belongs. A coordinate of order n moves a circle about the axis only in the harmonics n,
/// n_sectors - n, n_sectors + n, 2 n_sectors - n, ..., and shares no mass or stiffness with those
/// of another order.
struct SectorHarmonics {
  int n_sectors;
  std::vector<int> order;  ///< of each coordinate, 0 to n_sectors / 2; -1: several
};

/// The harmonics of other coordinates, each by its kinetic energy; T^T M T = I.
/// @param T  [n x m]
SectorHarmonics in_coordinates(const SectorHarmonics& harmonics, const Eigen::MatrixXd& M,
                               const Eigen::MatrixXd& T);

/// The displacements of the nodes of all sectors of a body of equal sectors, given by those of one:
/// sector j moves as cos(j mu) x - sin(j mu) y, mu = 2 pi order / n_sectors, turned with the sector
/// about the z axis.
struct SectorMotions {
  struct Harmonic {
    int order;
    /// [3 n x k] rows x, y, z of the nodes of the first sector
    Eigen::MatrixXd x, y;
    std::vector<Eigen::Index> columns;  ///< [k] indices of the whole body's coordinates
  };
  int n_sectors = 0;
  Eigen::Index n_coordinates = 0;  ///< of the whole body
  std::vector<Harmonic> harmonics;
  /// [n_coordinates squared] Set if the coordinates of the whole body are others than those that
  /// `columns` numbers, which are T times them. Else empty.
  Eigen::MatrixXd T = {};

  Eigen::Index rows_of_sector() const { return harmonics.empty() ? 0 : harmonics[0].x.rows(); }
};

/// The rows of all sectors times T, computed without forming the rows themselves.
/// @param T  [n_coordinates x m]
/// @return [3 n n_sectors x m]
Eigen::MatrixXd in_coordinates(const SectorMotions& motions, const Eigen::MatrixXd& T);

/// A node at which loads, supports and contacts may act. Its DOFs are masters, or some
/// circumferential harmonics of its ring are.
struct AttachmentNode {
  std::int64_t number;       ///< node number of the mesh; a reference node has its own number
  Eigen::Vector3d position;  ///< m
  /// Unit normal of the shell if only the numerical drilling stiffness of the elements resists the
  /// rotation about it, so that nothing may be loaded or held there (drilling.hpp); else zero.
  Eigen::Vector3d drilling_axis = Eigen::Vector3d::Zero();
};

/// A named set of attachment nodes of the scene, e.g. the ring "track" or the reference node "hub".
struct AttachmentSet {
  std::string name;
  std::vector<int> nodes;  ///< indices into `attachment_nodes`; a ring is ordered by angle
};

/// A circumferential harmonic of the motion of a ring: cos(n phi) or sin(n phi).
struct RingHarmonic {
  int set;    ///< index in `sets`
  int order;  ///< n
  bool is_sine;
};

/// The DOF of a row of K_r: an attachment node and component (0..2 displacement x, y, z in m; 3..5
/// rotation about x, y, z in rad). Or the amplitude of a harmonic of a ring: node is -1, and
/// components are along and about the radial, the tangential direction and the axis of the ring.
struct MasterDof {
  int node;
  int component;
  std::optional<RingHarmonic> harmonic = {};
};

/// The motion of the attachment nodes if harmonics of rings are masters. Rows: all six components
/// of each node in turn.
struct RingMotion {
  /// F [6 n_nodes x n_m], orthonormal columns: the motion by a unit amplitude of each master.
  Eigen::MatrixXd shapes;
  /// [6 n_nodes x n_FE] F u_m and the contribution of harmonics that are no masters.
  Eigen::MatrixXd displacements;
};

/// The surface for pictures: some nodes of the mesh, triangles and quadrilaterals over them, and
/// the rows of the transformation that give their displacements.
struct Picture {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> positions;  ///< [n x 3], m
  std::vector<std::array<int, 4>>
      cells;                       ///< corners; a triangle repeats its last one, a line twice
  Eigen::MatrixXd transformation;  ///< [3 n x n_FE], rows x, y, z of each node in turn
};

/// Stresses, section forces or other resultants r = S q at points of chosen elements, as linear
/// forms in the coordinates q: "stress modes".
struct ResultantModes {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::string name;                    ///< e.g. the group of the elements
  std::vector<std::string> kinds;      ///< [n_kinds] "N", "Q_z", "M_y", ...; the same at each point
  std::vector<std::string> units;      ///< [n_kinds] of the kinds, "N", "N m", "N/m", ...
  std::vector<std::int64_t> elements;  ///< [n_points] element numbers of the mesh
  Rows positions;                      ///< [n_points x 3], m
  Rows axes;                           ///< [n_points x 9] unit vectors e_x, e_y, e_z of the kinds
  Eigen::MatrixXd S;  ///< [n_points n_kinds x n_coordinates] all kinds of each point in turn
};

/// The origin of a result, written into every file. A step that reads a file hands on the scene of
/// that file, which may be older than its own.
struct Provenance {
  std::string scene;          ///< text of the scene file
  std::string mesh_checksum;  ///< FNV-1a of node coordinates and connectivity, hexadecimal
  std::string versions;       ///< of Chladni and its libraries
  std::string options;        ///< options of the solvers
  int ranks = 1;
  std::string reduction_scene = {};   ///< scene of the reduced system from which a body was made
  std::string body_scene = {};        ///< scene of the body that a study used
  std::string mesh_file_digest = {};  ///< XXH64 of the mesh file's bytes, hexadecimal, or none
  /// Path of the scene file relative to the folder of this file; empty if there is none.
  std::string scene_file = {};
};

/// The result of the FE reduction, without PETSc: (K_r, M_r, C_r) in the coordinates (u_m, q) =
/// (displacements of the masters, amplitudes of the fixed-interface modes). Rows are ordered as
/// `masters`, then the fixed-interface modes.
struct ReducedSystem {
  std::string title;
  std::vector<AttachmentNode> attachment_nodes;
  std::vector<AttachmentSet> sets;
  std::vector<MasterDof> masters;              ///< [n_m]
  std::optional<RingMotion> ring_motion = {};  ///< absent if each master is a DOF of a node
  Eigen::MatrixXd K;                           ///< [n_FE x n_FE], N/m, N, N m
  Eigen::MatrixXd M;                           ///< [n_FE x n_FE], kg, kg m, kg m^2
  Eigen::MatrixXd C;                           ///< [n_FE x n_FE] or [0 x 0] when undamped
  /// [n_FE x n_FE] structural damping, sum of eta_e K_e of elements and springs, or [0 x 0], so
  /// that a harmonic motion has K + i H; units as K.
  Eigen::MatrixXd H = {};
  Eigen::VectorXd fixed_interface_frequencies;  ///< [n_CB], rad/s
  Picture picture;                              ///< empty if the scene asks for none
  /// Replaces the picture's transformation, which would be many times as large and is then empty.
  std::optional<SectorMotions> picture_of_sectors = {};
  std::optional<SectorHarmonics> sector_harmonics = {};  ///< for a body of equal sectors
  Certificate certificate = {};
  std::vector<ResultantModes> resultants = {};
  std::optional<MassIntegrals> mass_integrals = {};  ///< absent for matrices without geometry
  std::optional<Stiffening> stiffening = {};         ///< if the scene asks for it
  Provenance provenance;

  Eigen::Index n_masters() const { return static_cast<Eigen::Index>(masters.size()); }
};

/// The set with this name.
/// @throws chladni::Error naming the sets that exist.
const AttachmentSet& find_set(const ReducedSystem& reduced, const std::string& name);

/// The picture in other coordinates p with q = T p; empty if there is none.
Picture picture_in(const ReducedSystem& reduced, const Eigen::MatrixXd& T);

}  // namespace chladni::mbs_export
