#pragma once

#include "Common/Types.h"

#include <map>

namespace bsr
{
/// A sparse integer linear form: coefficient of each variable.
using IntegerForm = std::map<Index, std::int64_t>;

/// a += factor * b, dropping zeros.
void addForm(IntegerForm& a, const IntegerForm& b, std::int64_t factor);

/**
 * The integer solutions of a homogeneous linear system, by unimodular substitution: every integer
 * assignment of the free variables gives one integer solution, and every one is reached.
 */
class IntegerKernel
{
public:
  explicit IntegerKernel(Index variables) : Next(variables) {}

  /// Demands that the form is zero.
  void require(IntegerForm row);
  /// Numbers the free variables; call once, after all require().
  void finish();
  Index freeVariables() const { return this->Free; }
  /// A variable in terms of the free ones. \pre finish()
  const IntegerForm& variable(Index i) const { return this->Expanded[i]; }

private:
  IntegerForm substituted(IntegerForm row) const;

  Index Next;
  Index Free = 0;
  std::map<Index, IntegerForm> Replaced; ///< in terms of variables replaced later or never
  std::vector<Index> Order;              ///< of replacement
  std::vector<IntegerForm> Expanded;
};
} // namespace bsr
