#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chladni::mbs_export::formats {

/// A file in a zip archive.
struct ZipEntry {
  std::string name;  ///< with slashes between folders
  std::string bytes;
};

/// A zip archive of compressed entries. Equal entries give equal bytes.
/// @throws chladni::Error when it is too large for the format without its 4 GiB extension.
/// Source: PKWARE, APPNOTE.TXT, .ZIP File Format Specification, sections 4.3.7, 4.3.12, 4.3.16.
std::string zip_archive(const std::vector<ZipEntry>& entries);

}  // namespace chladni::mbs_export::formats
