#include "Layout/IntegerKernel.h"

#include <cstdlib>
#include <numeric>

namespace bsr
{
void addForm(IntegerForm& a, const IntegerForm& b, std::int64_t factor)
{
  for (const auto& [variable, coefficient] : b)
  {
    auto it = a.try_emplace(variable, 0).first;
    it->second += factor * coefficient;
    if (it->second == 0)
    {
      a.erase(it);
    }
  }
}

IntegerForm IntegerKernel::substituted(IntegerForm row) const
{
  for (bool changed = true; changed;)
  {
    changed = false;
    for (const auto& [variable, coefficient] : IntegerForm(row))
    {
      const auto it = this->Replaced.find(variable);
      if (it != this->Replaced.end() && row.count(variable))
      {
        const std::int64_t factor = row[variable];
        row.erase(variable);
        addForm(row, it->second, factor);
        changed = true;
      }
    }
  }
  return row;
}

void IntegerKernel::require(IntegerForm row)
{
  row = this->substituted(std::move(row));
  while (!row.empty())
  {
    std::int64_t common = 0;
    for (const auto& [variable, c] : row)
    {
      common = std::gcd(common, c);
    }
    Index pivot = -1;
    for (auto& [variable, c] : row)
    {
      c /= common;
      if (pivot < 0 || std::abs(c) < std::abs(row[pivot]))
      {
        pivot = variable;
      }
    }
    const std::int64_t cp = row[pivot];
    row.erase(pivot);
    IntegerForm expression;
    if (std::abs(cp) == 1)
    {
      addForm(expression, row, -cp);
      this->Replaced[pivot] = expression;
      this->Order.push_back(pivot);
      return;
    }
    // pivot = fresh - sum of quotients: the row keeps the remainders (Euclid).
    const Index fresh = this->Next++;
    expression[fresh] = 1;
    IntegerForm rest;
    for (const auto& [variable, c] : row)
    {
      const std::int64_t q = c / cp;
      if (q != 0)
      {
        expression[variable] = -q;
      }
      if (c - q * cp != 0)
      {
        rest[variable] = c - q * cp;
      }
    }
    this->Replaced[pivot] = expression;
    this->Order.push_back(pivot);
    rest[fresh] = cp;
    row = std::move(rest);
  }
}

void IntegerKernel::finish()
{
  std::vector<Index> number(this->Next, -1);
  this->Expanded.assign(this->Next, {});
  for (Index i = 0; i < this->Next; ++i)
  {
    if (!this->Replaced.count(i))
    {
      number[i] = this->Free++;
      this->Expanded[i][number[i]] = 1;
    }
  }
  // Those replaced last depend on free variables only.
  for (auto it = this->Order.rbegin(); it != this->Order.rend(); ++it)
  {
    for (const auto& [variable, coefficient] : this->Replaced[*it])
    {
      addForm(this->Expanded[*it], this->Expanded[variable], coefficient);
    }
  }
}
} // namespace bsr
