// Waves and windows of Gabor kernels in whole vectors, in fused multiply-adds: a lane's bits depend neither on the
// other lanes nor on their number, nor on the processor.
//
// For gabor_loops.cpp, which includes this for each kind of processor, inside a namespace that says what Lanes and
// has_fused are.

using Floats = Lanes::Floats;
using Ints = Lanes::Ints;
using Words = Lanes::Words;
using LooseFloats = Lanes::LooseFloats;

/// a b + c, rounded once. By the instruction's name: GCC finds it in loops over the numbers of a vector in some places
/// and not in others. Analyzers that are not GCC read the loops.
[[gnu::always_inline]] inline Floats fused_lanes(const Floats& a, const Floats& b, const Floats& c) {
  auto sum = c;
#ifndef __clang__
  if constexpr (has_fused) {
    asm("vfmadd231ps %2, %1, %0" : "+v"(sum) : "v"(b), "vm"(a));
    return sum;
  }
#endif
  for (int x = 0; x < Lanes::count; ++x) sum[x] = __builtin_fmaf(a[x], b[x], c[x]);
  return sum;
}

/// The same where a is used up and c is a coefficient.
[[gnu::always_inline]] inline Floats fused_series(const Floats& a, const Floats& b, float c) {
  auto sum = a;
#ifndef __clang__
  if constexpr (has_fused) {
    const Floats last = c - Floats{};
    asm("vfmadd213ps %2, %1, %0" : "+v"(sum) : "v"(b), "vm"(last));
    return sum;
  }
#endif
  for (int x = 0; x < Lanes::count; ++x) sum[x] = __builtin_fmaf(a[x], b[x], c);
  return sum;
}

[[gnu::always_inline]] inline Floats all_lanes(float number) { return number - Floats{}; }

[[gnu::always_inline]] inline Floats load_lanes(const float* from) {
  return *reinterpret_cast<const LooseFloats*>(from);
}

[[gnu::always_inline]] inline void store_lanes(const Floats& lanes, float* to) {
  *reinterpret_cast<LooseFloats*>(to) = lanes;
}

/// 2^e, −120 <= e <= 120, within 3e-7 of it. Anything, without a trap, for other numbers.
[[gnu::always_inline]] inline Floats exp2_of(const Floats& e) {
  constexpr float magic = 0x1.8p23F;  // rounds to whole numbers, which the lowest bits then hold
  const Floats shifted = e + magic;
  const Floats f = e - (shifted - magic);
  Floats series = all_lanes(1.339086331e-3F);
  for (const float k : {9.676031768e-3F, 5.550356954e-2F, 2.402210683e-1F, 6.931471825e-1F, 1.000000119F}) {
    series = fused_series(series, f, k);
  }
  const Words power = reinterpret_cast<const Words&>(series) + (reinterpret_cast<const Words&>(shifted) << 23U);
  return reinterpret_cast<const Floats&>(power);
}

/// Cosine of 2π turn / 2^32 and minus its sine, but for a sign bit that both have in common: within 2e-7.
[[gnu::always_inline]] inline void half_wave(const Words& turn, Floats& cosine, Floats& sine, Words& sign) {
  sign = (turn + 0x40000000U) & 0x80000000U;
  // In [−1/4, 1/4) turn once its words are read as signed.
  const Words rest = turn - sign;
  const Floats x = __builtin_convertvector(reinterpret_cast<const Ints&>(rest), Floats) * -1.46291807926715968e-9F;
  const Floats x2 = x * x;
  Floats s = all_lanes(2.605107738e-6F), c = all_lanes(-2.629751634e-7F);
  for (const float k : {-1.980901725e-4F, 8.333049715e-3F, -1.666665822e-1F, 1.0F}) {
    s = fused_series(s, x2, k);
  }
  for (const float k : {2.477457929e-5F, -1.388865174e-3F, 4.166666046e-2F, -0.5F, 1.0F}) {
    c = fused_series(c, x2, k);
  }
  cosine = c;
  sine = x * s;
}

/// The number with its sign changed where a sign bit is set.
[[gnu::always_inline]] inline Floats with_sign(const Floats& number, const Words& sign) {
  const Words bits = reinterpret_cast<const Words&>(number) ^ sign;
  return reinterpret_cast<const Floats&>(bits);
}

/// Turns of `part` in 2^−29 turn, truncated.
[[gnu::always_inline]] inline Words turns_of_part(const Floats& part) {
  const Ints whole = __builtin_convertvector(part, Ints);
  return reinterpret_cast<const Words&>(whole) << 3U;
}
