#include "Layout/FeatureFallback.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
// Lengths of creases, as shares of the length of all edges of the layout.
constexpr double MostLength = 0.6;  ///< there is no layout beyond
constexpr double EasyLength = 0.12; ///< up to that, paired triangles may do

bool border(const TriangleSurface& s, Index h)
{
  return s.Region[h / 3] != s.Region[s.Opposite[h] / 3];
}

bool atHole(const TriangleSurface& s, Index h)
{
  return s.hole(h / 3) || s.hole(s.Opposite[h] / 3);
}

/// Length of sharp edges and of borders between regions, as a share of that of all edges of a
/// layout of so many squares.
struct CreaseLengths
{
  double Sharp = 0.0;
  double Border = 0.0;
};

CreaseLengths creaseLengths(const TriangleSurface& s, int quads)
{
  CreaseLengths lengths;
  const double all = 2.0 * std::sqrt(s.area() * quads);
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    if (s.Vertex[h] >= 0 && s.Crease[h] && h < s.Opposite[h] && !atHole(s, h))
    {
      (border(s, h) ? lengths.Border : lengths.Sharp) +=
        (s.Points[s.start(h)] - s.Points[s.end(h)]).norm() / all;
    }
  }
  return lengths;
}

void dropSharpEdges(TriangleSurface& s)
{
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    s.Crease[h] = s.Vertex[h] >= 0 && border(s, h);
  }
}

void dropRegions(TriangleSurface& s)
{
  for (Index& region : s.Region)
  {
    region = region == TriangleSurface::HoleRegion ? region : 0;
  }
  dropSharpEdges(s);
}
} // namespace

void takeRegions(QuadMesh& quads, const TriangleMesh& mesh)
{
  const TriangleTree tree(mesh.Points, mesh.Triangles);
  quads.Region.resize(quads.Quads.size());
  for (std::size_t q = 0; q < quads.Quads.size(); ++q)
  {
    Vec3 middle = Vec3::Zero();
    for (Index v : quads.Quads[q])
    {
      middle += 0.25 * quads.Points[v];
    }
    quads.Region[q] = mesh.Region[tree.nearest(middle).Triangle];
  }
}

namespace
{
/// Region borders are what regions are given for: they may cost as many quads again as asked for.
bool accepted(const LayoutDraft& draft, int quads, int least, FollowedFeatures rung)
{
  const double miss = rung == FollowedFeatures::Regions ? 1.0 : 0.1;
  const LayoutReport report = checkLayout(draft.Mesh);
  const auto got = static_cast<double>(draft.Mesh.Quads.size());
  return report.Valid && report.Flipped == 0 && report.MaxValence <= 8 &&
         (std::abs(got - quads) <= std::max(miss * quads, 2.0) ||
           std::abs(got - least) <= 0.1 * least);
}
Result<FieldLayout> layoutOfRung(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, const FieldLayoutOptions& options, FollowedFeatures rung, Monitor& monitor)
{
  TriangleSurface creased = s;
  if (rung == FollowedFeatures::None)
  {
    dropRegions(creased);
  }
  else if (rung == FollowedFeatures::Regions)
  {
    dropSharpEdges(creased);
  }
  ReferenceSurface own(creased);
  own.Samples = reference.Samples;
  return fieldLayout(creased, own, sizing, options, monitor);
}
} // namespace

FollowedFeatures dropHopelessCreases(TriangleSurface& s, int quads)
{
  const CreaseLengths lengths = creaseLengths(s, quads);
  if (lengths.Border > MostLength)
  {
    dropRegions(s);
    return FollowedFeatures::None;
  }
  if (lengths.Border + lengths.Sharp > MostLength)
  {
    dropSharpEdges(s);
    return FollowedFeatures::Regions;
  }
  return FollowedFeatures::All;
}

Result<FieldLayout> layoutOfFeatures(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, const FieldLayoutOptions& options, int least, FollowedFeatures& followed,
  Monitor& monitor)
{
  const CreaseLengths lengths = creaseLengths(s, options.Quads);
  if (lengths.Border + lengths.Sharp == 0.0)
  {
    return fieldLayout(s, reference, sizing, options, monitor);
  }
  double done = 0.0;
  const bool borders = lengths.Border > 0.0;
  for (FollowedFeatures rung : {FollowedFeatures::All, FollowedFeatures::Regions})
  {
    if (rung == FollowedFeatures::All ? lengths.Sharp == 0.0 : !borders)
    {
      continue;
    }
    SubMonitor part(monitor, done, done + 0.4);
    done += 0.4;
    FieldLayoutOptions own = options;
    const double sharp = rung == FollowedFeatures::All ? lengths.Sharp : 0.0;
    own.MapsOnly = lengths.Border + sharp > EasyLength;
    auto found = layoutOfRung(s, reference, sizing, own, rung, part);
    const bool cancelled = !found && found.status().code() == StatusCode::Cancelled;
    if (cancelled || (found && accepted(found->Draft, options.Quads, least, rung)))
    {
      followed = lengths.Sharp > 0.0 ? rung : followed;
      return found;
    }
  }
  followed = borders ? FollowedFeatures::None : FollowedFeatures::Regions;
  SubMonitor part(monitor, done, 1.0);
  return layoutOfRung(s, reference, sizing, options, followed, part);
}
} // namespace bsr
