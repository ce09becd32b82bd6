#include "Layout/Chords.h"

#include "Common/UnionFind.h"

#include <algorithm>
#include <map>

namespace bsr
{
namespace
{
using Pair = std::array<Index, 2>;

Pair edge(Index a, Index b)
{
  return {std::min(a, b), std::max(a, b)};
}

/// The edges of a layout by number.
struct EdgeTable
{
  explicit EdgeTable(const QuadMesh& mesh) : OfQuad(mesh.Quads.size())
  {
    std::vector<std::pair<Pair, std::array<Index, 2>>> all;
    all.reserve(4 * mesh.Quads.size());
    for (std::size_t q = 0; q < mesh.Quads.size(); ++q)
    {
      for (int k = 0; k < 4; ++k)
      {
        all.push_back({edge(mesh.Quads[q][k], mesh.Quads[q][(k + 1) % 4]),
          {static_cast<Index>(q), static_cast<Index>(k)}});
      }
    }
    std::sort(all.begin(), all.end());
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      if (i == 0 || all[i].first != all[i - 1].first)
      {
        this->Points.push_back(all[i].first);
        this->Uses.emplace_back();
      }
      this->Uses.back().push_back(all[i].second);
      this->OfQuad[all[i].second[0]][all[i].second[1]] =
        static_cast<Index>(this->Points.size()) - 1;
    }
  }

  std::vector<Pair> Points;
  std::vector<std::vector<std::array<Index, 2>>> Uses; ///< quad and side
  std::vector<std::array<Index, 4>> OfQuad;
};

double excess(int valence, bool rim)
{
  const int off = valence - (rim ? 3 : 4);
  const int tooMany = std::max(0, off - 2);
  return off * off + 3.0 * tooMany * tooMany;
}

class Walker
{
public:
  Walker(const LayoutDraft& draft, const std::vector<double>& sides)
      : D(draft), Sides(sides), T(draft.Mesh)
  {
    this->Rim.assign(draft.Mesh.Points.size(), 0);
    this->Valence.assign(draft.Mesh.Points.size(), 0);
    for (std::size_t e = 0; e < this->T.Points.size(); ++e)
    {
      for (Index v : this->T.Points[e])
      {
        ++this->Valence[v];
        this->Rim[v] = this->Rim[v] != 0 || this->T.Uses[e].size() == 1;
      }
    }
  }

  std::vector<Chord> run()
  {
    std::vector<Chord> chords;
    std::vector<std::uint8_t> seen(this->T.Points.size(), 0);
    for (std::size_t e = 0; e < this->T.Points.size(); ++e)
    {
      if (seen[e] == 0)
      {
        chords.push_back(this->walk(static_cast<Index>(e), seen));
      }
    }
    return chords;
  }

private:
  Chord walk(Index first, std::vector<std::uint8_t>& seen) const
  {
    Chord chord;
    std::vector<Index> stack(1, first);
    seen[first] = 1;
    while (!stack.empty())
    {
      const Index e = stack.back();
      stack.pop_back();
      chord.Rungs.push_back(this->T.Points[e]);
      for (const auto& use : this->T.Uses[e])
      {
        chord.Quads.push_back(use[0]);
        const Index o = this->T.OfQuad[use[0]][(use[1] + 2) % 4];
        if (seen[o] == 0)
        {
          seen[o] = 1;
          stack.push_back(o);
        }
      }
    }
    std::sort(chord.Rungs.begin(), chord.Rungs.end());
    std::sort(chord.Quads.begin(), chord.Quads.end());
    for (std::size_t i = 3; i < chord.Quads.size(); ++i)
    {
      chord.Twice = chord.Twice || chord.Quads[i] == chord.Quads[i - 3]; // all four sides
    }
    chord.Quads.erase(std::unique(chord.Quads.begin(), chord.Quads.end()), chord.Quads.end());
    this->judge(chord);
    return chord;
  }

  void judge(Chord& chord) const
  {
    std::map<Index, std::pair<int, int>> merged; // root: valence, rungs
    std::map<Index, Index> parent;
    auto root = [&](Index v)
    {
      parent.try_emplace(v, v);
      while (parent[v] != v)
      {
        v = parent[v];
      }
      return v;
    };
    for (const Pair& r : chord.Rungs)
    {
      const Index a = root(r[0]);
      const Index b = root(r[1]);
      parent[std::max(a, b)] = std::min(a, b);
      const double length = (this->D.Mesh.Points[r[0]] - this->D.Mesh.Points[r[1]]).norm();
      chord.Width += 2.0 * length / (this->Sides[r[0]] + this->Sides[r[1]]);
    }
    chord.Width /= static_cast<double>(chord.Rungs.size());
    std::map<Index, bool> rim;
    for (const auto& entry : parent)
    {
      const Index v = entry.first;
      chord.Gain -= excess(this->Valence[v], this->Rim[v] != 0);
      auto& sum = merged[root(v)];
      sum.first += this->Valence[v];
      sum.second += 1;
      rim[root(v)] = rim[root(v)] || this->Rim[v] != 0;
    }
    for (const auto& [v, sum] : merged)
    {
      const int lost = rim[v] ? 3 : 4;
      chord.Gain += excess(sum.first - lost * (sum.second - 1), rim[v]);
    }
  }

  const LayoutDraft& D;
  const std::vector<double>& Sides;
  EdgeTable T;
  std::vector<std::uint8_t> Rim;
  std::vector<int> Valence;
};

std::vector<Pair> mergedCreases(const std::vector<Pair>& creases, const std::vector<Index>& number)
{
  std::vector<Pair> out;
  for (const Pair& c : creases)
  {
    const Pair e = edge(number[c[0]], number[c[1]]);
    if (e[0] != e[1])
    {
      out.push_back(e);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}
} // namespace

std::vector<Chord> chordsOf(const LayoutDraft& draft, const std::vector<double>& sides)
{
  return Walker(draft, sides).run();
}

LayoutDraft withoutChord(const LayoutDraft& draft, const Chord& chord, std::vector<Index>* merged)
{
  const std::size_t n = draft.Mesh.Points.size();
  UnionFind sets(static_cast<Index>(n));
  for (const Pair& r : chord.Rungs)
  {
    const bool crease = std::binary_search(draft.Creases.begin(), draft.Creases.end(), r);
    if (draft.Kind[r[0]] != VertexKind::Free && draft.Kind[r[1]] != VertexKind::Free && !crease)
    {
      return {};
    }
    sets.join(r[0], r[1]);
  }
  LayoutDraft out;
  std::vector<Index> number(n, -1);
  std::vector<double> weight;
  std::vector<int> corners;
  for (std::size_t v = 0; v < n; ++v)
  {
    const auto r = static_cast<std::size_t>(sets.find(static_cast<Index>(v)));
    if (number[r] < 0)
    {
      number[r] = static_cast<Index>(out.Mesh.Points.size());
      out.Mesh.Points.push_back(Vec3(0, 0, 0));
      out.Kind.push_back(VertexKind::Free);
      weight.push_back(0.0);
      corners.push_back(0);
    }
    number[v] = number[r];
    const Index i = number[v];
    if (draft.Kind[v] > out.Kind[i])
    {
      out.Kind[i] = draft.Kind[v];
      out.Mesh.Points[i].setZero();
      weight[i] = 0.0;
    }
    corners[i] += draft.Kind[v] == VertexKind::Fixed;
    if (draft.Kind[v] == out.Kind[i])
    {
      out.Mesh.Points[i] += draft.Mesh.Points[v];
      weight[i] += 1.0;
    }
  }
  for (std::size_t i = 0; i < weight.size(); ++i)
  {
    out.Mesh.Points[i] /= weight[i];
    if (corners[i] > 1)
    {
      return {};
    }
  }
  std::vector<std::uint8_t> gone(draft.Mesh.Quads.size(), 0);
  for (Index q : chord.Quads)
  {
    gone[q] = 1;
  }
  for (std::size_t q = 0; q < gone.size(); ++q)
  {
    if (gone[q] == 0)
    {
      auto quad = draft.Mesh.Quads[q];
      for (Index& v : quad)
      {
        v = number[v];
      }
      out.Mesh.Quads.push_back(quad);
      out.Mesh.Region.push_back(draft.Mesh.Region[q]);
    }
  }
  out.Creases = mergedCreases(draft.Creases, number);
  if (merged != nullptr)
  {
    for (const Pair& r : chord.Rungs)
    {
      merged->push_back(number[r[0]]);
    }
  }
  const bool doubled =
    std::adjacent_find(out.Creases.begin(), out.Creases.end()) != out.Creases.end();
  return doubled ? LayoutDraft{} : out;
}

LayoutDraft withSplitChord(const LayoutDraft& draft, const Chord& chord)
{
  LayoutDraft out = draft;
  std::map<Pair, Index> middle;
  for (const Pair& r : chord.Rungs)
  {
    const bool crease = std::binary_search(draft.Creases.begin(), draft.Creases.end(), r);
    middle[r] = static_cast<Index>(out.Mesh.Points.size());
    out.Mesh.Points.push_back(Vec3(0.5 * (draft.Mesh.Points[r[0]] + draft.Mesh.Points[r[1]])));
    out.Kind.push_back(crease ? VertexKind::Crease : VertexKind::Free);
    if (crease)
    {
      out.Creases.erase(std::lower_bound(out.Creases.begin(), out.Creases.end(), r));
      for (Index v : r)
      {
        const Pair half = edge(v, middle[r]);
        out.Creases.insert(std::lower_bound(out.Creases.begin(), out.Creases.end(), half), half);
      }
    }
  }
  auto middleOf = [&](Index a, Index b)
  {
    const auto it = middle.find(edge(a, b));
    return it == middle.end() ? Index(-1) : it->second;
  };
  for (Index quad : chord.Quads)
  {
    const auto q = draft.Mesh.Quads[quad];
    std::array<Index, 4> m{};
    for (int k = 0; k < 4; ++k)
    {
      m[k] = middleOf(q[k], q[(k + 1) % 4]);
    }
    const Index region = draft.Mesh.Region[quad];
    auto add = [&](const std::array<Index, 4>& corners)
    {
      out.Mesh.Quads.push_back(corners);
      out.Mesh.Region.push_back(region);
    };
    if (m[0] >= 0 && m[1] >= 0)
    {
      const auto center = static_cast<Index>(out.Mesh.Points.size());
      out.Mesh.Points.push_back(Vec3(0.25 * (draft.Mesh.Points[q[0]] + draft.Mesh.Points[q[1]] +
                                              draft.Mesh.Points[q[2]] + draft.Mesh.Points[q[3]])));
      out.Kind.push_back(VertexKind::Free);
      out.Mesh.Quads[quad] = {q[0], m[0], center, m[3]};
      add({m[0], q[1], m[1], center});
      add({center, m[1], q[2], m[2]});
      add({m[3], center, m[2], q[3]});
      continue;
    }
    const int k = m[0] >= 0 ? 0 : 1;
    out.Mesh.Quads[quad] = {q[k], m[k], m[k + 2], q[(k + 3) % 4]};
    add({m[k], q[(k + 1) % 4], q[(k + 2) % 4], m[k + 2]});
  }
  return out;
}
} // namespace bsr
