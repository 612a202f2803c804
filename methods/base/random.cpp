#include "methods/base/random.h"

#include <Random123/philox.h>
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "methods/base/poisson_rejection.h"
#include "methods/base/portable_math.h"

namespace textonbench {
namespace {

__extension__ using Wide = unsigned __int128;

// Keys of children come from the parent's key under a mask, so that they are not among the parent's own words.
std::uint64_t child_key(std::uint64_t key, std::uint64_t kind, std::uint64_t value) {
  const auto words = philox_block(key ^ 0x7465787475726573ULL, kind, value);
  return (std::uint64_t{words[1]} << 32U) | words[0];
}

/// FNV-1a, 64 bit.
std::uint64_t hash(std::string_view name) {
  std::uint64_t h = 0xCBF29CE484222325ULL;
  for (const char c : name) {
    h = (h ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  }
  return h;
}

}  // namespace

std::array<std::uint32_t, 4> philox_block(std::uint64_t key, std::uint64_t row, std::uint64_t index) {
  const r123::Philox4x32::ctr_type counter = {
      {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32U), static_cast<std::uint32_t>(row),
       static_cast<std::uint32_t>(row >> 32U)}};
  const r123::Philox4x32::key_type k = {{static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32U)}};
  const auto words = r123::Philox4x32{}(counter, k);
  return {words[0], words[1], words[2], words[3]};
}

Stream::Stream(Seed seed) : key_(child_key(seed.value, 0, 0)) {}

Stream Stream::child(std::string_view name) const { return Stream(child_key(key_, 1, hash(name))); }

Stream Stream::child(std::uint64_t index) const { return Stream(child_key(key_, 2, index)); }

std::array<std::uint32_t, 4> Stream::block(std::uint64_t row, std::uint64_t index) const {
  return philox_block(key_, row, index);
}

Seed derive(Seed seed, std::string_view name) { return Seed{child_key(seed.value, 3, hash(name))}; }

Seed derive(Seed seed, std::uint64_t index) { return Seed{child_key(seed.value, 4, index)}; }

std::uint32_t RandomSequence::next() {
  if (used_ == 4) {
    words_ = stream_.block(0, index_++);
    used_ = 0;
  }
  return words_[static_cast<std::size_t>(used_++)];
}

double RandomSequence::uniform() {
  const std::uint64_t high = next();
  const std::uint64_t word = (high << 32U) | next();
  return (static_cast<double>(word >> 12U) + 0.5) * 0x1p-52;
}

std::uint64_t RandomSequence::below(std::uint64_t bound) {
  if (bound == 0) {
    throw std::invalid_argument("random integer below 0: the bound must be at least 1");
  }
  // Lemire 2019: the high word of a product is uniform once the few low words that would bias it are refused.
  const std::uint64_t refused = (0 - bound) % bound;
  for (;;) {
    const std::uint64_t high = next();
    const std::uint64_t word = (high << 32U) | next();
    const Wide product = static_cast<Wide>(word) * bound;
    if (static_cast<std::uint64_t>(product) >= refused) {
      return static_cast<std::uint64_t>(product >> 64U);
    }
  }
}

double RandomSequence::normal() {
  // Marsaglia's polar method.
  for (;;) {
    const double x = 2 * uniform() - 1;
    const double y = 2 * uniform() - 1;
    const double s = x * x + y * y;
    if (s < 1 && s > 0) {
      return x * std::sqrt(-2 * portable::log(s) / s);
    }
  }
}

std::int64_t RandomSequence::poisson(double mean) {
  if (!(mean >= 0 && mean <= 1e15)) {
    throw std::invalid_argument(fmt::format("Poisson mean {}: expected a number in [0, 1e15]", mean));
  }
  if (mean < least_rejection_mean) {
    // Count the arrivals of a unit-rate process before time `mean`.
    std::int64_t count = -1;
    for (double time = 0; time <= mean; ++count) {
      time -= portable::log(uniform());
    }
    return count;
  }
  // Transformed rejection with squeeze, PTRS (Hörmann 1993).
  const auto [a, b, inverse_alpha, v_r] = poisson_rejection(mean);
  for (;;) {
    const double u = uniform() - 0.5;
    const double v = uniform();
    const double us = 0.5 - std::fabs(u);
    const double k = std::floor((2 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= v_r) {
      return static_cast<std::int64_t>(k);
    }
    if (k < 0 || (us < 0.013 && v > us)) {
      continue;
    }
    if (portable::log(v * inverse_alpha / (a / (us * us) + b)) <= log_poisson(k, mean)) {
      return static_cast<std::int64_t>(k);
    }
  }
}

}  // namespace textonbench
