#include <array>
#include <cmath>
#include <initializer_list>

#include "building.hpp"

namespace chladni::strangers {

namespace {

using Eigen::Vector3d;

/// A straight beam in its plane, deflection and slope of each node; `first` held from the left.
Pencil plane_beam(const std::string& name, int n_elements, double length, double bending,
                  double mass)
{
  Pencil beam{.name = name, .n = 2 * (n_elements + 1), .n_rigid = 2};
  const ElementMatrices e = beam_element(length / n_elements, bending, mass);
  for (int i = 0; i < n_elements; ++i) {
    const std::array<int, 4> dofs{2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3};
    add(beam.K, dofs, e.K);
    add(beam.M, dofs, e.M);
  }
  return beam;
}

Pencil free_beam(int n_elements, const std::string& name)
{
  Pencil beam = plane_beam(name, n_elements, 1.0, 1.0, 1.0);
  beam.masters = {0, 1, beam.n - 2, beam.n - 1};
  return beam;
}

/// The left end is held by an element that bends easily; all deflections are masters, so that
/// slopes alone are left out.
Pencil soft_rooted_beam_on_its_deflections()
{
  constexpr int n_elements = 60;
  Pencil beam{.name = "SoftRootedBeamOnItsDeflections", .n = 2 * n_elements};
  for (int i = 0; i < n_elements; ++i) {
    const ElementMatrices e = beam_element(1.0 / n_elements, i == 0 ? 1e-5 : 1.0, 1.0);
    const int left = i == 0 ? -1 : 2 * i - 2;
    const std::array<int, 4> dofs{left, i == 0 ? -1 : left + 1, 2 * i, 2 * i + 1};
    add(beam.K, dofs, e.K);
    add(beam.M, dofs, e.M);
    beam.masters.push_back(2 * i);
  }
  return beam;
}

constexpr FrameSection steel_tube{.young = 2.1e11,
                                  .shear = 8.1e10,
                                  .density = 7850.0,
                                  .area = 1e-3,
                                  .inertia_y = 1e-6,
                                  .inertia_z = 1e-6,
                                  .torsion = 2e-6};

struct Rod {
  int from, to;
};

/// Rods between points, six DOFs each.
Pencil frame(const std::string& name, const std::vector<Vector3d>& points,
             const std::vector<Rod>& rods, const FrameSection& section)
{
  Pencil pencil{.name = name, .n = 6 * static_cast<int>(points.size()), .n_rigid = 6};
  for (const Rod& rod : rods) {
    const ElementMatrices e = frame_element(points[rod.from], points[rod.to], section);
    std::array<int, 12> dofs{};
    for (int c = 0; c < 6; ++c) {
      dofs[c] = 6 * rod.from + c;
      dofs[6 + c] = 6 * rod.to + c;
    }
    add(pencil.K, dofs, e.K);
    add(pencil.M, dofs, e.M);
  }
  return pencil;
}

/// A straight row of rods in space: free, all rows of an end are masters.
Pencil straight_rods(int n_rods, const std::string& name, const FrameSection& section)
{
  std::vector<Vector3d> points;
  std::vector<Rod> rods;
  for (int i = 0; i <= n_rods; ++i) points.emplace_back(double(i) / n_rods, 0.0, 0.0);
  for (int i = 0; i < n_rods; ++i) rods.push_back({i, i + 1});
  Pencil pencil = frame(name, points, rods, section);
  for (int c = 0; c < 6; ++c) pencil.masters.push_back(c);
  for (int c = 0; c < 6; ++c) pencil.masters.push_back(6 * n_rods + c);
  return pencil;
}

/// A tower of two cubes: 12 points, 28 rods, every angle.
Pencil tower(const std::string& name)
{
  std::vector<Vector3d> points;
  std::vector<Rod> rods;
  for (int level = 0; level < 3; ++level) {
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.1}, {1.1, 0.9}, {0.05, 1.0}})
      points.emplace_back(x, y, 1.2 * level);
    for (int i = 0; i < 4; ++i) {
      rods.push_back({4 * level + i, 4 * level + (i + 1) % 4});
      if (level == 0) continue;
      rods.push_back({4 * level - 4 + i, 4 * level + i});
      rods.push_back({4 * level - 4 + i, 4 * level + (i + 1) % 4});
    }
  }
  return frame(name, points, rods, steel_tube);
}

/// 48 DOFs: the lowest level of the tower is held, lumped masses have no rotary inertia.
Pencil frame_with_lumped_masses()
{
  const Pencil whole = tower("");
  Pencil held{.name = "FrameOf48WithLumpedMasses", .n = whole.n - 24};
  for (const Entry& k : whole.K)
    if (k.row >= 24 && k.column >= 24) held.K.push_back({k.row - 24, k.column - 24, k.value});
  for (int i = 0; i < held.n; ++i)
    if (i % 6 < 3) add_diagonal(held.M, i, 10.0);
  held.masters = {24, 25, 26, 36, 37, 38};
  return held;
}

/// x, y and z of one point, x and z of another, z of a third: what holds a body and no more.
Pencil tower_on_isostatic_mounts()
{
  Pencil pencil = tower("TowerOnIsostaticMounts");
  pencil.masters = {0, 1, 2, 6 * 1 + 1, 6 * 1 + 2, 6 * 3 + 2};
  return pencil;
}

struct Counts {
  int x, y, z;
};

/// Node i + j (x + 1) + k (x + 1)(y + 1) of a block of hexahedra.
int node(const Counts& n, int i, int j, int k)
{
  return i + (n.x + 1) * (j + (n.y + 1) * k);
}

Pencil block(const std::string& name, const Counts& n, const Vector3d& edges, const Solid& solid)
{
  Pencil pencil{.name = name, .n = 3 * (n.x + 1) * (n.y + 1) * (n.z + 1), .n_rigid = 6};
  const ElementMatrices e = hexahedron(edges, solid);
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) {
        std::array<int, 24> dofs{};
        for (int c = 0; c < 24; ++c) {
          const int at = c / 3;
          dofs[c] = 3 * node(n, i + at % 2, j + at / 2 % 2, k + at / 4) + c % 3;
        }
        add(pencil.K, dofs, e.K);
        add(pencil.M, dofs, e.M);
      }
    }
  }
  return pencil;
}

void append_node(std::vector<int>& masters, int at)
{
  for (int c = 0; c < 3; ++c) masters.push_back(3 * at + c);
}

constexpr Solid steel{.young = 2.1e11, .poisson = 0.3, .density = 7850.0};

/// Free, three corners are masters.
Pencil bar(const std::string& name, const Counts& n, double edge, const Solid& solid)
{
  Pencil pencil = block(name, n, Vector3d::Constant(edge), solid);
  append_node(pencil.masters, node(n, 0, 0, 0));
  append_node(pencil.masters, node(n, n.x, 0, 0));
  append_node(pencil.masters, node(n, 0, n.y, n.z));
  return pencil;
}

Pencil bar_on_isostatic_mounts()
{
  constexpr Counts n{10, 2, 2};
  Pencil pencil = bar("BarOnIsostaticMounts", n, 0.1, steel);
  const int b = 3 * node(n, n.x, 0, 0), c = 3 * node(n, 0, n.y, 0);
  pencil.masters = {0, 1, 2, b + 1, b + 2, c + 2};
  return pencil;
}

/// Held at one face as MatZeroRowsColumns(..., 1) does it: unit rows that belong to nothing.
Pencil block_with_unit_rows()
{
  constexpr Counts n{6, 4, 4};
  Pencil whole = block("BlockWithUnitRows", n, Vector3d(0.1, 0.12, 0.13), steel);
  const auto held = [&](int row) { return row / 3 % (n.x + 1) == 0 || row == whole.n - 1; };
  Pencil pencil{.name = whole.name, .n = whole.n};
  for (const Entry& k : whole.K)
    if (!held(k.row) && !held(k.column)) pencil.K.push_back(k);
  for (int i = 0; i < pencil.n; ++i)
    if (held(i)) add_diagonal(pencil.K, i, 1.0);
  add_identity(pencil.M, pencil.n);
  append_node(pencil.masters, node(n, n.x, 2, 2));
  return pencil;
}

Pencil held_block()
{
  constexpr Counts n{4, 3, 3};
  const Pencil whole = block("HeldBlock", n, Vector3d::Constant(0.1), steel);
  std::vector<int> row(whole.n, -1);
  Pencil pencil{.name = whole.name};
  for (int i = 0; i < whole.n; ++i)
    if (i / 3 % (n.x + 1) != 0) row[i] = pencil.n++;
  const auto keep = [&](const std::vector<Entry>& from, std::vector<Entry>& to) {
    for (const Entry& a : from)
      if (row[a.row] >= 0 && row[a.column] >= 0) to.push_back({row[a.row], row[a.column], a.value});
  };
  keep(whole.K, pencil.K);
  keep(whole.M, pencil.M);
  for (int c = 0; c < 3; ++c) pencil.masters.push_back(row[3 * node(n, n.x, n.y, n.z) + c]);
  return pencil;
}

/// Equal blades of four masses on a hub: every mode with the hub held is there once for each blade.
Pencil blades(const std::string& name, int n_blades)
{
  Pencil pencil{.name = name, .n = 1 + 4 * n_blades};
  add_diagonal(pencil.K, 0, 1e3);
  add_diagonal(pencil.M, 0, 50.0);
  for (int b = 0; b < n_blades; ++b) {
    for (int i = 1; i <= 4; ++i) {
      const int row = 4 * b + i;
      add_spring(pencil.K, i == 1 ? 0 : row - 1, row, 100.0 / i);
      add_diagonal(pencil.M, row, 1.0 + 0.25 * i);
    }
  }
  pencil.masters = {0};
  return pencil;
}

/// Linear elements of Timoshenko with one Gauss point, clamped; the shear is (l / t)^2 as stiff.
Pencil thin_foil(const std::string& name, double thickness)
{
  constexpr int n_elements = 60;
  Pencil pencil{.name = name, .n = 2 * n_elements};
  const double l = 1.0 / n_elements, EI = std::pow(thickness, 3) / 12.0, GA = thickness / 3.0;
  for (int i = 0; i < n_elements; ++i) {
    const int left = i == 0 ? -1 : 2 * i - 2;
    const std::array<int, 4> dofs{left, i == 0 ? -1 : left + 1, 2 * i, 2 * i + 1};
    const Eigen::Vector4d shear(-1.0 / l, -0.5, 1.0 / l, -0.5), bend(0, -1.0 / l, 0, 1.0 / l);
    add(pencil.K, dofs, l * (GA * shear * shear.transpose() + EI * bend * bend.transpose()));
  }
  for (int i = 0; i < n_elements; ++i) {
    const double share = i + 1 == n_elements ? 0.5 : 1.0;
    add_diagonal(pencil.M, 2 * i, share * l * thickness);
    add_diagonal(pencil.M, 2 * i + 1, share * l * EI);
  }
  pencil.masters = {pencil.n - 2, pencil.n - 1};
  return pencil;
}

struct Link {
  int i, j;
  double k;
};

Pencil chain(const std::string& name, const std::vector<double>& mass,
             const std::vector<Link>& springs)
{
  Pencil pencil{.name = name, .n = static_cast<int>(mass.size())};
  for (const Link& spring : springs)
    if (spring.j < 0)
      add_diagonal(pencil.K, spring.i, spring.k);
    else
      add_spring(pencil.K, spring.i, spring.j, spring.k);
  for (int i = 0; i < pencil.n; ++i)
    if (mass[i] != 0.0) add_diagonal(pencil.M, i, mass[i]);
  return pencil;
}

std::vector<Link> row_of_springs(int n, double k)
{
  std::vector<Link> springs;
  for (int i = 0; i + 1 < n; ++i) springs.push_back({i, i + 1, k});
  return springs;
}

Pencil free_chain_on_an_inner_mass()
{
  Pencil pencil =
      chain("FreeChainOnAnInnerMass", std::vector<double>(40, 1.0), row_of_springs(40, 1.0));
  pencil.n_rigid = 1;
  pencil.masters = {17};
  return pencil;
}

Pencil massless(const std::string& name, const std::vector<int>& without_mass)
{
  std::vector<double> mass(50, 1.0);
  for (const int i : without_mass) mass[i] = 0.0;
  std::vector<Link> springs = row_of_springs(50, 10.0);
  springs.push_back({49, -1, 10.0});
  Pencil pencil = chain(name, mass, springs);
  pencil.masters = {0, 25};
  return pencil;
}

Pencil one_heavy_mass()
{
  std::vector<double> mass(40, 1.0);
  mass[20] = 1e12;
  std::vector<Link> springs = row_of_springs(40, 1.0);
  springs.push_back({0, -1, 1.0});
  Pencil pencil = chain("OneMassOf1e12", mass, springs);
  pencil.masters = {39};
  return pencil;
}

Pencil stiffness_contrast()
{
  std::vector<Link> springs = row_of_springs(60, 1.0);
  for (std::size_t i = 0; i < springs.size(); i += 2) springs[i].k = 1e10;
  springs.push_back({0, -1, 1.0});
  Pencil pencil = chain("StiffnessContrastOf1e10", std::vector<double>(60, 1.0), springs);
  pencil.masters = {59};
  return pencil;
}

Pencil two_free_bodies()
{
  std::vector<Link> springs = row_of_springs(60, 1.0);
  springs.erase(springs.begin() + 29);
  Pencil pencil = chain("TwoFreeBodies", std::vector<double>(60, 1.0), springs);
  pencil.n_rigid = 2;
  pencil.masters = {3, 44};
  return pencil;
}

}  // namespace

std::vector<Pencil> mechanical_pencils()
{
  const FrameSection cable{1e7, 4e6, 1000.0, 1e-4, 1e-10, 1e-10, 2e-10};
  const Solid steel_in_mm{.young = 2.1e5, .poisson = 0.3, .density = 7.85e-9};
  return {free_beam(40, "FreeBeam"),
          soft_rooted_beam_on_its_deflections(),
          straight_rods(20, "FreeCableInSpace", cable),
          tower_on_isostatic_mounts(),
          frame_with_lumped_masses(),
          bar("FreeBar", {10, 2, 2}, 0.1, steel),
          bar("FreeGrainOf1mm", {4, 2, 2}, 2.5e-4, steel),
          bar("FreeShipOf100m", {8, 2, 1}, 12.5, steel),
          bar("FreeBarInMillimetres", {6, 2, 2}, 10.0, steel_in_mm),
          bar("CompactFreeSolid", {3, 3, 3}, 0.1, steel),
          bar_on_isostatic_mounts(),
          held_block(),
          block_with_unit_rows(),
          blades("Blades36", 36),
          blades("Blades9", 9),
          thin_foil("Foil1in1000", 1e-3),
          thin_foil("Foil1in10000", 1e-4),
          free_chain_on_an_inner_mass(),
          massless("MasslessMasters", {0, 25}),
          massless("MasslessSlaves", {3, 4, 5, 30, 48}),
          massless("MasslessHalf", {26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37,
                                    38, 39, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49}),
          one_heavy_mass(),
          stiffness_contrast(),
          two_free_bodies(),
          straight_rods(40, "StraightRods40", steel_tube)};
}

}  // namespace chladni::strangers
