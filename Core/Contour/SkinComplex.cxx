#include "Contour/SkinComplex.h"

#include "Contour/ColumnMap.h"
#include "Contour/SkinCap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// Shares of a contour's length over the outline of the trunk, 0 to 4, a unit a side.
using Outline = std::vector<double>;
constexpr int OutlineSteps = 64; ///< a side
/// Error, in tolerances, that the finest size would hardly bring down to one: it is not the size of
/// the patches but contours that change too much from slice to slice.
constexpr double Hopeless = 8.0;
constexpr double Ease = 0.1; ///< a slice, of the outline towards equal spacing

class Complex
{
public:
  Complex(const ContourStack& stack, const SkinPiece& piece, const SkinComplexOptions& options)
      : Stack(stack), Piece(piece), Options(options)
  {
    for (const bool up : {false, true})
    {
      if (!this->has(up))
      {
        continue;
      }
      SkinGrid& g = up ? this->Upper : this->Lower;
      g = arrangeGrid(stack, up ? piece.Upper : piece.Lower, options.CorePoints, true);
      alignGrid(stack, g);
      auto& caps = up ? this->UpperCaps : this->LowerCaps;
      caps = closeCores(stack, g, options.CapShare);
      for (const CapPoint& b : bridgeParts(stack, g))
      {
        caps.push_back(b);
      }
    }
    this->layTrunk();
  }

  /// Quads and data for `n` quads along each edge of bottom and top and `high` up the trunk.
  void build(int n, int high)
  {
    this->N = n;
    this->High = high;
    this->makeQuads();
    for (const bool up : {false, true})
    {
      if (this->has(up))
      {
        this->addGrid(up ? this->Upper : this->Lower, up ? this->UpperCaps : this->LowerCaps, up);
      }
    }
    this->addTrunk();
    this->placeVertices();
  }

  /// The size that gives a patch about `lines` lines of the data sets.
  std::array<int, 2> sizes(double lines) const
  {
    const int most =
      std::max({this->Lower.Rows, this->Lower.Columns, this->Upper.Rows, this->Upper.Columns});
    const int n = std::clamp(static_cast<int>(std::ceil(most / lines)), 2, 16);
    double around = 0.0;
    for (const Index c : this->Piece.Trunk)
    {
      around += this->Stack.Contours[c].Length / static_cast<double>(this->Piece.Trunk.size());
    }
    const double tall = this->Heights.back();
    const int high =
      std::clamp(static_cast<int>(std::lround(4.0 * n * tall / std::max(around, 1e-300))), 1,
        std::max(1, static_cast<int>(this->Piece.Trunk.size()) - 1));
    return {n, high};
  }

  /// The ends of all legs.
  std::vector<LegEnd> ends() const
  {
    std::vector<LegEnd> all = legEnds(this->Lower);
    const std::vector<LegEnd> upper = legEnds(this->Upper);
    all.insert(all.end(), upper.begin(), upper.end());
    return all;
  }

  QuadMesh Mesh;
  PartitionedPoints Points;

private:
  /// Whether there is a bottom or a top; one may be missing, and the border lies there.
  bool has(bool up) const { return !(up ? this->Piece.Upper : this->Piece.Lower).Nodes.empty(); }

  /// Node of a ring at place t of the outline, 0 to 4.
  static double nodeOf(const SkinRing& r, double t)
  {
    const double w = r.Columns - 1;
    const double h = r.Rows - 1;
    return t <= 1.0   ? t * w
           : t <= 2.0 ? w + (t - 1.0) * h
           : t <= 3.0 ? w + h + (t - 2.0) * w
                      : 2.0 * w + h + (t - 3.0) * h;
  }

  static Outline sharesOf(const SkinRing& ring)
  {
    Outline shares;
    for (int k = 0; k < 4 * OutlineSteps; ++k)
    {
      shares.push_back(ring.shareAt(nodeOf(ring, static_cast<double>(k) / OutlineSteps)));
    }
    return shares;
  }

  /// Shares of the trunk's contours over one outline: from the lower data set's root on, each as
  /// close to the one below as can be, then turned gradually to meet the upper data set's root.
  void layTrunk()
  {
    const auto& trunk = this->Piece.Trunk;
    this->Heights.push_back(0.0);
    for (const Index c : trunk)
    {
      this->Curves.emplace_back(this->Stack.Contours[c].Points, true);
      if (this->Curves.size() > 1)
      {
        const Index before = trunk[this->Curves.size() - 2];
        this->Heights.push_back(
          this->Heights.back() +
          std::abs(this->Stack.Slices[this->Stack.Contours[c].Slice].Position -
                   this->Stack.Slices[this->Stack.Contours[before].Slice].Position));
      }
    }
    this->Outlines.resize(trunk.size());
    const auto last = static_cast<Index>(trunk.size()) - 1;
    if (this->has(false))
    {
      this->Outlines[0] = sharesOf(this->Lower.Rings[0]);
      for (Index k = 1; k <= last; ++k)
      {
        this->Outlines[k] = this->nextOutline(k - 1, k);
      }
      if (this->has(true))
      {
        this->meetUpper();
      }
      return;
    }
    this->Outlines[last] = sharesOf(this->Upper.Rings[0]);
    for (Index k = last; k > 0; --k)
    {
      this->Outlines[k - 1] = this->nextOutline(k, k - 1);
    }
  }

  /// Places of the outline carried to a neighboring contour by the match of the two, and eased
  /// towards equal spacing, so that places that bays have squeezed come apart again.
  Outline nextOutline(Index from, Index to) const
  {
    const Outline& last = this->Outlines[from];
    const double start = alignedStart(this->Curves[from], last[0], this->Curves[to]);
    MatchOptions match;
    match.Steps = 4 * OutlineSteps;
    match.Evenness = 0.15;
    match.Center = true;
    const ArcMatch m =
      matchArcs({&this->Curves[from], last[0], 1.0}, {&this->Curves[to], start, 1.0}, match);
    const auto count = static_cast<double>(last.size());
    Outline next;
    double mean = 0.0;
    for (const double s : last)
    {
      next.push_back(start + interpolated(m.First, m.Second, s - last[0]));
      mean += (next.back() - static_cast<double>(next.size() - 1) / count) / count;
    }
    for (std::size_t k = 0; k < next.size(); ++k)
    {
      next[k] += Ease * (mean + static_cast<double>(k) / count - next[k]);
    }
    return next;
  }

  void meetUpper()
  {
    const Outline upper = sharesOf(this->Upper.Rings[0]);
    const Outline& reached = this->Outlines.back();
    const auto count = static_cast<int>(reached.size());
    double best = Infinity;
    std::vector<double> turn;
    for (int r = 0; r < 4; ++r)
    {
      std::vector<double> difference;
      double mean = 0.0;
      for (int k = 0; k < count; ++k)
      {
        const int j = k + r * OutlineSteps;
        difference.push_back(upper[j % count] + (j >= count ? 1.0 : 0.0) - reached[k]);
        mean += difference.back() / count;
      }
      double sum = 0.0;
      for (double& d : difference)
      {
        d -= std::round(mean);
        sum += d * d;
      }
      if (sum < best)
      {
        best = sum;
        turn = difference;
        this->Rotation = r;
      }
    }
    const auto n = this->Outlines.size();
    for (std::size_t k = 1; k < n; ++k)
    {
      const double share = static_cast<double>(k) / static_cast<double>(n - 1);
      for (int i = 0; i < count; ++i)
      {
        this->Outlines[k][i] += share * turn[i];
      }
    }
  }

  double shareAt(std::size_t k, double t) const
  {
    const Outline& o = this->Outlines[k];
    const double x = t * OutlineSteps;
    const auto i = static_cast<std::size_t>(std::floor(x));
    const double next = i + 1 < o.size() ? o[i + 1] : o[0] + 1.0;
    return o[i] + (x - static_cast<double>(i)) * (next - o[i]);
  }

  /// Vertices: the outline's at each height of the trunk, then the inner ones of bottom and top.
  Index ringVertex(int q, int b) const { return b * 4 * this->N + q % (4 * this->N); }

  Index faceVertex(int i, int j, bool up) const
  {
    const int n = this->N;
    if (i > 0 && j > 0 && i < n && j < n)
    {
      return 4 * n * (this->High + 1) + (up && this->has(false) ? (n - 1) * (n - 1) : 0) +
             (j - 1) * (n - 1) + i - 1;
    }
    const int q = j == 0 ? i : i == n ? n + j : j == n ? 3 * n - i : 4 * n - j;
    return up ? this->ringVertex(q + (4 - this->Rotation) * n, this->High) : this->ringVertex(q, 0);
  }

  void makeQuads()
  {
    const int n = this->N;
    this->Mesh = {};
    const int faces = (this->has(false) ? 1 : 0) + (this->has(true) ? 1 : 0);
    const auto wide = static_cast<std::size_t>(n);
    const auto rings = static_cast<std::size_t>(this->High) + 1;
    const auto flat = static_cast<std::size_t>(faces);
    this->Mesh.Points.resize(4 * wide * rings + flat * (wide - 1) * (wide - 1));
    for (const bool up : {false, true})
    {
      this->FirstQuad[up ? 1 : 0] = static_cast<Index>(this->Mesh.Quads.size());
      for (int j = 0; j < n && this->has(up); ++j)
      {
        for (int i = 0; i < n; ++i)
        {
          const Index a = this->faceVertex(i, j, up);
          const Index b = this->faceVertex(i + 1, j, up);
          const Index c = this->faceVertex(i + 1, j + 1, up);
          const Index d = this->faceVertex(i, j + 1, up);
          up ? this->Mesh.Quads.push_back({a, b, c, d}) : this->Mesh.Quads.push_back({a, d, c, b});
        }
      }
    }
    this->FirstQuad[2] = static_cast<Index>(this->Mesh.Quads.size());
    for (int b = 0; b < this->High; ++b)
    {
      for (int q = 0; q < 4 * n; ++q)
      {
        this->Mesh.Quads.push_back({this->ringVertex(q, b), this->ringVertex(q + 1, b),
          this->ringVertex(q + 1, b + 1), this->ringVertex(q, b + 1)});
      }
    }
    this->Points = {};
  }

  void add(const Vec3& p, Index quad, const Vec2& uv, double weight)
  {
    this->Points.Points.push_back(p);
    this->Points.QuadId.push_back(quad);
    this->Points.UV.push_back(uv);
    this->Points.Weights.push_back(weight);
  }

  void addToFace(const SkinGrid& grid, const Vec2& place, const Vec3& p, bool up, double weight)
  {
    const int n = this->N;
    const Vec2 x(n * std::clamp(place.x() / (grid.Columns - 1), 0.0, 1.0),
      n * std::clamp(place.y() / (grid.Rows - 1), 0.0, 1.0));
    const int i = std::min(static_cast<int>(x.x()), n - 1);
    const int j = std::min(static_cast<int>(x.y()), n - 1);
    const Vec2 in = x - Vec2(i, j);
    this->add(p, this->FirstQuad[up ? 1 : 0] + j * n + i, up ? in : Vec2(in.y(), in.x()), weight);
  }

  void addGrid(const SkinGrid& grid, const std::vector<CapPoint>& caps, bool up)
  {
    for (std::size_t r = 0; r < grid.Rings.size(); ++r)
    {
      const SkinRing& ring = grid.Rings[r];
      const int sub = std::clamp(
        static_cast<int>(
          std::ceil(grid.Curves[r].length() / (this->Options.PointSpacing * ring.size()))),
        1, 12);
      for (int k = 0; k < ring.size() * sub; ++k)
      {
        const double node = static_cast<double>(k) / sub;
        this->addToFace(
          grid, grid.rounded(ring.place(node)), grid.at(static_cast<Index>(r), node), up, 1.0);
      }
    }
    for (const CapPoint& c : caps)
    {
      this->addToFace(grid, grid.rounded(c.Place), c.Point, up, c.Bridge ? 0.1 : 2.0);
    }
  }

  void addTrunk()
  {
    const int n = this->N;
    // the ends of the trunk belong to bottom and top where there are any
    const std::size_t first = this->has(false) ? 1 : 0;
    const std::size_t end = this->Curves.size() - (this->has(true) ? 1 : 0);
    for (std::size_t k = first; k < end; ++k)
    {
      const double v = this->High * this->Heights[k] / this->Heights.back();
      const int b = std::min(static_cast<int>(v), this->High - 1);
      const int count = std::clamp(
        static_cast<int>(this->Curves[k].length() / this->Options.PointSpacing), 16, 2000);
      for (int i = 0; i < count; ++i)
      {
        const double t = 4.0 * i / count;
        const int q = std::min(static_cast<int>(t * n), 4 * n - 1);
        this->add(this->Curves[k].at(this->shareAt(k, t)), this->FirstQuad[2] + b * 4 * n + q,
          Vec2(t * n - q, v - b), 1.0);
      }
    }
  }

  /// Vertices go to the data nearest to them in the quads around.
  void placeVertices()
  {
    std::vector<double> nearest(this->Mesh.Points.size(), Infinity);
    for (std::size_t k = 0; k < this->Points.Points.size(); ++k)
    {
      const Vec2 uv = this->Points.UV[k];
      const auto& quad = this->Mesh.Quads[this->Points.QuadId[k]];
      const Vec2 corners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      for (int c = 0; c < 4; ++c)
      {
        const double d = (uv - corners[c]).squaredNorm();
        if (d < nearest[quad[c]])
        {
          nearest[quad[c]] = d;
          this->Mesh.Points[quad[c]] = this->Points.Points[k];
        }
      }
    }
    const int n = this->N; // trunk vertices lie on contours
    for (int b = 0; b <= this->High; ++b)
    {
      const double height = this->Heights.back() * b / this->High;
      std::size_t k = 0;
      while (k + 2 < this->Heights.size() && this->Heights[k + 1] <= height)
      {
        ++k;
      }
      const double x = (height - this->Heights[k]) / (this->Heights[k + 1] - this->Heights[k]);
      for (int q = 0; q < 4 * n; ++q)
      {
        const double t = static_cast<double>(q) / n;
        this->Mesh.Points[this->ringVertex(q, b)] =
          (1.0 - x) * this->Curves[k].at(this->shareAt(k, t)) +
          x * this->Curves[k + 1].at(this->shareAt(k + 1, t));
      }
    }
  }

  const ContourStack& Stack;
  const SkinPiece& Piece;
  const SkinComplexOptions& Options;
  SkinGrid Lower, Upper;
  std::vector<CapPoint> LowerCaps, UpperCaps;
  std::vector<ArcCurve> Curves; ///< of the trunk, from low to high
  std::vector<double> Heights;
  std::vector<Outline> Outlines;
  int Rotation = 0;                 ///< side of the upper data set over the lower one's first
  std::array<Index, 3> FirstQuad{}; ///< of bottom, top and sides
  int N = 2;
  int High = 1;
};
} // namespace

Result<SkinComplexFit> fitComplex(const ContourStack& stack, const SkinPiece& piece,
  const SkinComplexOptions& options, Monitor& monitor)
{
  if (piece.Trunk.size() < 2)
  {
    return Status::invalidInput("a part that is closed at both ends needs at least two contours "
                                "between its legs; give more slices or leave its base open");
  }
  Complex complex(stack, piece, options);
  Result<G1FitResult> best = Status::failed("the complex of patches could not be fitted");
  const double ends[] = {0.2, 0.5, 1.0}; // of the progress
  int round = 0;
  for (const double lines : {10.0, 7.0, 5.0})
  {
    SubMonitor part(monitor, round > 0 ? ends[round - 1] : 0.0, ends[round]);
    ++round;
    const std::array<int, 2> size = complex.sizes(lines);
    if (best && 2 * size[0] * size[0] + 4 * size[0] * size[1] > options.PatchLimit)
    {
      break;
    }
    complex.build(size[0], size[1]);
    G1FitOptions fit;
    fit.Robust = false;
    fit.CorrelatedNoise = false;
    fit.DataWeight = 3e3;
    Result<G1FitResult> next = fitG1(complex.Points, complex.Mesh, fit, part);
    if (!next)
    {
      if (next.status().code() == StatusCode::Cancelled)
      {
        return next.status();
      }
      best = best ? std::move(best) : std::move(next);
      continue;
    }
    const auto score = [&](const G1FitResult& r)
    { return 10.0 * r.FoldedPatches + r.Rms / options.Tolerance; };
    if (!best || score(*next) < score(*best))
    {
      best = std::move(next);
    }
    if (best->FoldedPatches == 0 &&
        (best->Rms <= options.Tolerance || best->Rms > Hopeless * options.Tolerance))
    {
      break;
    }
  }
  if (!best)
  {
    return best.status();
  }
  return SkinComplexFit{std::move(*best), complex.ends()};
}
} // namespace bsr
