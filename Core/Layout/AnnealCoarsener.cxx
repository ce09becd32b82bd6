#include "Layout/AnnealCoarsener.h"

namespace bsr::coarsening
{
namespace
{
constexpr double Temperature = 10.0; ///< in squares of edges
constexpr int Patient = 500;         ///< turns tried a quad without a collapse, before it ends
constexpr int MostPatient = 100000;  ///< turns tried without a collapse
constexpr int Passes = 8;            ///< over all edges, to improve shapes
constexpr double Ease = 0.05;        ///< of the price: how much more very bad shapes count
constexpr double Faced = 0.2;        ///< cosine from which a quad looks the way the surface does
constexpr double LeastGain = 1e-3;   ///< of the price, relative
} // namespace

AnnealCoarsener::AnnealCoarsener(const LayoutDraft& draft, const ReferenceSurface& reference,
  const CoarsenOptions& options, const Bounds& bounds, double cell2, Monitor& monitor)
    : LocalCoarsener(draft, reference, options, bounds, cell2, monitor)
{
  this->E.MostEdges = 8;
  this->E.LeastRimEdges = 2;
}

bool AnnealCoarsener::annealTo(int target, Monitor& monitor)
{
  int since = 0; // the last collapse
  const auto patience = [this] { return std::min(Patient * this->count(), MostPatient); };
  for (int i = 0; this->count() > target && since < patience(); ++i, ++since)
  {
    if (i % 8 == 0 && monitor.cancelled())
    {
      return false;
    }
    if (this->step())
    {
      since = 0;
    }
  }
  return true;
}

bool AnnealCoarsener::improve(Monitor& monitor)
{
  bool any = true;
  for (int pass = 0; pass < Passes && any; ++pass)
  {
    any = false;
    for (Index q = 0; q < static_cast<Index>(this->E.Quads.size()); ++q)
    {
      if (q % 4 == 0 && monitor.cancelled())
      {
        return false;
      }
      for (int k = 0; k < 4 && this->E.alive(q); ++k)
      {
        if (this->E.neighbor(q, k) > q)
        {
          any = this->turnOnly(this->turnAt(q, k, 1), true) ||
                this->turnOnly(this->turnAt(q, k, -1), true) || any;
        }
      }
    }
  }
  return true;
}

/// From 0 to below 1 (O'Neill 2014, PCG-XSH-RR).
double AnnealCoarsener::random()
{
  const std::uint64_t s = this->State;
  this->State = s * 6364136223846793005U + 1442695040888963407U;
  const auto x = static_cast<std::uint32_t>(((s >> 18U) ^ s) >> 27U);
  const auto turn = static_cast<std::uint32_t>(s >> 59U);
  return ((x >> turn) | (x << ((32U - turn) % 32U))) / 4294967296.0;
}

AnnealCoarsener::Turn AnnealCoarsener::turnAt(Index quad, int corner, int way) const
{
  Turn t{quad, corner, way, {}};
  const Index other = this->E.crease(quad, corner) ? -1 : this->E.neighbor(quad, corner);
  if (other >= 0)
  {
    t.Hexagon.assign(this->E.Quads[quad].begin(), this->E.Quads[quad].end());
    t.Hexagon.insert(t.Hexagon.end(), this->E.Quads[other].begin(), this->E.Quads[other].end());
    QuadEditor::sortUnique(t.Hexagon);
  }
  return t;
}

AnnealCoarsener::Turn AnnealCoarsener::randomTurn()
{
  const auto n = static_cast<double>(this->E.Quads.size());
  auto q = static_cast<Index>(n * this->random());
  while (!this->E.alive(q))
  {
    q = static_cast<Index>(n * this->random());
  }
  const auto k = static_cast<int>(8.0 * this->random());
  return this->turnAt(q, k / 2, k % 2 == 0 ? 1 : -1);
}

/// Least where some vertices have all the edges allowed and others few.
double AnnealCoarsener::potential(const std::vector<Index>& vertices) const
{
  double sum = 0.0;
  for (Index v : vertices)
  {
    const double room = this->E.MostEdges - this->E.valence(v);
    sum += room >= 0.0 ? -room * room : 9.0 * room * room;
  }
  return sum;
}

bool AnnealCoarsener::isTip(Index v) const
{
  return this->E.Rim[v] != 0 && this->E.Around[v].size() == 1;
}

/// A quad at the tip of an ear is nearly a triangle where the boundary is smooth.
bool AnnealCoarsener::hasTip(const std::vector<Index>& vertices) const
{
  return std::any_of(vertices.begin(), vertices.end(), [this](Index v) { return this->isTip(v); });
}

bool AnnealCoarsener::mayCollapse(const Collapse& c) const
{
  const auto& q = this->E.Quads[c.Quad];
  const Index a = q[c.Corner];
  const Index b = q[c.Corner + 2];
  int edges = this->E.valence(a) + this->E.valence(b) - 2;
  if (this->E.Rim[a] != 0 && this->E.Rim[b] != 0)
  {
    if (!this->isTip(q[c.Corner + 1]) && !this->isTip(q[(c.Corner + 3) % 4]))
    {
      return false;
    }
    --edges;
  }
  return edges <= this->E.MostEdges;
}

std::vector<AnnealCoarsener::Collapse> AnnealCoarsener::collapsesNear(
  const std::vector<Index>& quads) const
{
  std::vector<Collapse> found;
  for (Index q : quads)
  {
    for (int k = 0; k < 2; ++k)
    {
      if (this->mayCollapse({q, k}))
      {
        found.push_back({q, k});
      }
    }
  }
  return found;
}

/// The vertices and all that share quads with them.
std::vector<Index> AnnealCoarsener::ring(const std::vector<Index>& core) const
{
  std::vector<Index> vertices;
  for (Index v : core)
  {
    this->addRing(vertices, v);
  }
  QuadEditor::sortUnique(vertices);
  return vertices;
}

double AnnealCoarsener::away(Index quad) const
{
  const auto& c = this->E.Quads[quad];
  const auto& p = this->E.Points;
  const Vec3 n = (p[c[2]] - p[c[0]]).cross(p[c[3]] - p[c[1]]).normalized();
  double sum = 0.0;
  for (Index v : c)
  {
    sum += 0.25 * n.dot(this->Normal[v]);
  }
  return std::max(0.0, Faced - sum);
}

AnnealCoarsener::Look AnnealCoarsener::look(const std::vector<Index>& quads) const
{
  Look l{1.0, 0.0, 0.0};
  for (Index q : quads)
  {
    if (this->E.alive(q))
    {
      const double shape = this->shape(q);
      l.Worst = std::min(l.Worst, shape);
      l.Price += 1.0 / (std::max(shape, 0.0) + Ease);
      l.Away += this->away(q);
    }
  }
  return l;
}

/// Moves the points around a change of the quads at `core`. False if these, or `quads` that were
/// there before, are worse then.
bool AnnealCoarsener::place(
  const std::vector<Index>& core, std::vector<Index> quads, const Look& before)
{
  const std::vector<Index> vertices = this->ring(core);
  const std::vector<Index> now = this->E.quadsAt(vertices);
  quads.insert(quads.end(), now.begin(), now.end());
  QuadEditor::sortUnique(quads);
  for (int round = 0; round < 2; ++round)
  {
    for (Index v : core)
    {
      if (!this->E.Around[v].empty())
      {
        this->relax(v);
      }
    }
  }
  const double bound = std::min(this->Least, before.Worst);
  for (int round = 0; round < 3 && this->worst(now) < bound; ++round)
  {
    for (Index v : vertices)
    {
      if (this->worst(this->E.Around[v]) < bound)
      {
        this->search(v);
      }
    }
  }
  const Look after = this->look(quads);
  return after.Worst >= bound && after.Away <= before.Away;
}

/// One edge turned at random, if that is taken, and collapses tried that it allows.
/// True: there are fewer quads.
bool AnnealCoarsener::step()
{
  const Turn t = this->randomTurn();
  if (t.Hexagon.size() < 6)
  {
    return false;
  }
  const std::vector<Index> around = this->E.quadsAt(t.Hexagon);
  const double before = this->potential(t.Hexagon);
  this->E.begin();
  const bool turns = this->rotate(t);
  const double rise = this->potential(t.Hexagon) - before;
  const bool tip = this->hasTip(t.Hexagon);
  const std::vector<Collapse> collapses =
    turns ? this->collapsesNear(around) : std::vector<Collapse>();
  this->E.rollback();
  if (!turns)
  {
    return false;
  }
  for (const Collapse& c : collapses)
  {
    if (this->turnAndCollapse(t, c))
    {
      return true;
    }
  }
  if (!tip && (rise <= 0.0 || this->random() < std::exp(-rise / Temperature)))
  {
    this->turnOnly(t, false);
  }
  return false;
}

bool AnnealCoarsener::turnAndCollapse(const Turn& t, const Collapse& c)
{
  std::vector<Index> core = t.Hexagon;
  this->E.begin();
  this->rotate(t);
  const QuadEditor::Quad corners = this->E.Quads[c.Quad];
  this->E.rollback();
  core.insert(core.end(), corners.begin(), corners.end());
  QuadEditor::sortUnique(core);
  const std::vector<Index> quads = this->E.quadsAt(this->ring(core));
  const Look before = this->look(quads);
  this->E.begin();
  this->rotate(t);
  const double side = 0.5 * (this->Side[corners[c.Corner]] + this->Side[corners[c.Corner + 2]]);
  const Index v = this->E.collapse(c.Quad, c.Corner);
  if (v < 0 || !this->place(core, quads, before))
  {
    this->E.rollback();
    return false;
  }
  this->Side[v] = side;
  return true;
}

bool AnnealCoarsener::turnOnly(const Turn& t, bool better)
{
  if (t.Hexagon.size() < 6)
  {
    return false;
  }
  const std::vector<Index> quads = this->E.quadsAt(this->ring(t.Hexagon));
  Look before = this->look(quads);
  this->E.begin();
  if (!this->rotate(t) || !this->place(t.Hexagon, quads, before) ||
      (better && this->look(quads).Price > (1.0 - LeastGain) * before.Price))
  {
    this->E.rollback();
    return false;
  }
  return true;
}
} // namespace bsr::coarsening
