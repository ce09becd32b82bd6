#include "Layout/CleanLayout.h"

#include <algorithm>

namespace bsr
{
namespace
{
using Quad = std::array<Index, 4>;

class Cleaner
{
public:
  explicit Cleaner(LayoutDraft& draft) : D(draft), Quads(draft.Mesh.Quads) {}

  void run()
  {
    for (int pass = 0; pass < 50; ++pass)
    {
      this->index();
      const bool zipped = this->closeZips();
      this->index();
      if (!this->mergeDoublets() && !zipped)
      {
        break;
      }
    }
    this->drop();
  }

private:
  void index()
  {
    this->Around.assign(this->D.Mesh.Points.size(), {});
    for (std::size_t q = 0; q < this->Quads.size(); ++q)
    {
      for (Index v : this->Quads[q])
      {
        if (v >= 0)
        {
          this->Around[v].push_back(static_cast<Index>(q));
        }
      }
    }
  }

  static bool dead(const Quad& q) { return q[0] < 0; }

  /// Removes quads (a, b, a, c): their sides fall together in pairs.
  bool closeZips()
  {
    bool any = false;
    for (Quad& q : this->Quads)
    {
      if (!dead(q) && (q[0] == q[2] || q[1] == q[3]))
      {
        q.fill(-1);
        any = true;
      }
    }
    return any;
  }

  /// Corner k of quad q is v.
  static int corner(const Quad& q, Index v)
  {
    return static_cast<int>(std::find(q.begin(), q.end(), v) - q.begin());
  }

  bool mergeDoublets()
  {
    bool any = false;
    for (std::size_t i = 0; i < this->Around.size(); ++i)
    {
      const auto v = static_cast<Index>(i);
      const auto& list = this->Around[i];
      if (list.size() != 2 || list[0] == list[1] || this->D.Kind[i] != VertexKind::Free)
      {
        continue;
      }
      Quad& p = this->Quads[list[0]];
      Quad& q = this->Quads[list[1]];
      if (dead(p) || dead(q) || corner(p, v) == 4 || corner(q, v) == 4)
      {
        continue;
      }
      const int kp = corner(p, v);
      const int kq = corner(q, v);
      // p = (v, a, c, b) and q = (v, b, d, a) become (a, c, b, d).
      const Index a = p[(kp + 1) % 4];
      const Index b = p[(kp + 3) % 4];
      if (q[(kq + 1) % 4] != b || q[(kq + 3) % 4] != a)
      {
        continue;
      }
      p = {a, p[(kp + 2) % 4], b, q[(kq + 2) % 4]};
      q.fill(-1);
      any = true;
      // Quads around the other corners changed: they wait for the next pass.
      for (Index w : p)
      {
        this->Around[w].clear();
      }
    }
    return any;
  }

  void drop()
  {
    std::vector<Index> number(this->D.Mesh.Points.size(), -1);
    LayoutDraft out;
    for (std::size_t q = 0; q < this->Quads.size(); ++q)
    {
      if (dead(this->Quads[q]))
      {
        continue;
      }
      Quad quad = this->Quads[q];
      for (Index& v : quad)
      {
        if (number[v] < 0)
        {
          number[v] = static_cast<Index>(out.Mesh.Points.size());
          out.Mesh.Points.push_back(this->D.Mesh.Points[v]);
          out.Kind.push_back(this->D.Kind[v]);
        }
        v = number[v];
      }
      out.Mesh.Quads.push_back(quad);
      out.Mesh.Region.push_back(this->D.Mesh.Region[q]);
    }
    for (const auto& c : this->D.Creases)
    {
      const Index a = number[c[0]];
      const Index b = number[c[1]];
      if (a >= 0 && b >= 0)
      {
        out.Creases.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    this->D = std::move(out);
    this->D.completeCreases();
  }

  LayoutDraft& D;
  std::vector<Quad>& Quads;
  std::vector<std::vector<Index>> Around;
};
} // namespace

void cleanLayout(LayoutDraft& draft)
{
  Cleaner(draft).run();
}
} // namespace bsr
