#include "Spline/NetMixer.h"

#include <Eigen/QR>

namespace bsr
{
NetPoints NetMixer::next(const NetPoints& from, const NetPoints& to)
{
  this->Images.push_back(to);
  this->Steps.push_back(to - from);
  if (this->Images.size() > this->Depth)
  {
    this->Images.pop_front();
    this->Steps.pop_front();
  }
  const auto m = static_cast<Eigen::Index>(this->Images.size()) - 1;
  if (m == 0)
  {
    return to;
  }
  const Eigen::Map<const Eigen::VectorXd> last(this->Steps.back().data(), to.size());
  Eigen::MatrixXd changes(to.size(), m);
  for (Eigen::Index i = 0; i < m; ++i)
  {
    changes.col(i) = last - Eigen::Map<const Eigen::VectorXd>(
                              this->Steps[static_cast<std::size_t>(i)].data(), to.size());
  }
  const Eigen::VectorXd gamma = changes.colPivHouseholderQr().solve(last);
  if (!gamma.allFinite())
  {
    return to;
  }
  NetPoints net = to;
  for (Eigen::Index i = 0; i < m; ++i)
  {
    net -= gamma[i] * (to - this->Images[static_cast<std::size_t>(i)]);
  }
  return net;
}
} // namespace bsr
