// A library to be loaded before MPI (LD_PRELOAD), which counts what each rank does by itself: the
// CPU time between its calls of MPI, by the phases and the events in them that the program names
// with MPI_Pcontrol (1 and 2; 0 and 3 end them), and what it sends. Waiting in MPI does not count,
// so that the numbers mean something where many ranks share few cores. MPI_Finalize writes them to
// the file that WORK_OUTSIDE_MPI names.
#include <mpi.h>

#include <algorithm>
#include <bit>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <vector>

namespace {

struct Counted {
  double work_s = 0.0;
  double sent = 0.0, received = 0.0;  ///< bytes
  double messages = 0.0;              ///< one after the other: see `count` and `exchange`
};

std::map<std::string, Counted>& phases()
{
  static std::map<std::string, Counted> all;
  return all;
}

std::string phase;
std::vector<std::string> events;  ///< under way within the phase
Counted* now = nullptr;
double since = 0.0;

double cpu_s()
{
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

void leave()
{
  since = cpu_s();
}

void enter()
{
  if (now != nullptr) now->work_s += cpu_s() - since;
}

void turn_to(const std::string& name)
{
  enter();
  now = &phases()[name];
  leave();
}

std::string event()
{
  return events.empty() ? phase : phase + '/' + events.back();
}

void begin_phase(const char* name)
{
  phase = name;
  turn_to(event());
}

double size_of(MPI_Datatype type)
{
  int size = 0;
  PMPI_Type_size(type, &size);
  return size;
}

int ranks_of(MPI_Comm comm)
{
  int size = 1;
  PMPI_Comm_size(comm, &size);
  return size;
}

/// Without those of this rank for itself.
double sum(const int* counts, MPI_Comm comm)
{
  int rank = 0;
  PMPI_Comm_rank(comm, &rank);
  double all = 0.0;
  for (int q = 0; counts != nullptr && q < ranks_of(comm); ++q)
    if (q != rank) all += counts[q];
  return all;
}

/// A call of all ranks of a communicator, along a binary tree so many times, in which this rank
/// sends and receives as many bytes.
void count(MPI_Comm comm, double times, double bytes)
{
  if (now == nullptr || ranks_of(comm) == 1) return;
  now->messages += times * std::bit_width(unsigned(ranks_of(comm) - 1));
  now->sent += bytes;
  now->received += bytes;
}

void count_sent(double bytes)
{
  if (now == nullptr) return;
  now->messages += 1.0;
  now->sent += bytes;
}

void count_received(double bytes)
{
  if (now != nullptr) now->received += bytes;
}

/// A message to each rank that gets something.
void exchange(const int* sent, MPI_Datatype type, const int* received, MPI_Datatype received_type,
              MPI_Comm comm)
{
  if (now == nullptr) return;
  int rank = 0;
  PMPI_Comm_rank(comm, &rank);
  for (int q = 0; q < ranks_of(comm); ++q)
    if (q != rank && sent[q] > 0) now->messages += 1.0;
  now->sent += sum(sent, comm) * size_of(type);
  now->received += sum(received, comm) * size_of(received_type);
}

/// Bytes of persistent requests: sent, or received (negative).
std::map<MPI_Request, double>& persistent()
{
  static std::map<MPI_Request, double> all;
  return all;
}

void start(int n, const MPI_Request* requests)
{
  for (int i = 0; i < n; ++i) {
    const auto known = persistent().find(requests[i]);
    if (known == persistent().end()) continue;
    if (known->second > 0.0)
      count_sent(known->second);
    else
      count_received(-known->second);
  }
}

std::string as_json()
{
  std::string text = "{";
  for (const auto& [name, counted] : phases()) {
    char line[256];
    std::snprintf(line, sizeof line,
                  "%s\"%s\": {\"work_s\": %.6f, \"bytes\": %.0f, \"messages\": %.0f}",
                  text.size() == 1 ? "" : ", ", name.c_str(), counted.work_s,
                  std::max(counted.sent, counted.received), counted.messages);
    text += line;
  }
  return text + "}";
}

/// The counts of this rank, in a file of its own.
void write()
{
  const char* path = std::getenv("WORK_OUTSIDE_MPI");
  if (path == nullptr) return;
  int rank = 0;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::FILE* file = std::fopen((path + ('.' + std::to_string(rank))).c_str(), "w");
  if (file == nullptr) return;
  std::fputs(as_json().c_str(), file);
  std::fclose(file);
}

}  // namespace

// Each function of MPI that waits, or may.
#define COUNTED(name, parameters, arguments, counts) \
  int MPI_##name parameters                          \
  {                                                  \
    enter();                                         \
    counts;                                          \
    const int status = PMPI_##name arguments;        \
    leave();                                         \
    return status;                                   \
  }

extern "C" {

int MPI_Init(int* argc, char*** argv)
{
  const int status = PMPI_Init(argc, argv);
  begin_phase("start");
  return status;
}

int MPI_Init_thread(int* argc, char*** argv, int required, int* provided)
{
  const int status = PMPI_Init_thread(argc, argv, required, provided);
  begin_phase("start");
  return status;
}

int MPI_Pcontrol(const int level, ...)
{
  std::va_list arguments;
  va_start(arguments, level);
  switch (level) {
    case 1:
      begin_phase(va_arg(arguments, const char*));
      break;
    case 2:
      events.emplace_back(va_arg(arguments, const char*));
      turn_to(event());
      break;
    case 3:
      if (!events.empty()) events.pop_back();
      turn_to(event());
      break;
    default:
      begin_phase("between");
  }
  va_end(arguments);
  return MPI_SUCCESS;
}

int MPI_Finalize()
{
  enter();
  write();
  return PMPI_Finalize();
}

COUNTED(Barrier, (MPI_Comm c), (c), count(c, 1, 0.0))
COUNTED(Bcast, (void* a, int n, MPI_Datatype t, int r, MPI_Comm c), (a, n, t, r, c),
        count(c, 1, n* size_of(t)))
COUNTED(Allreduce, (const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c),
        (a, b, n, t, o, c), count(c, 2, 2.0 * n * size_of(t)))
COUNTED(Reduce, (const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, int r, MPI_Comm c),
        (a, b, n, t, o, r, c), count(c, 1, n* size_of(t)))
COUNTED(Exscan, (const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c),
        (a, b, n, t, o, c), count(c, 1, n* size_of(t)))
COUNTED(Scan, (const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c),
        (a, b, n, t, o, c), count(c, 1, n* size_of(t)))
COUNTED(Allgather,
        (const void* a, int n, MPI_Datatype t, void* b, int m, MPI_Datatype u, MPI_Comm c),
        (a, n, t, b, m, u, c), count(c, 1, double(m) * ranks_of(c) * size_of(u)))
COUNTED(Allgatherv,
        (const void* a, int n, MPI_Datatype t, void* b, const int* m, const int* d, MPI_Datatype u,
         MPI_Comm c),
        (a, n, t, b, m, d, u, c), count(c, 1, sum(m, c) * size_of(u)))
COUNTED(Gather,
        (const void* a, int n, MPI_Datatype t, void* b, int m, MPI_Datatype u, int r, MPI_Comm c),
        (a, n, t, b, m, u, r, c), count(c, 1, double(n) * ranks_of(c) * size_of(t)))
COUNTED(Gatherv,
        (const void* a, int n, MPI_Datatype t, void* b, const int* m, const int* d, MPI_Datatype u,
         int r, MPI_Comm c),
        (a, n, t, b, m, d, u, r, c),
        count(c, 1, b == nullptr ? n * size_of(t) : sum(m, c) * size_of(t)))
COUNTED(Scatter,
        (const void* a, int n, MPI_Datatype t, void* b, int m, MPI_Datatype u, int r, MPI_Comm c),
        (a, n, t, b, m, u, r, c), count(c, 1, double(m) * ranks_of(c) * size_of(u)))
COUNTED(Scatterv,
        (const void* a, const int* n, const int* d, MPI_Datatype t, void* b, int m, MPI_Datatype u,
         int r, MPI_Comm c),
        (a, n, d, t, b, m, u, r, c),
        count(c, 1, n == nullptr ? m * size_of(u) : sum(n, c) * size_of(u)))
COUNTED(Alltoall,
        (const void* a, int n, MPI_Datatype t, void* b, int m, MPI_Datatype u, MPI_Comm c),
        (a, n, t, b, m, u, c), count(c, 1, double(m) * ranks_of(c) * size_of(u)))
COUNTED(Alltoallv,
        (const void* a, const int* n, const int* d, MPI_Datatype t, void* b, const int* m,
         const int* e, MPI_Datatype u, MPI_Comm c),
        (a, n, d, t, b, m, e, u, c), exchange(n, t, m, u, c))
COUNTED(Reduce_scatter_block, (const void* a, void* b, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c),
        (a, b, n, t, o, c), count(c, 1, double(n) * ranks_of(c) * size_of(t)))
COUNTED(Send, (const void* a, int n, MPI_Datatype t, int r, int g, MPI_Comm c), (a, n, t, r, g, c),
        count_sent(n* size_of(t)))
COUNTED(Isend, (const void* a, int n, MPI_Datatype t, int r, int g, MPI_Comm c, MPI_Request* q),
        (a, n, t, r, g, c, q), count_sent(n* size_of(t)))
COUNTED(Recv, (void* a, int n, MPI_Datatype t, int r, int g, MPI_Comm c, MPI_Status* s),
        (a, n, t, r, g, c, s), count_received(n* size_of(t)))
COUNTED(Irecv, (void* a, int n, MPI_Datatype t, int r, int g, MPI_Comm c, MPI_Request* q),
        (a, n, t, r, g, c, q), count_received(n* size_of(t)))
COUNTED(Startall, (int n, MPI_Request* q), (n, q), start(n, q))

int MPI_Send_init(const void* a, int n, MPI_Datatype t, int r, int g, MPI_Comm c, MPI_Request* q)
{
  const int status = PMPI_Send_init(a, n, t, r, g, c, q);
  persistent()[*q] = n * size_of(t);
  return status;
}

int MPI_Recv_init(void* a, int n, MPI_Datatype t, int r, int g, MPI_Comm c, MPI_Request* q)
{
  const int status = PMPI_Recv_init(a, n, t, r, g, c, q);
  persistent()[*q] = -n * size_of(t);
  return status;
}

COUNTED(Wait, (MPI_Request * q, MPI_Status* s), (q, s), )
COUNTED(Waitall, (int n, MPI_Request* q, MPI_Status* s), (n, q, s), )
COUNTED(Waitany, (int n, MPI_Request* q, int* i, MPI_Status* s), (n, q, i, s), )
COUNTED(Waitsome, (int n, MPI_Request* q, int* m, int* i, MPI_Status* s), (n, q, m, i, s), )
COUNTED(Test, (MPI_Request * q, int* f, MPI_Status* s), (q, f, s), )
COUNTED(Testall, (int n, MPI_Request* q, int* f, MPI_Status* s), (n, q, f, s), )
COUNTED(Probe, (int r, int g, MPI_Comm c, MPI_Status* s), (r, g, c, s), )
COUNTED(Iprobe, (int r, int g, MPI_Comm c, int* f, MPI_Status* s), (r, g, c, f, s), )
COUNTED(Ibarrier, (MPI_Comm c, MPI_Request* q), (c, q), count(c, 1, 0.0))
COUNTED(Comm_dup, (MPI_Comm c, MPI_Comm* d), (c, d), count(c, 2, 0.0))
COUNTED(Comm_split, (MPI_Comm c, int k, int l, MPI_Comm* d), (c, k, l, d), count(c, 2, 0.0))
COUNTED(Comm_create_group, (MPI_Comm c, MPI_Group g, int t, MPI_Comm* d), (c, g, t, d), )
COUNTED(Comm_free, (MPI_Comm * c), (c), )

}  // extern "C"
