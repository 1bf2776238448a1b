// What is left of a power log after a model's prediction, in units of the instruments' noise, and
// with the noise's memory taken out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "diagnose/power_screening.hpp"

namespace tethercalc {

/// Waves that are looked for in a log have so many half turns in it at most, from two on. They are
/// so near to each other that of one between two of them the nearer one, off by an eighth of a turn
/// at either end, sees nine tenths.
inline constexpr int most_half_turns = 100;

/// One comparison of the chain.
struct PowerStage {
  Stage stage = Stage::tether;  ///< which part of the chain
  std::string quantity;         ///< in words: "voltage lost in the tether"
  std::string unit;             ///< of `noise`
  std::string shaped;           ///< what a shape without a name changes, in words
  std::string shaped_unit;      ///< its unit
  double noise = 1;             ///< standard deviation of one sample, all instruments together
  std::vector<char> usable{};   ///< one a sample

  std::size_t samples_per_row = 1;  ///< averaged into one row
  std::size_t first_row = 0;        ///< among the rows of all stages
  std::size_t rows = 0;             ///< number of samples used
  std::vector<char> usable_rows{};  ///< at least half of the samples are usable
  std::vector<double>
      memory{};           ///< φ of the autoregression that the rows' noise follows; empty: white
  double innovation = 1;  ///< standard deviation of the rows' white part over `noise`
};

/// Compares a screened log with models of it.
///
/// - *tether*: the voltage lost on the way, U_supply − U_drone, with I·R.
/// - *converter*: the power at its input, U_drone·I − P_aux, with what its output needs. Both sides
///   are measured. The difference is divided by the noise of both, the slope of the model in it:
///   minimising its square is the maximum-likelihood estimate with errors in both variables
///   (Deming 1943; Fuller 1987, Measurement Error Models, section 1.3), free of the attenuation
///   that a plain regression on the noisy output suffers.
/// - *motors*: the logarithm of the power at the bus with that of steady flight at the measured
///   height and airspeed, averaged over some seconds; its error is relative, and lasts for seconds.
///
/// A gain, an offset or a resistance changes the noise of what it is applied to, and so does the
/// residual's unit: a reading that is taken to be too large would else seem to explain something,
/// only because its noise shrinks with it.
///
/// Noise and its memory are estimated from what a flexible smooth function of time, height and
/// airspeed leaves of the base model's residuals, less the waves in it that no memory explains as
/// well, so that what is hidden does not pass for noise.
class PowerResiduals {
 public:
  /// Stages whose channels are missing do not appear. The design must have a cable cross-section.
  PowerResiduals(const PowerModel& base, ScreenedPowerLog screened);

  /// The log after screening.
  [[nodiscard]] const PowerLog& log() const { return screened_.log; }
  /// The stages that the channels allow.
  [[nodiscard]] std::span<const PowerStage> stages() const { return stages_; }
  /// Number of samples.
  [[nodiscard]] std::size_t samples() const { return screened_.log.time.size(); }

  /// Rows of all stages.
  [[nodiscard]] std::size_t rows() const { return rows_; }

  /// Measured minus predicted over the noise of one sample, one element a sample, for stage `k` of
  /// `stages()`.
  void standardised(std::size_t k, const PowerModel& model, std::span<double> out) const;

  /// Power in W that the flight takes at the converter's input, whatever was measured at the bus,
  /// over the power measured there, one ratio a sample. NaN where the model cannot fly.
  [[nodiscard]] std::vector<double> predicted_share_of_input(const PowerModel& model) const;

  /// Averages a stage's samples into its rows, takes the memory out of them and divides by the
  /// standard deviation of what is left: rows of independent noise of size 1. Linear. Unusable rows
  /// become 0.
  void whitened(std::size_t k, std::span<const double> standardised, std::span<double> out) const;

  /// Takes the noise of stage `k` and its memory from all that `model` leaves. The smooth functions
  /// of the first estimate take slow noise away with what is hidden; once nothing is hidden any
  /// more, what is left shows all of it.
  void refine_noise(std::size_t k, const PowerModel& model);

 private:
  /// What the noise of a comparison hangs on.
  struct ReadingNoise {
    double supply_voltage = 0;        ///< V², variance of one reading
    double drone_voltage = 0;         ///< V²
    double supply_current = 0;        ///< A², as the line shows it
    double current_at_converter = 0;  ///< A², as the power at the converter's input shows it
    double mean_voltage = 0;          ///< V at the drone
    double mean_current = 0;          ///< A
  };

  /// Of the difference of the powers before and behind the converter.
  struct ConverterNoise {
    double total = 0;         ///< W²
    double output_share = 0;  ///< of that, the part that the power behind it brings in
    double slope = 1;         ///< W of input a W of output
  };
  [[nodiscard]] ConverterNoise converter_noise(const PowerModel& base,
                                               const std::vector<char>& usable) const;
  void estimate_reading_noise(const PowerModel& base);
  /// Variances in V² of the voltage lost, at a mean resistance in Ω, and in W² of the power at the
  /// converter's input, by `readings_`.
  [[nodiscard]] double lost_voltage_variance(const PowerInstruments& instruments,
                                             double resistance) const;
  [[nodiscard]] double input_power_variance(const PowerInstruments& instruments) const;
  void estimate_noise(const PowerModel& base, PowerStage& stage, std::size_t k);

  ScreenedPowerLog screened_;
  std::vector<PowerStage> stages_;
  std::size_t rows_ = 0;
  std::vector<double> bus_power_;
  std::vector<double> log_bus_power_;
  mutable ChainMemory memory_;
  ReadingNoise readings_;
  // In the base model, whose noise a stage's is.
  double lost_voltage_variance_ = 1;  ///< V²
  double input_power_variance_ = 1;   ///< W²
  double input_variance_ = 1;         ///< of U_drone·I, a part of all noise at the converter
  double output_variance_ = 0;        ///< of the bus power, likewise
};

}  // namespace tethercalc
