#pragma once

#include "Mesh/Meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>

namespace bsrtest
{
/// What is wrong with a mesh on purpose.
enum class Dirt
{
  None,
  Turned,     ///< a tenth of the faces is turned over
  Soup,       ///< every face has points of its own
  Repeated,   ///< repeated and degenerate faces, unused NaN points, faces in random order
  SpecksFins, ///< tiny bodies far away and fins on edges of the surface
};

/// A surface that depends on a seed only, and what should come of it.
struct RandomSurface
{
  bsr::TriangleMesh Mesh;
  bsr::TriangleMesh Clean; ///< the same without dirt
  Dirt Kind = Dirt::None;
  int Target = 0; ///< quads, 24 to 1000
  std::string Text;
};

/**
 * Unions of balls, bent tubes and rings, some of them subtracted, with waves and noise, sampled on
 * a grid and triangulated by marching tetrahedra: any genus, several components, slivers wherever
 * the surface passes near a grid point. Some seeds are cut by balls and planes whose triangles are
 * left out (jagged boundaries, sometimes touching themselves in a point).
 */
class RandomShape
{
public:
  RandomShape(unsigned seed, int grid) : Engine(seed * 7919U + 17U), N(grid)
  {
    const int count = 1 + this->pick(5);
    for (int i = 0; i < count; ++i)
    {
      this->Parts.push_back(this->part(i > 0 && this->pick(4) == 0));
    }
    this->Blend = this->real(12.0, 40.0);
    this->Wave = this->pick(2) ? this->real(0.0, 0.03) : 0.0;
    this->Noise = this->pick(4) == 0 ? this->real(0.0, 0.25) : 0.0;
  }

  RandomSurface make()
  {
    RandomSurface s;
    this->sample();
    this->march(s.Clean);
    this->cut(s.Clean);
    s.Target = static_cast<int>(24.0 * std::pow(1000.0 / 24.0, this->real(0.0, 1.0)));
    s.Mesh = s.Clean;
    static const std::array<Dirt, 8> kinds = {Dirt::None, Dirt::None, Dirt::None, Dirt::None,
      Dirt::Turned, Dirt::Soup, Dirt::Repeated, Dirt::SpecksFins};
    s.Kind = kinds[this->pick(8)];
    this->soil(s);
    s.Text = std::to_string(s.Mesh.Triangles.size()) + " triangles, dirt " +
             std::to_string(static_cast<int>(s.Kind)) + ", " + std::to_string(s.Target) + " quads";
    return s;
  }

private:
  using Vec3 = bsr::Vec3;
  using Index = bsr::Index;

  struct Part
  {
    int Kind;
    bool Minus;
    Vec3 C;
    Vec3 D;
    Vec3 B;
    double R;
    double T;
  };

  // Not the distributions of the standard library: their numbers differ between libraries.
  double real(double a, double b) { return a + (b - a) * (this->Engine() / 4294967296.0); }
  int pick(int n) { return static_cast<int>(this->Engine() % static_cast<unsigned>(n)); }

  Part part(bool minus)
  {
    Part p{this->pick(3), minus, {}, {}, {}, 0.0, 0.0};
    for (int k = 0; k < 3; ++k)
    {
      p.C[k] = this->real(-0.5, 0.5);
      p.D[k] = this->real(-1.0, 1.0);
      p.B[k] = this->real(-0.4, 0.4);
    }
    p.D = (p.D + Vec3(1e-3, 0, 0)).normalized();
    p.R = this->real(0.18, 0.42);
    p.T = this->real(0.07, 0.18);
    return p;
  }

  static double distance(const Part& p, const Vec3& x)
  {
    Vec3 w = x - p.C;
    const double along = w.dot(p.D);
    if (p.Kind == 0)
    {
      return w.norm() - p.R;
    }
    if (p.Kind == 1)
    {
      const double t = std::clamp(along, -2.0 * p.R, 2.0 * p.R);
      w -= t * p.D + t * t * p.B;
      return w.norm() - p.T;
    }
    const double across = std::sqrt(std::max(w.squaredNorm() - along * along, 0.0));
    return std::hypot(across - p.R, along) - p.T;
  }

  double value(const Vec3& x) const
  {
    double sum = 1e-300;
    for (const Part& p : this->Parts)
    {
      sum += p.Minus ? 0.0 : std::exp(-this->Blend * distance(p, x));
    }
    double d = -std::log(sum) / this->Blend;
    for (const Part& p : this->Parts)
    {
      d = p.Minus ? std::max(d, -distance(p, x)) : d;
    }
    return d + this->Wave * std::sin(17.0 * x[0]) * std::sin(19.0 * x[1] + 11.0 * x[2]);
  }

  Vec3 place(int i, int j, int k) const
  {
    const double h = 2.4 / (this->N - 1);
    return {i * h - 1.2, j * h - 1.2, k * h - 1.2};
  }
  Index node(int i, int j, int k) const { return (k * this->N + j) * this->N + i; }

  void sample()
  {
    this->Values.resize(static_cast<std::size_t>(this->N) * this->N * this->N);
    for (int k = 0; k < this->N; ++k)
    {
      for (int j = 0; j < this->N; ++j)
      {
        for (int i = 0; i < this->N; ++i)
        {
          const int border = std::min({i, j, k, this->N - 1 - i, this->N - 1 - j, this->N - 1 - k});
          double v = this->value(this->place(i, j, k));
          v += this->Noise * this->real(-1.0, 1.0) * 2.4 / this->N;
          this->Values[this->node(i, j, k)] =
            border == 0 ? std::max(v, 0.3 * 2.4 / this->N) : v; // closed at the box
        }
      }
    }
  }

  Index middle(bsr::TriangleMesh& mesh, Index a, Index b, const Vec3& pa, const Vec3& pb)
  {
    const auto key = std::minmax(a, b);
    const auto found = this->Middles.emplace(key, -1).first;
    if (found->second < 0)
    {
      const double t = this->Values[a] / (this->Values[a] - this->Values[b]);
      found->second = static_cast<Index>(mesh.Points.size());
      mesh.Points.emplace_back(pa + t * (pb - pa));
    }
    return found->second;
  }

  void march(bsr::TriangleMesh& mesh)
  {
    // Six tetrahedra around the diagonal 0-7 of the cube; corner c is (c & 1, c >> 1 & 1, c >> 2).
    static const int tets[6][4] = {
      {0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
    for (int k = 0; k + 1 < this->N; ++k)
    {
      for (int j = 0; j + 1 < this->N; ++j)
      {
        for (int i = 0; i + 1 < this->N; ++i)
        {
          for (const auto& tet : tets)
          {
            std::array<Index, 4> id;
            std::array<Vec3, 4> p;
            for (int c = 0; c < 4; ++c)
            {
              const int x = i + (tet[c] & 1);
              const int y = j + (tet[c] >> 1 & 1);
              const int z = k + (tet[c] >> 2);
              id[c] = this->node(x, y, z);
              p[c] = this->place(x, y, z);
            }
            this->marchTet(mesh, id, p);
          }
        }
      }
    }
  }

  void marchTet(
    bsr::TriangleMesh& mesh, const std::array<Index, 4>& id, const std::array<Vec3, 4>& p)
  {
    std::vector<int> in;
    std::vector<int> out;
    for (int c = 0; c < 4; ++c)
    {
      (this->Values[id[c]] < 0.0 ? in : out).push_back(c);
    }
    if (in.empty() || out.empty())
    {
      return;
    }
    std::vector<Index> ring;
    if (in.size() == 2)
    {
      for (const auto& e :
        {std::array<int, 2>{in[0], out[0]}, {in[0], out[1]}, {in[1], out[1]}, {in[1], out[0]}})
      {
        ring.push_back(this->middle(mesh, id[e[0]], id[e[1]], p[e[0]], p[e[1]]));
      }
    }
    else
    {
      const int apex = in.size() == 1 ? in[0] : out[0];
      for (int c : in.size() == 1 ? out : in)
      {
        ring.push_back(this->middle(mesh, id[apex], id[c], p[apex], p[c]));
      }
    }
    // Orientation from grid points alone, so that slivers turn no face over.
    std::array<Vec3, 3> at;
    for (std::size_t r = 0; r < 3; ++r)
    {
      at[r] = Vec3::Zero();
    }
    const auto mid = [&](int a, int b) { return Vec3(0.5 * (p[a] + p[b])); };
    if (in.size() == 2)
    {
      at = {mid(in[0], out[0]), mid(in[0], out[1]), mid(in[1], out[1])};
    }
    else
    {
      const int apex = in.size() == 1 ? in[0] : out[0];
      const auto& other = in.size() == 1 ? out : in;
      at = {mid(apex, other[0]), mid(apex, other[1]), mid(apex, other[2])};
    }
    const Vec3 normal = (at[1] - at[0]).cross(at[2] - at[0]);
    if (normal.dot(p[out[0]] - p[in[0]]) < 0.0)
    {
      std::reverse(ring.begin(), ring.end());
    }
    for (std::size_t r = 2; r < ring.size(); ++r)
    {
      mesh.Triangles.push_back({ring[0], ring[r - 1], ring[r]});
    }
  }

  /// Leaves triangles out: inside balls, beyond planes.
  void cut(bsr::TriangleMesh& mesh)
  {
    const int cuts = this->pick(3) == 0 ? 1 + this->pick(4) : 0;
    for (int c = 0; c < cuts && !mesh.Triangles.empty(); ++c)
    {
      const bool plane = this->pick(3) == 0;
      const Vec3 at =
        mesh.Points[mesh.Triangles[this->pick(static_cast<int>(mesh.Triangles.size()))][0]];
      const Vec3 normal = Vec3(this->real(-1, 1), this->real(-1, 1), this->real(-1, 1));
      const double radius = this->real(0.05, 0.25);
      std::vector<std::array<Index, 3>> kept;
      for (const auto& t : mesh.Triangles)
      {
        const Vec3 w = (mesh.Points[t[0]] + mesh.Points[t[1]] + mesh.Points[t[2]]) / 3.0 - at;
        if (plane ? normal.dot(w) < 0.4 * normal.norm() : w.norm() > radius)
        {
          kept.push_back(t);
        }
      }
      if (kept.size() >= 100)
      {
        mesh.Triangles.swap(kept);
      }
    }
  }

  void soil(RandomSurface& s)
  {
    bsr::TriangleMesh& mesh = s.Mesh;
    const auto n = static_cast<int>(mesh.Triangles.size());
    if (n == 0)
    {
      return;
    }
    switch (s.Kind)
    {
    case Dirt::None:
      break;
    case Dirt::Turned:
      for (int i = 0; i < n / 10; ++i)
      {
        auto& t = mesh.Triangles[this->pick(n)];
        std::swap(t[0], t[1]);
      }
      break;
    case Dirt::Soup:
    {
      std::vector<Vec3> points;
      for (auto& t : mesh.Triangles)
      {
        for (Index& v : t)
        {
          points.push_back(mesh.Points[v]);
          v = static_cast<Index>(points.size()) - 1;
        }
      }
      mesh.Points.swap(points);
      break;
    }
    case Dirt::Repeated:
      for (int i = 0; i < 30; ++i)
      {
        auto t = mesh.Triangles[this->pick(n)];
        std::rotate(t.begin(), t.begin() + this->pick(3), t.end());
        mesh.Triangles.push_back(t);
        t[1] = t[0];
        mesh.Triangles.push_back(t);
        mesh.Points.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
      }
      for (std::size_t i = mesh.Triangles.size(); i > 1; --i)
      {
        std::swap(mesh.Triangles[i - 1], mesh.Triangles[this->pick(static_cast<int>(i))]);
      }
      break;
    case Dirt::SpecksFins:
      for (int i = 0; i < 5; ++i)
      {
        this->addSpeck(mesh, Vec3(3.0 + i, this->real(-1, 1), 0.0), 1e-4);
        const auto t = mesh.Triangles[this->pick(n)];
        const Vec3 tip = mesh.Points[t[0]] + 1e-3 * Vec3(this->real(-1, 1), 1.0, 0.3);
        mesh.Triangles.push_back({t[0], t[1], static_cast<Index>(mesh.Points.size())});
        mesh.Points.push_back(tip);
      }
      break;
    }
  }

  static void addSpeck(bsr::TriangleMesh& mesh, const Vec3& at, double size)
  {
    const auto b = static_cast<Index>(mesh.Points.size());
    mesh.Points.push_back(at);
    for (int k = 0; k < 3; ++k)
    {
      mesh.Points.emplace_back(at + size * Vec3::Unit(k));
    }
    for (const auto& t : {std::array<Index, 3>{b, b + 2, b + 1}, {b, b + 1, b + 3},
           {b, b + 3, b + 2}, {b + 1, b + 2, b + 3}})
    {
      mesh.Triangles.push_back(t);
    }
  }

  std::mt19937 Engine;
  int N;
  std::vector<Part> Parts;
  double Blend = 20.0;
  double Wave = 0.0;
  double Noise = 0.0; ///< in grid steps
  std::vector<double> Values;
  std::map<std::pair<Index, Index>, Index> Middles;
};

/// The surface of a seed; every seed gives one with triangles.
inline RandomSurface randomSurface(unsigned seed, int grid)
{
  for (unsigned again = 0;; ++again)
  {
    RandomSurface s = RandomShape(seed + 100003U * again, grid).make();
    if (s.Clean.Triangles.size() >= 100)
    {
      return s;
    }
  }
}
} // namespace bsrtest
