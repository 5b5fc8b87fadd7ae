// SPDX-License-Identifier: MIT
// The upper envelope of straight segments over a line: the horizon of a viewshed sector, or of a strip of parallel
// sun rays. Positions u run along the line, heights s across it; the caller converts edges of the ground to segments.
//
//    s        /\.  <- an implicit vertex: two edges cross. Its position is rounded
//      ___  _/  \.
//     /   \/     |   <- a drop: an edge ends here. Its position is a sample's, and exact
//    o            o____o
//                           u
//
// Pieces keep the line of their edge even after other edges cut them many times: rounding does not accumulate. Heights
// are compared in doubles with a bound on their rounding. Where that is undecided, the end of an edge and another edge
// are compared exactly, from the samples. At an implicit vertex that is not possible: a piece that may be lower there
// than the piece it replaced stores by how much (`slack`), and targets that close to it are left to the caller.
//
// Source: H. J. Haverkort and L. Toma, "A comparison of I/O-efficient algorithms for visibility computation on massive
// grid terrains", arXiv 1810.01946, 2018, model R3 (there only in doubles). Cost: a merge copies the pieces once and
// compares those under the new segments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scarp {

/// A sample, identified by its ring (the line of samples in which it occurs) and its index along that line.
struct HorizonSample {
  int ring = 0;
  int side = 0;
  bool operator==(const HorizonSample&) const = default;
};

/// A straight edge between two samples, as a line s(u) = s0 + slope (u - u0).
struct HorizonLine {
  double u0 = 0;
  double s0 = 0;  ///< -infinity: no ground
  double slope = 0;
  double error = 0;  ///< bound of the rounding of s at any u within the edge
  HorizonSample from{-1, -1}, to{-1, -1};

  double at(double u) const { return s0 + slope * (u - u0); }
  bool is_ground() const { return from.side >= 0; }
};

/// A segment to merge: a line from `begin` to `end`. Its ends are those of the edge, unless `end_cut` (`begin_cut`) is
/// set: the edge is cut short there.
struct HorizonSegment {
  double begin = 0;
  double end = 0;
  HorizonSample first, last;  ///< the samples at both ends, where it is not cut
  bool begin_cut = false;
  bool end_cut = false;
  bool clear = false;  ///< certainly above the envelope from end to end
  HorizonLine line;
};

/// Exact answers about edges and samples.
class HorizonEdges {
 public:
  virtual ~HorizonEdges() = default;
  /// Returns the sign of the edge's height minus the sample's, at the sample's position within the edge.
  virtual int edge_above(const HorizonLine& edge, HorizonSample sample) const = 0;
  /// Returns the same for the target on a sample.
  virtual int edge_above_target(const HorizonLine& edge, HorizonSample target) const = 0;
  /// Returns the position u of a sample.
  virtual double position(HorizonSample sample) const = 0;
};

class HorizonEnvelope {
 public:
  struct Piece {
    double begin = 0;
    HorizonLine line;
    double error = 0;  ///< line.error, or more next to an implicit vertex
    double slack = 0;  ///< the envelope may be higher by this much
    double blur = 0;   ///< uncertainty of `begin`; 0 for a sample's position
  };

  /// `edges` must outlive the envelope.
  explicit HorizonEnvelope(const HorizonEdges& edges);

  /// Pieces from u = -infinity on; each ends where the next starts. The last is a sentinel at +infinity.
  const std::vector<Piece>& pieces() const { return pieces_; }
  /// Returns the piece that contains u, the later one of two. `hint` is a piece that starts at or before u.
  std::size_t find(double u, std::size_t hint = 0) const;

  /// Merges segments, which must be sorted and overlap only at their ends.
  void merge(const std::vector<HorizonSegment>& segments);

  enum class Answer : std::uint8_t { visible, blocked, unsure };
  /// Tests the target on a sample, at u and s: whether any merged edge is strictly above. `piece` is find(u).
  Answer test(std::size_t piece, double u, double s, double s_error, HorizonSample target) const;
  /// Whether the highest line at u is certainly that of the piece find(u) or, exactly at its start, that of the
  /// previous piece.
  bool is_sure(std::size_t piece, double u) const;

 private:
  struct Comparison {
    int sign = 0;  // sign of segment minus piece, or kUnsure
    double difference = 0;
    double bound = 0;
  };
  Comparison compare(const HorizonSegment& segment, std::size_t piece, double u) const;
  void resolve(const HorizonSegment& segment, std::size_t piece, double begin, double end);
  void put(const Piece& piece);
  void put_old(std::size_t piece, double begin, double slack);
  void put_new(const HorizonSegment& segment, std::size_t piece, double begin, double slack);
  void put_crossing(const HorizonSegment& segment, std::size_t piece, double begin, double end, const Comparison& left,
                    const Comparison& right);
  bool blurred(std::size_t piece, double u) const;

  const HorizonEdges& edges_;
  std::vector<Piece> pieces_, merged_;
};

}  // namespace scarp
