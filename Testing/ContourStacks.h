#ifndef ContourStacks_h
#define ContourStacks_h

#include "Common/CounterRandom.h"
#include "Contour/ContourStack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// Stacks of contours for tests: the objects of paper 004 and seeded random branching bodies.
namespace bsrtest
{
using bsr::Polyline;
using bsr::Vec2;
using bsr::Vec3;

constexpr double Tau = 6.283185307179586;

/// A closed polyline of n points on the ellipse with the given half axes (first point repeated).
inline Polyline ellipseAt(const Vec3& center, double a, double b, int n = 48)
{
  Polyline line;
  for (int i = 0; i <= n; ++i)
  {
    const double t = Tau * (i % n) / n;
    line.Points.push_back(center + Vec3(a * std::cos(t), b * std::sin(t), 0.0));
  }
  return line;
}

/// A closed rectangle of full widths a and b with n points a side (first point repeated).
inline Polyline rectangleAt(const Vec3& center, double a, double b, int n = 12)
{
  const Vec2 corner[5] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
  Polyline line;
  for (int i = 0; i <= 4 * n; ++i)
  {
    const int side = i / n % 4;
    const double t = static_cast<double>(i % n) / n;
    const Vec2 p = (1.0 - t) * corner[side] + t * corner[side + 1];
    line.Points.push_back(center + 0.5 * Vec3(a * p.x(), b * p.y(), 0.0));
  }
  return line;
}

/// An object of paper 004, "circles" or "rectangles": 14 slices 0.2 or 0.5 apart, two legs in the
/// lower 7, as Examples/objects.csv has them (half widths a and b; the paper gives no other sizes).
inline std::vector<Polyline> objectOfThePaper(const std::string& name)
{
  std::ifstream file("Examples/objects.csv"); // tests run in the source folder
  std::vector<Polyline> lines;
  std::string row;
  while (std::getline(file, row))
  {
    std::replace(row.begin(), row.end(), ',', ' ');
    std::istringstream words(row);
    std::string object;
    std::string shape;
    Vec3 center = Vec3::Zero();
    double a = 0.0;
    double b = 0.0;
    int points = 0;
    words >> object >> shape >> center.x() >> center.z() >> a >> b >> points;
    if (object == name)
    {
      lines.push_back(shape == "ellipse" ? ellipseAt(center, a, b, points)
                                         : rectangleAt(center, 2.0 * a, 2.0 * b, points / 4));
    }
  }
  return lines;
}

inline std::vector<Polyline> rectangleBasedObject()
{
  return objectOfThePaper("rectangles");
}

inline std::vector<Polyline> circleBasedObject()
{
  return objectOfThePaper("circles");
}

/// A branch of a body: a tube about an axis that moves with height.
struct BodyBranch
{
  double From, To;    ///< heights between which it exists
  Vec2 Start, End;    ///< centers there
  double StartRadius; ///< at From; a radius that falls to 0 is a rounded end
  double EndRadius;
  double Phase; ///< of its out-of-roundness
};

/// How much a point is inside (positive) the smooth union of branches, in radii.
inline double insideBody(const std::vector<BodyBranch>& branches, const Vec3& p)
{
  double sum = 0.0;
  for (const BodyBranch& b : branches)
  {
    const double t = (p.z() - b.From) / (b.To - b.From);
    if (t < 0.0 || t > 1.0)
    {
      continue;
    }
    const Vec2 d = p.head<2>() - ((1.0 - t) * b.Start + t * b.End);
    const double r = (1.0 - t) * b.StartRadius + t * b.EndRadius;
    const double round = 1.0 + 0.12 * std::cos(2.0 * std::atan2(d.y(), d.x()) + b.Phase);
    sum += r > 0.0 ? std::exp(8.0 * (1.0 - d.norm() / (r * round))) : 0.0;
  }
  return sum > 0.0 ? std::log(sum) / 8.0 : -1e3;
}

/// Closed zero lines of a function on the square [-size, size]^2 (marching squares).
inline std::vector<std::vector<Vec2>> zeroLines(
  const std::function<double(const Vec2&)>& f, double size, int cells)
{
  const int n = cells + 1;
  const double h = 2.0 * size / cells;
  std::vector<double> value;
  for (int k = 0; k < n * n; ++k)
  {
    value.push_back(f(Vec2(-size + h * (k % n), -size + h * (k / n))));
    value.back() += value.back() == 0.0 ? 1e-12 : 0.0;
  }
  const auto crossing = [&](int a, int b)
  {
    const double t = value[a] / (value[a] - value[b]);
    const Vec2 pa(a % n, a / n);
    const Vec2 pb(b % n, b / n);
    return Vec2(Vec2(-size, -size) + h * ((1.0 - t) * pa + t * pb));
  };
  using Edge = std::pair<int, int>;
  std::map<Edge, Edge> next; // inside on the left
  for (int j = 0; j < cells; ++j)
  {
    for (int i = 0; i < cells; ++i)
    {
      const int c[4] = {j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i};
      const double mid = value[c[0]] + value[c[1]] + value[c[2]] + value[c[3]];
      std::vector<int> out; // sides where the boundary leaves the inside
      std::vector<int> in;
      for (int s = 0; s < 4; ++s)
      {
        const bool a = value[c[s]] > 0.0;
        const bool b = value[c[(s + 1) % 4]] > 0.0;
        if (a != b)
        {
          (a ? out : in).push_back(s);
        }
      }
      const auto key = [&](int s)
      {
        const int a = c[s];
        const int b = c[(s + 1) % 4];
        return Edge(std::min(a, b), std::max(a, b));
      };
      for (std::size_t k = 0; k < out.size(); ++k)
      {
        // from the side where the inside ends to the one where it starts again
        std::size_t m = 0;
        if (out.size() == 2)
        {
          const int want = mid > 0.0 ? (out[k] + 1) % 4 : (out[k] + 3) % 4;
          m = in[0] == want ? 0 : 1;
        }
        next[key(out[k])] = key(in[m]);
      }
    }
  }
  std::vector<std::vector<Vec2>> lines;
  while (!next.empty())
  {
    std::vector<Vec2> line;
    Edge at = next.begin()->first;
    for (auto e = next.find(at); e != next.end(); e = next.find(at))
    {
      line.push_back(crossing(e->first.first, e->first.second));
      at = e->second;
      next.erase(e);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

enum class StackKind
{
  Tube,       ///< one contour a slice
  OneToTwo,   ///< a trunk above, two legs below
  OneToThree, ///<
  TwoToOne,   ///< two legs above, a trunk below
  OneTwoFour, ///< two levels of branching
  Vanishing,  ///< legs of different length with rounded ends
  Nested,     ///< a canal inside a trunk with two legs
  TwoOneTwo,  ///< legs below and above
  OneTwoOne,  ///< a handle: splits and merges again
  Count
};

struct RandomStack
{
  StackKind Kind = StackKind::Tube;
  std::vector<Polyline> Lines;
  std::string Name; ///< for messages
};

/// The branches of a kind within heights 0 to 10; those of the canal are in the second list.
inline std::array<std::vector<BodyBranch>, 2> bodyOf(StackKind kind, bsr::CounterRandom& random)
{
  std::vector<BodyBranch> body;
  std::vector<BodyBranch> canal;
  const auto jitter = [&] { return 1.0 + 0.15 * random.uniform(-1.0, 1.0); };
  const double turn = random.uniform(0.0, Tau);
  const auto away = [&](double angle, double r)
  { return Vec2(r * jitter() * std::cos(angle + turn), r * jitter() * std::sin(angle + turn)); };
  const auto add = [&](double from, double to, const Vec2& a, const Vec2& b, double ra, double rb) {
    body.push_back({from, to, a, b, ra * jitter(), rb * jitter(), random.uniform(0.0, Tau)});
  };
  const Vec2 zero = Vec2::Zero();
  const double low = kind == StackKind::Tube ? 0.0 : random.uniform(4.0, 6.0);
  if (kind != StackKind::OneTwoOne)
  {
    const double high = kind == StackKind::TwoOneTwo ? low + 2.0 : 10.0;
    const Vec2 top = away(0.0, 0.5);
    const double wide = 2.2 * jitter();
    body.push_back({low, high, zero, top, wide, 2.5 * jitter(), random.uniform(0.0, Tau)});
    if (kind != StackKind::Tube) // rounded where the legs part
    {
      body.push_back({low - 1.2, low, zero, zero, 0.3 * wide, wide, body[0].Phase});
    }
    if (kind == StackKind::TwoOneTwo)
    {
      body.push_back({high, high + 1.2, top, top, body[0].EndRadius, 0.6, body[0].Phase});
    }
  }
  const int legs = kind == StackKind::OneToThree ? 3 : kind == StackKind::Tube ? 0 : 2;
  for (int l = 0; l < legs; ++l)
  {
    const double angle = Tau * l / legs;
    if (kind == StackKind::OneTwoOne)
    {
      add(0.0, 3.0, zero, zero, 2.5, 2.2);
      add(2.5, 5.0, away(angle, 1.2), away(angle, 2.6), 1.4, 1.2);
      add(5.0, 7.5, away(angle, 2.6), away(angle, 1.2), 1.2, 1.4);
      add(7.0, 10.0, zero, zero, 2.2, 2.5);
      continue;
    }
    const bool stops = kind == StackKind::Vanishing && l == 1;
    if (kind == StackKind::OneTwoFour)
    {
      const Vec2 knee = away(angle, 2.4);
      add(3.0, low + 0.8, knee, away(angle, 1.3), 1.5, 1.5);
      for (const double side : {-1.0, 1.0})
      {
        const Vec2 off(-side * std::sin(angle + turn), side * std::cos(angle + turn));
        add(0.0, 3.6, knee + 1.9 * jitter() * off, knee + 0.6 * off, 0.9, 1.1);
      }
      continue;
    }
    add(stops ? low - 2.6 : 0.0, low + 0.8, away(angle, 2.7), away(angle, 1.2),
      kind == StackKind::Vanishing ? 0.35 : 1.2, 1.4);
    if (kind == StackKind::TwoOneTwo)
    {
      add(low + 1.2, 10.0, away(angle + 0.7, 1.2), away(angle + 0.7, 2.8), 1.4, 1.2);
    }
  }
  if (kind == StackKind::Nested)
  {
    canal.push_back({random.uniform(low + 1.0, 6.8), 10.0, zero, Vec2(0.2, 0.1), 0.7, 1.0, turn});
  }
  return {body, canal};
}

/// Stack number `seed` of an endless series: kind seed % Count; tilted, uneven, noisy, oblique by
/// chance. Every slice is cut from one solid, so contours neither cross nor jump.
inline RandomStack randomStack(int seed)
{
  bsr::CounterRandom random(static_cast<std::uint64_t>(seed), 17);
  RandomStack stack;
  stack.Kind = static_cast<StackKind>(seed % static_cast<int>(StackKind::Count));
  const auto [body, canal] = bodyOf(stack.Kind, random);
  const bool tilted = random.uniform() < 0.3;
  const bool uneven = random.uniform() < 0.4;
  const bool noisy = random.uniform() < 0.4;
  const bool clockwise = random.uniform() < 0.5;
  const int slices = 14 + random.below(10);
  const double flip = stack.Kind == StackKind::TwoToOne ? -1.0 : 1.0;
  const Eigen::AngleAxisd oblique(random.uniform(0.0, 3.0),
    Vec3(random.normal(), random.normal(), random.normal() + 4.0).normalized());
  for (int s = 0; s < slices; ++s)
  {
    const double z = 10.0 * (s + 0.5 + (uneven ? 0.3 * random.uniform(-1.0, 1.0) : 0.0)) / slices;
    const Eigen::AngleAxisd tilt(tilted ? 0.5 / slices * random.uniform(-1.0, 1.0) : 0.0,
      Vec3(std::cos(1.7 * s), std::sin(1.7 * s), 0.0));
    const auto place = [&](const Vec2& p)
    { return Vec3(tilt * Vec3(p.x(), p.y(), 0.0) + Vec3(0.0, 0.0, z)); };
    const auto solid = [&, &body = body, &canal = canal](const Vec2& p)
    {
      const double out = insideBody(body, place(p));
      return canal.empty() ? out : std::min(out, -insideBody(canal, place(p)));
    };
    for (const auto& flat : zeroLines(solid, 6.4, 64))
    {
      Polyline line;
      line.Closed = true;
      const double apart = random.uniform(0.12, 0.25); // no points closer than this
      Vec2 last = flat.back();
      for (const Vec2& q : flat)
      {
        if ((q - last).norm() < apart || (q - flat.back()).norm() < apart)
        {
          continue;
        }
        last = q;
        const double n = noisy ? 0.012 : 0.0;
        Vec3 p = place(q + n * Vec2(random.normal(), random.normal()));
        p.z() *= flip;
        line.Points.push_back(oblique * p);
      }
      if (clockwise)
      {
        std::reverse(line.Points.begin(), line.Points.end());
      }
      if (line.Points.size() > 2)
      {
        stack.Lines.push_back(std::move(line));
      }
    }
  }
  static const char* names[] = {
    "tube", "1-2", "1-3", "2-1", "1-2-4", "vanishing", "nested", "2-1-2", "1-2-1"};
  stack.Name = "seed " + std::to_string(seed) + " " +
               names[seed % static_cast<int>(StackKind::Count)] + (tilted ? " tilted" : "") +
               (uneven ? " uneven" : "") + (noisy ? " noisy" : "");
  return stack;
}
} // namespace bsrtest

#endif
