// A cable as a chain of straight links that is aimed from the ground until it meets the drone: an
// independent check, which shares nothing with the solver but the law of drag.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace tethercalc::test {

/// What a cable does to the drone that it hangs from.
struct CablePull {
  double along = 0;   ///< N, with the wind
  double down = 0;    ///< N
  double length = 0;  ///< m
};

/// A cable from the ground to a drone straight above, in an even wind. It keeps its last solution,
/// from which the next is sought.
class LinkedCable {
 public:
  /// N/m; kg/m², ½·ρ·C times the width.
  LinkedCable(double weight, double drag) : weight_(weight), drag_(drag) {}

  /// `length` > `height`, m; `wind` in m/s, from 0.
  CablePull of_length(double height, double wind, double length) {
    // In little wind it turns round within a link: between such a wind and still air, where it
    // hangs down from both ends, the pull is straight in the pressure of the wind.
    const double little = std::sqrt(0.02 * weight_ / drag_);
    if (wind < little) {
      const CablePull least = of_length(height, little, length);
      const double share = wind * wind / (little * little);
      const double still = weight_ * (height + (length - height) / 2);
      return {share * least.along, still + share * (least.down - still), length};
    }
    const auto miss = [&](const Aim& aim, double speed) {
      return missed(aim[0], aim[1], length, height, speed);
    };
    // A bow of a cable that weighs nothing has the tension q·h/√(24·slack).
    const auto bow = [&](double speed) {
      const double q = drag_ * speed * speed * height;
      return Aim{-q / 2, q / std::sqrt(24 * (length / height - 1)) - weight_ * height / 2};
    };
    // From much wind down, where the cable is such a bow.
    const double much = std::max(wind, std::sqrt(3 * weight_ / drag_));
    aim_at(miss, bow(much), much, wind);
    return {end_[0], end_[1], length};
  }

  /// As long as it takes for `tension` > 0 N on the ground.
  CablePull of_tension(double height, double wind, double tension) {
    const auto miss = [&](const Aim& aim, double speed) {
      return missed(tension * std::sin(aim[0]), tension * std::cos(aim[0]), aim[1] * height, height,
                    speed);
    };
    aim_at(miss, Aim{0, 1}, 0, wind);  // from still air up, where it is upright
    return {end_[0], end_[1], last_->at(1) * height};
  }

 private:
  using Aim = std::array<double, 2>;

  /// Where the last link ends beside the drone, over its height.
  Aim missed(double along, double up, double length, double height, double wind) {
    constexpr int links = 160;
    const double link = length / links;
    double x = 0, z = 0;
    Aim tension{along, up};
    const auto change = [&](const Aim& t) {
      const double size = std::hypot(t[0], t[1]);
      const double across = -wind * t[1] / size;  // of the wind, in the direction (up, −along)
      const double pressed = drag_ * std::abs(across) * across;
      return Aim{-pressed * t[1] / size, weight_ + pressed * t[0] / size};
    };
    for (int i = 0; i < links; ++i) {
      const Aim first = change(tension);
      const Aim middle{tension[0] + link / 2 * first[0], tension[1] + link / 2 * first[1]};
      const Aim whole = change(middle);
      const double size = std::hypot(middle[0], middle[1]);
      x += link * middle[0] / size;
      z += link * middle[1] / size;
      for (std::size_t k = 0; k < 2; ++k) tension[k] += link * whole[k];
    }
    end_ = tension;
    return {x / height, z / height - 1};
  }

  /// From the last solution, or else by steps of the wind from `first`, where the aim is `guess`.
  template <typename Miss>
  void aim_at(const Miss& miss, const Aim& guess, double first, double wind) {
    if (last_ && hit(miss, wind)) return;
    last_ = guess;
    constexpr int steps = 60;
    for (int i = 0; i <= steps; ++i) {
      if (!hit(miss, first + (wind - first) * i / steps)) {
        throw std::runtime_error("the chain of links does not meet the drone");
      }
    }
  }

  /// Newton's method with halved steps.
  template <typename Miss>
  bool hit(const Miss& miss, double wind) {
    Aim aim = *last_;
    Aim off = miss(aim, wind);
    for (int i = 0; i < 60; ++i) {
      const double far = std::hypot(off[0], off[1]);
      if (far < 1e-9) {
        last_ = aim;
        return true;
      }
      std::array<Aim, 2> slope;
      for (std::size_t k = 0; k < 2; ++k) {
        Aim moved = aim;
        const double step = 1e-6 * (1 + std::abs(aim[k]));
        moved[k] += step;
        const Aim there = miss(moved, wind);
        slope[k] = {(there[0] - off[0]) / step, (there[1] - off[1]) / step};
      }
      const double area = slope[0][0] * slope[1][1] - slope[1][0] * slope[0][1];
      const Aim step{(off[0] * slope[1][1] - off[1] * slope[1][0]) / area,
                     (off[1] * slope[0][0] - off[0] * slope[0][1]) / area};
      double part = 1;
      for (; part > 1e-4; part /= 2) {
        const Aim next{aim[0] - part * step[0], aim[1] - part * step[1]};
        const Aim there = miss(next, wind);
        if (!(std::hypot(there[0], there[1]) < far)) continue;
        aim = next;
        off = there;
        break;
      }
      if (part <= 1e-4) return false;
    }
    return false;
  }

  double weight_;
  double drag_;
  std::optional<Aim> last_{};
  Aim end_{};  ///< N, of the upper end of the last chain
};

}  // namespace tethercalc::test
