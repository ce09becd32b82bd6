#include "Mesh/FiberEnds.h"

#include "Common/Parallel.h"
#include "Mesh/FiberRim.h"
#include "Mesh/PointTree.h"
#include "Mesh/RegionCut.h"
#include "Mesh/WallRim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace bsr
{
namespace
{
constexpr int Smoothing = 3;       ///< rounds on the function that is cut
constexpr double Snap = 0.2;       ///< of an edge
constexpr double DrawReach = 0.5;  ///< of the mouth's radius: how far the surface moves along
constexpr double MostShift = 0.2;  ///< of the mouth's radius
constexpr double BandReach = 0.2;  ///< of the mouth's radius: how far the crest may be off the rim
constexpr int DrawSteps = 3;       ///< to the rim of the raw wall
constexpr double ClearerBy = 0.05; ///< how much clearer another rim's end of the wall must be

/// Weights of radius against height that a rim is sought with.
constexpr std::array<double, 3> Leans{0.8, 1.15, 1.5};

/// Vertices reachable from `seed` over edges between vertices for which inside() holds.
template <class Inside>
std::vector<char> connected(
  const std::vector<std::vector<Index>>& neighbors, Index seed, const Inside& inside)
{
  std::vector<char> reached(neighbors.size(), 0);
  std::vector<Index> stack{seed};
  reached[seed] = 1;
  while (!stack.empty())
  {
    const Index v = stack.back();
    stack.pop_back();
    for (const Index w : neighbors[v])
    {
      if (!reached[w] && inside(w))
      {
        reached[w] = 1;
        stack.push_back(w);
      }
    }
  }
  return reached;
}

std::vector<std::vector<Index>> neighborsOf(const TriangleMesh& mesh)
{
  std::vector<std::vector<Index>> neighbors(mesh.Points.size());
  for (const auto& t : mesh.Triangles)
  {
    for (int c = 0; c < 3; ++c)
    {
      neighbors[t[c]].push_back(t[(c + 1) % 3]);
    }
  }
  return neighbors;
}

/// Vertex of the cap: the nearest to the axis, not far below or above the mouth.
Index capVertex(const TriangleMesh& mesh, const MouthFrame& frame, double radius)
{
  Index best = -1;
  double nearest = 0.3 * radius;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    const double h = frame.height(mesh.Points[i]);
    const double r = frame.radius(mesh.Points[i]);
    if (std::abs(h) < 2.0 * radius && r < nearest && h > highest)
    {
      highest = h;
      best = static_cast<Index>(i);
    }
  }
  return best;
}

/// Averages a function over neighbors.
void smooth(std::vector<double>& value, const std::vector<std::vector<Index>>& neighbors)
{
  for (int round = 0; round < Smoothing; ++round)
  {
    std::vector<double> next = value;
    for (std::size_t i = 0; i < value.size(); ++i)
    {
      double sum = 0.0;
      for (const Index n : neighbors[i])
      {
        sum += value[n];
      }
      if (!neighbors[i].empty())
      {
        next[i] = 0.5 * (value[i] + sum / static_cast<double>(neighbors[i].size()));
      }
    }
    value = std::move(next);
  }
  for (double& v : value)
  {
    v = v == 0.0 ? -1e-12 : v;
  }
}

/// What of the negative part belongs to the body, reached from `outside`. Where the crest lies
/// behind the rim and the cap falls steeply, the cap's negative part is joined to the body's over
/// the crest: they are parted halfway in the band around the rim.
std::vector<char> bodyPart(const std::vector<std::vector<Index>>& neighbors,
  const std::vector<double>& value, const std::vector<char>& band, Index outside)
{
  std::vector<char> body =
    connected(neighbors, outside, [&](Index v) { return value[v] < 0.0 && !band[v]; });
  std::vector<char> known = body;
  std::vector<Index> front;
  for (std::size_t i = 0; i < value.size(); ++i)
  {
    if (value[i] < 0.0 && !band[i])
    {
      known[i] = 1;
      front.push_back(static_cast<Index>(i));
    }
  }
  while (!front.empty())
  {
    std::vector<Index> next;
    for (const Index v : front)
    {
      for (const Index w : neighbors[v])
      {
        if (!known[w] && value[w] < 0.0)
        {
          known[w] = 1;
          body[w] = body[v];
          next.push_back(w);
        }
      }
    }
    front = std::move(next);
  }
  return body;
}

/// The function whose zero level is the rim: made positive in one connected part without holes.
std::optional<std::vector<double>> endFunction(
  const TriangleMesh& mesh, const MouthFrame& frame, const FiberRim& rim, double radius)
{
  const auto neighbors = neighborsOf(mesh);
  double widest = 0.0;
  for (const double r : rim.Radius)
  {
    widest = std::max(widest, r);
  }
  std::vector<double> value(mesh.Points.size());
  std::vector<char> band(value.size());
  for (std::size_t i = 0; i < value.size(); ++i)
  {
    const Vec3& p = mesh.Points[i];
    const Vec2 edge = rim.at(frame.bin(p));
    band[i] = (Vec2(frame.radius(p), frame.height(p)) - edge).norm() < BandReach * radius;
    const double f = frame.height(p) - edge.y() - (frame.radius(p) - edge.x());
    const bool far = (p - frame.Center).norm() > 2.0 * widest;
    value[i] = far ? -std::max(std::abs(f), 1e-9 * radius) : (f == 0.0 ? 1e-9 * radius : f);
  }
  smooth(value, neighbors);
  const Index seed = capVertex(mesh, frame, radius);
  const auto lowest = std::min_element(value.begin(), value.end());
  if (seed < 0 || *lowest >= 0.0)
  {
    return std::nullopt;
  }
  // The cap may lie so deep in the lumen that it is negative: what counts is that the ring of the
  // end face, which is positive, parts it from the body.
  const auto outside = static_cast<Index>(lowest - value.begin());
  const auto below = bodyPart(neighbors, value, band, outside);
  if (below[seed])
  {
    return std::nullopt;
  }
  const auto end = connected(neighbors, seed, [&](Index v) { return !below[v]; });
  const auto body = connected(neighbors, outside, [&](Index v) { return !end[v]; });
  for (std::size_t i = 0; i < value.size(); ++i)
  {
    value[i] = body[i] ? -std::abs(value[i]) : std::abs(value[i]);
  }
  return value;
}

/// Marks triangles on the positive side of the cut with a region; false where another has them.
bool mark(TriangleMesh& mesh, const std::vector<double>& value, Index region)
{
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    double sum = 0.0;
    for (const Index v : mesh.Triangles[t])
    {
      sum += value[v];
    }
    if (sum > 0.0)
    {
      if (mesh.Region[t] != 0)
      {
        return false;
      }
      mesh.Region[t] = region;
    }
  }
  return true;
}

/// The way from the loop of vertices that was cut to the rim, by direction.
FiberRim wayToRim(const TriangleMesh& mesh, const std::vector<Index>& loop, const MouthFrame& frame,
  const FiberRim& rim)
{
  constexpr int n = MouthFrame::Bins;
  FiberRim way;
  RimProfile weight{};
  for (const Index v : loop)
  {
    // A hat over two bins on either side, as a bin may be empty.
    const Vec3& p = mesh.Points[v];
    const double bin = frame.bin(p);
    const Vec2 gap = rim.at(bin) - Vec2(frame.radius(p), frame.height(p));
    const int b = static_cast<int>(bin);
    for (int k = b - 2; k <= b + 2; ++k)
    {
      const double w = std::max(0.0, 2.0 - std::abs(k + 0.5 - bin));
      const int i = ((k % n) + n) % n;
      way.Radius[i] += w * gap.x();
      way.Height[i] += w * gap.y();
      weight[i] += w;
    }
  }
  for (int i = 0; i < n; ++i)
  {
    way.Radius[i] /= std::max(weight[i], 1e-9);
    way.Height[i] /= std::max(weight[i], 1e-9);
  }
  return way;
}

/// Moves the surface near the cut to the rim, from which it is off by the wall's roughness and
/// where the end was torn; the shift fades out so slowly that nothing folds.
void drawToRim(TriangleMesh& mesh, const std::vector<Index>& loop, const MouthFrame& frame,
  const FiberRim& rim, double radius)
{
  const FiberRim way = wayToRim(mesh, loop, frame, rim);
  const double reach = DrawReach * radius;
  for (Vec3& p : mesh.Points)
  {
    const double bin = frame.bin(p);
    const Vec2 shift = way.at(bin);
    const Vec2 from = rim.at(bin) - shift;
    const double off = (Vec2(frame.radius(p), frame.height(p)) - from).norm() / reach;
    if (off < 1.0)
    {
      const double fade = (1.0 - off * off) * (1.0 - off * off) *
                          std::min(1.0, MostShift * radius / std::max(shift.norm(), 1e-12));
      p += fade * (shift.x() * frame.radial(bin) + shift.y() * frame.Axis);
    }
  }
}

double meanEdge(const TriangleMesh& mesh)
{
  double sum = 0.0;
  for (const auto& t : mesh.Triangles)
  {
    sum += (mesh.Points[t[1]] - mesh.Points[t[0]]).norm();
  }
  return sum / static_cast<double>(mesh.Triangles.size());
}

/// How far each vertex is off the wall's points, less one and a half edges; 0 where there are no
/// points.
std::vector<double> offWall(const TriangleMesh& mesh, const FiberWall& wall)
{
  std::vector<double> off(mesh.Points.size(), 0.0);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < wall.Surface.Points.size() && i < wall.Side.size(); ++i)
  {
    if (wall.Side[i] <= 1)
    {
      points.push_back(wall.Surface.Points[i]);
    }
  }
  if (points.empty())
  {
    return off;
  }
  const PointTree tree(std::move(points));
  const double free = 1.5 * meanEdge(mesh);
  parallelFor(0, static_cast<std::int64_t>(off.size()), 1024,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        const double distance2 = tree.nearest(mesh.Points[i]).second;
        off[i] = std::max(0.0, std::sqrt(distance2) - free);
      }
    });
  return off;
}

/// An end that was cut, or why it was not.
struct CutEnd
{
  TriangleMesh Surface;
  std::vector<Index> Rim;
  double Clear = 0.0; ///< how clearly the wall ends there, 0..1
  std::string Why;
};

/// What rims are found on: not what earlier ends have cut, so that the ends do not depend on their
/// order.
struct RimSources
{
  const TriangleMesh& Closed;
  std::vector<double> Off; ///< how far each of its vertices is off the wall
  WallSamples Wall;
};

/// Tries to cut one end. The surface is cut along its own rim and then moved to that and on to the
/// raw wall's, in small steps of which none folds it.
CutEnd cutEnd(const FiberEnds& ends, const EndMouth& mouth, const RimSources& sources, double lean)
{
  CutEnd end;
  MouthFrame frame(mouth.Center, mouth.Direction);
  const auto rim = findRim(sources.Closed, sources.Off, mouth, lean, frame);
  if (!rim)
  {
    end.Why = "the surface does not go round it";
    return end;
  }
  auto value = endFunction(ends.Surface, frame, *rim, mouth.Radius);
  if (!value)
  {
    end.Why = "no cap lies over it";
    return end;
  }
  end.Surface = ends.Surface;
  cutAtZero(end.Surface, *value, Snap);
  const auto region = static_cast<Index>(ends.Rims.size() + 1);
  if (!mark(end.Surface, *value, region))
  {
    end.Why = "it overlaps another end";
    return end;
  }
  auto loops = regionLoops(end.Surface, region);
  if (loops.size() != 1 || regionEuler(end.Surface, region) != 1)
  {
    end.Why = "its region is not a disc";
    return end;
  }
  end.Rim = std::move(loops.front());
  drawToRim(end.Surface, end.Rim, frame, *rim, mouth.Radius);
  const WallRim wall = rimOnWall(sources.Wall, frame, *rim);
  end.Clear = wall.Clear;
  for (int step = 0; step < DrawSteps && wall.Clear > 0.0; ++step)
  {
    drawToRim(end.Surface, end.Rim, frame, wall.Rim, mouth.Radius);
  }
  return end;
}

/// Cuts one end along the rim where the wall ends most clearly; says why not.
std::string cutBest(FiberEnds& ends, const EndMouth& mouth, const RimSources& sources)
{
  if (!(mouth.Radius > 0.0) || !(mouth.Direction.norm() > 0.0) || !mouth.Center.allFinite())
  {
    return "its radius or direction is not valid";
  }
  CutEnd best = cutEnd(ends, mouth, sources, Leans.front());
  for (std::size_t i = 1; i < Leans.size(); ++i)
  {
    CutEnd other = cutEnd(ends, mouth, sources, Leans[i]);
    if (other.Why.empty() && (!best.Why.empty() || other.Clear > best.Clear + ClearerBy))
    {
      best = std::move(other);
    }
  }
  if (best.Why.empty())
  {
    ends.Surface = std::move(best.Surface);
    ends.Rims.push_back(std::move(best.Rim));
  }
  return best.Why;
}
} // namespace

Result<FiberEnds> findFiberEnds(const TriangleMesh& closedSurface,
  const std::vector<EndMouth>& mouths, const FiberWall& wall, Monitor& monitor)
{
  if (closedSurface.Triangles.empty())
  {
    return Status::invalidInput("The closed surface has no triangles. Contour SignedDistance of "
                                "the Closing filter's output at 0.");
  }
  FiberEnds ends;
  const RimSources sources{closedSurface, offWall(closedSurface, wall), sampleWall(wall)};
  ends.Surface = closedSurface;
  ends.Surface.Region.assign(closedSurface.Triangles.size(), 0);
  for (std::size_t m = 0; m < mouths.size(); ++m)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    const std::string why = cutBest(ends, mouths[m], sources);
    if (!why.empty())
    {
      ends.Note += (ends.Note.empty() ? "Mouth " : " Mouth ") + std::to_string(m + 1) +
                   " of the lumen was not made an end: " + why + ".";
    }
    monitor.progress(static_cast<double>(m + 1) / static_cast<double>(mouths.size()));
  }
  return ends;
}
} // namespace bsr
