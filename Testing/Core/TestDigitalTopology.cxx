#include "ImageTestHelpers.h"

#include "Image/DigitalTopology.h"

#include <gtest/gtest.h>

using namespace bsrtest;
using bsr::Connectivity;

namespace
{
bsr::BettiNumbers betti(const bsr::Volume<std::uint8_t>& v, Connectivity c)
{
  bsr::Monitor monitor;
  const auto b = bsr::bettiNumbers(v.view(), c, monitor);
  EXPECT_TRUE(b) << b.status().message();
  return *b;
}

void expectBetti(const bsr::Volume<std::uint8_t>& v, Connectivity c, int b0, int b1, int b2)
{
  const auto b = betti(v, c);
  EXPECT_EQ(b.Components, b0);
  EXPECT_EQ(b.Tunnels, b1);
  EXPECT_EQ(b.Cavities, b2);
}

bsr::Volume<std::uint8_t> drawing(const std::vector<std::vector<const char*>>& slices)
{
  const auto nz = static_cast<std::int64_t>(slices.size());
  const auto ny = static_cast<std::int64_t>(slices[0].size());
  const auto nx = static_cast<std::int64_t>(std::strlen(slices[0][0]));
  return makeVolume<std::uint8_t>({{nx, ny, nz}}, {{1.0, 1.0, 1.0}},
    [&](const bsr::Int3& p) { return slices[p[2]][p[1]][p[0]] == '#' ? 1 : 0; });
}

/// Components of a small image by flooding: an independent count.
int floodCount(const bsr::Volume<std::uint8_t>& v, bool foreground, bool all)
{
  const bsr::Int3 n = v.Extent.Size;
  std::vector<char> seen(static_cast<std::size_t>(v.Extent.volume()), 0);
  int count = 0;
  forEachVoxel(n,
    [&](const bsr::Int3& start)
    {
      const auto index = [&](const bsr::Int3& p) { return p[0] + n[0] * (p[1] + n[1] * p[2]); };
      if (seen[index(start)] || (v.Data[index(start)] != 0) != foreground)
      {
        return;
      }
      ++count;
      std::vector<bsr::Int3> stack{start};
      seen[index(start)] = 1;
      while (!stack.empty())
      {
        const bsr::Int3 p = stack.back();
        stack.pop_back();
        forEachVoxel({{3, 3, 3}},
          [&](const bsr::Int3& o)
          {
            const bsr::Int3 q{{p[0] + o[0] - 1, p[1] + o[1] - 1, p[2] + o[2] - 1}};
            const auto steps = std::abs(o[0] - 1) + std::abs(o[1] - 1) + std::abs(o[2] - 1);
            if ((!all && steps != 1) || !bsr::Box{{{0, 0, 0}}, n}.contains(q) || seen[index(q)] ||
                (v.Data[index(q)] != 0) != foreground)
            {
              return;
            }
            seen[index(q)] = 1;
            stack.push_back(q);
          });
      }
    });
  return count;
}
} // namespace

TEST(DigitalTopology, OneVoxelIsABall)
{
  const auto v = drawing({{"#"}});
  expectBetti(v, Connectivity::TwentySix, 1, 0, 0);
  expectBetti(v, Connectivity::Six, 1, 0, 0);
  EXPECT_TRUE(betti(v, Connectivity::Six).isBall());
}

TEST(DigitalTopology, DiagonalNeighborsDependOnConnectivity)
{
  const auto corner = drawing({{"#.", ".."}, {"..", ".#"}});
  expectBetti(corner, Connectivity::TwentySix, 1, 0, 0);
  expectBetti(corner, Connectivity::Six, 2, 0, 0);
  const auto ring = drawing({{".#.", "#.#", ".#."}});
  expectBetti(ring, Connectivity::TwentySix, 1, 1, 0);
  expectBetti(ring, Connectivity::Six, 4, 0, 0);
}

TEST(DigitalTopology, RingShellAndDoubleRing)
{
  for (const auto c : {Connectivity::Six, Connectivity::TwentySix})
  {
    expectBetti(drawing({{"###", "#.#", "###"}}), c, 1, 1, 0);
    expectBetti(drawing({{"#####", "#.#.#", "#####"}}), c, 1, 2, 0);
    expectBetti(
      drawing({{"###", "###", "###"}, {"###", "#.#", "###"}, {"###", "###", "###"}}), c, 1, 0, 1);
  }
}

TEST(DigitalTopology, CavityWithDiagonalLeak)
{
  // The cavity touches the outside over an edge only: closed for a 26-connected object.
  const auto v = drawing({{"###", "###", "###"}, {"##.", "#.#", "###"}, {"###", "###", "###"}});
  expectBetti(v, Connectivity::TwentySix, 1, 0, 1);
  expectBetti(v, Connectivity::Six, 1, 0, 0);
}

TEST(DigitalTopology, EmptyImageHasNothing)
{
  const auto v = drawing({{"...", "..."}});
  expectBetti(v, Connectivity::TwentySix, 0, 0, 0);
  expectBetti(v, Connectivity::Six, 0, 0, 0);
}

TEST(DigitalTopology, LabelsEqualFlooding)
{
  bsr::Monitor monitor;
  for (int seed = 0; seed < 20; ++seed)
  {
    const auto v = randomMask({{11, 9, 8}}, {{1.0, 1.0, 1.0}}, 0.05 + 0.04 * seed, seed);
    for (bool foreground : {true, false})
    {
      for (bool all : {true, false})
      {
        const auto c = bsr::connectedComponents(
          v.view(), foreground, all ? Connectivity::TwentySix : Connectivity::Six, monitor);
        ASSERT_TRUE(c);
        EXPECT_EQ(static_cast<int>(c->Voxels.size()), floodCount(v, foreground, all));
      }
    }
  }
}

TEST(DigitalTopology, EulerIsAdditiveOverSeparatedObjects)
{
  auto v =
    makeVolume<std::uint8_t>({{24, 9, 9}}, {{1.0, 1.0, 1.0}}, [](const bsr::Int3&) { return 0; });
  int expected = 0;
  for (int object = 0; object < 3; ++object)
  {
    const auto part = randomMask({{6, 7, 7}}, {{1.0, 1.0, 1.0}}, 0.4, 40 + object);
    expected += static_cast<int>(bsr::eulerCharacteristic(part.view()));
    forEachVoxel(part.Extent.Size, [&](const bsr::Int3& p)
      { v.view()(p[0] + 8 * object + 1, p[1] + 1, p[2] + 1) = part.view()(p[0], p[1], p[2]); });
  }
  EXPECT_EQ(bsr::eulerCharacteristic(v.view()), expected);
}

TEST(DigitalTopology, KeepsTheLargestComponent)
{
  auto v = drawing({{"##..###", "#...#..", ".......", "#####.."}});
  bsr::Monitor monitor;
  const auto count = bsr::keepLargestComponent(v.view(), Connectivity::TwentySix, monitor);
  ASSERT_TRUE(count);
  EXPECT_EQ(*count, 3);
  const auto expected = drawing({{".......", ".......", ".......", "#####.."}});
  EXPECT_EQ(std::memcmp(v.Data.get(), expected.Data.get(), 28), 0);
}

TEST(DigitalTopology, Cancels)
{
  const auto v = randomMask({{40, 40, 40}}, {{1.0, 1.0, 1.0}}, 0.3, 1);
  for (int after : {0, 3, 30})
  {
    CancelAfter monitor(after);
    EXPECT_EQ(bsr::bettiNumbers(v.view(), Connectivity::Six, monitor).status().code(),
      bsr::StatusCode::Cancelled);
  }
}
