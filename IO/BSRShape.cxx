#include "BSRShape.h"

#include "Spline/Evaluate.h"
#include "Spline/Topology.h"
#include "Spline/Volume.h"

#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

namespace bsr
{
namespace
{
/// Distinct knots with multiplicities, as OpenCASCADE wants them.
struct KnotVector
{
  TColStd_Array1OfReal Knots;
  TColStd_Array1OfInteger Mults;
};

KnotVector knotVector(const double* k, int n)
{
  std::vector<double> knots;
  std::vector<int> mults;
  for (int i = 0; i < n; ++i)
  {
    if (knots.empty() || k[i] > knots.back())
    {
      knots.push_back(k[i]);
      mults.push_back(0);
    }
    ++mults.back();
  }
  const auto size = static_cast<int>(knots.size());
  KnotVector v{TColStd_Array1OfReal(1, size), TColStd_Array1OfInteger(1, size)};
  for (int i = 0; i < size; ++i)
  {
    v.Knots(i + 1) = knots[i];
    v.Mults(i + 1) = mults[i];
  }
  return v;
}

/// An edge as a face uses it: `Forward` if the face's side parameter runs along the edge's curve.
struct EdgeUse
{
  TopoDS_Edge Edge;
  bool Forward = true;
  double From = 0.0; ///< range of the curve's parameter
  double To = 1.0;
};

/// Builds faces, edges and vertices of one model.
class ShapeBuilder
{
public:
  ShapeBuilder(const SplineModel& model, double scale, bool shared)
      : Model(model), Scale(scale), Shared(shared), Uses(4 * model.Patches.size())
  {
    const std::vector<GridSize> corners(model.Patches.size(), GridSize{2, 2});
    SplineModel separate;
    if (!shared)
    {
      separate = model;
      separate.Neighbors.assign(model.Patches.size(), {-1, -1, -1, -1});
    }
    this->Corners = stitchGrids(shared ? model : separate, corners);
    this->Vertices.resize(this->Corners.Owner.size());
  }

  TopoDS_Face face(std::int64_t patch);

private:
  const SplinePatch& patchOf(std::int64_t p) const { return this->Model.Patches[p]; }
  gp_Pnt pole(std::int64_t index) const
  {
    const Vec4& c = this->Model.ControlPoints[index];
    return gp_Pnt(this->Scale * c[0], this->Scale * c[1], this->Scale * c[2]);
  }
  KnotVector knots(const SplinePatch& p, bool alongU) const
  {
    return alongU ? knotVector(this->Model.Knots.data() + p.FirstKnotU, p.CountU + p.DegreeU + 1)
                  : knotVector(this->Model.Knots.data() + p.FirstKnotV, p.CountV + p.DegreeV + 1);
  }
  Handle(Geom_BSplineSurface) surface(const SplinePatch& p) const;
  Handle(Geom_BSplineCurve) sideCurve(const SplinePatch& p, int side) const;
  TopoDS_Vertex vertex(std::int64_t patch, int side, bool last);
  EdgeUse edge(std::int64_t patch, int side);
  EdgeUse newEdge(std::int64_t patch, int side);
  Handle(Geom2d_Curve) parameterCurve(std::int64_t patch, int side, const EdgeUse& use) const;

  const SplineModel& Model;
  double Scale;
  bool Shared;
  StitchedGrids Corners;
  std::vector<TopoDS_Vertex> Vertices;
  std::vector<EdgeUse> Uses; ///< of each side; null until its edge exists
  BRep_Builder Build;
};

Handle(Geom_BSplineSurface) ShapeBuilder::surface(const SplinePatch& p) const
{
  TColgp_Array2OfPnt poles(1, p.CountU, 1, p.CountV);
  TColStd_Array2OfReal weights(1, p.CountU, 1, p.CountV);
  bool rational = false;
  for (int j = 0; j < p.CountV; ++j)
  {
    for (int i = 0; i < p.CountU; ++i)
    {
      const std::int64_t at = p.FirstControlPoint + static_cast<std::int64_t>(j) * p.CountU + i;
      poles(i + 1, j + 1) = this->pole(at);
      weights(i + 1, j + 1) = this->Model.ControlPoints[at][3];
      rational = rational || weights(i + 1, j + 1) != weights(1, 1);
    }
  }
  const KnotVector u = this->knots(p, true);
  const KnotVector v = this->knots(p, false);
  return rational ? new Geom_BSplineSurface(
                      poles, weights, u.Knots, v.Knots, u.Mults, v.Mults, p.DegreeU, p.DegreeV)
                  : new Geom_BSplineSurface(
                      poles, u.Knots, v.Knots, u.Mults, v.Mults, p.DegreeU, p.DegreeV);
}

Handle(Geom_BSplineCurve) ShapeBuilder::sideCurve(const SplinePatch& p, int side) const
{
  const bool alongU = side % 2 == 0;
  const int n = alongU ? p.CountU : p.CountV;
  TColgp_Array1OfPnt poles(1, n);
  TColStd_Array1OfReal weights(1, n);
  bool rational = false;
  for (int k = 0; k < n; ++k)
  {
    const std::int64_t at = p.FirstControlPoint + gridSideIndex({p.CountU, p.CountV}, side, k);
    poles(k + 1) = this->pole(at);
    weights(k + 1) = this->Model.ControlPoints[at][3];
    rational = rational || weights(k + 1) != weights(1);
  }
  const KnotVector v = this->knots(p, alongU);
  const int degree = alongU ? p.DegreeU : p.DegreeV;
  return rational ? new Geom_BSplineCurve(poles, weights, v.Knots, v.Mults, degree)
                  : new Geom_BSplineCurve(poles, v.Knots, v.Mults, degree);
}

TopoDS_Vertex ShapeBuilder::vertex(std::int64_t patch, int side, bool last)
{
  const std::int64_t corner = gridSideIndex({2, 2}, side, last ? 1 : 0);
  TopoDS_Vertex& v = this->Vertices[this->Corners.Id[this->Corners.First[patch] + corner]];
  if (v.IsNull())
  {
    const SplinePatch& p = this->patchOf(patch);
    const std::int64_t n = side % 2 == 0 ? p.CountU : p.CountV;
    const std::int64_t at =
      p.FirstControlPoint + gridSideIndex({p.CountU, p.CountV}, side, last ? n - 1 : 0);
    this->Build.MakeVertex(v, this->pole(at), Precision::Confusion());
  }
  return v;
}

EdgeUse ShapeBuilder::newEdge(std::int64_t patch, int side)
{
  const SplinePatch& p = this->patchOf(patch);
  const std::array<double, 4> d = patchDomain(this->Model, p);
  const double from = side % 2 == 0 ? d[0] : d[2];
  const double to = side % 2 == 0 ? d[1] : d[3];
  TopoDS_Edge e;
  if (sideCollapsed(this->Model, patch, side))
  {
    this->Build.MakeEdge(e);
    this->Build.Degenerated(e, true);
  }
  else
  {
    this->Build.MakeEdge(e, this->sideCurve(p, side), Precision::Confusion());
  }
  this->Build.Add(e, this->vertex(patch, side, false).Oriented(TopAbs_FORWARD));
  this->Build.Add(e, this->vertex(patch, side, true).Oriented(TopAbs_REVERSED));
  this->Build.Range(e, from, to);
  return {e, true, from, to};
}

EdgeUse ShapeBuilder::edge(std::int64_t patch, int side)
{
  EdgeUse& use = this->Uses[4 * patch + side];
  if (!use.Edge.IsNull())
  {
    return use;
  }
  use = this->newEdge(patch, side);
  const SideMatch m = this->Shared ? matchSide(this->Model, patch, side) : SideMatch{};
  if (m.Patch >= 0)
  {
    this->Uses[4 * m.Patch + m.Side] = {use.Edge, !m.Reversed, use.From, use.To};
  }
  return use;
}

/// The straight line in a patch's parameters that runs along the edge's curve.
Handle(Geom2d_Curve) ShapeBuilder::parameterCurve(
  std::int64_t patch, int side, const EdgeUse& use) const
{
  const std::array<double, 4> d = patchDomain(this->Model, this->patchOf(patch));
  gp_Pnt2d a(side == 1 ? d[1] : d[0], side == 2 ? d[3] : d[2]);
  gp_Pnt2d b(side == 3 ? d[0] : d[1], side == 0 ? d[2] : d[3]);
  if (!use.Forward)
  {
    std::swap(a, b);
  }
  const double from = use.From;
  const double to = use.To;
  if (a.Distance(b) == to - from)
  {
    const gp_Dir2d direction(gp_Vec2d(a, b));
    return new Geom2d_Line(a.Translated(gp_Vec2d(direction) * -from), direction);
  }
  TColgp_Array1OfPnt2d poles(1, 2);
  TColStd_Array1OfReal knots(1, 2);
  TColStd_Array1OfInteger mults(1, 2);
  poles(1) = a;
  poles(2) = b;
  knots(1) = from;
  knots(2) = to;
  mults.Init(2);
  return new Geom2d_BSplineCurve(poles, knots, mults, 1);
}

TopoDS_Face ShapeBuilder::face(std::int64_t patch)
{
  TopoDS_Face face;
  this->Build.MakeFace(face, this->surface(this->patchOf(patch)), Precision::Confusion());
  TopoDS_Wire wire;
  this->Build.MakeWire(wire);
  std::array<EdgeUse, 4> uses;
  std::array<Handle(Geom2d_Curve), 4> curves;
  std::array<bool, 4> forward{};
  for (int s = 0; s < 4; ++s)
  {
    uses[s] = this->edge(patch, s);
    curves[s] = this->parameterCurve(patch, s, uses[s]);
    // Counter-clockwise: sides v=0 and u=1 along their parameter, v=1 and u=0 against it.
    forward[s] = (s < 2) == uses[s].Forward;
    this->Build.Add(wire, uses[s].Edge.Oriented(forward[s] ? TopAbs_FORWARD : TopAbs_REVERSED));
  }
  for (int s = 0; s < 4; ++s)
  {
    int twin = -1; // another side with the same edge
    for (int t = 0; t < 4; ++t)
    {
      twin = t != s && uses[t].Edge.IsSame(uses[s].Edge) ? t : twin;
    }
    if (twin < 0)
    {
      this->Build.UpdateEdge(uses[s].Edge, curves[s], face, Precision::Confusion());
    }
    else if (s < twin) // a seam: the patch is its own neighbor
    {
      const int first = forward[s] ? s : twin;
      this->Build.UpdateEdge(
        uses[s].Edge, curves[first], curves[first == s ? twin : s], face, Precision::Confusion());
    }
  }
  for (const EdgeUse& use : uses)
  {
    this->Build.Range(use.Edge, use.From, use.To); // of the new curves, too
  }
  wire.Closed(true);
  this->Build.Add(face, wire);
  return face;
}

/// Whether all neighbors meet in the same curve, so that they can share an edge.
bool sidesMatch(const SplineModel& model)
{
  for (std::int64_t p = 0; p < static_cast<std::int64_t>(model.Patches.size()); ++p)
  {
    for (int s = 0; s < 4; ++s)
    {
      const SideMatch m = matchSide(model, p, s);
      if (m.Patch >= 0 && !m.Same)
      {
        return false;
      }
    }
  }
  return true;
}

TopoDS_Shape single(const TopoDS_Compound& all)
{
  TopoDS_Iterator it(all);
  const TopoDS_Shape first = it.Value();
  it.Next();
  return it.More() ? TopoDS_Shape(all) : first;
}

CadShape separateFaces(const SplineModel& model, double scale)
{
  ShapeBuilder builder(model, scale, false);
  BRep_Builder build;
  TopoDS_Compound all;
  build.MakeCompound(all);
  for (std::size_t p = 0; p < model.Patches.size(); ++p)
  {
    build.Add(all, builder.face(static_cast<std::int64_t>(p)));
  }
  return {all, 0, 0};
}

/// Shells by the neighbor relations, then solids by how the components are nested.
CadShape exactSolids(const SplineModel& model, double scale)
{
  const Nesting nesting = findNesting(model);
  const std::vector<char> flip = outwardFlips(model);
  ShapeBuilder builder(model, scale, true);
  BRep_Builder build;
  std::vector<TopoDS_Shell> shells(nesting.Closed.size());
  for (std::size_t c = 0; c < shells.size(); ++c)
  {
    build.MakeShell(shells[c]);
  }
  for (std::size_t p = 0; p < model.Patches.size(); ++p)
  {
    const Index c = nesting.Component[p];
    const TopoDS_Face face = builder.face(static_cast<std::int64_t>(p));
    build.Add(shells[c], face.Oriented(flip[p] ? TopAbs_REVERSED : TopAbs_FORWARD));
  }
  CadShape out;
  TopoDS_Compound all;
  build.MakeCompound(all);
  for (std::size_t c = 0; c < shells.size(); ++c)
  {
    shells[c].Closed(nesting.Closed[c] != 0);
    if (!nesting.Closed[c])
    {
      build.Add(all, shells[c]);
      ++out.OpenShells;
    }
    else if (nesting.Depth[c] % 2 == 0)
    {
      TopoDS_Solid solid;
      build.MakeSolid(solid);
      build.Add(solid, shells[c]);
      for (std::size_t v = 0; v < shells.size(); ++v)
      {
        if (nesting.Closed[v] && nesting.Depth[v] % 2 == 1 &&
            nesting.Parent[v] == static_cast<Index>(c))
        {
          build.Add(solid, shells[v]);
        }
      }
      build.Add(all, solid);
      ++out.Solids;
    }
  }
  out.Shape = single(all);
  return out;
}

/// For sides with different parametrizations: sew by distance, then close solids.
CadShape sewnSolids(const SplineModel& model, double scale)
{
  Vec3 low = model.ControlPoints[0].head<3>();
  Vec3 high = low;
  for (const Vec4& c : model.ControlPoints)
  {
    low = low.cwiseMin(c.head<3>());
    high = high.cwiseMax(c.head<3>());
  }
  BRepBuilderAPI_Sewing sewing(std::max(1e-6, 1e-6 * scale * (high - low).norm()));
  sewing.Add(separateFaces(model, scale).Shape);
  sewing.Perform();
  CadShape out;
  BRep_Builder build;
  TopoDS_Compound all;
  build.MakeCompound(all);
  for (TopExp_Explorer it(sewing.SewedShape(), TopAbs_SHELL); it.More(); it.Next())
  {
    TopoDS_Shell shell = TopoDS::Shell(it.Current());
    if (BRep_Tool::IsClosed(shell))
    {
      TopoDS_Solid solid;
      build.MakeSolid(solid);
      build.Add(solid, shell);
      BRepLib::OrientClosedSolid(solid);
      build.Add(all, solid);
      ++out.Solids;
    }
    else
    {
      build.Add(all, shell);
      ++out.OpenShells;
    }
  }
  for (TopExp_Explorer it(sewing.SewedShape(), TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next())
  {
    build.Add(all, it.Current());
    ++out.OpenShells;
  }
  out.Shape = single(all);
  return out;
}
} // namespace

Result<CadShape> cadShape(const SplineModel& model, double scale, bool sew)
{
  try
  {
    return !sew                ? separateFaces(model, scale)
           : sidesMatch(model) ? exactSolids(model, scale)
                               : sewnSolids(model, scale);
  }
  catch (const Standard_Failure& e)
  {
    return Status::failed(std::string("OpenCASCADE could not build the shape (") +
                          e.GetMessageString() +
                          "); check the unit: sizes must be well above 1e-7 mm.");
  }
}
} // namespace bsr
