#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "methods/sparse/strata.h"

namespace textonbench {
namespace {

int torus_index(int k, int side) { return ((k % side) + side) % side; }

/// Place of (x, y) on the torus, row after row.
std::size_t place(int x, int y, int side) {
  return static_cast<std::size_t>(torus_index(y, side)) * static_cast<std::size_t>(side) +
         static_cast<std::size_t>(torus_index(x, side));
}

/// The set and its mirror image on the whole torus, row after row.
std::vector<char> whole_plane(const std::vector<Pixel>& bins, int side) {
  std::vector<char> inside(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (const Pixel& bin : bins) {
    inside[place(bin.x, bin.y, side)] = 1;
    inside[place(-bin.x, -bin.y, side)] = 1;
  }
  return inside;
}

/// Squared distances on the torus to the nearest place that is not inside: along columns, then along rows, where no
/// more is looked at than can be nearer.
std::vector<int> squared_distances(const std::vector<char>& inside, int side) {
  const int far = 2 * side;
  std::vector<int> column(inside.size(), far), result(inside.size());
  for (int x = 0; x < side; ++x) {
    int down = far, up = far;
    for (int i = 0; i < 2 * side; ++i) {
      const std::size_t at = place(x, i, side);
      down = inside[at] != 0 ? std::min(far, down + 1) : 0;
      column[at] = std::min(column[at], down);
      const std::size_t back = place(x, 2 * side - 1 - i, side);
      up = inside[back] != 0 ? std::min(far, up + 1) : 0;
      column[back] = std::min(column[back], up);
    }
  }
  for (int y = 0; y < side; ++y) {
    const int* row = column.data() + place(0, y, side);
    for (int x = 0; x < side; ++x) {
      int best = row[x] * row[x];
      for (int d = 1; d * d < best && d <= side / 2; ++d) {
        const int left = row[torus_index(x - d, side)], right = row[torus_index(x + d, side)];
        best = std::min(best, d * d + std::min(left * left, right * right));
      }
      result[place(x, y, side)] = best;
    }
  }
  return result;
}

/// Number of the connected piece (eight neighbors) of each place that is inside, −1 outside.
std::vector<int> pieces_of(const std::vector<char>& inside, int side) {
  std::vector<int> pieces(inside.size(), -1);
  std::vector<std::size_t> piece;
  int count = 0;
  for (std::size_t start = 0; start < inside.size(); ++start) {
    if (inside[start] == 0 || pieces[start] >= 0) continue;
    piece.assign(1, start);
    pieces[start] = count;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const int x = static_cast<int>(piece[i]) % side, y = static_cast<int>(piece[i]) / side;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const std::size_t at = place(x + dx, y + dy, side);
          if (inside[at] == 0 || pieces[at] >= 0) continue;
          pieces[at] = count;
          piece.push_back(at);
        }
      }
    }
    ++count;
  }
  return pieces;
}

/// Whether a bin is in the middle of its piece: no neighbor is farther from the outside by more than half a bin, and
/// none within a distance is half as far again.
bool is_in_the_middle(const Pixel& bin, const std::vector<int>& pieces, const std::vector<int>& squares, int side,
                      double distance) {
  const std::size_t here = place(bin.x, bin.y, side);
  const double wide = std::sqrt(squares[here]);
  const double next = std::pow(wide + 0.5, 2), further = std::max(next, std::pow(wide * 1.5, 2));
  const int reach = static_cast<int>(std::min(distance, side / 2.0));
  // Neighbors first: most bins have a wider one among them.
  for (int around = 1; around <= reach; ++around) {
    for (int i = 0; i < 8 * around; ++i) {
      const int along = i % (2 * around) - around;
      const int edge = i / (2 * around);
      const int dx = edge == 0 ? along : edge == 1 ? around : edge == 2 ? -along : -around;
      const int dy = edge == 0 ? -around : edge == 1 ? along : edge == 2 ? around : -along;
      const std::size_t at = place(bin.x + dx, bin.y + dy, side);
      if (pieces[at] == pieces[here] && squares[at] > (around == 1 ? next : further) &&
          dx * dx + dy * dy <= distance * distance)
        return false;
    }
  }
  return true;
}

}  // namespace

std::vector<Pixel> erode_bins(const std::vector<Pixel>& bins, int side, double distance, std::size_t least) {
  const std::vector<char> inside = whole_plane(bins, side);
  const std::vector<int> squares = squared_distances(inside, side);
  const std::vector<int> pieces = pieces_of(inside, side);
  const auto at = [side](const Pixel& bin) { return place(bin.x, bin.y, side); };
  std::vector<char> middle(bins.size());
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const bool narrow = squares[at(bins[i])] < distance * distance;
    middle[i] = narrow && is_in_the_middle(bins[i], pieces, squares, side, distance) ? 1 : 0;
  }
  const auto eroded = [&](double square) {
    std::vector<Pixel> rest;
    for (std::size_t i = 0; i < bins.size(); ++i) {
      if (squares[at(bins[i])] >= square || middle[i] != 0) rest.push_back(bins[i]);
    }
    return rest;
  };
  std::vector<Pixel> rest = eroded(distance * distance);
  if (rest.size() >= least) return rest;
  std::vector<int> steps;
  for (const Pixel& bin : bins) {
    if (squares[at(bin)] < distance * distance) steps.push_back(squares[at(bin)]);
  }
  std::ranges::sort(steps, std::greater());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  for (const int square : steps) {
    rest = eroded(square);
    if (rest.size() >= least) break;
  }
  return rest;
}

}  // namespace textonbench
