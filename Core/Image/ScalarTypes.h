#pragma once

/// Applies a macro to every scalar type a volume may have (the templates of Image are instantiated
/// for these).
// clang-format off
#define BSR_FOR_EACH_SCALAR_TYPE(M)                                                                \
  M(float) M(double)                                                                               \
  M(char) M(signed char) M(unsigned char) M(short) M(unsigned short) M(int) M(unsigned int)        \
  M(long) M(unsigned long) M(long long) M(unsigned long long)
// clang-format on
