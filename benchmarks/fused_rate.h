// What the processor can do at most: fused multiply-adds of floats a second, on one thread.
#pragma once

#include <benchmark/benchmark.h>
#include <immintrin.h>

#include <cstdint>

namespace textonbench {

/// Chains that do not wait for each other: enough to hide the latency of two units, few enough for the registers.
constexpr int fused_chains = 12;

__attribute__((target("avx512f"))) inline void make_fused_avx512(std::int64_t rounds) {
  const __m512 factor = _mm512_set1_ps(0.5F), term = _mm512_set1_ps(0.25F);
  __m512 sum[fused_chains] = {};
  for (std::int64_t i = 0; i < rounds; ++i) {
#pragma GCC unroll 16
    for (__m512& one : sum) one = _mm512_fmadd_ps(one, factor, term);
  }
  for (__m512& one : sum) benchmark::DoNotOptimize(one);
}

__attribute__((target("avx2,fma"))) inline void make_fused_avx2(std::int64_t rounds) {
  const __m256 factor = _mm256_set1_ps(0.5F), term = _mm256_set1_ps(0.25F);
  __m256 sum[fused_chains] = {};
  for (std::int64_t i = 0; i < rounds; ++i) {
#pragma GCC unroll 16
    for (__m256& one : sum) one = _mm256_fmadd_ps(one, factor, term);
  }
  for (__m256& one : sum) benchmark::DoNotOptimize(one);
}

/// Makes at least `count` fused multiply-adds by the widest registers at hand, as fast as the processor can; false on
/// one that has no such instruction.
inline bool make_fused(double count) {
  if (__builtin_cpu_supports("avx512f")) {
    make_fused_avx512(static_cast<std::int64_t>(count / (fused_chains * 16)) + 1);
    return true;
  }
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return false;
  make_fused_avx2(static_cast<std::int64_t>(count / (fused_chains * 8)) + 1);
  return true;
}

}  // namespace textonbench
