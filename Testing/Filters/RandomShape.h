#ifndef RandomShape_h
#define RandomShape_h

#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace bsrtest
{
/**
 * A smooth closed surface that depends on a seed only: the zero set of a blend of balls, tubes and
 * rings with some waves, sampled on n^3 voxels of a box. Any genus, sometimes several components.
 */
inline vtkSmartPointer<vtkPolyData> randomShape(unsigned seed, int n)
{
  std::mt19937 engine(seed);
  // Not std::uniform_real_distribution: its numbers differ between libraries.
  auto random = [&](double a, double b) { return a + (b - a) * (engine() / 4294967296.0); };
  struct Part
  {
    int Kind;
    double C[3], D[3], R, T;
  };
  std::vector<Part> parts(2 + engine() % 4);
  for (Part& p : parts)
  {
    p.Kind = static_cast<int>(engine() % 3);
    double length = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      p.C[k] = random(-0.4, 0.4);
      p.D[k] = random(-1.0, 1.0);
      length += p.D[k] * p.D[k];
    }
    for (double& d : p.D)
    {
      d /= std::sqrt(std::max(length, 1e-9));
    }
    p.R = random(0.22, 0.38);
    p.T = random(0.1, 0.16);
  }
  const double wave = random(0.0, 0.02);
  auto value = [&](double x, double y, double z)
  {
    double sum = 0.0;
    for (const Part& p : parts)
    {
      const double w[3] = {x - p.C[0], y - p.C[1], z - p.C[2]};
      const double along = w[0] * p.D[0] + w[1] * p.D[1] + w[2] * p.D[2];
      const double r2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
      const double across = std::sqrt(std::max(r2 - along * along, 0.0));
      double d = std::sqrt(r2) - p.R;
      if (p.Kind == 1)
      {
        d = std::hypot(across, std::max(std::abs(along) - p.R, 0.0)) - p.T;
      }
      else if (p.Kind == 2)
      {
        d = std::hypot(across - p.R, along) - p.T;
      }
      sum += std::exp(-25.0 * d);
    }
    return -std::log(sum) / 25.0 + wave * std::sin(17.0 * x) * std::sin(19.0 * y + 11.0 * z);
  };
  vtkNew<vtkImageData> image;
  image->SetDimensions(n, n, n);
  const double h = 2.2 / (n - 1);
  image->SetSpacing(h, h, h);
  image->SetOrigin(-1.1, -1.1, -1.1);
  image->AllocateScalars(VTK_DOUBLE, 1);
  auto* data = static_cast<double*>(image->GetScalarPointer());
  for (int k = 0; k < n; ++k)
  {
    for (int j = 0; j < n; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        *data++ = value(i * h - 1.1, j * h - 1.1, k * h - 1.1);
      }
    }
  }
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(image);
  contour->SetValue(0, 0.0);
  contour->ComputeNormalsOff();
  contour->ComputeScalarsOff();
  contour->Update();
  return contour->GetOutput();
}

/// V - E + F of a closed triangle surface.
inline int eulerOfClosed(vtkPolyData* surface)
{
  return static_cast<int>(surface->GetNumberOfPoints() - surface->GetNumberOfPolys() / 2);
}
} // namespace bsrtest

#endif
