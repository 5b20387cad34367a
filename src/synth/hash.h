// Noise that depends on nothing but its key: the same for any thread, order and machine.
#pragma once

#include <cmath>
#include <cstdint>

namespace varve::synth {

/// Mixes a number into a key. Finalizer of SplitMix64 (Steele, Lea, Flood 2014).
inline std::uint64_t mix(std::uint64_t key, std::uint64_t value) {
  std::uint64_t z = key + 0x9E3779B97F4A7C15u * (value + 1);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

/// Uniform in [0, 1).
inline double uniform(std::uint64_t key) { return double(key >> 11) * 0x1p-53; }

/// Normal with mean 0 and deviation 1 (Box and Muller 1958).
inline double normal(std::uint64_t key) {
  const double u = 1 - uniform(mix(key, 1)), v = uniform(mix(key, 2));
  return std::sqrt(-2 * std::log(u)) * std::cos(6.283185307179586 * v);
}

/// Key of a lattice cell, for textures.
inline std::uint64_t cell_key(double i, double j, std::uint64_t seed) {
  return mix(mix(seed, std::uint64_t(std::int64_t(i))), std::uint64_t(std::int64_t(j)));
}

}  // namespace varve::synth
