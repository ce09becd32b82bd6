#pragma once

#include "Image/HugePages.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

namespace bsr
{
using Int3 = std::array<std::int64_t, 3>;
using Double3 = std::array<double, 3>;

/**
 * A regular volume that somebody else owns: x runs fastest, then y, then z. `Spacing` is the
 * distance of neighboring voxels along each axis in world units (only ratios matter where lengths
 * are in "voxels": multiples of the smallest spacing).
 */
template <class T>
struct ImageView
{
  T* Data = nullptr;
  Int3 Dims{{0, 0, 0}};
  Double3 Spacing{{1.0, 1.0, 1.0}};

  std::int64_t size() const { return this->Dims[0] * this->Dims[1] * this->Dims[2]; }
  std::int64_t index(std::int64_t i, std::int64_t j, std::int64_t k) const
  {
    return i + this->Dims[0] * (j + this->Dims[1] * k);
  }
  T* row(std::int64_t j, std::int64_t k) const { return this->Data + this->index(0, j, k); }
  T& operator()(std::int64_t i, std::int64_t j, std::int64_t k) const
  {
    return this->Data[this->index(i, j, k)];
  }
  operator ImageView<const T>() const { return {this->Data, this->Dims, this->Spacing}; }
};

/// A box of voxels: the first index and the number of voxels along each axis.
struct Box
{
  Int3 Lo{{0, 0, 0}};
  Int3 Size{{0, 0, 0}};

  bool empty() const { return this->Size[0] <= 0 || this->Size[1] <= 0 || this->Size[2] <= 0; }
  std::int64_t volume() const
  {
    return this->empty() ? 0 : this->Size[0] * this->Size[1] * this->Size[2];
  }
  bool contains(const Int3& p) const
  {
    for (int a = 0; a < 3; ++a)
    {
      if (p[a] < this->Lo[a] || p[a] >= this->Lo[a] + this->Size[a])
      {
        return false;
      }
    }
    return true;
  }
  Box padded(const Int3& by) const
  {
    Box b = *this;
    for (int a = 0; a < 3; ++a)
    {
      b.Lo[a] -= by[a];
      b.Size[a] += 2 * by[a];
    }
    return b;
  }
};

/**
 * A volume that owns its memory, which is not initialized. `Extent` says which voxels of the image
 * it was made from it holds (indices may be negative or lie beyond the image: padding).
 */
template <class T>
struct Volume
{
  Volume() = default;
  Volume(const Box& extent, const Double3& spacing)
      : Extent(extent), Spacing(spacing), Data(new T[static_cast<std::size_t>(extent.volume())])
  {
    adviseHugePages(this->Data.get(), static_cast<std::size_t>(extent.volume()) * sizeof(T));
  }
  ImageView<T> view() { return {this->Data.get(), this->Extent.Size, this->Spacing}; }
  ImageView<const T> view() const { return {this->Data.get(), this->Extent.Size, this->Spacing}; }

  Box Extent;
  Double3 Spacing{{1.0, 1.0, 1.0}};
  std::unique_ptr<T[]> Data;
};

/// The smallest spacing: the length of one "voxel".
inline double voxelLength(const Double3& spacing)
{
  return spacing[0] < spacing[1] ? (spacing[0] < spacing[2] ? spacing[0] : spacing[2])
                                 : (spacing[1] < spacing[2] ? spacing[1] : spacing[2]);
}

/// Number of voxels along each axis that a length of `radius` voxels (smallest spacing) covers.
inline Int3 reach(double radius, const Double3& spacing)
{
  const double unit = voxelLength(spacing);
  Int3 n{};
  for (int a = 0; a < 3; ++a)
  {
    n[a] = static_cast<std::int64_t>(radius * unit / spacing[a] * (1.0 + 1e-6));
  }
  return n;
}
} // namespace bsr
