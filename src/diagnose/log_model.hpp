// A kind of log as the search and the writer of diagnoses see it: effects with their parameters,
// rows, predictions, and what of them a person is shown.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/selection.hpp"
#include "tethercalc/diagnose/catalogue.hpp"

namespace tethercalc {

struct FlightRecord;  // diagnose/flight_prediction.hpp
struct PowerLog;      // diagnose/power_log.hpp

/// Logs of some kind, most often one. Groups that are no effects of the catalogue, such as drag
/// areas, are described as such too: an `Effect` without an id, that is always fitted.
class LogModel {
 public:
  /// When a log begins and ends, s of its clock.
  struct Span {
    double begin = 0;
    double end = 0;
    std::size_t blocks = 0;  ///< of several logs: so many are its own
  };
  /// One log at least.
  explicit LogModel(std::vector<Span> logs) : logs_(std::move(logs)) {}
  LogModel(const LogModel&) = delete;
  LogModel& operator=(const LogModel&) = delete;
  virtual ~LogModel() = default;

  /// Adds a group for `effect`, which must outlive this; fitted from the start, or a candidate. It
  /// acts in one of the logs, or in all of them alike.
  void add(const Effect& effect, const Design& design, bool fitted,
           std::optional<std::size_t> log = std::nullopt);

  [[nodiscard]] std::size_t logs() const { return logs_.size(); }
  /// The only log that the group acts in; nothing where it acts in all.
  [[nodiscard]] std::optional<std::size_t> log_of(std::size_t group) const {
    return in_log_[group];
  }
  /// The same for a person: 1, 2, …, or 0 for all.
  [[nodiscard]] std::size_t flight_of(std::size_t group) const {
    return in_log_[group] ? *in_log_[group] + 1 : 0;
  }
  /// Id or title, with the log that it acts in if that is one of several.
  [[nodiscard]] const std::string& name(std::size_t group) const {
    return problem.groups[group].id;
  }

  [[nodiscard]] const Effect& effect(std::size_t group) const { return *effects_[group]; }
  [[nodiscard]] std::span<const Effect* const> effects() const { return effects_; }
  [[nodiscard]] std::size_t first_parameter(std::size_t group) const { return first_[group]; }
  /// Index of a parameter by its name, over all groups added; nothing where there is none.
  [[nodiscard]] std::optional<std::size_t> index_of(std::string_view parameter) const;
  /// The same of the parameter that a field of the spec takes.
  [[nodiscard]] std::optional<std::size_t> index_of_field(std::string_view spec_field) const;
  /// The part of all parameters that belongs to `group`.
  [[nodiscard]] std::span<const double> own(std::size_t group,
                                            std::span<const double> values) const {
    return values.subspan(first_[group], effects_[group]->parameters.size());
  }
  /// Whether the sizes of `group` are neutral, so that it changes nothing.
  [[nodiscard]] bool is_neutral(std::size_t group, std::span<const double> values) const;

  SelectionProblem problem;  ///< its groups in the order in which they were added

  // --- What is shown of a finding ---

  /// Where the effect of the group acts first, into `Diagnosis::compared`.
  [[nodiscard]] virtual std::size_t series(std::size_t group) const = 0;
  /// The channel that it acts through.
  [[nodiscard]] virtual Channel channel(std::size_t group) const = 0;
  /// Measured less predicted with these values, NaN in samples that are left out.
  [[nodiscard]] virtual std::vector<double> left_by(std::size_t series,
                                                    std::span<const double> values) const = 0;

 private:
  /// Of the first parameter whose `member` is `text`.
  [[nodiscard]] std::optional<std::size_t> index_where(std::string EffectParameter::*member,
                                                       std::string_view text) const;

  std::vector<Span> logs_;
  std::vector<std::optional<std::size_t>> in_log_;
  std::vector<const Effect*> effects_;
  std::vector<std::size_t> first_;
};

/// Of a log with samples at `time`, rising; empty where there are none.
[[nodiscard]] LogModel::Span span_of(std::span<const double> time, std::size_t blocks = 0);

/// Throws std::invalid_argument unless each of `ids` is one of `effects`, those of such logs.
void check_base_effects(LogKind kind, std::span<const Effect* const> effects,
                        std::span<const std::string> ids);

/// All that is told alike of every kind of log: qualities and parameters of the models, findings
/// with their traces, aliases, the error budget, and of the unexplained all but its size.
void tell(const LogModel& log, const Selection& selection, Diagnosis& diagnosis);

/// 100·t²/(t² + n): the least part of the squared error that one of `shapes` tried must make up so
/// that the test of its correlation with n independent samples, at `false_alarm_probability` over
/// all of them (Bonferroni), finds it. n > 2.
[[nodiscard]] double undetectable_percent(double samples, std::size_t shapes,
                                          double false_alarm_probability);

/// The channel of a flight that `id`, as in `Effect::channel`, names, one value a sample:
/// "forward_speed", "tilt", "tilt_rate", "yaw", "place", "height", "time", "braking" (forward speed
/// times tilt while they oppose, else NaN) or "sinking" (forward speed times down speed). Throws
/// std::invalid_argument for any other.
[[nodiscard]] Channel flight_channel(const std::string& id, const FlightRecord& record);

/// The same of a power log: "supply_current", "current_height" (their product), "bus_power",
/// "height", "airspeed" or "time". The log needs the channels in question.
[[nodiscard]] Channel power_channel(const std::string& id, const PowerLog& log);

}  // namespace tethercalc
