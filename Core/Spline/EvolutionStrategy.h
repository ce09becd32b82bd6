#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace bsr
{
/// Settings of the evolution strategy of paper 003, section 5.1.
struct EvolutionOptions
{
  int Parents = 10;      ///< gamma, individuals that survive, at least 2
  int Offspring = 50;    ///< mu, descendants a generation, at least 1
  int Generations = 100; ///< at most
  double Low = 0.01;     ///< initial variables and step sizes are uniform in [Low, High]
  double High = 1.0;
  double Tolerance = 0.0; ///< delta: stops when the best fitness is below it (eq. 2)
  int Patience = 12;      ///< generations without a gain of 1e-4 of the best, then it stops
  std::uint64_t Seed = 0; ///< the same seed and stream give the same run
  std::uint64_t Stream = 0;
};

struct EvolutionResult
{
  Eigen::VectorXd Best;
  double Fitness = 0.0;        ///< of Best; infinite where no feasible individual was found
  std::vector<double> History; ///< best fitness of the first population and after each generation
  std::int64_t Evaluations = 0;
};

/**
 * Minimizes a function of positive variables by a (gamma + mu) evolution strategy (paper 003,
 * section 5.1): an individual has n variables and n step sizes, both at first uniform in
 * [Low, High]. Each descendant gets its variables by global intermediate recombination (eq. 4: the
 * mean of the parents) and its step sizes by local intermediate recombination of two parents drawn
 * for it (eq. 5), then the uncorrelated mutation of eq. 3 with c0 = 1 / sqrt(2 n) and
 * ci = 1 / sqrt(2 sqrt(n)). The best gamma of parents and descendants together survive.
 * Infeasible individuals (a variable not positive, or a fitness that is not finite) are filtered.
 * The function is called from the calling thread only.
 */
EvolutionResult evolve(int variables, const std::function<double(const Eigen::VectorXd&)>& fitness,
  const EvolutionOptions& options);
} // namespace bsr
