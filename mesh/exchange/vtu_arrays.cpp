#include "mesh/exchange/vtu_arrays.hpp"

#include <expat.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "common/error.hpp"

namespace chladni::mesh {

namespace {

using Attributes = std::map<std::string, std::string>;

/// An array as it is written.
struct Written {
  VtuArray array;
  std::string type, format;
  std::uint64_t offset = 0;
  std::string text = {};
};

struct Appended {
  std::string xml;  ///< the file without its appended bytes
  std::string_view bytes;
};

/// Appended bytes may be anything, so that no reader of XML can pass over them.
Appended without_appended(const std::string& text)
{
  const std::size_t begin = text.find("<AppendedData");
  if (begin == std::string::npos) return {text, {}};
  const std::size_t end = text.find('>', begin);
  const std::size_t mark = text.find_first_not_of(" \t\r\n", std::min(end, text.size() - 1) + 1);
  if (end == std::string::npos || mark == std::string::npos || text[mark] != '_')
    throw Error("AppendedData: the mark _ in front of its bytes is missing");
  return {text.substr(0, end + 1) + "</AppendedData></VTKFile>",
          std::string_view(text).substr(mark + 1)};
}

std::int64_t whole_number(const std::string& text, const std::string& what)
{
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= 0) return value;
  throw Error(fmt::format("{} = \"{}\" is no number", what, text));
}

/// The elements of the XML, one after the other.
class Document {
 public:
  void begin(const std::string& name, const Attributes& attributes, int line)
  {
    if (is_in_array_) {  // VTK's notes on an array: its range, names of components
      ++depth_in_array_;
      return;
    }
    if (name == "VTKFile") begin_file(attributes);
    if (name == "Piece") begin_piece(attributes);
    if (name == "AppendedData") encoding_.is_base64 = value(attributes, "encoding") != "raw";
    if (name == "DataArray" || name == "Array") begin_array(attributes, line);
    if (name != "DataArray" && depth_in_piece(name)) section_ = name;
  }
  void end(const std::string& name)
  {
    if (depth_in_array_ > 0) {
      --depth_in_array_;
      return;
    }
    is_in_array_ = false;
    if (name == section_) section_.clear();
  }
  void text(std::string_view more)
  {
    if (is_in_array_ && depth_in_array_ == 0) written_.back().text += more;
  }

  VtuPiece piece(std::string_view appended)
  {
    if (!piece_) throw Error("it has no Piece: it is no unstructured grid of VTK");
    for (Written& written : written_) {
      const bool is_data = written.array.section.ends_with("Data");
      if (written.type == "String" && is_data) {
        ++piece_->n_texts;
        continue;
      }
      try {
        read(written, appended);
      } catch (const Error& error) {
        written.array.refuse(error.what());
      }
      piece_->arrays.push_back(std::move(written.array));
    }
    return std::move(*piece_);
  }

 private:
  static std::string value(const Attributes& attributes, const std::string& name)
  {
    const auto found = attributes.find(name);
    return found == attributes.end() ? "" : found->second;
  }
  static bool depth_in_piece(const std::string& name)
  {
    return name == "Points" || name == "Cells" || name == "PointData" || name == "CellData" ||
           name == "FieldData";
  }

  void begin_file(const Attributes& attributes)
  {
    const std::string type = value(attributes, "type");
    if (type != "UnstructuredGrid")
      throw Error(fmt::format("it holds \"{}\", not an UnstructuredGrid", type));
    const std::string order = value(attributes, "byte_order"),
                      words = value(attributes, "header_type");
    const std::string compressor = value(attributes, "compressor");
    if (!order.empty() && order != "LittleEndian")
      throw Error(fmt::format("byte_order {} is not known, only LittleEndian", order));
    if (!words.empty() && words != "UInt32" && words != "UInt64")
      throw Error(fmt::format("header_type {} is not known; UInt32 and UInt64 are", words));
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
      throw Error(fmt::format(
          "compressor {} is not known; write it with vtkZLibDataCompressor or with none",
          compressor));
    }
    encoding_.header_bytes = words == "UInt64" ? 8 : 4;
    encoding_.is_compressed = !compressor.empty();
  }

  void begin_piece(const Attributes& attributes)
  {
    if (piece_) throw Error("it has several pieces; join them, in ParaView by Merge Blocks");
    piece_ = {.n_points = whole_number(value(attributes, "NumberOfPoints"), "NumberOfPoints"),
              .n_cells = whole_number(value(attributes, "NumberOfCells"), "NumberOfCells"),
              .arrays = {},
              .n_texts = 0};
  }

  void begin_array(const Attributes& attributes, int line)
  {
    if (section_ == "FieldData" || section_.empty()) return;
    const std::string components = value(attributes, "NumberOfComponents");
    const std::string offset = value(attributes, "offset"), type = value(attributes, "type");
    written_.push_back({.array = {.section = section_,
                                  .name = value(attributes, "Name"),
                                  .line = line,
                                  .components = 1,
                                  .is_real = type.starts_with("Float"),
                                  .reals = {},
                                  .integers = {}},
                        .type = type,
                        .format = value(attributes, "format")});
    if (!components.empty())
      written_.back().array.components = whole_number(components, "NumberOfComponents");
    if (!offset.empty())
      written_.back().offset = static_cast<std::uint64_t>(whole_number(offset, "offset"));
    is_in_array_ = true;
  }

  void read(Written& written, std::string_view appended) const
  {
    if (written.format == "ascii" || written.format.empty())
      return read_words(written.array, written.type, written.text);
    VtuEncoding encoding = encoding_;
    if (written.format == "binary") {
      encoding.is_base64 = true;
      return read_bytes(written.array, written.type, vtu_bytes(written.text, encoding));
    }
    if (written.format != "appended")
      throw Error(fmt::format("format \"{}\" is not known", written.format));
    if (written.offset >= appended.size()) throw Error("stands behind the end of the file");
    read_bytes(written.array, written.type, vtu_bytes(appended.substr(written.offset), encoding));
  }

  std::optional<VtuPiece> piece_;
  VtuEncoding encoding_;
  std::vector<Written> written_;
  std::string section_;
  bool is_in_array_ = false;
  int depth_in_array_ = 0;  ///< elements that are open within the array
};

/// Expat is C: an error waits until it has returned.
struct Parsing {
  Document document;
  XML_Parser parser;
  std::string error = {};

  void attempt(auto&& action)
  {
    try {
      if (error.empty()) action();
    } catch (const Error& thrown) {
      error = fmt::format("line {}: {}", XML_GetCurrentLineNumber(parser), thrown.what());
      XML_StopParser(parser, XML_FALSE);
    }
  }
};

void XMLCALL on_begin(void* parsing, const char* name, const char** attributes)
{
  auto& to = *static_cast<Parsing*>(parsing);
  to.attempt([&] {
    Attributes all;
    for (; attributes[0] != nullptr; attributes += 2) all.emplace(attributes[0], attributes[1]);
    to.document.begin(name, all, static_cast<int>(XML_GetCurrentLineNumber(to.parser)));
  });
}

void XMLCALL on_end(void* parsing, const char* name)
{
  auto& to = *static_cast<Parsing*>(parsing);
  to.attempt([&] { to.document.end(name); });
}

void XMLCALL on_text(void* parsing, const char* text, int n)
{
  auto& to = *static_cast<Parsing*>(parsing);
  to.attempt([&] { to.document.text({text, static_cast<std::size_t>(n)}); });
}

}  // namespace

void VtuArray::refuse(std::string_view why) const
{
  throw Error(fmt::format("line {}: {} \"{}\": {}", line, section, name, why));
}

VtuPiece vtu_piece(const std::string& text)
{
  const auto [xml, appended] = without_appended(text);
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(
      XML_ParserCreate(nullptr), XML_ParserFree);
  Parsing parsing{.document = {}, .parser = parser.get()};
  XML_SetUserData(parser.get(), &parsing);
  XML_SetElementHandler(parser.get(), on_begin, on_end);
  XML_SetCharacterDataHandler(parser.get(), on_text);
  if (xml.size() > std::size_t(std::numeric_limits<int>::max()))
    throw Error("it has more than 2 GiB of text; write its arrays as appended bytes");
  const XML_Status status =
      XML_Parse(parser.get(), xml.data(), static_cast<int>(xml.size()), XML_TRUE);
  if (!parsing.error.empty()) throw Error(parsing.error);
  if (status != XML_STATUS_OK) {
    throw Error(fmt::format("line {}: it is no XML: {}", XML_GetCurrentLineNumber(parser.get()),
                            XML_ErrorString(XML_GetErrorCode(parser.get()))));
  }
  return parsing.document.piece(appended);
}

namespace {

constexpr std::uint64_t most_bytes = std::uint64_t(1) << 34;

/// 0 to 63; 64 for what is none.
unsigned digit_of(char c)
{
  if (c >= 'A' && c <= 'Z') return static_cast<unsigned>(c - 'A');
  if (c >= 'a' && c <= 'z') return static_cast<unsigned>(c - 'a') + 26;
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0') + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : 64;
}

/// Takes bytes from the front, out of base64 where they are in that. Header and values may be
/// encoded apart, so that padding ends no more than its four letters.
class Source {
 public:
  Source(std::string_view encoded, bool is_base64) : rest_(encoded), is_base64_(is_base64) {}

  std::string take(std::uint64_t n)
  {
    if (n > most_bytes || n > rest_.size() + pending_.size())
      throw Error(fmt::format("ends before the {} bytes that it says", n));
    if (!is_base64_) {
      std::string bytes(rest_.substr(0, n));
      rest_.remove_prefix(n);
      return bytes;
    }
    std::string bytes = std::move(pending_);
    while (bytes.size() < n) take_letters(bytes);
    pending_ = bytes.substr(n);
    bytes.resize(n);
    return bytes;
  }

 private:
  void take_letters(std::string& bytes)
  {
    std::array<char, 4> letters{};
    for (char& letter : letters) {
      rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
      if (rest_.empty()) throw Error("ends before the bytes that it says");
      letter = rest_.front();
      rest_.remove_prefix(1);
    }
    const int n_bytes = letters[2] == '=' ? 1 : letters[3] == '=' ? 2 : 3;
    unsigned value = 0;
    for (int k = 0; k < 4; ++k) {
      const unsigned digit = k > n_bytes ? 0 : digit_of(letters[static_cast<std::size_t>(k)]);
      if (digit > 63) throw Error("holds what is no base64");
      value = value << 6 | digit;
    }
    for (int k = 0; k < n_bytes; ++k) bytes += static_cast<char>(value >> (16 - 8 * k) & 0xFF);
  }

  std::string_view rest_;
  bool is_base64_;
  std::string pending_;  ///< decoded and not yet taken
};

std::uint64_t header_number(Source& source, std::size_t n_bytes)
{
  const std::string bytes = source.take(n_bytes);
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data(), n_bytes);
  return number;
}

std::string unpacked(const std::string& packed, std::uint64_t size)
{
  constexpr std::uint64_t best_ratio = 1032;  // of deflate
  if (size > best_ratio * packed.size()) throw Error("does not unpack to what it says");
  std::string bytes(size, '\0');
  uLongf n = size;
  const int result = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &n,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  if (result != Z_OK || n != size) throw Error("does not unpack to what it says");
  return bytes;
}

/// Number of blocks, size of each, size of the last (0: like the others), packed sizes; then the
/// blocks.
std::string take_blocks(Source& source, std::size_t header_bytes)
{
  const std::uint64_t n = header_number(source, header_bytes);
  const std::uint64_t size = header_number(source, header_bytes);
  const std::uint64_t last = header_number(source, header_bytes);
  std::vector<std::uint64_t> packed_sizes;
  for (std::uint64_t i = 0; i < n; ++i) packed_sizes.push_back(header_number(source, header_bytes));
  std::string bytes;
  for (std::uint64_t i = 0; i < n; ++i) {
    const bool is_last = i + 1 == n && last != 0;
    bytes += unpacked(source.take(packed_sizes[i]), is_last ? last : size);
  }
  return bytes;
}

}  // namespace

std::string vtu_bytes(std::string_view encoded, const VtuEncoding& encoding)
{
  Source source(encoded, encoding.is_base64);
  if (encoding.is_compressed) return take_blocks(source, encoding.header_bytes);
  const std::uint64_t n = header_number(source, encoding.header_bytes);
  return source.take(n);
}

namespace {

template <class T>
void append(std::vector<T>& values, std::string_view word)
{
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    throw Error(fmt::format("\"{}\" is no number", word.substr(0, 40)));
  values.push_back(value);
}

template <class From, class To>
void copy_bytes(const std::string& bytes, std::vector<To>& values)
{
  if (bytes.size() % sizeof(From) != 0) throw Error("ends in the midst of a number");
  values.resize(bytes.size() / sizeof(From));
  for (std::size_t i = 0; i < values.size(); ++i) {
    From value{};
    std::memcpy(&value, bytes.data() + i * sizeof(From), sizeof(From));
    // Signed numbers of one byte are numbers here, not characters.
    values[i] = static_cast<To>(value);  // NOLINT(bugprone-signed-char-misuse)
  }
}

void check_type(const std::string& type)
{
  for (const char* known : {"Float32", "Float64", "Int8", "UInt8", "Int16", "UInt16", "Int32",
                            "UInt32", "Int64", "UInt64"})
    if (type == known) return;
  throw Error(fmt::format("type \"{}\" is not known", type));
}

}  // namespace

void read_words(VtuArray& array, const std::string& type, std::string_view text)
{
  check_type(type);
  constexpr const char* blanks = " \t\r\n";
  for (std::size_t at = text.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (array.is_real)
      append(array.reals, word);
    else
      append(array.integers, word);
    at = text.find_first_not_of(blanks, end);
  }
}

void read_bytes(VtuArray& array, const std::string& type, const std::string& bytes)
{
  check_type(type);
  std::vector<std::int64_t>& integers = array.integers;
  if (type == "Float32") copy_bytes<float>(bytes, array.reals);
  if (type == "Float64") copy_bytes<double>(bytes, array.reals);
  if (type == "Int8") copy_bytes<std::int8_t>(bytes, integers);
  if (type == "UInt8") copy_bytes<std::uint8_t>(bytes, integers);
  if (type == "Int16") copy_bytes<std::int16_t>(bytes, integers);
  if (type == "UInt16") copy_bytes<std::uint16_t>(bytes, integers);
  if (type == "Int32") copy_bytes<std::int32_t>(bytes, integers);
  if (type == "UInt32") copy_bytes<std::uint32_t>(bytes, integers);
  if (type == "Int64") copy_bytes<std::int64_t>(bytes, integers);
  if (type == "UInt64") copy_bytes<std::uint64_t>(bytes, integers);
}

}  // namespace chladni::mesh
