#include "report/output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "common/error.hpp"

namespace chladni::report {
namespace {

/// Cells may hold UTF-8; a continuation byte takes no column.
std::size_t width(std::string_view text)
{
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

std::vector<std::size_t> column_widths(const TextTable& table)
{
  std::vector<std::size_t> widths;
  for (std::size_t j = 0; j < table.header.size(); ++j) {
    widths.push_back(width(table.header[j]));
    for (const auto& row : table.rows) widths[j] = std::max(widths[j], width(row[j]));
  }
  return widths;
}

std::string format_row(const std::vector<std::string>& cells,
                       const std::vector<std::size_t>& widths)
{
  std::string line = cells[0] + std::string(widths[0] - width(cells[0]), ' ');
  for (std::size_t j = 1; j < cells.size(); ++j) {
    line += std::string(2 + widths[j] - width(cells[j]), ' ') + cells[j];
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

/// A file descriptor that is closed at the end.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path)
      : descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666))
  {}
  ~OutputFile()
  {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  /// @return whether all of `text` is on the disk
  bool write(std::string_view text)
  {
    while (!text.empty()) {
      const ssize_t n = ::write(descriptor_, text.data(), text.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(n));
    }
    return ::fsync(descriptor_) == 0;
  }

 private:
  int descriptor_;
};

bool write_file(const std::string& path, std::string_view text)
{
  OutputFile file(path);
  return file.is_open() && file.write(text);
}

}  // namespace

std::string format_table(const TextTable& table)
{
  const std::vector<std::size_t> widths = column_widths(table);
  std::string text = format_row(table.header, widths);
  for (const auto& row : table.rows) text += format_row(row, widths);
  return text;
}

void write_text_atomically(const std::filesystem::path& path, std::string_view text)
{
  const std::string temporary = fmt::format("{}.{}.tmp", path.string(), ::getpid());
  if (write_file(temporary, text) && std::rename(temporary.c_str(), path.c_str()) == 0) return;
  const std::string reason = std::strerror(errno);
  std::remove(temporary.c_str());
  throw Error(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

void make_folder(const std::filesystem::path& folder)
{
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (!std::filesystem::is_directory(folder)) {
    throw Error(fmt::format("{}: this folder cannot be made{}{}", folder.string(),
                            failure ? ": " : "", failure ? failure.message() : ""));
  }
}

std::optional<std::string> progress_text(std::string_view phase, double fraction, double elapsed_s)
{
  constexpr double shortest_worth_telling_s = 2.0;
  if (elapsed_s < shortest_worth_telling_s) return std::nullopt;
  if (!(fraction > 0.0)) return fmt::format("{}: {:.0f} s", phase, elapsed_s);
  const double done = std::min(fraction, 1.0);
  const double left_s = std::ceil(elapsed_s * (1.0 - done) / done);
  return fmt::format("{}: {:.0f} %, {:.0f} s left", phase, std::floor(100.0 * done), left_s);
}

ProgressLine::~ProgressLine()
{
  wipe();
}

void ProgressLine::wipe()
{
  if (visible_) fmt::print(stderr, "\r\033[K");
  visible_ = false;
}

void ProgressLine::show(const std::string& phase, double fraction)
{
  if (::isatty(STDERR_FILENO) == 0) return;
  const Clock::time_point now = Clock::now();
  if (phase != phase_) {  // its name at once: a factorisation says nothing until it is done
    phase_ = phase;
    start_ = now;
    put(phase + " ...");
    return;
  }
  constexpr std::chrono::milliseconds pause{200};
  if (now - shown_ < pause || fraction >= 1.0) return;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const std::optional<std::string> text = progress_text(phase, fraction, elapsed_s);
  if (!text) return;
  put(*text);
  shown_ = now;
}

void ProgressLine::put(const std::string& text)
{
  fmt::print(stderr, "\r\033[K{}", text);
  std::fflush(stderr);
  visible_ = true;
}

}  // namespace chladni::report
