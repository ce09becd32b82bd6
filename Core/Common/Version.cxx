#include "Common/Version.h"

namespace bsr
{
const char* version()
{
  return "0.1.0";
}
} // namespace bsr
