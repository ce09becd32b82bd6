#include "Image/FiberPhantom.h"

#include <cmath>
#include <string>

namespace bsr
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

/// Collects the first complaint.
class Checks
{
public:
  template <class T>
  void within(const char* name, T value, T low, T high, const char* unit)
  {
    const auto text = [](T v)
    {
      std::string s = std::to_string(v);
      if (s.find('.') != std::string::npos)
      {
        s.erase(s.find_last_not_of('0') + 1);
        s.erase(s.back() == '.' ? s.size() - 1 : s.size());
      }
      return s;
    };
    if (this->Outcome && !(value >= low && value <= high)) // NaN is not within
    {
      this->Outcome =
        Status::invalidParameter(std::string(name) + " is " + text(value) + "; choose " +
                                 text(low) + " to " + text(high) + (*unit ? " " : "") + unit + ".");
    }
  }
  Status Outcome;
};

Status check(const FiberPhantomOptions& o)
{
  Checks c;
  for (int a = 0; a < 3; ++a)
  {
    c.within("Dimensions", o.Dimensions[a], 24, 8192, "voxels a side");
    c.within("Spacing", o.Spacing[a], 1e-9, 1e9, "");
  }
  c.within("Holes", o.Holes, 0, 10000, "");
  c.within("Pits", o.Pits, -1, 10000, "(-1: automatic)");
  c.within("Tunnels", o.Tunnels, -1, 100000, "(-1: automatic)");
  c.within("Cavities", o.Cavities, -1, 100000, "(-1: automatic)");
  c.within("Debris", o.Debris, 0, 10000, "");
  c.within("Roughness", o.Roughness, 0.0, 5.0, "voxels");
  c.within("Noise", o.Noise, 0.0, 2.0, "of the contrast");
  c.within("Rings", o.Rings, 0.0, 1.0, "of the contrast");
  c.within("Shading", o.Shading, 0.0, 0.5, "of the contrast");
  c.within("Blur", o.Blur, 0.0, 5.0, "voxels");
  c.within("Collapse", o.Collapse, 0.0, 1.0, "");
  c.within("Bend", o.Bend, 0.0, 2.0, "");
  c.within("Twist", o.Twist, -3.0, 3.0, "turns");
  c.within("Wall Thickness", o.WallThickness, 0.1, 0.5, "of the mean radius");
  c.within("Length", o.Length, 0.3, 1.5, "of the volume's length");
  c.within("Air Value", o.AirValue, 0.0, 65535.0, "");
  c.within("Wall Value", o.WallValue, 0.0, 65535.0, "");
  if (!c.Outcome)
  {
    return c.Outcome;
  }
  if (!(o.WallValue > o.AirValue))
  {
    return Status::invalidParameter("Wall Value must be larger than Air Value.");
  }
  const double least = std::min({o.Spacing[0], o.Spacing[1], o.Spacing[2]});
  const double most = std::max({o.Spacing[0], o.Spacing[1], o.Spacing[2]});
  if (most > 20.0 * least)
  {
    return Status::invalidParameter(
      "Spacing differs by more than 20 to 1 between the axes; choose more even voxels.");
  }
  const double length = o.Dimensions[0] * o.Spacing[0];
  const double across = std::min(o.Dimensions[1] * o.Spacing[1], o.Dimensions[2] * o.Spacing[2]);
  if (across < 20.0 * least || length < 0.5 * across || length > 200.0 * across)
  {
    return Status::invalidParameter("The volume must be at least 20 of its smallest voxels wide "
                                    "and 0.5 to 200 times as long (x) as wide (y, z); change "
                                    "Dimensions or Spacing.");
  }
  return Status::ok();
}

/// A grid of rows along the fiber and columns around it, closed around.
class Grid
{
public:
  Grid(FiberTruth& truth, FiberShape::Wall wall, int columns)
      : Truth(truth), Wall(wall), Columns(columns)
  {
  }

  void row(const std::vector<Vec3>& points, std::int32_t end)
  {
    const auto first = this->add(points, end);
    if (this->Last >= 0)
    {
      for (int j = 0; j < this->Columns; ++j)
      {
        const Index k = (j + 1) % this->Columns;
        this->quad({this->Last + j, first + j, first + k, this->Last + k});
      }
    }
    this->Last = first;
    if (this->Tip >= 0)
    {
      this->fan(this->Tip, false);
      this->Tip = -1;
    }
  }

  /// The single point that closes the grid before its first or after its last row.
  void tip(const Vec3& point)
  {
    const Index t = this->add({point}, 0);
    if (this->Last < 0)
    {
      this->Tip = t;
    }
    else
    {
      this->fan(t, true);
    }
  }

private:
  Index add(const std::vector<Vec3>& points, std::int32_t end)
  {
    const auto first = static_cast<Index>(this->Truth.Points.size());
    this->Truth.Points.insert(this->Truth.Points.end(), points.begin(), points.end());
    this->Truth.Side.resize(this->Truth.Points.size(), static_cast<std::uint8_t>(this->Wall));
    this->Truth.End.resize(this->Truth.Points.size(), end);
    return first;
  }
  void fan(Index tip, bool after)
  {
    for (int j = 0; j < this->Columns; ++j)
    {
      const Index a = this->Last + j;
      const Index b = this->Last + (j + 1) % this->Columns;
      this->quad(after ? std::array<Index, 4>{a, tip, b, b} : std::array<Index, 4>{b, tip, a, a});
    }
  }
  /// Both walls face the air: outward outside, into the lumen inside.
  void quad(std::array<Index, 4> q)
  {
    if (this->Wall == FiberShape::Outer)
    {
      q = q[2] == q[3] ? std::array<Index, 4>{q[2], q[1], q[0], q[0]}
                       : std::array<Index, 4>{q[3], q[2], q[1], q[0]};
    }
    this->Truth.Quads.push_back(q);
  }

  FiberTruth& Truth;
  FiberShape::Wall Wall;
  int Columns;
  Index Last = -1;
  Index Tip = -1;
};

struct Circle
{
  explicit Circle(int columns) : Points(static_cast<std::size_t>(columns))
  {
    for (int j = 0; j < columns; ++j)
    {
      const double angle = 2.0 * Pi * j / columns;
      this->Points[static_cast<std::size_t>(j)] = Vec2(std::cos(angle), std::sin(angle));
    }
  }
  std::vector<Vec2> Points;
};

void openWall(
  const FiberShape& shape, FiberShape::Wall wall, const Circle& circle, int rows, Grid& grid)
{
  std::vector<Vec3> row(circle.Points.size());
  for (int i = 0; i <= rows; ++i)
  {
    for (std::size_t j = 0; j < row.size(); ++j)
    {
      const Vec2& c = circle.Points[j];
      const double low = shape.cutAt(0, wall, c.x(), c.y());
      const double high = shape.cutAt(1, wall, c.x(), c.y());
      row[j] = shape.wallPoint(wall, low + (high - low) * i / rows, c.x(), c.y());
    }
    grid.row(row, i == 0 ? 1 : i == rows ? 2 : 0);
  }
}

void closedWall(
  const FiberShape& shape, FiberShape::Wall wall, const Circle& circle, int rows, Grid& grid)
{
  std::vector<Vec3> row(circle.Points.size());
  const auto addRow = [&](double x, double shrink)
  {
    for (std::size_t j = 0; j < row.size(); ++j)
    {
      row[j] = shape.wallPoint(wall, x, circle.Points[j].x(), circle.Points[j].y(), shrink);
    }
    grid.row(row, 0);
  };
  const double length = shape.capLength(wall);
  const int capRows = std::max(4, static_cast<int>(1.6 * length / shape.voxel()));
  grid.tip(shape.wallPoint(wall, shape.capBase(0) - length, 1.0, 0.0, 0.0));
  for (int i = capRows - 1; i > 0; --i)
  {
    const double a = 0.5 * Pi * i / capRows;
    addRow(shape.capBase(0) - length * std::sin(a), std::cos(a));
  }
  for (int i = 0; i <= rows; ++i)
  {
    addRow(shape.capBase(0) + (shape.capBase(1) - shape.capBase(0)) * i / rows, 1.0);
  }
  for (int i = 1; i < capRows; ++i)
  {
    const double a = 0.5 * Pi * i / capRows;
    addRow(shape.capBase(1) + length * std::sin(a), std::cos(a));
  }
  grid.tip(shape.wallPoint(wall, shape.capBase(1) + length, 1.0, 0.0, 0.0));
}
} // namespace

Result<FiberPhantom> makeFiberPhantom(const FiberPhantomOptions& options)
{
  Status s = check(options);
  if (!s)
  {
    return s;
  }
  FiberPhantom phantom;
  phantom.Options = options;
  phantom.Shape = FiberShape(options);
  phantom.Defects = makeFiberDefects(options, phantom.Shape);
  return phantom;
}

FiberTruth fiberTruth(const FiberPhantom& phantom)
{
  FiberTruth truth;
  const FiberShape& shape = phantom.Shape;
  for (const FiberShape::Wall wall : {FiberShape::Outer, FiberShape::Inner})
  {
    const double around = 2.0 * Pi * shape.meanRadius() * (wall == FiberShape::Outer ? 1.0 : 0.7);
    const int columns = std::max(16, static_cast<int>(around / shape.voxel()));
    const int rows = std::max(8, static_cast<int>((shape.end() - shape.begin()) / shape.voxel()));
    const Circle circle(columns);
    Grid grid(truth, wall, columns);
    if (shape.openEnds())
    {
      openWall(shape, wall, circle, rows, grid);
    }
    else
    {
      closedWall(shape, wall, circle, rows, grid);
    }
  }
  return truth;
}
} // namespace bsr
