#include "Spline/ModelCheck.h"
#include "Spline/Basis.h"

#include <cmath>

namespace bsr
{
namespace
{
Status bad(std::size_t patch, const std::string& what)
{
  return Status::invalidInput("Not a valid spline model: patch " + std::to_string(patch) + " " +
                              what + "; make the model again with its filter.");
}

bool inside(std::int64_t first, std::int64_t count, std::size_t size)
{
  return first >= 0 && count >= 0 && first <= static_cast<std::int64_t>(size) - count;
}

std::string checkKnots(const double* k, int degree, int count)
{
  const int n = count + degree + 1;
  for (int i = 0; i < n; ++i)
  {
    if (!std::isfinite(k[i]) || (i > 0 && k[i] < k[i - 1]))
    {
      return "has knots that decrease or are not finite";
    }
  }
  if (k[0] != k[degree] || k[count] != k[n - 1] || !(k[degree] < k[count]))
  {
    return "has knots without full multiplicity at the ends";
  }
  for (int i = degree + 1; i + degree < count; ++i)
  {
    if (k[i] == k[i + degree])
    {
      return "has an inner knot of multiplicity above its degree";
    }
  }
  return {};
}

std::string checkDirection(const SplineModel& m, int degree, int count, std::int64_t firstKnot)
{
  if (degree < 1 || degree > MaximumDegree)
  {
    return "has degree " + std::to_string(degree) + ", not 1 to " + std::to_string(MaximumDegree);
  }
  if (count <= degree)
  {
    return "has " + std::to_string(count) +
           " control points along a parameter, too few for degree " + std::to_string(degree);
  }
  if (!inside(firstKnot, static_cast<std::int64_t>(count) + degree + 1, m.Knots.size()))
  {
    return "points outside the knot array";
  }
  return checkKnots(m.Knots.data() + firstKnot, degree, count);
}

std::string checkPatch(const SplineModel& m, const SplinePatch& p)
{
  if (static_cast<int>(p.Side) > static_cast<int>(Shell::Wall))
  {
    return "has an unknown shell (0 outer, 1 inner, 2 wall)";
  }
  std::string s = checkDirection(m, p.DegreeU, p.CountU, p.FirstKnotU);
  if (s.empty())
  {
    s = checkDirection(m, p.DegreeV, p.CountV, p.FirstKnotV);
  }
  if (!s.empty())
  {
    return s;
  }
  const std::int64_t count = static_cast<std::int64_t>(p.CountU) * p.CountV;
  if (!inside(p.FirstControlPoint, count, m.ControlPoints.size()))
  {
    return "points outside the control point array";
  }
  for (std::int64_t i = 0; i < count; ++i)
  {
    const Vec4& c = m.ControlPoints[p.FirstControlPoint + i];
    if (!c.allFinite() || !(c[3] > 0.0))
    {
      return "has a control point that is not finite or a weight that is not positive";
    }
  }
  return {};
}

std::string checkNeighbors(const SplineModel& m, std::size_t p)
{
  for (int s = 0; s < 4; ++s)
  {
    const std::int64_t code = m.Neighbors[p][s];
    if (code < -1 || code >= static_cast<std::int64_t>(4 * m.Patches.size()))
    {
      return "names a neighbor that does not exist";
    }
    if (code >= 0 && m.Neighbors[code / 4][code % 4] != static_cast<std::int64_t>(4 * p) + s)
    {
      return "has a neighbor that does not name it in return";
    }
  }
  return {};
}
} // namespace

Status checkModel(const SplineModel& model)
{
  if (model.Patches.empty())
  {
    return Status::invalidInput("The spline model has no patch; check the filter that made it.");
  }
  if (model.Neighbors.size() != model.Patches.size())
  {
    return Status::invalidInput(
      "Not a valid spline model: " + std::to_string(model.Neighbors.size()) +
      " entries of neighbors for " + std::to_string(model.Patches.size()) + " patches.");
  }
  for (std::size_t p = 0; p < model.Patches.size(); ++p)
  {
    std::string what = checkPatch(model, model.Patches[p]);
    if (what.empty())
    {
      what = checkNeighbors(model, p);
    }
    if (!what.empty())
    {
      return bad(p, what);
    }
  }
  return Status::ok();
}
} // namespace bsr
