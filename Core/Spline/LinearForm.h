#pragma once

#include <algorithm>
#include <initializer_list>
#include <utility>
#include <vector>

namespace bsr
{
/// A sparse linear combination of numbered variables, sorted by number.
class LinearForm
{
public:
  using Term = std::pair<int, double>;

  LinearForm() = default;
  explicit LinearForm(int variable, double factor = 1.0) : Terms{{variable, factor}} {}

  const std::vector<Term>& terms() const { return this->Terms; }

  /// this += factor * other; terms that cancel exactly are dropped.
  LinearForm& add(const LinearForm& other, double factor = 1.0)
  {
    if (factor == 0.0 || other.Terms.empty())
    {
      return *this;
    }
    std::vector<Term> sum;
    sum.reserve(this->Terms.size() + other.Terms.size());
    auto a = this->Terms.begin();
    auto b = other.Terms.begin();
    while (a != this->Terms.end() || b != other.Terms.end())
    {
      if (b == other.Terms.end() || (a != this->Terms.end() && a->first < b->first))
      {
        sum.push_back(*a++);
      }
      else if (a == this->Terms.end() || b->first < a->first)
      {
        sum.emplace_back(b->first, factor * b->second);
        ++b;
      }
      else
      {
        const double v = a->second + factor * b->second;
        if (v != 0.0)
        {
          sum.emplace_back(a->first, v);
        }
        ++a;
        ++b;
      }
    }
    this->Terms.swap(sum);
    return *this;
  }

  LinearForm& scale(double factor)
  {
    for (Term& t : this->Terms)
    {
      t.second *= factor;
    }
    return *this;
  }

private:
  std::vector<Term> Terms;
};

/// factor_1 * form_1 + factor_2 * form_2 + ...
inline LinearForm combine(std::initializer_list<std::pair<double, const LinearForm*>> parts)
{
  LinearForm sum;
  for (const auto& p : parts)
  {
    sum.add(*p.second, p.first);
  }
  return sum;
}
} // namespace bsr
