#include "Spline/EvolutionStrategy.h"

#include "Common/CounterRandom.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr int Attempts = 20; ///< draws until an individual is feasible

struct Individual
{
  Eigen::VectorXd Variables;
  Eigen::VectorXd Steps;
  double Fitness = std::numeric_limits<double>::infinity();
};

bool fitter(const Individual& a, const Individual& b)
{
  return a.Fitness < b.Fitness;
}

class Strategy
{
public:
  Strategy(int variables, const std::function<double(const Eigen::VectorXd&)>& fitness,
    const EvolutionOptions& options)
      : Count(variables),
        Fitness(fitness),
        Options(options),
        Random(options.Seed, options.Stream),
        CommonRate(1.0 / std::sqrt(2.0 * variables)),
        OwnRate(1.0 / std::sqrt(2.0 * std::sqrt(static_cast<double>(variables))))
  {
  }

  EvolutionResult run()
  {
    for (int i = 0; i < this->Options.Parents; ++i)
    {
      this->Population.push_back(this->feasible([this] { return this->newborn(); }));
    }
    std::stable_sort(this->Population.begin(), this->Population.end(), fitter);
    this->record();
    int idle = 0;
    for (int g = 0; g < this->Options.Generations && idle < this->Options.Patience; ++g)
    {
      const double before = this->Population.front().Fitness;
      if (before < this->Options.Tolerance)
      {
        break;
      }
      this->generation();
      this->record();
      idle = this->Population.front().Fitness < (1.0 - 1e-4) * before ? 0 : idle + 1;
    }
    this->Out.Best = this->Population.front().Variables;
    this->Out.Fitness = this->Population.front().Fitness;
    return std::move(this->Out);
  }

private:
  template <class Make>
  Individual feasible(const Make& make)
  {
    Individual last;
    for (int i = 0; i < Attempts && !std::isfinite(last.Fitness); ++i)
    {
      last = make();
      if (last.Variables.minCoeff() > 0.0)
      {
        const double f = this->Fitness(last.Variables);
        last.Fitness = std::isfinite(f) ? f : std::numeric_limits<double>::infinity();
        ++this->Out.Evaluations;
      }
    }
    return last;
  }

  Individual newborn()
  {
    Individual one{Eigen::VectorXd(this->Count), Eigen::VectorXd(this->Count)};
    for (int i = 0; i < this->Count; ++i)
    {
      one.Variables[i] = this->Random.uniform(this->Options.Low, this->Options.High);
      one.Steps[i] = this->Random.uniform(this->Options.Low, this->Options.High);
    }
    return one;
  }

  Individual descendant(const Eigen::VectorXd& mean)
  {
    const Individual& a = this->Population[this->Random.below(this->Options.Parents)];
    const Individual& b = this->Population[this->Random.below(this->Options.Parents)];
    const double common = this->CommonRate * this->Random.normal();
    Individual child{mean, Eigen::VectorXd(this->Count)};
    for (int i = 0; i < this->Count; ++i)
    {
      const double u = this->Random.uniform();
      const double step = u * a.Steps[i] + (1.0 - u) * b.Steps[i];
      child.Steps[i] = step * std::exp(common + this->OwnRate * this->Random.normal());
      child.Variables[i] += child.Steps[i] * this->Random.normal();
    }
    return child;
  }

  void generation()
  {
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(this->Count);
    for (const Individual& p : this->Population)
    {
      mean += p.Variables / this->Options.Parents;
    }
    std::vector<Individual> children;
    children.reserve(this->Options.Offspring);
    for (int i = 0; i < this->Options.Offspring; ++i)
    {
      children.push_back(this->feasible([&] { return this->descendant(mean); }));
    }
    this->Population.insert(this->Population.end(), children.begin(), children.end());
    std::stable_sort(this->Population.begin(), this->Population.end(), fitter);
    this->Population.resize(this->Options.Parents);
  }

  void record() { this->Out.History.push_back(this->Population.front().Fitness); }

  int Count;
  const std::function<double(const Eigen::VectorXd&)>& Fitness;
  const EvolutionOptions& Options;
  CounterRandom Random;
  double CommonRate;
  double OwnRate;
  std::vector<Individual> Population;
  EvolutionResult Out;
};
} // namespace

EvolutionResult evolve(int variables, const std::function<double(const Eigen::VectorXd&)>& fitness,
  const EvolutionOptions& options)
{
  EvolutionOptions o = options;
  o.Parents = std::max(2, o.Parents);
  o.Offspring = std::max(1, o.Offspring);
  return Strategy(variables, fitness, o).run();
}
} // namespace bsr
