#pragma once

#include <cstddef>

namespace bsr
{
/// Tells the operating system that a large block will be written as a whole, so that it may come in
/// huge pages (first touching a volume in small pages costs as much as a pass over it). Only a
/// hint.
void adviseHugePages(void* data, std::size_t bytes);
} // namespace bsr
