#pragma once

#include <optional>
#include <string>
#include <vector>

#include "files/hdf5.hpp"
#include "mbs_export/mass_integrals.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mbs_export/stiffening.hpp"

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
