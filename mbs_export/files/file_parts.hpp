#pragma once

#include <optional>
#include <string>
#include <vector>

#include "files/hdf5.hpp"
#include "mbs_export/mass_integrals.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mbs_export/stiffening.hpp"

/// The groups that the files of a reduced system and of a modal body have in common.
namespace chladni::mbs_export::file_parts {

struct Attachment {
  std::vector<AttachmentNode> nodes;
  std::vector<AttachmentSet> sets;
};

void write_attachment(files::Writer& file, const std::vector<AttachmentNode>& nodes,
                      const std::vector<AttachmentSet>& sets);
Attachment read_attachment(const files::Reader& file);

/// Nothing is written for an empty picture, and of one without a transformation the surface alone.
void write_picture(files::Writer& file, const Picture& picture);
/// The picture without its transformation.
Picture read_surface(const files::Reader& file);
/// @param n_columns  that `transformation` must have
Picture read_picture(const files::Reader& file, Eigen::Index n_columns);

/// Group `picture/sectors`, which stands for `picture/displacements`: the motion of the nodes of
/// one sector in each harmonic.
void write_sector_motions(files::Writer& file, const std::optional<SectorMotions>& motions);
/// None where the picture of the file has displacements.
/// @param n_points   nodes of the whole picture
/// @param n_columns  coordinates of the whole body
std::optional<SectorMotions> read_sector_motions(const files::Reader& file, Eigen::Index n_points,
                                                 Eigen::Index n_columns);

/// `resultant_names` and a group `resultants/NAME` for each; nothing is written when there are
/// none.
void write_resultants(files::Writer& file, const std::vector<ResultantModes>& resultants);
/// @param n_columns  that each `modes` must have
std::vector<ResultantModes> read_resultants(const files::Reader& file, Eigen::Index n_columns);

/// Group `mass_integrals`; nothing is written when there are none.
void write_mass_integrals(files::Writer& file, const std::optional<MassIntegrals>& integrals);
/// @param n  number of coordinates
std::optional<MassIntegrals> read_mass_integrals(const files::Reader& file, Eigen::Index n);

/// Group `stiffening`; nothing is written when there is none.
void write_stiffening(files::Writer& file, const std::optional<Stiffening>& stiffening);
/// @param n  number of coordinates
std::optional<Stiffening> read_stiffening(const files::Reader& file, Eigen::Index n);

/// Group `sectors`; nothing is written where there are none.
void write_sector_harmonics(files::Writer& file, const std::optional<SectorHarmonics>& harmonics);
/// @param n  number of coordinates or modes
std::optional<SectorHarmonics> read_sector_harmonics(const files::Reader& file, Eigen::Index n);

/// Integers of which each must be an index 0 .. limit - 1.
std::vector<int> read_indices(const files::Reader& file, const std::string& name,
                              Eigen::Index limit, Eigen::Index size = files::any);
/// A count or index of 0 or more.
int read_count(const files::Reader& file, const std::string& name);

/// A name that can be a link of HDF5; returned unchanged.
/// @throws chladni::Error when it is empty, "." or contains "/".
const std::string& link_name(const std::string& name);

}  // namespace chladni::mbs_export::file_parts
