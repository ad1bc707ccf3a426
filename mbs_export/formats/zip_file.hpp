#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chladni::mbs_export::formats {

/// A file in a zip archive.
struct ZipEntry {
  std::string name;  ///< with slashes
  std::string bytes;
};

/// A zip archive whose entries are deflated; of the same entries the same bytes.
/// @throws chladni::Error when it is too large for the format without its extension for 4 GiB.
/// Source: PKWARE, APPNOTE.TXT, .ZIP File Format Specification, sections 4.3.7, 4.3.12, 4.3.16.
std::string zip_archive(const std::vector<ZipEntry>& entries);

}  // namespace chladni::mbs_export::formats
