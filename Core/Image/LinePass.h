#pragma once

#include "Image/ImageView.h"
#include "Image/LineEnvelope.h"
#include "Image/MonitoredLoop.h"

#include <vector>

namespace bsr
{
/// A buffer in which lines along y and z are transformed in place; strides in elements, x has 1.
struct LineBuffer
{
  float* Data = nullptr;
  std::int64_t Width = 0; ///< elements along x
  std::int64_t StrideY = 0;
  std::int64_t StrideZ = 0;
};

/**
 * Applies make()'s line function (const float* in, float* out) to all lines along y (axis 1) or
 * z (axis 2) of a buffer: `inputs` values of the line are read, `outputs` written from its start.
 * Lines are taken in blocks of neighbors along x, through a transposed local tile, so that memory
 * is read and written in whole cache lines. `others` is the number of rows along the third axis.
 */
template <class Make>
bool linePass(const LineBuffer& buffer, int axis, std::int64_t others, std::int64_t inputs,
  std::int64_t outputs, Monitor& monitor, const Make& make)
{
  constexpr std::int64_t BlockWidth = 16;
  const std::int64_t stride = axis == 1 ? buffer.StrideY : buffer.StrideZ;
  const std::int64_t otherStride = axis == 1 ? buffer.StrideZ : buffer.StrideY;
  const std::int64_t blocks = (buffer.Width + BlockWidth - 1) / BlockWidth;
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
        const std::int64_t width = std::min(BlockWidth, buffer.Width - x);
        float* const base = buffer.Data + (task / blocks) * otherStride + x;
        for (std::int64_t i = 0; i < inputs; ++i)
        {
          const float* const src = base + i * stride;
          for (std::int64_t b = 0; b < width; ++b)
          {
            in[b * inPitch + i] = src[b];
          }
        }
        for (std::int64_t b = 0; b < width; ++b)
        {
          line(in.data() + b * inPitch, out.data() + b * outPitch);
        }
        for (std::int64_t i = 0; i < outputs; ++i)
        {
          float* const dst = base + i * stride;
          for (std::int64_t b = 0; b < width; ++b)
          {
            dst[b] = out[b * outPitch + i];
          }
        }
      }
    });
}
} // namespace bsr
