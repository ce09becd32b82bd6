/**
 * Prints the table of layout quality: LayoutTable [-o FOLDER] [-f ANGLE] [-m METHOD] [-t 50,100]
 * FILE.obj ... One line a surface and number of quads: validity, topology, irregular vertices,
 * shape, distance in percent of the diagonal of the bounding box, seconds. With -o the layouts are
 * kept as OBJ files.
 */
#include "Layout/QuadRemesh.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string>

namespace
{
using namespace bsr;

TriangleMesh readObj(const std::string& name)
{
  TriangleMesh mesh;
  std::ifstream in(name);
  std::string line;
  while (std::getline(in, line))
  {
    if (line.rfind("v ", 0) == 0)
    {
      char* end = nullptr;
      const double x = std::strtod(line.c_str() + 2, &end);
      const double y = std::strtod(end, &end);
      const double z = std::strtod(end, &end);
      mesh.Points.emplace_back(x, y, z);
    }
    else if (line.rfind("f ", 0) == 0)
    {
      char* end = nullptr;
      std::array<Index, 3> t;
      const char* at = line.c_str() + 2;
      for (Index& v : t)
      {
        v = static_cast<Index>(std::strtol(at, &end, 10)) - 1;
        at = end;
      }
      mesh.Triangles.push_back(t);
    }
  }
  return mesh;
}

void writeObj(const QuadMesh& mesh, const std::string& name)
{
  std::ofstream out(name);
  out.precision(9);
  for (const Vec3& p : mesh.Points)
  {
    out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  }
  for (const auto& q : mesh.Quads)
  {
    out << "f " << q[0] + 1 << ' ' << q[1] + 1 << ' ' << q[2] + 1 << ' ' << q[3] + 1 << '\n';
  }
}

double diagonal(const TriangleMesh& mesh)
{
  Vec3 low = mesh.Points.front();
  Vec3 high = low;
  for (const Vec3& p : mesh.Points)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

void run(const TriangleMesh& mesh, const std::string& name, const QuadRemeshOptions& options,
  const std::string& folder)
{
  Monitor monitor;
  const std::clock_t start = std::clock();
  const auto layout = quadRemesh(mesh, options, monitor);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("%-24s %5d ", name.c_str(), options.NumberOfQuads);
  if (!layout)
  {
    std::printf("ERROR %s (%.1f s)\n", layout.status().message().c_str(), seconds);
    std::fflush(stdout);
    return;
  }
  const LayoutReport& r = layout->Report;
  int other = 0;
  for (LayoutStage stage : layout->Stages)
  {
    other += stage != LayoutStage::Parametrized;
  }
  const double d = 100.0 / diagonal(mesh);
  std::printf("%5zu %s comp %3d chi %4d loops %2d irr %4d val %2d flip %d sJ %5.2f/%.3f dev %4.1f "
              "H %5.2f/%.3f st %d/%zu %5.1fs\n",
    layout->Mesh.Quads.size(), r.Valid ? "ok " : "BAD", r.Components, r.Euler, r.BoundaryLoops,
    r.Irregular, r.MaxValence, r.Flipped, r.MinJacobian, r.MeanJacobian, r.MeanAngleDeviation,
    d * layout->Distance.Maximum, d * layout->Distance.Mean, other, layout->Stages.size(), seconds);
  std::fflush(stdout);
  if (!folder.empty())
  {
    writeObj(
      layout->Mesh, folder + "/" + name + "-" + std::to_string(options.NumberOfQuads) + ".obj");
  }
}
} // namespace

int main(int argc, char** argv)
{
  QuadRemeshOptions options;
  std::string folder;
  std::vector<int> counts = {50, 100, 250, 500, 1000, 2000};
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    if (word == "-o" && i + 1 < argc)
    {
      folder = argv[++i];
    }
    else if (word == "-f" && i + 1 < argc)
    {
      options.FeatureAngle = std::atof(argv[++i]);
    }
    else if (word == "-m" && i + 1 < argc)
    {
      options.Method = static_cast<LayoutMethod>(std::clamp(std::atoi(argv[++i]), 0, 1));
    }
    else if (word == "-s" && i + 1 < argc)
    {
      options.Seed = std::atoi(argv[++i]);
    }
    else if (word == "-t" && i + 1 < argc)
    {
      counts.clear();
      for (char* at = std::strtok(argv[++i], ","); at != nullptr; at = std::strtok(nullptr, ","))
      {
        counts.push_back(std::atoi(at));
      }
    }
    else
    {
      const TriangleMesh mesh = readObj(word);
      std::string name = word.substr(word.find_last_of('/') + 1);
      name = name.substr(0, name.find_last_of('.'));
      for (int n : counts)
      {
        options.NumberOfQuads = n;
        run(mesh, name, options, folder);
      }
    }
  }
  return 0;
}
