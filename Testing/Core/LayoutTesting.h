#ifndef LayoutTesting_h
#define LayoutTesting_h

#include "Layout/QuadRemesh.h"

#include <gtest/gtest.h>

namespace bsrtest
{
/// The layout of about so many quads, by the default options; empty, with a failure, on an error.
inline bsr::QuadLayout remeshed(const bsr::TriangleMesh& mesh, int quads)
{
  bsr::QuadRemeshOptions options;
  options.NumberOfQuads = quads;
  bsr::Monitor monitor;
  auto layout = bsr::quadRemesh(mesh, options, monitor);
  EXPECT_TRUE(layout) << layout.status().message();
  return layout ? *layout : bsr::QuadLayout{};
}
} // namespace bsrtest

#endif
