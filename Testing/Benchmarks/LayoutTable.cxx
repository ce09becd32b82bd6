/**
 * Prints the table of layouts: LayoutTable [-o FOLDER] [-r FILE] [-f ANGLE] [-m METHOD] [-s SEED]
 * [-t 50,100] FILE.obj ... One line of Markdown a surface and number of quads. With -o the layouts
 * are kept as OBJ files; with -r lines are added to FILE, and those that it has are not made again.
 *
 * Every layout is judged by a checker that knows nothing of the library: oriented 2-manifold, Euler
 * characteristic and boundary loops of each component those of the repaired surface, no doublet, no
 * repeated quad, no two quads with two common edges. Flipped: quads whose scaled Jacobian against
 * their mean normal is not above 0. Least: lower bound by topology. Stage: components by the road
 * that gave them. Gap: longest time in which the computation did not ask whether it is cancelled,
 * the lesser of wall and processor time.
 */
#include "../Core/PolygonTopology.h"
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

double processorSeconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Notes the longest time between two questions.
class GapMonitor : public Monitor
{
public:
  bool cancelled() override
  {
    const auto wall = std::chrono::steady_clock::now();
    const double processor = processorSeconds();
    const std::chrono::duration<double> passed = wall - this->Wall;
    this->Longest = std::max(this->Longest, std::min(passed.count(), processor - this->Processor));
    this->Wall = wall;
    this->Processor = processor;
    return false;
  }
  double Longest = 0.0;

private:
  std::chrono::steady_clock::time_point Wall = std::chrono::steady_clock::now();
  double Processor = processorSeconds();
};

/// Why the layout is not one of the repaired surface, or "ok".
std::string verdict(const TriangleMesh& mesh, const QuadRemeshOptions& o, const QuadLayout& layout)
{
  std::string problem = bsrtest::layoutProblem(layout.Mesh);
  if (!problem.empty())
  {
    return problem;
  }
  BuildSurfaceOptions building;
  building.FeatureAngle = o.FeatureAngle;
  building.SmallestShare = o.SmallestComponent / o.NumberOfQuads;
  RepairReport repairs;
  Monitor monitor;
  const auto surfaces = buildSurfaces(mesh, building, repairs, monitor);
  if (!surfaces)
  {
    return surfaces.status().message();
  }
  std::vector<bsrtest::ComponentTopology> wanted;
  for (const TriangleSurface& s : *surfaces)
  {
    const bsrtest::PolygonTopology<3> topology(s.toMesh().Triangles);
    wanted.insert(wanted.end(), topology.Components.begin(), topology.Components.end());
  }
  std::sort(wanted.begin(), wanted.end());
  const auto got = bsrtest::PolygonTopology<4>(layout.Mesh.Quads).Components;
  return bsrtest::text(wanted) == bsrtest::text(got) ? "ok" : "another topology";
}

std::string stages(const QuadLayout& layout)
{
  static const std::array<const char*, 5> names = {"map", "pairs", "Morse", "finer map", "box"};
  std::array<int, 5> count{};
  for (LayoutStage stage : layout.Stages)
  {
    ++count[static_cast<std::size_t>(stage)];
  }
  std::string text;
  for (std::size_t i = 0; i < count.size(); ++i)
  {
    if (count[i] > 0)
    {
      text += (text.empty() ? "" : ", ") + std::to_string(count[i]) + " " + names[i];
    }
  }
  return text;
}

std::string rowStart(const std::string& name, int asked)
{
  return "| " + name + " | " + std::to_string(asked) + " |";
}

std::string row(const TriangleMesh& mesh, const std::string& name, const QuadRemeshOptions& options,
  QuadMesh& out)
{
  GapMonitor monitor;
  const double start = processorSeconds();
  const auto layout = quadRemesh(mesh, options, monitor);
  monitor.cancelled();
  const double seconds = processorSeconds() - start;
  if (!layout)
  {
    return rowStart(name, options.NumberOfQuads) + " error: " + layout.status().message() + " |";
  }
  out = layout->Mesh;
  const LayoutReport& r = layout->Report;
  const double d = 100.0 / diagonal(mesh);
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(),
    " %zu | %d | %s | %d / %d / %d | %d | %d | %d | %.2f / %.3f | %.1f | %.2f / %.3f | %s | %.1f | "
    "%.2f |",
    layout->Mesh.Quads.size(), layout->MinimumQuads, verdict(mesh, options, *layout).c_str(),
    r.Components, r.Euler, r.BoundaryLoops, bsrtest::flippedQuads(layout->Mesh), r.Irregular,
    r.MaxValence, r.MinJacobian, r.MeanJacobian, r.MeanAngleDeviation, d * layout->Distance.Maximum,
    d * layout->Distance.Mean, stages(*layout).c_str(), seconds, monitor.Longest);
  return rowStart(name, options.NumberOfQuads) + text.data();
}

/// Is there a line for this in the file?
bool has(const std::string& file, const std::string& start)
{
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line))
  {
    if (line.rfind(start, 0) == 0)
    {
      return true;
    }
  }
  return false;
}

void run(const TriangleMesh& mesh, const std::string& name, const QuadRemeshOptions& options,
  const std::string& folder, const std::string& file)
{
  QuadMesh quads;
  const std::string text = row(mesh, name, options, quads);
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
  if (!file.empty())
  {
    std::ofstream(file, std::ios::app) << text << '\n';
  }
  if (!folder.empty())
  {
    writeObj(quads, folder + "/" + name + "-" + std::to_string(options.NumberOfQuads) + ".obj");
  }
}

void runFile(const std::string& path, const std::vector<int>& counts, QuadRemeshOptions options,
  const std::string& folder, const std::string& file)
{
  std::string name = path.substr(path.find_last_of('/') + 1);
  name = name.substr(0, name.find_last_of('.'));
  TriangleMesh mesh;
  for (int n : counts)
  {
    if (has(file, rowStart(name, n)))
    {
      continue;
    }
    if (mesh.Triangles.empty())
    {
      mesh = readObj(path);
    }
    options.NumberOfQuads = n;
    run(mesh, name, options, folder, file);
  }
}
} // namespace

int main(int argc, char** argv)
{
  QuadRemeshOptions options;
  std::string folder;
  std::string file;
  std::vector<int> counts = {50, 100, 250, 500, 1000, 2000};
  std::printf(
    "| surface | asked | quads | least | valid | components / χ / loops | flipped | irregular | "
    "largest valence | scaled Jacobian | angle | Hausdorff / mean %% | stage | s | gap s |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    if (word == "-o" && i + 1 < argc)
    {
      folder = argv[++i];
    }
    else if (word == "-r" && i + 1 < argc)
    {
      file = argv[++i];
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
      runFile(word, counts, options, folder, file);
    }
  }
  return 0;
}
