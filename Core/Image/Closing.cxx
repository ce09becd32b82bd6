#include "Image/Closing.h"

#include "Common/Parallel.h"
#include "Image/ClosedDistance.h"
#include "Image/ClosingRadius.h"
#include "Image/DistanceTransform.h"
#include "Image/ScalarTypes.h"
#include "Image/Threshold.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <sstream>

namespace bsr
{
namespace
{
std::string text(double v)
{
  std::ostringstream s;
  s << v;
  return s.str();
}

Status check(const Int3& dims, const Double3& spacing, const ClosingOptions& o)
{
  for (int a = 0; a < 3; ++a)
  {
    if (dims[a] <= 0)
    {
      return Status::invalidInput("The image is empty.");
    }
    if (!(spacing[a] > 0.0) || !std::isfinite(spacing[a]))
    {
      return Status::invalidInput("The image spacing must be positive along every axis (it is " +
                                  text(spacing[0]) + ", " + text(spacing[1]) + ", " +
                                  text(spacing[2]) + ").");
    }
  }
  const double longest = *std::max_element(spacing.begin(), spacing.end());
  if (longest > 1000.0 * voxelLength(spacing))
  {
    return Status::invalidInput(
      "The spacings of the image differ by more than a factor of 1000; correct them first.");
  }
  if (!o.AutoIsoValue && !std::isfinite(o.IsoValue))
  {
    return Status::invalidParameter("The iso value must be a finite number.");
  }
  double width = 0.0;
  for (int a = 0; a < 3; ++a)
  {
    width = std::max(width, static_cast<double>(dims[a]) * spacing[a] / voxelLength(spacing));
  }
  if (!o.AutoRadius && (!(o.Radius >= 0.0) || o.Radius > width))
  {
    return Status::invalidParameter("The closing radius must lie between 0 and the image's largest "
                                    "width (" +
                                    text(width) + " voxels), but it is " + text(o.Radius) +
                                    "; choose a smaller one or Auto Radius.");
  }
  return Status::ok();
}

/// The threshold asked for or found, after a look at the values.
template <class T>
Result<double> isoValue(const ImageView<const T>& image, const ClosingOptions& o, Monitor& monitor)
{
  const ValueRange range = valueRange(image);
  if (o.AutoIsoValue || range.NotFinite > 0 || !(range.Max > range.Min))
  {
    const auto otsu = otsuThreshold(image, monitor); // also says what is wrong with such an image
    return otsu ? halfwayThreshold(image, *otsu, monitor) : otsu;
  }
  if (o.IsoValue > range.Max || o.IsoValue <= range.Min)
  {
    return Status::invalidParameter("The iso value " + text(o.IsoValue) +
                                    " is outside the image's range (" + text(range.Min) + ", " +
                                    text(range.Max) + "]: there would be " +
                                    (o.IsoValue > range.Max ? "no object" : "no background") +
                                    "; choose one inside or Auto Iso Value.");
  }
  return o.IsoValue;
}

/// The object's voxels in its bounding box.
struct Object
{
  Volume<std::uint8_t> Mask;
  std::int64_t Components = 0;
};

Volume<std::uint8_t> crop(const Volume<std::uint8_t>& mask, const Box& box)
{
  Volume<std::uint8_t> small(box, mask.Spacing);
  const auto from = mask.view();
  const auto to = small.view();
  for (std::int64_t k = 0; k < box.Size[2]; ++k)
  {
    for (std::int64_t j = 0; j < box.Size[1]; ++j)
    {
      std::memcpy(to.row(j, k), from.row(j + box.Lo[1], k + box.Lo[2]) + box.Lo[0],
        static_cast<std::size_t>(box.Size[0]));
    }
  }
  return small;
}

template <class T>
Result<Object> findObject(
  const ImageView<const T>& image, double iso, bool largest, Monitor& monitor)
{
  auto mask = thresholdMask(image, iso, monitor);
  if (!mask)
  {
    return mask.status();
  }
  Object object;
  if (largest)
  {
    const auto n = keepLargestComponent(mask->view(), Connectivity::TwentySix, monitor);
    if (!n)
    {
      return n.status();
    }
    object.Components = *n;
  }
  const Box box = boundingBox(mask->view());
  if (box.empty())
  {
    return Status::invalidInput("No voxel reaches the iso value " + text(iso) + ".");
  }
  object.Mask = crop(*mask, box);
  return object;
}

/// The image's extent, widened so that two voxels of background surround the object.
Box outputExtent(const Int3& dims, const Box& object)
{
  Box e;
  for (int a = 0; a < 3; ++a)
  {
    e.Lo[a] = std::min<std::int64_t>(0, object.Lo[a] - 2);
    e.Size[a] = std::max(dims[a], object.Lo[a] + object.Size[a] + 2) - e.Lo[a];
  }
  return e;
}

Volume<std::uint8_t> embed(const Volume<std::uint8_t>& part, const Box& extent)
{
  Volume<std::uint8_t> whole(extent, part.Spacing);
  std::fill_n(whole.Data.get(), extent.volume(), std::uint8_t{0});
  const auto from = part.view();
  const auto to = whole.view();
  for (std::int64_t k = 0; k < from.Dims[2]; ++k)
  {
    for (std::int64_t j = 0; j < from.Dims[1]; ++j)
    {
      std::memcpy(
        to.row(j + part.Extent.Lo[1] - extent.Lo[1], k + part.Extent.Lo[2] - extent.Lo[2]) +
          (part.Extent.Lo[0] - extent.Lo[0]),
        from.row(j, k), static_cast<std::size_t>(from.Dims[0]));
    }
  }
  return whole;
}

std::string describe(const BettiNumbers& b)
{
  return std::to_string(b.Components) + " component(s), " + std::to_string(b.Tunnels) +
         " tunnel(s), " + std::to_string(b.Cavities) + " cavity(ies)";
}

std::string warningFor(const ClosingOptions& o, const ClosingResult& r, const RadiusChoice& choice)
{
  std::string w;
  if (o.AutoRadius && !choice.Plateau)
  {
    w +=
      "The volume of the closing has no plateau over the radius (a solid, branching or networked "
      "object): no lumen was recognized and the radius " +
      text(r.Radius) + " was chosen by topology alone. ";
  }
  if (o.LargestComponent && !r.After.isBall())
  {
    w += std::string("The closed object is not a ball (") + describe(r.After) + ")" +
         (o.AutoRadius ? ": no radius tried makes it one; " : "; ") +
         "set another Radius if that is not wanted. ";
  }
  if (r.Surface != r.After)
  {
    w += "The zero level of SignedDistance has another topology (" + describe(r.Surface) +
         ") than Closed (" + describe(r.After) + "). ";
  }
  return w.empty() ? w : w.substr(0, w.size() - 1);
}

Result<BettiNumbers> bettiOfInside(const Volume<float>& distance, Monitor& monitor)
{
  Volume<std::uint8_t> inside(distance.Extent, distance.Spacing);
  parallelFor(0, distance.Extent.volume(), std::int64_t{1} << 16,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        inside.Data[i] = distance.Data[i] < 0.0f ? 1 : 0;
      }
    });
  return bettiNumbers(inside.view(), Connectivity::TwentySix, monitor);
}

double ones(const Volume<std::uint8_t>& v)
{
  return static_cast<double>(std::count(v.Data.get(), v.Data.get() + v.Extent.volume(), 1));
}

/// The closed voxels and their topology: a radius that was searched for brings them along.
Status closeVoxels(const Object& object, RadiusChoice& choice, double radius, Monitor& monitor)
{
  if (choice.Closed.Data)
  {
    return Status::ok();
  }
  SubMonitor ball(monitor, 0.0, 0.7);
  SubMonitor topology(monitor, 0.7, 1.0);
  auto closed = closeByBall(object.Mask.view(), radius, ball);
  if (!closed)
  {
    return closed.status();
  }
  const auto betti = bettiNumbers(closed->view(), Connectivity::TwentySix, topology);
  if (!betti)
  {
    return betti.status();
  }
  choice.Closed = std::move(*closed);
  choice.Betti = *betti;
  choice.Radius = radius;
  return Status::ok();
}

/// The signed distance for a radius that is decided.
template <class T>
Status measureDepth(const ImageView<const T>& image, const Object& object, RadiusChoice& choice,
  ClosingResult& r, Monitor& monitor)
{
  SubMonitor depth(monitor, 0.0, 0.85);
  SubMonitor rest(monitor, 0.85, 1.0);
  choice.Closed.Extent = object.Mask.Extent;
  r.After = choice.Betti;
  r.VolumeRatio = ones(choice.Closed) / ones(object.Mask);
  const Box extent = outputExtent(image.Dims, object.Mask.Extent);
  auto distance =
    closedDistance(objectField(image, r.IsoValue, object.Mask), r.Radius, extent, depth);
  if (!distance)
  {
    return distance.status();
  }
  r.Closed = embed(choice.Closed, extent);
  choice.Closed = Volume<std::uint8_t>(); // the next attempt closes anew
  r.SignedDistance = std::move(*distance);
  const auto changed = removeStrayParts(r.SignedDistance, r.Closed, rest);
  if (!changed)
  {
    return changed.status();
  }
  const auto surface = bettiOfInside(r.SignedDistance, rest);
  if (!surface)
  {
    return surface.status();
  }
  r.Surface = *surface;
  return Status::ok();
}
} // namespace

namespace
{
template <class T>
Result<ClosingResult> closeImage(
  const ImageView<const T>& image, const ClosingOptions& options, Monitor& monitor)
{
  const Status valid = check(image.Dims, image.Spacing, options);
  if (!valid)
  {
    return valid;
  }
  SubMonitor threshold(monitor, 0.0, 0.05);
  SubMonitor search(monitor, 0.05, options.AutoRadius ? 0.5 : 0.25);
  SubMonitor finish(monitor, options.AutoRadius ? 0.5 : 0.25, 1.0);
  const auto iso = isoValue(image, options, threshold);
  if (!iso)
  {
    return iso.status();
  }
  const auto object = findObject(image, *iso, options.LargestComponent, threshold);
  if (!object)
  {
    return object.status();
  }
  const auto before = bettiNumbers(object->Mask.view(), Connectivity::TwentySix, threshold);
  if (!before)
  {
    return before.status();
  }
  ClosingResult r;
  r.IsoValue = *iso;
  r.Before = *before;
  r.Components = options.LargestComponent ? object->Components : before->Components;
  r.Radius = options.Radius;
  RadiusChoice choice;
  if (options.AutoRadius)
  {
    auto found = closingRadius(object->Mask, search);
    if (!found)
    {
      return found.status();
    }
    choice = std::move(*found);
    r.Radius = choice.Radius;
  }
  // A radius at which a gap just closes may close it for voxels but not for real distances, or the
  // other way: then a little more settles it.
  for (int attempt = 0; attempt < 4; ++attempt)
  {
    Status done = closeVoxels(*object, choice, r.Radius, search);
    done = done ? measureDepth(image, *object, choice, r, finish) : done;
    if (!done)
    {
      return done;
    }
    if (!options.AutoRadius || !r.After.isBall() || r.Surface.isBall())
    {
      break;
    }
    r.Radius *= 1.05;
  }
  r.Warning = warningFor(options, r, choice);
  r.Curve = std::move(choice.Curve);
  r.Plateau = choice.Plateau;
  return r;
}
} // namespace

template <class T>
Result<ClosingResult> closing(
  const ImageView<const T>& image, const ClosingOptions& options, Monitor& monitor)
{
  try
  {
    return closeImage(image, options, monitor);
  }
  catch (const std::bad_alloc&)
  {
    return Status::failed(
      "There is not enough memory for this closing; crop the image to the object "
      "(Extract Subset), resample it, or set a smaller Radius.");
  }
}

#define BSR_INSTANTIATE(T)                                                                         \
  template Result<ClosingResult> closing<T>(                                                       \
    const ImageView<const T>&, const ClosingOptions&, Monitor&);
BSR_FOR_EACH_SCALAR_TYPE(BSR_INSTANTIATE)
#undef BSR_INSTANTIATE
} // namespace bsr
