// SPDX-License-Identifier: MIT
// Positions of a pixel's samples in the unit square: low-discrepancy points that depend only on pixel and seed, and are
// therefore the same in every run and for any number of threads.
//
//   points   the first two dimensions of Sobol's sequence (Sobol 1967), a (0,2)-sequence: every elementary interval
//            of area 2^-m contains exactly one of 2^m consecutive points that start at a multiple of 2^m
//   random   Owen's nested uniform scrambling (Owen 1995), by hashing (Laine and Karras 2011; the hash is Vegdahl's of
//            2021): unbiased, and the intervals keep their one point each
//   pixels   take blocks of ONE sequence, in Morton order with its digits shuffled (Ahmed and Wonka 2020): neighbours
//            complement each other, so the error of the picture is blue noise, which the eye averages
//
//            and take their points in a shuffled order, again nested (Burley 2020); otherwise the upper left corner of
//            every pixel would sample the same part of the sun
//
// A pixel's samples may be drawn in several consecutive passes: each pass is stratified, and so are all of them
// together.
#pragma once

#include <cstdint>

#include "scarp/base/vec.h"

namespace scarp {

/// The points of one pixel for one purpose.
class PixelPoints {
 public:
  /// Returns point i inside the unit square, never on its border; i is less than the pattern's points per pixel.
  dvec2 operator[](std::uint32_t i) const;

 private:
  friend class SamplePattern;
  std::uint32_t x_ = 0, y_ = 0;  // coordinates of the pixel's first point, before scrambling
  std::uint32_t seed_x_ = 0, seed_y_ = 0, seed_order_ = 0;
  int index_bits_ = 0;
};

class SamplePattern {
 public:
  /// `points_per_pixel`, 1..2^26, is the maximum number of points per pixel and purpose.
  SamplePattern(std::uint32_t seed, std::uint32_t points_per_pixel);

  /// The points of pixel (x, y), 0..65535 each. Purposes (any numbers) are independent of one another.
  PixelPoints pixel(int x, int y, std::uint32_t purpose) const;

  std::uint32_t seed() const { return seed_; }
  /// Bits of a point's number in its pixel.
  int index_bits() const { return index_bits_; }

 private:
  std::uint32_t seed_;
  int index_bits_;  // number of index bits in a pixel's block of the sequence
};

}  // namespace scarp
