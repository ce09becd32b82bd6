#pragma once

#include "Mesh/TriangleSurface.h"

#include <Eigen/SparseCore>

namespace bsr
{
/**
 * The Laplace-Beltrami operator of a surface as stiffness and lumped mass: the eigenfunctions solve
 * Stiffness u = lambda Mass u. Virtual vertices (middles of holes) have no row: boundaries are
 * natural (Neumann).
 */
struct Laplacian
{
  Eigen::SparseMatrix<double> Stiffness; ///< symmetric, rows sum to 0, both triangles stored
  Eigen::VectorXd Mass;                  ///< positive: area around each vertex
  std::vector<Index> Row;                ///< row of each vertex of the surface, -1: none
};

/**
 * Cotangent weights (Pinkall and Polthier 1993) on the intrinsic Delaunay triangulation of the
 * surface (Bobenko and Springborn 2007), whose weights are never negative inside, whatever the
 * triangles; edge lengths are first raised until every triangle is one (intrinsic mollification,
 * Sharp and Crane 2020). Edges at boundaries are kept and their weight is clamped at 0.
 *
 * \pre `s` is compact.
 */
Laplacian cotangentLaplacian(const TriangleSurface& s);
} // namespace bsr
