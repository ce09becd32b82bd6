#include "Layout/MorseLayout.h"

#include "Common/ParallelItems.h"
#include "Layout/ParametrizedLayout.h"
#include "Layout/RelaxLayout.h"
#include "Mesh/LaplaceSpectrum.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace bsr
{
namespace
{
/// What one eigenfunction gives.
struct Candidate
{
  int Number = 0;
  double Eigenvalue = 0.0;
  std::size_t Cancelled = 0;
  int Subdivisions = 0;
  MorseCells Cells;
  LayoutDraft Draft;                                      ///< no quads: not valid
  double Guess = std::numeric_limits<double>::infinity(); ///< of the cost, before it is relaxed
  double Cost = std::numeric_limits<double>::infinity();

  int quads() const { return static_cast<int>(this->Draft.Mesh.Quads.size()); }
};

class Search
{
public:
  Search(const TriangleSurface& fine, const TriangleSurface& s, const ReferenceSurface& reference,
    const MorseOptions& options)
      : Fine(fine), S(s), Reference(reference), Options(options), Euler(s.eulerCharacteristic())
  {
  }

  /// Layouts of some functions; those of too many cells also with more cancelled.
  Status take(const std::vector<Eigenfunction>& functions, bool count, Monitor& monitor)
  {
    std::vector<std::vector<Candidate>> found(functions.size());
    const bool all = parallelItems(functions.size(), monitor,
      [&](std::size_t i, Monitor& m) { found[i] = this->layouts(functions[i], count, m); });
    for (auto& list : found)
    {
      for (Candidate& c : list)
      {
        this->Found.push_back(std::move(c));
      }
    }
    return all ? Status::ok() : Status::cancelled();
  }

  /// Relaxes the candidates that promise most; the best one first.
  Status finish(std::size_t most, Monitor& monitor)
  {
    std::stable_sort(this->Found.begin(), this->Found.end(),
      [](const Candidate& a, const Candidate& b) { return a.Guess < b.Guess; });
    this->Found.resize(std::min(most, this->Found.size()));
    const bool all = parallelItems(this->Found.size(), monitor,
      [&](std::size_t i, Monitor& m) { this->judge(this->Found[i], m); });
    std::stable_sort(this->Found.begin(), this->Found.end(),
      [](const Candidate& a, const Candidate& b) { return a.Cost < b.Cost; });
    return all ? Status::ok() : Status::cancelled();
  }

  /// The number of quads asked for is kept where there is a choice.
  double countCost(const Candidate& c) const
  {
    const double miss =
      std::abs(std::log(static_cast<double>(c.quads()) / this->Options.NumberOfQuads));
    return 300.0 * std::max(0.0, miss - 0.07);
  }

  std::vector<Candidate> Found;

private:
  std::vector<Candidate> layouts(const Eigenfunction& function, bool count, Monitor& monitor) const
  {
    const auto [low, high] = std::minmax_element(function.Values.begin(), function.Values.end());
    const double noise = this->Options.Persistence * (*high - *low);
    std::vector<double> values = function.Values;
    smoothBoundaries(this->Fine, noise, values);
    const MorseGradient gradient = morseGradient(this->Fine, std::move(values));
    if (monitor.cancelled())
    {
      return {};
    }
    const auto pairs = persistencePairs(this->Fine, gradient);
    const auto end = std::find_if(
      pairs.begin(), pairs.end(), [&](const PersistencePair& p) { return p.Persistence > noise; });
    const auto cancelled = static_cast<std::size_t>(end - pairs.begin());
    std::vector<Candidate> found;
    const auto add = [&](std::size_t n)
    {
      Candidate c;
      c.Number = function.Number;
      c.Eigenvalue = function.Eigenvalue;
      c.Cancelled = n;
      MorseGradient g = gradient;
      cancelPairs(this->Fine, pairs, n, g);
      if (!monitor.cancelled())
      {
        c.Cells = morseCells(this->Fine, g);
        if (c.Cells.Problem.empty() && !monitor.cancelled())
        {
          this->mend(c, monitor);
        }
      }
      found.push_back(std::move(c));
      return found.back().quads();
    };
    const int quads = add(cancelled);
    const int surplus = (quads - this->Options.NumberOfQuads) / 2;
    if (count && surplus > 0 && quads < 1.4 * this->Options.NumberOfQuads)
    {
      add(std::min(cancelled + surplus, pairs.size()));
    }
    return found;
  }

  /// From cells to a valid layout, if they give one.
  void mend(Candidate& c, Monitor& monitor) const
  {
    QuadGraph graph = c.Cells.Graph;
    std::vector<Vec3> points = c.Cells.Points;
    std::vector<VertexKind> kind = c.Cells.Kind;
    if (!mendGraph(graph, points, kind, monitor))
    {
      if (monitor.cancelled())
      {
        return;
      }
      subdivideGraph(graph, points, kind);
      c.Subdivisions = 1;
    }
    LayoutDraft draft = draftOf(graph, points, kind);
    const LayoutReport report = checkLayout(draft.Mesh);
    if (report.Valid && report.Euler == this->Euler)
    {
      c.Draft = std::move(draft);
      c.Guess = report.MeanAngleDeviation +
                3.3 * report.Irregular / std::sqrt(static_cast<double>(c.quads())) +
                this->countCost(c);
    }
  }

  void judge(Candidate& c, Monitor& monitor) const
  {
    if (c.quads() == 0)
    {
      return;
    }
    QuietMonitor quiet(monitor);
    const Status status = relaxLayout(c.Draft, this->Reference, 40, quiet);
    if (status)
    {
      c.Cost = layoutCost(c.Draft, checkLayout(c.Draft.Mesh), this->S, this->Reference,
        this->Options.NumberOfQuads, quiet);
    }
  }

  const TriangleSurface& Fine;
  const TriangleSurface& S;
  const ReferenceSurface& Reference;
  const MorseOptions& Options;
  int Euler;
};

/// Goes through the spectrum, first to where the complexes have as many cells as asked for, then
/// outwards from there.
class SpectrumSearch
{
public:
  SpectrumSearch(LaplaceSpectrum& spectrum, const MorseOptions& options, Search& search)
      : Spectrum(spectrum), Options(options), Found(search)
  {
  }

  Status run(Monitor& monitor)
  {
    constexpr int rounds = 5;
    constexpr int most = 9; // symmetric surfaces have but few numbers of cells
    for (int round = 0; round < rounds || (round < most && !this->met()); ++round)
    {
      if (monitor.cancelled())
      {
        return Status::cancelled();
      }
      monitor.progress(static_cast<double>(round) / (round < rounds ? rounds : most));
      auto functions = this->Spectrum.near(this->shift(this->place()), Batch, monitor);
      if (!functions)
      {
        return functions.status();
      }
      std::vector<Eigenfunction> fresh;
      for (Eigenfunction& e : *functions)
      {
        if (e.Number > 0 && this->Tried.emplace(e.Number, e.Eigenvalue).second)
        {
          fresh.push_back(std::move(e));
        }
      }
      if (Status status = this->Found.take(fresh, true, monitor); !status)
      {
        return status;
      }
    }
    return Status::ok();
  }

private:
  static constexpr int Batch = 12;

  /// Is there a layout of about as many quads as asked for?
  bool met() const
  {
    return std::any_of(this->Found.Found.begin(), this->Found.Found.end(),
      [&](const Candidate& c) { return c.quads() > 0 && this->Found.countCost(c) < 10.0; });
  }

  /// Where in the spectrum to look next.
  double place() const
  {
    const double last = 0.2 * this->Spectrum.size();
    const double aim = std::clamp(this->Options.NumberOfQuads / this->rate(), 1.0, last);
    const auto center = static_cast<int>(std::lround(aim));
    if (this->Tried.count(center) == 0)
    {
      return aim;
    }
    int up = center;
    int down = center;
    while (this->Tried.count(up) != 0)
    {
      ++up;
    }
    while (this->Tried.count(down) != 0)
    {
      --down;
    }
    const bool upwards = down < 1 || up - center <= center - down;
    return std::clamp(upwards ? up + 0.5 * Batch - 1.0 : down - 0.5 * Batch + 1.0, 1.0, last);
  }

  /// Quads a place, by what was found (1.5 before): the median.
  double rate() const
  {
    std::vector<double> rates;
    for (const Candidate& c : this->Found.Found)
    {
      const double got = c.quads() > 0 ? c.quads() : 0.9 * c.Cells.Cells;
      rates.push_back(got / c.Number);
    }
    if (rates.empty())
    {
      return 1.5;
    }
    std::nth_element(rates.begin(), rates.begin() + rates.size() / 2, rates.end());
    return std::clamp(rates[rates.size() / 2], 0.3, 4.0);
  }

  /// The eigenvalue expected at a place, from the nearest one known.
  double shift(double place) const
  {
    const auto after = this->Tried.lower_bound(static_cast<int>(place));
    if (this->Tried.empty())
    {
      return this->Spectrum.weyl(place);
    }
    const auto& known = after == this->Tried.end() ? *std::prev(after) : *after;
    return known.second * (place + 0.4) / known.first; // between places, as a rule
  }

  LaplaceSpectrum& Spectrum;
  const MorseOptions& Options;
  Search& Found;
  std::map<int, double> Tried; ///< eigenvalue of each place
};

Result<TriangleSurface> evenSurface(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, const MorseOptions& options, Monitor& monitor)
{
  const double triangles = std::max(12000.0, options.TrianglesPerCell * options.NumberOfQuads);
  const double share = triangles / options.NumberOfQuads;
  const double cell = sizing.cellFor(options.NumberOfQuads);
  const double edge = std::sqrt(4.0 / std::sqrt(3.0) / share);
  TriangleSurface fine = s;
  const auto length = [&](const Vec3& p) { return edge * sizing.side(p, cell); };
  if (Status status = remesh(fine, reference, length, 5, monitor); !status)
  {
    return status;
  }
  return fine;
}
} // namespace

Result<MorseLayout> morseLayout(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, const MorseOptions& options, Monitor& monitor)
{
  SubMonitor remeshing(monitor, 0.0, 0.3);
  auto fine = evenSurface(s, reference, sizing, options, remeshing);
  if (!fine)
  {
    return fine.status();
  }
  const double cell = sizing.cellFor(options.NumberOfQuads);
  std::vector<double> density(fine->Points.size(), 1.0);
  for (std::size_t v = 0; v < density.size(); ++v)
  {
    const double side = sizing.side(fine->Points[v], cell);
    density[v] = 1.0 / (side * side);
  }
  LaplaceSpectrum spectrum(cotangentLaplacian(*fine), density);
  Search search(*fine, s, reference, options);
  SubMonitor searching(monitor, 0.3, 0.8);
  if (options.Eigenfunction > 0)
  {
    const auto function = spectrum.at(options.Eigenfunction, searching);
    if (!function)
    {
      return function.status();
    }
    if (Status status = search.take({*function}, false, monitor); !status)
    {
      return status;
    }
  }
  else if (Status status = SpectrumSearch(spectrum, options, search).run(searching); !status)
  {
    return status;
  }
  if (Status status = search.finish(24, monitor); !status)
  {
    return status;
  }
  if (search.Found.empty() || search.Found[0].quads() == 0)
  {
    return Status::failed("No eigenfunction gave a valid layout of about " +
                          std::to_string(options.NumberOfQuads) +
                          " quads; ask for more, or take the method Field Aligned.");
  }
  Candidate& best = search.Found[0];
  MorseLayout layout;
  layout.Draft = std::move(best.Draft);
  layout.Surface = std::move(best.Cells.Surface);
  layout.Report.Eigenfunction = best.Number;
  layout.Report.Eigenvalue = best.Eigenvalue;
  layout.Report.Minima = best.Cells.Minima;
  layout.Report.Maxima = best.Cells.Maxima;
  layout.Report.Saddles = best.Cells.Saddles;
  layout.Report.Cells = best.Cells.Cells;
  layout.Report.Cancelled = static_cast<Index>(best.Cancelled);
  layout.Report.Subdivisions = best.Subdivisions;
  return layout;
}
} // namespace bsr
