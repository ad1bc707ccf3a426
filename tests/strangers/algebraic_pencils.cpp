#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "building.hpp"

namespace chladni::strangers {

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

/// L + s I with M = I; s = 0 makes the constant vector a rigid motion.
Pencil laplacian(const std::string& name, int n, const std::vector<std::pair<int, int>>& edges,
                 double s)
{
  Pencil graph{.name = name, .n = n, .n_rigid = s == 0.0 ? 1 : 0, .masters = {0}};
  for (const auto& [i, j] : edges) add_spring(graph.K, i, j, 1.0);
  if (s != 0.0) add_identity(graph.K, n, s);
  add_identity(graph.M, n);
  return graph;
}

Pencil path(const std::string& name, int n, double s)
{
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i + 1 < n; ++i) edges.emplace_back(i, i + 1);
  return laplacian(name, n, edges, s);
}

Pencil cycle(const std::string& name, int n, double s)
{
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i < n; ++i) edges.emplace_back(i, (i + 1) % n);
  return laplacian(name, n, edges, s);
}

Pencil hypercube(const std::string& name, int dimension, double s)
{
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i < 1 << dimension; ++i) {
    for (int bit = 0; bit < dimension; ++bit)
      if ((i & 1 << bit) == 0) edges.emplace_back(i, i | 1 << bit);
  }
  return laplacian(name, 1 << dimension, edges, s);
}

Pencil complete(const std::string& name, int n, double s)
{
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j) edges.emplace_back(i, j);
  return laplacian(name, n, edges, s);
}

/// The centre or a leaf is the master.
Pencil star(const std::string& name, int n, int master)
{
  std::vector<std::pair<int, int>> edges;
  for (int i = 1; i < n; ++i) edges.emplace_back(0, i);
  Pencil graph = laplacian(name, n, edges, 1.0);
  graph.masters = {master};
  return graph;
}

/// A ring whose nodes are tied to a hub alike: with the hub held, eigenvalues are double.
Pencil wheel(const std::string& name, int n_ring)
{
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i < n_ring; ++i) {
    edges.emplace_back(1 + i, 1 + (i + 1) % n_ring);
    edges.emplace_back(0, 1 + i);
  }
  return laplacian(name, n_ring + 1, edges, 0.0);
}

/// Lines of very different admittance between buses, some to the ground.
Pencil power_network()
{
  constexpr int n = 300;
  std::mt19937 random(494);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  Pencil network{.name = "PowerNetwork", .n = n, .masters = {0, 7, 150, 299}};
  for (int i = 1; i < n; ++i)
    add_spring(network.K, i, static_cast<int>(uniform() * i), std::pow(10.0, 4.0 * uniform()));
  for (int i = 0; i < n / 2; ++i) {
    const int a = static_cast<int>(uniform() * n), b = static_cast<int>(uniform() * n);
    if (a != b) add_spring(network.K, a, b, std::pow(10.0, 4.0 * uniform()));
  }
  for (int i = 0; i < n; i += 25) add_diagonal(network.K, i, uniform());
  add_identity(network.M, n);
  return network;
}

/// A square membrane of m x m points, T (x) I + I (x) T: double eigenvalues and more.
Pencil membrane(const std::string& name, int m, const std::vector<int>& masters)
{
  Pencil pencil{.name = name, .n = m * m, .masters = masters};
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < m; ++i) {
      const int at = i + m * j;
      add_diagonal(pencil.K, at, 4.0);
      if (i + 1 < m) pencil.K.insert(pencil.K.end(), {{at, at + 1, -1.0}, {at + 1, at, -1.0}});
      if (j + 1 < m) pencil.K.insert(pencil.K.end(), {{at, at + m, -1.0}, {at + m, at, -1.0}});
    }
  }
  add_identity(pencil.M, pencil.n);
  return pencil;
}

Pencil diagonal(const std::string& name, const std::vector<double>& values)
{
  Pencil pencil{.name = name, .n = static_cast<int>(values.size()), .masters = {0}};
  for (int i = 0; i < pencil.n; ++i) add_diagonal(pencil.K, i, values[i]);
  add_identity(pencil.M, pencil.n);
  return pencil;
}

/// One value many times, then others that grow.
std::vector<double> cluster(int n_equal, int n_others, double spacing)
{
  std::vector<double> values{7.0};  // of the master
  for (int i = 0; i < n_equal; ++i) values.push_back(1.0 + spacing * i);
  for (int i = 0; i < n_others; ++i) values.push_back(2.0 + i);
  return values;
}

/// H diag(values) H with a reflection H: the same spectrum in a full matrix, all rows coupled.
Pencil reflected(const std::string& name, const std::vector<double>& values)
{
  const auto n = static_cast<int>(values.size());
  VectorXd v(n);
  for (int i = 0; i < n; ++i) v[i] = 1.0 + 0.5 * std::sin(3.0 * i);
  const MatrixXd H = MatrixXd::Identity(n, n) - 2.0 / v.squaredNorm() * v * v.transpose();
  MatrixXd A = H * VectorXd::Map(values.data(), n).asDiagonal() * H;
  A = (0.5 * (A + A.transpose())).eval();
  Pencil pencil{.name = name, .n = n, .masters = {0, 1}};
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  add(pencil.K, all, A);
  add_identity(pencil.M, n);
  return pencil;
}

/// Pairs of eigenvalues that agree to 14 digits.
Pencil wilkinson()
{
  Pencil pencil{.name = "Wilkinson21", .n = 21, .masters = {10}};
  for (int i = 0; i < 21; ++i) {
    add_diagonal(pencil.K, i, std::abs(i - 10) + 3.0);
    if (i > 0) pencil.K.insert(pencil.K.end(), {{i, i - 1, 1.0}, {i - 1, i, 1.0}});
  }
  add_identity(pencil.M, 21);
  return pencil;
}

/// Full matrices of which one eigenvalue is tiny (Moler) or all spread widely (Hilbert).
template <class Value>
Pencil classical(const std::string& name, int n, const Value& value)
{
  Pencil pencil{.name = name, .n = n, .masters = {0}};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) pencil.K.push_back({i, j, value(i, j)});
  add_identity(pencil.M, n);
  return pencil;
}

/// A heavy slave that the master hides: the lowest eigenvalue is out of reach of Guyan.
Pencil heavy_slave()
{
  Pencil pencil{.name = "HeavySlave", .n = 2, .masters = {0}};
  add_diagonal(pencil.K, 0, 100.0);
  add_diagonal(pencil.K, 1, 1.0);
  add_spring(pencil.K, 0, 1, 0.1);
  add_diagonal(pencil.M, 0, 1.0);
  add_diagonal(pencil.M, 1, 1000.0);
  return pencil;
}

/// Values of round-off that stand on one side of the diagonal only, as dropped zeros leave them.
Pencil one_sided_entries()
{
  Pencil pencil = path("OneSidedEntries", 200, 1.0);
  for (int i = 0; i + 20 < 200; i += 3) pencil.K.push_back({i, i + 20, 1e-17});
  pencil.masters = {0, 199};
  return pencil;
}

/// M of half the rank, full of zeros on no diagonal: u^T M u = 0 for alternating motions.
Pencil mass_of_half_rank()
{
  Pencil pencil = path("MassOfHalfRank", 60, 1.0);
  pencil.M.clear();
  const std::vector<double> ones(4, 1.0);
  for (int i = 0; i < 60; i += 2) {
    const int ends[] = {i, i + 1};
    add(pencil.M, ends, MatrixXd::Constant(2, 2, 1.0 + 0.01 * i));
  }
  return pencil;
}

Pencil named_refusal(Pencil pencil, const std::string& name, const std::string& words)
{
  pencil.name = name;
  pencil.refusal = words;
  return pencil;
}

}  // namespace

std::vector<Pencil> algebraic_pencils()
{
  return {
      path("PathAndIdentity", 120, 1.0),
      path("Path", 120, 0.0),
      cycle("CycleAndIdentity", 90, 1.0),
      cycle("Cycle", 90, 0.0),
      hypercube("HypercubeAndIdentity", 7, 1.0),
      hypercube("Hypercube", 6, 0.0),
      complete("CompleteGraphAndIdentity", 40, 1.0),
      complete("CompleteGraph", 30, 0.0),
      star("StarOnItsCentre", 50, 0),
      star("StarOnALeaf", 50, 1),
      wheel("Wheel", 64),
      power_network(),
      membrane("MembraneOnItsCentre", 11, {60}),
      membrane("MembraneOnItsCorners", 12, {0, 11, 132, 143}),
      diagonal("Identity", std::vector<double>(40, 1.0)),
      diagonal("ClusterOf50", cluster(50, 50, 0.0)),
      diagonal("ClusterOf50Spaced1e12", cluster(50, 50, 1e-12)),
      diagonal("ClusterOf500", cluster(500, 40, 0.0)),
      reflected("ReflectedClusterOf50", cluster(50, 50, 0.0)),
      reflected("ReflectedClusterSpaced1e8", cluster(30, 30, 1e-8)),
      wilkinson(),
      classical("Moler", 12, [](int i, int j) { return i == j ? i + 1.0 : std::min(i, j) - 1.0; }),
      classical("Hilbert", 7, [](int i, int j) { return 1.0 / (i + j + 1.0); }),
      heavy_slave(),
      one_sided_entries(),
      mass_of_half_rank()};
}

std::vector<Pencil> refused_pencils()
{
  Pencil no_stiffness{.name = "", .n = 30, .n_rigid = 30, .masters = {0}};
  add_diagonal(no_stiffness.K, 0, 0.0);
  add_identity(no_stiffness.M, 30);
  Pencil empty_row = path("", 40, 1.0);
  ++empty_row.n;
  Pencil indefinite = path("", 40, 1.0);
  add_diagonal(indefinite.K, 0, -3.0);
  Pencil negative_mass = path("", 40, 1.0);
  negative_mass.M.insert(negative_mass.M.end(), {{5, 6, 4.0}, {6, 5, 4.0}});
  Pencil unsymmetric = path("", 40, 1.0);
  unsymmetric.K.push_back({3, 30, 0.5});
  Pencil free_part = path("", 40, 0.0);
  free_part.K.erase(std::remove_if(free_part.K.begin(), free_part.K.end(),
                                   [](const Entry& k) { return k.row >= 20 && k.column < 20; }),
                    free_part.K.end());
  free_part = path("", 40, 0.0);
  add_spring(free_part.K, 19, 20, -1.0);
  Pencil infinite = path("", 40, 1.0);
  add_diagonal(infinite.M, 11, std::nan(""));
  return {named_refusal(no_stiffness, "NoStiffness", "of K is empty"),
          named_refusal(empty_row, "EmptyRow", "row 40"),
          named_refusal(indefinite, "IndefiniteStiffness", "indefinite"),
          named_refusal(negative_mass, "IndefiniteMass", "indefinite"),
          named_refusal(unsymmetric, "UnsymmetricStiffness", "not symmetric"),
          named_refusal(free_part, "PartWithoutMaster", "not positive definite"),
          named_refusal(infinite, "MassThatIsNoNumber", "not finite")};
}

std::vector<Pencil> all_pencils()
{
  std::vector<Pencil> all = mechanical_pencils();
  for (const auto& more : {algebraic_pencils(), refused_pencils()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace chladni::strangers
