#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/files/fields.hpp"
#include "common/files/hdf5.hpp"
#include "mbs_export/certificate.hpp"
#include "mbs_export/inertia.hpp"
#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"

/// Groups that the files of reduced systems and of modal bodies share. Reading throws as
/// files::Reader.

namespace chladni::mbs_export::file_parts {

struct Attachment {
  std::vector<AttachmentNode> nodes;
  std::vector<AttachmentSet> sets;
};

void write_attachment(files::Writer& file, const std::vector<AttachmentNode>& nodes,
                      const std::vector<AttachmentSet>& sets);
Attachment read_attachment(const files::Reader& file);

/// Writes the picture: nothing if it is empty, the surface alone if it has no transformation.
void write_picture(files::Writer& file, const Picture& picture);
/// Reads the picture without its transformation.
Picture read_surface(const files::Reader& file);
/// Reads the picture.
/// @param n_columns  required number of columns of `transformation`
Picture read_picture(const files::Reader& file, Eigen::Index n_columns);

/// Writes the group `picture/sectors`, which replaces `picture/displacements`: the motion of the
/// nodes of one sector in each harmonic.
void write_sector_motions(files::Writer& file, const std::optional<SectorMotions>& motions);
/// Reads the group; absent if the picture of the file has displacements.
/// @param n_points   nodes of the whole picture
/// @param n_columns  coordinates of the whole body
std::optional<SectorMotions> read_sector_motions(const files::Reader& file, Eigen::Index n_points,
                                                 Eigen::Index n_columns);

/// Writes `resultant_names` and a group `resultants/NAME` for each; nothing if there are none.
void write_resultants(files::Writer& file, const std::vector<ResultantModes>& resultants);
/// Reads all resultants.
/// @param n_columns  required number of columns of each `modes`
std::vector<ResultantModes> read_resultants(const files::Reader& file, Eigen::Index n_columns);

/// Writes the group `mass_integrals`; nothing if there are none.
void write_mass_integrals(files::Writer& file, const std::optional<MassIntegrals>& integrals);
/// Reads the group `mass_integrals`; absent if the file has none.
/// @param n  number of coordinates
std::optional<MassIntegrals> read_mass_integrals(const files::Reader& file, Eigen::Index n);

/// Writes the group `stiffening`; nothing if there is none.
void write_stiffening(files::Writer& file, const std::optional<Stiffening>& stiffening);
/// Reads the group `stiffening`; absent if the file has none.
/// @param n  number of coordinates
std::optional<Stiffening> read_stiffening(const files::Reader& file, Eigen::Index n);

/// Writes the group `sectors`; nothing if there are none.
void write_sector_harmonics(files::Writer& file, const std::optional<SectorHarmonics>& harmonics);
/// Reads the group `sectors`; absent if the file has none.
/// @param n  number of coordinates or modes
std::optional<SectorHarmonics> read_sector_harmonics(const files::Reader& file, Eigen::Index n);

/// Reads integers, each of which must be an index 0 .. limit - 1.
std::vector<int> read_indices(const files::Reader& file, const std::string& name,
                              Eigen::Index limit, Eigen::Index size = files::any);
/// Reads a count or index, which must be 0 or more.
int read_count(const files::Reader& file, const std::string& name);

/// The name itself, if it can be a link of HDF5.
/// @throws chladni::Error when it is empty, "." or contains "/".
const std::string& link_name(const std::string& name);

}  // namespace chladni::mbs_export::file_parts

namespace chladni::mbs_export {

/// What of some groups is stored; see fields.hpp.
constexpr auto fields_of(std::type_identity<Provenance>)
{
  using files::Field, files::Presence;
  using T = Provenance;
  constexpr auto if_any = Presence::if_any;
  return std::tuple{Field{"scene", "", &T::scene},
                    Field{"mesh_checksum", "", &T::mesh_checksum},
                    Field{"versions", "", &T::versions},
                    Field{"options", "", &T::options},
                    Field{"ranks", "1", &T::ranks},
                    Field{"reduction_scene", "", &T::reduction_scene, "", if_any},
                    Field{"body_scene", "", &T::body_scene, "", if_any},
                    Field{"mesh_file_digest", "", &T::mesh_file_digest, "", if_any},
                    Field{"scene_file", "", &T::scene_file, "", if_any}};
}

constexpr auto fields_of(std::type_identity<Preparation>)
{
  using files::Field;
  using T = Preparation;
  return std::tuple{Field{"condition_directions", "1", &T::condition_directions},
                    Field{"rigid_residual", "1", &T::rigid_residual},
                    Field{"constrained_modes", "1", &T::n_constrained_modes},
                    Field{"partner_modes", "1", &T::n_partners},
                    Field{"interface_modes_dropped", "1", &T::n_interface_dropped},
                    Field{"massless_coordinates", "1", &T::n_massless}};
}

constexpr auto fields_of(std::type_identity<Condensation>)
{
  using files::Field;
  using T = Condensation;
  constexpr auto check = +[](const files::Reader& file, const std::string& name, const double& x) {
    if (!(x > 0.0)) file.fail(name, "expected a positive frequency");
  };
  return std::tuple{Field{"brake", "", &T::brake},
                    Field{"highest", "rad/s", &T::highest, "", files::Presence::always, check},
                    Field{"tolerance", "1", &T::tolerance}, Field{"error", "1", &T::error}};
}

constexpr auto fields_of(std::type_identity<SelectionStep>)
{
  using files::Field;
  using T = SelectionStep;
  return std::tuple{Field{"added", "", &T::added}, Field{"modes", "1", &T::n_modes},
                    Field{"interface_modes", "1", &T::n_interface}, Field{"error", "1", &T::error}};
}

constexpr auto fields_of(std::type_identity<SelectionTable>)
{
  using files::Field;
  using T = SelectionTable;
  return std::tuple{Field{"tolerance", "1", &T::error},
                    Field{"error_of_reduction", "1", &T::of_reduction},
                    Field{"highest_frequency", "rad/s", &T::Omega_max},
                    Field{"loads", "", &T::loads},
                    Field{"modes_only", "", &T::modes_only},
                    Field{"with_interface_modes", "", &T::with_interface_modes}};
}

constexpr auto fields_of(std::type_identity<ResponseCheck>)
{
  using files::Field;
  using T = ResponseCheck;
  return std::tuple{Field{"up_to", "rad/s", &T::up_to}, Field{"error", "1", &T::error},
                    Field{"loads", "", &T::loads}};
}

/// A group that may be absent.
template <files::Stored T>
void write_if_any(files::Writer& file, const std::string& group, const std::optional<T>& x)
{
  if (x) files::write_fields(file, group, *x);
}

template <files::Stored T>
std::optional<T> read_if_any(const files::Reader& file, const std::string& group)
{
  return file.contains(group) ? std::optional(files::read_fields<T>(file, group)) : std::nullopt;
}

/// The value of the attribute `format` of a body file.
inline constexpr auto body_format = "chladni-body";

/// Writes *.body.h5, format "chladni-body" version 1 (docs/reference/file_formats.md), in full
/// precision, with the circumferential Fourier coefficients of each contact ring for other
/// programs. The file appears completely or not at all.
/// @throws chladni::Error when the file cannot be written.
void write_body(const std::string& path, const ModalBody& body);

/// Reads a body file. A body that `write_body` wrote is restored bit by bit.
/// @throws chladni::Error naming the file, the dataset and what was expected.
ModalBody read_body(const std::string& path);
ModalBody read_body(const files::Reader& file);

/// The value of the attribute `format` of a reduced file.
inline constexpr auto reduced_format = "chladni-reduced";

/// Writes *.reduced.h5, format "chladni-reduced" version 1 (docs/reference/file_formats.md), in
/// full precision. The file appears completely or not at all.
/// @throws chladni::Error when the file cannot be written.
void write_reduced(const std::string& path, const ReducedSystem& reduced);

/// Reads a reduced file. A system that `write_reduced` wrote is restored bit by bit.
/// @throws chladni::Error naming the file, the dataset and what was expected: another format or
///         version, a missing dataset, a wrong type or shape, a value that is not finite, an index
///         out of range, K or M unsymmetric beyond round-off.
ReducedSystem read_reduced(const std::string& path);
ReducedSystem read_reduced(const files::Reader& file);

}  // namespace chladni::mbs_export

/// The group `certificate` of the reduced file (docs/reference/file_formats.md).

namespace chladni::mbs_export {

/// Writes the group; writes nothing if the certificate is empty.
void write_certificate(files::Writer& file, const Certificate& certificate);

/// Reads the group; the certificate is empty if the file has none.
/// @throws chladni::Error as files::Reader.
Certificate read_certificate(const files::Reader& file);

}  // namespace chladni::mbs_export

namespace chladni::mbs_export::file_parts {

/// Writes the group `provenance`, which each file made from a scene has.
void write_provenance(files::Writer& file, const Provenance& provenance);
/// Reads the group `provenance`.
/// @throws chladni::Error naming file and dataset for what is missing or of the wrong kind.
Provenance read_provenance(const files::Reader& file);
Provenance read_provenance(const std::filesystem::path& file);

}  // namespace chladni::mbs_export::file_parts

/// The parts of the reduced file about masters that are harmonics of rings
/// (docs/reference/file_formats.md). They are absent if each master is a DOF of a node.

namespace chladni::mbs_export {

void write_ring_masters(files::Writer& file, const ReducedSystem& reduced);

bool has_ring_masters(const files::Reader& file);

/// Reads all masters, of nodes and of rings.
std::vector<MasterDof> read_ring_masters(const files::Reader& file, Eigen::Index n_nodes,
                                         const std::vector<AttachmentSet>& sets);

/// Reads the motion of the attachment nodes by the masters; absent if the file has none.
/// @param shape  of the shapes, [6 n_nodes x n_m]
/// @param n      number of coordinates
std::optional<RingMotion> read_ring_motion(const files::Reader& file, files::Shape shape,
                                           Eigen::Index n);

/// Writes the group /VTKHDF (version 1.0, UnstructuredGrid), with which ParaView shows the surface
/// of a body and each of its modes as a vector field, "mode 03, 812.5 Hz". The values are views on
/// those of `picture` and are not stored twice. Nothing is written for a body without a picture.
void write_vtkhdf(files::Writer& file, const ModalBody& body);

}  // namespace chladni::mbs_export
