#pragma once

#include <hdf5.h>

#include <string>

/// Parts of an HDF5 file that are not in it: values in other files, links to other files, and
/// values that need external code to be unpacked. None of them is followed, whoever sealed the
/// file.
namespace chladni::files {

/// The reason why the values of a dataset are not all in its file, or cannot be unpacked by libhdf5
/// alone: external storage, a virtual dataset of another file, or a filter other than deflate,
/// shuffle and fletcher32. Opens no other file.
/// @param creation  the creation properties of the dataset
/// @return a sentence without its subject; empty if all values are in the file
std::string foreign_part(hid_t creation);

/// True if a dataset stores nothing and shows values of others.
bool is_view(hid_t creation);

/// The first link of a file that leads out of it.
/// @return "NAME: WHY"; empty if there is none
std::string foreign_link(hid_t file);

/// A name from an untrusted file, without characters that control a terminal.
std::string shown(std::string name);

}  // namespace chladni::files
