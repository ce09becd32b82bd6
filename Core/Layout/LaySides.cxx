#include "Layout/LaySides.h"

#include "Common/CounterRandom.h"

#include <algorithm>

namespace bsr
{
namespace
{
constexpr int Attempts = 3;     ///< short orders
constexpr int Rings = 5;        ///< of quads around failed ones that are laid again
constexpr int SafeAttempts = 4; ///< spanning trees for all sides
constexpr double Detour = 3.0;  ///< of a side's length over that of the straight line

double chord(const QuadMesh& layout, const LayoutGraph& graph, Index edge)
{
  const Index h = graph.First[edge];
  return (layout.Points[graph.from(h)] - layout.Points[graph.to(h)]).norm();
}

class Search
{
public:
  Search(const CutMesh& base, const QuadMesh& layout, const LayoutGraph& graph, Monitor& monitor)
      : Base(base), Layout(layout), Graph(graph), Watch(monitor)
  {
    for (Index e = 0; e < graph.edges(); ++e)
    {
      this->Chords.push_back(chord(layout, graph, e));
    }
    this->Urgent.resize(this->Chords.size(), 0);
  }

  Result<LaidSides> run()
  {
    for (int i = 0; i < Attempts && !this->sound(); ++i)
    {
      if (Status s = this->lay(this->Base, shortestFirst(this->Graph, this->Chords, this->Urgent));
          !s)
      {
        return s;
      }
      this->Watch.progress(0.5 * (i + 1) / Attempts);
    }
    const CutMesh start = this->Best.Failed > 0 ? this->Best.Mesh : CutMesh();
    for (int ring = 0; ring<Rings&& this->Best.Failed> 0; ++ring)
    {
      if (Status s = this->mend(start, ring); !s)
      {
        return s;
      }
      this->Watch.progress(0.5 + 0.2 * (ring + 1) / Rings);
    }
    for (int i = 0; i<SafeAttempts&& this->Best.Failed> 0; ++i)
    {
      if (Status s = this->lay(this->Base, safeOrder(this->Graph, this->costs(i))); !s)
      {
        return s;
      }
      this->Watch.progress(0.7 + 0.3 * (i + 1) / SafeAttempts);
    }
    return std::move(this->Best);
  }

private:
  bool sound() const { return this->Best.Failed == 0 && this->Best.Detours == 0; }

  Status lay(CutMesh mesh, const SideOrder& order)
  {
    const auto failed = mesh.laySides(this->Layout, this->Graph, order, this->Watch);
    if (!failed)
    {
      return failed.status();
    }
    const auto far = detours(mesh, this->Layout, this->Graph);
    for (std::size_t h = 0; h < this->Graph.Edge.size(); ++h)
    {
      const Index e = this->Graph.Edge[h];
      this->Urgent[e] += mesh.Sides[e].empty() ? 2 : (mesh.Faces[h / 4].empty() ? 1 : far[e]);
    }
    const double length = mesh.totalLength();
    if (*failed < this->Best.Failed || (*failed == this->Best.Failed && length < this->Best.Length))
    {
      const auto count = static_cast<int>(std::count(far.begin(), far.end(), 1));
      this->Best = {std::move(mesh), *failed, count, length};
    }
    return Status::ok();
  }

  /// Lays the sides around failed quads again.
  Status mend(CutMesh mesh, int rings)
  {
    mesh.takeUpAround(this->Graph, rings);
    std::vector<std::uint8_t> laid(mesh.Sides.size());
    std::transform(mesh.Sides.begin(), mesh.Sides.end(), laid.begin(),
      [](const std::vector<Index>& side) { return !side.empty(); });
    return this->lay(std::move(mesh), safeOrder(this->Graph, this->Chords, laid));
  }

  /// Of the sides for a spanning tree: their length, changed more with every attempt.
  std::vector<double> costs(int attempt) const
  {
    CounterRandom random(static_cast<std::uint64_t>(attempt), 0);
    std::vector<double> cost = this->Chords;
    for (std::size_t e = 0; e < cost.size(); ++e)
    {
      const double change = 0.5 + random.uniform();
      cost[e] *= attempt < 2 ? 1.0 : change;
      cost[e] /= attempt % 2 == 1 ? 1.0 + this->Urgent[e] : 1.0;
    }
    return cost;
  }

  const CutMesh& Base;
  const QuadMesh& Layout;
  const LayoutGraph& Graph;
  Monitor& Watch;
  std::vector<double> Chords;
  std::vector<int> Urgent;
  LaidSides Best;
};
} // namespace

std::vector<std::uint8_t> detours(
  const CutMesh& cut, const QuadMesh& layout, const LayoutGraph& graph)
{
  std::vector<double> straight;
  double mean = 0.0;
  for (Index e = 0; e < graph.edges(); ++e)
  {
    straight.push_back(chord(layout, graph, e));
    mean += straight.back() / static_cast<double>(graph.edges());
  }
  std::vector<std::uint8_t> far(straight.size(), 0);
  for (std::size_t e = 0; e < far.size(); ++e)
  {
    far[e] = cut.sideLength(static_cast<Index>(e)) > Detour * std::max(straight[e], 0.5 * mean);
  }
  return far;
}

Result<LaidSides> laySides(
  const CutMesh& base, const QuadMesh& layout, const LayoutGraph& graph, Monitor& monitor)
{
  return Search(base, layout, graph, monitor).run();
}
} // namespace bsr
