#include "linear/machine_memory.hpp"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "common/petsc.hpp"

namespace chladni::linear {

namespace {

double sum_on_machine(double own, MPI_Comm comm)
{
  double sum = own;
  MPI_Comm same_memory = MPI_COMM_NULL;
  MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &same_memory);
  MPI_Allreduce(&own, &sum, 1, MPI_DOUBLE, MPI_SUM, same_memory);
  MPI_Comm_free(&same_memory);
  return sum;
}

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number in a file; infinity where there is none, as "max".
double number_in(const std::filesystem::path& file)
{
  std::ifstream stream(file);
  double number = unlimited;
  return stream >> number ? number : unlimited;
}

/// The number behind a name in a file of names and numbers; 0 where there is none.
double named_number(const std::filesystem::path& file, const std::string& wanted)
{
  std::ifstream stream(file);
  double number = 0.0;
  for (std::string name; stream >> name >> number;)
    if (name == wanted) return number;
  return 0.0;
}

/// How a version of control groups names its files.
struct GroupFiles {
  std::filesystem::path folder;
  const char *limit, *taken, *active_files, *inactive_files;
};

double free_bytes(const std::filesystem::path& group, const GroupFiles& names)
{
  const double limit = number_in(group / names.limit), taken = number_in(group / names.taken);
  if (limit == unlimited || taken == unlimited) return unlimited;
  const std::filesystem::path statistics = group / "memory.stat";
  const double files =
      named_number(statistics, names.active_files) + named_number(statistics, names.inactive_files);
  return std::max(0.0, limit - std::max(0.0, taken - files));
}

/// Of a group and of all above it. In a container the path of a group is that of the machine, and
/// the files of the group are those of the root.
double free_bytes_up_to_root(std::filesystem::path group, const GroupFiles& names)
{
  double free = free_bytes(names.folder, names);
  for (group = group.relative_path(); !group.empty(); group = group.parent_path())
    free = std::min(free, free_bytes(names.folder / group, names));
  return free;
}

}  // namespace

double free_MiB_of_control_group(const ControlGroups& where)
{
  const GroupFiles first{where.root / "memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
                         "total_active_file", "total_inactive_file"};
  const GroupFiles second{where.root, "memory.max", "memory.current", "active_file",
                          "inactive_file"};
  std::ifstream groups(where.groups);
  double free = unlimited;
  for (std::string line; std::getline(groups, line);) {  // number:controllers:path
    const std::size_t name = line.find(':'), path = line.find(':', name + 1);
    if (path == std::string::npos) continue;
    const std::string_view controllers = std::string_view(line).substr(name + 1, path - name - 1);
    const std::filesystem::path group = line.substr(path + 1);
    if (controllers.empty()) free = std::min(free, free_bytes_up_to_root(group, second));
    if (controllers == "memory") free = std::min(free, free_bytes_up_to_root(group, first));
  }
  return free / bytes_in_MiB;
}

namespace {

double free_MiB_of_machine()
{
  std::ifstream meminfo("/proc/meminfo");
  std::string name, unit;
  double KiB = 0.0;
  while (meminfo >> name >> KiB) {
    if (name == "MemAvailable:") return KiB / 1024.0;
    std::getline(meminfo, unit);
  }
  return unlimited;
}

}  // namespace

double free_MiB()
{
  return std::min(free_MiB_of_machine(), free_MiB_of_control_group());
}

void give_back_freed()
{
  malloc_trim(0);
}

double freed_MiB()
{
  return static_cast<double>(mallinfo2().fordblks) / (1024.0 * 1024.0);
}

double resident_MiB()
{
  std::ifstream pages("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  pages >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / bytes_in_MiB;
}

MemoryNeed tightest_machine(double own_MiB, double free_MiB, MPI_Comm comm)
{
  std::array<double, 2> need{sum_on_machine(own_MiB, comm), free_MiB};
  struct {
    double lacking;
    int rank;
  } here{need[0] - need[1], petsc::rank(comm)}, worst{};
  MPI_Allreduce(&here, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm);
  MPI_Bcast(need.data(), 2, MPI_DOUBLE, worst.rank, comm);
  return {.needed_MiB = need[0], .free_MiB = need[1]};
}

void require_memory(double own_MiB, const std::string& what, const std::string& cure, MPI_Comm comm)
{
  const MemoryNeed need = tightest_machine(own_MiB, free_MiB(), comm);
  if (need.fits()) return;
  throw Error(
      fmt::format("{} needs {:.0f} MiB more on one machine, and {:.0f} MiB are free there; {}",
                  what, need.needed_MiB, need.free_MiB, cure));
}

}  // namespace chladni::linear
