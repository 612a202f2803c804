// RandomSequence::poisson() (methods/base/random.h) of the mean of a cell, the first numbers drawn from a stream. Its
// float64 operations are the processor's, one for one, so the count is the same bit for bit where divisions are rounded
// correctly, as in Mesa's software; where they are off by their last bit it differs for one cell in some 10^13.
uniform usamplerBuffer poisson_numbers;  // pairs of words of float64: mean, a, b, 1/α, v_r, logarithms of probabilities

double poisson_constant(int i) {
  return packDouble2x32(uvec2(texelFetch(poisson_numbers, 2 * i).x, texelFetch(poisson_numbers, 2 * i + 1).x));
}

// RandomSequence::uniform() of two words.
double open_uniform(uvec2 words) {
  precise double v = (double(words.x) * 1048576.0lf + double(words.y >> 12) + 0.5lf) * 2.220446049250313080847e-16lf;
  return v;
}

const double inverse_odd[10] =
    double[10](1.0lf / 21.0lf, 1.0lf / 19.0lf, 1.0lf / 17.0lf, 1.0lf / 15.0lf, 1.0lf / 13.0lf, 1.0lf / 11.0lf,
               1.0lf / 9.0lf, 1.0lf / 7.0lf, 1.0lf / 5.0lf, 1.0lf / 3.0lf);

// portable::log() (methods/base/portable_math.h).
double logarithm(double x) {
  uvec2 bits = unpackDouble2x32(x);
  uint borrow;
  usubBorrow(bits.x, 0x667F3BCDu, borrow);
  int e = int(bits.y - 0x3FE6A09Eu - borrow) >> 20;
  double m = packDouble2x32(uvec2(bits.x, bits.y - uint(e << 20)));
  precise double s = (m - 1.0lf) / (m + 1.0lf);
  precise double s2 = s * s;
  precise double series = 1.0lf / 23.0lf;
  for (int i = 0; i < 10; ++i) series = series * s2 + inverse_odd[i];
  precise double result = double(e) * 0.69314718055994530942lf + (2.0lf * s + 2.0lf * s * s2 * series);
  return result;
}

#if ARRIVALS

// Arrivals of a unit-rate process before the mean. Below 10, which has more than 100 never.
uint poisson_number(uvec2 stream, out uint words) {
  double mean = poisson_constant(0);
  precise double time = 0.0lf;
  uvec4 block = uvec4(0u);
  uint drawn = 0u;
  while (time <= mean) {
    if ((drawn & 1u) == 0u) block = philox_block(stream, uvec4(drawn / 2u, 0u, 0u, 0u));
    time = time - logarithm(open_uniform((drawn & 1u) == 0u ? block.xy : block.zw));
    ++drawn;
  }
  words = 2u * drawn;
  return drawn - 1u;
}

#else

// Transformed rejection, a block of words a candidate.
uint poisson_number(uvec2 stream, out uint words) {
  double mean = poisson_constant(0);
  double a = poisson_constant(1);
  double b = poisson_constant(2);
  double k = 0.0lf;
  uint tried = 0u;
  bool is_taken = false;
  while (!is_taken) {
    uvec4 block = philox_block(stream, uvec4(tried, 0u, 0u, 0u));
    ++tried;
    precise double u = open_uniform(block.xy) - 0.5lf;
    precise double v = open_uniform(block.zw);
    precise double us = 0.5lf - abs(u);
    precise double position = (2.0lf * a / us + b) * u + mean + 0.43lf;
    k = floor(position);
    if (us >= 0.07lf && v <= poisson_constant(4)) {
      is_taken = true;
    } else if (k >= 0.0lf && k < double(LOGARITHMS) && !(us < 0.013lf && v > us)) {
      precise double bound = v * poisson_constant(3) / (a / (us * us) + b);
      is_taken = logarithm(bound) <= poisson_constant(5 + int(k));
    }
  }
  words = 4u * tried;
  return uint(k);
}

#endif
