#pragma once

#include "files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"

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

}  // namespace chladni::mbs_export
