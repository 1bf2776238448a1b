// Loads of a cable over a range of a logarithm, by Chebyshev's polynomials of x, which runs from −1
// to 1 across it (Trefethen, Approximation Theory and Approximation Practice, 2013, chapter 3).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>

namespace tethercalc {

constexpr std::size_t load_degree = 8;
/// Octaves that one series spans at most, where cables are solved soon.
constexpr double widest_piece = 1.0 / 4;
/// And at least: where loads are no series there, they are solved where they are asked for.
constexpr double narrowest_piece = 1.0 / 1024;
/// Beyond which nothing is remembered.
constexpr double most_octaves = 60;
/// What a series' last two terms may be of the greatest tension: the solver's own error is 1e-10
/// mostly.
constexpr double little_of_tension = 4e-9;

/// Of so many parts of a load, term by term; or their values at the nine places where they are
/// solved, from the upper end down.
template <std::size_t Parts>
using LoadSeries = std::array<std::array<double, Parts>, load_degree + 1>;

/// cos(π·i/8)
inline double load_cosine(std::size_t i) {
  static const std::array<double, 2 * load_degree> cosines = [] {
    std::array<double, 2 * load_degree> out{};
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k] = std::cos(std::numbers::pi * static_cast<double>(k) / load_degree);
    }
    return out;
  }();
  return cosines[i % cosines.size()];
}

/// Place `j` of a range from `from` to `from` + `width`.
inline double load_place(double from, double width, std::size_t j) {
  return from + 0.5 * width * (1 + load_cosine(j));
}

/// The series through values.
template <std::size_t Parts>
LoadSeries<Parts> series_through(const LoadSeries<Parts>& values) {
  LoadSeries<Parts> series{};
  for (std::size_t k = 0; k <= load_degree; ++k) {
    for (std::size_t j = 0; j <= load_degree; ++j) {
      const double weight = (j == 0 || j == load_degree ? 1.0 : 2.0) / load_degree *
                            (k == 0 || k == load_degree ? 0.5 : 1.0) * load_cosine(j * k);
      for (std::size_t i = 0; i < Parts; ++i) series[k][i] += weight * values[j][i];
    }
  }
  return series;
}

/// Whether no part of the last two terms is more than `little` of `tension`.
template <std::size_t Parts>
bool is_converged(const LoadSeries<Parts>& series, double tension,
                  double little = little_of_tension) {
  for (std::size_t k = load_degree - 1; k <= load_degree; ++k) {
    for (const double part : series[k]) {
      if (!(std::abs(part) < little * tension)) return false;
    }
  }
  return true;
}

/// The derivative by the natural logarithm of what spans `width` octaves.
template <std::size_t Parts>
LoadSeries<Parts> slope_of(const LoadSeries<Parts>& series, double width) {
  // d/dx of T_k by those before it.
  const double per_x = 2 / (width * std::numbers::ln2);
  LoadSeries<Parts> slope{};
  for (std::size_t k = load_degree; k-- > 0;) {
    for (std::size_t i = 0; i < Parts; ++i) {
      const double beyond = k + 2 <= load_degree ? slope[k + 2][i] : 0;
      slope[k][i] = beyond + 2 * static_cast<double>(k + 1) * series[k + 1][i] * per_x;
    }
  }
  for (double& part : slope[0]) part *= 0.5;
  return slope;
}

/// What the terms of a series are times at one place.
struct AtPlace {
  std::array<double, load_degree + 1> value{};
  std::array<double, load_degree + 1> slope{};  ///< by the natural logarithm of what spans `width`
};

/// Chebyshev's polynomials at `place` of a range from `from`, both in octaves, with T′_k = k·U_k−1.
inline AtPlace polynomials_at(double from, double width, double place) {
  const double x = 2 * (place - from) / width - 1;
  const double per_x = 2 / (width * std::numbers::ln2);
  AtPlace at;
  at.value[0] = 1;
  at.value[1] = x;
  at.slope[1] = per_x;
  double before = 1;  // U_k−2
  double last = 2 * x;
  for (std::size_t k = 2; k <= load_degree; ++k) {
    at.value[k] = 2 * x * at.value[k - 1] - at.value[k - 2];
    at.slope[k] = static_cast<double>(k) * last * per_x;
    const double next = 2 * x * last - before;
    before = last;
    last = next;
  }
  return at;
}

/// A part of a range, and where it lies.
template <class Piece>
struct PieceAbout {
  Piece* piece = nullptr;
  double from = 0;
  double width = 0;
};

/// The piece about a place that has no `halves`. The `widest` are kept by their numbers; `make`
/// makes one of which the kind is unknown.
template <class Piece, class Make>
PieceAbout<Piece> piece_about(std::map<int, Piece>& pieces, double place, double widest,
                              const Make& make) {
  double width = widest;
  double from = width * std::floor(place / width);
  Piece* piece = &pieces[static_cast<int>(from / width)];
  for (;;) {
    if (piece->kind == Piece::Kind::unknown) make(*piece, from, width);
    if (!piece->halves) return {piece, from, width};
    width /= 2;
    const bool upper = place >= from + width;
    if (upper) from += width;
    piece = &(*piece->halves)[upper ? 1 : 0];
  }
}

/// Its value at x, by Clenshaw's recurrence.
template <std::size_t Parts>
std::array<double, Parts> value_at(const LoadSeries<Parts>& series, double x) {
  std::array<double, Parts> now{};
  std::array<double, Parts> before{};
  for (std::size_t k = load_degree; k > 0; --k) {
    for (std::size_t i = 0; i < Parts; ++i) {
      const double value = series[k][i] + 2 * x * now[i] - before[i];
      before[i] = now[i];
      now[i] = value;
    }
  }
  for (std::size_t i = 0; i < Parts; ++i) now[i] = series[0][i] + x * now[i] - before[i];
  return now;
}

}  // namespace tethercalc
