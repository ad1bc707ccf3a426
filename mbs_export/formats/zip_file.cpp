#include "mbs_export/formats/zip_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cstdint>
#include <limits>

#include "common/error.hpp"

namespace chladni::mbs_export::formats {
namespace {

constexpr std::uint16_t version_needed = 20, deflated = 8;
constexpr std::uint16_t name_is_utf8 = 0x0800;
constexpr std::uint16_t first_of_january_1980 = 0x0021;  // no time: the archive depends on nothing

/// Little-endian, as all numbers of the format.
void append(std::string& bytes, std::uint16_t number)
{
  bytes += static_cast<char>(number & 0xFF);
  bytes += static_cast<char>(number >> 8);
}

void append(std::string& bytes, std::uint32_t number)
{
  append(bytes, static_cast<std::uint16_t>(number & 0xFFFF));
  append(bytes, static_cast<std::uint16_t>(number >> 16));
}

std::uint32_t size_of(std::size_t n, const std::string& name)
{
  if (n < std::numeric_limits<std::uint32_t>::max()) return static_cast<std::uint32_t>(n);
  throw Error(fmt::format("{}: with it the archive has 4 GiB, more than a zip holds", name));
}

/// Without zlib's own head and checksum, as in a zip.
std::string raw_deflate(const std::string& bytes)
{
  z_stream stream{};
  constexpr int without_header = -MAX_WBITS, memory_level = 8;
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, without_header, memory_level,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error("zlib has no memory to pack an archive");
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int result = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw Error("zlib could not pack an archive");
  return packed;
}

/// What stands in front of an entry and again in the directory at the end.
std::string fields(const ZipEntry& entry, std::size_t n_packed)
{
  std::string bytes;
  append(bytes, version_needed);
  append(bytes, name_is_utf8);
  append(bytes, deflated);
  append(bytes, std::uint16_t{0});
  append(bytes, first_of_january_1980);
  append(bytes,
         static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(entry.bytes.data()),
                                          size_of(entry.bytes.size(), entry.name))));
  append(bytes, size_of(n_packed, entry.name));
  append(bytes, size_of(entry.bytes.size(), entry.name));
  append(bytes, static_cast<std::uint16_t>(entry.name.size()));
  append(bytes, std::uint16_t{0});  // no extra field
  return bytes;
}

std::string in_directory(const ZipEntry& entry, const std::string& of_entry, std::size_t offset)
{
  constexpr std::uint16_t made_by_unix = 3 << 8 | version_needed;
  constexpr std::uint32_t regular_file = 0100644U << 16;
  std::string bytes = "PK\1\2";
  append(bytes, made_by_unix);
  bytes += of_entry;
  append(bytes, std::uint16_t{0});  // no comment
  append(bytes, std::uint16_t{0});  // first disk
  append(bytes, std::uint16_t{0});
  append(bytes, regular_file);
  append(bytes, size_of(offset, entry.name));
  return bytes + entry.name;
}

}  // namespace

std::string zip_archive(const std::vector<ZipEntry>& entries)
{
  std::string archive, directory;
  for (const ZipEntry& entry : entries) {
    size_of(entry.bytes.size(), entry.name);
    const std::string packed = raw_deflate(entry.bytes);
    const std::string of_entry = fields(entry, packed.size());
    directory += in_directory(entry, of_entry, archive.size());
    for (const std::string& part : {std::string("PK\3\4"), of_entry, entry.name, packed})
      archive += part;
  }
  const auto n = static_cast<std::uint16_t>(entries.size());
  const std::uint32_t begin = size_of(archive.size(), "the directory");
  archive += directory + "PK\5\6";
  append(archive, std::uint32_t{0});  // first disk, twice
  append(archive, n);
  append(archive, n);
  append(archive, size_of(directory.size(), "the directory"));
  append(archive, begin);
  append(archive, std::uint16_t{0});  // no comment
  return archive;
}

}  // namespace chladni::mbs_export::formats
