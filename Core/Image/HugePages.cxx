#include "Image/HugePages.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace bsr
{
void adviseHugePages(void* data, std::size_t bytes)
{
#ifdef __linux__
  constexpr std::uintptr_t Page = std::uintptr_t{1} << 21;
  const auto begin = (reinterpret_cast<std::uintptr_t>(data) + Page - 1) & ~(Page - 1);
  const auto end = (reinterpret_cast<std::uintptr_t>(data) + bytes) & ~(Page - 1);
  if (end > begin)
  {
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  }
#else
  (void)data;
  (void)bytes;
#endif
}
} // namespace bsr
