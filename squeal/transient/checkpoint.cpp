#include "squeal/transient/checkpoint.hpp"

#include <span>
#include <system_error>
#include <utility>

#include "common/error.hpp"
#include "common/files/hdf5.hpp"
#include "mbs_export/files/body_files.hpp"

namespace chladni::squeal {
namespace {

using std::chrono::steady_clock;

constexpr auto format = "chladni-checkpoint";
constexpr std::int64_t version = 1;

}  // namespace

Checkpoint::Checkpoint(std::filesystem::path file, RunOrigin origin, double interval)
    : file_(std::move(file)),
      origin_(std::move(origin)),
      interval_(interval),
      last_(steady_clock::now())
{}

RunOrigin Checkpoint::read()
{
  const files::Reader reader(file_.string());
  reader.expect_format(format, version);
  state_ = reader.integers("state");
  was_written_ = true;
  return {mbs_export::file_parts::read_provenance(reader), reader.text("inputs")};
}

bool Checkpoint::is_due() const
{
  return steady_clock::now() - last_ >= interval_;
}

void Checkpoint::write(const std::vector<std::int64_t>& state)
{
  last_ = steady_clock::now();
  try {
    write_file(state);
    was_written_ = true;
    failure_.clear();
  } catch (const Error& error) {
    failure_ = error.what();
  }
}

void Checkpoint::write_file(const std::vector<std::int64_t>& state) const
{
  files::Writer writer(file_.string());
  writer.attribute("/", "format", format);
  writer.attribute("/", "version", version);
  mbs_export::file_parts::write_provenance(writer, origin_.provenance);
  writer.write("inputs", origin_.inputs);
  writer.write("state", std::span<const std::int64_t>(state), "1");
  writer.commit();
}

void Checkpoint::remove() const
{
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace chladni::squeal
