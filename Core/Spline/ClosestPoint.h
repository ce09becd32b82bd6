#pragma once

#include "Common/BoxTree.h"
#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Spline/SplineModel.h"
#include "Spline/Topology.h"

namespace bsr
{
/// The point of a model nearest to a query.
struct ModelHit
{
  Index Patch = -1;
  double U = 0.0;
  double V = 0.0;
  double SquaredDistance = std::numeric_limits<double>::infinity();
  Vec3 Point = Vec3::Zero();
  Vec3 Normal = Vec3::Zero(); ///< unit, by outwardFlips
  Index Cell = -1;            ///< a hint for the next query
};

/**
 * Finds exact nearest points on a spline model: a bounding-volume tree over Bezier pieces, whose
 * control points bound them, and Newton's method on the patch inside each piece. Answers depend
 * neither on the order of the queries nor on the hint.
 */
class ClosestPoint
{
public:
  /// \pre the model is valid (checkModel) and outlives this object.
  explicit ClosestPoint(const SplineModel& model);

  /// \param shell only patches of this shell, or any where it is negative.
  ModelHit find(const Vec3& p, Index hint = -1, int shell = -1) const;

  /// Distance to a hit, negative on the inner side of the surface. At a sharp edge between patches
  /// the mean of their normals decides, which is the right side for every point.
  double signedDistance(const Vec3& p, const ModelHit& hit) const;

private:
  /// A Bezier piece in an oriented box.
  struct Cell
  {
    Index Patch;
    std::array<double, 4> Range; ///< u from, to, v from, to
    Vec3 Center;
    Eigen::Matrix3d Axes;
    Vec3 Low, High;
  };
  void addCells(Index patch, std::vector<Box>& boxes);
  ModelHit project(const Cell& cell, const Vec3& p) const;
  Vec3 edgeNormal(const ModelHit& hit) const;

  const SplineModel& Model;
  std::vector<char> Flip;
  std::vector<Cell> Cells;
  BoxTree Tree;
};

struct DeviationOptions
{
  /// Shell that each point is compared with (0 outer, 1 inner, 2 wall), or any where negative;
  /// empty: any for all points. Points with a value above 2 are compared with any shell and do not
  /// count in the summary.
  std::vector<int> ShellOfPoint;
};

/// Signed distances of points from a model; positive outside.
struct Deviation
{
  std::vector<double> Distance;
  std::vector<Index> PatchId;
  std::int64_t Counted = 0; ///< points in the summary
  double RMS = 0.0;
  double Mean = 0.0;                   ///< of the signed values
  double Max = 0.0;                    ///< of the absolute values, like the percentiles
  std::array<double, 5> Percentiles{}; ///< 50, 75, 90, 95, 99 %
};

/// Distances of points from a model. Fails with InvalidInput on no point, coordinates that are not
/// finite, or a shell that the model does not have. \pre the model is valid.
Result<Deviation> measureDeviation(const SplineModel& model, const std::vector<Vec3>& points,
  const DeviationOptions& options, Monitor& monitor);
} // namespace bsr
