#include "cases/broadcast_mesh.hpp"

#include <mpi.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "cases/ranks.hpp"
#include "common/petsc.hpp"

namespace chladni::cases {
namespace {

/// Writes values one behind the other.
class Packer {
 public:
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const T& value) { append(&value, sizeof(T)); }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const std::vector<T>& values)
  {
    (*this)(values.size());
    append(values.data(), values.size() * sizeof(T));
  }
  void operator()(const std::string& text)
  {
    (*this)(text.size());
    append(text.data(), text.size());
  }
  const std::vector<char>& bytes() const { return bytes_; }

 private:
  void append(const void* from, std::size_t n)
  {
    const char* first = static_cast<const char*>(from);
    bytes_.insert(bytes_.end(), first, first + n);
  }
  std::vector<char> bytes_;
};

/// Reads them back in the same order.
class Unpacker {
 public:
  explicit Unpacker(const std::vector<char>& bytes) : next_(bytes.data()) {}

  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(T& value) { extract(&value, sizeof(T)); }
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::vector<T>& values)
  {
    values.resize(size());
    extract(values.data(), values.size() * sizeof(T));
  }
  void operator()(std::string& text)
  {
    text.resize(size());
    extract(text.data(), text.size());
  }
  std::size_t size()
  {
    std::size_t n = 0;
    (*this)(n);
    return n;
  }

 private:
  void extract(void* to, std::size_t n)
  {
    if (n > 0) std::memcpy(to, next_, n);
    next_ += n;
  }
  const char* next_;
};

/// The order of the parts, for both directions.
template <typename Archive, typename Block>
void transfer_block(Archive& archive, Block& block)
{
  archive(block.shape);
  archive(block.order);
  archive(block.nodes_per_element);
  archive(block.numbers);
  archive(block.nodes);
  archive(block.group);
}

template <typename Archive, typename Group>
void transfer_group(Archive& archive, Group& group)
{
  archive(group.name);
  archive(group.dimension);
  archive(group.nodes);
}

std::vector<char> pack(const mesh::Mesh& mesh)
{
  Packer packer;
  packer(mesh.node_numbers);
  packer(mesh.positions);
  packer(mesh.blocks.size());
  for (const mesh::ElementBlock& block : mesh.blocks) transfer_block(packer, block);
  packer(mesh.groups.size());
  for (const mesh::Group& group : mesh.groups) transfer_group(packer, group);
  packer(mesh.notes.size());
  for (const std::string& note : mesh.notes) packer(note);
  return packer.bytes();
}

mesh::Mesh unpack(const std::vector<char>& bytes)
{
  Unpacker unpacker(bytes);
  mesh::Mesh mesh;
  unpacker(mesh.node_numbers);
  unpacker(mesh.positions);
  mesh.blocks.resize(unpacker.size());
  for (mesh::ElementBlock& block : mesh.blocks) transfer_block(unpacker, block);
  mesh.groups.resize(unpacker.size());
  for (mesh::Group& group : mesh.groups) transfer_group(unpacker, group);
  mesh.notes.resize(unpacker.size());
  for (std::string& note : mesh.notes) unpacker(note);
  return mesh;
}

}  // namespace

mesh::Mesh broadcast(const mesh::Mesh& mesh)
{
  if (n_ranks() == 1) return mesh;
  std::vector<char> bytes;
  if (rank() == 0) bytes = pack(mesh);
  std::size_t size = bytes.size();
  MPI_Bcast(&size, sizeof(size), MPI_BYTE, 0, PETSC_COMM_WORLD);
  bytes.resize(size);
  constexpr std::size_t piece = std::size_t(1) << 30;  // an MPI count is an int
  for (std::size_t at = 0; at < size; at += piece) {
    const auto count = static_cast<int>(std::min(piece, size - at));
    MPI_Bcast(bytes.data() + at, count, MPI_BYTE, 0, PETSC_COMM_WORLD);
  }
  return unpack(bytes);
}

}  // namespace chladni::cases
