#pragma once

#include "Common/MonitoredLoop.h"
#include "Image/ImageView.h"
#include "Image/LineEnvelope.h"

#include <vector>

namespace bsr
{
/// A buffer of lines along x, y and z; strides in elements, x has 1.
struct LineBuffer
{
  float* Data = nullptr;
  std::int64_t Width = 0; ///< elements along x
  std::int64_t StrideY = 0;
  std::int64_t StrideZ = 0;
};

/**
 * Applies make()'s line function (const float* in, float* out) to all lines along y (axis 1) or
 * z (axis 2): `inputs` values of a line are read from `source`, `outputs` written to the start of
 * the same line of `target` (the same buffer, or one with other strides). `others` is the number of
 * rows along the third axis. Lines are taken in blocks of neighbors along x, through a transposed
 * local tile, so that memory is read and written in whole cache lines.
 */
template <class Make>
bool linePass(const LineBuffer& source, const LineBuffer& target, int axis, std::int64_t others,
  std::int64_t inputs, std::int64_t outputs, Monitor& monitor, const Make& make)
{
  constexpr std::int64_t BlockWidth = 16;
  const auto stride = [axis](const LineBuffer& b) { return axis == 1 ? b.StrideY : b.StrideZ; };
  const auto otherStride = [axis](const LineBuffer& b)
  { return axis == 1 ? b.StrideZ : b.StrideY; };
  const std::int64_t blocks = (source.Width + BlockWidth - 1) / BlockWidth;
  const std::int64_t inPitch = inputs + 16;
  const std::int64_t outPitch = outputs + 16;
  return monitoredFor(0, others * blocks, 4, monitor,
    [&](std::int64_t begin, std::int64_t end)
    {
      std::vector<float> in(static_cast<std::size_t>(BlockWidth * inPitch));
      std::vector<float> out(static_cast<std::size_t>(BlockWidth * outPitch));
      auto line = make();
      for (std::int64_t task = begin; task < end; ++task)
      {
        const std::int64_t x = (task % blocks) * BlockWidth;
        const std::int64_t other = task / blocks;
        const std::int64_t width = std::min(BlockWidth, source.Width - x);
        const float* const from = source.Data + other * otherStride(source) + x;
        for (std::int64_t i = 0; i < inputs; ++i)
        {
          for (std::int64_t b = 0; b < width; ++b)
          {
            in[b * inPitch + i] = from[i * stride(source) + b];
          }
        }
        for (std::int64_t b = 0; b < width; ++b)
        {
          line(in.data() + b * inPitch, out.data() + b * outPitch);
        }
        float* const to = target.Data + other * otherStride(target) + x;
        for (std::int64_t i = 0; i < outputs; ++i)
        {
          for (std::int64_t b = 0; b < width; ++b)
          {
            to[i * stride(target) + b] = out[b * outPitch + i];
          }
        }
      }
    });
}

/// The same along x: every row (y, z) with y < rows, z < slices.
template <class Make>
bool rowPass(const LineBuffer& source, const LineBuffer& target, std::int64_t rows,
  std::int64_t slices, std::int64_t inputs, std::int64_t outputs, Monitor& monitor,
  const Make& make)
{
  return monitoredFor(0, rows * slices, 16, monitor,
    [&](std::int64_t begin, std::int64_t end)
    {
      std::vector<float> in(static_cast<std::size_t>(inputs));
      std::vector<float> out(static_cast<std::size_t>(outputs));
      auto line = make();
      for (std::int64_t r = begin; r < end; ++r)
      {
        const std::int64_t y = r % rows;
        const std::int64_t z = r / rows;
        const float* const from = source.Data + y * source.StrideY + z * source.StrideZ;
        std::copy(from, from + inputs, in.begin());
        line(in.data(), out.data());
        std::copy(out.begin(), out.end(), target.Data + y * target.StrideY + z * target.StrideZ);
      }
    });
}
} // namespace bsr
