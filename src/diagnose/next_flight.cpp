// Notation: δ change of the prediction by an effect as large as the log has it, G its Gram matrix
// with everything that is fitted or could take its place, λ = ‖δ beside what is fitted‖², s² the
// variance of one row as much as it weighs among correlated ones, T² = λ/s².
#include "tethercalc/diagnose/next_flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "diagnose/block_fit.hpp"
#include "diagnose/fit_judgement.hpp"
#include "diagnose/flight_model.hpp"
#include "diagnose/manoeuvres.hpp"
#include "identify/statistics.hpp"
#include "tethercalc/diagnose/hypothesis.hpp"

namespace tethercalc {
namespace {

/// Chance that something that was asked comes out otherwise, over all of it (Bonferroni).
constexpr double one_in_ten = 0.1;
/// Of each effect: that chance hardly explains it, that it gains, and that others do worse.
constexpr double asked_of_each = 3;
/// s less of manoeuvres that are judged: what is flown counts from the first to the last pass.
constexpr double lost_at_ends = shortest_block;
/// s that a further flight takes at least, so that it can be diagnosed by itself.
constexpr double shortest_flight =
    shortest_block * static_cast<double>(fewest_blocks) + lost_at_ends;
/// So many shorter plans are tried before the question whether there is one stays open.
constexpr std::size_t most_trials = 2000;

/// How often each candidate is flown.
using Plan = std::vector<int>;

double time_of(const Plan& plan, const std::vector<Manoeuvre>& candidates) {
  double sum = 0;
  for (std::size_t k = 0; k < plan.size(); ++k) sum += plan[k] * candidates[k].duration;
  return sum;
}

/// Rows of logs and candidates by the columns of one question.
struct Grams {
  std::vector<MatrixXd> logged;  ///< one a block
  /// Of each candidate one a piece as long as a block.
  std::vector<std::vector<MatrixXd>> manoeuvre;
};

/// One effect that is to be settled.
struct Question {
  Decision decision;
  double sizes = 1;
  double chances = 1;  ///< so many places were to choose from
  bool own = false;    ///< to the further flight
  double least_gain_percent = 0;
  Index nuisances = 0;  ///< leading columns: what is fitted beside it
  struct Rival {
    std::string name;
    Index first = 0;
    Index count = 0;
  };
  std::vector<Rival> rivals;  ///< columns after those
  Grams grams;                ///< the last column is δ
};

/// What all questions share.
struct Terms {
  double row_variance = 1;  ///< of the residuals
  double correlated = 1;    ///< times so many rows weigh as one independent one
  double logged_rows = 0;
  std::vector<double> manoeuvre_rows;
  double tested = 1;  ///< candidates that share the chance of a false alarm
  SelectionOptions options;
};

/// By how much of what is asked a plan answers a question: 1 where it does.
struct Standing {
  double chance = 0;  ///< hardly would chance explain it
  double gain = 0;    ///< on data that were not fitted
  double rival = 0;   ///< the nearest other effect does worse in its place
  std::string nearest;
  double gain_percent = 0;

  [[nodiscard]] bool settled() const { return chance >= 1 && gain >= 1 && rival >= 1; }
  [[nodiscard]] double score() const {
    return std::min(chance, 1.0) + std::min(gain, 1.0) + std::min(rival, 1.0);
  }
};

double blocks_of(double duration) {
  return std::clamp(std::floor((duration - lost_at_ends) / shortest_block), 0.0,
                    static_cast<double>(most_blocks));
}

/// A Gram matrix with its leading columns fitted.
class Beside {
 public:
  Beside(const MatrixXd& gram, Index fitted) : fitted_(fitted) {
    const Index rest = gram.cols() - fitted;
    solution_ =
        solve_symmetric(gram.topLeftCorner(fitted, fitted), gram.topRightCorner(fitted, rest));
    left_ = gram.bottomRightCorner(rest, rest) -
            inner_products(gram.topRightCorner(fitted, rest), solution_);
  }
  [[nodiscard]] double own(Index column) const { return left_(column - fitted_, column - fitted_); }
  [[nodiscard]] double own_beside(Index column, Index first, Index count) const {
    const VectorXd cross = left_.block(first - fitted_, column - fitted_, count, 1);
    return own(column) - cross.dot(parts_of(column, first, count));
  }
  /// Column less what fits of it, as a combination of all columns.
  [[nodiscard]] VectorXd combination(Index column) const {
    VectorXd all = VectorXd::Zero(fitted_ + left_.cols());
    all.head(fitted_) = -solution_.col(column - fitted_);
    all[column] = 1;
    return all;
  }

  /// What of some more columns is fitted to it, beside the leading ones.
  [[nodiscard]] VectorXd parts_of(Index column, Index first, Index count) const {
    const VectorXd cross = left_.block(first - fitted_, column - fitted_, count, 1);
    const MatrixXd square = left_.block(first - fitted_, first - fitted_, count, count);
    return pseudo_solution(square, cross);
  }
  /// The column less what fits of it where these are fitted, too.
  [[nodiscard]] VectorXd combination_beside(Index column, Index first, Index count) const {
    const VectorXd parts = parts_of(column, first, count);
    VectorXd all = combination(column);
    for (Index k = 0; k < count; ++k) all -= parts[k] * combination(first + k);
    return all;
  }

 private:
  Index fitted_;
  MatrixXd solution_;
  MatrixXd left_;
};

/// Answers each question for any plan.
class Forecast {
 public:
  Forecast(std::vector<Question> questions, Terms terms, const std::vector<Manoeuvre>& candidates)
      : questions_(std::move(questions)), terms_(std::move(terms)), candidates_(candidates) {}

  [[nodiscard]] const std::vector<Question>& questions() const { return questions_; }
  [[nodiscard]] const std::vector<Manoeuvre>& candidates() const { return candidates_; }

  /// `together` effects are to be settled.
  [[nodiscard]] Standing standing(const Question& question, const Plan& plan,
                                  std::size_t together) const {
    const double sure_by = margin(together);
    const double blocks = blocks_of(time_of(plan, candidates_));
    const auto logged = static_cast<double>(question.grams.logged.size());
    const double all = question.own ? blocks : logged + blocks;
    const double degrees = all - 1;
    Standing standing;
    if (degrees + 1 - question.sizes < 1) return standing;

    MatrixXd gram =
        MatrixXd::Zero(question.grams.logged.front().rows(), question.grams.logged.front().cols());
    for (const MatrixXd& block : question.grams.logged) gram += block;
    double rows = terms_.logged_rows;
    for (std::size_t k = 0; k < plan.size(); ++k) {
      if (plan[k] == 0) continue;
      for (const MatrixXd& piece : question.grams.manoeuvre[k]) gram += plan[k] * piece;
      rows += plan[k] * terms_.manoeuvre_rows[k];
    }
    const Beside beside(gram, question.nuisances);
    const double lambda = beside.own(gram.cols() - 1);
    if (!(lambda > 0)) return standing;
    const double weight = terms_.row_variance * terms_.correlated;

    standing.chance = std::sqrt(lambda / weight) / (certain_at(question, degrees) + sure_by);

    const double noise = 2 * std::sqrt(weight * lambda);
    const double sure = std::max(0.0, lambda - sure_by * noise);
    const double student = student_quantile(degrees, 0.975);
    const double spread = std::hypot(
        noise, uneven(question, plan, beside.combination(gram.cols() - 1), logged + blocks));
    const double base = terms_.row_variance * rows;
    standing.gain_percent = gain_percent(base + lambda, base);
    standing.gain = std::min(gain_percent(base + sure, base) / question.least_gain_percent,
                             sure / (student * spread));

    standing.rival = infinite;
    for (const Question::Rival& rival : question.rivals) {
      const double left = beside.own_beside(gram.cols() - 1, rival.first, rival.count);
      const double rival_noise = 2 * std::sqrt(weight * std::max(left, 0.0));
      const double behind = std::max(0.0, left - sure_by * rival_noise);
      double told = behind / ((1 - rival_gain) * lambda);
      if (told < std::min(1.0, standing.rival)) {
        const VectorXd excess =
            beside.combination_beside(gram.cols() - 1, rival.first, rival.count);
        const double rival_spread =
            std::hypot(rival_noise, uneven(question, plan, excess, logged + blocks));
        if (rival_spread > 0) told = std::max(told, behind / (student * rival_spread));
      }
      if (told >= standing.rival) continue;
      standing.rival = told;
      standing.nearest = rival.name;
    }
    return standing;
  }

  /// Over the questions that are `asked`.
  [[nodiscard]] double score(const Plan& plan, const std::vector<bool>& asked) const {
    double sum = std::min(1.0, time_of(plan, candidates_) / shortest_flight);
    const auto together = static_cast<std::size_t>(std::count(asked.begin(), asked.end(), true));
    for (std::size_t q = 0; q < questions_.size(); ++q) {
      if (asked[q]) sum += standing(questions_[q], plan, together).score();
    }
    return sum;
  }
  [[nodiscard]] bool settles(const Plan& plan, const std::vector<bool>& asked) const {
    const auto count = std::count(asked.begin(), asked.end(), true);
    return score(plan, asked) >= 1 + 3 * static_cast<double>(count) - 1e-9;
  }

 private:
  static constexpr double infinite = 1e300;

  /// What blocks differ by because a combination of columns shows in some more than in others: the
  /// spread between them counts it as an error.
  [[nodiscard]] double uneven(const Question& question, const Plan& plan, const VectorXd& v,
                              double blocks) const {
    double sum = 0;
    double squares = 0;
    const auto add = [&](const MatrixXd& gram, double share, double times) {
      const double part = v.dot(gram * v) / share;
      sum += times * share * part;
      squares += times * share * part * part;
    };
    for (const MatrixXd& block : question.grams.logged) add(block, 1, 1);
    for (std::size_t k = 0; k < plan.size(); ++k) {
      if (plan[k] == 0) continue;
      const auto pieces = static_cast<double>(question.grams.manoeuvre[k].size());
      const double share = std::max(1.0, candidates_[k].duration / shortest_block) / pieces;
      for (const MatrixXd& piece : question.grams.manoeuvre[k]) add(piece, share, plan[k]);
    }
    return std::sqrt(blocks / (blocks - 1) * std::max(0.0, squares - sum * sum / blocks));
  }

  /// Standard errors between what is expected and what is asked for.
  [[nodiscard]] static double margin(std::size_t together) {
    constexpr double many = 1e6;  // degrees of freedom: normal
    return student_quantile(
        many,
        1 - one_in_ten / (asked_of_each * static_cast<double>(std::max<std::size_t>(together, 1))));
  }

  /// Root of Hotelling's T² beyond which the effect of a question is certain.
  [[nodiscard]] double certain_at(const Question& question, double degrees) const {
    const double sizes = question.sizes;
    const double tested = terms_.tested * question.chances;
    const auto known = certain_.find({sizes, tested, degrees});
    if (known != certain_.end()) return known->second;
    const double denominator = degrees + 1 - sizes;
    double low = 0;
    double high = 1000;
    for (int k = 0; k < 50; ++k) {
      const double t = (low + high) / 2;
      const double p = fisher_tail(t * t / sizes * denominator / degrees, sizes, denominator);
      (p * tested <= terms_.options.false_alarm_probability ? high : low) = t;
    }
    return certain_[{sizes, tested, degrees}] = high;
  }

  std::vector<Question> questions_;
  Terms terms_;
  const std::vector<Manoeuvre>& candidates_;
  mutable std::map<std::array<double, 3>, double> certain_;
};

/// Adds what tells most a second until all that is asked is settled; nothing where that takes too
/// long, or no manoeuvre tells more.
std::optional<Plan> settled_by_steps(const Forecast& forecast, const std::vector<bool>& asked,
                                     double longest) {
  Plan plan(forecast.candidates().size(), 0);
  double duration = 0;
  double score = forecast.score(plan, asked);
  while (!forecast.settles(plan, asked)) {
    std::optional<std::size_t> best;
    double most = 1e-9;
    for (std::size_t k = 0; k < plan.size(); ++k) {
      const double takes = forecast.candidates()[k].duration;
      if (duration + takes > longest) continue;
      Plan trial = plan;
      ++trial[k];
      const double tells = (forecast.score(trial, asked) - score) / takes;
      if (tells <= most) continue;
      most = tells;
      best = k;
    }
    if (!best) return std::nullopt;
    ++plan[*best];
    duration += forecast.candidates()[*best].duration;
    score = forecast.score(plan, asked);
  }
  // What was taken early may be superfluous beside what came later: the longest first.
  std::vector<std::size_t> order(plan.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return forecast.candidates()[a].duration > forecast.candidates()[b].duration;
  });
  for (const std::size_t k : order) {
    while (plan[k] > 0) {
      Plan trial = plan;
      --trial[k];
      if (!forecast.settles(trial, asked)) break;
      plan = std::move(trial);
    }
  }
  return plan;
}

/// Tries every plan shorter than the best one known, depth first, as long as there are trials left.
class ShorterPlans {
 public:
  ShorterPlans(const Forecast& forecast, const std::vector<bool>& asked, Plan known)
      : forecast_(forecast), asked_(asked), best_(std::move(known)) {
    duration_ = time_of(best_, forecast.candidates());
  }

  /// Whether all were tried.
  bool search() {
    Plan plan(best_.size(), 0);
    descend(plan, 0, 0);
    return trials_ <= most_trials;
  }
  [[nodiscard]] const Plan& best() const { return best_; }

 private:
  void descend(Plan& plan, std::size_t from, double duration) {
    for (std::size_t k = from; k < plan.size() && trials_ <= most_trials; ++k) {
      const double with = duration + forecast_.candidates()[k].duration;
      if (with >= duration_ - 1e-9) continue;
      ++plan[k];
      ++trials_;
      if (forecast_.settles(plan, asked_)) {
        best_ = plan;
        duration_ = with;
      } else {
        descend(plan, k, with);
      }
      --plan[k];
    }
  }

  const Forecast& forecast_;
  const std::vector<bool>& asked_;
  Plan best_;
  double duration_ = 0;
  std::size_t trials_ = 0;
};

/// An effect that is open, and why.
struct Open {
  std::size_t group = 0;  ///< of the logs' model
  std::vector<std::string> told_from;
};

/// Whether an effect belongs to moments of the flight that showed it.
bool is_of_a_moment(const Effect& effect) { return effect.channel == "time"; }

/// What the diagnosis leaves open, by groups of the logs' model.
std::vector<Open> open_in(const Diagnosis& diagnosis, const FlightModel& model) {
  std::vector<Open> open;
  const auto entry = [&](std::size_t group) -> Open& {
    const auto same =
        std::find_if(open.begin(), open.end(), [&](const Open& o) { return o.group == group; });
    return same != open.end() ? *same : open.emplace_back(Open{group, {}});
  };
  const auto group_of = [&](const auto& is_meant) -> std::optional<std::size_t> {
    for (std::size_t g = 0; g < model.effects().size(); ++g) {
      if (!model.effect(g).id.empty() && is_meant(g)) return g;
    }
    return std::nullopt;
  };
  const auto told_as = [&](const std::string& id, std::size_t flight) {
    return group_of(
        [&](std::size_t g) { return model.effect(g).id == id && model.flight_of(g) == flight; });
  };
  for (const Finding& f : diagnosis.findings) {
    if (f.indistinguishable_from.empty()) continue;
    std::vector<std::size_t> set;
    if (const auto g = told_as(f.effect, f.flight)) set.push_back(*g);
    for (const std::string& name : f.indistinguishable_from) {
      if (const auto g = group_of([&](std::size_t k) { return model.name(k) == name; })) {
        set.push_back(*g);
      }
    }
    for (const std::size_t g : set) {
      for (const std::size_t other : set) {
        if (other != g) entry(g).told_from.push_back(model.name(other));
      }
    }
  }
  for (const Suspected& s : diagnosis.suspected) {
    if (const auto g = told_as(s.effect, s.flight)) entry(*g);
  }
  return open;
}

/// The groups of a model that are found in the diagnosis.
Groups found_in(const Diagnosis& diagnosis, const FlightModel& model) {
  Groups found;
  for (const Finding& f : diagnosis.findings) {
    for (std::size_t g = 0; g < model.effects().size(); ++g) {
      if (model.effect(g).id == f.effect && model.flight_of(g) == f.flight) found.push_back(g);
    }
  }
  return found;
}

/// What is free beside `selected`: all that is always fitted and not told in more detail.
Groups free_beside(const FlightModel& model, const Groups& selected) {
  Groups free;
  for (std::size_t g = 0; g < model.effects().size(); ++g) {
    const bool replaced = std::any_of(selected.begin(), selected.end(), [&](std::size_t by) {
      return model.problem.groups[by].replaces == g;
    });
    const bool wanted = model.problem.groups[g].fitted || contains(selected, g);
    if (wanted && !replaced) free.push_back(g);
  }
  return free;
}

/// The logs alone, as they were diagnosed, and with the manoeuvres as a further flight.
class Planning {
 public:
  Planning(const Design& design, std::span<const MeasuredFlight> flights,
           const FlightDiagnosisOptions& options, const Diagnosis& diagnosis,
           const FlightLimits& limits)
      : design_(design),
        options_(options),
        diagnosis_(diagnosis),
        limits_(limits),
        effects_(effects_for(LogKind::flight, options.hypotheses)),
        logged_(read_flights(design, flights, options.pitch_offset)),
        model_(design, logged_, effects_, options.base),
        record_(model_.problem) {
    place(diagnosis.findings);
    place(diagnosis.suspected);
    found_ = found_in(diagnosis, model_);
    fit_ = fit_blocks(record_, {free_beside(model_, found_), {}}, nullptr);
    heading_ = logged_.back().record.mean_heading;
  }

  [[nodiscard]] std::vector<Open> open() const { return open_in(diagnosis_, model_); }
  [[nodiscard]] const FlightModel& model() const { return model_; }
  [[nodiscard]] double heading() const { return heading_; }

  /// The questions, were there these manoeuvres to choose from.
  [[nodiscard]] Forecast forecast(const std::vector<Open>& open,
                                  const std::vector<Manoeuvre>& candidates) const {
    std::vector<FlightData> all = logged_;
    std::vector<std::size_t> pieces;
    all.push_back(further_flight(candidates, pieces));
    const FlightModel joint(design_, all, effects_, options_.base);
    const Record rows(joint.problem);
    Terms terms;
    const double logged_rows = static_cast<double>(record_.rows());
    terms.row_variance = std::pow(diagnosis_.extended.holdout_rmse, 2);
    terms.correlated = std::max(1.0, logged_rows / std::max(1.0, diagnosis_.effective_samples));
    terms.logged_rows = logged_rows;
    for (std::size_t k = 0, block = record_.blocks(); k < candidates.size(); ++k) {
      double count = 0;
      for (std::size_t i = 0; i < pieces[k]; ++i) {
        count += static_cast<double>(rows.block_size(block++));
      }
      terms.manoeuvre_rows.push_back(count);
    }
    terms.options = options_.selection;
    for (const ParameterGroup& group : joint.problem.groups) terms.tested += group.fitted ? 0 : 1;
    std::vector<Question> questions;
    for (const Open& o : open) questions.push_back(question(o, joint, rows, terms, pieces));
    return {std::move(questions), std::move(terms), candidates};
  }

 private:
  /// Moments and periods start where the diagnosis has them.
  template <typename Told>
  void place(const std::vector<Told>& told) {
    for (const Told& t : told) {
      for (std::size_t g = 0; g < model_.effects().size(); ++g) {
        const Effect& effect = model_.effect(g);
        if (effect.id != t.effect || model_.flight_of(g) != t.flight) continue;
        for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
          for (const ParameterEstimate& p : t.parameters) {
            if (p.name != effect.parameters[k].name) continue;
            const ModelParameter& bounds = model_.problem.groups[g].parameters[k];
            record_.start_at(
                model_.first_parameter(g) + k,
                std::clamp(p.value * effect.parameters[k].unit_SI, bounds.lower, bounds.upper));
          }
        }
      }
    }
  }

  [[nodiscard]] FlownBy drone() const {
    FlownBy drone{{fit_.values[0], fit_.values[1], 0, 0},
                  design_.drone.mass,
                  design_.flight.air_density,
                  design_.flight.gravity};
    if (const auto j = model_.index_of_field(linear_speed_field)) {
      drone.drag.linear_speed = fit_.values[*j];
    }
    return drone;
  }

  /// Every candidate once, cut into pieces as long as the blocks of a log: `pieces` of each.
  [[nodiscard]] FlightData further_flight(const std::vector<Manoeuvre>& candidates,
                                          std::vector<std::size_t>& pieces) const {
    const FlownBy flown_by = drone();
    const NominalFlight nominal = nominal_flight(candidates, limits_, heading_, flown_by);
    FlightData data;
    const std::size_t size = nominal.log.time.size();
    data.observations = observe(nominal.log, {0, size}, 0, flown_by.gravity);
    data.record =
        flight_record(data.observations, flown_by.mass, flown_by.air_density, flown_by.gravity);
    std::size_t block = record_.blocks();
    for (std::size_t first = 0; first < size;) {
      std::size_t last = first;
      while (last < size && nominal.manoeuvre[last] == nominal.manoeuvre[first]) ++last;
      const std::size_t samples = last - first;
      const double duration = nominal.log.time[last - 1] - nominal.log.time[first];
      pieces.push_back(
          std::max<std::size_t>(1, static_cast<std::size_t>(duration / shortest_block)));
      for (std::size_t i = first; i < last; ++i) {
        const bool inside = i > 0 && i + 1 < size;
        const std::size_t piece = block + (i - first) * pieces.back() / samples;
        data.block.push_back(inside ? static_cast<int>(piece) : -1);
      }
      block += pieces.back();
      first = last;
    }
    data.faults.sample.assign(size, false);
    data.step = median_step(data.observations.time);
    data.usable = data.step * static_cast<double>(size);
    data.blocks = block - record_.blocks();
    return data;
  }

  /// The values of a fit of the logs, with neutral ones for what is the further flight's own.
  [[nodiscard]] std::vector<double> carried(const FlightModel& joint,
                                            const std::vector<double>& logged) const {
    std::vector<double> values;
    for (std::size_t g = 0; g < joint.effects().size(); ++g) {
      const std::size_t flight = joint.log_of(g).value_or(0);
      for (std::size_t k = 0; k < joint.effect(g).parameters.size(); ++k) {
        const ModelParameter& own = joint.problem.groups[g].parameters[k];
        const auto from = flight < logged_.size()
                              ? model_.index_in(flight, joint.effect(g).parameters[k].name)
                              : std::nullopt;
        values.push_back(from ? logged[*from] : own.neutral);
      }
    }
    return values;
  }

  /// The group of the joint model for one of the logs'.
  [[nodiscard]] std::optional<std::size_t> in_joint(const FlightModel& joint, std::size_t group,
                                                    bool further) const {
    const Effect& effect = model_.effect(group);
    const std::size_t flight = further ? logged_.size() : model_.log_of(group).value_or(0);
    for (std::size_t g = 0; g < joint.effects().size(); ++g) {
      if (&joint.effect(g) == &effect && joint.log_of(g).value_or(flight) == flight) return g;
    }
    return std::nullopt;
  }

  [[nodiscard]] Question question(const Open& open, const FlightModel& joint, const Record& rows,
                                  const Terms& terms,
                                  const std::vector<std::size_t>& pieces) const {
    const Effect& effect = model_.effect(open.group);
    Question q;
    q.decision = {effect.id, model_.flight_of(open.group), effect.own_in_each_flight,
                  open.told_from};
    q.own = effect.own_in_each_flight;
    q.least_gain_percent = terms.options.least_gain_percent * effect.least_gain_factor;

    // As large as the logs have it, without those that it could not be told from.
    Groups selected = without_group(found_, open.group);
    for (const std::string& name : open.told_from) {
      for (const std::size_t g : Groups(selected)) {
        if (model_.name(g) == name) selected = without_group(selected, g);
      }
    }
    const Groups with = with_group(selected, open.group);
    const BlockFit fit = fit_blocks(record_, {free_beside(model_, with), {}}, &fit_);
    std::vector<double> values = carried(joint, fit.values);

    const std::size_t target = in_joint(joint, open.group, q.own).value();
    Groups known;  // that may be there beside it
    for (const std::size_t g : selected) {
      for (const bool further : {false, true}) {
        const auto k = in_joint(joint, g, further);
        if (k && *k != target && !contains(known, *k)) known = with_group(known, *k);
      }
    }
    if (q.own) {
      // What it was in the logs stays open there.
      for (const std::size_t g : with) {
        const auto k = in_joint(joint, g, false);
        if (k && *k != target && !contains(known, *k)) known = with_group(known, *k);
      }
      for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        values[joint.first_parameter(target) + k] =
            fit.values[model_.first_parameter(open.group) + k];
      }
    }
    Groups fitted = without_group(free_beside(joint, with_group(known, target)), target);
    // A flight that turns needs its wind in the detail that turning shows.
    for (std::size_t g = 0; g < joint.effects().size(); ++g) {
      const auto replaced = joint.problem.groups[g].replaces;
      if (joint.log_of(g) == logged_.size() && g != target && replaced && *replaced != target &&
          joint.problem.groups[*replaced].fitted) {
        fitted = with_group(fitted, g);
      }
    }

    const double weight = terms.row_variance * terms.correlated;
    // As they would have to do without it: a drag area carries the linear drag that is asked about.
    std::vector<MatrixXd> columns{group_slopes(rows, fitted, without(joint, target, values))};
    Groups rivals;
    q.nuisances = columns.front().cols();
    Index next = q.nuisances;
    for (std::size_t g = 0; g < joint.effects().size(); ++g) {
      const ParameterGroup& group = joint.problem.groups[g];
      const bool elsewhere = q.own && joint.log_of(g).value_or(logged_.size()) < logged_.size();
      // What is looked for at many places puts what is not in doubt only where it does clearly
      // better.
      if (group.fitted || g == target || contains(fitted, g) || is_placed(group) || elsewhere ||
          group.replaces == target || joint.problem.groups[target].replaces == g) {
        continue;
      }
      columns.push_back(slopes_at_start(rows, values, g));
      rivals.push_back(g);
      next += columns.back().cols();
    }
    columns.push_back(change_by(joint, rows, target, values));
    // As large as they would be in its place: a wind of some m/s is not what a breath of it is.
    const MatrixXd start = side_by_side(columns);
    const Beside beside(gram_matrix(start) + small(start.cols(), weight), q.nuisances);
    Index first = q.nuisances;
    next = q.nuisances;
    for (std::size_t r = 0; r < rivals.size(); ++r) {
      MatrixXd& slopes = columns[1 + r];
      const Index count = slopes.cols();
      if (count == 0) continue;
      const VectorXd parts = beside.parts_of(start.cols() - 1, first, count);
      first += count;
      const std::vector<double> instead = moved(joint, rivals[r], values, parts);
      const MatrixXd there = group_slopes(rows, {rivals[r]}, instead);
      slopes.resize(rows.rows(), there.cols() + 1);
      slopes << there, change_by(joint, rows, rivals[r], instead);
      q.rivals.push_back({name_in(joint, rivals[r]), next, slopes.cols()});
      next += slopes.cols();
    }
    const MatrixXd all = side_by_side(columns);

    q.sizes = 0;
    q.chances = chances(joint.problem.groups[target]);
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
      const ModelParameter& p = joint.problem.groups[target].parameters[k];
      q.sizes += p.is_free() && !p.shape_only ? 1 : 0;
    }
    std::size_t block = 0;
    const auto next_gram = [&] {
      const auto part = all.middleRows(rows.block_begin(block), rows.block_size(block));
      ++block;
      return gram_matrix(part);
    };
    while (block < record_.blocks()) q.grams.logged.push_back(next_gram());
    for (const std::size_t count : pieces) {
      std::vector<MatrixXd>& grams = q.grams.manoeuvre.emplace_back();
      while (grams.size() < count) grams.push_back(next_gram());
    }
    q.grams.logged.front() += small(all.cols(), weight);
    return q;
  }

  [[nodiscard]] static MatrixXd side_by_side(const std::vector<MatrixXd>& columns) {
    Index count = 0;
    for (const MatrixXd& part : columns) count += part.cols();
    MatrixXd all(columns.front().rows(), count);
    count = 0;
    for (const MatrixXd& part : columns) {
      all.middleCols(count, part.cols()) = part;
      count += part.cols();
    }
    return all;
  }

  /// What is known before any flight: parameters are within a hundred of their scales. Without it,
  /// what no row shows would leave the sums singular. The last column is no parameter.
  [[nodiscard]] static MatrixXd small(Index columns, double weight) {
    VectorXd diagonal = VectorXd::Constant(columns, 1e-4 * weight);
    diagonal[columns - 1] = 0;
    return diagonal.asDiagonal();
  }

  /// `values` with the free parameters of the group moved from their first values, within bounds.
  [[nodiscard]] static std::vector<double> moved(const FlightModel& joint, std::size_t group,
                                                 std::vector<double> values,
                                                 const VectorXd& parts) {
    Index column = 0;
    for (std::size_t k = 0; k < joint.effect(group).parameters.size(); ++k) {
      const ModelParameter& p = joint.problem.groups[group].parameters[k];
      double& value = values[joint.first_parameter(group) + k];
      value = p.start;
      if (!p.is_free()) continue;
      value = std::clamp(value + p.scale * parts[column], p.lower, p.upper);
      ++column;
    }
    return values;
  }

  /// The group as a person calls it; the flight that is planned has no number yet.
  [[nodiscard]] std::string name_in(const FlightModel& joint, std::size_t group) const {
    return joint.flight_of(group) > logged_.size()
               ? "what the next flight has of " + joint.effect(group).id
               : joint.name(group);
  }

  /// `values` with the group at its neutral ones.
  [[nodiscard]] static std::vector<double> without(const FlightModel& joint, std::size_t group,
                                                   std::vector<double> values) {
    for (std::size_t k = 0; k < joint.effect(group).parameters.size(); ++k) {
      values[joint.first_parameter(group) + k] = joint.problem.groups[group].parameters[k].neutral;
    }
    return values;
  }

  /// By how much the group changes the prediction, as large as it is in `values`.
  static VectorXd change_by(const FlightModel& joint, const Record& rows, std::size_t group,
                            std::vector<double> values) {
    VectorXd left(rows.rows());
    VectorXd left_without(rows.rows());
    rows.residuals(values, left);
    rows.residuals(without(joint, group, std::move(values)), left_without);
    return left_without - left;
  }

  const Design& design_;
  const FlightDiagnosisOptions& options_;
  const Diagnosis& diagnosis_;
  const FlightLimits& limits_;
  std::vector<const Effect*> effects_;
  std::vector<FlightData> logged_;
  FlightModel model_;
  Record record_;
  Groups found_;
  BlockFit fit_;
  double heading_ = 0;
};

/// The manoeuvres of a plan, those of a kind as far apart as may be: what blocks of the log differ
/// by counts as an error. The last candidates come in the middle, since a hover at an end is not
/// judged.
std::vector<Manoeuvre> spread_out(const Plan& plan, const std::vector<Manoeuvre>& candidates) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < plan.size(); ++k) {
    for (int i = 0; i < plan[k]; ++i) order.emplace_back((i + 0.5) / plan[k], k);
  }
  std::sort(order.begin(), order.end());
  std::vector<Manoeuvre> flown;
  for (const auto& [place, k] : order) flown.push_back(candidates[k]);
  return flown;
}

/// What the base model needs in more detail where the nose turns.
std::vector<FinerBase> finer_base(const FlightDiagnosisOptions& options,
                                  const std::vector<Manoeuvre>& manoeuvres) {
  std::vector<FinerBase> finer;
  const double first = manoeuvres.front().waypoints.front().heading;
  const bool turns = std::any_of(manoeuvres.begin(), manoeuvres.end(), [&](const Manoeuvre& m) {
    return std::any_of(m.waypoints.begin(), m.waypoints.end(),
                       [&](const Waypoint& w) { return w.heading != first; });
  });
  if (!turns) return finer;
  for (const Effect* effect : effects_for(LogKind::flight, options.hypotheses)) {
    if (contains(options.base, effect->replaces) && !contains(options.base, effect->id)) {
      finer.push_back({effect->replaces, effect->id});
    }
  }
  return finer;
}

/// Why no plan settles a question, from how far the longest one comes.
std::string why_not(const Question& question, const Standing& standing) {
  if (standing.gain < 1 && standing.gain <= standing.rival) {
    return fmt::format(
        "as small as the log has it, it would lower the held-out error of all flights by {:.1f} % "
        "at most, too little to be sure of the {:g} % that a name takes",
        standing.gain_percent, question.least_gain_percent);
  }
  if (standing.rival < 1 && standing.rival <= standing.chance) {
    return fmt::format("no manoeuvre within the limits tells it from {}",
                       in_words(standing.nearest));
  }
  return "chance could still explain it after the longest flight that is planned";
}

}  // namespace

NextFlight plan_next_flight(const Design& design, std::span<const MeasuredFlight> flights,
                            const FlightDiagnosisOptions& options, const Diagnosis& diagnosis,
                            const FlightLimits& limits) {
  NextFlight next;
  next.limits = limits;
  const bool nothing_open =
      diagnosis.suspected.empty() &&
      std::all_of(diagnosis.findings.begin(), diagnosis.findings.end(),
                  [](const Finding& f) { return f.indistinguishable_from.empty(); });
  if (nothing_open) return next;

  const Planning planning(design, flights, options, diagnosis, limits);
  std::vector<Open> open;
  for (Open& o : planning.open()) {
    const Effect& effect = planning.model().effect(o.group);
    if (!is_of_a_moment(effect)) {
      open.push_back(std::move(o));
      continue;
    }
    next.undecided.push_back({effect.id, planning.model().flight_of(o.group),
                              "it belongs to moments of the flight that was logged, which no other "
                              "flight repeats"});
  }
  if (open.empty()) return next;

  const std::vector<Manoeuvre> candidates = candidate_manoeuvres(limits, planning.heading());
  const Forecast forecast = planning.forecast(open, candidates);
  const std::vector<Question>& questions = forecast.questions();
  // One after the other, each alone: what cannot be settled must not hold up the rest.
  std::vector<bool> asked(questions.size(), false);
  for (std::size_t q = 0; q < questions.size(); ++q) {
    std::vector<bool> alone(questions.size(), false);
    alone[q] = true;
    asked[q] = settled_by_steps(forecast, alone, limits.duration).has_value();
  }
  std::optional<Plan> plan;
  while (!plan && contains(asked, true)) {
    plan = settled_by_steps(forecast, asked, limits.duration);
    // Together they take too long: the one that was seen last waits.
    if (!plan) *std::find(asked.rbegin(), asked.rend(), true) = false;
  }
  if (plan) {
    ShorterPlans shorter(forecast, asked, *plan);
    next.shortest = shorter.search();
    plan = shorter.best();
    next.manoeuvres = spread_out(*plan, candidates);
    next.duration = time_of(*plan, candidates);
    next.finer_base = finer_base(options, next.manoeuvres);
  }
  // Of what is left open, how far all manoeuvres would come.
  const double once = time_of(Plan(candidates.size(), 1), candidates);
  const Plan longest(candidates.size(), std::max(1, static_cast<int>(limits.duration / once)));
  for (std::size_t q = 0; q < questions.size(); ++q) {
    const Decision& d = questions[q].decision;
    if (asked[q]) {
      next.decides.push_back(d);
    } else {
      next.undecided.push_back(
          {d.effect, d.flight, why_not(questions[q], forecast.standing(questions[q], longest, 1))});
    }
  }
  return next;
}

}  // namespace tethercalc
