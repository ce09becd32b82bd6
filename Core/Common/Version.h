#pragma once

namespace bsr
{
/// Version of the project, "major.minor.patch".
const char* version();
} // namespace bsr
