#pragma once

#include <hdf5.h>

#include <string>

/// What a file of HDF5 can hold that is not in it: values in other files, links to other files, and
/// values that need code from elsewhere to be unpacked. None of it is followed, whoever sealed it.
namespace chladni::files {

/// Why the values of a dataset are not all in its file, or cannot be unpacked by libhdf5 alone:
/// external storage, a virtual dataset of another file, a filter other than deflate, shuffle and
/// fletcher32. Opens no other file.
/// @param creation  the properties that the dataset was created with
/// @return a sentence without its subject; empty where there is nothing of the kind
std::string foreign_part(hid_t creation);

/// Whether a dataset stores nothing and shows values of others.
bool is_view(hid_t creation);

/// The first link of a file that leads out of it.
/// @return "NAME: WHY"; empty where there is none
std::string foreign_link(hid_t file);

/// A name out of a file nobody vouches for, without what a terminal would obey.
std::string shown(std::string name);

}  // namespace chladni::files
