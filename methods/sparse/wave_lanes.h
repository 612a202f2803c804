// Cosines and sines of whole vectors, the bits of portable::cos_sin.
//
// Functions that are compiled for several processors (target_clones) call these, so all of them are inlined.
#pragma once

#include <cstdint>

namespace textonbench {

/// Numbers of a vector register, and the same anywhere in memory.
struct EightLanes {
  static constexpr int count = 8;
  using Floats = float __attribute__((vector_size(32), may_alias));
  using Ints = std::int32_t __attribute__((vector_size(32), may_alias));
  using Words = std::uint32_t __attribute__((vector_size(32), may_alias));
  using LooseFloats = float __attribute__((vector_size(32), aligned(4), may_alias));
  using LooseWords = std::uint32_t __attribute__((vector_size(32), aligned(4), may_alias));
};
struct SixteenLanes {
  static constexpr int count = 16;
  using Floats = float __attribute__((vector_size(64), may_alias));
  using Ints = std::int32_t __attribute__((vector_size(64), may_alias));
  using Words = std::uint32_t __attribute__((vector_size(64), may_alias));
  using LooseFloats = float __attribute__((vector_size(64), aligned(4), may_alias));
  using LooseWords = std::uint32_t __attribute__((vector_size(64), aligned(4), may_alias));
};

template <class Lanes>
[[gnu::always_inline]] inline void cos_sin_lanes(const typename Lanes::Words& turn, typename Lanes::Floats& cosine,
                                                 typename Lanes::Floats& sine) {
  using Floats = typename Lanes::Floats;
  const typename Lanes::Words quarter = (turn + 0x20000000U) >> 30U;
  // In [−1/8, 1/8) turn once its words are read as signed.
  const typename Lanes::Words rest = turn - (quarter << 30U);
  const Floats x =
      __builtin_convertvector(reinterpret_cast<const typename Lanes::Ints&>(rest), Floats) * 1.46291807926715968e-9F;
  const Floats x2 = x * x;
  const Floats s = x + x * x2 * (-1.6666654611e-1F + x2 * (8.3321608736e-3F + x2 * -1.9515295891e-4F));
  const Floats c =
      1.0F - 0.5F * x2 + x2 * x2 * (4.166664568298827e-2F + x2 * (-1.388731625493765e-3F + x2 * 2.443315711809948e-5F));
  const auto odd = (quarter & 1U) != 0;
  const Floats a = odd ? s : c;
  const Floats b = odd ? c : s;
  // Signs are bits: cos is negative in quarters 1 and 2, sin in 2 and 3.
  const typename Lanes::Words cosine_sign = ((quarter + 1U) & 2U) << 30U;
  const typename Lanes::Words sine_sign = (quarter & 2U) << 30U;
  const auto signed_cosine = reinterpret_cast<const typename Lanes::Words&>(a) ^ cosine_sign;
  const auto signed_sine = reinterpret_cast<const typename Lanes::Words&>(b) ^ sine_sign;
  cosine = reinterpret_cast<const Floats&>(signed_cosine);
  sine = reinterpret_cast<const Floats&>(signed_sine);
}

}  // namespace textonbench
