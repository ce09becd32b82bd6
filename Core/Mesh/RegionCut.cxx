#include "Mesh/RegionCut.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace bsr
{
namespace
{
std::uint64_t key(Index a, Index b)
{
  const auto lo = static_cast<std::uint32_t>(std::min(a, b));
  const auto hi = static_cast<std::uint32_t>(std::max(a, b));
  return (std::uint64_t{lo} << 32) | hi;
}

int sign(double v)
{
  return v > 0.0 ? 1 : v < 0.0 ? -1 : 0;
}

class Cutter
{
public:
  Cutter(TriangleMesh& mesh, std::vector<double>& value) : Mesh(mesh), Value(value) {}

  void snap(double share)
  {
    std::vector<char> near(this->Value.size(), 0);
    for (const auto& t : this->Mesh.Triangles)
    {
      for (int c = 0; c < 3; ++c)
      {
        const Index a = t[c];
        const double u = this->Value[a];
        const double v = this->Value[t[(c + 1) % 3]];
        const double w = this->Value[t[(c + 2) % 3]];
        const auto close = [&](double other)
        { return u * other < 0.0 && std::abs(u) < share * std::abs(u - other); };
        near[a] |= close(v) || close(w);
      }
    }
    for (std::size_t i = 0; i < near.size(); ++i)
    {
      if (near[i])
      {
        this->Value[i] = 0.0;
      }
    }
  }

  void split()
  {
    const std::size_t count = this->Mesh.Triangles.size();
    for (std::size_t t = 0; t < count; ++t)
    {
      this->splitTriangle(t);
    }
  }

private:
  Index middle(Index a, Index b)
  {
    const auto found = this->Middles.emplace(key(a, b), -1).first;
    if (found->second < 0)
    {
      const Index lo = std::min(a, b);
      const Index hi = std::max(a, b);
      const double s = this->Value[lo] / (this->Value[lo] - this->Value[hi]);
      found->second = static_cast<Index>(this->Mesh.Points.size());
      this->Mesh.Points.push_back(
        this->Mesh.Points[lo] + s * (this->Mesh.Points[hi] - this->Mesh.Points[lo]));
      this->Value.push_back(0.0);
    }
    return found->second;
  }

  void add(std::size_t parent, const std::array<Index, 3>& t)
  {
    this->Mesh.Triangles.push_back(t);
    if (!this->Mesh.Region.empty())
    {
      this->Mesh.Region.push_back(this->Mesh.Region[parent]);
    }
  }

  void splitTriangle(std::size_t index)
  {
    const std::array<Index, 3> t = this->Mesh.Triangles[index];
    int s[3];
    int cuts = 0;
    for (int c = 0; c < 3; ++c)
    {
      s[c] = sign(this->Value[t[c]]);
    }
    for (int c = 0; c < 3; ++c)
    {
      cuts += s[c] * s[(c + 1) % 3] < 0;
    }
    if (cuts == 1) // one vertex on the level: two triangles
    {
      int c = 0;
      while (s[c] != 0)
      {
        ++c;
      }
      const Index a = t[c];
      const Index b = t[(c + 1) % 3];
      const Index d = t[(c + 2) % 3];
      const Index m = this->middle(b, d);
      this->Mesh.Triangles[index] = {a, b, m};
      this->add(index, {a, m, d});
    }
    else if (cuts == 2) // one vertex apart from the other two: three triangles
    {
      int c = 0;
      while (s[c] == s[(c + 1) % 3] || s[c] == s[(c + 2) % 3])
      {
        ++c;
      }
      const Index a = t[c];
      const Index b = t[(c + 1) % 3];
      const Index d = t[(c + 2) % 3];
      const Index m = this->middle(a, b);
      const Index n = this->middle(a, d);
      this->Mesh.Triangles[index] = {a, m, n};
      this->add(index, {m, b, n});
      this->add(index, {n, b, d});
    }
  }

  TriangleMesh& Mesh;
  std::vector<double>& Value;
  std::unordered_map<std::uint64_t, Index> Middles;
};
} // namespace

void cutAtZero(TriangleMesh& mesh, std::vector<double>& value, double snap)
{
  Cutter cutter(mesh, value);
  cutter.snap(snap);
  cutter.split();
}

std::vector<std::vector<Index>> regionLoops(const TriangleMesh& mesh, Index region)
{
  std::unordered_map<std::uint64_t, int> uses;
  const auto each = [&](const auto& f)
  {
    for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
    {
      for (int c = 0; c < 3 && mesh.Region[t] == region; ++c)
      {
        f(mesh.Triangles[t][c], mesh.Triangles[t][(c + 1) % 3]);
      }
    }
  };
  each([&](Index a, Index b) { ++uses[key(a, b)]; });
  std::unordered_map<Index, Index> next;
  std::vector<Index> starts;
  bool simple = true;
  each(
    [&](Index a, Index b)
    {
      if (uses[key(a, b)] == 1)
      {
        simple = next.emplace(a, b).second && simple;
        starts.push_back(a);
      }
    });
  std::vector<std::vector<Index>> loops;
  for (const Index start : starts)
  {
    std::vector<Index> loop;
    for (Index at = start; next.count(at) && simple;)
    {
      loop.push_back(at);
      const Index to = next[at];
      next.erase(at);
      at = to;
    }
    if (!loop.empty())
    {
      loops.push_back(std::move(loop));
    }
  }
  return simple ? loops : std::vector<std::vector<Index>>();
}

std::int64_t regionEuler(const TriangleMesh& mesh, Index region)
{
  std::unordered_map<std::uint64_t, char> edges;
  std::unordered_map<Index, char> vertices;
  std::int64_t faces = 0;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    if (mesh.Region[t] == region)
    {
      ++faces;
      for (int c = 0; c < 3; ++c)
      {
        vertices[mesh.Triangles[t][c]] = 1;
        edges[key(mesh.Triangles[t][c], mesh.Triangles[t][(c + 1) % 3])] = 1;
      }
    }
  }
  return static_cast<std::int64_t>(vertices.size()) - static_cast<std::int64_t>(edges.size()) +
         faces;
}
} // namespace bsr
